// The cubic through four places, rising, in Newton's form.
#pragma once

struct Cubic {
  double x[4], y0, slope, bend, third;
  Cubic(const double* at, const double* y) : x{at[0], at[1], at[2], at[3]}, y0(y[0]) {
    const double d12 = (y[2] - y[1]) / (x[2] - x[1]), d23 = (y[3] - y[2]) / (x[3] - x[2]);
    slope = (y[1] - y[0]) / (x[1] - x[0]);
    bend = (d12 - slope) / (x[2] - x[0]);
    third = ((d23 - d12) / (x[3] - x[1]) - bend) / (x[3] - x[0]);
  }
  double operator()(double at) const { return y0 + (at - x[0]) * (slope + (at - x[1]) * (bend + third * (at - x[2]))); }
};
