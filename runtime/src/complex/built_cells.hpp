// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of 4D cells that depend on more than the signature, so a cell has more contours than a table could list.
// Those that occur are built, each once. Compact contours depend on the numbers of the points in each 3D face
// (FaceFillings).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "ambiguity/face_estimator.hpp"
#include "complex/border_facets.hpp"
#include "complex/cell_contour.hpp"
#include "complex/face_fillings.hpp"
#include "tegl/tile/face_lattice.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// Everything that a cell's contour depends on.
struct CellKey {
  std::uint16_t signature = 0;
  std::array<std::uint8_t, 16> fillings{};  ///< compact, by facet: FaceFillings; decided: one bit by quadrilateral
  auto operator<=>(const CellKey&) const = default;
};

/// A contour before it is in a table: tetrahedra of local vertices, and the masks of added vertices by kind.
struct BuiltContour {
  std::vector<std::array<std::uint8_t, 4>> tetrahedra;
  std::vector<std::uint64_t> shared, cones, sides, collars;
  bool of_image = false;  ///< of a tesseract in images
};

/// The contours of the cells of one 4D shape that occur: found by keys, built, and kept in a table.
class BuiltCells {
 public:
  BuiltCells(const BuiltCells&) = delete;
  BuiltCells& operator=(const BuiltCells&) = delete;
  virtual ~BuiltCells() = default;

  /// The key of a cell with these points at its corners. `values`: of all points.
  [[nodiscard]] virtual CellKey key(unsigned signature, const Index* corners,
                                    std::span<const double> values) const noexcept = 0;
  /// Builds the contours of `keys`, which ascend and are distinct. To be called once. Errors: Cancelled.
  void build(std::vector<CellKey> keys, const WorkOptions& work);
  /// The number of a contour that was built.
  [[nodiscard]] std::uint32_t variant(const CellKey& key) const noexcept;
  [[nodiscard]] CellContour contour(std::uint32_t variant) const noexcept { return {table_, lists_[variant]}; }
  /// Whether a contour is that of the tesseract in images. Its side vertices are on rays, where the interpolant has the
  /// isovalue.
  [[nodiscard]] bool is_of_image(std::uint32_t variant) const noexcept { return of_image_[variant] != 0; }

 protected:
  explicit BuiltCells(const tables::CellTable& table);
  /// Builds contours, on any thread.
  virtual void fill(std::span<const CellKey> keys, std::span<BuiltContour> contours) const = 0;

  tables::CellTable table_;  ///< of the contours built

 private:
  std::vector<CellKey> keys_;
  std::vector<tables::CellList> lists_;  ///< by key, as of_image_
  std::vector<std::uint8_t> of_image_;
  std::vector<std::uint8_t> simplices_;
  std::vector<std::uint64_t> masks_;
};

/// The compact contours of the cells of one 4D shape.
class CompactCells final : public BuiltCells {
 public:
  /// `is_swept`: the first two facets, the ends of prisms, have the fillings of their own tables (CellGroups).
  CompactCells(tables::CellShape shape, bool high_connected, bool is_swept);

  [[nodiscard]] CellKey key(unsigned signature, const Index* corners,
                            std::span<const double> values) const noexcept override;
  /// The triangles of the contour in a facet, as edges of the facet, oriented by the facet's own corners.
  [[nodiscard]] std::span<const FaceFillings::Triangle> in_facet(std::size_t facet, const CellKey& key) const;

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
  /// Builds one contour.
  class Filler;

  void fill(std::span<const CellKey> keys, std::span<BuiltContour> contours) const override;
  [[nodiscard]] unsigned facet_signature(const Facet& facet, unsigned signature) const noexcept;

  tables::CellShape shape_;
  bool high_connected_;
  const tables::CellTable& barycentric_;
  std::map<tables::CellShape, FaceFillings> fillings_;
  std::vector<Facet> facets_;
};

/// The barycentric contours of the cells of one 4D shape whose ambiguous quadrilaterals are decided from the data. Each
/// polygon in a 3D face is a disc, coned from its barycentre; no tunnels.
class DecidedCells final : public BuiltCells {
 public:
  /// `rule`: not a caller's. Throws InvalidArgument for a rule that has tunnels in cubes, if the shape has cubes.
  DecidedCells(tables::CellShape shape, FaceRule rule, double isovalue);

  [[nodiscard]] CellKey key(unsigned signature, const Index* corners,
                            std::span<const double> values) const noexcept override;

 private:
  void fill(std::span<const CellKey> keys, std::span<BuiltContour> contours) const override;
  [[nodiscard]] bool is_reversed() const;

  FaceRule rule_;
  double isovalue_;
  tile::FaceLattice lattice_;
  std::vector<std::uint8_t> edge_of_;                        ///< by face of the lattice
  std::vector<std::uint32_t> faces_;                         ///< quadrilaterals, in the lattice
  std::vector<std::array<std::uint8_t, 4>> quadrilaterals_;  ///< their corners; bit i of the place is a coordinate
  bool reversed_ = false;  ///< whether the lattice is oriented against the coordinates
};

}  // namespace tegl::detail
