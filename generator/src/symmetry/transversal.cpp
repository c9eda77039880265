// SPDX-License-Identifier: BSD-3-Clause
//
// Orbits under a group of symmetries of the cube, checked against Burnside's lemma.
#include "symmetry/transversal.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "symmetry/counting.hpp"

namespace tegl::gen {

Transversal transversal(int n, std::span<const Element> group) {
  if (n < 1 || n > kMaxEnumeratedDim) {
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("enumerating signatures in dimension {}: expected 1 to {}", n, kMaxEnumeratedDim));
  }
  std::vector<CornerMap> maps;
  maps.reserve(group.size());
  for (const Element& g : group) {
    maps.push_back({corner_permutation(g, n), g.inverts});
  }
  return orbits(std::size_t{1} << n, maps);
}

void require_burnside_count(const Transversal& classes, int n, GroupKind kind, bool inversion) {
  const WideUint expected = burnside_orbits(n, kind, inversion);
  const std::size_t found = classes.representatives.size();
  if (!(WideUint{found} == expected)) {
    throw Error(ErrorCode::CountMismatch,
                fmt::format("dimension {}: {} classes by enumeration, {} by Burnside's lemma: expected the same", n,
                            found, expected.to_decimal()));
  }
}

}  // namespace tegl::gen
