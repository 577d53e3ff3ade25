"""From the mechanism graph to numbers: spanning tree, closing joints, blocks, the kernel's plan,
the sweep."""
