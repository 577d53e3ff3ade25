// Where two branches cross: located from the places before it, and passed straight on.
#pragma once

#include "stepping/arc.hpp"

// A branch point `distance` (arclength) beyond a node, and the path's parameter there.
struct BranchPointAhead {
  Node base;
  double distance = 0.0, sigma = 0.0;
  int order = 1;  // of the zero
};

// Where beyond some nodes, which come near to it, the matrix [J g; t^T] becomes singular; false where they do not tell. It
// goes to zero as a power of the distance: by the branches that meet, in all loops that lie singular there together.
bool branch_point_ahead(Arc& arc, const std::vector<Node>& nodes, BranchPointAhead* found);

// The place itself; derivatives are those of a place before it.
Node branch_point_node(Arc& arc, const BranchPointAhead& point);

// A node before the branch point, and the one on its other side, on the branch that goes on smoothly; false where that
// branch is not told apart: its tangent t must satisfy all second-order conditions W^T D2F[t, t] = 0, and be isolated by
// them (W^T D2F[t, N] of full rank).
bool pass_straight(Arc& arc, const BranchPointAhead& point, Node* before, Node* after);
