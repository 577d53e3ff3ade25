// The parts of the Python module, each bound in a file of its own.
#pragma once

namespace nanobind {
class module_;
}
struct KernelUnit;

// TreeCode, LoadCode, OutputCode, Demand, RowFlag, TrackEnd, Operation.
void bind_codes(nanobind::module_& m);
// Integration of a motion that is a tape.
void bind_integrator(nanobind::module_& m);
// Responses of plans with a chart; needs the class Plan bound before.
void bind_response(nanobind::module_& m);
// Proofs of positions; needs the class Plan bound before.
void bind_certify(nanobind::module_& m);
// Enclosures of what rows write; needs the class Plan bound before.
void bind_enclosing(nanobind::module_& m);
// Eigenvalues of small matrices.
void bind_eigenvalues(nanobind::module_& m);
// PlanBuilder, Plan, Outputs.
void bind_plan(nanobind::module_& m);
// Numbers and tables as text.
void bind_text(nanobind::module_& m);
// Tapes, and the courses of inputs that are tapes.
void bind_tape(nanobind::module_& m);
void bind_course(nanobind::module_& m);
// The stepper and following rows; single positions; variants. They need the class Plan bound before.
void bind_stepper(nanobind::module_& m);
void bind_positions(nanobind::module_& m);
void bind_variants(nanobind::module_& m);

// The unit of some width; ValueError if this machine does not have it.
const KernelUnit& unit_or_throw(int lanes);
