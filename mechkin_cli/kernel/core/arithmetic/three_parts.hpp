// An enclosed number as plans carry it, the same for all lanes: high and low part of its midpoint, and its radius.
#pragma once

struct ThreeParts {
  double first, second, radius;
  friend ThreeParts operator-(ThreeParts a) { return {-a.first, -a.second, a.radius}; }
};
