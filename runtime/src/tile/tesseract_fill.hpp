// SPDX-License-Identifier: BSD-3-Clause
//
// The contour of a 4D tile whose ambiguous faces are resolved one by one. It is combined from its eight cubes, which
// are entries of the table of cubes with every ambiguity resolved freely (table_contract.hpp).
//
// A component of Sigma that is a sphere is coned from one of its own vertices, provided that no simplex then lies in a
// face of the tile without belonging to Sigma; otherwise from its barycentre. A component of higher genus, and
// components that the tile's centre joins, are filled with a copy of one side of the tile's boundary, which is also
// combined from the cubes (cube_regions.hpp). If all faces are resolved as in the low-connected contour, the compact
// table is used.
//
// In the barycentric triangulation, the lists are those of the cubes of 3D images (variant_table.hpp), so the contour
// in each face is the 3D contour there. Spheres with more triangles than a tetrahedron are coned from their
// barycentres, and the compact table is not used.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tegl/tile/facets.hpp"
#include "tile/cube_regions.hpp"
#include "tile/cube_subcases.hpp"
#include "tile/row_table.hpp"

namespace tegl::detail {

/// A square of the tesseract: spans `axes` from corner `base`.
struct TesseractSquare {
  std::uint8_t base, axes;
};

/// Square q = 4 * pair + (side of the lower axis that it does not span) + 2 * (side of the higher one). Pairs of such
/// axes in order: 01, 02, 03, 12, 13, 23.
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

/// Determines the contour in a 4D tile. Bits of faces without a choice are ignored.
struct ResolvedKey {
  std::uint32_t squares = 0;  ///< bit q: whether the centre of square q is high
  std::uint16_t signature = 0;
  std::uint8_t low_cubes = 0, high_cubes = 0;  ///< bit f: the centre of cube f is low, or high; neither: separate
  /// separate: spheres are coned, other components are filled as with a low centre.
  tile::Choice tile = tile::Choice::separate;
};

/// The contour of a tile. Local vertices: [0, 32) are on its edges; 32 + 3 f + j is own vertex j of cube f's list; 56 +
/// j is own vertex j of the tile.
struct ResolvedView {
  const std::uint8_t* simplices;  ///< 4 vertices each; the positive side faces high corners
  std::uint32_t simplex_count;
  std::uint32_t own_vertices;
  /// By own vertex: bit v for a corner, bit 16 + e for an edge. With edges only, it lies at the mean of their vertices;
  /// with corners, half way from the tile's centre to the mean of all. With ResolvedTesseract::kIsBarycentre it is the
  /// barycentre of the triangles of those simplices whose first vertex it is. Bits from ResolvedTesseract::kRepeat on:
  /// the number of earlier vertices with the same corners and edges; each repetition lies nearer to the centre.
  const std::uint64_t* masks;
};

/// Size of a tile's contour.
struct ResolvedSize {
  std::uint32_t simplices, own_vertices;
};

/// Finds the contours of tiles, one at a time; one object per thread. It holds only the last tile (less than 100 kB).
/// Its tables (1 MB) are derived once from the generated one and shared: those of lists take 2 ms, those of regions
/// (cube_regions.hpp) 0.1 s at first use. Time on noise resolved by means: 0.25 us per tile, with 33 tetrahedra and 2
/// own vertices on average. 31 % of these tiles come from the compact table; 55 % are coned otherwise, with 27
/// tetrahedra; 14 % are copies of a side, with 100.
class ResolvedTesseract {
 public:
  static constexpr unsigned kFirstOwn = ResolvedCubes::kVertices;
  static constexpr std::uint64_t kIsBarycentre = std::uint64_t{1} << 63;  ///< bit of masks
  static constexpr unsigned kRepeat = 48;                                 ///< first of eight bits of masks

  explicit ResolvedTesseract(Triangulation triangulation = Triangulation::compact);

  /// The result is valid until the next call.
  const ResolvedView& find(const ResolvedKey& key) { return find(key, lists_of(key)); }
  /// Variant for known lists of the tile's cubes.
  const ResolvedView& find(const ResolvedKey& key, const ResolvedCubes::Lists& lists);

  /// Size of the contour that `find` finds, in half the time. Does not invalidate the result of `find`.
  [[nodiscard]] ResolvedSize size(const ResolvedKey& key) { return size(key, lists_of(key)); }
  [[nodiscard]] ResolvedSize size(const ResolvedKey& key, const ResolvedCubes::Lists& lists);

  /// Whether neither signs nor choices matter: no square is ambiguous, no cube has several polygons, and Sigma is empty
  /// or one sphere. The contour is then the compact table's.
  static bool is_settled(std::uint16_t signature) noexcept { return !tables::kAmbiguous4[signature]; }

 private:
  using Word = std::uint32_t;  ///< four vertices
  struct Component {
    std::uint64_t vertices = 0;
    std::uint32_t parts = 0;  ///< bit set of parts
    std::uint32_t triangles = 0;
    std::uint32_t region = 0;  ///< corners of the adjacent region whose copy may fill it
    bool is_sphere = false, is_coned = false;
  };

  /// Fields of the compact table that are read, by signature.
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
  const CubeRegions* regions_ = nullptr;  ///< null until first used
  const InTable* in_table_;               ///< by signature
  // The current tile:
  ResolvedCubes::Lists lists_{};
  std::array<std::uint32_t, 32 + ResolvedCubes::kMostParts> parts_{};          ///< numbers of the parts of its cubes
  std::array<std::uint64_t, 32 + ResolvedCubes::kMostParts> part_vertices_{};  ///< vertices of each part
  std::array<Component, 32> components_{};
  unsigned part_count_ = 0, component_count_ = 0;
  std::uint32_t triangle_count_ = 0;  ///< triangles of Sigma
  std::uint32_t apexes_ = 0;          ///< edges that may be the cone's apex, if all parts are connected
  bool as_low_ = false;               ///< whether all cubes are those of the low-connected contour
  std::vector<Word> simplices_;
  std::size_t simplex_count_ = 0;
  std::vector<std::uint64_t> masks_;
  ResolvedView view_{};
};

}  // namespace tegl::detail
