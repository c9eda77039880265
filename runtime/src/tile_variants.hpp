// SPDX-License-Identifier: BSD-3-Clause
//
// Squares and cubes with their ambiguities resolved, as tables that the extraction goes through like the others.
//
// Variant 0 of a signature (extract_rows.hpp) is the plain table's tile; only ambiguous signatures have others. In 2D
// variant 1 is the square with a high centre. In 3D it is 1 + 3 r + choice, with r the resolution of the ambiguous
// squares (tables::ResolvedTable) and the cube's own choice.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "extract_rows.hpp"
#include "face_estimator.hpp"
#include "face_signs.hpp"
#include "resolved_tiles.hpp"
#include "tegl/saddle.hpp"
#include "tegl/table_contract.hpp"

namespace tegl::detail {

/// What a tile of four dimensions is filled with: how it is resolved, and the lists of its cubes, and the keys of those
/// that have vertices of their own.
struct ResolvedTile {
  ResolvedKey key;
  std::array<std::uint16_t, 8> cubes{};
  ResolvedCubes::Lists lists{};
  std::uint8_t with_vertices = 0;  ///< set of the cubes that have vertices of their own
};

/// The table of all keys, N = 2 or 3. In the barycentric triangulation what is no tunnel is coned from its barycentre.
template <int N>
class VariantTable {
 public:
  explicit VariantTable(int triangulation);
  VariantTable(const VariantTable&) = delete;
  VariantTable& operator=(const VariantTable&) = delete;

  /// By key.
  [[nodiscard]] const tables::TileTable& tile() const noexcept { return tile_; }
  [[nodiscard]] const RowTable& rows() const noexcept { return rows_.front(); }

 private:
  void add(unsigned key, const std::vector<std::uint8_t>& simplices, unsigned cones,
           const std::vector<std::uint64_t>& masks);
  void add_plain(unsigned key, const tables::TileTable& from, unsigned signature, bool reversed);
  void add_variants(int triangulation);
  void finish();
  void make_rows();

  std::vector<tables::List> lists_;
  std::vector<std::uint16_t> list_of_;
  std::vector<std::uint8_t> simplices_;
  std::vector<std::uint64_t> masks_;
  tables::TileTable tile_{};
  std::vector<RowTable> rows_;
};

/// The one of a triangulation (0: barycentric, 1: compact), made when it is first asked for.
template <int N>
const VariantTable<N>& variant_table(int triangulation);

/// Whether the data have a say in a tile: a square of it is ambiguous, or it may have several facets. By signature.
template <int N>
const std::array<bool, std::size_t{1} << (1u << N)>& ambiguous_signatures() noexcept;
template <>
const std::array<bool, 16>& ambiguous_signatures<2>() noexcept;
template <>
const std::array<bool, 256>& ambiguous_signatures<3>() noexcept;
template <>
const std::array<bool, 65536>& ambiguous_signatures<4>() noexcept;

/// The key of the cube along `axes` based at `base` of an image of three or four dimensions.
template <int N>
unsigned cube_key(const FaceEstimator<N>& estimator, const std::array<std::size_t, N>& base, unsigned axes,
                  unsigned signature) noexcept;

/// Whether a tile of four dimensions is put together from its cubes where data decide: if they have a say in it, and in
/// the barycentric triangulation always, as the cubes' barycentres are listed with their tiles.
inline bool is_put_together(const FaceEstimator<4>& estimator, unsigned signature) noexcept {
  return estimator.triangulation() == kBarycentric || ambiguous_signatures<4>()[signature];
}
/// The filling of such a tile.
ResolvedTile resolved_tile(const FaceEstimator<4>& estimator, const std::array<std::size_t, 4>& base,
                           unsigned signature) noexcept;
/// The same of tile `bit` of a block; false where it is to be asked for by itself.
bool resolve(const FaceEstimator<4>& estimator, const FaceBlock<4>& block, unsigned bit, unsigned signature,
             ResolvedTile& tile) noexcept;

/// The compact table of four dimensions; all tiles that are put together are marked as those with vertices of their
/// own.
const RowTable& estimated_tesseracts(int triangulation);

/// The number of the list (ResolvedCubes) that a cube's key stands for; kNone for a cube without a contour.
unsigned list_of_key(unsigned key) noexcept;

/// How many vertices of its own a cube has, by key.
inline unsigned cube_vertices(int triangulation, unsigned key) {
  return variant_table<3>(triangulation).rows().own_vertices(key);
}

/// The faces of a row's tiles, N = 3 or 4, a word of tiles at a time: where many of a word's tiles are ambiguous this
/// is quicker than to ask for them one by one.
template <int N>
class RowFaces {
 public:
  using Index = std::array<std::size_t, N>;
  /// So many ambiguous tiles of a word are worth it.
  static constexpr std::size_t kMany = 6;

  /// Of the row through `base`, which has `samples`.
  RowFaces(const FaceEstimator<N>& estimator, const Index& base, std::size_t samples) noexcept
      : estimator_(estimator), base_(base), samples_(samples) {}
  /// Not for a caller's estimator.
  static bool can_use(const FaceEstimator<N>& estimator) noexcept { return !estimator.is_callers(); }

  /// Decides all faces of a word's tiles, unless it was the last one.
  const FaceBlock<N>& look_at(std::size_t word) noexcept;

 private:
  const FaceEstimator<N>& estimator_;
  Index base_;
  std::size_t samples_;
  std::size_t word_ = ~std::size_t{0};
  FaceBlock<N> block_;
};

/// The ambiguous tiles of a row of tesseracts, one after the other: decided a word at a time where that pays.
class RowOfTesseracts {
 public:
  /// Of the row through `base`, which has `samples`; `tiles`: its active tiles.
  RowOfTesseracts(const FaceEstimator<4>& estimator, const std::array<std::size_t, 4>& base, std::size_t samples,
                  const ActiveTiles& tiles) noexcept
      : estimator_(estimator),
        tiles_(tiles),
        at_once_(samples <= kMostListed && RowFaces<4>::can_use(estimator)),
        faces_(estimator, base, samples) {}
  /// Number `ordinal` of the active tiles, which is at `base`; numbers rise from call to call.
  ResolvedTile resolve(const std::array<std::size_t, 4>& base, std::uint32_t ordinal, unsigned signature) noexcept;

 private:
  const FaceEstimator<4>& estimator_;
  ActiveTiles tiles_;
  bool at_once_;
  std::size_t word_ = ~std::size_t{0};
  bool has_many_ = false;  ///< whether the word is decided at once
  RowFaces<4> faces_;
};

/// Tiles at a word, with ambiguous signatures, and what becomes of them: with key 0, that it is to be asked for by
/// itself.
struct TilesOfWord {
  std::size_t count = 0;
  std::array<std::uint8_t, kWordBits> bits, signatures;
  std::array<Variant, kWordBits> variants;
};
void resolve(const FaceEstimator<3>& estimator, const RowTable& table, const FaceBlock<3>& block,
             TilesOfWord& tiles) noexcept;

/// The key of an ambiguous tile.
template <int N>
unsigned resolved_key(const FaceEstimator<N>& estimator, const std::array<std::size_t, N>& base,
                      unsigned signature) noexcept;
template <>
unsigned resolved_key<2>(const FaceEstimator<2>& estimator, const std::array<std::size_t, 2>& base,
                         unsigned signature) noexcept;
template <>
unsigned resolved_key<3>(const FaceEstimator<3>& estimator, const std::array<std::size_t, 3>& base,
                         unsigned signature) noexcept;

}  // namespace tegl::detail
