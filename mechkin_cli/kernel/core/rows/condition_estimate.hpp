// The largest singular value of the inverse of a factored and weighted square matrix, to 1 %.
//
// With B the inverse and G = B^T B over its trace, the sixteenth power of G (by repeated squaring) is nearly the
// projector on its dominant directions, and the largest eigenvalue follows from its traces, for every spectrum: there
// is no starting vector that could miss a direction, and clusters of singular values do no harm.
#pragma once

#include <utility>

#include "arithmetic/linear.hpp"

namespace {

// Calls f with 0, 1 ... N - 1 as constants: what is written N times lets a matrix stand in registers.
template <int... K, class F>
MECHKIN_INLINE void each_constant(std::integer_sequence<int, K...>, F&& f) {
  (f(std::integral_constant<int, K>()), ...);
}
template <int N, class F>
MECHKIN_INLINE void each_of(F&& f) {
  each_constant(std::make_integer_sequence<int, N>(), f);
}
// C = U^-1 L^-1 D^-1 for the factors P A = L U, D the equations' weights in the order of the pivots; row i
// of C over the weight of unknown i. Its singular values are those of the inverse of the weighted matrix.
inline void weighted_inverse(const Pack* a, const Mask* swap, int n, Pack* inverse_weight, const double* column_weight,
                             const int* unknown, Pack* c) {
  int s = 0;
  for (int k = 0; k < n; ++k)
    for (int i = k + 1; i < n; ++i) {
      const Mask swapped = swap[s++];
      const Pack x = inverse_weight[k], y = inverse_weight[i];
      inverse_weight[k] = select(swapped, y, x);
      inverse_weight[i] = select(swapped, x, y);
    }
  for (int j = 0; j < n; ++j) {
    c[j * n + j] = inverse_weight[j];
    for (int i = 0; i < j; ++i) c[i * n + j] = 0.0;
    for (int i = j + 1; i < n; ++i) {
      Pack sum = 0.0;
      for (int k = j; k < i; ++k) sum -= a[i * n + k] * c[k * n + j];
      c[i * n + j] = sum;
    }
  }
  for (int i = n - 1; i >= 0; --i)
    for (int j = 0; j < n; ++j) {
      Pack sum = c[i * n + j];
      for (int k = i + 1; k < n; ++k) sum -= a[i * n + k] * c[k * n + j];
      c[i * n + j] = sum * a[i * n + i];
    }
  for (int i = 0; i < n; ++i) {
    const Pack scale = 1.0 / column_weight[unknown[i]];
    for (int j = 0; j < n; ++j) c[i * n + j] *= scale;
  }
}

// The same of known size without the division by the unknowns' weights, written out, so that what is yet needed stays in
// registers.
template <int N>
MECHKIN_INLINE void small_inverse(const Pack* a, const Mask* swap, const Pack* inverse_weight, Pack* c) {
  Pack weight[N];
  for (int i = 0; i < N; ++i) weight[i] = inverse_weight[i];
  each_of<N>([&](auto k) __attribute__((always_inline)) {
    each_of<N - 1 - k()>([&](auto off) __attribute__((always_inline)) {
      constexpr int i = k() + 1 + off();
      const Mask swapped = swap[k() * N - k() * (k() + 1) / 2 + off()];
      const Pack x = weight[k()], y = weight[i];
      weight[k()] = select(swapped, y, x);
      weight[i] = select(swapped, x, y);
    });
  });
  each_of<N>([&](auto j) __attribute__((always_inline)) {
    c[j() * N + j()] = weight[j()];
    each_of<N - 1 - j()>([&](auto off) __attribute__((always_inline)) {
      constexpr int i = j() + 1 + off();
      Pack sum = -(a[i * N + j()] * c[j() * N + j()]);
      each_of<off()>([&](auto k) __attribute__((always_inline)) {
        constexpr int at = j() + 1 + k();
        sum -= a[i * N + at] * c[at * N + j()];
      });
      c[i * N + j()] = sum;
    });
  });
  each_of<N>([&](auto from_last) __attribute__((always_inline)) {
    constexpr int i = N - 1 - from_last();
    each_of<N>([&](auto j) __attribute__((always_inline)) {
      Pack sum = i < j() ? Pack(0.0) : c[i * N + j()];
      each_of<from_last()>([&](auto off) __attribute__((always_inline)) {
        constexpr int k = i + 1 + off();
        sum -= a[i * N + k] * c[k * N + j()];
      });
      c[i * N + j()] = sum * a[i * N + i];
    });
  });
}

// Packs whose estimates are made together.
constexpr int PACKS_OF_ESTIMATE = 2;

// Half as wide numbers, of two packs in the room of one: seven digits are plenty for 1 %, and the powers below take half
// the time.
typedef float HalfSingles __attribute__((vector_size(4 * LANES)));
typedef float Singles __attribute__((vector_size(PACKS_OF_ESTIMATE * 4 * LANES)));
MECHKIN_INLINE void put_half(Singles& a, int k, HalfSingles x) {
  __builtin_memcpy(reinterpret_cast<char*>(&a) + k * sizeof x, &x, sizeof x);
}
MECHKIN_INLINE Pack half_of(const Singles& a, int k) {
  HalfSingles x;
  __builtin_memcpy(&x, reinterpret_cast<const char*>(&a) + k * sizeof x, sizeof x);
  return Pack(__builtin_convertvector(x, Doubles));
}
MECHKIN_INLINE Singles root(Singles a) {
  Singles r;
  for (int i = 0; i < PACKS_OF_ESTIMATE * LANES; ++i) r[i] = __builtin_sqrtf(a[i]);
  return r;
}
MECHKIN_INLINE Doubles root(Doubles a) { return sqrt(Pack(a)).v; }
MECHKIN_INLINE Singles larger(Singles a, Singles b) { return a < b ? b : a; }
MECHKIN_INLINE Doubles larger(Doubles a, Doubles b) { return a < b ? b : a; }

// out = a^T a, symmetric (n x n); returns its trace.
template <class Numbers>
inline Numbers gram(const Numbers* a, int n, Numbers* out) {
  Numbers trace = {};
  for (int i = 0; i < n; ++i)
    for (int j = i; j < n; ++j) {
      Numbers sum = a[i] * a[j];
      for (int k = 1; k < n; ++k) sum += a[k * n + i] * a[k * n + j];
      out[i * n + j] = sum, out[j * n + i] = sum;
      if (i == j) trace += sum;
    }
  return trace;
}

// An entry of a symmetric matrix of which the upper half is there.
template <int N>
constexpr int upper(int i, int j) { return i < j ? i * N + j : j * N + i; }

// The upper half of a^T a, a of known size, or with SYMMETRIC of known size and by its upper half; returns its trace.
template <int N, bool SYMMETRIC, class Numbers>
MECHKIN_INLINE Numbers upper_gram(const Numbers* a, Numbers* out) {
  Numbers trace = {};
  const auto entry = [a](int k, int i) __attribute__((always_inline)) { return a[SYMMETRIC ? upper<N>(k, i) : k * N + i]; };
  each_of<N>([&](auto i) __attribute__((always_inline)) {
    each_of<N - i()>([&](auto off) __attribute__((always_inline)) {
      constexpr int row = i(), column = i() + off();
      Numbers sum = entry(0, row) * entry(0, column);
      each_of<N - 1>([&](auto k) __attribute__((always_inline)) { sum += entry(k() + 1, row) * entry(k() + 1, column); });
      out[upper<N>(row, column)] = sum;
      if constexpr (off() == 0) trace += sum;
    });
  });
  return trace;
}

// The factor t of T2 = l^2p t, l the largest eigenvalue, from the traces T1 and T2 of the powers p and 2 p of a
// symmetric matrix. r = T1^2 / T2 counts the eigenvalues that matter; for a given r, t lies between r (r equal
// eigenvalues) and 1 + (n - 1) y^2 (one above n - 1 equal ones). The middle is off by at most a factor of 1.72 for
// n = 6, and the error of the singular value is the 4 p-th root of that: 0.9 % for p = 16.
template <class Numbers>
MECHKIN_INLINE Numbers multiplicity(Numbers t1, Numbers t2, int n) {
  const Numbers none = {}, one = none + 1, others = none + (float)(n - 1);
  const Numbers r = larger(one, t1 * t1 / t2);
  const Numbers y = (r - one) / (others + root(larger(none, others * others + (r - one) * others * (others - r))));
  return n == 1 ? one : root(r * (one + others * y * y));
}

// The largest eigenvalue from the traces after so many squarings.
template <class Numbers>
MECHKIN_INLINE Numbers eigenvalue_of(Numbers t1, Numbers t2, int n, int squarings) {
  Numbers value = t2 / multiplicity(t1, t2, n);
  for (int s = 0; s <= squarings; ++s) value = root(value);
  return value;
}
// The largest eigenvalue of a symmetric matrix (n x n, of trace 1), to 2 %; both arrays are room for powers.
template <class Numbers>
inline Numbers largest_eigenvalue(Numbers* power, Numbers* other, int n) {
  const int squarings = n > 6 ? 5 : 4;
  Numbers t1 = {}, t2 = {};
  for (int s = 0; s < squarings; ++s) {
    t1 = gram(power, n, other);
    Numbers* const before = power;
    power = other, other = before;
  }
  for (int e = 0; e < n * n; ++e) t2 += power[e] * power[e];
  return eigenvalue_of(t1, t2, n, squarings);
}

// The sum of the squares of a symmetric matrix's entries, the trace of its square, by the upper half.
template <int N, class Numbers>
MECHKIN_INLINE Numbers square_sum(const Numbers* a) {
  Numbers diagonal = {}, above = {};
  each_of<N>([&](auto i) __attribute__((always_inline)) {
    each_of<N - i()>([&](auto off) __attribute__((always_inline)) {
      const Numbers x = a[upper<N>(i(), i() + off())];
      if constexpr (off() == 0)
        diagonal += x * x;
      else
        above += x * x;
    });
  });
  return diagonal + (above + above);
}

// The part of the largest eigenvalue's power p up to which those of all others together are passed over: with their sum s in
// parts of it and q, at most s^2, the sum of their squares, T1^2 / T2 = (1 + s)^2 / (1 + q), and T2 is the largest one's but
// for q: 1e-4, whose 4 p-th root is lost in a singular value, 6e-6 for p = 4.
constexpr double PASSED_OVER = 0.01;

// The largest eigenvalue of a small symmetric matrix of trace 1 by its upper half, of packs in the halves: to 2 %, and to
// 1e-5 where it is found by a lower power since it is far above the others, which spares most packs a squaring or two.
struct LargestOfSmall {
  Singles value = {};
  Mask found[PACKS_OF_ESTIMATE] = {all_lanes(false), all_lanes(false)};

  // Takes what lanes tell by the traces of a power and its square that were not found before; whether that is all of them.
  MECHKIN_INLINE bool take_far_ones(Singles t1, Singles t2, int squarings) {
    const Singles square = t1 * t1;
    Singles now = t2;
    for (int s = 0; s <= squarings; ++s) now = root(now);
    Mask everywhere = all_lanes(true);
    for (int k = 0; k < PACKS_OF_ESTIMATE; ++k) {
      const Mask far = half_of(square, k) <= Pack(1.0 + 2.0 * PASSED_OVER) * half_of(t2, k);
      take(k, now, far);
      everywhere = everywhere & found[k];
    }
    return all(everywhere);
  }
  MECHKIN_INLINE void take(int k, Singles now, Mask these) {
    const Pack mine = select(these & ~found[k], half_of(now, k), half_of(value, k));
    put_half(value, k, __builtin_convertvector(mine.v, HalfSingles));
    found[k] = found[k] | these;
  }
};
template <int N>
MECHKIN_INLINE Singles largest_eigenvalue_of_small(Singles* power) {
  static_assert(N <= 6);
  Singles other[N * N];
  LargestOfSmall largest;
  upper_gram<N, true>(power, other);
  Singles t1 = upper_gram<N, true>(other, power);
  if (largest.take_far_ones(t1, square_sum<N>(power), 2)) return largest.value;
  t1 = upper_gram<N, true>(power, other);
  if (largest.take_far_ones(t1, square_sum<N>(other), 3)) return largest.value;
  t1 = upper_gram<N, true>(other, power);
  Singles t2 = {};
  each_of<N>([&](auto i) __attribute__((always_inline)) {
    each_of<N>([&](auto j) __attribute__((always_inline)) {
      const Singles x = power[upper<N>(i(), j())];
      t2 += x * x;
    });
  });
  const Singles last = eigenvalue_of(t1, t2, N, 4);
  for (int k = 0; k < PACKS_OF_ESTIMATE; ++k) largest.take(k, last, all_lanes(true));
  return largest.value;
}

// The largest singular value of the inverse of diag(1 / inverse_weight) A diag(column_weight), A as factored.
struct InverseNorm {
  Factors f;
  Pack* inverse_weight;  // n, used up
  Pack* scratch;         // room for 3 n x n
  Pack value;
};

template <int N>
MECHKIN_INLINE void estimate_together(InverseNorm* pack, int count, const double* column_weight, const int* unknown) {
  static_assert(N > 0);
  Singles power[N * N];
  Pack trace[PACKS_OF_ESTIMATE];
  for (int k = 0; k < count; ++k) {
    Pack c[N * N], g[N * N];
    small_inverse<N>(pack[k].f.a, pack[k].f.swap, pack[k].inverse_weight, c);
    each_of<N>([&](auto i) __attribute__((always_inline)) {
      const Pack scale = 1.0 / column_weight[unknown[i()]];
      each_of<N>([&](auto j) __attribute__((always_inline)) { c[i() * N + j()] *= scale; });
    });
    trace[k] = upper_gram<N, false>(&c->v, &g->v);
    // the largest eigenvalue is now between 1 / n and 1
    const Pack inverse = Pack(1.0) / trace[k];
    each_of<N>([&](auto i) __attribute__((always_inline)) {
      each_of<N - i()>([&](auto off) __attribute__((always_inline)) {
        constexpr int e = upper<N>(i(), i() + off());
        put_half(power[e], k, __builtin_convertvector((g[e] * inverse).v, HalfSingles));
      });
    });
  }
  if (count < PACKS_OF_ESTIMATE)
    for (int e = 0; e < N * N; ++e) put_half(power[e], 1, HalfSingles{} + 1);
  const Singles value = largest_eigenvalue_of_small<N>(power);
  for (int k = 0; k < count; ++k) pack[k].value = sqrt(half_of(value, k) * trace[k]);
}

inline void estimate_alone(InverseNorm& pack, const double* column_weight, const int* unknown) {
  const int n = pack.f.n;
  Pack *const c = pack.scratch, *const g = c + n * n;
  weighted_inverse(pack.f.a, pack.f.swap, n, pack.inverse_weight, column_weight, unknown, c);
  const Pack trace = gram(&c->v, n, &g->v), inverse = Pack(1.0) / trace;
  for (int e = 0; e < n * n; ++e) g[n * n + e] = g[e] * inverse;
  pack.value = sqrt(Pack(largest_eigenvalue(&g[n * n].v, &c->v, n)) * trace);
}

inline void find_inverse_norms(InverseNorm* pack, int count, const double* column_weight, const int* unknown) {
  switch (pack->f.n) {
    case 1: return estimate_together<1>(pack, count, column_weight, unknown);
    case 2: return estimate_together<2>(pack, count, column_weight, unknown);
    case 3: return estimate_together<3>(pack, count, column_weight, unknown);
    case 4: return estimate_together<4>(pack, count, column_weight, unknown);
    case 5: return estimate_together<5>(pack, count, column_weight, unknown);
    case 6: return estimate_together<6>(pack, count, column_weight, unknown);
  }
  for (int k = 0; k < count; ++k) estimate_alone(pack[k], column_weight, unknown);
}

}  // namespace
