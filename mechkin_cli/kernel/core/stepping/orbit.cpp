#include "stepping/orbit.hpp"

#include "rows/units.hpp"

#include <algorithm>
#include <cmath>

namespace {

// A difference of angles without whole turns.
double within_half_turn(double angle) { return angle - FULL_TURN * std::rint(angle / FULL_TURN); }

int block_of(const Plan& plan, const TreeJoint& joint, int freedoms) {
  int block = -1;
  for (int f = 0; f < freedoms; ++f) block = std::max(block, plan.column_block[joint.column + f]);
  return block;
}

int tree_freedoms(const TreeJoint& j) { return kernel_unit()->tree_types[j.type].freedoms; }

// Of a quaternion the sign with which it lies nearer to another.
double sign_against(const double* q, const double* other) {
  double product = 0.0;
  for (int i = 0; i < 4; ++i) product += q[i] * other[i];
  return product < 0.0 ? -1.0 : 1.0;
}

}  // namespace

Orbit::Orbit(const Stepper& stepper, const Node& start, int leading, double sense, double whole)
    : plan_(stepper.plan()), closing_(stepper.turns()), tree_(stepper.tree_turns()), start_(start), leading_(leading),
      sense_(sense), whole_(whole), period_(plan_.blocks, 0), above_(plan_.blocks) {
  for (int b = 0; b < plan_.blocks; ++b)
    for (int c = plan_.block[b].closing_begin; c < plan_.block[b].closing_end; ++c)
      for (int l = plan_.closing[c].loop_begin; l < plan_.closing[c].loop_end; ++l) {
        const TreeJoint& j = plan_.joints[plan_.loop[l].joint];
        const int other = block_of(plan_, j, tree_freedoms(j));
        if (other >= 0 && other != b) above_[b].push_back(other);
      }
}

bool Orbit::repeats_some() const {
  return std::any_of(period_.begin(), period_.end(), [](long p) { return p > 0; });
}

// Whether the unknowns of a block stand where they stood at the start.
bool Orbit::returned(int block, const Node& end) const {
  for (int k = 0; k < plan_.links; ++k) {
    const TreeJoint& j = plan_.joints[k];
    const double *from = &start_.state[j.state], *to = &end.state[j.state];
    if (j.type == TREE_S) {
      if (plan_.column_block[j.column] != block) continue;
      const double sign = sign_against(from, to);
      for (int i = 0; i < 4; ++i)
        if (!(std::fabs(to[i] - sign * from[i]) <= SAME_PLACE)) return false;
      continue;
    }
    for (int f = 0; f < tree_freedoms(j); ++f) {
      if (plan_.column_block[j.column + f] != block) continue;
      const bool turns = f == 0 && (j.type == TREE_R || j.type == TREE_C);
      const double change = turns ? within_half_turn(to[f] - from[f]) : to[f] - from[f];
      if (!(std::fabs(change) <= SAME_PLACE)) return false;
    }
  }
  return true;
}

Orbit::Group* Orbit::group_of(long period) {
  for (Group& g : groups_)
    if (g.period == period) return &g;
  Group g = {period, {}, {}, {}};
  g.chosen.state.assign(plan_.states, 0), g.chosen.slot.assign(start_.turn.size(), 0);
  g.sign.assign(plan_.states, 1.0), g.added.assign(start_.turn.size(), 0.0);
  groups_.push_back(g);
  return &groups_.back();
}

// Fills in a block by the turns up to this one from now on.
void Orbit::choose(int block, const Node& end) {
  Group& g = *group_of((long)turns_.size());
  for (int k = 0; k < plan_.links; ++k) {
    const TreeJoint& j = plan_.joints[k];
    if (j.type == TREE_S) {
      if (plan_.column_block[j.column] != block) continue;
      const double sign = sign_against(&start_.state[j.state], &end.state[j.state]);
      for (int i = 0; i < 4; ++i) g.chosen.state[j.state + i] = 1, g.sign[j.state + i] = sign;
      continue;
    }
    for (int f = 0; f < tree_freedoms(j); ++f)
      if (plan_.column_block[j.column + f] == block) g.chosen.state[j.state + f] = 1;
  }
  for (const TreeTurn& t : tree_) {
    if (!g.chosen.state[t.state]) continue;
    g.chosen.slot[t.slot] = 1;
    g.added[t.slot] = end.turn[t.slot] - start_.turn[t.slot] +
                      std::rint((end.state[t.state] - start_.state[t.state]) / FULL_TURN);
  }
  for (const ClosingTurn& t : closing_) {
    if (t.closing < plan_.block[block].closing_begin || t.closing >= plan_.block[block].closing_end) continue;
    for (int i = 0; i < t.width; ++i) g.chosen.slot[t.slot + i] = 1;
    if (t.width == 1)
      g.added[t.slot] = FULL_TURN * std::rint((end.turn[t.slot] - start_.turn[t.slot]) / FULL_TURN);
    else
      g.added[t.slot] = sign_against(&start_.turn[t.slot], &end.turn[t.slot]);
  }
}

void Orbit::add_turn(std::vector<Segment> stretches, const Node& end, bool inputs_return) {
  turns_.push_back(std::move(stretches));
  if (!inputs_return) return;
  const long turn = (long)turns_.size();
  std::vector<char> back(plan_.blocks);
  for (int b = 0; b < plan_.blocks; ++b) back[b] = returned(b, end);
  if (std::all_of(back.begin(), back.end(), [](char b) { return b; })) {
    // one period for all: nothing has to be followed any more
    groups_.clear(), common_ = turn;
    for (int b = 0; b < plan_.blocks; ++b) period_[b] = turn, choose(b, end);
    return;
  }
  for (int b = 0; b < plan_.blocks; ++b) {
    bool repeats = back[b] && !period_[b];
    for (int other : above_[b]) repeats = repeats && period_[other] && turn % period_[other] == 0;
    if (repeats) period_[b] = turn, choose(b, end);
  }
}

Orbit::Place Orbit::place(double angle, double whole) const {
  double rest = sense_ * (angle - start_.inputs[leading_]);
  long turn = (long)(sense_ * (whole - whole_));
  if (rest < 0.0) rest += FULL_TURN, --turn;
  return {turn, rest};
}

void Orbit::fill(const Stepper& stepper, const std::vector<Place>& places, long begin, const RowGuesses& out) const {
  const long count = (long)places.size();
  std::vector<double> sigma(count);
  for (long i = 0; i < count; ++i) sigma[i] = places[i].rest;
  for (const Group& g : groups_) {
    for (long i = 0, next = 0; i < count; i = next) {
      const long lap = places[i].turn >= 0 ? places[i].turn / g.period : -((g.period - 1 - places[i].turn) / g.period);
      const std::vector<Segment>& turn = turns_[places[i].turn - lap * g.period];
      const auto at = std::lower_bound(turn.begin(), turn.end(), sigma[i],
                                       [](const Segment& s, double x) { return s.to.sigma < x; });
      const Segment& stretch = at == turn.end() ? turn.back() : *at;
      for (next = i + 1; next < count && places[next].turn == places[i].turn && sigma[next] <= stretch.to.sigma &&
                         sigma[next] > stretch.from.sigma;)
        ++next;
      infill(stepper, stretch.from, stretch.to, &sigma[i], begin + i, begin + next, out, &g.chosen);
      if (lap == 0) continue;
      const bool odd = lap % 2 != 0;
      for (std::size_t s = 0; odd && s < g.sign.size(); ++s)
        if (g.sign[s] < 0.0)
          for (long row = begin + i; row < begin + next; ++row) out.guess[s * out.rows + row] *= -1.0;
      for (const ClosingTurn& t : closing_) {
        if (!g.chosen.slot[t.slot]) continue;
        if (t.width == 4 && !(odd && g.added[t.slot] < 0.0)) continue;
        for (int j = 0; j < t.width; ++j)
          for (long row = begin + i; row < begin + next; ++row) {
            double& turned = out.turn[(t.slot + j) * out.rows + row];
            turned = t.width == 4 ? -turned : turned + lap * g.added[t.slot];
          }
      }
      for (const TreeTurn& t : tree_)
        if (g.chosen.slot[t.slot])
          for (long row = begin + i; row < begin + next; ++row)
            out.turn[t.slot * out.rows + row] += lap * g.added[t.slot];
    }
  }
}
