// A closing pair put together from elementary conditions and coordinates.
//
// Its equations, derivatives, multipliers and wrench are those of its conditions one after the other; forces are summed
// before their common point's moment is taken, and moments are added to that.
#pragma once

#include "joints/pair_coordinates.hpp"

namespace {

template <class... All>
struct Conditions;

template <>
struct Conditions<> {
  static constexpr int equations = 0, lengths = 0;
  static constexpr unsigned axes = NO_AXES;
  static MECHKIN_INLINE void residual(const Closure&, Pack*) {}
  static MECHKIN_INLINE void column(const Closure&, Twist, Pack*) {}
  static MECHKIN_INLINE void second(const Closure&, const Motion&, const Motion&, Pack*) {}
  static MECHKIN_INLINE void third(const Closure&, const MotionToJerk&, const MotionToJerk&, Pack*) {}
  template <class Meet>
  static MECHKIN_INLINE void sides(const Closure&, Meet&&) {}
  static MECHKIN_INLINE void add_force(const Closure&, const Pack*, Vec3&) {}
  static MECHKIN_INLINE void add_moment(const Closure&, const Pack*, Wrench&) {}
};

template <class One, class... Rest>
struct Conditions<One, Rest...> {
  using Others = Conditions<Rest...>;
  static constexpr int count = One::equations;
  static constexpr int equations = count + Others::equations, lengths = One::lengths + Others::lengths;
  static constexpr unsigned axes = One::axes | Others::axes;
  static_assert(One::lengths == count || Others::lengths == 0, "lengths come before directions");

  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) {
    One::residual(k, r);
    Others::residual(k, r + count);
  }
  static MECHKIN_INLINE void column(const Closure& k, const Twist& s, Pack* r) {
    One::column(k, s, r);
    Others::column(k, s, r + count);
  }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    One::second(k, a, b, r);
    Others::second(k, a, b, r + count);
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    One::third(k, a, b, r);
    Others::third(k, a, b, r + count);
  }
  template <class Meet>
  static MECHKIN_INLINE void sides(const Closure& k, Meet&& meet) {
    One::sides(k, meet);
    Others::sides(k, meet);
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) {
    static_assert(One::lengths > 0, "a pair holds some length, the first condition says at which point");
    Vec3 force = One::force(k, l);
    Others::add_force(k, l + count, force);
    Wrench w = force_at(One::point(k), force);
    Others::add_moment(k, l + count, w);
    return w;
  }
  static MECHKIN_INLINE void add_force(const Closure& k, const Pack* l, Vec3& force) {
    if constexpr (One::lengths > 0) force += One::force(k, l);
    Others::add_force(k, l + count, force);
  }
  static MECHKIN_INLINE void add_moment(const Closure& k, const Pack* l, Wrench& w) {
    if constexpr (One::lengths == 0) w.moment += One::moment(k, l);
    Others::add_moment(k, l + count, w);
  }
};

// In the order of the pair's freedoms; a pair may leave out the last ones that have no name.
template <class... All>
struct Coordinates {
  // bit f: freedom f has a name
  static constexpr int coordinates() {
    int mask = 0, next = 0;
    ((mask |= has_name<All> << next++), ...);
    return mask;
  }
  // bit f: freedom f is an angle with a name
  static constexpr int turns() {
    int mask = 0, next = 0;
    ((mask |= is_turn<All> << next++), ...);
    return mask;
  }

  static MECHKIN_INLINE unsigned axes_of(int freedom) {
    unsigned axes = NO_AXES;
    int next = 0;
    ((freedom == next++ ? void(axes = All::axes) : void()), ...);
    return axes;
  }
  static MECHKIN_INLINE void coordinate(const Closure& k, const PairMotion& p, int freedom, Pack* out) {
    int next = 0;
    const bool named = ((freedom == next++ ? (All::of(k, p, out), true) : false) || ...);
    if (!named) Nameless::of(k, p, out);
  }
};

template <class TheConditions, class TheCoordinates>
struct Pair : TheConditions, TheCoordinates {
  static constexpr bool is_relation = false;
};

// Entry number I of a list.
template <int I, class First, class... Rest>
struct EntryAt : EntryAt<I - 1, Rest...> {};
template <class First, class... Rest>
struct EntryAt<0, First, Rest...> {
  using type = First;
};

// A list of entries; the code of an entry is its place.
template <class... All>
struct Entries {
  static constexpr int count = sizeof...(All);
  static_assert(count <= 24, "add cases to the switch below");

  template <int CODE, class F>
  static MECHKIN_INLINE void call_one(F&& f) {
    if constexpr (CODE < count) f(typename EntryAt<CODE, All...>::type{});
  }
  // Calls f with the entry of a code: a switch, which costs less than comparing one after the other.
  template <class F>
  static MECHKIN_INLINE void call(int code, F&& f) {
    switch (code) {
      case 0: return call_one<0>(f);
      case 1: return call_one<1>(f);
      case 2: return call_one<2>(f);
      case 3: return call_one<3>(f);
      case 4: return call_one<4>(f);
      case 5: return call_one<5>(f);
      case 6: return call_one<6>(f);
      case 7: return call_one<7>(f);
      case 8: return call_one<8>(f);
      case 9: return call_one<9>(f);
      case 10: return call_one<10>(f);
      case 11: return call_one<11>(f);
      case 12: return call_one<12>(f);
      case 13: return call_one<13>(f);
      case 14: return call_one<14>(f);
      case 15: return call_one<15>(f);
      case 16: return call_one<16>(f);
      case 17: return call_one<17>(f);
      case 18: return call_one<18>(f);
      case 19: return call_one<19>(f);
      case 20: return call_one<20>(f);
      case 21: return call_one<21>(f);
      case 22: return call_one<22>(f);
      case 23: return call_one<23>(f);
    }
  }
};

}  // namespace
