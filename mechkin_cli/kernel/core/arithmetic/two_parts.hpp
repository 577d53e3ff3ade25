// A number of an arithmetic with two parts as plans carry it, the same for all lanes: high and low, or midpoint and radius.
#pragma once

struct TwoParts {
  double first, second;
  friend TwoParts operator-(TwoParts a) { return {-a.first, -a.second}; }
};
