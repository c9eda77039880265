// SPDX-License-Identifier: BSD-3-Clause
//
// A region of a cube is bounded by parts of its squares and of the contour. It is divided into tetrahedra that are
// proved to be positive (region_maker.hpp).
#include "builders/cube_regions.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <string>

#include <fmt/format.h>

#include "base/error.hpp"
#include "cubes/cube_sides.hpp"
#include "tegl/tile/complex.hpp"

namespace tegl::gen {

namespace {

using Triangle = RegionTriangle;
using Tetrahedron = CubeRegions::Tetrahedron;
using Set = std::uint64_t;  ///< bit set of local vertices

constexpr unsigned kFirstEdge = CubeRegions::kFirstEdge;

constexpr Set bit(unsigned v) { return Set{1} << v; }
constexpr Set set_of(const Triangle& t) { return bit(t[0]) | bit(t[1]) | bit(t[2]); }

/// Local vertices in each square.
const std::array<Set, 6> kSquares = RegionFrame().squares;

bool in_one_square(Set vertices) {
  return std::any_of(kSquares.begin(), kSquares.end(), [&](Set square) { return (vertices & ~square) == 0; });
}

/// The certificate of a region: its boundary is the surface, with orientations; the link of every vertex is a disc, or
/// a sphere for a vertex that is not on the surface; an edge or triangle in a square belongs to the surface.
void certify(const std::vector<Tetrahedron>& tetrahedra, const std::vector<Triangle>& surface) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw Error(ErrorCode::CertificateFailed, std::string("a region of a cube: ") + what);
  };
  std::map<Triangle, int> boundary;  // by sorted triangle
  const auto count = [&](Triangle t, int sign) {
    const int parity = tile::sort_vertices(t);
    boundary[t] += parity * sign;
  };
  std::map<std::uint8_t, tile::Simplices> links;
  std::map<Set, int> faces;
  for (const Tetrahedron& tetrahedron : tetrahedra)
    for (std::size_t i = 0; i < 4; ++i) {
      Triangle face{};
      tile::Simplex in_link = tile::kNoSimplex;
      for (std::size_t j = 0, k = 0; j < 4; ++j)
        if (j != i) in_link[k] = tetrahedron[j], face[k++] = tetrahedron[j];
      count(face, i % 2 == 0 ? 1 : -1);
      ++faces[set_of(face)];
      tile::sort_vertices(in_link);
      links[tetrahedron[i]].push_back(in_link);
    }
  std::set<Set> on_surface;
  Set surface_vertices = 0;
  for (const Triangle& t : surface) {
    count(t, -1);
    on_surface.insert(set_of(t));
    surface_vertices |= set_of(t);
    for (unsigned i = 0; i < 3; ++i) on_surface.insert(bit(t[i]) | bit(t[(i + 1) % 3]));
  }
  for (const auto& [t, sum] : boundary) require(sum == 0, "its boundary is not its surface");
  for (const auto& [face, incident] : faces) {
    require(incident <= 2, "a triangle in three tetrahedra");
    require(!in_one_square(face) || on_surface.contains(face), "a triangle in a square that is not the square's");
    for (Set rest = face; rest != 0; rest &= rest - 1) {
      const Set pair = face & ~(rest & (0 - rest));
      require(!in_one_square(pair) || on_surface.contains(pair), "an edge in a square that is not the square's");
    }
  }
  for (const auto& [vertex, link] : links)
    require(tile::shape_of(link) == ((surface_vertices >> vertex & 1u) != 0 ? tile::Shape::ball : tile::Shape::sphere),
            "a link that is neither a disc nor a sphere");
}

/// A nested copy that passes the contour (templates/builder4_nested.cpp.in) has the regions on both of its sides. If
/// both had a double on the ray of the same barycentre, they would overlap beside it. `low`: doubles of the low
/// regions.
void require_other_doubles(const std::vector<std::uint32_t>& centres, bool high, std::uint32_t& low) {
  for (const std::uint32_t centre : centres) {
    if (centre < CubeRegions::kFirstDouble) continue;
    if (high && (low & centre) != 0)
      throw Error(ErrorCode::CertificateFailed, "regions of a cube: a barycentre with doubles on both sides");
    low |= high ? 0 : centre;
  }
}

}  // namespace

CubeRegions make_cube_regions(const CubeLists& lists, bool is_cap) {
  const RegionProof proof;
  CubeRegions result;
  const std::size_t whole = lists.lists.size();
  std::uint32_t doubles = 0;  // of the low regions of a list
  for (std::size_t number = 0; number <= whole; ++number)
    for (const bool high : {false, true}) {
      doubles = high ? doubles : 0;
      result.first_region.push_back(static_cast<std::uint32_t>(result.regions.size()));
      if (is_cap && !high) continue;
      const CubeLists::List list = number == whole ? CubeLists::List{} : lists.lists[number];
      const CubeSide side{number == whole && high ? 255u : list.signature, list.high_squares, high};
      std::vector<Triangle> contour;
      const auto triangles = number == whole ? std::span<const std::uint8_t>() : lists.triangles_of(number);
      for (std::size_t t = 0; t < triangles.size(); t += 3)
        contour.push_back({static_cast<std::uint8_t>(kFirstEdge + triangles[t]),
                           static_cast<std::uint8_t>(kFirstEdge + triangles[t + 1]),
                           static_cast<std::uint8_t>(kFirstEdge + triangles[t + 2])});
      const RegionFrame frame =
          region_frame(std::span(list.masks).first(list.own_vertices), list.barycentres, contour, is_cap);
      for (const std::vector<Triangle>& surface : side.regions(contour)) {
        const auto division = divide_side_region(proof, frame, surface, high);
        if (!division)
          throw Error(ErrorCode::CertificateFailed,
                      fmt::format("a {} of the cube of signature {} without a proved division",
                                  is_cap ? "cap" : "region", side.signature));
        certify(division->tetrahedra, surface);
        if (!is_cap) require_other_doubles(division->centres, high, doubles);
        Set vertices = 0;
        for (const Triangle& t : surface) vertices |= set_of(t);
        result.regions.push_back(
            {static_cast<std::uint8_t>(vertices & 0xffu), static_cast<std::uint8_t>(division->centres.size()),
             static_cast<std::uint16_t>(division->tetrahedra.size()),
             static_cast<std::uint32_t>(result.tetrahedra.size()), static_cast<std::uint32_t>(result.centres.size())});
        result.tetrahedra.insert(result.tetrahedra.end(), division->tetrahedra.begin(), division->tetrahedra.end());
        result.centres.insert(result.centres.end(), division->centres.begin(), division->centres.end());
      }
    }
  result.first_region.push_back(static_cast<std::uint32_t>(result.regions.size()));
  return result;
}

}  // namespace tegl::gen
