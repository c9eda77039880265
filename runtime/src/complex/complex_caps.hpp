// SPDX-License-Identifier: BSD-3-Clause
//
// Caps: the high part of the border of a complex, which closes a contour there.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/progress.hpp"
#include "base/stopwatch.hpp"
#include "complex/border_facets.hpp"
#include "complex/contour_numbers.hpp"
#include "polytope/solid_facets.hpp"
#include "regions/decided_regions.hpp"
#include "regions/region_divisions.hpp"

namespace tegl::detail {

/// A vertex of a cap before it has a number: a vertex of the contour, a corner or a vertex that the cap adds.
class CapVertex {
 public:
  CapVertex() = default;
  static CapVertex of_contour(Index v) noexcept { return CapVertex(v); }
  static CapVertex corner(Index point) noexcept { return CapVertex(kCorner | point); }
  static CapVertex added(std::uint64_t number) noexcept { return CapVertex(kAdded | number); }

  [[nodiscard]] bool is_of_contour() const noexcept { return (bits_ & (kCorner | kAdded)) == 0; }
  [[nodiscard]] bool is_corner() const noexcept { return (bits_ & kCorner) != 0; }
  /// The number of the contour's vertex, of the point, or of the added vertex.
  [[nodiscard]] std::uint64_t number() const noexcept { return bits_ & ~(kCorner | kAdded); }
  auto operator<=>(const CapVertex&) const = default;

 private:
  static constexpr std::uint64_t kCorner = std::uint64_t{1} << 62, kAdded = std::uint64_t{1} << 63;
  explicit CapVertex(std::uint64_t bits) noexcept : bits_(bits) {}
  std::uint64_t bits_ = 0;
};

/// Appends the triangles of a fan in a part of a polygon, with vertices in the order around it. The fan starts at the
/// corner between two others, if the part has three and further vertices, otherwise at the corner with the smallest
/// number. So all facets at a polygon have the same triangles, and so has a mesh at each of its times. `corner_of`: the
/// number of a corner; kNoPoint for a vertex on an edge.
template <class Vertex, class CornerOf>
void add_fan(std::vector<Vertex> part, const CornerOf& corner_of, std::vector<std::array<Vertex, 3>>& triangles) {
  const std::size_t size = part.size();
  const auto corner = [&](std::size_t i) { return corner_of(part[i % size]); };
  std::size_t corners = 0, start = size;
  for (std::size_t i = 0; i < size; ++i) {
    if (corner(i) == kNoPoint) continue;
    ++corners;
    if (start == size || corner(i) < corner(start)) start = i;
  }
  for (std::size_t i = 0; corners == 3 && size > 3 && i < size; ++i)
    if (corner(i) != kNoPoint && corner(i + 1) != kNoPoint && corner(i + 2) != kNoPoint) start = (i + 1) % size;
  if (corners == 0) return;
  std::rotate(part.begin(), part.begin() + static_cast<std::ptrdiff_t>(start), part.end());
  for (std::size_t i = 2; i < size; ++i) triangles.push_back({part[0], part[i - 1], part[i]});
}
/// The same for vertices of caps.
void add_fan(std::vector<CapVertex> part, std::vector<std::array<CapVertex, 3>>& triangles);

/// The caps of a contour, without positions. Facets of cells with missing corners have none.
template <int N>
class ComplexCaps {
 public:
  using Simplex = std::array<CapVertex, N>;

  /// The arguments must outlive this object. `values`: of the points. Errors: TooLarge, Cancelled.
  ComplexCaps(const CellGroups& cells, const CellSigns& signs, const BorderFacets& border,
              std::span<const double> values, double isovalue, const ExtractOptions& options,
              const ContourNumbers& numbers, const Progress& progress);

  /// The points that caps have as vertices, ascending.
  [[nodiscard]] const std::vector<Index>& corners() const noexcept { return corners_; }
  /// Number of vertices that the contour does not have: corners first, then added ones.
  [[nodiscard]] std::size_t vertex_count() const noexcept { return corners_.size() + first_point_.size() - 1; }
  /// The points of the contour and corners whose mean an added vertex is, or on the way to whose mean it is.
  [[nodiscard]] std::span<const CapVertex> points_of(std::size_t added) const noexcept {
    return {points_.data() + first_point_[added], points_.data() + first_point_[added + 1]};
  }
  /// A vertex on the way from a corner to a mean.
  struct Between {
    std::size_t added;  ///< number of the vertex
    Index corner;
    double weight;  ///< of the mean
  };
  [[nodiscard]] const std::vector<Between>& between() const noexcept { return between_; }
  [[nodiscard]] const std::vector<Simplex>& simplices() const noexcept { return simplices_; }
  /// The cells of the border facets that have simplices, in their order: a cell again for each of its facets.
  [[nodiscard]] const std::vector<CellSimplices>& by_facet() const noexcept { return by_facet_; }
  /// The number of a vertex.
  [[nodiscard]] Index number(CapVertex vertex) const noexcept;

 private:
  /// A facet's corners and the contour in it.
  struct Facet {
    const CellFacet& of;
    std::array<Index, 8> points;
    unsigned high = 0;
    bool flip;
    DecidedFacet contour = {};

    [[nodiscard]] bool is_high(unsigned i) const noexcept { return (high >> i & 1u) != 0; }
    [[nodiscard]] bool is_active() const noexcept { return high != 0 && high + 1 != 1u << of.corner_count; }
  };
  /// Vertices of a facet, numbered as ShapeVertices; parts of polygons are convex and in the order around it.
  using Local = std::uint8_t;
  using Part = std::vector<Local>;
  /// The boundary of a facet's high part, facing outwards, and the barycentres of the contour's polygons in it.
  struct Boundary {
    std::vector<RegionDivision::Triangle> triangles;
    std::size_t sides = 0;  ///< number of triangles in the facet's faces, which are the first ones
    std::vector<CapVertex> centres;
    std::vector<Part> polygons;  ///< by barycentre
  };

  void add_facet(const Facet& facet);
  /// Adds the high part of an edge or a face of a polytope.
  void add_face(const std::vector<Index>& points, bool flip);
  [[nodiscard]] std::vector<std::vector<CapVertex>> parts_around(const std::vector<Index>& points) const;
  /// Adds the high part of a facet of a 4D polytope with these points at its corners. `name`:
  /// Polytopes::entangled_facet.
  void add_tabled(const SolidFacet& facet, const Index* points, bool flip);
  void add_solid(const SolidFacet& facet, const Index* points, std::optional<Index> name, bool flip);
  [[nodiscard]] Boundary boundary_of(const Facet& facet) const;
  /// Adds the contour's polygons in a facet. `next`: by vertex, the end of its segment, or the vertex itself.
  using Segments = std::array<Local, ShapeVertices::kFirstCentre>;
  void add_polygons(const Facet& facet, Segments next, Boundary& to) const;
  /// Adds triangles of the contour that are oriented alike.
  static void add_oriented(const Segments& next, const std::vector<RegionDivision::Triangle>& triangles, Boundary& to);
  void add_compact(const Facet& facet, const Segments& next, Boundary& to) const;
  /// Of a hexahedron that is decided, and of an octahedron with a tunnel.
  void add_cube(const Facet& facet, const Segments& next, Boundary& to) const;
  void add_tunnel_centres(const Facet& facet, Boundary& to) const;
  [[nodiscard]] Index own_of_cube(const Facet& facet, unsigned own) const;
  /// The contour in a facet of a 4D polytope that has a table.
  [[nodiscard]] DecidedFacet decide(const Facet& facet) const;
  void add_regions(const Facet& facet);
  [[nodiscard]] const RegionDivision& division_of(const Facet& facet, Boundary& boundary);
  [[nodiscard]] ShapePlaces places_of(const Facet& facet, const Boundary& boundary) const;
  /// Appends a fan in a part of a facet's polygon.
  static void add_fan_in(const Facet& facet, Part part, std::vector<RegionDivision::Triangle>& triangles);
  [[nodiscard]] CapVertex on_edge(Index p, Index q) const;
  [[nodiscard]] CapVertex vertex(const Facet& facet, unsigned local) const;
  /// Adds the high parts of a polygon with corners `around`, and the contour's segments in it, against their direction
  /// around the parts.
  void cut(const Facet& facet, std::span<const std::uint8_t> around, std::vector<Part>& parts,
           Segments* segments) const;
  [[nodiscard]] bool joins(const Facet& facet, std::span<const std::uint8_t> around) const;
  void add_simplex(Simplex simplex, bool flip);
  /// A vertex at the mean of the given ones.
  CapVertex add_mean(std::span<const CapVertex> points);

  std::span<const double> values_;
  double isovalue_;
  const ExtractOptions& options_;
  const ContourNumbers& numbers_;
  RegionDivisions divisions_;
  RegionDivision decided_;  ///< of the current facet
  std::vector<Index> corners_;
  std::vector<CapVertex> points_;
  std::vector<std::uint64_t> first_point_{0};
  std::vector<Between> between_;
  std::vector<Simplex> simplices_;
  std::vector<CellSimplices> by_facet_;
  CellSimplices current_{};  ///< of the current facet
  bool is_new_facet_ = true;
};

/// The caps of a contour, if they are requested. `border`: the facets to close; null: all of the complex. Errors:
/// TooLarge, Cancelled.
template <int N>
[[nodiscard]] std::optional<ComplexCaps<N>> find_caps(const Complex<N>& complex, const ContourNumbers& numbers,
                                                      const BorderFacets* border, double isovalue,
                                                      const ExtractOptions& options, const Progress& progress);

/// Everything about a contour but its places: its numbers and its caps. Not movable.
template <int N>
class NumberedContour {
 public:
  /// Reports progress from 0 to 1 and adds times to `stats`. `active`: as of ContourNumbers; `border`: as of
  /// find_caps. Errors: TooLarge, Cancelled.
  NumberedContour(const Complex<N>& complex, double isovalue, const ExtractOptions& options,
                  const std::vector<Index>* active, const BorderFacets* border, const Progress& progress,
                  ExtractStats& stats)
      : numbers_(ComplexAccess::cells(complex), ComplexAccess::edges(complex), complex.values(), isovalue, options,
                 part_of(progress, 0.0, options.close ? 0.5 : 1.0), stats, active),
        caps_(caps_of(complex, border, isovalue, options, part_of(progress, 0.5, 1.0), stats)) {
    watch_.add_to(stats.close_seconds);
  }
  [[nodiscard]] const ContourNumbers& numbers() const noexcept { return numbers_; }
  [[nodiscard]] const ComplexCaps<N>* caps() const noexcept { return caps_ ? &*caps_ : nullptr; }
  /// With caps.
  [[nodiscard]] ContourSize size() const noexcept {
    ContourSize size = numbers_.size();
    if (caps_) size.vertices += caps_->vertex_count(), size.simplices += caps_->simplices().size();
    return size;
  }
  /// The vertices at which the contour may touch itself beside missing values: those on edges of cells with missing
  /// corners, and all of caps. Caps may touch where no edge is crossed, if all corners are high.
  [[nodiscard]] std::vector<Index> touching(const CellGroups& cells) const {
    std::vector<Index> vertices = numbers_.vertices_at_missing(cells);
    if (caps_ && numbers_.any_missing())
      for (std::uint64_t v = numbers_.size().vertices; v < size().vertices; ++v)
        vertices.push_back(static_cast<Index>(v));
    return vertices;
  }

 private:
  std::optional<ComplexCaps<N>> caps_of(const Complex<N>& complex, const BorderFacets* border, double isovalue,
                                        const ExtractOptions& options, const Progress& progress, ExtractStats& stats) {
    watch_.add_to(stats.find_seconds);
    stats.find_seconds -= stats.classify_seconds;
    return find_caps<N>(complex, numbers_, border, isovalue, options, progress);
  }

  Stopwatch watch_;
  ContourNumbers numbers_;
  std::optional<ComplexCaps<N>> caps_;
};

}  // namespace tegl::detail
