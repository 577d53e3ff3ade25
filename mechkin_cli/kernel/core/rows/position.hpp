// The closure of the loops, block by block, by Newton's method.
//
// A lane runs until its residual is at rounding level (`tight`) or its last step was so short that what it left is
// below rounding (`coarse`, quadratic convergence). A finished lane is
// frozen, so its bits do not depend on its neighbours.
#pragma once

#include "rows/advance.hpp"
#include "rows/band.hpp"
#include "rows/factors.hpp"
#include "rows/placing.hpp"

namespace {

// The largest closing equation, lengths in parts of the size; `test` the same with the lengths of a loop that reaches
// farther than the size in parts of its reach, since coordinates round by their own size. That one is held against the
// limit and told to the user.
struct Residual {
  Pack size, test;
};

// Largest coordinate of the joints' places.
inline Pack block_reach(const Plan& p, const Workspace& w, const Block& b) {
  Pack reach = 0.0;
  for (int o = b.joint_begin; o < b.joint_end; ++o) {
    const Vec3 at = w.pose[p.order[o]].o;
    reach = max(max(reach, abs(at.x)), max(abs(at.y), abs(at.z)));
  }
  return reach;
}

// Closing equations of a block into w.right.
inline Residual block_residual(const Plan& p, Workspace& w, const Block& b) {
  Pack length = 0.0, direction = 0.0, sum = 0.0;
  closing_equations(p, w, b, [&](auto entry, const Pack* r) __attribute__((always_inline)) {
    for (int i = 0; i < entry.equations; ++i) {
      Pack& worst = i < entry.lengths ? length : direction;
      worst = max(worst, abs(r[i])), sum += abs(r[i]);
    }
  });
  for (int i = b.rows - b.charts; i < b.rows; ++i) sum += abs(w.right[i]);
  length = Pack(p.row_weight) * length;
  Residual worst = {max(length, direction), max(length, direction)};
  const Pack reach = Pack(p.row_weight) * block_reach(p, w, b);
  if (!all(reach <= Pack(1.0))) worst.test = max(Pack(1.0) / max(Pack(1.0), reach) * length, direction);
  for (int i = b.rows - b.charts; i < b.rows; ++i) worst.test = max(worst.test, abs(w.right[i]));
  sum += reach;
  const Mask number = sum == sum;  // a maximum forgets what is none
  worst.size = select(number, worst.size, sum), worst.test = select(number, worst.test, sum);
  return worst;
}

inline Mask block_side_conditions(const Plan& p, const Workspace& w, const Block& b) {
  Mask good = all_lanes(true);
  for (int c = b.closing_begin; c < b.closing_end; ++c)
    with_closing_joint(p.closing[c].type, [&](auto entry) __attribute__((always_inline)) {
      entry.sides(w.closure[c], [&](Pack side) { good = good & (side > Pack(0.0)); });
    });
  return good;
}

// A block's matrices and their factors.
struct BlockMatrices {
  Pack *jacobian, *multiplier, *reflector;
  Mask* swap;
  int m, n;
  const BandRow* row;  // null: a full matrix
  int charts, entries;

  MECHKIN_INLINE Factors lu() const { return {jacobian, swap, n}; }
  MECHKIN_INLINE Reflectors qr() const { return {jacobian, reflector, reflector + n, m, n}; }
  MECHKIN_INLINE Band band() const { return {jacobian, swap, row, n, charts}; }
  int swaps() const { return row ? row[n - 1].swaps : n * (n - 1) / 2; }
  void factor_jacobian() const {
    if (row) return factor(band());
    m == n ? factor(lu()) : reflect(qr());
  }
  Pack least() const {
    if (row) return least_pivot(band());
    return m == n ? least_pivot(lu()) : least_pivot(qr());
  }
  // The sign of the determinant, 1 where there are more equations than unknowns.
  Pack side() const {
    if (row) return determinant_sign(band());
    return m == n ? determinant_sign(lu()) : Pack(1.0);
  }
  // Of the Jacobian that is not factored.
  Pack entry(int equation, int unknown) const {
    const int place = row ? place_in_band(row[unknown], equation, m - charts) : equation * n + unknown;
    return place < 0 ? Pack(0.0) : jacobian[place];
  }
  // The unknowns from the equations' right-hand sides, in place.
  MECHKIN_INLINE void solve_equations(Pack* b) const {
    if (m == 1 && n == 1) {
      *b *= *jacobian;
      return;
    }
    if (row) return solve(band(), b);
    m == n ? solve(lu(), b) : solve(qr(), b);
  }
  // The equations' multipliers from the unknowns' generalised forces, in place.
  MECHKIN_INLINE void solve_multipliers(Pack* b, int shift, Pack level) const {
    if (m == 1 && n == 1) {
      *b *= *jacobian;
      return;
    }
    if (row) return solve_transposed(band(), b);
    m == n ? solve_transposed(lu(), b) : solve_transposed(qr(), b, shift, level);
  }
};
inline BlockMatrices matrices_of(const Plan& p, const Workspace& w, int block) {
  const Block& at = p.block[block];
  const BandRow* const row = at.band_entries ? p.band + at.column_begin : nullptr;
  return {w.jacobian + at.jacobian_at, w.multiplier + at.equation_at, w.reflector + 2 * at.column_begin, w.swap + at.swap_at,
          at.rows, at.size, row, at.charts, row ? at.band_entries : at.rows * at.size};
}

// The Jacobian of a block with a band.
inline void band_jacobian(const Plan& p, Workspace& w, int index, const BlockMatrices& at) {
  const Block& b = p.block[index];
  const Band band = at.band();
  for (int e = 0; e < at.entries; ++e) at.jacobian[e] = 0.0;
  for (int c = b.closing_begin; c < b.closing_end; ++c) {
    const ClosingJoint& j = p.closing[c];
    const Closure& k = w.closure[c];
    with_closing_joint(j.type, [&](auto entry) __attribute__((always_inline)) {
      for (int at = j.columns_begin; at < j.known_begin; ++at) {
        const LoopColumn& met = p.loop_column[at];
        Pack column[entry.equations];
        closing_column(p, w.curve, k, p.loop[met.loop], met.freedom, w.screw[met.column], entry, column);
        for (int i = 0; i < entry.equations; ++i) *band.in_column(met.place, j.row + i) = column[i];
      }
    });
  }
  chart_rows(p, b, w.chart(), w.q, [&](int i, int column, Pack x) {
    const int u = unknown_index(p, index, column);
    if (u >= 0) *band.in_column(u, band.inner() + i) = x;
  });
}
// A block's Jacobian where its factors will be.
inline void find_jacobian(const Plan& p, Workspace& w, int index, const BlockMatrices& at) {
  at.row ? band_jacobian(p, w, index, at) : block_jacobian(p, w, index, at.jacobian);
}

// The joints that Newton moves, which are placed anew in each of its steps; inputs and what they carry stand still.
inline void find_moving(const Plan& p, Workspace& w) {
  for (int k = 0; k < p.links; ++k) w.moves[k] = w.stands[k] = false;
  for (int b = 0; b < p.blocks; ++b)
    for (int o = p.block[b].joint_begin; o < p.block[b].joint_end; ++o) {
      const int k = p.order[o];
      const TreeJoint& j = p.joints[k];
      bool carried = false;  // by a joint that moves with it
      for (int e = p.block[b].joint_begin; e < o; ++e) carried = carried || (p.order[e] == j.parent && w.moves[j.parent]);
      bool moves = carried || j.type == TREE_L;
      with_tree_joint(j.type, [&](auto entry) {
        for (int f = 0; f < entry.freedoms; ++f) moves = moves || unknown_index(p, b, j.column + f) >= 0;
      });
      w.moves[k] = moves;
      w.stands[k] = moves && j.type != TREE_L && j.parent >= 0 && !carried;
    }
}
inline void place_moving(const Plan& p, Workspace& w, const Block& b) {
  for (int o = b.joint_begin; o < b.joint_end; ++o)
    if (const int k = p.order[o]; w.moves[k]) w.stands[k] ? place_standing(p, w, k) : place_joint(p, w, k);
}
inline void moving_screws(const Plan& p, Workspace& w, const Block& b) {
  for (int o = b.joint_begin; o < b.joint_end; ++o)
    if (w.moves[p.order[o]]) find_screws(p, w, p.order[o]);
}
// Moves the states of a block by the increments of its unknowns.
inline void advance_block(const Plan& p, Workspace& w, int index, const Pack* step, Mask moving) {
  const Block& b = p.block[index];
  for (int u = 0; u < b.size; ++u) {
    const int column = p.unknown[b.column_begin + u], state = p.column_state[column];
    if (state >= 0) {
      w.q[state] = select(moving, w.q[state] + step[u], w.q[state]);
      continue;
    }
    // an orientation with the first of its unknowns
    const TreeJoint& t = p.joints[p.column_joint[column]];
    Pack delta[3];
    bool is_first = true;
    for (int f = 0; f < 3; ++f) {
      const int other = unknown_index(p, index, t.column + f);
      delta[f] = other < 0 ? Pack(0.0) : step[other];
      is_first = is_first && (other < 0 || t.column + f >= column);
    }
    if (is_first) advance(Orientation{}, w.q + t.state, delta, moving);
  }
}

// |f| in parts of the scale that the limit of closing equations is measured by:
//
//     reach + HALF_PLACE n sum |x_j| |df/dx_j| / accept
//
// so that a row counts as closed up to accept * reach + what half the last place of each coordinate met moves the
// equation. Of a relation the terms themselves are large and are rounded again in their products and sums, so n is one
// more than their number there, and 1 elsewhere. Reach: 1 for angles; of lengths the size of the mechanism, or of the
// loop that reaches farther. The sum matters to threads, slides and wheels that have gone far and is taken where reach
// alone does not do; lanes are told apart by their own values. w.right, w.closure and the poses are those of the place;
// screws are made here, for those in the workspace may be of a place before.
MECHKIN_RARE Pack residual_with_rounding(const Plan& p, const Workspace& w, const Block& b, double accept) {
  const Pack lengths = Pack(p.row_weight), reach = max(Pack(1.0), lengths * block_reach(p, w, b));
  Pack worst = 0.0;
  for (int c = b.closing_begin; c < b.closing_end; ++c) {
    const ClosingJoint& j = p.closing[c];
    int equations = 0, length_equations = 0;
    Pack half_places = HALF_PLACE;
    with_closing_joint(j.type, [&](auto entry) {
      equations = entry.equations, length_equations = entry.lengths;
      if (entry.is_relation) half_places = Pack(HALF_PLACE) * Pack(double(j.loop_end - j.loop_begin + 1));
    });
    Pack moved[MAX_CLOSING_ROWS];
    for (Pack& m : moved) m = 0.0;
    for (int l = j.loop_begin; l < j.loop_end; ++l) {
      const TreeJoint& t = p.joints[p.loop[l].joint];
      int freedoms = 0, states = 0;
      Twist screw[MAX_CLOSING_ROWS];
      with_tree_joint(t.type, [&](auto tree) __attribute__((always_inline)) {
        freedoms = tree.freedoms, states = tree.states;
        tree.screws(w.pose[p.loop[l].joint], t, pose_of(w, t.parent), w.course + p.loop[l].joint, screw);
      });
      for (int f = 0; f < freedoms; ++f) {
        Pack column[MAX_CLOSING_ROWS];
        with_closing_joint(j.type, [&](auto entry) __attribute__((always_inline)) {
          closing_column(p, w.curve, w.closure[c], p.loop[l], f, screw[f], entry, column);
        });
        // an orientation's quaternion has unit length
        const Pack x = states == freedoms ? abs(w.q[t.state + f]) : Pack(1.0);
        for (int i = 0; i < equations; ++i) moved[i] += half_places * x * abs(column[i]);
      }
    }
    for (int i = 0; i < equations; ++i) {
      const bool length = i < length_equations;
      const Pack weight = length ? lengths : Pack(1.0);
      const Pack scale = (length ? reach : Pack(1.0)) + weight * moved[i] / Pack(accept);
      const Pack part = weight * abs(w.right[j.row + i]) / scale;
      worst = select(part <= worst, worst, part);  // a NaN wins
    }
  }
  return worst;
}

struct Closed {
  Pack residual, correction;
  Pack last_step;  // the step that the factors left behind belong to, infinite where there are none
  Mask converged, side;
};

// A closed block of one pack on its way to its verdict.
struct Judged {
  Judged(Workspace& at, const Closed& of) : w(at), closed(of) {}
  Workspace& w;
  const Closed& closed;
  Pack side, condition;  // sign of a square block's determinant; no number where none is wanted
};

inline void keep_factors(Workspace& w, const BlockMatrices& at) {
  for (int e = 0; e < at.entries; ++e) w.kept[e] = at.jacobian[e];
  for (int s = 0; s < at.swaps(); ++s) w.kept_swap[s] = at.swap[s];
}
inline void take_back_factors(const Workspace& w, const BlockMatrices& at, Mask done) {
  for (int e = 0; e < at.entries; ++e) at.jacobian[e] = select(done, w.kept[e], at.jacobian[e]);
  for (int s = 0; s < at.swaps(); ++s)
    at.swap[s] = (done & w.kept_swap[s]) | (~done & at.swap[s]);
}

// A Newton step (rad, length units) that no residual at rounding level gives where the condition is below 1e8.
constexpr double LONG_STEP = 1e-6;

inline Pack largest(const Pack* step, int size) {
  Pack length = 0.0;
  for (int u = 0; u < size; ++u) length = select(abs(step[u]) <= length, length, abs(step[u]));  // a NaN wins
  return length;
}

// The second step with the factors of the first, whose length was `before`, into `step`; where it may be the last. One of
// length a leaves 2 a^2 / before, where Newton's last one may leave coarse^2.
inline Mask step_again(const Workspace& w, const BlockMatrices& at, Pack before, double coarse, Pack* step) {
  for (int i = 0; i < at.m; ++i) step[i] = w.right[i];
  at.solve_equations(step);
  const Pack length = largest(step, at.n);
  return Pack(2.0) * length * length <= Pack(coarse) * Pack(coarse) * before;
}

// Newton's method on a block for one pack of rows.
struct Closing {
  explicit Closing(Workspace& at) : w(at) {}
  Workspace& w;
  bool over = false;
  Mask polished = all_lanes(false), done = all_lanes(false), again = all_lanes(false);
  Residual residual;
  Pack correction = 0.0, last_step = __builtin_inf();
};

// Moves a pack by the step in w.right, or, where the factors of the step before serve again, by that in w.scratch.
template <bool AGAIN>
inline void take_step(const Plan& p, Closing& c, int index, const Request& r, int iteration) {
  Workspace& w = c.w;
  const int size = p.block[index].size;
  if (AGAIN && iteration == 1)
    for (int u = 0; u < size; ++u) w.right[u] = select(c.again, w.scratch[u], w.right[u]);
  for (int u = 0; u < size; ++u) w.right[u] = -w.right[u];
  const Pack length = largest(w.right, size);
  c.last_step = select(c.done, iteration ? c.last_step : Pack(0.0), length);
  c.polished = c.again | (length <= Pack(r.coarse));
  // where the Jacobian is singular there is no step: the lane stays where it is (NaN, infinity, or 1e100, whose
  // products would soon be infinite)
  c.done = c.done | ~(length < Pack(1e100));
  // a closed place whose step is yet long is singular, and the step is rounding
  c.done = c.done | ((c.residual.test <= Pack(r.accept)) & (length > Pack(LONG_STEP)));
  c.correction += select(c.done, Pack(0.0), length);
  advance_block(p, w, index, w.right, ~c.done);
}

// Newton's first step on relations alone, before anything is placed.
inline void step_unplaced(const Plan& p, Closing& c, int index, const Request& r) {
  Workspace& w = c.w;
  const BlockMatrices at = matrices_of(p, w, index);
  closing_equations(p, w, p.block[index], [](auto, const Pack*) {});
  find_jacobian(p, w, index, at);
  at.factor_jacobian();
  at.solve_equations(w.right);
  c.residual.test = __builtin_inf();
  take_step<false>(p, c, index, r, 0);
}

// Closes one block from the guesses in the packs' w.q, all of them through each stage of a step: they meet its
// instructions in the cache, and one is begun while another waits for its results. With `AGAIN` factors serve two steps
// where they are good enough, which pays where no condition is wanted of them.
template <bool AGAIN>
inline void close_packs(const Plan& p, Closing* pack, int count, int index, const Request& r) {
  const Block& b = p.block[index];
  const bool square = b.rows == b.size;
  // a lane's factors must not depend on how long its neighbours go on
  const bool keeps_factors = square && r.demand == DEMAND_CONDITION;
  const auto each = [&](auto&& stage) __attribute__((always_inline)) {
    for (Closing* c = pack; c < pack + count; ++c)
      if (!c->over) stage(*c);
  };
  if (r.iterations > 0 && b.placeless) each([&](Closing& c) { step_unplaced(p, c, index, r); });
  for (int iteration = 0;; ++iteration) {
    each([&](Closing& c) { iteration ? place_moving(p, c.w, b) : place_block(p, c.w, b); });
    bool over = true;
    each([&](Closing& c) {
      c.residual = block_residual(p, c.w, b);
      // a short step leaves its square times condition and curvature, which may yet be too much
      c.done = c.done | (c.polished & (c.residual.test <= Pack(r.accept))) | (c.residual.test <= Pack(r.tight));
      c.over = (all(c.done) && !(keeps_factors && iteration == 0)) || iteration == r.iterations;
      over = over && c.over;
    });
    if (over) return;
    each([&](Closing& c) {
      c.again = all_lanes(false);
      const BlockMatrices at = matrices_of(p, c.w, index);
      if (AGAIN && iteration == 1) c.again = step_again(c.w, at, c.last_step, r.coarse, c.w.scratch);
      if (AGAIN && all(c.again | c.done)) return;
      moving_screws(p, c.w, b);
      const bool keep = keeps_factors && iteration > 0 && any(c.done);
      if (keep) keep_factors(c.w, at);
      find_jacobian(p, c.w, index, at);
      at.factor_jacobian();
      at.solve_equations(c.w.right);
      if (keep) take_back_factors(c.w, at, c.done);
    });
    each([&](Closing& c) { take_step<AGAIN>(p, c, index, r, iteration); });
  }
}

// What became of a pack of rows.
inline Closed closed_block(const Plan& p, Closing& c, int index, const Request& r) {
  const Block& b = p.block[index];
  Residual& residual = c.residual;
  const Mask near = residual.test <= Pack(r.accept);
  if (!all(near) && r.accept > 0.0)
    residual.test = select(near, residual.test, residual_with_rounding(p, c.w, b, r.accept));
  return {residual.test, c.correction, c.last_step, residual.test <= Pack(r.accept), block_side_conditions(p, c.w, b)};
}

// The coefficient of an explicit block's unknown, which is the same at all places.
inline Pack explicit_slope(const Plan& p, const Workspace& w, int index) {
  const ClosingJoint& j = p.closing[p.block[index].closing_begin];
  for (int l = j.loop_begin;; ++l) {
    const int freedom = p.term[p.loop[l].term].freedom;
    if (freedom >= 0 && p.joints[p.loop[l].joint].column + freedom == p.unknown[p.block[index].column_begin])
      return slope_by_freedom(p, w.curve, p.loop[l], freedom);
  }
}
// Closes an explicit block: its relation gives the unknown, whatever the guess, before anything is placed. It leaves the
// factor of its place, which is that of all.
inline Closed close_explicitly(const Plan& p, Workspace& w, int index, const Request& r) {
  const Block& b = p.block[index];
  const ClosingJoint& j = p.closing[b.closing_begin];
  Pack& unknown = w.q[p.column_state[p.unknown[b.column_begin]]];
  const Pack slope = explicit_slope(p, w, index), guess = unknown;
  *matrices_of(p, w, index).jacobian = Pack(1.0) / slope;
  Mask there = all_lanes(true);
  find_curves(p, j, w.q, 1, w.function, w.curve);
  // the curves are those of its other terms
  const auto equation = [&] {
    closing_residual(p, w.q, w.curve, j, w.closure[b.closing_begin], Relation<0>{}, w.right);
    return w.right[0];
  };
  if (r.iterations > 0) {
    unknown = 0.0;
    const Pack found = -equation() / slope;
    there = abs(found) < Pack(1e100);  // else it has no slope: the lane stays where it is, as in take_step
    unknown = select(there, found, guess);
  }
  place_block(p, w, b);
  Pack residual = 0.0;
  for (int again = 0;; ++again) {
    residual = j.type == RELATION_OF_LENGTHS ? block_residual(p, w, b).test : abs(equation());
    const Mask near = residual <= Pack(r.accept);
    if (all(near) || !(r.accept > 0.0)) break;
    residual = select(near, residual, residual_with_rounding(p, w, b, r.accept));
    const Mask closed = ~there | (residual <= Pack(r.accept));
    if (all(closed) || again >= r.iterations) break;
    unknown = select(closed, unknown, unknown - w.right[0] / slope);
    place_block(p, w, b);
  }
  return {residual, abs(unknown - guess), 0.0, residual <= Pack(r.accept), all_lanes(true)};
}

// Closes one block of one pack.
template <bool AGAIN>
inline Closed close_block(const Plan& p, Workspace& w, int index, const Request& r) {
  if (p.block[index].is_explicit) return close_explicitly(p, w, index, r);
  Closing c(w);
  close_packs<AGAIN>(p, &c, 1, index, r);
  return closed_block(p, c, index, r);
}

}  // namespace
