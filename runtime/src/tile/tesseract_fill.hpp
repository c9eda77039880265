// SPDX-License-Identifier: BSD-3-Clause
//
// The contour of a tile of four dimensions whose ambiguous faces are resolved one by one: put together from the
// entries of its eight cubes in the table of the cube with every ambiguity resolved freely (table_contract.hpp).
//
// Each component of Sigma that is a sphere is coned, from one of its own points if no simplex then lies in a face
// without being Sigma's, else from its barycentre. A component of higher genus, and components that the tile's centre
// joins, are filled with a copy of one side of the tile's boundary, put together from the cubes as well
// (cube_regions.hpp). Where all faces are resolved as in the low-connected contour, the compact table is taken.
//
// In the barycentric triangulation the lists are those of the cubes that 3D images are contoured by
// (tile_variants.hpp): so the contour in each face is the 3D contour there. Spheres of more than a tetrahedron's
// triangles are coned from their barycentres, and no table is taken.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tegl/facets/facets.hpp"
#include "tile/cube_regions.hpp"
#include "tile/cube_subcases.hpp"
#include "tile/extract_rows.hpp"

namespace tegl::detail {

/// A square of the tesseract: spans `axes` from corner `base`.
struct TesseractSquare {
  std::uint8_t base, axes;
};

/// Square q = 4 * pair + side of the lower axis that it does not span + 2 * side of the higher one; pairs of such axes:
/// 01, 02, 03, 12, 13, 23.
inline constexpr std::array<TesseractSquare, 24> kTesseractSquares = [] {
  std::array<TesseractSquare, 24> result{};
  unsigned q = 0;
  for (unsigned c = 0; c < 4; ++c)
    for (unsigned d = c + 1; d < 4; ++d)
      for (unsigned sides = 0; sides < 4; ++sides, ++q)
        result[q] = {static_cast<std::uint8_t>((sides & 1u) << c | (sides >> 1) << d),
                     static_cast<std::uint8_t>(15u ^ 1u << c ^ 1u << d)};
  return result;
}();

/// What fixes the contour in a tile of four dimensions. What is said of faces with nothing to choose is ignored.
struct ResolvedKey {
  std::uint32_t squares = 0;  ///< bit q: the centre of square q is high
  std::uint16_t signature = 0;
  std::uint8_t low_cubes = 0, high_cubes = 0;  ///< bit f: the centre of cube f is low, high; neither: separate
  /// separate: spheres are coned; what is none is filled as by a low centre.
  facets::Choice tile = facets::Choice::separate;
};

/// The contour of a tile. Vertices are local: [0, 32) the points on its edges, 32 + 3 f + j own vertex j of cube f's
/// list, 56 + j its own vertex j.
struct ResolvedView {
  const std::uint8_t* simplices;  ///< 4 vertices each; positive side towards high
  std::uint32_t simplex_count;
  std::uint32_t own_vertices;
  /// Own vertex -> bit v: corner, bit 16 + e: edge. With edges only it lies at the mean of their points; with corners
  /// among them, half way from the tile's centre to the mean of all. With ResolvedTesseract::kIsBarycentre it is the
  /// barycentre of the triangles that the simplices have which it comes first in. Bits from ResolvedTesseract::kRepeat
  /// on: how many vertices before it have the same corners and edges; each lies nearer to the centre than the last.
  const std::uint64_t* masks;
};

/// How much a contour has of each.
struct ResolvedSize {
  std::uint32_t simplices, own_vertices;
};

/// Looks tiles up, one after the other: an object for each thread. It holds the last tile alone, less than 100 kB; the
/// tables behind it, 1 MB, are made once, of the generated one, and shared: those of lists in 2 ms, those of regions
/// (cube_regions.hpp), when the first one is asked for, in 0.1 s. Time on noise resolved by means: 0.25 us a tile, of
/// 33 tetrahedra and 2 own vertices in the mean. 31 % of these tiles are the compact table's; 55 % are coned otherwise,
/// with 27 tetrahedra; 14 % are copies of a side, with 100.
class ResolvedTesseract {
 public:
  static constexpr unsigned kFirstOwn = ResolvedCubes::kVertices;
  static constexpr std::uint64_t kIsBarycentre = std::uint64_t{1} << 63;  ///< in masks
  static constexpr unsigned kRepeat = 48;                                 ///< first bit of eight, in masks

  explicit ResolvedTesseract(int triangulation = kCompact);

  /// Valid until the next call.
  const ResolvedView& find(const ResolvedKey& key) { return find(key, lists_of(key)); }
  /// The same where the lists of the tile's cubes are known.
  const ResolvedView& find(const ResolvedKey& key, const ResolvedCubes::Lists& lists);

  /// The size of what `find` finds, in half the time. What `find` returned is as it was.
  [[nodiscard]] ResolvedSize size(const ResolvedKey& key) { return size(key, lists_of(key)); }
  [[nodiscard]] ResolvedSize size(const ResolvedKey& key, const ResolvedCubes::Lists& lists);

  /// Whether neither signs nor choices matter: no square is ambiguous, no cube has several polygons, and Sigma is one
  /// sphere (or there is none). Then the contour is that of the compact table.
  static bool is_settled(std::uint16_t signature) noexcept;

 private:
  using Word = std::uint32_t;  ///< four vertices
  struct Component {
    std::uint64_t vertices = 0;
    std::uint32_t parts = 0;  ///< set of parts
    std::uint32_t triangles = 0;
    std::uint32_t region = 0;  ///< corners of the side that is copied, beside it
    bool is_sphere = false, is_coned = false;
  };

  /// What is looked at of a signature in the compact table.
  struct InTable {
    std::uint32_t first_simplex;
    std::uint16_t simplex_count, own_vertices;
  };
  static const std::vector<InTable>& in_table();
  [[nodiscard]] const CubeRegions& regions();

  [[nodiscard]] ResolvedCubes::Lists lists_of(const ResolvedKey& key) const noexcept;
  [[nodiscard]] const ResolvedCubes::Part& part(unsigned i) const noexcept { return cubes_.part(parts_[i]); }
  void find_cubes(const ResolvedCubes::Lists& lists);
  void find_components(std::uint64_t vertices, std::uint32_t connected);
  void take_from_table(const ResolvedKey& key);
  [[nodiscard]] bool is_in_table(const ResolvedKey& key) const;
  [[nodiscard]] bool find_joined(const ResolvedKey& key);
  [[nodiscard]] bool choose_cones(const ResolvedKey& key, bool joins);
  [[nodiscard]] bool is_first_of_region(unsigned component) const;
  void fill(const ResolvedKey& key, bool joins);
  [[nodiscard]] unsigned apex_of(const Component& component) const;
  void cone(const Component& component);
  void add_region_size(unsigned corners, bool high, ResolvedSize& size);
  [[nodiscard]] static bool is_in(unsigned cube, const CubeRegions::Region& region, unsigned corners) noexcept;
  void find_regions(const ResolvedKey& key, bool high);
  [[nodiscard]] bool is_alone(unsigned component) const;
  void fill_region(unsigned corners, bool high);
  void cap(const Component& component, unsigned corners, std::span<std::uint8_t> sigma);
  [[nodiscard]] std::uint64_t mask_of(unsigned vertex, unsigned corners) const;
  void add_cube_regions(unsigned cube, unsigned corners, bool high, std::size_t first_centre,
                        std::span<const std::uint8_t, 16> copy,
                        std::span<const std::uint8_t, ResolvedCubes::kVertices> sigma);
  void add_simplex(const std::array<std::uint8_t, 4>& vertices);
  unsigned add_own(std::uint64_t mask);
  unsigned add_apart(std::uint64_t mask, std::size_t first);

  bool is_barycentric_;
  const ResolvedCubes& cubes_;
  const CubeRegions* regions_ = nullptr;  ///< once they are asked for
  const InTable* in_table_;               ///< by signature
  // Of the tile at hand.
  ResolvedCubes::Lists lists_{};
  std::array<std::uint32_t, 32 + ResolvedCubes::kMostParts> parts_{};          ///< their numbers
  std::array<std::uint64_t, 32 + ResolvedCubes::kMostParts> part_vertices_{};  ///< of each
  std::array<Component, 32> components_{};
  unsigned part_count_ = 0, component_count_ = 0;
  std::uint32_t triangle_count_ = 0;  ///< of Sigma
  std::uint32_t apexes_ = 0;          ///< where all parts hang together: edges that may be a cone's apex
  bool as_low_ = false;               ///< whether all cubes are those of the low-connected contour
  std::vector<Word> simplices_;
  std::size_t simplex_count_ = 0;
  std::vector<std::uint64_t> masks_;
  ResolvedView view_{};
};

/// The compact table of four dimensions; all tiles that are put together are marked as those with vertices of their
/// own.
const RowTable& estimated_tesseracts(int triangulation);

}  // namespace tegl::detail
