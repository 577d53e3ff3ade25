// Whether two nodes of a path lie on one branch.
//
// A block of equations passes a singular place where the sign of its determinant changes; the signs are compared block
// by block, for two that change together leave their product as it was. An overconstrained block has no determinant;
// there det(A^T B) of its Jacobians at both nodes is negative where one direction of the unknowns loses its
// equations and gets them back reversed.
#include <cmath>

#include "stepper.hpp"

namespace {

// det(A^T B) of two m x n matrices, by elimination with row exchanges.
double product_determinant(const double* a, const double* b, int m, int n) {
  std::vector<double> c(n * n, 0.0);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < m; ++k) c[i * n + j] += a[k * n + i] * b[k * n + j];
  double determinant = 1.0;
  for (int k = 0; k < n; ++k) {
    int best = k;
    for (int i = k + 1; i < n; ++i)
      if (std::fabs(c[i * n + k]) > std::fabs(c[best * n + k])) best = i;
    if (best != k) {
      for (int j = 0; j < n; ++j) std::swap(c[k * n + j], c[best * n + j]);
      determinant = -determinant;
    }
    determinant *= c[k * n + k];
    for (int i = k + 1; i < n; ++i) {
      const double f = c[i * n + k] / c[k * n + k];
      for (int j = k; j < n; ++j) c[i * n + j] -= f * c[k * n + j];
    }
  }
  return determinant;
}

bool same_sides(const Plan& plan, const Node& a, const Node& b) {
  const double *one = a.jacobian.data(), *other = b.jacobian.data();
  for (int k = 0; k < plan.blocks; ++k) {
    const int m = plan.block[k].rows, n = plan.block[k].size;
    if (m == n && a.side[k] != b.side[k]) return false;
    if (m > n && !(product_determinant(one, other, m, n) > 0.0)) return false;
    one += m * n, other += m * n;
  }
  return true;
}

bool turned_too_far(const Node& a, const Node& b, const StepLimits& limits) {
  const double cosine = tangent_product(a, b) / std::sqrt(tangent_product(a, a) * tangent_product(b, b));
  return !(cosine >= limits.turn_cosine);
}

// Prediction of a from b: a place on another branch does not look back at where it was predicted from.
bool looks_back(const Stepper& stepper, const Node& a, const Node& b, double tolerance) {
  std::vector<double> back;
  stepper.predict(b, a.sigma - b.sigma, &back);
  for (std::size_t s = 0; s < back.size(); ++s)
    if (!(std::fabs(back[s] - a.state[s]) <= tolerance)) return false;
  return true;
}

}  // namespace

bool Stepper::judge(const Node& a, const Node& b) const {
  const double length = std::fabs(b.sigma - a.sigma) * std::sqrt(tangent_product(a, a));
  if (!(b.correction <= limits_.jump * length)) return false;
  for (double p : b.pivot)
    if (!(p >= limits_.pivot)) return false;
  return same_sides(plan_, a, b) && !turned_too_far(a, b, limits_) && looks_back(*this, a, b, limits_.jump * length);
}
