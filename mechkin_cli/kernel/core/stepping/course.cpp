#include "stepping/course.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "arithmetic/operations.hpp"
#include "rows/units.hpp"

namespace {

// Part of a piece next to a rest within which it is its chord: derivatives by a power of the parameter would be products
// of zero and infinity there, and the way differs from its chord by less than a thousandth of 1e-9.
constexpr double AT_REST = 1e-9;

const KernelUnit& narrow() { return *kernel_unit(2); }

// x^y with the kernel's own bits, exact for y = 1.
double power(double x, double y) {
  if (y == 1.0) return x;
  double result;
  narrow().elementwise(OPERATION_POWER, &x, &y, &result, 1);
  return result;
}

// The part of a piece's length; beyond its ends the formulas go on, but not beyond a rest.
double part_of(const CoursePiece& p, double sigma) {
  const double part = sigma / p.scale;
  if (std::fabs(p.power) == 1.0) return part;
  return p.power < 0.0 ? std::fmin(part, 1.0) : std::fmax(part, 0.0);
}

}  // namespace

Course::Course(const TapeStore& tape, std::vector<CoursePiece> pieces, std::vector<double> constants,
               std::vector<double> ways, std::vector<double> units, std::vector<double> parameter)
    : tape_(tape), pieces_(std::move(pieces)), constants_(std::move(constants)), ways_(std::move(ways)),
      units_(std::move(units)), parameter_(std::move(parameter)), switches_(tape.switches()) {}

Refusal Course::prepare() const {
  const Tape& t = tape_.view();
  REQUIRE(t.outputs == inputs(), "units: one for each output of the tape");
  REQUIRE(constants_.size() == pieces_.size() * (t.inputs - 1), "constants: one for each further input and piece");
  REQUIRE(ways_.size() == pieces_.size() * switches_, "ways: one for each switch and piece");
  long after = 0;
  for (const CoursePiece& p : pieces_) {
    REQUIRE(p.first >= after && p.last > p.first && p.last < rows(), "pieces: rows out of order");
    REQUIRE(std::isfinite(p.begin) && std::isfinite(p.end) && p.begin != p.end, "pieces: no stretch of the parameter");
    REQUIRE(p.scale > 0.0 && std::isfinite(p.scale), "pieces: a scale is positive");
    REQUIRE(std::fabs(p.power) >= 1.0 && std::fabs(p.power) <= 100.0, "pieces: a power is 1 to 100");
    after = p.last;
  }
  return {};
}

double Course::sigma(long piece, double parameter) const {
  const CoursePiece& p = pieces_[piece];
  const double u = std::fmin(std::fmax((parameter - p.begin) / (p.end - p.begin), 0.0), 1.0);
  return p.scale * (p.power < 0.0 ? 1.0 - power(1.0 - u, -p.power) : power(u, p.power));
}

double Course::parameter(long piece, double sigma) const {
  const CoursePiece& p = pieces_[piece];
  const double part = part_of(p, sigma);
  const double u = p.power < 0.0 ? 1.0 - power(1.0 - part, -1.0 / p.power) : power(part, 1.0 / p.power);
  return p.begin + (p.end - p.begin) * u;
}

void Course::at(long piece, double sigma, PathPoint* point, std::vector<char>* memory) const {
  const Tape& t = tape_.view();
  const CoursePiece& p = pieces_[piece];
  const int n = inputs(), more = t.inputs - 1;
  memory->resize(narrow().jets_size(t));
  std::vector<double> given(t.inputs), out(3 * n);
  std::copy_n(constants_.begin() + piece * more, more, given.begin() + 1);
  const auto replay = [&](double parameter) {
    given[0] = parameter;
    narrow().replay_jets(t, given.data(), ways_.data() + piece * switches_, out.data(), memory->data());
  };
  point->inputs.resize(n), point->first.resize(n), point->second.assign(n, 0.0);
  const double stretch = p.end - p.begin, order = std::fabs(p.power), part = part_of(p, sigma);
  const double rest = p.power < 0.0 ? 1.0 - part : part, sense = p.power < 0.0 ? -1.0 : 1.0;
  if (order != 1.0 && rest < AT_REST) {
    // the chord from the rest
    replay(p.power < 0.0 ? p.end : p.begin);
    for (int i = 0; i < n; ++i) point->inputs[i] = out[3 * i] / units_[i];
    replay(parameter(piece, p.scale * (p.power < 0.0 ? 1.0 - AT_REST : AT_REST)));
    for (int i = 0; i < n; ++i) {
      const double slope = (out[3 * i] / units_[i] - point->inputs[i]) / AT_REST;
      point->inputs[i] += slope * rest, point->first[i] = sense * slope / p.scale;
    }
    return;
  }
  // the parameter by sigma
  double first = stretch / p.scale, second = 0.0;
  if (order != 1.0) {
    const double slope = power(rest, 1.0 / order) / (order * rest), bend = slope * (1.0 / order - 1.0) / rest;
    first *= slope, second = sense * stretch / (p.scale * p.scale) * bend;
  }
  replay(parameter(piece, sigma));
  for (int i = 0; i < n; ++i) {
    const double by = out[3 * i + 1] / units_[i], twice = out[3 * i + 2] / units_[i];
    point->inputs[i] = out[3 * i] / units_[i];
    point->first[i] = by * first;
    point->second[i] = twice * (first * first) + by * second;
  }
}

void CoursePath::at(double sigma, PathPoint* point) const {
  course_.at(piece_, sigma, point, &memory_);
  // inputs beyond those of the course are held
  for (int i = course_.inputs(); i < plan_.inputs; ++i) {
    point->inputs.push_back(rows_.inputs[i * rows_.stride]);
    point->first.push_back(0.0), point->second.push_back(0.0);
  }
  const double* const end = rows_.sigma + rows_.count;
  const double* const row = std::lower_bound(rows_.sigma, end, sigma);
  if (row == end || *row != sigma) return;
  for (std::size_t i = 0; i < point->inputs.size(); ++i)
    point->inputs[i] = rows_.inputs[i * rows_.stride + (row - rows_.sigma)];
}
