// SPDX-License-Identifier: BSD-3-Clause
//
// All ways to resolve ambiguities, for tests that hold for each: the library's estimators and two custom ones.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "tegl/extract.hpp"

namespace tegl::test {

/// One of three choices by a hash of the face's values, so that all combinations of neighbours occur.
inline tile::Choice random_choice(const AmbiguousFace& face) {
  std::uint64_t hash = 0x9e3779b97f4a7c15u;
  for (const double value : face.values()) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(value + 0.0)) * 0xbf58476d1ce4e5b9u;
    hash ^= hash >> 29;
  }
  constexpr std::array<tile::Choice, 3> kChoices{tile::Choice::separate, tile::Choice::low, tile::Choice::high};
  return kChoices[hash % 3];
}

/// By the mean of minimum and maximum; invariant under mirroring of the face.
inline tile::Choice mid_range(const AmbiguousFace& face) {
  const auto [least, largest] = std::minmax_element(face.values().begin(), face.values().end());
  return *least + *largest >= 2 * face.isovalue() ? tile::Choice::high : tile::Choice::low;
}

inline ExtractOptions by_estimator(tile::Choice (*choose)(const AmbiguousFace&)) {
  ExtractOptions options;
  options.ambiguity = Ambiguity::custom;
  options.estimator.choose = choose;
  return options;
}

inline ExtractOptions by_ambiguity(Ambiguity ambiguity) {
  ExtractOptions options;
  options.ambiguity = ambiguity;
  return options;
}

struct NamedOptions {
  std::string name;
  ExtractOptions options;
};

/// The library's estimators and the two above.
inline std::vector<NamedOptions> all_estimators() {
  return {{"low", by_ambiguity(Ambiguity::low)},         {"high", by_ambiguity(Ambiguity::high)},
          {"mean", by_ambiguity(Ambiguity::mean)},       {"saddle", by_ambiguity(Ambiguity::saddle)},
          {"squares", by_ambiguity(Ambiguity::squares)}, {"decider", by_ambiguity(Ambiguity::decider)},
          {"mid-range", by_estimator(mid_range)},        {"random", by_estimator(random_choice)}};
}

/// Each estimator in each triangulation, with one thread: for many small images.
inline std::vector<NamedOptions> all_ways() {
  std::vector<NamedOptions> result;
  for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric})
    for (NamedOptions way : all_estimators()) {
      way.options.triangulation = triangulation;
      way.options.work.threads = 1;
      way.name += triangulation == Triangulation::compact ? ", compact" : ", barycentric";
      result.push_back(std::move(way));
    }
  return result;
}

}  // namespace tegl::test
