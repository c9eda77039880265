// SPDX-License-Identifier: BSD-3-Clause
//
// `gen --count`: the number of classes, counted twice by ways that share no code beyond the group's order: Burnside's
// lemma over pairs of partitions, and orbits of all signatures under the closed group.
#include <fmt/format.h>

#include "tegl/gen/commands.hpp"
#include "tegl/gen/counting.hpp"
#include "tegl/gen/transversal.hpp"

namespace tegl::gen {

int run_count(const Options& options) {
  const WideUint orbits = burnside_orbits(options.dim, options.group, options.inversion);
  const bool enumerated = options.dim <= kMaxEnumeratedDim;
  if (enumerated) {
    const Transversal classes = transversal(options.dim, group(options.dim, options.group, options.inversion));
    require_burnside_count(classes, options.dim, options.group, options.inversion);
  }
  const std::size_t order = group_order(options.dim, options.group, options.inversion);
  const char* const group_name = options.group == GroupKind::Full ? "full" : "rotations";
  if (options.json) {
    fmt::print("{{\"dim\": {}, \"group\": \"{}\", \"inversion\": {}, \"order\": {}, \"orbits\": {}}}\n", options.dim,
               group_name, options.inversion, order, orbits.to_decimal());
  } else {
    fmt::print("dimension  {}\ngroup      {}{}, order {}\norbits     {} ({})\n", options.dim, group_name,
               options.inversion ? " with inversion" : "", order, orbits.to_decimal(),
               enumerated ? "by Burnside's lemma and by enumeration" : "by Burnside's lemma");
  }
  return 0;
}

}  // namespace tegl::gen
