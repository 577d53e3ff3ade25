// Which signs linear functions can have together.
#pragma once

#include <vector>

#include "arithmetic/dense.hpp"

using Signs = std::vector<signed char>;

// All vectors of signs (-1, 0, 1) that rows x + offset takes over all x; the faces of an arrangement of hyperplanes. They are
// the compositions of those of its rays (Bjoerner, Las Vergnas, Sturmfels, White, Ziegler, Oriented Matroids, 1999, 3.7).
// None where there are more than `most`. Entries below `none` of the largest of the rows, or of the offsets, are zero.
std::vector<Signs> sign_vectors(const Matrix& rows, const std::vector<double>& offset, double none, std::size_t most);
