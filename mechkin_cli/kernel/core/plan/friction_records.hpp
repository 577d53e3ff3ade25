// Friction of joints as records of the plan (friction.hpp), and what is known of it in a row.
#pragma once

// Contacts that rub, by what their load is: shares of the radial force and of the tilting couple of a joint, a single
// component, the whole force, or what a relation transmits.
enum ContactCode : int {
  CONTACT_RADIAL = 0,
  CONTACT_ALONG = 1,
  CONTACT_TOTAL = 2,
  CONTACT_TRANSMITTED = 3,
  CONTACT_CODES = 4
};

// One contact of a joint that rubs. With F and M the joint's force and moment about its point, z its axis:
//   RADIAL  | share F_r + tilt M x z |,  F_r = F - (z.F) z
//   ALONG   | share u.F + tilt u.(M x z) + roll z.M |,  u the direction
//   TOTAL   share |F|
//   TRANSMITTED  | share X + roll z.D |,  X the multiplier of the place's relation, D the moment of the friction itself on
//           the second link
template <class Number>
struct ContactOf {
  int code;
  Number weight;             // of its load in the joint's normal load
  Number share, tilt, roll;  // lengths in units
  Number direction[3];       // on the link that carries the friction's axis
};

// Coulomb friction of a joint: a drag against the velocity of its surfaces, the coefficient times its normal load.
// Which motions rub: FreeCode of its turns and its slides, -1 for none. Beside friction stand forces that go by a magnitude,
// too: those with which relations push links apart, of the coefficient 1 and a fixed direction (`pushes`).
template <class Number>
struct FrictionOf {
  int place;
  int turns, slides;
  int link;          // that carries the axis
  int falls;         // whether the coefficient depends on the speed; else it is `sliding`
  int screws;        // whether turn and slide are one motion, by `pitch`
  int course;        // tree joint: the axis is the tangent of its curve, or the normal of its surface; -1: as given
  int pushes;        // no friction, but what the place's relation pushes apart with
  Number axis[3];
  Number radius;     // of the surfaces that turn
  Number pitch;      // of a screw: slide by turn; else 0
  Number at_rest, sliding, speed;  // coefficients, and the speed from one to the other
  int contact_begin, contact_end;  // into Plan::contact
};

// What is known of a joint's friction in a row.
enum FrictionState : int {
  FRICTION_DECIDED = 0,
  FRICTION_AT_REST = 1,     // loaded, and neither a velocity nor an acceleration tells its direction
  FRICTION_NOT_UNIQUE = 2,  // no proof that the loads of the rubbing joints are the only ones
  FRICTION_NOT_SOLVED = 3
};

// What a motion tells a row of a joint's friction: a number, then moment and force that it takes from the second link.
enum FrictionTold : int {
  TOLD_NOTHING = 0,  // it slips: the row's own rates tell
  TOLD_FORCE = 1,    // it sticks, or is just starting to slip
  TOLD_OPEN = 2,     // it sticks by a force that is not unique
  TOLD_IMMOBILE = 3  // so it does, as no coordinate of the motion moves it
};
constexpr int TOLD_NUMBERS = 7;
