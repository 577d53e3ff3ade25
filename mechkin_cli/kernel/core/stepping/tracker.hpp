// Following a branch along rows: skeleton and infill.
//
// Few careful steps (stepper.hpp) give nodes with first and second derivatives; the guesses for all rows come from
// quintic Hermite interpolation between them and are left for one batched run to finish. The angles and orientations
// of closing joints are carried along in the same way, so that whole turns and signs are never lost between rows.
#pragma once

#include "stepping/course.hpp"
#include "stepping/stretch.hpp"

enum class TrackEnd : int { finished = 0, stalled = 1, exhausted = 2, start_not_closed = 3 };

// Guesses of a run of rows, stored column after column. Where turns are asked for, the tree's angles are within half a
// turn, and their whole turns stand among them (TreeTurn).
struct RowGuesses {
  long rows;
  double* guess;  // states x rows
  double* limit;  // rows: largest correction that infill may make
  double* turn;   // turn slots x rows: closing joints' turns, continuous from the start; may be null
};

// What ended a branch: a dead centre or a branch point, located by arclength; `lost` where nothing is known.
struct Limit {
  PassageEnd kind = PassageEnd::lost;
  int block = -1;
  Node at, beyond;  // the place, with derivatives by arclength; the first node on a dead centre's other side
};

// Two neighbouring nodes; the angles of the second go on from the first.
struct Segment {
  Node from, to;
};

struct Track {
  TrackEnd end;
  long reached;     // rows that have a guess
  long steps, rejected;
  Node last;
  double refused_step;  // the step that could not be taken, if stalled
  Limit limit;
  std::vector<double> crossings;  // sigma of the branch points that were passed
};

// Rows on a path from `begin` to `end`: sigma (rows) must not fall; row 0 of them is number `first` of the guesses.
// `turn` (turn slots) are the continuous turns at the start, empty: as the kernel finds them. `kept`: takes the steps,
// none where some were walked by arclength.
Track follow_path(const Path& path, const KernelUnit& unit, double begin, long rows, const double* sigma, double end,
                  const double* start, const std::vector<double>& turn, const StepLimits& limits, const RowGuesses& out,
                  long first, std::vector<Segment>* kept = nullptr);
// The same on the straight path x0 + sigma u, from x0 on.
Track follow_line(const Plan& plan, const KernelUnit& unit, const double* x0, const double* u, long rows,
                  const double* sigma, double end, const double* start, const std::vector<double>& turn,
                  const StepLimits& limits, const RowGuesses& out, long first, std::vector<Segment>* kept = nullptr);

// How far rows were followed: the last place on the branch, and the way the inputs went there (largest part 1); on a
// piece of their course, which one, and the course's parameter at the limit, or at the last place where none is known.
struct Followed {
  TrackEnd end;
  long reached, steps, rejected;
  std::vector<double> inputs, state, turn, direction;
  Limit limit;
  // branch points that were passed: the inputs there, and the first row behind each
  std::vector<std::vector<double>> crossings;
  std::vector<long> crossed_before;
  long piece = -1;
  double parameter = 0.0;
};

// Follows the branch through `start` along all rows; `inputs` (inputs x rows, column after column), of angles without
// the `whole` turns of each (as many numbers; null: none). Straight runs of
// rows are followed as lines, other stretches as smooth curves through the rows, corners between distant rows chord by
// chord (polyline.cpp). `every_row` makes each row a node. Rows on the pieces of a `course` are followed along it.
Followed follow_rows(const Plan& plan, const KernelUnit& unit, const double* inputs, const double* whole,
                     const double* start, const std::vector<double>& turn, bool every_row, const StepLimits& limits,
                     const RowGuesses& out, const Course* course = nullptr);

// Steps of one path at most: so many take a minute, and a path that needs more has an input that is a slip of the pen.
constexpr long MOST_PATH_STEPS = 20000000;

// Whether a path gets on: a path may be as long as it likes, but most_steps attempts must take it a longest step further.
class Progress {
 public:
  explicit Progress(const StepLimits& limits) : limits_(limits) {}
  bool goes_on(double sigma) {
    if (!(sigma < from_ + limits_.longest_step)) from_ = sigma, tries_ = 0;
    return tries_++ < limits_.most_steps;
  }

 private:
  const StepLimits& limits_;
  double from_ = 0.0;
  long tries_ = 0;
};

// --- shared by both -------------------------------------------------------------------------------

// Gives a node the turns that it has by another way: whole turns and signs are taken over.
void adopt_turns(const Stepper& stepper, const std::vector<double>& turn, Node* node);
// Makes the turns of a node continuous with those of the node before; false where one turned too fast to tell. The
// stepper closes places between the two where their derivatives leave a doubt.
bool continue_turns(Stepper& stepper, const Node& a, Node* b);
struct Chosen;
// Guesses for rows [begin, end) at place[0 ... end - begin) between two nodes; `chosen`: of these states and turns
// alone; `before`: the node before a, whose values and derivatives tell the curve, too, null where none is known.
void infill(const Stepper& stepper, const Node& a, const Node& b, const double* place, long begin, long end,
            const RowGuesses& out, const Chosen* chosen = nullptr, const Node* before = nullptr);
// How far the inputs of `count` rows (column after column, `stride` apart) lie from the curve between two nodes.
double stray(const Stepper& stepper, const Node& a, const Node& b, const double* place, long count,
             const double* inputs, long stride);
// A node as the guess of a row.
void put_row(const Node& node, double limit, long row, const RowGuesses& out);
