#include "plan/same_layout.hpp"

#include <algorithm>

namespace {

template <class Record, class Same>
bool all_same(const Record* a, const Record* b, int count, const Same& same) {
  return std::equal(a, a + count, b, same);
}

bool same_counts(const Plan& a, const Plan& b) {
  return a.links == b.links && a.states == b.states && a.columns == b.columns && a.closings == b.closings &&
         a.hung_bodies == b.hung_bodies && a.blocks == b.blocks && a.inputs == b.inputs && a.unknowns == b.unknowns &&
         a.loop_entries == b.loop_entries && a.terms == b.terms && a.functions.functions == b.functions.functions && a.largest_block == b.largest_block;
}

bool same_joint(const TreeJoint& a, const TreeJoint& b) {
  return a.type == b.type && a.parent == b.parent && a.state == b.state && a.column == b.column && a.hung == b.hung &&
         a.function == b.function;
}

bool same_closing(const ClosingJoint& a, const ClosingJoint& b) {
  return a.type == b.type && a.first == b.first && a.second == b.second && a.slide == b.slide && a.row == b.row &&
         a.loop_begin == b.loop_begin && a.loop_end == b.loop_end && a.path_begin == b.path_begin &&
         a.path_end == b.path_end && a.is_pair_of_forces == b.is_pair_of_forces;
}

bool same_block(const Block& a, const Block& b) {
  return a.joint_begin == b.joint_begin && a.joint_end == b.joint_end && a.closing_begin == b.closing_begin &&
         a.closing_end == b.closing_end && a.column_begin == b.column_begin && a.column_end == b.column_end &&
         a.rows == b.rows && a.size == b.size;
}

bool same_number(int a, int b) { return a == b; }

}  // namespace

bool same_layout(const Plan& a, const Plan& b) {
  return same_counts(a, b) && all_same(a.joints, b.joints, a.links, same_joint) &&
         all_same(a.closing, b.closing, a.closings, same_closing) &&
         all_same(a.block, b.block, a.blocks, same_block) &&
         all_same(a.unknown, b.unknown, a.unknowns, same_number) &&
         all_same(a.input_column, b.input_column, a.inputs, same_number);
}
