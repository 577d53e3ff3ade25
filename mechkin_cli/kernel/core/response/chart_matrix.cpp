#include "response/chart_matrix.hpp"

#include <cmath>
#include <cstdint>

#include "arithmetic/band.hpp"

namespace {

// Vectors of signs whose products with the inverse show how large it is: of four, at random, the square is below a hundredth
// of what is expected for one matrix in ten thousand, and a factor that stays as it is does no harm.
constexpr int SHOWN_BY = 4;
// Products by which the largest eigenvalue comes out: near a branch point it is some times the next.
constexpr int MOST_PRODUCTS = 24;

// Signs in no order that a mechanism could have, the same on all machines (a linear congruence; Knuth 1998, 3.3.4).
std::vector<double> signs(int count, int which) {
  std::vector<double> x((std::size_t)count);
  std::uint64_t state = 88172645463325252u + (std::uint64_t)which;
  for (double& entry : x) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    entry = state >> 63 ? 1.0 : -1.0;
  }
  return x;
}

double length(const std::vector<double>& x) { return std::sqrt(product(x, x)); }

Matrix change_of(const Matrix& matrix, const Matrix& origin) {
  Matrix e = LeastSquares(matrix).solve(origin);
  subtract_identity(&e);
  return e;
}

// The factors of a band.
class BandFactors {
 public:
  BandFactors(const std::vector<double>& entries, const BandRow* row, int unknowns, int border)
      : entries_(entries), swap_((std::size_t)row[unknowns - 1].swaps),
        band_{entries_.data(), swap_.data(), row, unknowns, border} {
    factor(band_);
  }
  BandFactors(const BandFactors&) = delete;
  void solve(std::vector<double>* b) const { ::solve(band_, b->data()); }

 private:
  std::vector<double> entries_;
  std::vector<unsigned char> swap_;
  BandOf<DoubleEntries> band_;
};

}  // namespace

ChartMatrix::ChartMatrix(std::vector<double> entries, const BandRow* row, int unknowns, int border)
    : entries_(std::move(entries)), row_(row), unknowns_(unknowns), border_(border) {}

double ChartMatrix::regularity() const {
  if (!row_) return LeastSquares(full_).least_singular_bound();
  const BandFactors factors(entries_, row_, unknowns_, border_);
  double square = 0.0;
  for (int which = 0; which < SHOWN_BY; ++which) {
    std::vector<double> x = signs(unknowns_, which);
    factors.solve(&x);
    square += product(x, x);
  }
  return 1.0 / std::sqrt(square / SHOWN_BY);
}

double ChartMatrix::largest_change(const ChartMatrix& origin) const {
  if (!row_) return spectral_radius_bound(change_of(full_, origin.full_));
  const BandFactors factors(entries_, row_, unknowns_, border_);
  std::vector<double> before = origin.entries_, x = signs(unknowns_, 0), y(x.size());
  const BandOf<DoubleEntries> band = {before.data(), nullptr, row_, unknowns_, border_};
  double growth = 0.0;
  for (int k = 0; k < MOST_PRODUCTS; ++k) {
    const double size = length(x);
    if (!(size > 0.0)) break;
    for (double& entry : x) entry /= size;
    multiply(band, x.data(), y.data());
    factors.solve(&y);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = y[i] - x[i];
    growth = length(x);
  }
  return growth;
}

bool ChartMatrix::is_joined(const ChartMatrix& origin, double limit) const {
  return spectral_radius_within(change_of(full_, origin.full_), limit);
}
