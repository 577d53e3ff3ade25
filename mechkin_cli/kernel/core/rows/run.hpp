// Bounds of what one call may be asked for.
#pragma once

// Rows of a table that has no columns may be any number, and take no memory where they come from.
constexpr long MOST_ROWS = 100000000;
