// SPDX-License-Identifier: BSD-3-Clause
//
// Tetrahedra that are positive for all positions, and whose oriented boundaries
// add up to the boundary of a region, cover the region once. Such a division is
// sought by taking away tetrahedra from the boundary inwards, until the rest is
// visible from one of its vertices, or from a mean of corners and points.
#include "regions/region_divisions.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include "base/disjoint_sets.hpp"
#include "regions/cube_frame.hpp"
#include "tegl/generated/cells.hpp"
#include "tegl/tile/corners.hpp"

namespace tegl::detail {

namespace {

using Triangle = RegionDivision::Triangle;
using Tetrahedron = ShapeVolumes::Tetrahedron;
using Vertices = RegionVertices;
using Triangles = std::vector<Triangle>;

constexpr std::uint64_t one(unsigned v) noexcept { return std::uint64_t{1} << v; }
constexpr std::uint64_t set_of(const Triangle& t) noexcept { return one(t[0]) | one(t[1]) | one(t[2]); }

std::uint64_t set_of(const Triangles& triangles) noexcept {
  std::uint64_t all = 0;
  for (const Triangle& t : triangles) all |= set_of(t);
  return all;
}

/// Vertices are numbers below kEnd. No region with nearly as many own ones is known.
void require_room(const RegionDivision& division) {
  if (division.own.size() > Vertices::kEnd - Vertices::kFirstOwn)
    throw std::length_error("division of a region: too many vertices of its own");
}

/// The same triangle, starting at its smallest vertex.
Triangle from_smallest(Triangle t) noexcept {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

/// The triangles of a tetrahedron, facing outwards if the first one, opposite to its first vertex, does.
std::array<Triangle, 4> faces_of(const Tetrahedron& t) noexcept {
  return {Triangle{t[1], t[2], t[3]}, Triangle{t[0], t[3], t[2]}, Triangle{t[0], t[1], t[3]},
          Triangle{t[0], t[2], t[1]}};
}

/// Adds an oriented triangle to a boundary, sorted, where it may cancel another one.
void add(Triangles& boundary, const Triangle& triangle) {
  const Triangle same = from_smallest(triangle), opposite = from_smallest({triangle[1], triangle[0], triangle[2]});
  if (const auto at = std::lower_bound(boundary.begin(), boundary.end(), opposite);
      at != boundary.end() && *at == opposite)
    boundary.erase(at);
  else
    boundary.insert(std::lower_bound(boundary.begin(), boundary.end(), same), same);
}

/// The edges (kFirstEdge + e) of a boundary's triangles at a vertex.
std::vector<std::uint8_t> edges_around(const Triangles& boundary, unsigned vertex) {
  std::uint64_t around = 0;
  for (const Triangle& t : boundary)
    if ((set_of(t) & one(vertex)) != 0) around |= set_of(t);
  std::vector<std::uint8_t> edges;
  for (std::uint8_t v = Vertices::kFirstEdge; v < Vertices::kFirstCentre; ++v)
    if ((around & one(v)) != 0) edges.push_back(v);
  return edges;
}

/// Points spread over a shape, for one position of the contour's points. They show early that tetrahedra overlap; that
/// only makes the search faster.
class Samples {
 public:
  Samples(const ShapeVolumes& volumes, const Triangles& boundary) : volumes_(volumes) {
    for (std::size_t i = 0; i < kCount; ++i) {  // a lattice of rank 1, of barycentric coordinates
      const double t = static_cast<double>(i) + 0.5;
      std::array<double, 8> weights{};
      double sum = 0;
      for (unsigned v = 0; v < volumes.table().corner_count; ++v) {
        const double x = t * kSteps[v];
        weights[v] = -std::log(1e-3 + 0.998 * (x - std::floor(x)));
        sum += weights[v];
      }
      for (unsigned v = 0; v < 8; ++v)
        for (std::size_t a = 0; a < 3; ++a)
          if (weights[v] > 0) places_[i][a] += weights[v] / sum * volumes.table().corners[3 * v + a];
    }
    const ShapePlaces::Place origin = {0.31, 0.27, 0.43};
    std::array<int, kCount> count{};
    for (const Triangle& t : boundary) {
      const std::array<ShapePlaces::Place, 4> corners = {origin, volumes.generic().place(t[0]),
                                                         volumes.generic().place(t[1]), volumes.generic().place(t[2])};
      const bool is_positive = six_volumes(corners) > 0;
      const std::uint64_t inside = in(corners);
      for (std::size_t i = 0; i < kCount; ++i)
        if ((inside >> i & 1u) != 0) count[i] += is_positive ? 1 : -1;
    }
    for (std::size_t i = 0; i < kCount; ++i)
      if (count[i] != 0) region |= one(static_cast<unsigned>(i));
  }

  std::uint64_t region = 0;  ///< the samples in the region

  [[nodiscard]] std::uint64_t in(const Tetrahedron& t) const noexcept { return in(volumes_.generic().places(t)); }

 private:
  static constexpr std::size_t kCount = 64;
  static constexpr std::array<double, 8> kSteps = {0.8191725134, 0.6710436067, 0.5497004779, 0.4503265221,
                                                   0.3689117343, 0.3022151127, 0.2475772431, 0.2028179431};

  [[nodiscard]] std::uint64_t in(const std::array<ShapePlaces::Place, 4>& corners) const noexcept {
    const double all = six_volumes(corners);
    std::uint64_t inside = 0;
    for (std::size_t i = 0; i < kCount; ++i) {
      bool is_inside = true;
      for (std::size_t k = 0; k < 4 && is_inside; ++k) {
        auto part = corners;
        part[k] = places_[i];
        is_inside = six_volumes(part) * all > 1e-9 * all * all;
      }
      if (is_inside) inside |= one(static_cast<unsigned>(i));
    }
    return inside;
  }

  const ShapeVolumes& volumes_;
  std::array<ShapePlaces::Place, kCount> places_{};
};

/// Divides one region.
class RegionSearch {
 public:
  /// `outwards`: whether volumes below the boundary's triangles are positive. Adds to `result`.
  RegionSearch(const ShapeVolumes& volumes, bool outwards, RegionDivision& result)
      : volumes_(volumes), outwards_(outwards), result_(result) {}

  /// Returns whether a division was found that is proved.
  bool run(const Triangles& boundary) {
    if (take_rest(boundary, false)) return true;
    vertices_ = set_of(boundary);
    const Samples samples(volumes_, boundary);
    left_ = samples.region;
    samples_ = &samples;
    if (cover(boundary)) return true;
    for (const bool is_near : {false, true})
      for (unsigned most = 0; most <= kMostTaken; ++most) {
        nodes_ = 0;
        seen_.clear();
        if (divide(boundary, most, is_near)) return true;
      }
    return cut(boundary);
  }
  /// A cone from the mean of all points, which is not proved.
  void add_cone_from_mean(const Triangles& boundary) {
    result_.is_proved = false;
    add_own(boundary, set_of(boundary) & (one(Vertices::kFirstCentre) - 1));
  }

 private:
  static constexpr unsigned kMostNodes = 1000, kMostTaken = 4;

  [[nodiscard]] VolumeSigns signs(std::uint8_t apex, const Triangle& t) {
    const unsigned key = ((apex * 32u + t[0]) * 32u + t[1]) * 32u + t[2];
    const auto [at, is_new] = signs_.try_emplace(key);
    if (is_new) {
      at->second = volumes_.signs({apex, t[0], t[1], t[2]});
      if (!outwards_) std::swap(at->second.positive, at->second.negative);
    }
    return at->second;
  }

  void add_cone(const Triangles& boundary, std::uint8_t apex) {
    for (const Triangle& t : boundary)
      if ((set_of(t) & one(apex)) == 0) result_.tetrahedra.push_back({apex, t[0], t[1], t[2]});
  }
  void add_own(const Triangles& boundary, std::uint64_t points) {
    const auto own = static_cast<std::uint8_t>(Vertices::kFirstOwn + result_.own.size());
    result_.own.push_back(static_cast<std::uint32_t>(points));
    require_room(result_);
    add_cone(boundary, own);
  }

  /// Takes the rest if it is visible from a vertex or, with a vertex of its own, from a mean.
  bool take_rest(const Triangles& boundary, bool has_own) {
    const std::uint64_t vertices = set_of(boundary);
    std::uint64_t apexes = vertices, seeing = has_own ? vertices & (one(Vertices::kFirstCentre) - 1) : 0;
    std::vector<std::uint64_t> seen_by;
    for (const Triangle& t : boundary) {
      std::uint64_t positive = 0;
      for (std::uint64_t rest = (apexes | seeing) & ~set_of(t); rest != 0; rest &= rest - 1) {
        const auto v = static_cast<std::uint8_t>(std::countr_zero(rest));
        const VolumeSigns of = signs(v, t);
        if (of.is_positive()) positive |= one(v);
        if (!of.is_positive()) apexes &= ~one(v);
        if (of.negative) seeing &= ~one(v);
      }
      if (apexes == 0 && seeing == 0) return false;
      seen_by.push_back(positive);
    }
    if (apexes != 0) {
      add_cone(boundary, best_apex(boundary, apexes));
      return true;
    }
    if (std::any_of(seen_by.begin(), seen_by.end(), [&](std::uint64_t s) { return (s & seeing) == 0; })) return false;
    add_own(boundary, seeing);
    return true;
  }

  /// Takes the rest if a corner sees all of it but triangles in its own planes: then points near the corner see all.
  bool take_near_corner(const Triangles& boundary) {
    const std::uint64_t points = set_of(boundary) & (one(Vertices::kFirstCentre) - 1);
    for (std::uint64_t rest = points & (one(Vertices::kFirstEdge) - 1); rest != 0; rest &= rest - 1) {
      const auto corner = static_cast<std::uint8_t>(std::countr_zero(rest));
      if (const std::uint64_t inwards = points_inwards(boundary, corner, points); inwards != 0) {
        result_.near.push_back({static_cast<std::uint8_t>(Vertices::kFirstOwn + result_.own.size()), corner, boundary});
        add_own(boundary, inwards);
        return true;
      }
    }
    return false;
  }

  /// Those of `points` that no triangle in a corner's planes has behind it, if their mean is in front of all of these
  /// and the corner in front of the other triangles; else 0.
  std::uint64_t points_inwards(const Triangles& boundary, std::uint8_t corner, std::uint64_t points) {
    Triangles around;
    for (const Triangle& t : boundary) {
      const VolumeSigns of = (set_of(t) & one(corner)) != 0 ? VolumeSigns() : signs(corner, t);
      if (of.negative) return 0;
      if (!of.positive) around.push_back(t);
    }
    std::vector<std::uint64_t> seen_by(around.size());
    for (std::uint64_t rest = points; rest != 0; rest &= rest - 1) {
      const auto v = static_cast<std::uint8_t>(std::countr_zero(rest));
      for (std::size_t i = 0; i < around.size(); ++i) {
        if ((set_of(around[i]) & one(v)) != 0) continue;
        const VolumeSigns of = signs(v, around[i]);
        if (of.negative) points &= ~one(v);
        if (of.is_positive()) seen_by[i] |= one(v);
      }
    }
    return std::all_of(seen_by.begin(), seen_by.end(), [&](std::uint64_t s) { return (s & points) != 0; }) ? points : 0;
  }

  /// The vertex whose cone has the fewest tetrahedra.
  static std::uint8_t best_apex(const Triangles& boundary, std::uint64_t apexes) {
    std::uint8_t best = 0;
    std::ptrdiff_t most = -1;
    for (; apexes != 0; apexes &= apexes - 1) {
      const auto v = static_cast<std::uint8_t>(std::countr_zero(apexes));
      const auto around =
          std::count_if(boundary.begin(), boundary.end(), [&](const Triangle& t) { return (set_of(t) & one(v)) != 0; });
      if (around > most) best = v, most = around;
    }
    return best;
  }

  /// The boundary without a tetrahedron at it.
  static Triangles without(Triangles boundary, const Tetrahedron& tetrahedron) {
    for (const Triangle& face : faces_of(tetrahedron)) add(boundary, {face[1], face[0], face[2]});
    return boundary;
  }

  struct Candidate {
    Tetrahedron tetrahedron;
    std::uint64_t inside;  ///< samples
    std::size_t left;      ///< triangles of the boundary without it
  };

  void find_candidates(const Triangles& boundary, const Triangle& t, std::vector<Candidate>& result) {
    result.clear();
    for (std::uint64_t rest = vertices_ & ~set_of(t); rest != 0; rest &= rest - 1) {
      const auto apex = static_cast<std::uint8_t>(std::countr_zero(rest));
      if (!signs(apex, t).is_positive()) continue;
      const Tetrahedron tetrahedron{apex, t[0], t[1], t[2]};
      const std::uint64_t inside = samples_->in(tetrahedron);
      if ((inside & ~left_) != 0) continue;
      result.push_back({tetrahedron, inside, without(boundary, tetrahedron).size()});
    }
  }

  /// Covers the region by tetrahedra between its vertices, each at the triangle that has the fewest possible ones.
  bool cover(const Triangles& boundary) {
    if (boundary.empty()) return true;
    if (++nodes_ > kMostNodes || !seen_.insert(boundary).second) return false;
    std::vector<Candidate> best, candidates;
    for (const Triangle& t : boundary) {
      find_candidates(boundary, t, candidates);
      if (!best.empty() && candidates.size() >= best.size()) continue;
      best.swap(candidates);
      if (best.empty()) return false;
      if (best.size() == 1) break;
    }
    std::stable_sort(best.begin(), best.end(), [](const auto& a, const auto& b) { return a.left < b.left; });
    for (const Candidate& candidate : best) {
      left_ &= ~candidate.inside;
      result_.tetrahedra.push_back(candidate.tetrahedron);
      if (cover(without(boundary, candidate.tetrahedron))) return true;
      result_.tetrahedra.pop_back();
      left_ |= candidate.inside;
    }
    return false;
  }

  /// Takes away up to `most` tetrahedra at two triangles of the boundary, then the rest with a vertex of its own, at a
  /// mean or near a corner.
  bool divide(const Triangles& boundary, unsigned most, bool is_near) {
    if (++nodes_ > kMostNodes || !seen_.insert(boundary).second) return false;
    if (most == 0) return is_near ? take_near_corner(boundary) : take_rest(boundary, true);
    for (const Triangle& t : boundary)
      for (const Triangle& u : boundary) {
        const std::uint64_t common = set_of(t) & set_of(u);
        if (t >= u || std::popcount(common) != 2) continue;
        const auto apex = static_cast<std::uint8_t>(std::countr_zero(set_of(u) & ~common));
        if (!signs(apex, t).is_positive()) continue;
        const Tetrahedron tetrahedron{apex, t[0], t[1], t[2]};
        const Triangles rest = without(boundary, tetrahedron);
        if (rest.size() > boundary.size()) continue;
        result_.tetrahedra.push_back(tetrahedron);
        if (divide(rest, most - 1, is_near)) return true;
        result_.tetrahedra.pop_back();
      }
    return false;
  }

  /// Cuts the region by a triangle whose sides are edges of the boundary, and divides both parts.
  bool cut(const Triangles& boundary) {
    for (const Triangle& t : boundary)
      for (const Triangle& u : boundary) {
        const std::uint64_t common = set_of(t) & set_of(u);
        if (t >= u || std::popcount(common) != 2) continue;
        // a triangle at one of the sides of t and one of the sides of u, which meet in a common corner
        for (std::uint64_t rest = common; rest != 0; rest &= rest - 1) {
          const std::uint64_t third = rest & (0 - rest);
          const std::uint64_t sides = (set_of(t) ^ common) | (set_of(u) ^ common) | third;
          const auto parts = parts_at(boundary, sides);
          if (parts && divide_both(*parts)) return true;
        }
      }
    return false;
  }

  using Parts = std::array<Triangles, 2>;
  /// The parts of a boundary on both sides of a triangle, and the triangle, if its sides are edges of the boundary.
  static std::optional<Parts> parts_at(const Triangles& boundary, std::uint64_t triangle) {
    const auto is_side = [&](const Triangle& t, const Triangle& u) {
      return std::popcount(set_of(t) & set_of(u) & triangle) == 2;
    };
    DisjointSets sets(boundary.size());
    unsigned sides = 0;
    for (Index i = 0; i < boundary.size(); ++i)
      for (Index k = 0; k < i; ++k) {
        if (std::popcount(set_of(boundary[i]) & set_of(boundary[k])) != 2) continue;
        if (is_side(boundary[i], boundary[k]))
          ++sides;
        else
          sets.join(i, k);
      }
    if (sides != 3) return std::nullopt;
    Parts parts;
    for (Index i = 0; i < boundary.size(); ++i) parts[sets.find(i) == 0 ? 0 : 1].push_back(boundary[i]);
    if (parts[0].size() < 3 || parts[1].size() < 3) return std::nullopt;
    for (Triangles& part : parts) {
      Triangle cut;
      for (std::uint8_t& v : cut) {
        v = static_cast<std::uint8_t>(std::countr_zero(triangle));
        triangle &= triangle - 1;
      }
      const bool has_side = std::any_of(part.begin(), part.end(), [&](const Triangle& t) {
        return (t[0] == cut[0] && t[1] == cut[1]) || (t[1] == cut[0] && t[2] == cut[1]) ||
               (t[2] == cut[0] && t[0] == cut[1]);
      });
      if (has_side) std::swap(cut[0], cut[1]);
      add(part, cut);
      triangle = set_of(cut);
    }
    return parts;
  }

  bool divide_both(const Parts& parts) {
    const RegionDivision before = result_;
    for (const Triangles& part : parts)
      if (!RegionSearch(volumes_, outwards_, result_).run(part)) {
        result_ = before;
        return false;
      }
    return true;
  }

  const ShapeVolumes& volumes_;
  bool outwards_;
  RegionDivision& result_;
  std::uint64_t vertices_ = 0, left_ = 0;
  const Samples* samples_ = nullptr;
  std::unordered_map<unsigned, VolumeSigns> signs_;
  std::set<Triangles> seen_;  ///< boundaries from which the search failed
  unsigned nodes_ = 0;
};

/// The boundaries of the regions.
std::vector<Triangles> split(const Triangles& boundary) {
  DisjointSets sets(Vertices::kEnd);
  for (const Triangle& t : boundary) sets.join(t[0], t[1]), sets.join(t[0], t[2]);
  std::map<Index, Triangles> regions;
  for (const Triangle& t : boundary) regions[sets.find(t[0])].push_back(t);
  std::vector<Triangles> result;
  for (auto& [root, triangles] : regions) result.push_back(std::move(triangles));
  return result;
}

/// The division by the cube's table in a frame, if it has the given boundary. `centres`: by their edges.
std::optional<RegionDivision> in_frame(const tables::RegionTable& cube, const CubeFrame& frame,
                                       const tables::CellTable& table, const Triangles& boundary, unsigned signature,
                                       const std::map<std::vector<std::uint8_t>, std::uint8_t>& centres) {
  constexpr unsigned kFirstSlot = 8 + 12, kFirstOwn = tables::first_region_vertex(3);
  const tables::RegionList& list = cube.lists[frame.signature(signature)];
  std::array<std::uint8_t, Vertices::kFirstCentre> shared{};
  for (unsigned v = 0; v < 8; ++v) shared[v] = static_cast<std::uint8_t>(frame.corner(v));
  for (unsigned e = 0; e < 12; ++e) {
    const unsigned base = edge_base(3, e);
    shared[Vertices::kFirstEdge + e] = static_cast<std::uint8_t>(
        Vertices::kFirstEdge + edge_between(table, frame.corner(base), frame.corner(base | 1u << e / 4)));
  }
  RegionDivision division;
  Triangles surface;
  for (unsigned i = 0; i < list.simplex_count; ++i) {
    Tetrahedron& t = division.tetrahedra.emplace_back();
    for (unsigned k = 0; k < 4; ++k) {
      const unsigned v = cube.simplices[(list.first_simplex + i) * 4 + k];
      // barycentres are named by their order in the table, until their edges
      // are known
      t[k] = v < kFirstSlot  ? shared[v]
             : v < kFirstOwn ? static_cast<std::uint8_t>(Vertices::kFirstCentre + (v - kFirstSlot))
                             : static_cast<std::uint8_t>(Vertices::kFirstOwn + (v - kFirstOwn));
    }
    if (frame.is_mirrored()) std::swap(t[2], t[3]);
    for (const Triangle& face : faces_of(t)) add(surface, face);
  }
  std::array<std::uint8_t, Vertices::kEnd> renamed{};
  for (std::uint8_t v = 0; v < Vertices::kEnd; ++v) renamed[v] = v;
  for (std::uint8_t v = Vertices::kFirstCentre; v < Vertices::kFirstOwn; ++v) {
    const auto edges = edges_around(surface, v);
    if (edges.empty()) continue;
    const auto found = centres.find(edges);
    if (found == centres.end()) return std::nullopt;
    renamed[v] = found->second;
  }
  for (Triangle& t : surface) {
    for (std::uint8_t& v : t) v = renamed[v];
    t = from_smallest(t);
  }
  for (Tetrahedron& t : division.tetrahedra)
    for (std::uint8_t& v : t) v = renamed[v];
  std::sort(surface.begin(), surface.end());
  if (surface != boundary) return std::nullopt;
  for (unsigned j = 0; j < list.own_vertices; ++j) {
    std::uint32_t points = 0;
    for (std::uint32_t mask = cube.masks[list.first_mask + j]; mask != 0; mask &= mask - 1)
      points |= 1u << shared[static_cast<std::size_t>(std::countr_zero(mask))];
    division.own.push_back(points);
  }
  return division;
}

/// A boundary with its barycentres.
struct Surface {
  ShapeVolumes volumes;
  std::map<std::vector<std::uint8_t>, std::uint8_t> centres;  ///< by their edges
  bool outwards;                                              ///< whether volumes below the triangles are positive

  Surface(tables::CellShape shape, const Triangles& boundary) : volumes(shape) {
    for (std::uint8_t v = Vertices::kFirstCentre; v < Vertices::kFirstOwn; ++v)
      if (auto edges = edges_around(boundary, v); !edges.empty()) {
        centres[edges] = v;
        volumes.set_centre(v, std::move(edges));
      }
    double volume = 0;
    for (const Triangle& t : boundary) volume += six_volumes(volumes.generic().places({0, t[0], t[1], t[2]}));
    outwards = volume > 0;
  }
};

/// The division of a hexahedron by the cube's table in one of the first `frames` frames.
std::optional<RegionDivision> by_table(const tables::RegionTable& cube, const Surface& surface,
                                       const Triangles& boundary, unsigned frames) {
  const auto signature = static_cast<unsigned>(set_of(boundary)) & 0xffu;
  Triangles faced = boundary;  // as the table has it
  for (Triangle& t : faced)
    if (!surface.outwards) t = from_smallest({t[1], t[0], t[2]});
  std::sort(faced.begin(), faced.end());
  for (unsigned f = 0; f < frames; ++f) {
    auto found = in_frame(cube, CubeFrame::of_number(f), surface.volumes.table(), faced, signature, surface.centres);
    if (!found) continue;
    if (!surface.outwards)
      for (Tetrahedron& t : found->tetrahedra) std::swap(t[2], t[3]);
    return found;
  }
  return std::nullopt;
}

/// `boundary`: of one region; sorted, and each triangle starts at its smallest vertex.
RegionDivision divide(tables::CellShape shape, const tables::RegionTable& cube, const Triangles& boundary) {
  const Surface surface(shape, boundary);
  if (shape == tables::CellShape::hexahedron)
    if (auto found = by_table(cube, surface, boundary, CubeFrame::kCount)) return std::move(*found);
  RegionDivision division;
  RegionSearch search(surface.volumes, surface.outwards, division);
  if (!search.run(boundary)) search.add_cone_from_mean(boundary);
  return division;
}

/// Where a symmetry of a shape moves each vertex.
using Symmetry = std::array<std::uint8_t, Vertices::kEnd>;

/// A symmetry of a 3D shape, by number (ShapeTable::symmetries).
Symmetry symmetry_of(tables::CellShape shape, unsigned number) {
  const auto& table = tables::cell_table(shape, Triangulation::barycentric);
  const std::uint8_t* const corners =
      tables::shape_table(shape).symmetries + number * (table.corner_count + table.edge_count);
  Symmetry moved;
  std::iota(moved.begin(), moved.end(), std::uint8_t{0});
  std::copy_n(corners, table.corner_count, moved.begin());
  for (unsigned e = 0; e < table.edge_count; ++e)
    moved[Vertices::kFirstEdge + e] = static_cast<std::uint8_t>(Vertices::kFirstEdge + corners[table.corner_count + e]);
  return moved;
}

/// Moves a boundary; barycentres are numbered by the first of their edges, and `symmetry` gets their numbers.
Triangles moved(const Triangles& boundary, Symmetry& symmetry) {
  std::array<std::uint8_t, Vertices::kFirstOwn - Vertices::kFirstCentre> first{};
  first.fill(Vertices::kEnd);
  for (const Triangle& t : boundary)
    for (const std::uint8_t v : t)
      for (const std::uint8_t u : t)
        if (v >= Vertices::kFirstCentre && u < Vertices::kFirstCentre)
          first[v - Vertices::kFirstCentre] = std::min(first[v - Vertices::kFirstCentre], symmetry[u]);
  for (std::size_t i = 0; i < first.size(); ++i)
    symmetry[Vertices::kFirstCentre + i] = static_cast<std::uint8_t>(
        Vertices::kFirstCentre + std::count_if(first.begin(), first.end(), [&](auto f) { return f < first[i]; }));
  Triangles result;
  for (const Triangle& t : boundary) result.push_back(from_smallest({symmetry[t[0]], symmetry[t[1]], symmetry[t[2]]}));
  std::sort(result.begin(), result.end());
  return result;
}

/// The division of the region that a symmetry maps to the one of `of`.
RegionDivision moved_back(RegionDivision of, const Symmetry& symmetry) {
  Symmetry back{};
  for (std::uint8_t v = 0; v < Vertices::kEnd; ++v) back[symmetry[v]] = v;
  for (Tetrahedron& t : of.tetrahedra)
    for (std::uint8_t& v : t) v = back[v];
  for (std::uint32_t& mask : of.own) {
    std::uint32_t points = 0;
    for (; mask != 0; mask &= mask - 1) points |= 1u << back[static_cast<std::size_t>(std::countr_zero(mask))];
    mask = points;
  }
  for (RegionDivision::Near& near : of.near) {
    near.corner = back[near.corner];
    for (Triangle& t : near.seen)
      for (std::uint8_t& v : t) v = back[v];
  }
  return of;
}

}  // namespace

double RegionDivision::weight(const Near& of, const ShapePlaces& places) const noexcept {
  const auto corner = places.place(of.corner);
  ShapePlaces::Place mean{};
  const std::uint32_t points = own[of.own - Vertices::kFirstOwn];
  for (std::uint32_t rest = points; rest != 0; rest &= rest - 1) {
    const auto place = places.place(static_cast<unsigned>(std::countr_zero(rest)));
    for (std::size_t a = 0; a < 3; ++a) mean[a] += place[a] / std::popcount(points);
  }
  // volumes are linear along the way; those at the corner have one sign or are zero
  std::vector<std::array<double, 2>> volumes;
  double sum = 0;
  for (const Triangle& t : of.seen) {
    std::array<ShapePlaces::Place, 4> from = {corner, places.place(t[0]), places.place(t[1]), places.place(t[2])};
    const double at_corner = six_volumes(from);
    from[0] = mean;
    volumes.push_back({at_corner, six_volumes(from)});
    sum += at_corner;
  }
  double most = 1.0;
  for (const auto& [at_corner, at_mean] : volumes)
    if (at_corner * sum > 0 && at_mean * sum < 0) most = std::min(most, at_corner / (at_corner - at_mean));
  return 0.5 * most;
}

const RegionDivision& RegionDivisions::of_region(tables::CellShape shape, const Boundary& boundary) {
  const auto [at, is_new] = regions_.try_emplace({shape, boundary});
  if (!is_new) return at->second;
  Triangles representative;
  Symmetry least{};
  for (unsigned i = 0; i < tables::shape_table(shape).symmetry_count; ++i) {
    Symmetry symmetry = symmetry_of(shape, i);
    Triangles there = moved(boundary, symmetry);
    if (!representative.empty() && there >= representative) continue;
    representative = std::move(there);
    least = symmetry;
  }
  const auto [of, is_first] = representatives_.try_emplace({shape, std::move(representative)});
  if (is_first) of->second = divide(shape, cube_, of->first.second);
  at->second = moved_back(of->second, least);
  return at->second;
}

const RegionDivision& RegionDivisions::of(tables::CellShape shape, std::vector<Triangle> boundary) {
  for (Triangle& t : boundary) t = from_smallest(t);
  std::sort(boundary.begin(), boundary.end());
  const auto [at, is_new] = known_.try_emplace({shape, std::move(boundary)});
  if (!is_new) return at->second;
  const Triangles& all = at->first.second;
  RegionDivision& division = at->second;
  if (shape == tables::CellShape::hexahedron)  // in their own frame, a grid's cubes have the division of an image's
    if (auto found = by_table(cube_, Surface(shape, all), all, 1)) {
      division = std::move(*found);
      return division;
    }
  for (const Triangles& region : split(all)) {
    const auto shift = static_cast<std::uint8_t>(division.own.size());
    const auto shifted = [&](std::uint8_t v) {
      return v < Vertices::kFirstOwn ? v : static_cast<std::uint8_t>(v + shift);
    };
    const RegionDivision& part = of_region(shape, region);
    for (Tetrahedron t : part.tetrahedra) {
      for (std::uint8_t& v : t) v = shifted(v);
      division.tetrahedra.push_back(t);
    }
    division.own.insert(division.own.end(), part.own.begin(), part.own.end());
    for (RegionDivision::Near near : part.near) {
      near.own = shifted(near.own);
      division.near.push_back(std::move(near));
    }
    require_room(division);
    division.is_proved = division.is_proved && part.is_proved;
  }
  return division;
}

}  // namespace tegl::detail
