// SPDX-License-Identifier: BSD-3-Clause
//
// Tetrahedra that are positive for all positions, and whose oriented boundaries add up to the boundary of a region,
// cover the region once. The search for such a division takes tetrahedra away from the boundary inwards, until the rest
// is visible from one of its vertices, or from a mean of corners and points.
#include "cells/region_search.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <set>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include "tegl/tile/disjoint_sets.hpp"

namespace tegl::gen {

namespace {

using Triangle = RegionTriangle;
using Triangles = RegionTriangles;
using Tetrahedron = RegionTetrahedron;
using Vertices = ShapeVertices;

constexpr std::uint64_t one(unsigned v) noexcept { return std::uint64_t{1} << v; }
constexpr std::uint64_t set_of(const Triangle& t) noexcept { return one(t[0]) | one(t[1]) | one(t[2]); }

std::uint64_t set_of(const Triangles& triangles) noexcept { return detail::vertices_of(triangles); }

/// Vertices are numbers below kEnd. No region with nearly as many own ones is known.
void require_room(const CapDivision& division) {
  if (division.own.size() > Vertices::kEnd - Vertices::kFirstOwn)
    throw std::length_error("division of a region: too many vertices of its own");
}

/// Points spread over a shape, for one position of the contour's points. They show early that tetrahedra overlap; that
/// only makes the search faster.
class Samples {
 public:
  Samples(const RegionVolumes& volumes, const Triangles& boundary) : volumes_(volumes) {
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
    const detail::ShapePlaces::Place origin = {0.31, 0.27, 0.43};
    std::array<int, kCount> count{};
    for (const Triangle& t : boundary) {
      const std::array<detail::ShapePlaces::Place, 4> corners = {
          origin, volumes.generic().place(t[0]), volumes.generic().place(t[1]), volumes.generic().place(t[2])};
      const bool is_positive = detail::six_volumes(corners) > 0;
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

  [[nodiscard]] std::uint64_t in(const std::array<detail::ShapePlaces::Place, 4>& corners) const noexcept {
    const double all = detail::six_volumes(corners);
    std::uint64_t inside = 0;
    for (std::size_t i = 0; i < kCount; ++i) {
      bool is_inside = true;
      for (std::size_t k = 0; k < 4 && is_inside; ++k) {
        auto part = corners;
        part[k] = places_[i];
        is_inside = detail::six_volumes(part) * all > 1e-9 * all * all;
      }
      if (is_inside) inside |= one(static_cast<unsigned>(i));
    }
    return inside;
  }

  const RegionVolumes& volumes_;
  std::array<detail::ShapePlaces::Place, kCount> places_{};
};

/// Divides one region.
class RegionSearch {
 public:
  /// `outwards`: whether volumes below the boundary's triangles are positive; `is_exact`: proves by the signs of
  /// volumes themselves, not of their terms. Adds to `result`.
  RegionSearch(const RegionVolumes& volumes, bool outwards, bool is_exact, CapDivision& result)
      : volumes_(volumes), outwards_(outwards), is_exact_(is_exact), result_(result) {}

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

 private:
  static constexpr unsigned kMostNodes = 1000, kMostTaken = 4;

  [[nodiscard]] VolumeSigns signs(std::uint8_t apex, const Triangle& t) {
    const unsigned key = ((apex * 32u + t[0]) * 32u + t[1]) * 32u + t[2];
    const auto [at, is_new] = signs_.try_emplace(key);
    if (is_new) {
      const Tetrahedron tetrahedron{apex, t[0], t[1], t[2]};
      at->second = volumes_.signs(tetrahedron);
      if (is_exact_ && at->second.positive && at->second.negative) at->second = volumes_.exact_signs(tetrahedron);
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
    for (const Triangle& face : detail::faces_of(tetrahedron))
      detail::add_to_boundary(boundary, {face[1], face[0], face[2]});
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
    detail::BasicDisjointSets<std::uint32_t> sets(boundary.size());
    unsigned sides = 0;
    for (std::uint32_t i = 0; i < boundary.size(); ++i)
      for (std::uint32_t k = 0; k < i; ++k) {
        if (std::popcount(set_of(boundary[i]) & set_of(boundary[k])) != 2) continue;
        if (is_side(boundary[i], boundary[k]))
          ++sides;
        else
          sets.join(i, k);
      }
    if (sides != 3) return std::nullopt;
    Parts parts;
    for (std::uint32_t i = 0; i < boundary.size(); ++i) parts[sets.find(i) == 0 ? 0 : 1].push_back(boundary[i]);
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
      detail::add_to_boundary(part, cut);
      triangle = set_of(cut);
    }
    return parts;
  }

  bool divide_both(const Parts& parts) {
    const CapDivision before = result_;
    for (const Triangles& part : parts)
      if (!RegionSearch(volumes_, outwards_, is_exact_, result_).run(part)) {
        result_ = before;
        return false;
      }
    return true;
  }

  const RegionVolumes& volumes_;
  bool outwards_, is_exact_;
  CapDivision& result_;
  std::uint64_t vertices_ = 0, left_ = 0;
  const Samples* samples_ = nullptr;
  std::unordered_map<unsigned, VolumeSigns> signs_;
  std::set<Triangles> seen_;  ///< boundaries from which the search failed
  unsigned nodes_ = 0;
};

}  // namespace

bool is_outwards(const RegionVolumes& volumes, const RegionTriangles& boundary) {
  double volume = 0;
  for (const Triangle& t : boundary) volume += detail::six_volumes(volumes.generic().places({0, t[0], t[1], t[2]}));
  return volume > 0;
}

RegionVolumes volumes_with(const tables::CellTable& shape, const RegionTriangles& boundary) {
  RegionVolumes volumes(shape);
  for (std::uint8_t v = Vertices::kFirstCentre; v < Vertices::kFirstOwn; ++v)
    if (auto edges = detail::edges_around(boundary, v); !edges.empty()) volumes.set_centre(v, std::move(edges));
  return volumes;
}

std::optional<CapDivision> divide_region(const tables::CellTable& shape, const RegionTriangles& boundary) {
  const RegionVolumes volumes = volumes_with(shape, boundary);
  const bool outwards = is_outwards(volumes, boundary);
  for (const bool is_exact : {false, true}) {
    CapDivision division;
    if (RegionSearch(volumes, outwards, is_exact, division).run(boundary)) return division;
  }
  return std::nullopt;
}

}  // namespace tegl::gen
