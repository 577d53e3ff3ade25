// One arithmetic's copy of the proofs; the build sets MECHKIN_ORDER and MECHKIN_PROVING.
//
// Krawczyk's operator on all unknowns of the mechanism at once (R. Krawczyk, Newton-Algorithmen zur Bestimmung von
// Nullstellen mit Fehlerschranken, Computing 4, 1969): with y the middle of a box X = y + [-r, r] and any matrix C, if
//
//     |C F(y)| + |I - C J(X)| r < r
//
// in every unknown, F has exactly one zero in X. C is block-diagonal, the inverses of the blocks' Jacobians in doubles, so
// that the radii are found block by block: those of one go into the next by |C J| of its columns. Along a curve all of it
// are functions of the parameter, C is linear in it, and the bound is taken over all of its values.
#define MECHKIN_WIDE_PLAN
#include "two_part_plan.hpp"

#include "closing_enclosures.hpp"
#include "inverse_lanes.hpp"

namespace {

// A box is made wider than what is to be found in it by this factor: over it the Jacobian varies.
constexpr double INFLATION = 1.5;
// It is wider than nothing.
constexpr double LEAST_RADIUS = 0x1p-70;
// Steps in which the radii are found; a proof that needs more is too weak to be one.
constexpr int RADIUS_STEPS = 12;
constexpr double CURVE_PLACE = 0.70710678118654752;  // where C is exact on a curve: the least largest error of a line

struct Proof {
  Enclosures at;
  Pack* inverse;      // largest block: size x rows
  Pack* middle;       // states
  Real* lines;        // twice the largest block squared
  Real* size;         // equations: |F(y)|
  Real *radius, *residual;  // columns: r, |C F(y)|
  Real* influence;    // size x columns of the largest block: |I - C J| and |C J|
  double* scalar;     // for one lane's inverse
};

struct Ledger {
  char* at;
  long used = 0;
  template <class T>
  T* take(long count) {
    T* const here = (T*)(at ? at + used : nullptr);
    used += (count * (long)sizeof(T) + 63) / 64 * 64;
    return here;
  }
};

inline Proof lay_out_proof(const Plan& p, Ledger& ledger) {
  Proof w;
  const long equations = equations_of(p), largest = p.largest_block;
  w.at.q = ledger.take<Pack>(p.states);
  w.at.pose = ledger.take<Pose>(p.links);
  w.at.screw = ledger.take<Twist>(p.columns);
  w.at.equation = ledger.take<Pack>(equations);
  w.at.jacobian = ledger.take<Pack>(equations * p.columns);
  w.inverse = ledger.take<Pack>(largest * largest * p.blocks);
  w.middle = ledger.take<Pack>(p.states);
  w.lines = ledger.take<Real>(2 * largest * largest);
  w.size = ledger.take<Real>(equations);
  w.radius = ledger.take<Real>(p.columns);
  w.residual = ledger.take<Real>(p.columns);
  w.influence = ledger.take<Real>(largest * p.columns);
  w.scalar = ledger.take<double>(inverse_numbers(largest));
  return w;
}

struct BlockPart {
  const Block& b;
  int first;       // equation
  Pack* inverse;   // size x rows
};
inline BlockPart part_of_block(const Plan& p, const Proof& w, int index) {
  int first = 0;
  for (int b = 0; b < index; ++b) first += p.block[b].rows;
  return {p.block[index], first, w.inverse + (long)index * p.largest_block * p.largest_block};
}

// The value of a model at a parameter, rounded.
inline Real value_at(const Pack& a, double t) {
  Real sum = a.c[ORDER];
  for (int k = ORDER - 1; k >= 0; --k) sum = sum * Real(t) + a.c[k];
  return sum;
}

// C of a block: at the middle of a point, on a curve the line through its values at two places. The equations that are
// solved for are the same all along.
inline void find_inverse(const Plan& p, Proof& w, const BlockPart& part) {
  const int n = part.b.size, m = part.b.rows;
  const auto at = [&](double t) {
    return [&w, &p, &part, t](int i, int u) {
      return value_at(w.at.jacobian[(part.first + i) * p.columns + p.unknown[part.b.column_begin + u]], t);
    };
  };
  Real *const one = w.lines, *const other = one + n * m;
  invert_lanes(n, m, at(ORDER ? -CURVE_PLACE : 0.0), at(0.0), w.scalar, one);
  if (ORDER) invert_lanes(n, m, at(CURVE_PLACE), at(0.0), w.scalar, other);
  for (int e = 0; e < n * m; ++e) {
    part.inverse[e] = Pack(one[e]);
    if constexpr (ORDER > 0) {
      part.inverse[e].c[0] = Real(0.5) * (one[e] + other[e]);
      part.inverse[e].c[1] = (other[e] - one[e]) * Real(0.5 / CURVE_PLACE);
    }
  }
}

// |C F| into w.residual.
inline void find_residual(const Plan& p, Proof& w, const BlockPart& part) {
  for (int u = 0; u < part.b.size; ++u) {
    Pack sum = 0.0;
    for (int i = 0; i < part.b.rows; ++i) sum += part.inverse[u * part.b.rows + i] * w.at.equation[part.first + i];
    w.residual[p.unknown[part.b.column_begin + u]] = bound(sum);
  }
}

// Whether a column is an unknown of this block or of one before it.
inline bool is_found(const Plan& p, int column, int block) {
  return p.column_block[column] >= 0 && p.column_block[column] <= block;
}

// |I - C J| for the block's own unknowns and |C J| for those of earlier ones into w.influence.
inline void find_influence_of_radii(const Plan& p, Proof& w, const BlockPart& part, int index) {
  for (int u = 0; u < part.b.size; ++u)
    for (int c = 0; c < p.columns; ++c) {
      Real& to = w.influence[u * p.columns + c];
      to = 0.0;
      if (!is_found(p, c, index)) continue;
      Pack sum = c == p.unknown[part.b.column_begin + u] ? -1.0 : 0.0;
      for (int i = 0; i < part.b.rows; ++i)
        sum += part.inverse[u * part.b.rows + i] * w.at.jacobian[(part.first + i) * p.columns + c];
      to = bound(sum);
    }
}

// |C F(y)| + |I - C J| r of one unknown.
inline Real image_radius(const Plan& p, const Proof& w, const BlockPart& part, int u) {
  Real sum = w.residual[p.unknown[part.b.column_begin + u]];
  for (int c = 0; c < p.columns; ++c) sum += w.influence[u * p.columns + c] * w.radius[c];
  return sum * Real(1.0 + 0x1p-40);  // at most 2^10 terms, rounded
}

// A box that has a chance, from the Jacobian at the middle.
template <class Least>
inline void guess_radii(const Plan& p, Proof& w, const BlockPart& part, Least&& least) {
  const int* const unknown = p.unknown + part.b.column_begin;
  for (int u = 0; u < part.b.size; ++u) w.radius[unknown[u]] = w.residual[unknown[u]];
  for (int step = 0; step < RADIUS_STEPS; ++step)
    for (int u = 0; u < part.b.size; ++u) w.radius[unknown[u]] = image_radius(p, w, part, u);
  for (int u = 0; u < part.b.size; ++u) {
    Real& r = w.radius[unknown[u]];
    r = max(r * Real(INFLATION) + Real(LEAST_RADIUS), least(unknown[u]));
  }
}


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

// Calls orientation(first column, first state) for what the blocks find of the tree's balls.
template <class Found>
void each_found_orientation(const Plan& p, Found&& found) {
  for (int b = 0; b < p.blocks; ++b)
    for (int o = p.block[b].joint_begin; o < p.block[b].joint_end; ++o) {
      const TreeJoint& t = p.joints[p.order[o]];
      with_tree_joint(t.type, [&](auto entry) {
        if (entry.states != entry.freedoms && p.column_block[t.column] >= 0) found(t.column, t.state);
      });
    }
}

// The box into w.at.q. The product (1, x / 2) q moves each part of q by halves of the others times x.
void widen_states(const Plan& p, Proof& w) {
  for (int s = 0; s < p.states; ++s) w.at.q[s] = w.middle[s];
  for (int c = 0; c < p.columns; ++c)
    if (p.column_block[c] >= 0 && p.column_state[c] >= 0)
      w.at.q[p.column_state[c]] = widened(w.middle[p.column_state[c]], w.radius[c]);
  each_found_orientation(p, [&](int c, int s) {
    Real size[4], half[3];
    for (int i = 0; i < 4; ++i) size[i] = bound(w.middle[s + i]);
    for (int i = 0; i < 3; ++i) half[i] = Real(0.5) * w.radius[c + i];
    const Real by[4] = {half[0] * size[1] + half[1] * size[2] + half[2] * size[3],
                        half[0] * size[0] + half[1] * size[3] + half[2] * size[2],
                        half[1] * size[0] + half[0] * size[3] + half[2] * size[1],
                        half[2] * size[0] + half[0] * size[2] + half[1] * size[1]};
    for (int i = 0; i < 4; ++i) w.at.q[s + i] = widened(w.middle[s + i], by[i] * Real(OUTWARD));
  });
}

// Columns of an orientation are by rotations omega; increments x have omega = (x' + x/2 x x') / (1 + |x|^2 / 4).
void columns_by_increments(const Plan& p, Proof& w) {
  each_found_orientation(p, [&](int c, int) {
    Real half[3], square = 0.0;
    for (int i = 0; i < 3; ++i) half[i] = Real(0.5) * w.radius[c + i], square += half[i] * half[i];
    for (int e = 0; e < equations_of(p); ++e) {
      Pack* const j = w.at.jacobian + e * p.columns + c;
      const Real size[3] = {bound(j[0]), bound(j[1]), bound(j[2])};
      for (int i = 0; i < 3; ++i) {
        const int k = (i + 1) % 3, l = (i + 2) % 3;
        j[i] = widened(j[i], (square * size[i] + half[l] * size[k] + half[k] * size[l]) * Real(OUTWARD));
      }
    }
  });
}

// At most the size of the equations without a part in C, anywhere in the box.
Real size_beyond(const Plan& p, const Proof& w, const BlockPart& part) {
  Real worst = 0.0;
  if (part.b.rows == part.b.size) return worst;
  for (int i = 0; i < part.b.rows; ++i) {
    Real share = 0.0, size = w.size[part.first + i];
    for (int u = 0; u < part.b.size; ++u) share += polynomial_bound(part.inverse[u * part.b.rows + i]);
    for (int c = 0; c < p.columns; ++c)
      if (p.column_block[c] >= 0) size += bound(w.at.jacobian[(part.first + i) * p.columns + c]) * w.radius[c];
    size = size * Real(1.0 + 0x1p-40);
    worst = select(share > Real(0.0), worst, select(size <= worst, worst, size));  // a NaN wins
  }
  return worst;
}

struct Verdict {
  Mask proven;
  Real contraction, beyond;
};

Verdict judge_boxes(const Plan& p, Proof& w) {
  Verdict verdict = {w.at.side > Real(0.0), 0.0, 0.0};
  for (int b = 0; b < p.blocks; ++b) {
    const BlockPart part = part_of_block(p, w, b);
    find_influence_of_radii(p, w, part, b);
    for (int u = 0; u < part.b.size; ++u) {
      const int column = p.unknown[part.b.column_begin + u];
      const Real image = image_radius(p, w, part, u), r = w.radius[column];
      verdict.proven = verdict.proven & (image < r);
      const Real share = (image - w.residual[column]) / r;
      verdict.contraction = select(share <= verdict.contraction, verdict.contraction, share);
      if (ORDER == 0) w.residual[column] = image;  // the box contracted once
    }
    const Real beyond = size_beyond(p, w, part);
    verdict.beyond = select(beyond <= verdict.beyond, verdict.beyond, beyond);
  }
  return verdict;
}

void prove_pack(const Plan& p, const ProvingRequest& r, Proof& w, long place, int count) {
  for (int s = 0; s < p.states; ++s) w.at.q[s] = w.middle[s] = read(r.states, s, r.places, place, count);
  enclose_closing(p, w.at);
  for (int e = 0; e < equations_of(p); ++e) w.size[e] = bound(w.at.equation[e]);
  for (int c = 0; c < p.columns; ++c) w.radius[c] = w.residual[c] = 0.0;
  for (int b = 0; b < p.blocks; ++b) {
    const BlockPart part = part_of_block(p, w, b);
    find_inverse(p, w, part);
    find_residual(p, w, part);
    find_influence_of_radii(p, w, part, b);
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
  for (long place = 0; place < r.places; place += LANES)
    prove_pack(p, r, w, place, r.places - place < LANES ? (int)(r.places - place) : LANES);
}

const ProvingUnit unit = {PARTS, workspace_size, prove};

}  // namespace

extern "C" const ProvingUnit* MECHKIN_PROVING() { return &unit; }
