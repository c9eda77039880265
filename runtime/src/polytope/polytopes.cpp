// SPDX-License-Identifier: BSD-3-Clause
//
// Keeps polygons, polyhedra and 4D polytopes, their lattices and their orientations.
#include "polytope/polytopes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include <Eigen/LU>

#include "base/workers.hpp"
#include "polytope/polygon_prisms.hpp"
#include "polytope/recognised_polytope.hpp"
#include "polytope/solid_facets.hpp"

namespace tegl::detail {

void Polytopes::add(std::span<const Index> corners, Lattice lattice) {
  const auto [at, is_new] = numbers_.try_emplace(std::move(lattice), static_cast<std::uint32_t>(shapes_.size()));
  if (is_new) shapes_.emplace_back(at->first.first, at->first.second);
  add(corners, at->second);
}

void Polytopes::add(std::span<const Index> corners, std::uint32_t shape) {
  shape_of_.push_back(shape);
  first_.push_back(corners_.size());
  corners_.insert(corners_.end(), corners.begin(), corners.end());
}

void Polytopes::add_polygon(std::span<const Index> corners) {
  Lattice lattice;
  for (std::size_t v = 0; v < corners.size(); ++v) lattice.first.push_back(static_cast<std::uint8_t>(v));
  lattice.second.push_back(static_cast<std::uint16_t>(corners.size()));
  add(corners, std::move(lattice));
}

void Polytopes::add_polyhedron(std::span<const Index> corners, std::vector<std::uint8_t> rings,
                               std::vector<std::uint16_t> ends) {
  add(corners, {std::move(rings), std::move(ends)});
}

void Polytopes::add_polytope(RecognisedPolytope polytope) {
  Lattice description;  // all facets, one after the other
  for (const RecognisedPolytope::Facet& facet : polytope.facets) {
    auto& [bytes, numbers] = description;
    numbers.insert(numbers.end(),
                   {static_cast<std::uint16_t>(facet.shape), facet.is_inverted ? std::uint16_t{1} : std::uint16_t{0},
                    static_cast<std::uint16_t>(facet.corners.size()), static_cast<std::uint16_t>(facet.ends.size())});
    numbers.insert(numbers.end(), facet.ends.begin(), facet.ends.end());
    bytes.insert(bytes.end(), facet.corners.begin(), facet.corners.end());
    bytes.insert(bytes.end(), facet.rings.begin(), facet.rings.end());
  }
  const auto [at, is_new] = numbers_.try_emplace(std::move(description), static_cast<std::uint32_t>(shapes_.size()));
  if (is_new) shapes_.push_back(shape_of_facets(polytope));
  add(polytope.corners, at->second);
}

PolytopeShape Polytopes::shape_of_facets(const RecognisedPolytope& polytope) {
  PolytopeSolids solids;
  std::vector<PolytopeFaces::Pair> edges;
  std::vector<std::uint16_t> number(kPolytopeCorners * kPolytopeCorners);  // 1 + the edge between two corners
  for (const RecognisedPolytope::Facet& facet : polytope.facets) {
    solids.solids.push_back({static_cast<SolidFacet::Kind>(facet.shape), facet.is_inverted,
                             static_cast<std::uint32_t>(solids.corners.size()),
                             static_cast<std::uint32_t>(solids.edges.size()),
                             static_cast<std::uint32_t>(solids.lattices.size())});
    PolytopeFaces faces;
    if (facet.shape == PolyhedronShape::other) {
      solids.solids.back().kind = SolidFacet::Kind::other;
      const auto at = solids_.try_emplace({facet.rings, facet.ends}, facet.rings, facet.ends).first;
      solids.lattices.push_back(at->second);
      faces = at->second;
    } else {
      faces = faces_of_known(facet.shape);
    }
    solids.corners.insert(solids.corners.end(), facet.corners.begin(), facet.corners.end());
    for (const auto& [a, b] : faces.edges()) {
      const auto [v, w] = std::minmax(facet.corners[a], facet.corners[b]);
      std::uint16_t& edge = number[kPolytopeCorners * v + w];
      if (edge == 0) {
        edges.push_back({v, w});
        edge = static_cast<std::uint16_t>(edges.size());
      }
      solids.edges.push_back(static_cast<std::uint16_t>(edge - 1));
    }
  }
  return PolytopeShape::of_solids(polytope.corners.size(), std::move(edges),
                                  std::make_shared<const PolytopeSolids>(std::move(solids)));
}

namespace {

/// The corners of each face of a polyhedron, or of each facet of a 4D polytope that is no prism, as bits.
std::vector<std::uint64_t> corners_of_facets(const PolytopeFaces& shape) {
  std::vector<std::uint64_t> facets(shape.facet_count());
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const auto add = [&](std::uint8_t v) { facets[f] |= std::uint64_t{1} << v; };
    if (shape.solids() != nullptr)
      for (const std::uint8_t v : facet_of_solid(shape, f).corners) add(v);
    else
      for (const std::uint8_t v : shape.ring(f)) add(v);
  }
  return facets;
}

std::vector<Index> ascending_points(const SolidFacet& facet, const Index* corners) {
  std::vector<Index> points;
  for (const std::uint8_t v : facet.corners) points.push_back(corners[v]);
  std::sort(points.begin(), points.end());
  return points;
}

}  // namespace

void Polytopes::find_entangled_facets() {
  entangled_ = find_entangled();
  is_entangled_.assign(size(), false);
  for (const Index c : entangled_) {
    is_entangled_[c] = true;
    for (const SolidFacet& facet : facets_of_solid(shape(c)))
      if (!facet.is_tabled())
        entangled_facets_.try_emplace(ascending_points(facet, cell(c)), static_cast<Index>(entangled_facets_.size()));
  }
}

std::optional<Index> Polytopes::entangled_facet(std::size_t cell, const SolidFacet& facet) const {
  if (facet.kind == SolidFacet::Kind::end)
    return is_entangled(cell) ? std::optional(static_cast<Index>(cell % base_count())) : std::nullopt;
  if (entangled_facets_.empty()) return std::nullopt;
  const auto found = entangled_facets_.find(ascending_points(facet, this->cell(cell)));
  return found == entangled_facets_.end() ? std::nullopt : std::optional(found->second);
}

std::vector<Index> Polytopes::find_entangled() const {
  // cells at each point
  Index points = 0;
  for (const Index p : corners_) points = std::max(points, p + 1);
  std::vector<std::uint64_t> first(std::size_t{points} + 1);
  for (const Index p : corners_) ++first[p + 1];
  for (std::size_t p = 0; p < points; ++p) first[p + 1] += first[p];
  std::vector<Index> cells_at(corners_.size());
  std::vector<std::uint64_t> next(first.begin(), first.end() - 1);
  for (std::size_t c = 0; c < size(); ++c)
    for (const Index p : points_of(c)) cells_at[next[p]++] = static_cast<Index>(c);
  // common corners of a cell and each other one, as bits
  std::vector<std::uint8_t> is_found(size());
  for_each_item(size(), 0, {}, [&](std::size_t c) {
    const std::span<const Index> corners = points_of(c);
    std::vector<std::pair<Index, std::uint64_t>> common;
    for (std::size_t v = 0; v < corners.size(); ++v)
      for (std::uint64_t i = first[corners[v]]; i < first[corners[v] + 1]; ++i)
        if (cells_at[i] != c) common.emplace_back(cells_at[i], std::uint64_t{1} << v);
    std::sort(common.begin(), common.end());
    const std::vector<std::uint64_t> faces = corners_of_facets(shape(c));
    for (std::size_t i = 0; i < common.size();) {
      std::uint64_t of_both = 0;
      const Index other = common[i].first;
      for (; i < common.size() && common[i].first == other; ++i) of_both |= common[i].second;
      // two edges have three points or more
      if (std::popcount(of_both) > 2 &&
          std::none_of(faces.begin(), faces.end(), [&](std::uint64_t face) { return (of_both & ~face) == 0; }))
        is_found[c] = 1;
    }
  });
  std::vector<Index> found;
  for (std::size_t c = 0; c < size(); ++c)
    if (is_found[c] != 0) found.push_back(static_cast<Index>(c));
  return found;
}

Polytopes Polytopes::solids_in_time(std::size_t points, std::size_t intervals) const {
  Polytopes prisms;
  prisms.entangled_ = find_entangled();
  prisms.is_entangled_.resize(size());
  for (const Index c : prisms.entangled_) prisms.is_entangled_[c] = true;
  for (const PolytopeShape& shape : shapes_) prisms.shapes_.push_back(PolytopeShape::prism_over(shape));
  for (std::size_t k = 0; k < intervals; ++k)
    for (std::size_t c = 0; c < size(); ++c) {
      prisms.shape_of_.push_back(shape_of_[c]);
      prisms.first_.push_back(prisms.corners_.size());
      for (const std::size_t layer : {k, k + 1})
        for (const Index p : points_of(c)) prisms.corners_.push_back(static_cast<Index>(layer * points + p));
    }
  return prisms;
}

Polytopes Polytopes::in_time(std::size_t points, std::size_t intervals) const {
  if (dim() == 3) return solids_in_time(points, intervals);
  Polytopes prisms;
  std::vector<Index> corners;
  for (std::size_t k = 0; k < intervals; ++k)
    for (std::size_t c = 0; c < size(); ++c) {
      const std::span<const Index> base = points_of(c);
      corners.clear();
      for (const std::size_t layer : {k, k + 1})
        for (const Index p : base) corners.push_back(static_cast<Index>(layer * points + p));
      const PolytopeFaces prism = kPolygonPrisms.over(base.size());
      prisms.add(corners, {{prism.rings().begin(), prism.rings().end()}, {prism.ends().begin(), prism.ends().end()}});
    }
  return prisms;
}

void Polytopes::renumber(std::span<const Index> number) {
  for (Index& corner : corners_) corner = number[corner];
  std::map<std::vector<Index>, Index> facets;
  for (const auto& [points, name] : entangled_facets_) {
    std::vector<Index> renumbered;
    for (const Index p : points) renumbered.push_back(number[p]);
    std::sort(renumbered.begin(), renumbered.end());
    facets.try_emplace(std::move(renumbered), name);
  }
  entangled_facets_ = std::move(facets);
}

namespace {

/// Moves points to the unit box: subtracts the lowest coordinates, and divides by the extents that are not 0.
template <int N>
void move_to_unit_box(std::span<std::array<double, N>> points) {
  for (std::size_t i = 0; i < N; ++i) {
    const auto less = [i](const auto& a, const auto& b) { return a[i] < b[i]; };
    const auto [first, last] = std::minmax_element(points.begin(), points.end(), less);
    const double lowest = (*first)[i], extent = (*last)[i] - lowest;
    for (auto& point : points) point[i] = extent > 0 ? (point[i] - lowest) / extent : 0.0;
  }
}

/// Volumes relative to the box around a cell up to which it is flat.
constexpr double kFlat = 0x1p-30;

/// The volume (3D) or area (2D) inside rings, times a positive factor, relative to the box around the corners; 0 if
/// the cell is flat up to rounding. Of a prism: of its cross-section in the middle.
template <int N, int M>
double relative_volume(const PolytopeShape& shape, const Index* corners,
                       const std::vector<std::array<double, M>>& points) {
  using Point = std::array<double, N>;
  const std::size_t count = shape.base_corners();
  std::array<Point, kPolytopeCorners> at;
  for (std::size_t v = 0; v < count; ++v)
    for (std::size_t i = 0; i < N; ++i) {
      at[v][i] = points[corners[v]][i];
      if constexpr (M > N) at[v][i] = 0.5 * at[v][i] + 0.5 * points[corners[v + count]][i];
    }
  move_to_unit_box<N>(std::span(at).first(count));
  double volume = 0.0;
  for (std::size_t f = 0; f < shape.face_count(); ++f) {
    const std::span<const std::uint8_t> ring = shape.ring(f);
    Point mean{};
    for (const std::uint8_t v : ring)
      for (std::size_t i = 0; i < N; ++i) mean[i] += at[v][i] / static_cast<double>(ring.size());
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Point &a = at[ring[k]], &b = at[ring[(k + 1) % ring.size()]];
      if constexpr (N == 2)
        volume += (a[0] - mean[0]) * (b[1] - mean[1]) - (a[1] - mean[1]) * (b[0] - mean[0]);
      else
        volume += mean[0] * (a[1] * b[2] - a[2] * b[1]) + mean[1] * (a[2] * b[0] - a[0] * b[2]) +
                  mean[2] * (a[0] * b[1] - a[1] * b[0]);
    }
  }
  return std::abs(volume) > kFlat ? volume : 0.0;
}

/// The volume inside the facets of a 4D polytope, times a positive factor, relative to the box around its corners; 0 if
/// flat up to rounding. Sum over the pyramids with their apex at the mean of all corners over tetrahedra between the
/// mean of a facet, the mean of one of its faces and an edge there.
double relative_volume_of_solids(const PolytopeShape& shape, const Index* corners,
                                 const std::vector<std::array<double, 4>>& points) {
  using Point = std::array<double, 4>;
  std::array<Point, kPolytopeCorners> at;
  for (std::size_t v = 0; v < shape.corner_count(); ++v) at[v] = points[corners[v]];
  move_to_unit_box<4>(std::span(at).first(shape.corner_count()));
  const auto mean = [&](std::span<const std::uint8_t> of) {
    Point sum{};
    for (const std::uint8_t v : of)
      for (std::size_t i = 0; i < 4; ++i) sum[i] += at[v][i] / static_cast<double>(of.size());
    return sum;
  };
  std::array<std::uint8_t, kPolytopeCorners> all;
  for (std::size_t v = 0; v < shape.corner_count(); ++v) all[v] = static_cast<std::uint8_t>(v);
  const Point centre = mean(std::span(all).first(shape.corner_count()));
  double volume = 0.0;
  for (std::size_t f = 0; f < shape.facet_count(); ++f) {
    const SolidFacet facet = facet_of_solid(shape, f);
    const Point of_facet = mean(facet.corners);
    for (std::size_t k = 0; k < facet.shape.face_count(); ++k) {
      std::vector<std::uint8_t> ring;
      for (const std::uint8_t v : facet.shape.ring(k)) ring.push_back(facet.corners[v]);
      const Point of_face = mean(ring);
      for (std::size_t i = 0; i < ring.size(); ++i) {
        Eigen::Matrix4d rows;
        const std::array<const Point*, 4> to = {&of_face, &at[ring[i]], &at[ring[(i + 1) % ring.size()]], &centre};
        for (int r = 0; r < 4; ++r)
          for (int c = 0; c < 4; ++c) rows(r, c) = (*to[r])[c] - of_facet[c];
        volume += facet.is_inverted ? -rows.determinant() : rows.determinant();
      }
    }
  }
  return std::abs(volume) > kFlat ? volume : 0.0;
}

template <int N>
double volume_of(const PolytopeShape& shape, const Index* corners, const std::vector<std::array<double, N>>& points) {
  if constexpr (N == 4)
    if (shape.solids() != nullptr) return relative_volume_of_solids(shape, corners, points);
  return relative_volume<std::min(N, 3), N>(shape, corners, points);
}

}  // namespace

template <int N>
std::vector<std::uint64_t> find_polytope_signs(const Polytopes& polytopes,
                                               const std::vector<std::array<double, N>>& points) {
  std::vector<std::uint64_t> inverted(block_count(polytopes.size(), 64));
  std::vector<std::uint64_t> kept(inverted.size());
  for_each_item(inverted.size(), 0, {}, [&](std::size_t w) {
    for (std::size_t c = 64 * w; c < std::min(polytopes.size(), 64 * w + 64); ++c) {
      const double volume = volume_of<N>(polytopes.shape(c), polytopes.cell(c), points);
      inverted[w] |= std::uint64_t{volume < 0} << (c & 63u);
      kept[w] |= std::uint64_t{volume > 0} << (c & 63u);
    }
  });
  const auto is_empty = [](const auto& words) {
    return std::all_of(words.begin(), words.end(), [](std::uint64_t word) { return word == 0; });
  };
  if (is_empty(kept) && !is_empty(inverted)) std::fill(inverted.begin(), inverted.end(), ~std::uint64_t{0});
  return inverted;
}

template std::vector<std::uint64_t> find_polytope_signs<2>(const Polytopes&, const std::vector<std::array<double, 2>>&);
template std::vector<std::uint64_t> find_polytope_signs<3>(const Polytopes&, const std::vector<std::array<double, 3>>&);
template std::vector<std::uint64_t> find_polytope_signs<4>(const Polytopes&, const std::vector<std::array<double, 4>>&);

}  // namespace tegl::detail
