// SPDX-License-Identifier: BSD-3-Clause
//
// A region of a cube is bounded by parts of its squares and of the contour. A region bounded by a sphere is a ball. It
// is coned: from one of its corners if the cone adds no simplex in a square, otherwise from a new vertex. A region
// along a tunnel is a thickened sphere with holes, one hole per polygon. Cuts from each polygon to the next around a
// ring divide it into two balls.
//
// Theory: side filling; regions that contain the cube's centre are star-shaped, the others are collars.
#include "builders/cube_regions.hpp"

#include <algorithm>
#include <bit>
#include <map>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "builders/region_maker.hpp"
#include "filling/cube_frame.hpp"
#include "tegl/tile/complex.hpp"
#include "tegl/tile/corners.hpp"

namespace tegl::gen {

namespace {

using detail::edge_number;
using detail::face_corners;
using detail::face_edges;
using detail::face_sign;

using Triangle = std::array<std::uint8_t, 3>;
using Tetrahedron = CubeRegions::Tetrahedron;
using Set = std::uint64_t;  ///< bit set of local vertices

constexpr unsigned kFirstEdge = CubeRegions::kFirstEdge, kFirstOwn = CubeRegions::kFirstOwn,
                   kFirstSquare = CubeRegions::kFirstSquare;
constexpr unsigned kEnd = kFirstSquare + 6;  ///< one past the last local vertex

constexpr Set bit(unsigned v) { return Set{1} << v; }
constexpr Set set_of(const Triangle& t) { return bit(t[0]) | bit(t[1]) | bit(t[2]); }

/// Local vertices in each square.
const std::array<Set, 6> kSquares = [] {
  std::array<Set, 6> result{};
  for (unsigned q = 0; q < 6; ++q)
    result[q] = face_corners(3, q) | Set{face_edges(3, q)} << kFirstEdge | bit(kFirstSquare + q);
  return result;
}();

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
  bool has_square_centres;  ///< polygons with more than three vertices are coned from their barycentre

  [[nodiscard]] bool has(unsigned corner) const { return ((signature >> corner & 1u) != 0) == high; }

  /// Appends the side's part of a square: each polygon as a fan from its lowest corner, or from the middle one of
  /// three, or coned. Adjacent cubes get the same triangles. Oriented outwards for the low side, inwards for the high
  /// side: this continues the contour, which is oriented towards high.
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
    } else if (corners != 0 && n > 3 && has_square_centres) {
      for (std::size_t i = 0; i < n; ++i)
        to.push_back({static_cast<std::uint8_t>(kFirstSquare + q), outline[i], outline[(i + 1) % n]});
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
  std::array<Set, kEnd> around{};
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
RegionFrame frame_of(const CubeLists& lists, std::size_t number, const std::vector<Triangle>& contour,
                     const Side& side) {
  RegionFrame frame;
  frame.squares = kSquares;
  for (unsigned v = 0; v < kFirstOwn; ++v) frame.points[v] = RegionProof::Points{1} << v;
  if (number < lists.lists.size())
    for (unsigned j = 0; j < lists.lists[number].own_vertices; ++j) {
      const std::uint32_t mask = lists.lists[number].masks[j];
      frame.points[kFirstOwn + j] = is_on_ray(mask) ? RegionProof::on_ray(mask) : mask;
      if (j < lists.lists[number].barycentres && !side.has_square_centres) frame.barycentres |= bit(kFirstOwn + j);
    }
  for (unsigned q = 0; q < 6; ++q) {
    std::vector<Triangle> square;
    side.add_square(q, square);
    for (const Triangle& t : square)
      for (const std::uint8_t v : t)
        if (v < kFirstOwn) frame.points[kFirstSquare + q] |= RegionProof::Points{1} << v;
  }
  for (const Triangle& t : contour) frame.on_contour |= set_of(t);
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
    if (division->centre != 0) centres.push_back(division->centre);
    return true;
  }

  /// `surface`: the whole boundary of the region. `contour`: triangles of the list.
  void fill(const std::vector<Triangle>& surface, const std::vector<Triangle>& contour) {
    const int euler = euler_characteristic(surface);
    if (euler == 2) return fill_ball(surface);
    contour_ = contour;
    fill_collar(surface, static_cast<unsigned>(2 - euler / 2));
  }

 private:
  void fill_ball(const std::vector<Triangle>& sphere) {
    const bool is_simplex = sphere.size() == 4;
    Set corners = 0;
    for (const Triangle& t : sphere) corners |= set_of(t) & 0xffu;
    for (; corners != 0 && (is_simplex || !is_barycentric_); corners &= corners - 1)
      if (const auto v = static_cast<std::uint8_t>(std::countr_zero(corners)); may_be_apex(sphere, v))
        return cone(sphere, v);
    cone(sphere, add_centre(sphere));
  }

  void cone(const std::vector<Triangle>& sphere, std::uint8_t apex) {
    for (const Triangle& t : sphere)
      if ((set_of(t) & bit(apex)) == 0) tetrahedra.push_back({apex, t[0], t[1], t[2]});
  }

  std::uint8_t add_centre(const std::vector<Triangle>& around) {
    Set vertices = 0;
    for (const Triangle& t : around) vertices |= set_of(t);
    return add_centre(vertices);
  }
  std::uint8_t add_centre(Set around) {
    centres.push_back(static_cast<std::uint32_t>(around & (bit(kFirstOwn) - 1)));
    if (CubeRegions::kFirstCentre + centres.size() > CubeRegions::kVertices)
      throw Error(ErrorCode::Internal, "a region of a cube with too many centres");
    return static_cast<std::uint8_t>(CubeRegions::kFirstCentre + centres.size() - 1);
  }

  /// A closed curve across the collar: from one polygon to another along the cube's boundary, and back along the
  /// contour.
  struct Curve {
    std::vector<std::uint8_t> vertices;
    Set set = 0;
    unsigned from = 0, to = 0;  ///< polygons
  };

  void fill_collar(const std::vector<Triangle>& surface, unsigned polygons) {
    find_curves(surface);
    for (unsigned count = polygons; count < polygons + kMoreCurves; ++count) {
      std::vector<const Curve*> chosen;
      if (choose(surface, polygons, count, 0, 0, chosen)) return;
    }
    throw Error(ErrorCode::CertificateFailed, "a collar in a cube that is not cut into balls");
  }

  /// Searches for `count` disjoint curves that cut the collar into balls, and fills it with them.
  bool choose(const std::vector<Triangle>& surface, unsigned polygons, unsigned count, std::size_t next, Set used,
              std::vector<const Curve*>& chosen) {
    if (chosen.size() == count) return meet_all_twice(polygons, chosen) && cut(surface, polygons, chosen);
    for (; next < curves_.size(); ++next) {
      if ((curves_[next].set & used) != 0) continue;
      chosen.push_back(&curves_[next]);
      if (choose(surface, polygons, count, next + 1, used | curves_[next].set, chosen)) return true;
      chosen.pop_back();
    }
    return false;
  }

  static bool meet_all_twice(unsigned polygons, const std::vector<const Curve*>& curves) {
    std::array<unsigned, 8> ends{};
    for (const Curve* curve : curves) ++ends[curve->from], ++ends[curve->to];
    return std::all_of(ends.begin(), ends.begin() + polygons, [](unsigned n) { return n >= 2; });
  }

  /// Cuts the surface along the curves. If each part, closed by the curves' discs, is a sphere whose part on the cube's
  /// boundary is a disc, fills all parts and returns true.
  bool cut(const std::vector<Triangle>& surface, unsigned polygons, const std::vector<const Curve*>& curves) {
    std::map<DirectedEdge, std::size_t> curve_of;
    for (std::size_t c = 0; c < curves.size(); ++c)
      for (std::size_t i = 0, n = curves[c]->vertices.size(); i < n; ++i) {
        const DirectedEdge e{curves[c]->vertices[i], curves[c]->vertices[(i + 1) % n]};
        curve_of[e] = curve_of[reversed(e)] = c;
      }
    auto parts = parts_of(surface, [&](DirectedEdge e) { return !curve_of.contains(e); });
    if (parts.size() + polygons != curves.size() + 2) return false;  // Euler's formula, if all parts are discs
    // close the parts by discs
    const std::size_t before = centres.size();
    std::vector<std::uint8_t> middle;
    for (const Curve* curve : curves) middle.push_back(add_centre(curve->set));
    for (auto& part : parts) {
      const bool is_product = is_outer_part_a_disc(part);
      const std::vector<Triangle> own = part;
      for (const Triangle& t : own)
        for (unsigned i = 0; i < 3; ++i)
          if (const auto at = curve_of.find(edge(t, i)); at != curve_of.end())
            part.push_back({middle[at->second], at->first.second, at->first.first});
      if (is_product && is_closed(part) && euler_characteristic(part) == 2) continue;
      centres.resize(before);
      return false;
    }
    // fill
    for (const auto& part : parts) cone(part, add_centre(part));
    return true;
  }

  /// Whether the part on the cube's boundary is a disc. The collar is then its product with an interval.
  [[nodiscard]] bool is_outer_part_a_disc(const std::vector<Triangle>& part) const {
    std::vector<Triangle> outer;
    std::set<Set> edges;
    Set vertices = 0;
    for (const Triangle& t : part) {
      if (std::find(contour_.begin(), contour_.end(), t) != contour_.end()) continue;
      outer.push_back(t);
      vertices |= set_of(t);
      for (unsigned i = 0; i < 3; ++i) edges.insert(bit(t[i]) | bit(t[(i + 1) % 3]));
    }
    return parts_of(outer, [](DirectedEdge) { return true; }).size() == 1 &&
           std::popcount(vertices) - static_cast<int>(edges.size()) + static_cast<int>(outer.size()) == 1;
  }

  static bool is_closed(const std::vector<Triangle>& triangles) {
    std::set<DirectedEdge> edges;
    for (const Triangle& t : triangles)
      for (unsigned i = 0; i < 3; ++i)
        if (!edges.insert(edge(t, i)).second) return false;
    return std::all_of(edges.begin(), edges.end(), [&](DirectedEdge e) { return edges.contains(reversed(e)); }) &&
           parts_of(triangles, [](DirectedEdge) { return true; }).size() == 1;
  }

  /// Finds all short curves, sorted by length.
  void find_curves(const std::vector<Triangle>& surface) {
    outside_ = {}, inside_ = {}, polygon_of_.fill(kNoPolygon);
    std::set<Set> contour;
    for (const Triangle& t : contour_) contour.insert(set_of(t));
    for (const Triangle& t : surface)
      for (const std::uint8_t v : t) (contour.contains(set_of(t)) ? inside_ : outside_)[v] |= set_of(t) & ~bit(v);
    number_polygons();
    curves_.clear();
    for (std::uint8_t p = kFirstEdge; p < kFirstOwn; ++p)
      if (polygon_of_[p] != kNoPolygon) {
        path_ = {p};
        go_outside();
      }
    std::stable_sort(curves_.begin(), curves_.end(),
                     [](const Curve& a, const Curve& b) { return a.vertices.size() < b.vertices.size(); });
  }

  /// Numbers the polygons: vertices connected by edges that belong both to the contour and to a square.
  void number_polygons() {
    unsigned count = 0;
    for (unsigned p = kFirstEdge; p < kFirstOwn; ++p) {
      if (inside_[p] == 0 || polygon_of_[p] != kNoPolygon) continue;
      std::vector<unsigned> reached{p};
      polygon_of_[p] = count;
      for (std::size_t k = 0; k < reached.size(); ++k)
        for (Set rest = inside_[reached[k]] & outside_[reached[k]]; rest != 0; rest &= rest - 1) {
          const auto q = static_cast<unsigned>(std::countr_zero(rest));
          if (polygon_of_[q] != kNoPolygon) continue;
          polygon_of_[q] = count;
          reached.push_back(q);
        }
      ++count;
    }
  }

  /// Extends the path along the cube's boundary, over corners and barycentres of squares, to another polygon.
  void go_outside() {
    constexpr std::size_t kMostCorners = 3;
    const std::uint8_t here = path_.back();
    for (Set rest = outside_[here]; rest != 0; rest &= rest - 1) {
      const auto next = static_cast<std::uint8_t>(std::countr_zero(rest));
      if (std::find(path_.begin(), path_.end(), next) != path_.end()) continue;
      const bool is_corner = next < kFirstEdge || next >= kFirstSquare;
      if (!is_corner && (polygon_of_[next] <= polygon_of_[path_[0]] || path_.size() == 1)) continue;
      if (is_corner && path_.size() > kMostCorners) continue;
      path_.push_back(next);
      is_corner ? go_outside() : go_inside();
      path_.pop_back();
    }
  }

  /// Closes the path along the contour, over at most kMostBetween vertices in between.
  void go_inside() {
    const std::size_t outer = path_.size();
    go_inside(outer, polygon_of_[path_.back()]);
  }
  void go_inside(std::size_t outer, unsigned to) {
    constexpr std::size_t kMostBetween = 1;
    const std::uint8_t here = path_.back();
    if ((inside_[here] & bit(path_[0])) != 0) {
      Curve& curve = curves_.emplace_back(Curve{path_, 0, polygon_of_[path_[0]], to});
      for (const std::uint8_t v : path_) curve.set |= bit(v);
    }
    if (path_.size() == outer + kMostBetween) return;
    for (Set rest = inside_[here]; rest != 0; rest &= rest - 1) {
      const auto next = static_cast<std::uint8_t>(std::countr_zero(rest));
      if (std::find(path_.begin(), path_.end(), next) != path_.end()) continue;
      path_.push_back(next);
      go_inside(outer, to);
      path_.pop_back();
    }
  }

  static constexpr unsigned kNoPolygon = ~0u, kMoreCurves = 3;
  std::vector<Triangle> contour_;
  bool is_barycentric_;
  std::array<Set, kEnd> outside_{}, inside_{};  ///< neighbours in squares and on the contour
  std::array<unsigned, kEnd> polygon_of_{};
  std::vector<std::uint8_t> path_;
  std::vector<Curve> curves_;
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

CubeRegions make_cube_regions(const CubeLists& lists, bool has_square_centres) {
  const RegionProof proof;
  CubeRegions result;
  const std::size_t whole = lists.lists.size();
  for (std::size_t number = 0; number <= whole; ++number)
    for (const bool high : {false, true}) {
      result.first_region.push_back(static_cast<std::uint32_t>(result.regions.size()));
      const bool is_whole = number == whole;
      // boundary of the side
      const Side side{is_whole ? (high ? 255u : 0u) : lists.lists[number].signature,
                      is_whole ? 0u : lists.lists[number].high_squares, high, has_square_centres};
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
      const RegionFrame frame = frame_of(lists, number, contour, side);
      // regions
      for (const auto& part : parts_of(surface, [](DirectedEdge) { return true; })) {
        RegionMaker maker(lists.triangulation == Triangulation::barycentric);
        if (!maker.divide(proof, frame, part, high)) maker.fill(part, contour);
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
