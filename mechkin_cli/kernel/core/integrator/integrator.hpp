// The integration in time of what moves under forces, in lanes: several variants of one response march together, each with
// its own time, step, chart and end.
//
// What a lane gets, bit for bit, depends neither on the other lanes nor on their number, provided that the motion's own
// answers do not. Arrays are [component][lane] with `lanes` numbers a component.
//
// Two methods: the explicit DOP853 (dop853.hpp), and Radau IIA of order 5 (radau.hpp), which a lane is given for good where
// Hairer's test finds that the explicit steps are short for stability alone.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "result.hpp"

// Places that a motion is asked about. y = (u [freedoms], v [freedoms], w [quadratures]): coordinates in the lane's present
// chart, zero at its origin, their rates, and what is integrated along (work, dissipation).
struct Places {
  const double* time;           // lanes
  const double* y;
  const unsigned char* active;  // lanes: those that are asked for; nothing is read of the others
  const signed char* side;      // switches x lanes: +1 or -1; 0 of one that rests at its zero
  bool is_end;                  // the end of a step: if the step is taken, `accept` comes with it, see there
};

struct Rates {
  double* rates;         // (v' [freedoms], w' [quadratures]) x lanes; u' = v
  double* switches;      // switches x lanes: their values there
  unsigned char* fault;  // lanes, zero when asked: why a place cannot be told (off the branch, does not close, singular
                         // inertia), in the motion's own numbers below 254; the step is tried again shorter
};
constexpr unsigned char NOT_FINITE = 255;  // the fault where a rate is not finite, set by the integrator

// A function of time and place at whose zeros steps end. An event only tells. At a kink the rates have a corner or jump:
// they are to be those of the lane's `side` on both sides of it, so that stages that reach beyond see a smooth function; the
// side changes when a step has ended there. One that `moves` is a border of the piece that a lane is in (of a table between
// two entries): it stays on its side, and the motion puts it elsewhere when told by `move`.
struct SwitchKind {
  bool kink;
  bool moves = false;
  signed char first = 1;  // side on which the first rates are taken; where it is known before, they do not reach beyond
  bool may_rest = false;  // a kink that takes the side 0: its value stays zero until another kink is passed
  bool bends_event = false;  // a kink at which the value of an event bends or jumps, whatever the rates do
  bool is_event() const { return !kink && !moves; }
  // A kink that stays where it is: where both its sides give the same rates it is passed without a word.
  bool may_be_nothing() const { return kink && !moves; }
};

class Motion {
 public:
  virtual ~Motion() = default;
  virtual int lanes() const = 0;
  virtual int freedoms() const = 0;
  virtual int quadratures() const = 0;
  virtual std::vector<SwitchKind> switches() const { return {}; }

  virtual void rates(const Places& places, const Rates& rates) = 0;
  // The sides of switches where the lanes start are known, and need not be those that the motion was made with: what it
  // decides by the rates there is decided anew. The mask (lanes) keeps those for which that made a difference.
  virtual void begin(const signed char* side, unsigned char* lanes) {
    (void)side;
    std::fill_n(lanes, this->lanes(), 0);
  }
  // These lanes' last place that was asked with `is_end` is taken: it is the origin of a new chart. `y` and `rates`, there
  // in the old chart, become those in the new one: u = 0, w as it is. `longest` (lanes, infinite before) may be set to the
  // longest step that the chart is likely to bear. Called in time order, before `row` and `event` of that place.
  virtual void accept(const unsigned char* lanes, const double* time, double* y, double* rates, double* longest) = 0;

  // The tolerance is relative: for u to 1 (rad, or lengths in parts of the size), for v to the largest |v| of the lane so
  // far, for w to the largest |w| so far. Here the sizes below which v and w do not matter: (1 + quadratures) x lanes, for
  // all v first, then for each w. Asked at the start and after each `accept`; the largest counts. Filled before with
  // SLOWEST over the duration, and with 0.
  virtual void sizes(const unsigned char* lanes, double* size) {
    (void)lanes;
    (void)size;
  }

  // Whether something moves beside the freedoms: powers are then not rounding where these rest.
  // The longest first step.
  virtual double longest() const { return __builtin_inf(); }
  virtual bool is_driven() const { return false; }

  // Of the quadratures the first so many are works: their powers are rounding where nothing moves.
  virtual int works() const { return quadratures(); }

  // Asked where a step was refused that may not be made shorter: whether the same step may be tried again, as more is known
  // of the places ahead.
  virtual bool finds_more(int lane) {
    (void)lane;
    return false;
  }

  // Asked where a step was refused for a fault: whether there is no use in shorter ones.
  virtual bool gives_up(int lane) const {
    (void)lane;
    return false;
  }

  // Asked behind rows: whether no more of a lane are wanted, which then is stuck where it is.
  virtual bool is_left(int lane) const {
    (void)lane;
    return false;
  }

  // Rows are reached; `row` (lanes). At the end of a step (`inside` false) that is the chart's origin, after `accept`. Inside
  // a step y is interpolated, in the chart of the step that is not yet accepted; the places of a lane come in time order.
  virtual void row(const unsigned char* lanes, const long* row, const double* time, const double* y, bool inside) = 0;
  // A switch was passed to its side +1 (`rising`) or -1, at the chart's origin, after `accept`. True ends the lane. Where it
  // falls together with a row, the row comes first.
  virtual bool event(int lane, int which, bool rising, double time) = 0;
  // Asked at the start, after a row there: the event that ends the lane at once, -1 without one.
  virtual int event_at_start(int lane) {
    (void)lane;
    return -1;
  }
  // An event came to its zero and went back.
  virtual void touch(int lane, int which, double time) {
    (void)lane;
    (void)which;
    (void)time;
  }
  // A switch that moves was met at the chart's origin: the lane is in the next piece, whose rates are asked for at once.
  // v and w may be changed there (a rate that comes to rest), of that lane alone. True: from there on the motion is stiff.
  virtual bool move(int lane, int which, double time, double* y) {
    (void)lane;
    (void)which;
    (void)time;
    (void)y;
    return false;
  }
};

// In parts of 1 rad over the duration: slower motion is not told relative to itself, as rates at rest are rounding.
constexpr double SLOWEST = 1e-4;

enum class MethodChoice { AUTOMATIC, EXPLICIT, IMPLICIT };

struct IntegratorSettings {
  double tolerance = 1e-10;
  double fixed_step = 0.0;       // > 0: as many equal steps between rows as are no longer; a fault then ends the lane
  double least_step = 1e-13;     // in parts of max(|time|, duration)
  long most_steps = 100000;      // attempts of a lane
  int dense_rows = 3;            // so many rows within one step are interpolated, fewer cut the step
  MethodChoice method = MethodChoice::AUTOMATIC;
};

// Equally spaced times, each made when it is asked for by the operations of building/spacing.py: very many are never held.
// Number k is (first + k step) / over in whole numbers that doubles hold exactly; without `over`, first + k step, and `last`
// the last one. In s it is that over the `divisor`, or times the `multiplier` where that is 1.
struct SpacedTimes {
  long count;
  double first, step, over, last, multiplier, divisor;

  double at(long row) const {
    const double k = (double)row;
    double time;
    if (over != 0.0)
      time = (double)((std::int64_t)first + (std::int64_t)row * (std::int64_t)step) / over;
    else
      time = row == count - 1 ? last : first + k * step;
    return divisor != 1.0 ? time / divisor : multiplier != 1.0 ? time * multiplier : time;
  }
  // Whether their steps are far above the rounding of any, four at most, so that they rise.
  bool surely_rise() const {
    if (count < 2) return true;
    const double largest = std::max(std::fabs(at(0)), std::fabs(at(count - 1)));
    return at(1) - at(0) > 16.0 * 0x1p-52 * largest && at(count - 1) > at(count - 2);
  }
};

// Some of rising times: those behind the `skipped` first ones, each after so many equal `parts` of the way from the one
// before, the first one from `begin` on; then one more, the `last`, if there is one.
struct PartOfTimes {
  long skipped = 0;
  int parts = 1;
  double begin = 0.0;
  bool has_last = false;
  double last = 0.0;
};

// Times of the rows, rising; `stride` numbers from lane to lane, 0 where all have the same. All have those of `spaced`, if
// there is one.
struct RowTimes {
  const double* time;
  long count;
  long stride;
  const SpacedTimes* spaced = nullptr;
  PartOfTimes part = {};

  double given(int lane, long row) const {
    row += part.skipped;
    return spaced ? spaced->at(row) : time[lane * stride + row];
  }
  double at(int lane, long row) const { return part.parts == 1 && !part.has_last ? given(lane, row) : between(lane, row); }
  double between(int lane, long row) const;
};

enum class LaneEnd : unsigned char {
  DONE,          // all rows are there
  STOPPED,       // an event said so
  STUCK,         // no step, however short, could be taken; `fault` says why, 0: the tolerance
  STEP_LIMIT,    // most_steps
  HELD,          // on both sides of the kink `which` the motion goes back to it
};

struct LaneReport {
  LaneEnd end = LaneEnd::DONE;
  unsigned char fault = 0;
  int which = -1;                // the switch that ended the lane; at STUCK and STEP_LIMIT the one that was met most often
  long met = 0;                  // how often that was
  double step = 0.0;             // the last step that was tried
  double value = 0.0;            // the largest of that switch at the end of any step that was tried
  bool stiff = false;            // the implicit method took over
  double stiff_from = 0.0;       // at this time
  double time = 0.0;             // how far the lane came
  long rows = 0;                 // rows that were reached
  long evaluations = 0, steps = 0, rejections = 0;
};

// Integrates from `time` (lanes) and y, u = 0 in the motion's present charts, over all rows. Refuses
// rows that do not rise or begin before `time`, and settings that are none.
Result<std::vector<LaneReport>> integrate(Motion& motion, const IntegratorSettings& settings, const double* time,
                                  const std::vector<double>& y, const RowTimes& rows);
