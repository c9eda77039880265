// SPDX-License-Identifier: BSD-3-Clause
//
// Fields by expressions, parsed by muParser.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <mutex>

#include "field/field_parts.hpp"

#ifdef TEGL_HAS_MUPARSER
#include <muParser.h>
#endif

namespace tegl {

#ifdef TEGL_HAS_MUPARSER

namespace {

constexpr std::array<const char*, detail::kMostCoordinates> kCoordinates = {"x", "y", "z", "t", "u"};

double norm(const double* values, int count) {
  double square = 0;
  for (int i = 0; i < count; ++i) square += values[i] * values[i];
  return std::sqrt(square);
}

double ball_function(const double* values, int count) {
  if (count < 2) throw mu::ParserError("ball needs coordinates and a radius");
  return values[count - 1] - norm(values, count - 1);
}
double box_function(const double* values, int count) {
  if (count < 2 || count % 2 != 0) throw mu::ParserError("box needs coordinates with a half width each");
  double value = values[1] - std::abs(values[0]);
  for (int i = 2; i < count; i += 2) value = std::min(value, values[i + 1] - std::abs(values[i]));
  return value;
}
double torus_function(const double* values, int count) {
  if (count < 4) throw mu::ParserError("torus needs at least two coordinates, a ring and a tube");
  return values[count - 1] - std::hypot(norm(values, 2) - values[count - 2], norm(values + 2, count - 4));
}

/// A parser with its variables.
struct Evaluator {
  Evaluator(const std::string& text, int dim) {
    for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a) parser.DefineVar(kCoordinates.at(a), &at[a]);
    parser.DefineVar("r", &distance);
    parser.DefineFun("ball", ball_function, true);
    parser.DefineFun("box", box_function, true);
    parser.DefineFun("torus", torus_function, true);
    parser.SetExpr(text);
    parser.Eval();  // finds errors
    if (parser.GetNumResults() != 1)
      throw mu::ParserError("has " + std::to_string(parser.GetNumResults()) + " values, separated by commas");
  }
  Evaluator(const Evaluator&) = delete;
  Evaluator& operator=(const Evaluator&) = delete;

  detail::FieldPoint at{};
  double distance = 0;
  mu::Parser parser;
};

/// Evaluators that are not in use: a parser serves one thread at a time.
class Evaluators {
 public:
  Evaluators(std::string text, int dim) : text_(std::move(text)), dim_(dim) {}

  std::unique_ptr<Evaluator> take() {
    {
      const std::scoped_lock lock(mutex_);
      if (!free_.empty()) {
        std::unique_ptr<Evaluator> one = std::move(free_.back());
        free_.pop_back();
        return one;
      }
    }
    return std::make_unique<Evaluator>(text_, dim_);
  }
  void give_back(std::unique_ptr<Evaluator> one) {
    const std::scoped_lock lock(mutex_);
    free_.push_back(std::move(one));
  }

 private:
  std::string text_;
  int dim_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Evaluator>> free_;
};

/// The parser's message as a part of one: without its full stop.
std::string message_of(const mu::ParserError& error) {
  std::string text = error.GetMsg();
  text.erase(text.find_last_not_of(". ") + 1);
  return text;
}

}  // namespace

bool has_expressions() noexcept { return true; }

Field make_expression(const std::string& text, int dim) {
  if (dim < 2 || dim > 5)
    throw Error(ErrorCode::InvalidArgument, fmt::format("an expression in {} dimensions; expected 2 to 5", dim));
  const auto evaluators = std::make_shared<Evaluators>(text, dim);
  try {
    evaluators->give_back(evaluators->take());
  } catch (const mu::ParserError& error) {
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("the expression '{}': {}; expected an expression of {} and r", text, message_of(error),
                            fmt::join(kCoordinates.begin(), kCoordinates.begin() + dim, ", ")));
  }
  return Field(dim, [evaluators, dim, text](const double* start, double step, std::size_t count, double* out) {
    std::unique_ptr<Evaluator> one = evaluators->take();
    try {
      for (std::size_t i = 0; i < count; ++i) {
        std::copy_n(start, dim, one->at.begin());  // each time, because an expression may assign
        one->at[0] = start[0] + static_cast<double>(i) * step;
        one->distance = norm(one->at.data(), dim);
        out[i] = one->parser.Eval();
      }
    } catch (const mu::ParserError& error) {  // in a part that was not evaluated before
      throw Error(ErrorCode::InvalidArgument, fmt::format("the expression '{}': {}", text, message_of(error)));
    }
    evaluators->give_back(std::move(one));
  });
}

#else

bool has_expressions() noexcept { return false; }

Field make_expression(const std::string& text, int /*dim*/) {
  throw Error(
      ErrorCode::UnsupportedData,
      fmt::format("the expression '{}': this build has no muParser (Debian: libmuparser-dev); expected the name "
                  "of a field",
                  text));
}

#endif

}  // namespace tegl
