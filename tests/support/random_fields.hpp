// SPDX-License-Identifier: BSD-3-Clause
//
// Random fields of integers for the oracle (multilinear.hpp), the same as images, and the comparison of a contour with
// the interpolant's: how many components, what Euler characteristic, and which critical edges each component meets.
#pragma once

#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "fields.hpp"
#include "invariants.hpp"
#include "multilinear.hpp"
#include "tegl/components.hpp"
#include "tegl/extract.hpp"

namespace tegl::test {

/// How many of `count` random fields a test looks at: all where the environment has TEGL_FULL_TOPOLOGY, else `share`.
inline std::size_t fields_to_test(std::size_t count, std::size_t share) {
  return std::getenv("TEGL_FULL_TOPOLOGY") != nullptr ? count : share;
}

/// Integers from -bound to bound, and around them, where `padded`, one layer below all.
template <int N>
SampledField<N> random_field(std::mt19937_64& bits, std::size_t samples, std::int64_t bound, bool padded = false) {
  SampledField<N> field;
  const std::size_t size = samples + (padded ? 2 : 0);
  field.sizes.fill(size);
  std::array<std::size_t, N> sizes = field.sizes;
  for_each_sample<N>(Grid<N>::unit(sizes), [&](std::size_t, const std::array<std::size_t, N>& index) {
    bool border = false;
    for (const std::size_t i : index) border = border || (padded && (i == 0 || i + 1 == size));
    const auto drawn = border ? 0 : random_below(bits, 2 * static_cast<std::uint64_t>(bound) + 1);
    field.values.push_back(border ? -bound - 1 : static_cast<std::int64_t>(drawn) - bound);
  });
  return field;
}

/// The field as an image on a grid of unit steps.
template <Value T, int N>
OwnedImage<T, N> image_of(const SampledField<N>& field, T shift = 0) {
  OwnedImage<T, N> image{Grid<N>::unit(field.sizes), {}};
  for (const std::int64_t value : field.values) image.values.push_back(static_cast<T>(static_cast<T>(value) + shift));
  return image;
}

/// The two samples at the ends of the edge of the grid that a vertex lies on, if it lies inside one.
template <int N, class Real>
std::optional<std::array<std::size_t, 2>> edge_of(const std::array<Real, N>& vertex,
                                                  const std::array<std::size_t, N>& sizes) {
  std::size_t first = 0, stride = 1, step = 0;
  for (int a = 0; a < N; stride *= sizes[a], ++a) {
    const Real whole = std::floor(vertex[a]);
    first += static_cast<std::size_t>(whole) * stride;
    if (vertex[a] == whole) continue;
    if (step != 0) return std::nullopt;
    step = stride;
  }
  if (step == 0) return std::nullopt;
  return std::array{first, first + step};
}

template <int N>
std::string describe(const SampledField<N>& field) {
  std::ostringstream text;
  text << "samples less isovalue:";
  for (const std::int64_t value : field.values) text << ' ' << value;
  return text.str();
}

/// Whether the contour is what the interpolant's is: an oriented manifold with its components, each meeting the same
/// critical edges, and with its Euler characteristic. For regular fields on grids of unit steps.
template <int N, class Real>
::testing::AssertionResult has_topology_of(const Contour<N, Real>& contour, const SampledField<N>& field,
                                           const InterpolantTopology& expected) {
  const auto failure = [&] { return ::testing::AssertionFailure() << describe(field) << ": "; };
  const MeshReport report = check(contour);
  if (const auto sound = is_oriented_manifold(report); !sound) return failure() << sound.message();
  const Topology found{static_cast<std::int64_t>(report.components), report.euler};
  if (!(found == expected.contour)) return failure() << found << "; the interpolant has " << expected.contour;
  const ComponentLabels labels = label_components(contour);
  std::map<std::pair<std::size_t, std::size_t>, Index> component_between;  // a low and a high piece
  std::set<Index> seen;
  std::size_t edges = 0;
  for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
    const auto edge = edge_of(contour.vertices[v], field.sizes);
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
