// Places near which the loads balance, many at once, each by Newton's method of its own.
#pragma once

#include "rows/run.hpp"

// An input that nothing drives: its number, the output that is the effort along it, and the effort's unit by the kernel's
// unit of the input.
struct FreeInput {
  int input, slot;
  double unit;
};

// Limits of the steps, rad or length units; see tolerances/statics.py.
struct BalanceLimits {
  double difference;  // between places by which slopes are differenced, either way
  double gain;        // a step is at most this part of the one before
  double rounding;    // or below this
  double enough;      // what may be left
  int steps;          // at most
};

struct BalanceRequest {
  long places;
  const FreeInput* free;
  int free_count;
  const unsigned char* cyclic;  // inputs: those of which whole turns are left out where loops are closed
  double* inputs;               // inputs x places, with whole turns: as guessed, and then as found
  double* states;               // states x places: closed there, likewise
  double* stiffness;            // free x free x places: slopes of the efforts before the last step, or those to go by
  bool is_stiffness_given;
  bool is_first_known;  // the first place is an equilibrium and stays
  BalanceLimits limits;
};

// How many places, from the first one on, come to an equilibrium, each before the next, and with stiffnesses that are
// not given before a determinant changes its sign. `like` has what all rows are given alike or place by place:
// constraint_rates, turned and time, over the places, the wanted outputs, the demand and Newton's limits for closing.
long balance(const Plan& plan, const Request& like, const KernelUnit& unit, int threads, const BalanceRequest& wanted);
