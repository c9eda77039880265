// SPDX-License-Identifier: BSD-3-Clause
//
// The contours of the cells of a shape: by signature, resolved from the data, or compact in 4D.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "ambiguity/face_estimator.hpp"
#include "complex/built_cells.hpp"
#include "complex/cell_contour.hpp"
#include "tegl/ambiguity.hpp"

namespace tegl::detail {

/// The quadrilaterals of a 2D or 3D shape, as corners: bit i is a coordinate of the quadrilateral. Those of hexahedra
/// in the order of CubeKey.
[[nodiscard]] std::span<const std::array<std::uint8_t, 4>> quadrilaterals_of(tables::CellShape shape) noexcept;

/// Whether two opposite corners of a quadrilateral are high and two low.
[[nodiscard]] bool is_ambiguous_square(unsigned signature, const std::array<std::uint8_t, 4>& corners) noexcept;

/// The contours of the cells of one shape whose ambiguous quadrilaterals are resolved from the data.
class ResolvedCells {
 public:
  /// `rule`: not a caller's. `table`: of the same triangulation.
  ResolvedCells(tables::CellShape shape, const tables::CellTable& table, Triangulation triangulation, FaceRule rule,
                double isovalue);
  ResolvedCells(const ResolvedCells&) = delete;
  ResolvedCells& operator=(const ResolvedCells&) = delete;

  /// Whether a cell's contour depends on more than its signature.
  [[nodiscard]] bool is_ambiguous(unsigned signature) const noexcept { return ambiguous_[signature]; }
  /// The variant of an ambiguous cell with these values at its corners: 0 if all faces are low-connected, 1 if all are
  /// high-connected, otherwise the number of a list.
  [[nodiscard]] std::uint16_t variant(const double* values, unsigned signature) const noexcept;
  /// The same for a shape that is no hexahedron, with these ambiguous quadrilaterals (quadrilaterals_of) and those of
  /// them that are high, as bits.
  [[nodiscard]] static std::uint16_t variant(unsigned signature, unsigned ambiguous, unsigned high) noexcept;
  /// The variant of an octahedron with a tunnel.
  [[nodiscard]] static std::uint16_t tunnel_variant(const LonePair& pair) noexcept;
  /// The contour of a variant above 1.
  [[nodiscard]] CellContour contour(unsigned variant) const noexcept { return {table_, lists_[variant - 2]}; }
  /// The place in the unit cube of a side vertex of a hexahedron, from its mask: on a ray from the centre, where the
  /// trilinear interpolant has the isovalue.
  [[nodiscard]] std::array<double, 3> place(std::uint64_t mask, const std::array<double, 8>& values,
                                            double epsilon) const noexcept;
  /// The same for a mask of corners (bit v) and edges (bit 8 + e) of the cube of images.
  [[nodiscard]] static std::array<double, 3> place_in_cube(std::uint32_t mask, const std::array<double, 8>& values,
                                                           double isovalue, double epsilon) noexcept;

 private:
  void add_hexahedra(Triangulation triangulation);
  void add_wedges();
  /// `table`: of octahedra, with the contours that have no tunnel.
  void add_tunnels(const tables::CellTable& table);

  tables::CellShape shape_;
  tables::CellTable table_;
  FaceRule rule_;
  double isovalue_;
  std::vector<bool> ambiguous_;                ///< by signature
  std::array<std::uint8_t, 12> cube_edges_{};  ///< hexahedra: the edge of the cell for an edge of the cube
  std::vector<tables::CellList> lists_;
  std::vector<std::uint8_t> simplices_;
  std::vector<std::uint64_t> masks_;
};

/// The contours of a shape by signature.
class CellCases {
 public:
  /// A signature of a shape of up to 8 corners.
  struct Case {
    std::uint32_t first_edge = 0;     ///< in its crossed edges, ascending
    std::uint32_t first_simplex = 0;  ///< in `ordinals`
    std::uint8_t crossings = 0;       ///< number of crossed edges
    std::uint8_t simplices = 0;       ///< number of simplices, if the shape is plain
  };

  /// `table` must outlive this object.
  CellCases(const tables::CellTable& table, bool high_connected, std::shared_ptr<const ResolvedCells> resolved = {},
            std::shared_ptr<BuiltCells> built = {})
      : table_(&table), high_connected_(high_connected), resolved_(std::move(resolved)), built_(std::move(built)) {
    if (table.corner_count <= 8) add_cases();  // otherwise many signatures: each is looked up when it occurs
  }
  [[nodiscard]] const tables::CellTable& table() const noexcept { return *table_; }
  [[nodiscard]] CellContour operator[](unsigned signature) const noexcept {
    return {*table_, signature, high_connected_};
  }
  /// The contour of a cell that is resolved from the data (ResolvedCells::variant) or whose contour is built
  /// (BuiltCells::variant); 0 for other cells.
  [[nodiscard]] CellContour of(unsigned signature, std::uint32_t variant) const noexcept {
    if (built_ != nullptr) return built_->contour(variant);
    if (variant == 0) return (*this)[signature];
    if (variant == 1) return {*table_, signature, true};
    return resolved_->contour(variant);
  }
  /// Null: ambiguous faces are resolved by a fixed rule.
  [[nodiscard]] const ResolvedCells* resolved() const noexcept { return resolved_.get(); }
  /// Null: the contours are in the table. Contours are built when the active cells are known.
  [[nodiscard]] BuiltCells* built() const noexcept { return built_.get(); }

  /// Whether all vertices are on edges and depend on the signature alone. Then `of_signature` and `ordinals` have all
  /// that there is to write.
  [[nodiscard]] bool is_plain() const noexcept { return is_plain_; }
  [[nodiscard]] const Case& of_signature(unsigned signature) const noexcept { return cases_[signature]; }
  /// The vertices of a case's simplices, as numbers among its crossed edges. `flip`: the last two are exchanged.
  [[nodiscard]] const std::uint8_t* ordinals(const Case& of, bool flip) const noexcept {
    return ordinals_[flip ? 1 : 0].data() + of.first_simplex;
  }

  /// The crossed edges of a signature, ascending; afterwards 0.
  using Picks = std::array<std::int32_t, 8>;
  /// By signature; null for shapes of more than 8 edges.
  [[nodiscard]] const Picks* picks() const noexcept { return picks_.empty() ? nullptr : picks_.data(); }
  /// Number of crossed edges.
  [[nodiscard]] unsigned crossing_count(unsigned signature) const noexcept {
    if (cases_.empty()) return static_cast<unsigned>(std::popcount(crossed_edges(*table_, signature)));
    return cases_[signature].crossings;
  }
  /// Calls visit(edge) for the crossed edges, ascending.
  template <class Visit>
  void for_each_crossed(unsigned signature, const Visit& visit) const {
    if (cases_.empty()) {
      for (std::uint32_t edges = crossed_edges(*table_, signature); edges != 0; edges &= edges - 1)
        visit(static_cast<unsigned>(std::countr_zero(edges)));
      return;
    }
    const Case& of = cases_[signature];
    const std::uint8_t* const edges = edges_.data() + of.first_edge;
    for (unsigned k = 0; k < of.crossings; ++k) visit(unsigned{edges[k]});
  }

 private:
  void add_cases();

  const tables::CellTable* table_;
  bool high_connected_;
  bool is_plain_ = false;
  std::shared_ptr<const ResolvedCells> resolved_;
  std::shared_ptr<BuiltCells> built_;
  std::vector<Case> cases_;          ///< by signature; empty for shapes of more corners
  std::vector<std::uint8_t> edges_;  ///< the crossed edges of all cases
  std::vector<Picks> picks_;
  std::array<std::vector<std::uint8_t>, 2> ordinals_;
};

}  // namespace tegl::detail
