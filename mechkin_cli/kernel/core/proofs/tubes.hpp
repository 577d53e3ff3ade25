// Tubes: boxes along a mechanism's way from row to row, each with exactly one position at every place of the way.
//
// The way goes straight from the inputs of each row to those of the next, and nothing else is said of it. A tube reaches
// from one row to another; it is proven with the cubic through both rows' positions and derivatives as its middle. Where
// two tubes meet, and at each row on the way, the row's own box, which has exactly one position, lies in the tubes': so
// the positions of all of them are one curve.
#pragma once

#include <vector>

#include "plan/plan.hpp"
#include "proofs/proving_unit.hpp"

struct WayOfRows {
  long rows;
  const double* place;         // rows: the way's parameter, that does not fall
  const double* inputs;        // inputs x rows, angles with their whole turns
  const double* off;           // inputs x rows: how far these may be from what is meant
  const double* states;        // states x rows
  const double* after;         // columns x rows: derivatives by the parameter on the way on from a row
  const double* before;        // columns x rows: the same on the way to it
  const double* radius;        // columns x rows: of the rows' boxes
  const unsigned char* proven; // rows: that these have one position each
  const unsigned char* bends;  // rows: the way bends here, no tube goes through
  const unsigned char* follows;  // equations: ProvingRequest::follows
};

struct Tubes {
  unsigned char* joined;  // rows: whether a tube is proven from the row to the next; of the last 0
  double* width;          // rows: largest radius of that tube
  long count, tried;      // tubes, and how many were looked at
};

// Memory for one plan.
class TubeProver {
 public:
  TubeProver(const Plan& plan, const Plan* radii, const ProvingUnit& unit);
  void prove(const WayOfRows& way, Tubes* tubes);

 private:
  bool are_proven(const WayOfRows& way, long from, long to) const;
  bool prove(const WayOfRows& way, long from, long to, double* width);
  void lay_curve(const WayOfRows& way, long from, long to);
  bool holds_row(const WayOfRows& way, long row, double t, bool is_box_known);
  double* coefficient(int state) { return curve_.data() + (long)parts_ * state; }

  const Plan& plan_;
  const Plan* radii_;
  const ProvingUnit& unit_;
  int parts_;
  std::vector<char> memory_, turns_;       // states: angles that a whole turn brings back
  std::vector<int> ball_;                  // first states of orientations, by their first column; else -1
  std::vector<double> curve_, least_, radius_;
};
