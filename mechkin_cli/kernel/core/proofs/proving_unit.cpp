// One arithmetic's copy of the proofs; the build sets MECHKIN_ORDER and MECHKIN_PROVING.
#define MECHKIN_WIDE_PLAN
#include "plan/parted_plan.hpp"

#include "proofs/krawczyk.hpp"
#include "proofs/orientation_boxes.hpp"

namespace {

Pack read(const double* base, long number, long places, long place, int count) {
  Real part[PARTS];
  for (int k = 0; k < PARTS; ++k) {
    double lanes[LANES];
    for (int i = 0; i < LANES; ++i) lanes[i] = base[(PARTS * number + k) * places + place + (i < count ? i : count - 1)];
    part[k] = load(lanes);
  }
  return from_parts(part);
}
void write(double* base, long number, long places, long place, int count, Real x) {
  for (int i = 0; i < count; ++i) base[number * places + place + i] = lane(x, i);
}

void prove_pack(const Plan& p, const ProvingRequest& r, Proof& w, long place, int count) {
  for (int s = 0; s < p.states; ++s) w.at.q[s] = w.middle[s] = read(r.states, s, r.places, place, count);
  enclose_closing(p, w.at);
  for (int e = 0; e < equations_of(p); ++e) w.size[e] = bound(w.at.equation[e]);
  for (int c = 0; c < p.columns; ++c) w.radius[c] = w.residual[c] = 0.0;
  for (int b = 0; b < p.blocks; ++b) {
    const BlockPart part = part_of_block(p, b);
    find_inverse(p, w, part);
    find_residual(p, w, part);
    find_influence_of_radii(p, w, part);
    guess_radii(p, w, part, [&](int c) {
      double lanes[LANES];
      for (int i = 0; i < LANES; ++i) lanes[i] = r.least ? r.least[c * r.places + place + (i < count ? i : count - 1)] : 0.0;
      return load(lanes);
    });
  }
  widen_states(p, w);
  enclose_closing(p, w.at);
  columns_by_increments(p, w);
  const Verdict verdict = judge_boxes(p, w);
  for (int c = 0; c < p.columns; ++c)
    write(r.radius, c, r.places, place, count, ORDER == 0 ? w.residual[c] : w.radius[c]);
  write(r.contraction, 0, r.places, place, count, verdict.contraction);
  write(r.beyond, 0, r.places, place, count, verdict.beyond);
  for (int i = 0; i < count; ++i) r.proven[place + i] = lane(verdict.proven, i);
}

long workspace_size(const LanePlan& given) {
  Ledger ledger = {nullptr};
  Plan p = {};
  static_cast<PlanShape&>(p) = given;
  lay_out_proof(p, ledger);
  return ledger.used + join_parts(given, nullptr, nullptr) + 64;
}

void prove(const LanePlan& given, const LanePlan* radii, const ProvingRequest& r, char* memory) {
  char* const plan = memory + (64 - (std::uintptr_t)memory % 64) % 64;
  Ledger ledger = {plan + join_parts(given, radii, plan)};
  const Plan& p = *reinterpret_cast<const Plan*>(plan);
  Proof w = lay_out_proof(p, ledger);
  w.follows = r.follows;
  find_dependence(p, w);
  for (long place = 0; place < r.places; place += LANES)
    prove_pack(p, r, w, place, r.places - place < LANES ? (int)(r.places - place) : LANES);
}

const ProvingUnit unit = {PARTS, workspace_size, prove};

}  // namespace

extern "C" const ProvingUnit* MECHKIN_PROVING() { return &unit; }
