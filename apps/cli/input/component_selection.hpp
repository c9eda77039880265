// SPDX-License-Identifier: BSD-3-Clause
//
// Conditions of --select, which choose components of a contour.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tegl::cli {

/// The properties of a component that a condition can use.
struct ComponentFacts {
  double label = 0;
  double rank = 0;  ///< 1 for the largest by size
  double vertices = 0;
  double simplices = 0;
  double size = 0;
  std::optional<double> content;  ///< none for an open component: comparisons with it are false
  double euler = 0;
  double boundary = 0;
  std::vector<double> lowest;  ///< by axis
  std::vector<double> highest;
  std::vector<double> centroid;
};

/// A condition on components, such as "size > 10 and t contains 7.3".
///
///   condition   comparisons joined by `and`, `or`, `not` and parentheses
///   comparison  QUANTITY (< <= > >= = !=) NUMBER, or `closed`, or `open`
///   quantity    label rank vertices simplices size content euler boundary,
///               AXIS.min AXIS.max AXIS.span AXIS.centroid
///   axis        AXIS contains NUMBER | AXIS meets LOW..HIGH | AXIS within LOW..HIGH
///
/// An axis is given by its own name or its letter x, y, z, t; `length`, `area` or `volume` are synonyms of `size`.
class ComponentSelection {
 public:
  /// `axes`: names of the axes, or letters for unnamed ones. Throws InvalidArgument, with the condition and the
  /// position in it, for a condition outside of this grammar.
  ComponentSelection(const std::string& condition, const std::vector<std::string>& axes);

  [[nodiscard]] bool operator()(const ComponentFacts& facts) const { return test_(facts); }

  using Test = std::function<bool(const ComponentFacts&)>;

 private:
  Test test_;
};

}  // namespace tegl::cli
