// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of 4D cells that depend on more than the signature, so a cell has more contours than a table could list.
// Those that occur are built, each once. Compact contours depend on the numbers of the points in each 3D face
// (FaceFillings).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ambiguity/face_estimator.hpp"
#include "ambiguity/lone_pair.hpp"
#include "complex/border_facets.hpp"
#include "complex/cell_contour.hpp"
#include "regions/decided_regions.hpp"
#include "regions/face_fillings.hpp"
#include "regions/sigma_pieces.hpp"
#include "tegl/tile/choices.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

class DecidedCells;
class ResolvedCells;

/// Everything that a cell's contour depends on.
struct CellKey {
  std::uint16_t signature = 0;
  /// By facet: FaceFillings; of a hexahedron that is decided: CubeFrame.
  std::array<std::uint8_t, 16> fillings{};
  std::uint32_t squares = 0;  ///< decided: whether quadrilaterals are high, as bits
  /// Decided: tile::Choice of facet f in bits 2 f and 2 f + 1; of an octahedron: of a lone pair with a tunnel.
  std::uint16_t cubes = 0;
  tile::Choice tile = tile::Choice::separate;
  auto operator<=>(const CellKey&) const = default;
};

/// Masks of shared vertices: a vertex of its own of facet f, which is a hexahedron, has bit kOwnOfFacet + f. The other
/// bits are its mask in the cube of images (ResolvedCubes::mask), as corners and edges of the cell.
inline constexpr unsigned kOwnOfFacet = 48;
/// Bit of the mask of a tesseract's side vertex: weights are slightly unequal (mask_place).
inline constexpr std::uint64_t kIsUneven = std::uint64_t{1} << 63;
/// First of four bits of the mask of a double (ResolvedTesseract::kIsDouble): the cube of images whose own vertex is
/// doubled, with the other bits as in ResolvedCubes::mask; 8: the vertex on an edge.
inline constexpr unsigned kDoubled = 56;

/// A contour before it is in a table: tetrahedra of local vertices, and the masks of added vertices by kind.
struct BuiltContour {
  std::vector<std::array<std::uint8_t, 4>> tetrahedra;
  std::vector<std::uint64_t> shared, cones, sides, collars;
  bool of_image = false;  ///< of a tesseract in images
};

/// The contour in a facet of a 4D cell. Polygons that it has not in triangles are coned from their barycentres.
struct DecidedFacet {
  /// In compact contours: its triangles, between edges of the facet, oriented alike.
  bool is_compact = false;
  std::span<const FaceFillings::Triangle> triangles{};
  std::optional<CubeContour> cube{};  ///< of a hexahedron that is decided
  std::optional<LonePair> tunnel{};   ///< of an octahedron with a tunnel
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
  /// The contour in a facet. `corners`: the points at the cell's corners.
  [[nodiscard]] virtual DecidedFacet in_facet(std::size_t facet, const CellKey& key, const Index* corners) const = 0;
  /// Builds the contours of `keys`, which ascend and are distinct. To be called once. Errors: Cancelled.
  void build(std::vector<CellKey> keys, const WorkOptions& work);
  /// The number of a contour that was built.
  [[nodiscard]] std::uint32_t variant(const CellKey& key) const noexcept;
  [[nodiscard]] CellContour contour(std::uint32_t variant) const noexcept { return {table_, lists_[variant]}; }
  /// Whether a contour is that of the tesseract in images. Its side vertices are on rays, where the interpolant has the
  /// isovalue.
  [[nodiscard]] bool is_of_image(std::uint32_t variant) const noexcept { return of_image_[variant] != 0; }
  /// The place in the unit tesseract of a side vertex of an image's contour, from its mask, which has the edges'
  /// numbers in images, and kIsUneven, ResolvedTesseract::kIsDouble and kRepeats. `values`: at the corners.
  [[nodiscard]] static std::array<double, 4> place(std::uint64_t mask, const std::array<double, 16>& values,
                                                   double isovalue, double epsilon) noexcept;

 protected:
  struct Facet {
    const CellFacet* of;
    std::array<std::uint8_t, 12> edges;  ///< of the cell, by edge of the facet
    bool has_own;                        ///< the filling of the facet's own table
  };

  /// `is_swept`: the first two facets, the ends of prisms, have the fillings of their own tables (CellGroups).
  BuiltCells(tables::CellShape shape, bool is_swept);
  [[nodiscard]] static unsigned facet_signature(const Facet& facet, unsigned signature) noexcept;
  /// The points at the corners of a facet.
  [[nodiscard]] static std::array<Index, 8> points_of(const Facet& facet, const Index* corners) noexcept;
  /// Builds contours, on any thread.
  virtual void fill(std::span<const CellKey> keys, std::span<BuiltContour> contours) const = 0;

  tables::CellShape shape_;
  tables::CellTable table_;  ///< of the contours built
  std::vector<Facet> facets_;

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
  CompactCells(tables::CellShape shape, bool high_connected, bool is_swept);
  ~CompactCells() override;

  [[nodiscard]] CellKey key(unsigned signature, const Index* corners,
                            std::span<const double> values) const noexcept override;
  [[nodiscard]] DecidedFacet in_facet(std::size_t facet, const CellKey& key, const Index* corners) const override;

 private:
  /// Builds one contour.
  class Filler;

  void fill(std::span<const CellKey> keys, std::span<BuiltContour> contours) const override;
  /// The triangles of the contour in a facet, as edges of the facet, oriented by the facet's own corners.
  [[nodiscard]] std::span<const FaceFillings::Triangle> triangles_in(std::size_t facet, const CellKey& key) const;

  bool high_connected_;
  const tables::CellTable& barycentric_;
  std::map<tables::CellShape, FaceFillings> fillings_;
  std::vector<const FaceFillings*> fillings_of_;  ///< by facet
  std::unique_ptr<const DecidedCells> copied_;    ///< of prisms over octahedra: fills what the table does not prove
};

/// The contours of the cells of one 4D shape whose ambiguous faces are decided from the data. The contour in a facet is
/// the 3D contour there: in hexahedra the contour of a resolved cube of images, elsewhere discs. Neighbours have the
/// same one, as it depends on values and, in hexahedra and compact contours, on the order of the points' numbers.
class DecidedCells final : public BuiltCells {
 public:
  /// `rule`: not a caller's.
  DecidedCells(tables::CellShape shape, Triangulation triangulation, FaceRule rule, double isovalue, bool is_swept);
  /// Of compact contours by a fixed rule: to fill single contours (fill_as).
  DecidedCells(tables::CellShape shape, bool high_connected, bool is_swept);
  ~DecidedCells() override;

  /// The contour of a key of CompactCells, filled as if its faces were decided. `key.tile`: high to fill components
  /// that are no spheres with copies of the low side, otherwise separate.
  [[nodiscard]] BuiltContour fill_as(CellKey key) const;

  [[nodiscard]] CellKey key(unsigned signature, const Index* corners,
                            std::span<const double> values) const noexcept override;
  [[nodiscard]] DecidedFacet in_facet(std::size_t facet, const CellKey& key, const Index* corners) const override;

 private:
  /// Builds one contour.
  class Filler;

  void fill(std::span<const CellKey> keys, std::span<BuiltContour> contours) const override;
  /// Which of a facet's quadrilaterals are ambiguous, or high, as bits by quadrilaterals_of.
  [[nodiscard]] unsigned ambiguous_in(std::size_t facet, unsigned signature) const noexcept;
  [[nodiscard]] unsigned high_in(std::size_t facet, const CellKey& key) const noexcept;
  /// The lone pair of a facet that is an octahedron. `bits`: its signature.
  [[nodiscard]] std::optional<LonePair> lone_pair_in(std::size_t facet, unsigned bits) const noexcept;
  /// Whether a facet is an octahedron with a tunnel.
  [[nodiscard]] bool has_ring(std::size_t facet, const CellKey& key) const noexcept;
  /// Of a 16-cell. `at`: the values at its corners.
  [[nodiscard]] tile::Choice choice_of_cross_polytope(unsigned signature, std::span<const double> at) const noexcept;
  /// Whether a hexahedron's contour depends on the order of the points' numbers.
  [[nodiscard]] bool has_frame(unsigned signature, unsigned squares, tile::Choice choice) const noexcept;

  Triangulation triangulation_;
  FaceRule rule_;
  double isovalue_;
  bool high_connected_ = false;                                        ///< of the fixed rule
  std::map<tables::CellShape, std::array<FaceFillings, 2>> fillings_;  ///< of facets other than cubes: low, high
  std::unique_ptr<const ResolvedCells> wedges_, octahedra_;
  std::vector<std::array<std::uint8_t, 4>> quadrilaterals_;   ///< their corners; bit i of the place is a coordinate
  std::vector<std::vector<std::uint8_t>> quadrilaterals_in_;  ///< by facet and quadrilaterals_of
};

}  // namespace tegl::detail
