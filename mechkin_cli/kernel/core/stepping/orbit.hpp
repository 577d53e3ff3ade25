// What whole turns of an input leave as it was: a branch that comes back to where it began is followed once.
//
// The turns of a straight path whose leading input is an angle are followed one by one. A block of unknowns that stands
// after p turns where it stood at the start, and so do the blocks that it depends on, repeats itself from there on: its
// rows are filled in between the nodes of the first p turns, at the place that the input's angle within half a turn
// tells. Equal angles so get guesses that are equal in every bit. Whole turns, and signs of quaternions, go on by what a
// period adds. A thread or a slide that advances with each turn never comes back, and what hangs on it is followed on.
#pragma once

#include "stepping/tracker.hpp"

// Which states and turn slots are filled in; those of all blocks, or of some.
struct Chosen {
  std::vector<char> state, slot;
};

class Orbit {
 public:
  // Turns that are looked over for a period.
  static constexpr int MOST_TURNS = 16;
  // How far states (rad, length units) may miss their first place and still be there.
  static constexpr double SAME_PLACE = 1e-12;

  // Begins at a node with reduced angles; `whole`: turns of the leading input there; `sense`: its direction, 1 or -1.
  Orbit(const Stepper& stepper, const Node& start, int leading, double sense, double whole);

  // Takes the stretches of the next turn; `end` is its last node, reduced. `inputs_return`: whether all inputs are back.
  void add_turn(std::vector<Segment> stretches, const Node& end, bool inputs_return);
  // Whether the turns are to be recorded further, and whether everything repeats itself.
  bool records() const { return !common_ && (int)turns_.size() < MOST_TURNS; }
  bool complete() const { return common_ > 0; }
  bool repeats_some() const;

  // Where a row lies: whole turns from the start, and the rest (0 to a full turn).
  struct Place {
    long turn;
    double rest;
  };
  // Of an input's angle within half a turn and its whole turns.
  Place place(double angle, double whole) const;
  int leading() const { return leading_; }
  const Node::Few& inputs() const { return start_.inputs; }

  // Fills in rows [begin, end) of the guesses that lie at `places`, as far as their blocks repeat themselves.
  void fill(const Stepper& stepper, const std::vector<Place>& places, long begin, const RowGuesses& out) const;

 private:
  // The blocks that share a period, what is filled in for them, and what a period adds to the turn slots (of a
  // quaternion: its sign).
  struct Group {
    long period;
    Chosen chosen;
    std::vector<double> sign, added;  // states, turn slots
  };
  bool returned(int block, const Node& end) const;
  void choose(int block, const Node& end);
  Group* group_of(long period);

  const Plan& plan_;
  std::vector<ClosingTurn> closing_;
  std::vector<TreeTurn> tree_;
  Node start_;
  int leading_;
  double sense_, whole_;
  std::vector<std::vector<Segment>> turns_;
  std::vector<long> period_;             // blocks: 0 where it has not come back
  std::vector<std::vector<int>> above_;  // blocks: those that it depends on
  std::vector<Group> groups_;
  long common_ = 0;
};
