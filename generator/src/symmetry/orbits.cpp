// SPDX-License-Identifier: BSD-3-Clause
//
// Orbits of signatures in ascending order: the first unreached signature is the smallest of its orbit.
//
// Based on: M. Liversage, thesis, 1994, algorithm 7.4.9.
#include "symmetry/orbits.hpp"

#include <fmt/format.h>

#include <limits>

#include "base/error.hpp"
#include "symmetry/symmetry.hpp"

namespace tegl::gen {

namespace {

constexpr std::uint32_t kUnreached = std::numeric_limits<std::uint32_t>::max();

}  // namespace

Transversal orbits(std::size_t corners, std::span<const CornerMap> group) {
  const std::size_t signatures = std::size_t{1} << corners;
  Transversal result;
  result.class_of.assign(signatures, kUnreached);
  result.element_of.assign(signatures, kUnreached);
  for (std::uint32_t representative = 0; representative < signatures; ++representative) {
    if (result.class_of[representative] != kUnreached) {
      continue;
    }
    const auto index = static_cast<std::uint32_t>(result.representatives.size());
    std::uint32_t length = 0;
    for (std::uint32_t g = 0; g < group.size(); ++g) {
      Element exchange;
      exchange.inverts = group[g].inverts;
      const std::uint32_t s = act(exchange, group[g].corner, representative);
      if (result.class_of[s] == kUnreached) {
        result.class_of[s] = index;
        result.element_of[s] = g;
        ++length;
      } else if (result.class_of[s] != index) {
        throw Error(ErrorCode::Internal,
                    fmt::format("signature {} is in the orbits of {} and {}: the elements are no group", s,
                                result.representatives[result.class_of[s]], representative));
      }
    }
    if (length == 0 || result.class_of[representative] != index || group.size() % length != 0) {
      throw Error(
          ErrorCode::Internal,
          fmt::format("the orbit of {} has {} signatures: expected itself among them and a divisor of the order {}",
                      representative, length, group.size()));
    }
    result.representatives.push_back(representative);
    result.orbit_length.push_back(length);
  }
  return result;
}

}  // namespace tegl::gen
