// SPDX-License-Identifier: BSD-3-Clause
//
// Compares a contour with the interpolant's (multilinear.hpp): number of components, Euler characteristic, and the
// critical edges that each component meets.
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "invariants.hpp"
#include "multilinear.hpp"
#include "random_fields.hpp"
#include "tegl/components.hpp"

namespace tegl::test {

/// True if the contour is an oriented manifold with the interpolant's Euler characteristic and components, each of
/// which meets the same critical edges. For regular fields on grids of unit steps.
template <int N, class Real>
::testing::AssertionResult has_topology_of(const Contour<N, Real>& contour, const SampledField<N>& field,
                                           const InterpolantTopology& expected) {
  const auto failure = [&] { return ::testing::AssertionFailure() << describe(field) << ": "; };
  const MeshReport report = check(contour);
  if (const auto sound = is_oriented_manifold(report); !sound) return failure() << sound.message();
  const Topology found{static_cast<std::int64_t>(report.components), report.euler};
  if (!(found == expected.contour)) return failure() << found << "; the interpolant has " << expected.contour;
  const ComponentLabels labels = label_components(contour);
  std::map<std::pair<std::size_t, std::size_t>, Index> component_between;  // key: a low and a high component
  std::set<Index> seen;
  std::size_t edges = 0;
  for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
    const auto edge = edge_of<N>(contour.vertices[v], field.sizes);
    if (!edge) continue;
    ++edges;
    auto [low, high] = *edge;
    if (field.values[low] >= 0) std::swap(low, high);
    if (field.values[low] >= 0 || field.values[high] < 0)
      return failure() << "a vertex on an edge that is not critical";
    const std::pair between{expected.pieces[low], expected.pieces[high]};
    const auto [known, is_new] = component_between.emplace(between, labels.vertices[v]);
    if (known->second != labels.vertices[v] || (is_new && !seen.insert(labels.vertices[v]).second))
      return failure() << "components meet other edges than the interpolant's";
  }
  if (edges == 0 && expected.contour.components > 0) return failure() << "no vertex on an edge";
  return ::testing::AssertionSuccess();
}

}  // namespace tegl::test
