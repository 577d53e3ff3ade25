// Eigenvalues and eigenvectors of small dense matrices in plain doubles, row-major: sums in fixed order and nothing of libm
// but square roots, so that every machine has the same bits.
#pragma once

#include <vector>

// A x = lambda B x, with A and B symmetric (their lower triangles are read) and B positive definite: values rising, vectors
// as columns with x^T B x = 1 and their largest entry positive. By Cholesky's factor of B and cyclic Jacobi rotations
// (Golub, Van Loan, Matrix Computations, sections 8.5 and 8.7). False where B is not positive definite, or a number is not
// finite.
struct SymmetricEigen {
  std::vector<double> values, vectors;
};
bool symmetric_eigen(int n, const double* a, const double* b, SymmetricEigen* found);

// A x = lambda x of a real matrix, n values and n columns of unit length with their largest entry real and positive, real
// and imaginary parts apart. Complex ones are exact pairs, that with the positive imaginary part first; values rise by
// their size. Balanced, brought to Hessenberg's form, and by shifted QR steps to a triangle (Wilkinson, Reinsch, Handbook
// for Automatic Computation II, 1971, II/11 to II/15). False where a number is not finite or the steps do not end.
struct GeneralEigen {
  std::vector<double> real, imaginary, vectors_real, vectors_imaginary;
};
bool general_eigen(int n, const double* a, GeneralEigen* found);
