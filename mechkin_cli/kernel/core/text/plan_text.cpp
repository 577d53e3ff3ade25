#include "text/plan_text.hpp"

#include <charconv>
#include <cmath>
#include <cstring>
#include <memory>
#include <tuple>
#include <type_traits>

namespace {

constexpr std::string_view FIRST_LINE = "mechkin plan 1", FIRST_LINE_OF_TAPE = "mechkin tape 1";
constexpr std::size_t BITS = 17;  // characters of a real number

// The words of one line, read off one after the other; what is not there, or no such thing, is a fault that stays.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}

  // A word, or a bracket; empty at the end.
  std::string_view next() {
    skip_blanks();
    std::size_t size = rest_.find_first_of(" []");
    if (size == 0) size = 1;
    const std::string_view word = rest_.substr(0, size);
    rest_.remove_prefix(word.size());
    return word;
  }
  void take(std::string_view wanted) {
    if (next() != wanted) refuse();
  }
  bool is_at(char wanted) {
    skip_blanks();
    return !rest_.empty() && rest_[0] == wanted;
  }
  void refuse() { fault_ = true; }
  bool is_faulty() const { return fault_; }
  Refusal end() {
    REQUIRE(!fault_ && next().empty(), "these are not the values of this record");
    return {};
  }

 private:
  void skip_blanks() {
    while (!rest_.empty() && rest_[0] == ' ') rest_.remove_prefix(1);
  }

  std::string_view rest_;
  bool fault_ = false;
};

template <class Number>
void read_integer(std::string_view word, Words& words, Number* to) {
  long long value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  *to = (Number)value;
  if (word.empty() || error != std::errc() || end != word.data() + word.size() || (long long)*to != value) words.refuse();
}

void read(Words& words, int* to) { read_integer(words.next(), words, to); }
void read(Words& words, std::uint8_t* to) { read_integer(words.next(), words, to); }
void read(Words& words, bool* to) { read_integer(words.next(), words, to); }
void read(Words& words, double* to) {
  const std::string_view word = words.next();
  if (word.size() != BITS || word[0] != 'x') {
    int whole = 0;
    read_integer(word, words, &whole);
    *to = whole;
    return;
  }
  unsigned long long bits = 0;
  const auto [end, error] = std::from_chars(word.data() + 1, word.data() + BITS, bits, 16);
  if (error != std::errc() || end != word.data() + BITS) words.refuse();
  std::memcpy(to, &bits, sizeof *to);
}

template <class T, std::size_t N>
void read(Words& words, std::array<T, N>* to) {
  words.take("[");
  for (T& item : *to) read(words, &item);
  words.take("]");
}
template <class A, class B>
void read(Words& words, std::pair<A, B>* to) {
  words.take("[");
  read(words, &to->first), read(words, &to->second);
  words.take("]");
}
template <class... T>
void read(Words& words, std::tuple<T...>* to) {
  words.take("[");
  std::apply([&](T&... item) { (read(words, &item), ...); }, *to);
  words.take("]");
}
template <class T>
void read(Words& words, std::vector<T>* to) {
  to->clear();
  words.take("[");
  while (!words.is_faulty() && !words.is_at(']')) {
    T item{};
    read(words, &item);
    to->push_back(item);
  }
  words.take("]");
}

// The values of a line, for a function that takes them.
template <class... T>
struct Values {
  std::tuple<T...> value;
  Refusal read_from(Words& words) {
    std::apply([&](T&... item) { (read(words, &item), ...); }, value);
    return words.end();
  }
};

// All values of a line.
template <class... T>
Refusal read_all(Words& words, std::tuple<T...>* values) {
  std::apply([&](T&... item) { (read(words, &item), ...); }, *values);
  return words.end();
}

const Refusal& refusal_of(const Refusal& refusal) { return refusal; }
template <class T>
const Refusal& refusal_of(const Result<T>& result) {
  return result.refusal();
}

template <class Returned, class... Given>
Refusal call(PlanBuilder& builder, Returned (PlanBuilder::*method)(Given...), Words& words) {
  Values<std::decay_t<Given>...> values;
  CHECK(values.read_from(words));
  return std::apply([&](auto&... given) -> Refusal { return refusal_of((builder.*method)(given...)); }, values.value);
}

template <auto Method>
Refusal said(PlanBuilder& builder, Words& words) {
  return call(builder, Method, words);
}

struct Verb {
  std::string_view name;
  Refusal (*say)(PlanBuilder& builder, Words& words);
};
constexpr Verb VERBS[] = {
    {"add_tree_joint", said<&PlanBuilder::add_tree_joint>},
    {"add_closing_joint", said<&PlanBuilder::add_closing_joint>},
    {"add_hung_links", said<&PlanBuilder::add_hung_links>},
    {"add_function", said<&PlanBuilder::add_function>},
    {"add_relation", said<&PlanBuilder::add_relation>},
    {"add_mesh", said<&PlanBuilder::add_mesh>},
    {"add_force", said<&PlanBuilder::add_force>},
    {"add_place", said<&PlanBuilder::add_place>},
    {"add_axis", said<&PlanBuilder::add_axis>},
    {"set_course", said<&PlanBuilder::set_course>},
    {"add_free_motion", said<&PlanBuilder::add_free_motion>},
    {"add_block", said<&PlanBuilder::add_block>},
    {"set_rest", said<&PlanBuilder::set_rest>},
    {"add_input", said<&PlanBuilder::add_input>},
    {"set_inertia", said<&PlanBuilder::set_inertia>},
    {"set_gravity", said<&PlanBuilder::set_gravity>},
    {"add_load", said<&PlanBuilder::add_load>},
    {"add_bushing", said<&PlanBuilder::add_bushing>},
    {"set_load_program", said<&PlanBuilder::set_load_program>},
    {"set_driven", said<&PlanBuilder::set_driven>},
    {"add_actuator", said<&PlanBuilder::add_actuator>},
    {"add_input_constraint", said<&PlanBuilder::add_input_constraint>},
    {"add_friction", said<&PlanBuilder::add_friction>},
    {"add_contact", said<&PlanBuilder::add_contact>},
    {"add_size_point", said<&PlanBuilder::add_size_point>},
};

using Numbers = std::vector<double>;
using Bytes = std::vector<std::uint8_t>;
using Registers = std::vector<int>;
using TapeRows = std::vector<std::array<int, 3>>;
// The arguments of TapeStore::make.
using TapeValues = std::tuple<int, Numbers, Bytes, TapeRows, Registers, TapeRows, Bytes, Bytes>;

Result<TapeStore> tape_of(TapeValues& values) {
  auto& [inputs, constants, operations, operands, outputs, guards, expected, advice] = values;
  const auto flat = [](const TapeRows& rows) {
    Registers all;
    for (const auto& row : rows) all.insert(all.end(), row.begin(), row.end());
    return all;
  };
  return TapeStore::make(inputs, constants, operations, flat(operands), outputs, flat(guards), expected, advice);
}

// The limits of a step in the order of their struct; counts and truths are numbers, too.
constexpr std::size_t STEP_LIMITS = 27;

Refusal read_limits(const Numbers& from, StepLimits* to) {
  REQUIRE(from.size() == STEP_LIMITS, "there are 27 limits of steps");
  for (const double number : from) REQUIRE(number >= -1.0 && number <= 1e15, "a limit of steps is a number from -1 on");
  const double* at = from.data();
  for (double* one : {&to->turn_cosine, &to->turn, &to->bend, &to->jump, &to->infill, &to->longest_step, &to->least_step})
    *one = *at++;
  to->most_steps = (int)std::fmin(*at++, 1e6);
  for (double* one : {&to->tight, &to->coarse, &to->accept, &to->pivot, &to->arc_pivot, &to->radius, &to->narrow}) *one = *at++;
  to->arc_steps = (int)std::fmin(*at++, 1e6), to->arc_work = *at++, to->straight = *at++ != 0.0, to->iterations = (int)std::fmin(*at++, 1e4);
  for (double* one : {&to->same_line, &to->knot, &to->corner_cosine, &to->stray, &to->angle_step, &to->angle_miss,
                      &to->angle_bend, &to->plan_step})
    *one = *at++;
  return {};
}

// Takes one line after the other; the parts come in their order.
class Reading {
 public:
  Refusal take(std::string_view line) {
    Words words(line);
    const std::string_view name = words.next();
    if (name.empty()) return {};
    if (name == "plan") return begin(words);
    if (name == "output") return add_output(words);
    if (name == "tape") return set_tape(words);
    if (name == "variants") return set_variants(words);
    if (name == "way") return add_way(words);
    if (name == "course") return set_course(words);
    if (name == "response") return set_response(words);
    for (const Verb& verb : VERBS)
      if (verb.name == name) {
        REQUIRE(builder_ && outputs_.empty() && !tape_, "records of a plan stand behind `plan` and before all else");
        return verb.say(*builder_, words);
      }
    return Refusal("unknown record");
  }

  Result<PlanText> end() {
    REQUIRE(builder_, "there is no plan");
    Result<FrozenPlan> plan = builder_->finish();
    CHECK(plan.refusal());
    Result<OutputList> outputs = OutputList::make(*plan, outputs_);
    CHECK(outputs.refusal());
    if (response_) CHECK(check_response(*response_, tape_ ? &*tape_ : nullptr, *plan, *outputs));
    return PlanText{std::move(*plan), std::move(*outputs), std::move(tape_), std::move(variants_), std::move(course_tapes_),
                    std::move(response_)};
  }

 private:
  Refusal begin(Words& words) {
    REQUIRE(!builder_, "there is one plan");
    Values<double, Triple, double> values;
    CHECK(values.read_from(words));
    const auto& [length, origin, size] = values.value;
    Result<PlanBuilder> builder = PlanBuilder::make(length, origin, size);
    CHECK(builder.refusal());
    builder_.emplace(std::move(*builder));
    return {};
  }
  Refusal add_output(Words& words) {
    REQUIRE(!tape_, "outputs stand before the tape");
    Values<int, int, int, int, Triple, double> values;
    CHECK(values.read_from(words));
    const auto& [type, index, freedom, order, data, factor] = values.value;
    outputs_.push_back({type, index, freedom, order, data, factor});
    return {};
  }
  Refusal set_tape(Words& words) {
    REQUIRE(!tape_, "there is one tape");
    TapeValues values;
    CHECK(read_all(words, &values));
    Result<TapeStore> tape = tape_of(values);
    CHECK(tape.refusal());
    tape_.emplace(std::move(*tape));
    return {};
  }

  Refusal set_variants(Words& words) {
    REQUIRE(tape_ && !variants_, "variants stand once, behind the tape");
    using Angles = std::vector<std::tuple<int, int, bool>>;
    std::tuple<Numbers, Numbers, Numbers, Numbers, Numbers, Numbers, Numbers, Numbers, Numbers> arrays;
    std::tuple<double, int, int, int, int, Numbers, Numbers, Angles, double> others;
    auto all = std::tuple_cat(std::move(arrays), std::move(others));
    CHECK(read_all(words, &all));
    VariantBase base = {};
    Numbers continuation, following;
    Angles angles;
    int rows, start, demand;
    std::tie(base.parameters, base.inputs, base.rates, base.accelerations, base.jerks, base.whole, base.full, base.time,
             base.state, base.size, rows, start, demand, base.iterations, continuation, following, angles,
             base.half_turn_side) = std::move(all);
    base.rows = rows, base.start_row = start, base.demand = (unsigned)demand;
    CHECK(read_limits(continuation, &base.continuation));
    CHECK(read_limits(following, &base.following));
    for (const auto& [slot, turn, closing] : angles) base.angles.push_back({slot, turn, closing});
    variants_.emplace(std::move(base));
    return {};
  }
  Refusal add_way(Words& words) {
    REQUIRE(variants_, "ways stand behind `variants`");
    std::tuple<int, std::vector<int>, Numbers> values;
    CHECK(read_all(words, &values));
    auto& [step, rows, inputs] = values;
    variants_->ways.push_back({step, {rows.begin(), rows.end()}, std::move(inputs), nullptr});
    return {};
  }
  Refusal set_course(Words& words) {
    REQUIRE(variants_ && !variants_->ways.empty() && !variants_->ways.back().course, "a course stands behind its way");
    using Pieces = std::vector<std::tuple<int, int, double, double, double, double>>;
    std::tuple<TapeValues, Pieces, Numbers, Numbers, Numbers, Numbers> values;
    CHECK(read_all(words, &values));
    auto& [tape, pieces, constants, ways, units, parameter] = values;
    Result<TapeStore> store = tape_of(tape);
    CHECK(store.refusal());
    std::vector<CoursePiece> list;
    for (const auto& [first, last, begin, end, scale, power] : pieces) list.push_back({first, last, begin, end, scale, power});
    course_tapes_.push_back(std::move(*store));
    Result<Course> course = make<Course>(course_tapes_.back(), list, constants, ways, units, parameter);
    CHECK(course.refusal());
    variants_->ways.back().course = std::make_shared<const Course>(std::move(*course));
    return {};
  }

  Refusal set_response(Words& words) {
    REQUIRE(tape_ && !variants_ && !response_, "a response stands once, behind the tape");
    using Stops = std::vector<std::tuple<int, int, int, double, int, int>>;
    using Angles = std::vector<std::tuple<int, int, bool>>;
    std::tuple<Numbers, Stops, double, double, int, int, Numbers, int, bool, std::vector<int>, int, Angles, double, double> values;
    CHECK(read_all(words, &values));
    ResponseBase base = {};
    Stops stops;
    Angles angles;
    Numbers limits;
    int steps, demand;
    IntegratorSettings& settings = base.settings;
    std::tie(base.times, stops, settings.tolerance, settings.fixed_step, steps, settings.dense_rows, limits,
             base.limits.iterations, base.limits.straight, base.start_states, demand, angles, base.same_moment,
             base.clear) = std::move(values);
    settings.most_steps = steps, base.demand = (unsigned)demand;
    REQUIRE(limits.size() == 5, "there are five limits of a motion");
    for (const double limit : limits) REQUIRE(limit >= 0.0, "a limit is a number from 0 on");
    REQUIRE(base.limits.iterations >= 0 && base.limits.iterations <= 10000, "iterations: 0 to 10000");
    base.limits.tight = limits[0], base.limits.coarse = limits[1], base.limits.accept = limits[2];
    base.limits.jump = limits[3], base.limits.radius = limits[4];
    for (const auto& [kind, direction, count, at, lengths, rates] : stops) {
      REQUIRE(kind >= STOP_CROSSING && kind <= STOP_CONDITION && direction >= -1 && direction <= 1, "stops: unknown kind");
      REQUIRE(std::fabs(at) <= 1e300 && lengths >= -64 && lengths <= 64 && rates <= 64, "stops: a number is too large");
      base.stops.push_back({kind, direction, count, at, lengths, rates});
    }
    for (const auto& [slot, turn, closing] : angles) base.angles.push_back({slot, turn, closing});
    response_.emplace(std::move(base));
    return {};
  }

  std::optional<PlanBuilder> builder_;
  std::vector<OutputRecord> outputs_;
  std::optional<TapeStore> tape_;
  std::optional<VariantBase> variants_;
  std::deque<TapeStore> course_tapes_;
  std::optional<ResponseBase> response_;
};

// Calls take(line) for every line behind the first, which must be the one of its kind of text.
template <class Take>
Refusal each_line(std::string_view text, std::string_view first, const Take& take) {
  for (long number = 1; !text.empty(); ++number) {
    const std::size_t size = text.find('\n');
    const std::string_view line = text.substr(0, size);
    text.remove_prefix(size == std::string_view::npos ? text.size() : size + 1);
    if (number == 1) {
      REQUIRE(line == first, "the text does not begin with '" + std::string(first) + "'");
    } else if (const Refusal refused = take(line)) {
      return Refusal("line " + std::to_string(number) + ": " + *refused);
    }
  }
  return {};
}

}  // namespace

Result<PlanText> read_plan(std::string_view text) {
  Reading reading;
  CHECK(each_line(text, FIRST_LINE, [&](std::string_view line) { return reading.take(line); }));
  return reading.end();
}

Result<TapeStore> read_tape(std::string_view text) {
  std::optional<TapeStore> found;
  CHECK(each_line(text, FIRST_LINE_OF_TAPE, [&](std::string_view line) -> Refusal {
    Words words(line);
    REQUIRE(words.next() == "tape" && !found, "there is one tape and nothing else");
    TapeValues values;
    CHECK(read_all(words, &values));
    Result<TapeStore> tape = tape_of(values);
    CHECK(tape.refusal());
    found.emplace(std::move(*tape));
    return {};
  }));
  REQUIRE(found, "there is no tape");
  return std::move(*found);
}
