// SPDX-License-Identifier: BSD-3-Clause
//
// The four kinds of tables of an extraction, for tests that hold for each.
#pragma once

#include <string>
#include <vector>

#include "tegl/extract.hpp"

namespace tegl::test {

inline std::vector<ExtractOptions> variants() {
  std::vector<ExtractOptions> result;
  for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric})
    for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::high}) {
      ExtractOptions options;
      options.triangulation = triangulation;
      options.ambiguity = ambiguity;
      result.push_back(options);
    }
  return result;
}

inline std::string describe(const ExtractOptions& options) {
  std::string text = options.triangulation == Triangulation::compact ? "compact" : "barycentric";
  constexpr const char* kAmbiguities[] = {", low",     ", high",    ", mean",  ", saddle",
                                          ", squares", ", decider", ", custom"};
  text += kAmbiguities[static_cast<int>(options.ambiguity)];
  if (options.close) text += ", closed";
  return text;
}

}  // namespace tegl::test
