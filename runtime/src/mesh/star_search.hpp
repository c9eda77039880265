// SPDX-License-Identifier: BSD-3-Clause
//
// Tests whether the link of a vertex of tetrahedra is a sphere or a disc, by a search through the tetrahedra around the
// vertex.
//
// The link is a surface of triangles, one in each of these tetrahedra. If each edge is in one or two triangles, and all
// triangles are connected across edges, they form a connected surface some of whose points may be identified. The Euler
// characteristic of a connected surface is 2 for a sphere, 1 for a disc, and less for any other surface without or with
// a border; each identification of two points subtracts 1. So if it is 2 without a border, or 1 with one, the triangles
// are a sphere or a disc, and no points are identified.
//
// Based on: H. Seifert and W. Threlfall, Lehrbuch der Topologie, 1934, § 38 (a connected surface without a border is a
// sphere iff its Euler characteristic is 2; with a border it is a disc iff it is 1).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "mesh/incidence_data.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// For the vertices from, from + 1, …: 1 if the link is a sphere or a disc. Else 0, as for vertices that StarSearch has
/// to decide. `rows`: #S x 4, row = tetrahedron.
void find_spheres_and_discs(const Index* rows, const IncidenceData<4>& incidence, std::size_t from,
                            std::span<std::uint8_t> found);

/// For stars of any size. Use one object per thread; it takes 4 bytes per tetrahedron.
class StarSearch {
 public:
  /// `rows`: #S x 4, row = tetrahedron.
  StarSearch(std::span<const Index> rows, const IncidenceData<4>& incidence)
      : rows_(rows.data()), incidence_(incidence), seen_(rows.size() / 4, std::numeric_limits<Index>::max()) {}

  /// False also if a triangle at v is in more than two tetrahedra. v must be a vertex of a tetrahedron.
  [[nodiscard]] bool is_sphere_or_disc(Index v) {
    const std::span<const Index> star = incidence_.stars.of(v);
    std::size_t border = 0;
    for (const Index s : star)
      for (int i = 0; i < 4; ++i) {
        if (rows_[std::size_t{s} * 4 + static_cast<std::size_t>(i)] == v) continue;
        if (incidence_.across[s][i] == kSeveralSimplices) return false;
        border += incidence_.across[s][i] == kNoSimplex ? 1 : 0;
      }
    const std::size_t edges = (3 * star.size() + border) / 2;
    return incidence_.edges_of(v) + star.size() == edges + (border == 0 ? 2 : 1) && is_connected(v, star);
  }

 private:
  /// Whether all tetrahedra around v are connected across triangles at v, each of which is in one or two of them.
  [[nodiscard]] bool is_connected(Index v, std::span<const Index> star) {
    if (open_.size() < star.size() + 1) open_.resize(star.size() + 1);
    Index* const open = open_.data();
    Index* const seen = seen_.data();
    const auto* const across = incidence_.across.data();
    std::size_t found = 1;
    open[0] = star[0];
    seen[star[0]] = v;
    for (std::size_t next = 0; next < found; ++next) {
      const Index s = open[next];
      const Index* const row = rows_ + std::size_t{s} * 4;
      for (int i = 0; i < 4; ++i) {
        // without a branch: a tetrahedron that is seen already stands for none
        const bool is_wanted = (row[i] != v) & (across[s][i] < kSeveralSimplices);
        const Index there = is_wanted ? across[s][i] : s;
        open[found] = there;
        found += seen[there] != v ? 1 : 0;
        seen[there] = v;
      }
    }
    return found == star.size();
  }

  const Index* rows_;
  const IncidenceData<4>& incidence_;
  std::vector<Index> seen_;  ///< by tetrahedron: the last vertex in whose star it was met
  std::vector<Index> open_;  ///< tetrahedra in the order in which they are met
};

}  // namespace tegl::detail
