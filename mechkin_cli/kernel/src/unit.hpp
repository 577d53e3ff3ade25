// The one entry that each compiled unit of the kernel exports.
#pragma once

#include "plan.hpp"

// The constants of a joint type, read off its entry in the joint table (joints.hpp).
struct JointType {
  const char* letter;
  int freedoms, states;
  int equations;  // as a closing joint; 0: closes no loop
  int slides;     // bit f: freedom f is a length
  bool theta, s;  // coordinates that the user sees
};

struct KernelUnit {
  int lanes;
  const JointType* joint_types;  // JOINT_CODES of them
  long (*workspace_size)(const Plan&);
  void (*run)(const Plan&, const Request&, char* workspace);
  void (*search)(const Plan&, const SearchRequest&, char* workspace);
  void (*elementwise)(int operation, const double* x, const double* y, double* out, long n);
};

extern "C" {
const KernelUnit* mechkin_unit_sse2();
const KernelUnit* mechkin_unit_avx2();
const KernelUnit* mechkin_unit_avx512();
}
