// The order of a plan's parts: blocks, what they place and solve for, and the finish.
#include "plan/plan_builder.hpp"

#include <algorithm>

#include "rows/units.hpp"
#include "stepping/stepper.hpp"

namespace {

// Entries of a block's matrices are counted in int; its Jacobian would take 128 MB a lane.
constexpr int MOST_BLOCK_ROWS = 4096;

// Unknowns up to which full matrices are as fast as bands: of blocks with a chart, and of others, whose rows are read more than
// their branch is judged.
constexpr int SMALL_BLOCK = 12, SMALL_DRIVEN_BLOCK = 24;

int equations(const ClosingJoint& j) { return kernel_unit()->pair_types[j.type].equations; }

}  // namespace

// Says in `placed_by` that a block, or the rest, places some tree joints.
Refusal PlanBuilder::place_joints(int block, const std::vector<int>& joints, std::vector<int>* placed_by) const {
  std::vector<int>& placed = *placed_by;
  for (int k : joints) {
    CHECK(check_joint(k, "places an unknown tree joint"));
    REQUIRE(placed[k] == NOT_PLACED, "a tree joint is placed once");
    const int parent = joints_[k].parent;
    REQUIRE(parent < 0 || placed[parent] != NOT_PLACED, "a tree joint is placed after its parent");
    if (joints_[k].type == TREE_L) {
      REQUIRE(joints_[k].hung >= 0, "TREE_L hangs a hung body");
      const int second = hung_[joints_[k].hung].second;
      REQUIRE(second < 0 || placed[second] != NOT_PLACED, "a hung body is placed after its ends");
    }
    placed[k] = block;
  }
  return {};
}

Refusal PlanBuilder::add_block(int closing_joints, const std::vector<int>& joints, const std::vector<int>& unknown,
                            int charts) {
  CHECK(open());
  const int index = (int)block_.size();
  const int closing_begin = block_.empty() ? 0 : block_.back().closing_end;
  REQUIRE(charts >= 0 && (charts == 0 || plan_.charts == 0), "one block has a chart");
  REQUIRE(closing_joints + charts > 0 && closing_joints >= 0 &&
              closing_joints <= (int)closing_.size() - closing_begin, "block of unknown joints");
  REQUIRE(!rest_set_, "blocks come before the rest");
  Block b = {(int)order_.size(), 0, closing_begin, closing_begin + closing_joints, (int)unknown_.size(), 0, 0, 0, charts, false, false, 0, 0, 0, 0, 0};
  long rows = charts;
  for (int c = b.closing_begin; c < b.closing_end; ++c)
    rows += equations(closing_[c]);
  REQUIRE(rows <= MOST_BLOCK_ROWS, "a block has at most 4096 equations");
  REQUIRE((long)unknown.size() <= rows, "a block needs as many equations as unknowns");
  std::vector<int> column_block = column_block_;
  for (int c : unknown) {
    REQUIRE(c >= 0 && c < plan_.columns && column_block[c] < 0, "a column must belong to one block");
    column_block[c] = index;
  }
  std::vector<int> placed_by = placed_by_;
  CHECK(place_joints(index, joints, &placed_by));
  placed_by_ = std::move(placed_by);
  int row = 0;
  for (int c = b.closing_begin; c < b.closing_end; ++c) {
    closing_[c].row = row;
    row += equations(closing_[c]);
  }
  order_.insert(order_.end(), joints.begin(), joints.end());
  for (int c : unknown) {
    column_place_[c] = (int)unknown_.size() - b.column_begin;
    unknown_.push_back(c);
  }
  column_block_ = column_block;
  b.joint_end = (int)order_.size();
  b.column_end = (int)unknown_.size();
  b.rows = (int)rows;
  plan_.charts += charts;
  b.size = (int)unknown.size();
  block_.push_back(b);
  return {};
}

Refusal PlanBuilder::set_rest(const std::vector<int>& joints) {
  CHECK(open());
  REQUIRE(!rest_set_, "the rest is set once");
  std::vector<int> placed_by = placed_by_;
  CHECK(place_joints(REST, joints, &placed_by));
  placed_by_ = std::move(placed_by);
  rest_ = joints;
  rest_set_ = true;
  return {};
}

// Closing joints between what is placed by then, all of them in blocks, every tree joint placed.
Refusal PlanBuilder::check_order() const {
  REQUIRE(block_.empty() ? closing_.empty() : block_.back().closing_end == (int)closing_.size(),
          "every closing joint must belong to a block");
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    REQUIRE((joints_[k].type == TREE_L) == (joints_[k].hung >= 0), "TREE_L hangs a hung body");
    REQUIRE((joints_[k].type == TREE_G || joints_[k].type == TREE_A) == (joints_[k].function >= 0),
            "TREE_G and TREE_A have a course");
    REQUIRE(placed_by_[k] != NOT_PLACED, "every tree joint must be placed by a block or be of the rest");
  }
  for (const Term& t : term_) REQUIRE(t.axis < (int)axis_.size(), "a relation's coordinates have axes");
  for (int b = 0; b < (int)block_.size(); ++b) {
    const auto placed = [&](int link) { return link < 0 || (placed_by_[link] != REST && placed_by_[link] <= b); };
    for (int c = block_[b].closing_begin; c < block_[b].closing_end; ++c) {
      const ClosingJoint& j = closing_[c];
      REQUIRE(placed(j.first) && placed(j.second), "a closing joint's links must be placed by its block or before");
      REQUIRE(j.slide < 0 || placed(j.slide), "a hung body's rod must be placed by its block or before");
      for (int l = j.loop_begin; l < j.loop_end; ++l)
        REQUIRE(placed(loop_[l].joint), "a loop's joints must be placed by its block or before");
      for (int l = j.path_begin; l < j.path_end; ++l)
        REQUIRE(placed(loop_[l].joint), "a force's way must be placed by its block or before");
    }
    for (int u = block_[b].column_begin; u < block_[b].column_end; ++u)
      REQUIRE(placed_by_[column_joint_[unknown_[u]]] == b, "a block's unknowns are of joints that it places");
  }
  return {};
}

// At least as many actuators as freedoms that they answer for, or none.
Refusal PlanBuilder::check_actuators() const {
  int freedoms = plan_.driven;
  for (int i = 0; i < plan_.driven; ++i) {
    bool led = false;
    for (const InputConstraint& t : input_constraint_) led = led || t.input == i;
    freedoms -= led;
  }
  REQUIRE(actuator_.empty() || (freedoms > 0 && freedoms <= (int)actuator_.size()),
          "actuators must be at least as many as the freedoms that they drive");
  return {};
}

// Drives grouped by the place of their axis; those without an axis last.
void PlanBuilder::sort_drives() {
  std::vector<int> order;
  for (std::size_t j = 0; j < place_.size(); ++j) {
    place_[j].drive_begin = (int)order.size();
    for (int d = 0; d < (int)drive_.size(); ++d)
      if (drive_[d].axis >= 0 && axis_[drive_[d].axis].place == (int)j) order.push_back(d);
    place_[j].drive_end = (int)order.size();
  }
  for (int d = 0; d < (int)drive_.size(); ++d)
    if (drive_[d].axis < 0) order.push_back(d);
  std::vector<Drive> sorted;
  std::vector<std::size_t> place(drive_.size());
  for (int d : order) {
    place[d] = sorted.size();
    sorted.push_back(drive_[d]);
  }
  for (ConstantPlace& c : constants_)
    if (c.array == ARRAY_DRIVE)
      c.offset = place[c.offset / sizeof(Drive)] * sizeof(Drive) + c.offset % sizeof(Drive);
  drive_ = sorted;
}

// Where springs on angles find how far these have turned.
void PlanBuilder::find_turns() {
  const Plan p = arrays();
  for (Load& l : load_) {
    if (l.type != LOAD_COORDINATE_SPRING) continue;
    if (l.other < 0) {
      for (const ClosingTurn& t : closing_turns(p, *kernel_unit(2)))
        if (t.closing == -1 - l.other && t.freedom == l.freedom) l.turn = t.slot;
      continue;
    }
    const TreeJoint& j = joints_[l.other];
    if ((j.type != TREE_R && j.type != TREE_C) || l.freedom != 0) continue;
    for (const TreeTurn& t : tree_turns(p, *kernel_unit(2)))
      if (t.state == j.state) l.turn = t.slot;
    for (int i = 0; i < p.inputs; ++i)
      if (input_column_[i] == j.column) l.turn = -2 - i;
  }
}

// Blocks of relations alone, and those that are explicit.
void PlanBuilder::find_relations() {
  for (int index = 0; index < (int)block_.size(); ++index) {
    Block& b = block_[index];
    b.placeless = !b.charts && b.rows == b.size;
    for (int c = b.closing_begin; c < b.closing_end; ++c) b.placeless = b.placeless && is_relation(closing_[c].type);
    if (!b.placeless || b.size != 1) continue;
    const ClosingJoint& j = closing_[b.closing_begin];
    for (int l = j.loop_begin; l < j.loop_end; ++l) {
      const Term& term = term_[loop_[l].term];
      if (term.freedom >= 0 && joints_[loop_[l].joint].column + term.freedom == unknown_[b.column_begin])
        b.is_explicit = term.function < 0;
    }
  }
}

// The columns that each loop passes, those that its block solves for first.
void PlanBuilder::find_loop_columns() {
  for (int index = 0; index < (int)block_.size(); ++index)
    for (int c = block_[index].closing_begin; c < block_[index].closing_end; ++c) {
      ClosingJoint& j = closing_[c];
      std::vector<LoopColumn> known;
      std::vector<char> met(block_[index].size, 0);
      j.columns_begin = (int)loop_column_.size();
      for (int l = j.loop_begin; l < j.loop_end; ++l) {
        const TreeJoint& t = joints_[loop_[l].joint];
        for (int f = 0; f < kernel_unit()->tree_types[t.type].freedoms; ++f) {
          const int column = t.column + f;
          const bool solved = column_block_[column] == index;
          const LoopColumn at = {l, f, column, solved ? column_place_[column] : -1};
          (solved ? loop_column_ : known).push_back(at);
          if (solved) met[at.place] = 1;
        }
      }
      j.known_begin = (int)loop_column_.size();
      loop_column_.insert(loop_column_.end(), known.begin(), known.end());
      j.columns_end = (int)loop_column_.size();
      j.meets_all = std::count(met.begin(), met.end(), 0) == 0;
    }
}

// Where the entries of a block are, if most of its matrix is zeros.
void PlanBuilder::find_band(Block* block) {
  const int n = block->size, inner = block->rows - block->charts;
  if (block->rows != n || n <= (block->charts ? SMALL_BLOCK : SMALL_DRIVEN_BLOCK)) return;
  std::vector<int> first(n, inner), end(n, 0);
  for (int c = block->closing_begin; c < block->closing_end; ++c) {
    const ClosingJoint& j = closing_[c];
    for (int k = j.columns_begin; k < j.known_begin; ++k) {
      const int u = loop_column_[k].place;
      first[u] = std::min(first[u], j.row), end[u] = std::max(end[u], j.row + equations(j));
    }
  }
  // unknowns before `reach` may hold an equation, and any of those not yet gone holds what one of them does
  BandRow* const row = &band_[block->column_begin];
  int reach = 0, last = 0, swaps = 0;
  for (int k = 0; k < n; ++k) {
    const int before = reach;
    for (int u = reach; u < n; ++u)
      if (k >= inner || first[u] <= k) reach = u + 1;
    reach = std::max(reach, k + 1);
    for (int u = before; u < reach; ++u) last = std::max(last, end[u]), row[u].begin = std::min(k, inner);
    last = std::min(std::max(last, k + 1), inner);
    swaps += reach - k - 1;
    row[k].end = last, row[k].reach = reach, row[k].swaps = swaps;
  }
  long entries = 0;
  for (int u = 0; u < n; ++u) {
    row[u].at = (int)entries, row[u].last = end[u];
    entries += row[u].end - row[u].begin + block->charts;
  }
  if (2 * entries <= (long)n * n) block->band_entries = (int)entries;
}

// The bands of all blocks, and where each block's matrices begin.
void PlanBuilder::find_bands() {
  band_.assign(unknown_.size(), {});
  long jacobian = 0, swap = 0, full = 0;
  int equation = 0;
  for (Block& b : block_) {
    find_band(&b);
    b.jacobian_at = jacobian, b.swap_at = swap, b.equation_at = equation, b.full_at = full;
    const long n = b.size, entries = b.rows * n;
    jacobian += b.band_entries ? b.band_entries : entries, full += entries, equation += b.rows;
    swap += b.band_entries ? band_[b.column_end - 1].swaps : n * (n - 1) / 2;
  }
}

Result<FrozenPlan> PlanBuilder::finish() {
  CHECK(open());
  // a tree whose states are given whole: only its poses are asked for
  const bool posed = block_.empty() && input_column_.empty();
  for (int c = 0; c < plan_.columns; ++c) {
    bool input = false;
    for (int i : input_column_) input = input || i == c;
    REQUIRE(posed || input != (column_block_[c] >= 0), "every column must be an input or an unknown, not both");
  }
  CHECK(check_order());
  CHECK(check_actuators());
  sort_drives();
  find_turns();
  find_relations();
  find_loop_columns();
  find_bands();
  REQUIRE(program_.view().outputs >= plan_.load_values, "one output of the load program for each value that varies");
  program_.find_turns(arrays());
  FrozenPlan plan(arrays(), constants_, repeated_);
  spent_ = true;
  return plan;
}

Plan PlanBuilder::arrays() const {
  Plan p = plan_;
  p.links = (int)joints_.size();
  p.closings = (int)closing_.size();
  p.hung_bodies = (int)hung_.size();
  p.blocks = (int)block_.size();
  p.inputs = (int)input_column_.size();
  p.loads = (int)load_.size();
  p.bushings = (int)bushing_.size();
  p.driven = driven_set_ ? plan_.driven : p.inputs;
  p.actuators = (int)actuator_.size();
  p.input_constraints = (int)input_constraint_.size();
  p.places = (int)place_.size();
  p.axes = (int)axis_.size();
  p.frees = (int)free_.size();
  p.drives = (int)drive_.size();
  p.loop_entries = (int)loop_.size();
  p.loop_columns = (int)loop_column_.size();
  p.terms = (int)term_.size();
  p.order_count = (int)order_.size();
  p.unknowns = (int)unknown_.size();
  p.rest_count = (int)rest_.size();
  p.size_points = (int)size_point_.size();
  p.frictions = (int)friction_.size();
  p.contacts = (int)contact_.size();
  p.largest_block = 0;
  for (const Block& b : block_) p.largest_block = b.rows > p.largest_block ? b.rows : p.largest_block;
  p.joints = joints_.data(), p.closing = closing_.data(), p.hung = hung_.data();
  p.place = place_.data(), p.axis = axis_.data(), p.drive = drive_.data(), p.free = free_.data();
  p.loop = loop_.data(), p.loop_column = loop_column_.data(), p.term = term_.data(), p.block = block_.data();
  p.order = order_.data(), p.unknown = unknown_.data(), p.band = band_.data(), p.rest = rest_.data();
  p.input_column = input_column_.data();
  p.column_state = column_state_.data(), p.column_joint = column_joint_.data();
  p.column_block = column_block_.data(), p.column_place = column_place_.data();
  p.column_weight = column_weight_.data();
  p.inertia = inertia_.data(), p.load = load_.data(), p.bushing = bushing_.data(), p.size_point = size_point_.data();
  p.actuator = actuator_.data(), p.input_constraint = input_constraint_.data();
  p.law = program_.view();
  p.functions = functions_.view(), p.function_knot = functions_.knots().data();
  p.function_constant = functions_.constants().data();
  p.friction = friction_.data(), p.contact = contact_.data();
  return p;
}
