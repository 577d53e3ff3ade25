// The loads of joints that rub, from each other (docs/friction.md).
//
// A friction force is its coefficient times a normal load, a normal load a sum of magnitudes of what the contacts carry,
// and that is linear in the friction forces:
//
//     z_k = mu_k N_k(z),    N_k(z) = sum over contacts of weight |base + sum_j gain_j z_j|
//
// Solved by semismooth Newton. With L_kj = mu_k sum weight |gain_j| the right-hand side is a contraction where the
// spectral radius of L is below 1, in the maximum norm weighted by w = (I - L)^-1 1: there is one solution. In that norm the
// residual falls along Newton's step, which is halved where it does not fall enough; z := mu N(z) leads on wherever that
// does not. w > 0 with L w < w proves that radius (Collatz 1942), and is there whenever it is below 1 (Berman and
// Plemmons, Nonnegative Matrices, 1979, chapter 6).
#pragma once

#include "rows/position.hpp"

namespace {

// By how much L w must be below w: far above the rounding of a few dozen sums, far below what tells friction that jams.
constexpr double CONTRACTION_MARGIN = 1e-12;
// Residuals, in parts of the largest friction force: a few roundings of the sums; where Newton gets no further; accepted.
constexpr double FRICTION_TIGHT = PARTS == 1 ? 4e-15 : 2e-30, FRICTION_STALLED = PARTS == 1 ? 1e-12 : 1e-27,
                 FRICTION_ACCEPT = PARTS == 1 ? 1e-10 : 1e-25;
constexpr int FRICTION_ITERATIONS = 60;
// Softness of magnitudes in parts of the loads at which they hardly bend, and steps, two for each halving, to their rounding.
constexpr double FRICTION_SOFTEST = 16.0;
constexpr int FRICTION_LEVELS = 112;
// Part of Newton's step below which z := mu N(z) is taken instead: at kinks of the magnitudes steps of an eighth help.
constexpr double FRICTION_SHORTEST = 1.0 / 1024.0;

MECHKIN_INLINE Pack magnitude(const Vec3& a) { return sqrt(dot(a, a)); }
MECHKIN_INLINE Pack sum_of_components(const Vec3& a) { return abs(a.x) + abs(a.y) + abs(a.z); }
// Whether a contact's load is a single number, which stands in x.
MECHKIN_INLINE bool has_one_component(const Contact& at) {
  return at.code == CONTACT_ALONG || at.code == CONTACT_TRANSMITTED;
}
// At least |a|, at most 1.16 times as much: it is linear wherever one component is the largest, and not below |a| on the
// edges of that region, (1, 0, 0), (1, 1, 0) and (1, 1, 1).
MECHKIN_INLINE Pack above_magnitude(const Vec3& a) {
  constexpr double ROOT_LESS_ONE = 0.4142135623730951;
  return Pack(ROOT_LESS_ONE) * sum_of_components(a) +
         Pack(1.0 - ROOT_LESS_ONE) * max(abs(a.x), max(abs(a.y), abs(a.z)));
}

// The Lipschitz matrix L of the friction forces into r.bound, `size` being at least the length of a vector.
template <int N, class Size>
MECHKIN_INLINE void bound_friction(const Plan& p, const Rubbing& r, Size&& size) {
  const int n = N ? N : p.frictions;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j) {
      Pack sum = 0.0;
      for (int c = p.friction[k].contact_begin; c < p.friction[k].contact_end; ++c)
        sum += Pack(p.contact[c].weight) * size(r.gain[c * n + j]);
      r.bound[k * n + j] = r.coefficient[k] * sum;
    }
}

// Not below the sum of row k of L.
template <int N>
MECHKIN_INLINE Pack coarse_bound(const Plan& p, const Rubbing& r, int k) {
  const int n = N ? N : p.frictions;
  Pack bound = 0.0;
  for (int c = p.friction[k].contact_begin; c < p.friction[k].contact_end; ++c) {
    Pack sum = 0.0;
    for (int j = 0; j < n; ++j) sum += sum_of_components(r.gain[c * n + j]);
    bound += Pack(p.contact[c].weight) * sum;
  }
  return r.coefficient[k] * bound;
}

// Friction k where L w < w.
MECHKIN_INLINE Mask contracts(const Rubbing& r, int n, int k, const Pack* weight) {
  Pack sum = 0.0;
  for (int j = 0; j < n; ++j) sum += r.bound[k * n + j] * weight[j];
  return sum <= Pack(1.0 - CONTRACTION_MARGIN) * weight[k];
}

MECHKIN_INLINE Mask doubtful(const Rubbing& r, int k) { return r.state[k] == Pack((double)FRICTION_NOT_UNIQUE); }

// w = (I - L)^-1 1 into r.step, L from r.bound.
inline void weigh(const Plan& p, const Rubbing& r) {
  const int n = p.frictions;
  for (int k = 0; k < n; ++k) {
    r.step[k] = 1.0;
    for (int j = 0; j < n; ++j) r.matrix[k * n + j] = Pack(k == j ? 1.0 : 0.0) - r.bound[k * n + j];
  }
  const Factors f = {r.matrix, r.swap, n};
  factor(f);
  solve(f, r.step);
}
// Whether these weights, of which only good ones are positive numbers, prove friction k.
MECHKIN_INLINE Mask weights_prove(const Rubbing& r, int n, int k) {
  const Mask finite = (r.step[k] > Pack(0.0)) & (r.step[k] < Pack(__builtin_inf()));
  return finite & contracts(r, n, k, r.step);
}

// As prove_unique, for lanes that are not `proven` yet; the matrix L is in r.bound.
inline void prove_thoroughly(const Plan& p, const Rubbing& r, Mask proven) {
  const int n = p.frictions;
  weigh(p, r);
  Mask all_good = all_lanes(true);
  for (int k = 0; k < n; ++k) {
    const Mask good = proven | weights_prove(r, n, k);
    r.state[k] = select(good, r.state[k], Pack((double)FRICTION_NOT_UNIQUE));
    all_good = all_good & good;
  }
  for (int round = 0; round < n && !all(all_good); ++round)
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j) {
        const Mask follows = doubtful(r, j) & ~(r.bound[k * n + j] == Pack(0.0));
        r.state[k] = select(follows, Pack((double)FRICTION_NOT_UNIQUE), r.state[k]);
      }
  for (int k = 0; k < n; ++k) {
    r.coefficient[k] = select(doubtful(r, k), Pack(0.0), r.coefficient[k]);
    r.weight[k] = select(proven, r.weight[k], select(doubtful(r, k), Pack(1.0), r.step[k]));
  }
}

// The weights w of the norm in which friction contracts; those that no proof holds for, and all that depend on them, are
// marked in r.state and have no friction.
template <int N>
inline void prove_unique(const Plan& p, const Rubbing& r) {
  const int n = N ? N : p.frictions;
  for (int k = 0; k < n; ++k) r.weight[k] = 1.0;
  // by a bound without roots first, and where contacts carry so little of friction that a coarse one mostly does
  Mask plainly = all_lanes(true), weighed = all_lanes(true);
  for (int k = 0; k < n; ++k) plainly = plainly & (coarse_bound<N>(p, r, k) <= Pack(1.0 - CONTRACTION_MARGIN));
  if (all(plainly)) return;
  bound_friction<N>(p, r, [](const Vec3& a) { return above_magnitude(a); });
  plainly = all_lanes(true);
  for (int k = 0; k < n; ++k) plainly = plainly & contracts(r, n, k, r.weight);
  if (all(plainly)) return;
  weigh(p, r);
  for (int k = 0; k < n; ++k) weighed = weighed & weights_prove(r, n, k);
  for (int k = 0; k < n; ++k) r.weight[k] = select(weighed & ~plainly, r.step[k], r.weight[k]);
  const Mask proven = plainly | weighed;
  if (all(proven)) return;
  bound_friction<0>(p, r, [](const Vec3& a) { return magnitude(a); });
  prove_thoroughly(p, r, proven);
}

// Normal loads of the friction forces in r.force, with the contacts' loads and their magnitudes, and mu N - z into r.right.
template <int N, bool SOFT>
inline void load_contacts(const Plan& p, const Rubbing& r) {
  const int n = N ? N : p.frictions;
  Pack own[N ? N : 1];
  for (int k = 0; N && k < n; ++k) own[k] = r.force[k];
  const Pack* const force = N ? own : r.force;
  for (int k = 0; k < n; ++k) {
    Pack normal = 0.0;
    for (int c = p.friction[k].contact_begin; c < p.friction[k].contact_end; ++c) {
      const Vec3* const gain = r.gain + c * n;
      Pack x = r.base[c].x, size;
      for (int j = 0; j < n; ++j) x += force[j] * gain[j].x;
      r.load[c].x = x;
      if (!SOFT && has_one_component(p.contact[c])) {
        size = abs(x);
      } else {
        Pack y = r.base[c].y, z = r.base[c].z;
        for (int j = 0; j < n; ++j) y += force[j] * gain[j].y, z += force[j] * gain[j].z;
        r.load[c].y = y, r.load[c].z = z;
        const Vec3 load = {x, y, z};
        if constexpr (SOFT)
          size = sqrt(dot(load, load) + r.softness * r.softness);
        else
          size = magnitude(load);
      }
      r.size[c] = size;
      normal += Pack(p.contact[c].weight) * size;
    }
    r.normal[k] = normal;
    r.right[k] = r.coefficient[k] * normal - r.force[k];
  }
}

// Row k of Newton's matrix I - mu dN/dz there.
template <int N>
MECHKIN_INLINE void differentiate_load(const Plan& p, const Rubbing& r, int k, Pack* row) {
  const int n = N ? N : p.frictions;
  for (int j = 0; j < n; ++j) row[j] = k == j ? 1.0 : 0.0;
  for (int c = p.friction[k].contact_begin; c < p.friction[k].contact_end; ++c) {
    const Mask none = r.size[c] == Pack(0.0);
    const Pack inverse = select(none, Pack(0.0), Pack(1.0) / select(none, Pack(1.0), r.size[c]));
    const Pack share = r.coefficient[k] * Pack(p.contact[c].weight);
    const Vec3* const gain = r.gain + c * n;
    if (has_one_component(p.contact[c])) {
      const Pack along = inverse * r.load[c].x;
      for (int j = 0; j < n; ++j) row[j] -= share * (along * gain[j].x);
    } else {
      const Vec3 along = inverse * r.load[c];
      for (int j = 0; j < n; ++j) row[j] -= share * dot(along, gain[j]);
    }
  }
}
inline void differentiate_loads(const Plan& p, const Rubbing& r) {
  for (int k = 0; k < p.frictions; ++k) differentiate_load<0>(p, r, k, r.matrix + k * p.frictions);
}

// b := a^-1 b. Where friction contracts the matrix is diagonally dominant, columns in parts of w, and needs no exchange of
// rows (Varga, On recurring theorems on diagonal dominance, 1976).
MECHKIN_INLINE void eliminate(Pack* a, Pack* b, int n) {
  for (int k = 0; k < n; ++k) {
    const Pack inverse = Pack(1.0) / a[k * n + k];
    a[k * n + k] = inverse;
    for (int i = k + 1; i < n; ++i) {
      const Pack l = a[i * n + k] * inverse;
      for (int j = k + 1; j < n; ++j) a[i * n + j] -= l * a[k * n + j];
      b[i] -= l * b[k];
    }
  }
  for (int k = n - 1; k >= 0; --k) {
    for (int j = k + 1; j < n; ++j) b[k] -= a[k * n + j] * b[j];
    b[k] *= a[k * n + k];
  }
}

// r.right := Newton's step.
template <int N>
inline void find_step(const Plan& p, const Rubbing& r) {
  if constexpr (N == 0) {
    differentiate_loads(p, r);
    eliminate(r.matrix, r.right, p.frictions);
  } else {
    // known to be apart
    Pack a[N * N], b[N];
    for (int k = 0; k < N; ++k) differentiate_load<N>(p, r, k, a + k * N);
    for (int k = 0; k < N; ++k) b[k] = r.right[k];
    eliminate(a, b, N);
    for (int k = 0; k < N; ++k) r.right[k] = b[k];
  }
}

// What is left of the equations, and the largest friction force, in the norm in which friction contracts.
struct LeftOver {
  Pack left, scale;
};
template <int N>
inline LeftOver left_over(const Plan& p, const Rubbing& r) {
  const int n = N ? N : p.frictions;
  LeftOver found = {Pack(0.0), Pack(0.0)};
  for (int k = 0; k < n; ++k) {
    const Pack per = r.per_weight[k], part = abs(r.right[k]) * per;
    found.left = select(part <= found.left, found.left, part);  // a NaN wins
    found.scale = max(max(abs(r.force[k]), r.coefficient[k] * r.normal[k]) * per, found.scale);
  }
  return found;
}

// A pack's friction on its way through Newton's method, from r.force on, for lanes that are not `done`.
struct FrictionSearch {
  Rubbing& r;
  Mask done;
  bool over = false;
  // each lane tries a length of Newton's step from `origin`; that of zero stands for z := mu N(z)
  Mask moved = all_lanes(false), solved = all_lanes(false);
  Pack before = __builtin_inf(), length = 0.0;

  // Whether lanes go on by Newton's step.
  template <int N>
  Mask try_forces(const Plan& p) {
    const int n = N ? N : p.frictions;
    load_contacts<N, false>(p, r);
    const LeftOver now = left_over<N>(p, r);
    const Mask back = ~done & (length > Pack(0.0)) & ~(now.left <= (Pack(1.0) - Pack(0.1) * length) * before);
    done = done | (~back & (now.left <= Pack(FRICTION_TIGHT) * now.scale));
    done = done | (back & (before <= Pack(FRICTION_STALLED) * now.scale));
    done = done | ~(now.left < Pack(__builtin_inf()));  // nothing to hope for
    moved = back;
    solved = ~back & (now.left <= Pack(FRICTION_ACCEPT) * now.scale);
    const Mask shorter = back & (length > Pack(FRICTION_SHORTEST)) & ~done;
    const Mask plain = back & ~shorter;
    length = select(shorter, Pack(0.5) * length, Pack(1.0));
    if (any(back)) {
      for (int k = 0; k < n; ++k) {
        r.force[k] = select(shorter, r.origin[k] + length * r.newton[k], r.force[k]);
        r.force[k] = select(plain, r.step[k], r.force[k]);
      }
      length = select(plain, Pack(0.0), length);
    }
    over = all(done);
    const Mask go = ~back & ~done;
    before = select(go, now.left, before);
    return go;
  }
  template <int N>
  void step(const Plan& p, Mask go) {
    const int n = N ? N : p.frictions;
    if (!any(go)) return;
    for (int k = 0; k < n; ++k) {
      r.origin[k] = select(go, r.force[k], r.origin[k]);
      r.step[k] = select(go, r.force[k] + r.right[k], r.step[k]);
    }
    find_step<N>(p, r);
    for (int k = 0; k < n; ++k) {
      r.newton[k] = select(go, r.right[k], r.newton[k]);
      r.force[k] = select(go, r.force[k] + r.right[k], r.force[k]);
    }
  }
};

// Newton's method on the packs that go together, each through every stage of a step: they wait for results, and need not
// wait for each other's. Loads and residuals of all lanes are those of r.force after it.
template <int N>
inline void iterate_friction(const Plan& p, FrictionSearch* pack, int count) {
  Mask go[2];
  bool over = false;
  for (int iteration = 0; iteration < FRICTION_ITERATIONS && !over; ++iteration) {
    over = true;
    for (int k = 0; k < count; ++k) {
      if (!pack[k].over) go[k] = pack[k].template try_forces<N>(p);
      over = over && pack[k].over;
    }
    for (int k = 0; k < count; ++k)
      if (!pack[k].over) pack[k].template step<N>(p, go[k]);
  }
  // where the forces were moved after their loads had been found, or were not found in time
  for (int k = 0; k < count; ++k)
    if (any(pack[k].moved) || !pack[k].over) load_contacts<N, false>(p, pack[k].r);
}

// A start next to the solution for lanes that are not `done`: magnitudes sqrt(|load|^2 + softness^2) have no kinks and the
// same Lipschitz matrix; their solution is followed while the softness falls from far above the loads to their rounding.
MECHKIN_RARE void start_softly(const Plan& p, Rubbing& r, Mask done) {
  const int n = p.frictions;
  Pack size = 0.0;
  for (int c = 0; c < p.contacts; ++c) size = max(size, sum_of_components(r.base[c]));
  for (int k = 0; k < n; ++k) {
    r.origin[k] = r.force[k];
    r.force[k] = select(done, r.force[k], Pack(0.0));
  }
  r.softness = Pack(FRICTION_SOFTEST) * size;
  for (int level = 0; level < FRICTION_LEVELS; ++level) {
    load_contacts<0, true>(p, r);
    find_step<0>(p, r);
    for (int k = 0; k < n; ++k) r.force[k] += r.right[k];
    if (level & 1) r.softness *= Pack(0.5);
  }
  r.softness = 0.0;
  for (int k = 0; k < n; ++k) r.force[k] = select(done, r.origin[k], r.force[k]);
}

// Starts from the loads without friction.
template <int N>
inline void start_friction(const Plan& p, Rubbing& r) {
  const int n = N ? N : p.frictions;
  prove_unique<N>(p, r);
  for (int k = 0; k < n; ++k) {
    r.per_weight[k] = Pack(1.0) / r.weight[k];
    Pack normal = 0.0;
    for (int c = p.friction[k].contact_begin; c < p.friction[k].contact_end; ++c)
      normal += Pack(p.contact[c].weight) * (has_one_component(p.contact[c]) ? abs(r.base[c].x) : magnitude(r.base[c]));
    r.force[k] = r.coefficient[k] * normal;
  }
  r.softness = 0.0;
}
// What Newton's method has not found is sought once more from another start.
template <int N>
inline void judge_solution(const Plan& p, const FrictionSearch& found) {
  if (all(found.solved)) return;
  Rubbing& r = found.r;
  LeftOver last = left_over<N>(p, r);
  Mask solved = last.left <= Pack(FRICTION_ACCEPT) * last.scale;
  if (all(solved)) return;
  start_softly(p, r, solved);
  FrictionSearch again = {r, solved};
  iterate_friction<0>(p, &again, 1);
  last = left_over<N>(p, r);
  solved = last.left <= Pack(FRICTION_ACCEPT) * last.scale;
  for (int k = 0; k < p.frictions; ++k) {
    const Mask open = ~solved & (r.state[k] == Pack((double)FRICTION_DECIDED));
    r.state[k] = select(open, Pack((double)FRICTION_NOT_SOLVED), r.state[k]);
  }
}

// Friction forces into r.force, normal loads into r.normal, FrictionState into r.state where there is no answer, from
// coefficients, base and gain; r.state is FRICTION_DECIDED. Of one pack or of two that go together.
template <int N>
inline void solve_sized_friction(const Plan& p, Rubbing* const* r, int count) {
  for (int k = 0; k < count; ++k) start_friction<N>(p, *r[k]);
  FrictionSearch pack[] = {{*r[0], all_lanes(false)}, {*r[count - 1], all_lanes(false)}};
  iterate_friction<N>(p, pack, count);
  for (int k = 0; k < count; ++k) judge_solution<N>(p, pack[k]);
}
inline void solve_frictions(const Plan& p, Rubbing* const* r, int count) {
  if constexpr (SIZED_BLOCKS) {
    switch (p.frictions) {
      case 1: return solve_sized_friction<1>(p, r, count);
      case 2: return solve_sized_friction<2>(p, r, count);
      case 3: return solve_sized_friction<3>(p, r, count);
      case 4: return solve_sized_friction<4>(p, r, count);
    }
  }
  solve_sized_friction<0>(p, r, count);
}
inline void solve_friction(const Plan& p, Rubbing& r) {
  Rubbing* const one = &r;
  solve_frictions(p, &one, 1);
}

}  // namespace
