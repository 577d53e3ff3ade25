#include "stepping/stretch.hpp"

#include <algorithm>
#include <cmath>

const Passage& Stretch::of_block(int block) const {
  for (const Passage& p : passages)
    if (p.arc->owns(block)) return p;
  for (const Passage& p : passages)
    if (p.arc->carries(block)) return p;
  return passages.front();
}

bool Stretch::at(const Plan& plan, const KernelUnit& unit, const std::vector<ClosingTurn>& turns, double sigma,
                 Node* node, double* limit) const {
  std::vector<Node> found(passages.size());
  *limit = 0.0;
  for (std::size_t k = 0; k < passages.size(); ++k) {
    double own = 0.0;
    if (!passages[k].at(sigma, &found[k], &own)) return false;
    *limit = std::fmax(*limit, own);
  }
  *node = found.front();
  const auto of = [&](int block) -> const Node& { return found[&of_block(block) - passages.data()]; };
  for (int k = 0; k < plan.links; ++k) {
    const TreeJoint& j = plan.joints[k];
    const bool turns_freely = j.type == TREE_S;
    for (int f = 0; f < unit.tree_types[j.type].freedoms; ++f) {
      const int block = plan.column_block[j.column + f];
      if (block < 0) continue;
      if (!turns_freely)
        node->state[j.state + f] = of(block).state[j.state + f];
      else
        std::copy_n(&of(block).state[j.state], 4, &node->state[j.state]);
    }
  }
  for (int b = 0; b < plan.blocks; ++b)
    for (const ClosingTurn& t : turns)
      if (t.closing >= plan.block[b].closing_begin && t.closing < plan.block[b].closing_end)
        std::copy_n(&of(b).turn[t.slot], t.width, &node->turn[t.slot]);
  return true;
}

bool Stretch::carries_all(int blocks) const {
  for (int b = 0; b < blocks; ++b)
    if (!of_block(b).arc->carries(b)) return false;
  return true;
}

namespace {

// The blocks in trouble that a block hangs on, itself, and all that lies between them: what is walked together.
std::vector<char> chain_of(int block, const std::vector<int>& trouble, const std::vector<char>& upstream, int n) {
  std::vector<char> own(n, 0);
  own[block] = 1;
  for (int other : trouble) {
    if (!upstream[block * n + other]) continue;
    own[other] = 1;
    for (int b = 0; b < n; ++b)
      if (upstream[b * n + other] && upstream[block * n + b]) own[b] = 1;
  }
  return own;
}

// All but the other blocks in trouble and what hangs on them.
std::vector<char> carried_with(const std::vector<char>& own, const std::vector<int>& trouble,
                               const std::vector<char>& upstream, int n) {
  std::vector<char> carried(n, 1);
  for (int other : trouble)
    for (int b = 0; b < n && !own[other]; ++b)
      if (b == other || upstream[b * n + other]) carried[b] = 0;
  return carried;
}

// The block whose matrix changes fastest; at the start of a path no step has told that yet.
int worst_block(const Node& node) {
  int worst = 0;
  for (int b = 1; b < (int)node.danger.size(); ++b) {
    const bool told = node.danger[b] != node.danger[worst];
    if (told ? node.danger[b] > node.danger[worst] : node.pivot[b] < node.pivot[worst]) worst = b;
  }
  return worst;
}

// Rate of sigma (in parts of the inputs' speed) below which a walk that comes to nothing is done again with sigma's weight
// raised to the unknowns' own speed.
constexpr double SLOW_SIGMA = 0.1;

// A block that follows another through its narrow place goes by it on a hyperbola as steep as the first one turns
// fast: sigma hardly moves on both sides of it, and the tangent turns over a way that is as many times smaller than the
// gap. In an arclength in which sigma weighs as much more, it turns over the gap itself.
double weight_for(const Passage& p) {
  if (p.end != PassageEnd::lost || p.blame >= 0 || p.unbounded || p.nodes.empty()) return 1.0;
  double slowest = 1.0;
  for (const Node& node : p.nodes) slowest = std::fmin(slowest, node.rate * p.arc->speed());
  return slowest > 0.0 && slowest < SLOW_SIGMA ? 1.0 / slowest : 1.0;
}

}  // namespace

Stretch walk_stretch(const Path& path, const KernelUnit& unit, const StepLimits& limits, const Node& from,
                     double refused, double until) {
  const int n = path.plan(0.0).blocks;
  const std::vector<char> upstream = upstream_blocks(path.plan(0.0), unit);
  std::vector<int> trouble = {worst_block(from)};
  Stretch stretch;
  // every block that is found to stand in the way changes what is walked together, and what is carried along
  for (bool again = true; again;) {
    again = false;
    stretch.passages.clear();
    for (std::size_t k = 0; k < trouble.size() && !again; ++k) {
      // what passed with those that hang on it needs no walk of its own
      const auto passed = [&](const Passage& p) { return p.end == PassageEnd::through && p.arc->owns(trouble[k]); };
      if (std::any_of(stretch.passages.begin(), stretch.passages.end(), passed)) continue;
      const std::vector<char> own = chain_of(trouble[k], trouble, upstream, n);
      const auto walk = [&](double weight) {
        Passage p;
        p.block = trouble[k];
        p.arc = std::make_unique<Arc>(path, unit, limits, own, carried_with(own, trouble, upstream, n), weight);
        walk_passage(limits, from, refused, until, &p);
        stretch.steps += p.steps, stretch.rejected += p.rejected;
        return p;
      };
      Passage p = walk(1.0);
      const double weight = weight_for(p);
      if (weight > 1.0) {
        Passage heavier = walk(weight);
        if (heavier.end != PassageEnd::lost || heavier.blame >= 0) p = std::move(heavier);
      }
      const bool is_new = std::find(trouble.begin(), trouble.end(), p.blame) == trouble.end();
      if (p.end == PassageEnd::lost && p.blame >= 0 && is_new) {
        again = true;
        trouble.push_back(p.blame);
      }
      if (p.nodes.empty()) p.nodes.assign(1, from);
      stretch.passages.push_back(std::move(p));
    }
  }
  for (std::size_t k = 0; k < stretch.passages.size(); ++k)
    if (stretch.ends < 0 || stretch.passages[k].reach() < stretch.reach()) stretch.ends = (int)k;
  return stretch;
}
