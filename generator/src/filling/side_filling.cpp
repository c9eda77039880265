// SPDX-License-Identifier: BSD-3-Clause
//
// Side filling. If the tile's centre is low, the contour inside the tile is a copy of the high part of the tile's
// boundary, pushed inwards and fixed at Sigma. It is a manifold with boundary Sigma for any Sigma. The high part is
// triangulated cube by cube (tile_regions.hpp). Vertices on Sigma are kept; every other vertex becomes an own vertex of
// the tile.
#include "filling/side_filling.hpp"

#include <algorithm>
#include <array>
#include <compare>
#include <map>
#include <stdexcept>
#include <utility>

namespace tegl::gen {

namespace {

/// A vertex of the side: a contour vertex (local number), or a point of the tile's boundary given by the corners (bit
/// v) and edges (bit 16 + e) of which it is the mean. `cube` distinguishes regions of different cubes; -1 for points
/// that cubes share.
struct Place {
  int contour_vertex = -1;
  std::uint64_t mask = 0;
  int cube = -1;
  auto operator<=>(const Place&) const = default;
};

std::uint64_t lift_mask(const SubTile& cube, std::uint32_t mask) {
  std::uint64_t result = 0;
  for (std::size_t v = 0; v < cube.corner.size(); ++v)
    if (((mask >> v) & 1u) != 0) result |= std::uint64_t{1} << cube.corner[v];
  for (std::size_t e = 0; e < cube.edge.size(); ++e)
    if (((mask >> (cube.corner.size() + e)) & 1u) != 0) result |= std::uint64_t{1} << (16 + cube.edge[e]);
  return result;
}

Place place_of(const FaceContours& faces, const SignatureRegions& regions, std::uint32_t f, Signature in_cube,
               std::uint8_t vertex) {
  const Tile& tile = faces.tile();
  const SubTile& cube = tile.faces[f];
  const std::uint32_t corners = cube.tile->corner_count();
  const std::uint32_t edges_end = corners + cube.tile->edge_count();
  const std::uint32_t squares = regions.own_base() - static_cast<std::uint32_t>(cube.tile->faces.size());
  if (vertex < corners) return {-1, std::uint64_t{1} << cube.corner[vertex], -1};
  if (vertex < edges_end) return {cube.edge[vertex - corners], 0, -1};
  if (vertex < squares) return {static_cast<int>(faces.lift(f, static_cast<std::uint8_t>(vertex - corners))), 0, -1};
  const bool shared = vertex < regions.own_base();  // a square's region lies in two cubes
  return {-1, lift_mask(cube, regions.mask_of(in_cube, vertex)), shared ? -1 : static_cast<int>(f)};
}

using Tetrahedron = std::array<Place, 4>;

/// The high part of the tile's boundary (for ~signature: the low part), with the boundary's orientation.
std::vector<Tetrahedron> side_of(const FaceContours& faces, const SignatureRegions& regions, Signature signature) {
  std::vector<Tetrahedron> side;
  for (std::uint32_t f = 0; f < faces.tile().faces.size(); ++f) {
    const Signature in_cube = faces.tile().restrict_to(f, signature);
    for (const LocalSimplex& s : regions.regions(in_cube).simplices) {
      Tetrahedron t;
      for (int i = 0; i < 4; ++i) t[i] = place_of(faces, regions, f, in_cube, s[i]);
      if (faces.tile().faces[f].sign < 0) std::swap(t[2], t[3]);
      side.push_back(t);
    }
  }
  return side;
}

/// Keeps the connected component of the given contour vertex.
void keep_connected(std::vector<Tetrahedron>& side, int contour_vertex) {
  std::map<Place, bool> reached{{Place{contour_vertex, 0, -1}, true}};
  for (bool grown = true; grown;) {
    grown = false;
    for (const Tetrahedron& t : side) {
      const bool touches = std::any_of(t.begin(), t.end(), [&](const Place& p) { return reached.contains(p); });
      if (touches)
        for (const Place& p : t) grown |= reached.emplace(p, true).second;
    }
  }
  std::erase_if(side, [&](const Tetrahedron& t) { return !reached.contains(t[0]); });
}

/// +1 if `tetrahedra` induce the triangle's orientation on it, -1 if the opposite one, 0 if it is not a face of them.
int induced_sign(const std::vector<LocalSimplex>& tetrahedra, const LocalSimplex& triangle) {
  static constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  for (const LocalSimplex& t : tetrahedra)
    for (const auto& f : kFaces)
      for (int turn = 0; turn < 3; ++turn) {
        const std::uint8_t a = t[f[turn]], b = t[f[(turn + 1) % 3]], c = t[f[(turn + 2) % 3]];
        if (a == triangle[0] && b == triangle[1] && c == triangle[2]) return 1;
        if (a == triangle[0] && c == triangle[1] && b == triangle[2]) return -1;
      }
  return 0;
}

}  // namespace

void fill_by_side(const FaceContours& faces, const SignatureRegions& regions, Signature signature,
                  const std::vector<LocalSimplex>& component, TileContour& contour, LocalFacet& facet) {
  // The low side in the high-connected alternative is the high side in the low-connected one after inversion.
  const Signature high = faces.alternative() == Alternative::low ? signature : ~signature & faces.tile().full();
  auto side = side_of(faces, regions, high);
  keep_connected(side, component.front()[0]);

  // number the vertices: those on Sigma keep their number, others are own vertices
  std::map<Place, std::uint8_t> number;
  for (const Tetrahedron& t : side)
    for (const Place& p : t) number.emplace(p, 0);
  std::uint32_t on_sigma = 0;
  for (auto& [place, id] : number) {
    if (place.contour_vertex >= 0) {
      id = static_cast<std::uint8_t>(place.contour_vertex);
      ++on_sigma;
    } else {
      const std::size_t own = faces.own_base() + contour.cone_vertices + contour.side_masks.size();
      if (own > 255) throw std::logic_error("side filling needs more local vertices than a byte can number");
      id = static_cast<std::uint8_t>(own);
      contour.side_masks.push_back(place.mask);
    }
  }
  // the side must meet Sigma in this component only
  std::map<int, int> sigma_vertices;
  for (const LocalSimplex& s : component)
    for (int i = 0; i < 3; ++i) sigma_vertices[s[i]] = 1;
  if (sigma_vertices.size() != on_sigma)
    throw std::logic_error("a side is bounded by more than one component: joining them is not the consistent method");

  // write, with the component's orientation
  for (const Tetrahedron& t : side)
    facet.simplices.push_back({number.at(t[0]), number.at(t[1]), number.at(t[2]), number.at(t[3])});
  if (induced_sign(facet.simplices, component.front()) < 0)
    for (LocalSimplex& s : facet.simplices) std::swap(s[2], s[3]);
}

}  // namespace tegl::gen
