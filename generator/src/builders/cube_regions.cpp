// SPDX-License-Identifier: BSD-3-Clause
//
// A region of a cube is bounded by parts of its squares and of the contour. A region bounded by a sphere is a ball. It
// is divided into tetrahedra that are proved to be positive (region_maker.hpp). If none are found, a region that is a
// ball is coned: from one of its corners if the cone adds no simplex in a square, otherwise from a new vertex.
#include "builders/cube_regions.hpp"

#include <algorithm>
#include <bit>
#include <map>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "cubes/cube_frame.hpp"
#include "embedding/region_maker.hpp"
#include "tegl/tile/complex.hpp"
#include "tegl/tile/corners.hpp"

namespace tegl::gen {

namespace {

using detail::edge_number;
using detail::face_sign;

using Triangle = std::array<std::uint8_t, 3>;
using Tetrahedron = CubeRegions::Tetrahedron;
using Set = std::uint64_t;  ///< bit set of local vertices

constexpr unsigned kFirstEdge = CubeRegions::kFirstEdge, kFirstOwn = CubeRegions::kFirstOwn;

constexpr Set bit(unsigned v) { return Set{1} << v; }
constexpr Set set_of(const Triangle& t) { return bit(t[0]) | bit(t[1]) | bit(t[2]); }

/// Local vertices in each square.
const std::array<Set, 6> kSquares = RegionFrame().squares;

bool in_one_square(Set vertices) {
  return std::any_of(kSquares.begin(), kSquares.end(), [&](Set square) { return (vertices & ~square) == 0; });
}

std::uint8_t edge_between(unsigned a, unsigned b) {
  const auto axis = static_cast<unsigned>(std::countr_zero(a ^ b));
  return static_cast<std::uint8_t>(kFirstEdge + edge_number(3, axis, a));
}

/// One side of a cube with its contour.
struct Side {
  unsigned signature, high_squares;
  bool high;

  [[nodiscard]] bool has(unsigned corner) const { return ((signature >> corner & 1u) != 0) == high; }

  /// Appends the side's part of a square: each polygon as a fan from its lowest corner, or from the middle one of
  /// three. Adjacent cubes get the same triangles. Oriented outwards for the low side, inwards for the high side: this
  /// continues the contour, which is oriented towards high.
  void add_square(unsigned q, std::vector<Triangle>& to) const {
    const unsigned axis = q / 2, b = axis == 0 ? 1 : 0, c = axis == 2 ? 1 : 2, at = (q % 2) << axis;
    std::array<unsigned, 4> ring = {at, at | 1u << b, at | 1u << b | 1u << c, at | 1u << c};
    if ((face_sign(q) > 0) == high) std::reverse(ring.begin(), ring.end());
    std::vector<std::uint8_t> outline;
    unsigned corners = 0;
    for (unsigned i = 0; i < 4; ++i) {
      const unsigned here = ring[i], next = ring[(i + 1) % 4];
      if (has(here)) outline.push_back(static_cast<std::uint8_t>(here)), ++corners;
      if (has(here) != has(next)) outline.push_back(edge_between(here, next));
    }
    const std::size_t n = outline.size();
    const bool apart = corners == 2 && n == 6 && ((high_squares >> q & 1u) != 0) != high;
    if (apart) {
      for (std::size_t i = 0; i < n; ++i)
        if (outline[i] < 8) to.push_back({outline[(i + n - 1) % n], outline[i], outline[(i + 1) % n]});
    } else if (corners != 0) {
      const auto is_apex = [&](std::size_t i) {
        return corners != 3 ? outline[i] == *std::min_element(outline.begin(), outline.end())
                            : outline[(i + n - 1) % n] < 8 && outline[i] < 8 && outline[(i + 1) % n] < 8;
      };
      std::size_t apex = 0;
      while (!is_apex(apex)) ++apex;
      std::rotate(outline.begin(), outline.begin() + static_cast<std::ptrdiff_t>(apex), outline.end());
      for (std::size_t i = 1; i + 1 < n; ++i) to.push_back({outline[0], outline[i], outline[i + 1]});
    }
  }
};

using DirectedEdge = std::pair<std::uint8_t, std::uint8_t>;

DirectedEdge edge(const Triangle& t, unsigned i) { return {t[i], t[(i + 1) % 3]}; }
DirectedEdge reversed(DirectedEdge e) { return {e.second, e.first}; }

int euler_characteristic(const std::vector<Triangle>& closed) {
  Set vertices = 0;
  for (const Triangle& t : closed) vertices |= set_of(t);
  return std::popcount(vertices) - static_cast<int>(closed.size()) / 2;
}

/// Connected components of triangles; `through(edge)`: whether an edge connects.
template <class Through>
std::vector<std::vector<Triangle>> parts_of(const std::vector<Triangle>& triangles, const Through& through) {
  std::map<DirectedEdge, std::size_t> at;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (unsigned j = 0; j < 3; ++j) at[edge(triangles[i], j)] = i;
  std::vector<bool> seen(triangles.size());
  std::vector<std::vector<Triangle>> result;
  for (std::size_t first = 0; first < triangles.size(); ++first) {
    if (seen[first]) continue;
    std::vector<std::size_t> reached{first};
    seen[first] = true;
    auto& part = result.emplace_back();
    for (std::size_t k = 0; k < reached.size(); ++k) {
      part.push_back(triangles[reached[k]]);
      for (unsigned j = 0; j < 3; ++j) {
        const DirectedEdge e = edge(triangles[reached[k]], j);
        const auto next = at.find(reversed(e));
        if (next == at.end() || seen[next->second] || !through(e)) continue;
        seen[next->second] = true;
        reached.push_back(next->second);
      }
    }
  }
  return result;
}

/// Whether the cone of a sphere from `apex` adds no simplex in a square beyond the square's own triangulation.
bool may_be_apex(const std::vector<Triangle>& sphere, std::uint8_t apex) {
  std::array<Set, RegionFrame::kEnd> around{};
  std::set<Set> triangles;
  for (const Triangle& t : sphere) {
    triangles.insert(set_of(t));
    for (const std::uint8_t v : t) around[v] |= set_of(t);
  }
  for (const Triangle& t : sphere) {
    if ((set_of(t) & bit(apex)) != 0) continue;
    for (unsigned i = 0; i < 3; ++i) {
      const Set with_apex = bit(t[i]) | bit(apex), triangle = with_apex | bit(t[(i + 1) % 3]);
      if (in_one_square(with_apex) && (around[apex] & bit(t[i])) == 0) return false;
      if (in_one_square(triangle) && !triangles.contains(triangle)) return false;
    }
    if (in_one_square(set_of(t) | bit(apex))) return false;
  }
  return true;
}

/// The vertices of a list and of a side for divide_region.
RegionFrame frame_of(const CubeLists& lists, std::size_t number, const std::vector<Triangle>& contour, bool is_cap) {
  RegionFrame frame;
  frame.is_cap = is_cap;
  if (number < lists.lists.size())
    for (unsigned j = 0; j < lists.lists[number].own_vertices; ++j) {
      const std::uint32_t mask = lists.lists[number].masks[j];
      frame.points[kFirstOwn + j] = is_on_ray(mask) ? RegionProof::on_ray(mask) : mask;
      if (j < lists.lists[number].barycentres && !is_cap) frame.barycentres |= bit(kFirstOwn + j);
    }
  for (const Triangle& t : contour)
    if (!is_cap) frame.on_contour |= set_of(t);
  return frame;
}

/// Divides the regions of one side of a cube into tetrahedra.
class RegionMaker {
 public:
  explicit RegionMaker(bool is_barycentric) : is_barycentric_(is_barycentric) {}

  std::vector<Tetrahedron> tetrahedra;
  std::vector<std::uint32_t> centres;
  bool is_proved = false;

  bool divide(const RegionProof& proof, const RegionFrame& frame, std::vector<Triangle> surface, bool high) {
    if (high)
      for (Triangle& t : surface) std::swap(t[1], t[2]);
    const auto division = divide_region(proof, frame, surface);
    if (!division) return false;
    is_proved = true;
    tetrahedra = division->tetrahedra;
    if (high)
      for (Tetrahedron& t : tetrahedra) std::swap(t[2], t[3]);
    centres = division->centres;
    return true;
  }

  /// Cones a ball, given by its whole boundary.
  void fill(const std::vector<Triangle>& sphere) {
    if (euler_characteristic(sphere) != 2)
      throw Error(ErrorCode::CertificateFailed, "a region of a cube that is not a ball and has no proved division");
    const bool is_simplex = sphere.size() == 4;
    Set corners = 0;
    for (const Triangle& t : sphere) corners |= set_of(t) & 0xffu;
    for (; corners != 0 && (is_simplex || !is_barycentric_); corners &= corners - 1)
      if (const auto v = static_cast<std::uint8_t>(std::countr_zero(corners)); may_be_apex(sphere, v))
        return cone(sphere, v);
    Set vertices = 0;
    for (const Triangle& t : sphere) vertices |= set_of(t);
    centres.push_back(static_cast<std::uint32_t>(vertices & (bit(kFirstOwn) - 1)));
    cone(sphere, static_cast<std::uint8_t>(CubeRegions::kFirstCentre));
  }

 private:
  void cone(const std::vector<Triangle>& sphere, std::uint8_t apex) {
    for (const Triangle& t : sphere)
      if ((set_of(t) & bit(apex)) == 0) tetrahedra.push_back({apex, t[0], t[1], t[2]});
  }

  bool is_barycentric_;
};

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

}  // namespace

std::size_t CubeRegions::proved() const {
  return static_cast<std::size_t>(
      std::count_if(regions.begin(), regions.end(), [](const Region& r) { return r.is_proved; }));
}

CubeRegions make_cube_regions(const CubeLists& lists, bool is_cap) {
  const RegionProof proof;
  CubeRegions result;
  const std::size_t whole = lists.lists.size();
  for (std::size_t number = 0; number <= whole; ++number)
    for (const bool high : {false, true}) {
      result.first_region.push_back(static_cast<std::uint32_t>(result.regions.size()));
      if (is_cap && !high) continue;
      const bool is_whole = number == whole;
      // boundary of the side
      const Side side{is_whole ? (high ? 255u : 0u) : lists.lists[number].signature,
                      is_whole ? 0u : lists.lists[number].high_squares, high};
      std::vector<Triangle> surface, contour;
      for (unsigned q = 0; q < 6; ++q) side.add_square(q, surface);
      if (!is_whole) {
        const std::span<const std::uint8_t> triangles = lists.triangles_of(number);
        for (std::size_t t = 0; t < triangles.size(); t += 3)
          contour.push_back({static_cast<std::uint8_t>(kFirstEdge + triangles[t]),
                             static_cast<std::uint8_t>(kFirstEdge + triangles[t + 1]),
                             static_cast<std::uint8_t>(kFirstEdge + triangles[t + 2])});
        surface.insert(surface.end(), contour.begin(), contour.end());
      }
      const RegionFrame frame = frame_of(lists, number, contour, is_cap);
      // regions
      for (const auto& part : parts_of(surface, [](DirectedEdge) { return true; })) {
        RegionMaker maker(lists.triangulation == Triangulation::barycentric);
        if (!maker.divide(proof, frame, part, high)) {
          if (is_cap) throw Error(ErrorCode::CertificateFailed, "a cap of a cube without a proved division");
          maker.fill(part);
        }
        certify(maker.tetrahedra, part);
        Set vertices = 0;
        for (const Triangle& t : part) vertices |= set_of(t);
        result.regions.push_back(
            {static_cast<std::uint8_t>(vertices & 0xffu), static_cast<std::uint8_t>(maker.centres.size()),
             static_cast<std::uint16_t>(maker.tetrahedra.size()), static_cast<std::uint32_t>(result.tetrahedra.size()),
             static_cast<std::uint32_t>(result.centres.size()), maker.is_proved});
        result.tetrahedra.insert(result.tetrahedra.end(), maker.tetrahedra.begin(), maker.tetrahedra.end());
        result.centres.insert(result.centres.end(), maker.centres.begin(), maker.centres.end());
      }
    }
  result.first_region.push_back(static_cast<std::uint32_t>(result.regions.size()));
  return result;
}

}  // namespace tegl::gen
