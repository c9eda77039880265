// SPDX-License-Identifier: BSD-3-Clause
//
// Unrolls wrapped contours: doubles the vertices that simplices across the seam have at the start of a period.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <span>

#include "base/periods.hpp"
#include "kernel/contour_output.hpp"
#include "mesh/validate.hpp"
#include "tegl/periodic.hpp"

namespace tegl {
namespace {

/// A vertex moved by a number of each period.
template <int N>
struct Moved {
  Index vertex = 0;
  std::array<int, N> times{};
  auto operator<=>(const Moved&) const = default;
};

/// By corner of a simplex, the periods by which it moves: neighbours of corner 0, then moved so that no share of the
/// simplex is below that of the corners that stay.
template <int N, class Real>
std::array<Moved<N>, N> moved_corners(const Contour<N, Real>& contour,
                                      const typename Contour<N, Real>::Simplex& simplex) {
  std::array<Moved<N>, N> moved;
  for (int j = 0; j < N; ++j) moved[j].vertex = simplex[j];
  for (std::size_t p = 0; p < contour.periods.size(); ++p) {
    const auto share = [&](int j) {
      return detail::share_of(contour.periods[p], detail::widened_point<N>(contour.vertices[simplex[j]]));
    };
    int least = 0;
    for (int j = 0; j < N; ++j) {
      moved[j].times[p] = static_cast<int>(std::round(share(0) - share(j)));
      least = std::min(least, moved[j].times[p]);
    }
    for (Moved<N>& corner : moved) corner.times[p] -= least;
  }
  return moved;
}

void append_copies(std::vector<Attribute>& attributes, std::span<const Index> copied) {
  for (Attribute& attribute : attributes) {
    const auto width = static_cast<std::size_t>(attribute.width);
    for (const Index v : copied)
      for (std::size_t i = 0; i < width; ++i) attribute.values.push_back(attribute.values[v * width + i]);
  }
}

}  // namespace

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4> Unrolled<N, Real> unroll(const Contour<N, Real>& contour) {
  detail::require_vertices(contour);
  detail::require_attributes(contour);
  Unrolled<N, Real> result{contour, {}};
  Contour<N, Real>& unrolled = result.contour;
  unrolled.periods.clear();
  std::map<Moved<N>, Index> numbers;
  std::vector<Index> copied;
  for (auto& simplex : unrolled.simplices) {
    for (const Moved<N>& corner : moved_corners<N, Real>(contour, simplex)) {
      if (corner.times == std::array<int, N>{}) continue;
      const auto [at, is_new] = numbers.try_emplace(corner, static_cast<Index>(unrolled.vertices.size()));
      if (is_new) {
        detail::check_vertex_count(unrolled.vertices.size() + 1, detail::kMaxVertices);
        std::array<double, N> x = detail::widened_point<N>(contour.vertices[corner.vertex]);
        for (std::size_t p = 0; p < contour.periods.size(); ++p)
          detail::add_times(contour.periods[p], corner.times[p], x);
        auto& vertex = unrolled.vertices.emplace_back();
        for (int a = 0; a < N; ++a) vertex[a] = static_cast<Real>(x[a]);
        copied.push_back(corner.vertex);
      }
      *std::find(simplex.begin(), simplex.end(), corner.vertex) = at->second;
    }
  }
  for (const Index v : copied)
    if (!contour.normals.empty()) unrolled.normals.push_back(contour.normals[v]);
  append_copies(unrolled.vertex_attributes, copied);
  result.originals.resize(contour.vertices.size());
  std::iota(result.originals.begin(), result.originals.end(), Index{0});
  result.originals.insert(result.originals.end(), copied.begin(), copied.end());
  return result;
}

#define TEGL_INSTANTIATE_CONTOURS(N, Real) template Unrolled<N, Real> unroll<N, Real>(const Contour<N, Real>&);
#include "base/instantiate.hpp"

}  // namespace tegl
