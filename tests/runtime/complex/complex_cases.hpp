// SPDX-License-Identifier: BSD-3-Clause
//
// What tests of complexes of images have in common.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "tegl/extract.hpp"

namespace tegl::test {

/// A ball of radius 0.7 around the origin.
template <int N>
double ball(const std::array<double, N>& x) {
  double square = 0.0;
  for (const double each : x) square += each * each;
  return 0.7 - std::sqrt(square);
}

/// Both triangulations with both fixed rules for ambiguous faces.
inline std::vector<ExtractOptions> fixed_rules() {
  std::vector<ExtractOptions> rules;
  for (const Triangulation triangulation : {Triangulation::barycentric, Triangulation::compact})
    for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::high}) {
      ExtractOptions& options = rules.emplace_back();
      options.triangulation = triangulation;
      options.ambiguity = ambiguity;
    }
  return rules;
}

}  // namespace tegl::test
