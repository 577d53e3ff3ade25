// The course of the inputs between rows: their own laws and what follows them, as a tape over one parameter (time, or the input that
// the others follow), in pieces on which it is smooth.
#pragma once

#include <vector>

#include "stepping/stepper.hpp"
#include "tape/tape_store.hpp"

// A smooth piece from row `first` to row `last`. The parameter runs from `begin` to `end`. Where all inputs rest at one
// of them, a length sigma of their way goes as a power of the distance from there: with u the part of the parameter's
// way, sigma = scale u^power, or scale (1 - (1 - u)^-power) where `power` < 0 and they rest at the end.
struct CoursePiece {
  long first, last;
  double begin, end, scale, power;
};

class Course {
 public:
  // `constants` and `ways` (pieces x inputs of the tape but the first, pieces x switches); `units` (inputs): what the
  // tape's outputs are divided by; `parameter` (rows). By `make`, which refuses what does not fit together.
  Course(const TapeStore& tape, std::vector<CoursePiece> pieces, std::vector<double> constants,
         std::vector<double> ways, std::vector<double> units, std::vector<double> parameter);
  Course(const Course&) = delete;
  Course(Course&&) = default;
  Refusal prepare() const;

  const std::vector<CoursePiece>& pieces() const { return pieces_; }
  long rows() const { return (long)parameter_.size(); }
  int inputs() const { return (int)units_.size(); }
  // Where a parameter, a row's, or a length of the way lies on a piece.
  double sigma(long piece, double parameter) const;
  double sigma_of_row(long piece, long row) const { return sigma(piece, parameter_[row]); }
  double parameter(long piece, double sigma) const;
  // Inputs and derivatives by sigma; `memory` as `memory_size` says, one a thread.
  void at(long piece, double sigma, PathPoint* point, std::vector<char>* memory) const;

 private:
  const TapeStore& tape_;
  std::vector<CoursePiece> pieces_;
  std::vector<double> constants_, ways_, units_, parameter_;
  int switches_;
};

// One piece as a path; at a row it has the row's own inputs, bit for bit.
class CoursePath : public Path {
 public:
  // `rows`: lengths of the way (rising) and inputs (inputs x rows, `stride` apart) of the piece's rows.
  struct RowPlaces {
    const double* sigma;
    long count;
    const double* inputs;
    long stride;
  };
  CoursePath(const Plan& plan, const Course& course, long piece, RowPlaces rows)
      : plan_(plan), course_(course), piece_(piece), rows_(rows) {}
  void at(double sigma, PathPoint* point) const override;
  const Plan& plan(double) const override { return plan_; }
  bool is_straight() const override { return false; }

 private:
  const Plan& plan_;
  const Course& course_;
  long piece_;
  RowPlaces rows_;
  mutable std::vector<char> memory_;
};
