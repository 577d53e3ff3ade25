// Proofs that a mechanism has exactly one position in a box, or along a curve of boxes.
#pragma once

template <class Number>
struct PlanOf;

// Places that are looked at: boxes about points, or about curves over a parameter in [-1, 1]. Numbers of places have as many
// parts as the unit's arithmetic (pack.hpp): the coefficients of 1, t ... t^K, then a radius, which only inputs have.
struct ProvingRequest {
  long places;
  const double* states;   // states, of the unit's parts, x places: the middle of the box; orientations need no unit length
  const double* least;    // columns x places, may be null: boxes are at least this wide
  const unsigned char* follows;  // equations of all blocks, may be null: whether one is zero where those of its joint that
                                 // do not follow are, and the side conditions hold
  double* radius;         // columns x places: of the box that was proven. Of an orientation of its increments x, which turn
                          // it by the quaternion (1, x / 2) about the axes of the joint's frame in the parent.
  double* contraction;    // places: at most the norm of I - C J in parts of the box, below 1 where proven
  double* beyond;         // places: at most the size of the equations that were not needed, anywhere in the box
  unsigned char* proven;  // places
};

struct ProvingUnit {
  int parts;
  long (*workspace_size)(const PlanOf<double>&);
  // `radii`: of the plan's constants, as a plan with these instead of them; null where they are exact.
  void (*prove)(const PlanOf<double>&, const PlanOf<double>* radii, const ProvingRequest&, char* workspace);
};

extern "C" {
const ProvingUnit* mechkin_proving_points();  // K = 0
const ProvingUnit* mechkin_proving_curves();  // K = 4
}
