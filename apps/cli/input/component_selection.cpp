// SPDX-License-Identifier: BSD-3-Clause
//
// A recursive-descent parser: one function per grammar rule, each returning a predicate on components.
#include "input/component_selection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

#include "base/numbers.hpp"
#include "tegl/error.hpp"

namespace tegl::cli {

namespace {

using Test = ComponentSelection::Test;
using Quantity = std::function<std::optional<double>(const ComponentFacts&)>;

constexpr std::string_view kQuantities = "label, rank, vertices, simplices, size, content, euler, boundary";

/// A word, a number or an operator, and its position.
struct Token {
  std::string_view text;  ///< empty at the end
  std::size_t at = 0;
};

class Parser {
 public:
  Parser(const std::string& condition, const std::vector<std::string>& axes) : condition_(condition), axes_(axes) {
    tokenize();
  }

  Test parse() {
    Test test = alternatives();
    if (!now().text.empty()) fail("expected 'and', 'or' or the end");
    return test;
  }

 private:
  /// Throws an error with the current token and the expected one.
  [[noreturn]] void fail(const std::string& expected) const {
    const std::string found = now().text.empty() ? "ends" : fmt::format("has '{}' at {}", now().text, now().at + 1);
    throw Error(ErrorCode::InvalidArgument, fmt::format("--select '{}' {}; {}", condition_, found, expected));
  }

  static bool is_word(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '+' || c == '-' ||
           static_cast<unsigned char>(c) >= 0x80;
  }

  void tokenize() {
    const std::string_view text = condition_;
    for (std::size_t at = 0; at < text.size();) {
      std::size_t end = at;
      if (std::isspace(static_cast<unsigned char>(text[at])) != 0) {
        ++at;
        continue;
      }
      if (is_word(text[at]))
        while (end < text.size() && is_word(text[end])) ++end;
      else
        end = at + (at + 1 < text.size() && text[at + 1] == '=' ? 2 : 1);
      tokens_.push_back({text.substr(at, end - at), at});
      at = end;
    }
    tokens_.push_back({{}, text.size()});
  }

  [[nodiscard]] const Token& now() const { return tokens_[next_]; }
  bool take(std::string_view text) {
    if (!equal_ignoring_case(now().text, text)) return false;
    ++next_;
    return true;
  }

  // Limits the nesting of parentheses and `not`, so that no condition exhausts the stack.
  Test nested(Test (Parser::*rule)()) {
    constexpr int kDeepest = 100;
    if (++depth_ > kDeepest) fail("expected no more than 100 levels of parentheses and 'not'");
    Test test = (this->*rule)();
    --depth_;
    return test;
  }

  Test alternatives() {
    std::vector<Test> tests = {conjunction()};
    while (take("or")) tests.push_back(conjunction());
    if (tests.size() == 1) return tests.front();
    return [tests = std::move(tests)](const ComponentFacts& facts) {
      return std::any_of(tests.begin(), tests.end(), [&](const Test& test) { return test(facts); });
    };
  }

  Test conjunction() {
    std::vector<Test> tests = {term()};
    while (take("and")) tests.push_back(term());
    if (tests.size() == 1) return tests.front();
    return [tests = std::move(tests)](const ComponentFacts& facts) {
      return std::all_of(tests.begin(), tests.end(), [&](const Test& test) { return test(facts); });
    };
  }

  Test term() {
    if (take("not")) return [test = nested(&Parser::term)](const ComponentFacts& facts) { return !test(facts); };
    if (take("(")) {
      Test test = nested(&Parser::alternatives);
      if (!take(")")) fail("expected ')'");
      return test;
    }
    if (take("closed")) return [](const ComponentFacts& facts) { return facts.boundary == 0; };
    if (take("open")) return [](const ComponentFacts& facts) { return facts.boundary > 0; };
    if (const std::optional<std::size_t> axis = find_axis(now().text)) {
      ++next_;
      return span_test(*axis);
    }
    return comparison(quantity());
  }

  [[nodiscard]] std::optional<std::size_t> find_axis(std::string_view name) const {
    for (std::size_t a = 0; a < axes_.size(); ++a)
      if (equal_ignoring_case(name, axes_[a])) return a;
    for (std::size_t a = 0; a < axes_.size(); ++a)
      if (equal_ignoring_case(name, std::string_view("xyzt").substr(a, 1))) return a;
    return std::nullopt;
  }

  Test span_test(std::size_t axis) {
    if (take("contains")) {
      const double value = a_number(now().text);
      ++next_;
      return [=](const ComponentFacts& f) { return f.lowest[axis] <= value && value <= f.highest[axis]; };
    }
    const bool meets = take("meets");
    if (!meets && !take("within"))
      fail(
          "expected 'contains NUMBER', 'meets LOW..HIGH' or 'within LOW..HIGH' after the axis, or a quantity of it: "
          ".min, .max, .span or .centroid");
    const std::pair<double, double> range = a_range();
    const double low = range.first;
    const double high = range.second;
    if (meets) return [=](const ComponentFacts& f) { return f.lowest[axis] <= high && f.highest[axis] >= low; };
    return [=](const ComponentFacts& f) { return f.lowest[axis] >= low && f.highest[axis] <= high; };
  }

  double a_number(std::string_view text) const {
    const std::optional<double> value = parse_number(text);
    if (!value || *value != *value) fail("expected a number");
    return *value;
  }

  std::pair<double, double> a_range() {
    const std::size_t dots = now().text.find("..");
    if (dots == std::string_view::npos) fail("expected a range, as in 2.5..7");
    const double low = a_number(now().text.substr(0, dots));
    const double high = a_number(now().text.substr(dots + 2));
    if (low > high) fail("expected a range from low to high");
    ++next_;
    return {low, high};
  }

  Quantity quantity() {
    const std::string_view name = now().text;
    const auto is = [&](std::string_view other) { return equal_ignoring_case(name, other); };
    const auto member = [&](auto which) {
      ++next_;
      return [which](const ComponentFacts& facts) -> std::optional<double> { return facts.*which; };
    };
    if (is("label")) return member(&ComponentFacts::label);
    if (is("rank")) return member(&ComponentFacts::rank);
    if (is("vertices")) return member(&ComponentFacts::vertices);
    if (is("simplices")) return member(&ComponentFacts::simplices);
    if (is("size") || is("length") || is("area") || is("volume")) return member(&ComponentFacts::size);
    if (is("content")) return member(&ComponentFacts::content);
    if (is("euler")) return member(&ComponentFacts::euler);
    if (is("boundary")) return member(&ComponentFacts::boundary);
    return quantity_of_axis(name);
  }

  Quantity quantity_of_axis(std::string_view name) {
    const std::size_t dot = name.rfind('.');
    const std::optional<std::size_t> axis =
        dot == std::string_view::npos ? std::nullopt : find_axis(name.substr(0, dot));
    if (axis) {
      const std::string_view what = name.substr(dot + 1);
      const auto of_axis = [&](auto which) {
        ++next_;
        return [which, a = *axis](const ComponentFacts& facts) -> std::optional<double> { return (facts.*which)[a]; };
      };
      if (what == "min") return of_axis(&ComponentFacts::lowest);
      if (what == "max") return of_axis(&ComponentFacts::highest);
      if (what == "centroid") return of_axis(&ComponentFacts::centroid);
      if (what == "span") {
        ++next_;
        return [a = *axis](const ComponentFacts& facts) -> std::optional<double> {
          return facts.highest[a] - facts.lowest[a];
        };
      }
    }
    fail(fmt::format("expected one of {}; closed; open; or an axis, {}, with or without .min, .max, .span or .centroid",
                     kQuantities, fmt::join(axes_, ", ")));
  }

  Test comparison(Quantity quantity) {
    static constexpr std::array<std::string_view, 7> kSigns = {"<=", ">=", "!=", "==", "<", ">", "="};
    for (const std::string_view sign : kSigns) {
      if (!take(sign)) continue;
      const double value = a_number(now().text);
      ++next_;
      return [quantity = std::move(quantity), sign, value](const ComponentFacts& facts) {
        const std::optional<double> found = quantity(facts);
        if (!found) return false;
        if (sign == "<=") return *found <= value;
        if (sign == ">=") return *found >= value;
        if (sign == "!=") return *found != value;
        if (sign == "<") return *found < value;
        if (sign == ">") return *found > value;
        return *found == value;
      };
    }
    fail("expected <, <=, >, >=, = or !=");
  }

  const std::string& condition_;
  const std::vector<std::string>& axes_;
  std::vector<Token> tokens_;
  std::size_t next_ = 0;
  int depth_ = 0;
};

}  // namespace

ComponentSelection::ComponentSelection(const std::string& condition, const std::vector<std::string>& axes)
    : test_(Parser(condition, axes).parse()) {}

}  // namespace tegl::cli
