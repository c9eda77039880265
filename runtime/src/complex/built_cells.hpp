// SPDX-License-Identifier: BSD-3-Clause
//
// Compact contours of 4D cells. The contour in each 3D face depends on the numbers of its points (FaceFillings), so a
// cell has more contours than a table could list. Those that occur are built, each once.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "complex/border_facets.hpp"
#include "complex/cell_contour.hpp"
#include "complex/face_fillings.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// Everything that a cell's contour depends on.
struct CompactKey {
  std::uint16_t signature = 0;
  std::array<std::uint8_t, 16> fillings{};  ///< by facet: FaceFillings
  auto operator<=>(const CompactKey&) const = default;
};

/// The compact contours of the cells of one 4D shape.
class CompactCells {
 public:
  /// `is_swept`: the first two facets, the ends of prisms, have the fillings of their own tables (CellGroups).
  CompactCells(tables::CellShape shape, bool high_connected, bool is_swept);
  CompactCells(const CompactCells&) = delete;
  CompactCells& operator=(const CompactCells&) = delete;

  /// The key of a cell with these points at its corners.
  [[nodiscard]] CompactKey key(unsigned signature, const Index* corners) const noexcept;
  /// The triangles of the contour in a facet, as edges of the cell, oriented by the facet's own corners.
  [[nodiscard]] std::vector<FaceFillings::Triangle> in_facet(std::size_t facet, const CompactKey& key) const;

  /// Builds the contours of `keys`, which ascend and are distinct. To be called once. Errors: Cancelled.
  void build(std::vector<CompactKey> keys, const WorkOptions& work);
  /// The number of a contour that was built.
  [[nodiscard]] std::uint32_t variant(const CompactKey& key) const noexcept;
  [[nodiscard]] CellContour contour(std::uint32_t variant) const noexcept { return {table_, lists_[variant]}; }
  /// Whether a contour is that of the tesseract in images. Its side vertices are on rays, where the interpolant has the
  /// isovalue.
  [[nodiscard]] bool is_of_image(std::uint32_t variant) const noexcept { return of_image_[variant] != 0; }

  /// The place in the unit tesseract of a side vertex of an image's contour, from its mask. `values`: at the corners.
  [[nodiscard]] static std::array<double, 4> place(const tables::CellTable& table, std::uint64_t mask,
                                                   std::array<double, 16> values, double isovalue,
                                                   double epsilon) noexcept;

 private:
  struct Facet {
    const FaceFillings* fillings;
    const CellFacet* of;
    std::array<std::uint8_t, 12> edges;  ///< of the cell, by edge of the facet
    bool has_own;                        ///< the filling of the facet's table
  };
  /// A contour before it is in the table.
  struct Built;
  /// Builds one contour.
  class Filler;

  [[nodiscard]] unsigned facet_signature(const Facet& facet, unsigned signature) const noexcept;

  tables::CellShape shape_;
  bool high_connected_;
  const tables::CellTable& barycentric_;
  tables::CellTable table_;  ///< of the contours built
  std::map<tables::CellShape, FaceFillings> fillings_;
  std::vector<Facet> facets_;
  std::vector<CompactKey> keys_;
  std::vector<tables::CellList> lists_;  ///< by key, as of_image_
  std::vector<std::uint8_t> of_image_;
  std::vector<std::uint8_t> simplices_;
  std::vector<std::uint64_t> masks_;
};

}  // namespace tegl::detail
