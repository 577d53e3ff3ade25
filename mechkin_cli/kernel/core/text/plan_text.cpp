#include "text/plan_text.hpp"

#include <charconv>
#include <cstring>
#include <tuple>
#include <type_traits>

namespace {

constexpr std::string_view FIRST_LINE = "mechkin plan 1";
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
    {"set_load_program", said<&PlanBuilder::set_load_program>},
    {"set_driven", said<&PlanBuilder::set_driven>},
    {"add_actuator", said<&PlanBuilder::add_actuator>},
    {"add_input_constraint", said<&PlanBuilder::add_input_constraint>},
    {"add_friction", said<&PlanBuilder::add_friction>},
    {"add_contact", said<&PlanBuilder::add_contact>},
    {"add_size_point", said<&PlanBuilder::add_size_point>},
};

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
    return PlanText{std::move(*plan), std::move(*outputs), std::move(tape_)};
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
    using Bytes = std::vector<std::uint8_t>;
    using Registers = std::vector<int>;
    using Rows = std::vector<std::array<int, 3>>;
    Values<int, std::vector<double>, Bytes, Rows, Registers, Rows, Bytes, Bytes> values;
    CHECK(values.read_from(words));
    auto& [inputs, constants, operations, operands, outputs, guards, expected, advice] = values.value;
    const auto flat = [](const Rows& rows) {
      Registers all;
      for (const auto& row : rows) all.insert(all.end(), row.begin(), row.end());
      return all;
    };
    Result<TapeStore> tape = TapeStore::make(inputs, constants, operations, flat(operands), outputs, flat(guards),
                                             expected, advice);
    CHECK(tape.refusal());
    tape_.emplace(std::move(*tape));
    return {};
  }

  std::optional<PlanBuilder> builder_;
  std::vector<OutputRecord> outputs_;
  std::optional<TapeStore> tape_;
};

}  // namespace

Result<PlanText> read_plan(std::string_view text) {
  Reading reading;
  for (long number = 1; !text.empty(); ++number) {
    const std::size_t size = text.find('\n');
    const std::string_view line = text.substr(0, size);
    text.remove_prefix(size == std::string_view::npos ? text.size() : size + 1);
    if (number == 1) {
      REQUIRE(line == FIRST_LINE, "the text does not begin with '" + std::string(FIRST_LINE) + "'");
    } else if (const Refusal refused = reading.take(line)) {
      return Refusal("line " + std::to_string(number) + ": " + *refused);
    }
  }
  return reading.end();
}
