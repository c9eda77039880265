// SPDX-License-Identifier: BSD-3-Clause
//
// `gen --transversal`: one signature of every class. Two checks: the number of classes by Burnside's lemma, and the sum
// of the orbit lengths.
#include <fmt/format.h>

#include <map>

#include "base/error.hpp"
#include "program/commands.hpp"
#include "symmetry/counting.hpp"
#include "symmetry/transversal.hpp"

namespace tegl::gen {

namespace {

/// Counts of classes, signatures and orbit lengths.
struct Census {
  std::uint64_t classes = 0;
  std::uint64_t signatures = 0;
  std::map<std::uint32_t, std::uint64_t> by_length;  ///< orbit length -> number of classes
};

void check(const Census& census, const Options& options) {
  const WideUint expected = burnside_orbits(options.dim, options.group, false);
  if (!(WideUint{census.classes} == expected))
    throw Error(ErrorCode::CountMismatch,
                fmt::format("dimension {}: {} representatives by enumeration, {} classes by Burnside's lemma: expected "
                            "the same",
                            options.dim, census.classes, expected.to_decimal()));
  const std::uint64_t all = std::uint64_t{1} << (1u << options.dim);
  if (census.signatures != all)
    throw Error(ErrorCode::CountMismatch, fmt::format("dimension {}: orbits of {} signatures in all; expected {}",
                                                      options.dim, census.signatures, all));
}

void print(const Census& census, const Options& options) {
  const std::size_t order = group_order(options.dim, options.group, false);
  const char* const group_name = options.group == GroupKind::Full ? "full" : "rotations";
  if (options.json) {
    std::string lengths;
    for (const auto& [length, classes] : census.by_length)
      lengths += fmt::format("{}\"{}\": {}", lengths.empty() ? "" : ", ", length, classes);
    fmt::print(
        "{{\"dim\": {}, \"group\": \"{}\", \"order\": {}, \"representatives\": {}, \"signatures\": {}, "
        "\"orbit_lengths\": {{{}}}}}\n",
        options.dim, group_name, order, census.classes, census.signatures, lengths);
    return;
  }
  fmt::print(
      "dimension        {}\ngroup            {}, order {}\nrepresentatives  {} (as many as by Burnside's lemma)\n"
      "signatures       {} in their orbits: all\n\n    orbit    classes\n",
      options.dim, group_name, order, census.classes, census.signatures);
  for (const auto& [length, classes] : census.by_length) fmt::print("{:>9} {:>10}\n", length, classes);
}

}  // namespace

int run_transversal(const Options& options) {
  Census census;
  census.signatures = for_each_representative(options.dim, options.group, [&](const Representative& r) {
    ++census.classes;
    ++census.by_length[r.orbit_length];
    if (options.list) fmt::print("{} {}\n", r.signature, r.orbit_length);
  });
  check(census, options);
  if (!options.list) print(census, options);
  return 0;
}

}  // namespace tegl::gen
