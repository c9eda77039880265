// SPDX-License-Identifier: BSD-3-Clause
//
// Keeps polygons and polyhedra, their lattices and their orientations.
#include "polytope/polytopes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "base/workers.hpp"
#include "polytope/polygon_prisms.hpp"

namespace tegl::detail {

PolytopeShape::PolytopeShape(std::vector<std::uint8_t> rings, std::vector<std::uint16_t> ends)
    : PolytopeShape(arrays_of(std::move(rings), std::move(ends))) {}

PolytopeShape::PolytopeShape(Arrays arrays) : arrays_(std::make_shared<const Arrays>(std::move(arrays))) {
  const Arrays& a = *arrays_;
  static_cast<PolytopeFaces&>(*this) = {a.corner_count, a.rings, a.ring_edges, a.ends, a.edges, a.faces_of, a.is_prism};
}

PolytopeShape::Arrays PolytopeShape::arrays_of(std::vector<std::uint8_t> rings, std::vector<std::uint16_t> ends) {
  Arrays a{std::move(rings), {}, std::move(ends), {}, {}, 0, false};
  a.ring_edges.resize(a.rings.size());
  for (std::size_t f = 0; f < a.ends.size(); ++f) {
    const std::size_t begin = f == 0 ? 0 : a.ends[f - 1], count = a.ends[f] - begin;
    for (std::size_t i = 0; i < count; ++i) {
      const auto [v, w] = std::minmax(a.rings[begin + i], a.rings[begin + (i + 1) % count]);
      const Pair edge{v, w};
      const auto at = static_cast<std::size_t>(std::find(a.edges.begin(), a.edges.end(), edge) - a.edges.begin());
      a.ring_edges[begin + i] = static_cast<std::uint8_t>(at);
      const auto face = static_cast<std::uint8_t>(f);
      if (at < a.edges.size()) {
        a.faces_of[at][1] = face;
        continue;
      }
      a.edges.push_back(edge);
      a.faces_of.push_back({face, face});
    }
  }
  for (const std::uint8_t corner : a.rings) a.corner_count = std::max(a.corner_count, std::size_t{corner} + 1);
  return a;
}

PolytopeShape PolytopeShape::prism_over(const PolytopeShape& base) {
  Arrays prism = *base.arrays_;
  const auto count = static_cast<std::uint8_t>(prism.corner_count);
  const std::size_t edges = prism.edges.size();
  for (std::size_t e = 0; e < edges; ++e)
    prism.edges.push_back(
        {static_cast<std::uint8_t>(prism.edges[e][0] + count), static_cast<std::uint8_t>(prism.edges[e][1] + count)});
  for (std::uint8_t v = 0; v < count; ++v) prism.edges.push_back({v, static_cast<std::uint8_t>(v + count)});
  prism.is_prism = true;
  return PolytopeShape(std::move(prism));
}

void Polytopes::add(std::span<const Index> corners, Lattice lattice) {
  const auto [at, is_new] = numbers_.try_emplace(std::move(lattice), static_cast<std::uint32_t>(shapes_.size()));
  if (is_new) shapes_.emplace_back(at->first.first, at->first.second);
  shape_of_.push_back(at->second);
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
    std::vector<std::uint64_t> faces(shape(c).face_count());
    for (std::size_t f = 0; f < faces.size(); ++f)
      for (const std::uint8_t v : shape(c).ring(f)) faces[f] |= std::uint64_t{1} << v;
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
}

namespace {

/// The volume (3D) or area (2D) inside rings, times a positive factor, relative to the box around the corners; 0 if
/// the cell is flat up to rounding. Of a prism: of its cross-section in the middle.
template <int N, int M>
double relative_volume(const PolytopeShape& shape, const Index* corners,
                       const std::vector<std::array<double, M>>& points) {
  using Point = std::array<double, N>;
  constexpr double kFlat = 0x1p-30;
  const std::size_t count = shape.base_corners();
  std::array<Point, kPolytopeCorners> at;
  for (std::size_t v = 0; v < count; ++v)
    for (std::size_t i = 0; i < N; ++i) {
      at[v][i] = points[corners[v]][i];
      if constexpr (M > N) at[v][i] = 0.5 * at[v][i] + 0.5 * points[corners[v + count]][i];
    }
  Point lowest = at[0], highest = lowest;
  for (std::size_t v = 0; v < count; ++v)
    for (std::size_t i = 0; i < N; ++i) {
      lowest[i] = std::min(lowest[i], at[v][i]);
      highest[i] = std::max(highest[i], at[v][i]);
    }
  for (std::size_t v = 0; v < count; ++v)
    for (std::size_t i = 0; i < N; ++i) {
      const double extent = highest[i] - lowest[i];
      at[v][i] = extent > 0 ? (at[v][i] - lowest[i]) / extent : 0.0;
    }
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

}  // namespace

template <int N>
std::vector<std::uint64_t> find_polytope_signs(const Polytopes& polytopes,
                                               const std::vector<std::array<double, N>>& points) {
  std::vector<std::uint64_t> inverted(block_count(polytopes.size(), 64));
  std::vector<std::uint64_t> kept(inverted.size());
  for_each_item(inverted.size(), 0, {}, [&](std::size_t w) {
    for (std::size_t c = 64 * w; c < std::min(polytopes.size(), 64 * w + 64); ++c) {
      const double volume = relative_volume<std::min(N, 3), N>(polytopes.shape(c), polytopes.cell(c), points);
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
