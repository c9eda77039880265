// SPDX-License-Identifier: BSD-3-Clause
//
// Caps: the high part of the border of a complex, which closes a contour there.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "complex/border_facets.hpp"
#include "complex/contour_numbers.hpp"
#include "tegl/table_contract.hpp"

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
  /// Number of vertices beside those of the contour: corners first, then added ones.
  [[nodiscard]] std::size_t vertex_count() const noexcept { return corners_.size() + first_point_.size() - 1; }
  /// The points of the contour and corners whose mean an added vertex is.
  [[nodiscard]] std::span<const CapVertex> points_of(std::size_t added) const noexcept {
    return {points_.data() + first_point_[added], points_.data() + first_point_[added + 1]};
  }
  [[nodiscard]] const std::vector<Simplex>& simplices() const noexcept { return simplices_; }
  /// The number of a vertex.
  [[nodiscard]] Index number(CapVertex vertex) const noexcept;

 private:
  /// A facet's corners and what is known about them.
  struct Facet;
  /// A convex part of a polygon, in the order around it.
  using Part = std::vector<CapVertex>;
  using Triangle = std::array<CapVertex, 3>;
  /// The boundary of a facet's high part.
  struct Boundary {
    std::vector<Part> parts;          ///< parts of polygons around the facet, and the contour's polygons in it
    std::vector<Triangle> triangles;  ///< facing outwards
  };

  void add_facet(const Facet& facet);
  void add_table(const Facet& facet, const tables::RegionTable& table);
  [[nodiscard]] Boundary boundary_of(const Facet& facet) const;
  void add_compact(const Facet& facet, const std::map<CapVertex, CapVertex>& next,
                   std::vector<Triangle>& triangles) const;
  void add_regions(const Facet& facet);
  [[nodiscard]] CapVertex on_edge(Index p, Index q) const;
  /// Adds the high parts of a polygon with corners `around`, and the contour's segments in it, against their direction
  /// around the parts.
  void cut(const Facet& facet, std::span<const std::uint8_t> around, std::vector<Part>& parts,
           std::vector<std::array<CapVertex, 2>>* segments) const;
  [[nodiscard]] bool joins(const Facet& facet, std::span<const std::uint8_t> around) const;
  void add_simplex(Simplex simplex, bool flip);
  /// A vertex at the mean of the given ones.
  CapVertex add_mean(const Part& points);

  std::span<const double> values_;
  double isovalue_;
  const ExtractOptions& options_;
  const ContourNumbers& numbers_;
  std::vector<Index> corners_;
  std::vector<CapVertex> points_;
  std::vector<std::uint64_t> first_point_{0};
  std::vector<Simplex> simplices_;
};

}  // namespace tegl::detail
