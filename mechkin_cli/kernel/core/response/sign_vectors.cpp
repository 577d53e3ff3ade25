#include "response/sign_vectors.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace {

constexpr double ZERO = 1e-9;  // of a product of unit vectors

// Takes what lies along unit vectors out of one, twice; the size of the rest, which becomes a unit vector.
double orthonormalise(const std::vector<std::vector<double>>& basis, std::vector<double>* a) {
  for (int pass = 0; pass < 2; ++pass)
    for (const std::vector<double>& b : basis) {
      const double along = product(*a, b);
      for (std::size_t k = 0; k < a->size(); ++k) (*a)[k] -= along * b[k];
    }
  const double size = std::sqrt(product(*a, *a));
  if (size > ZERO)
    for (double& x : *a) x /= size;
  return size;
}

// Rows with their offsets as one more entry, of unit size, and the row that tells the sign of that entry.
std::vector<std::vector<double>> homogeneous(const Matrix& rows, const std::vector<double>& offset, double none) {
  double largest = 0.0, most = 0.0;
  for (double x : rows.a) largest = std::max(largest, std::fabs(x));
  for (double x : offset) most = std::max(most, std::fabs(x));
  std::vector<std::vector<double>> all;
  for (int i = 0; i < rows.rows; ++i) {
    std::vector<double> row;
    for (int j = 0; j < rows.columns; ++j) row.push_back(largest > 0.0 ? rows(i, j) / largest : 0.0);
    row.push_back(most > 0.0 ? offset[i] / most : 0.0);
    for (double& x : row) x = std::fabs(x) <= none ? 0.0 : x;
    const double size = std::sqrt(product(row, row));
    if (size > 0.0)
      for (double& x : row) x /= size;
    all.push_back(row);
  }
  std::vector<double> last((std::size_t)rows.columns + 1, 0.0);
  last.back() = 1.0;
  all.push_back(last);
  return all;
}

// Rows in coordinates of the space that they span.
std::vector<std::vector<double>> spanned(const std::vector<std::vector<double>>& rows) {
  std::vector<std::vector<double>> basis;
  for (std::vector<double> row : rows)
    if (orthonormalise(basis, &row) > ZERO) basis.push_back(row);
  std::vector<std::vector<double>> found;
  for (const std::vector<double>& row : rows) {
    std::vector<double> own;
    for (const std::vector<double>& b : basis) own.push_back(product(row, b));
    found.push_back(own);
  }
  return found;
}

// The signs on the line where some rows vanish; false where that is no line.
bool ray(const std::vector<std::vector<double>>& rows, const std::vector<int>& chosen, Signs* signs) {
  std::vector<std::vector<double>> basis;
  for (int k : chosen) {
    std::vector<double> row = rows[k];
    if (!(orthonormalise(basis, &row) > ZERO)) return false;
    basis.push_back(row);
  }
  const std::size_t size = rows[0].size();
  std::vector<double> line, best(size, 0.0);
  double rest = 0.0;
  for (std::size_t axis = 0; axis < size; ++axis) {
    std::vector<double> unit(size, 0.0);
    unit[axis] = 1.0;
    const double left = orthonormalise(basis, &unit);
    if (left > rest) rest = left, best = unit;
  }
  for (const std::vector<double>& row : rows) {
    const double value = product(row, best);
    signs->push_back(std::fabs(value) <= ZERO ? 0 : value > 0.0 ? 1 : -1);
  }
  return true;
}

Signs composed(const Signs& a, const Signs& b) {
  Signs c = a;
  for (std::size_t k = 0; k < c.size(); ++k) c[k] = a[k] ? a[k] : b[k];
  return c;
}

std::vector<Signs> rays(const std::vector<std::vector<double>>& rows) {
  const int count = (int)rows.size(), size = (int)rows[0].size() - 1;
  std::set<Signs> found;
  std::vector<int> chosen;
  for (int k = 0; k < size; ++k) chosen.push_back(k);
  for (;;) {
    Signs signs;
    if (ray(rows, chosen, &signs)) {
      found.insert(signs);
      for (signed char& s : signs) s = (signed char)-s;
      found.insert(signs);
    }
    int last = size - 1;
    while (last >= 0 && chosen[last] == count - size + last) --last;
    if (last < 0) break;
    ++chosen[last];
    for (int k = last + 1; k < size; ++k) chosen[k] = chosen[k - 1] + 1;
  }
  return {found.begin(), found.end()};
}

}  // namespace

std::vector<Signs> sign_vectors(const Matrix& rows, const std::vector<double>& offset, double none, std::size_t most) {
  const std::vector<std::vector<double>> all = spanned(homogeneous(rows, offset, none));
  const std::vector<Signs> edges = rays(all);
  std::set<Signs> found = {Signs(all.size(), 0)};
  std::vector<Signs> open(found.begin(), found.end());
  // three times as many lie on all sides of the last row
  while (!open.empty() && found.size() <= 3 * most) {
    const Signs from = open.back();
    open.pop_back();
    for (const Signs& edge : edges) {
      const Signs to = composed(from, edge);
      if (found.insert(to).second) open.push_back(to);
    }
  }
  std::vector<Signs> kept;
  for (const Signs& signs : found)
    if (signs.back() > 0) kept.emplace_back(signs.begin(), signs.end() - 1);
  if (kept.size() > most || !open.empty()) kept.clear();
  return kept;
}
