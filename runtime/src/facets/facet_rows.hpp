// SPDX-License-Identifier: BSD-3-Clause
//
// The critical faces of a grid (those that the contour crosses), of all dimensions, as bits by rows along axis 0, over
// the whole image.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "image/bitplanes.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// A kind of faces: those along the axes in `axes`. `outward`: faces of the border, each times an interval that leads
/// out of the image to low values, so that its high part becomes a facet (a cap; see grid_cells.hpp). The interval is
/// the last axis.
struct FaceKind {
  unsigned axes = 0;
  bool outward = false;

  [[nodiscard]] constexpr unsigned grid_dim() const noexcept { return static_cast<unsigned>(std::popcount(axes)); }
  [[nodiscard]] constexpr unsigned dim() const noexcept { return grid_dim() + (outward ? 1 : 0); }
  /// Grid axis of the face's axis j < grid_dim().
  [[nodiscard]] constexpr unsigned axis(unsigned j) const noexcept {
    unsigned rest = axes;
    for (; j > 0; --j) rest &= rest - 1;
    return static_cast<unsigned>(std::countr_zero(rest));
  }
  /// A set of axes of the face, as a set of axes of the grid.
  [[nodiscard]] constexpr unsigned spread(unsigned set) const noexcept {
    unsigned result = 0;
    for (unsigned j = 0; j < grid_dim(); ++j) result |= (set >> j & 1u) << axis(j);
    return result;
  }
};

/// Offsets of the corners of a kind of faces from its first sample, in words and samples.
struct FaceCorners {
  unsigned count = 0;
  std::array<std::size_t, 16> words{};
  std::array<std::uint8_t, 16> ahead{};
};

/// Bits of the samples in rows, and the layout of rows.
template <int N>
class GridRows {
 public:
  using Index = std::array<std::size_t, N>;
  static constexpr unsigned kAll = (1u << N) - 1;

  /// Bit a of `closed_axes`: faces across axis a at the border may lead out of the image.
  explicit GridRows(const Index& sizes, unsigned closed_axes = kAll)
      : sizes_(sizes),
        closed_axes_(closed_axes),
        words_((sizes[0] + kWordBits - 1) / kWordBits),
        high_(),
        missing_(),
        tiles_() {
    for (int a = 1; a < N; ++a) {
      strides_[a] = rows_;
      rows_ *= sizes[a];
    }
    high_.assign(rows_ * pitch(), 0);
  }
  [[nodiscard]] std::size_t size(int axis) const noexcept { return sizes_[axis]; }
  [[nodiscard]] std::size_t rows() const noexcept { return rows_; }
  [[nodiscard]] std::size_t words() const noexcept { return words_; }
  /// Words per row: one more than needed, always 0.
  [[nodiscard]] std::size_t pitch() const noexcept { return words_ + 1; }
  /// Distance between rows along an axis > 0.
  [[nodiscard]] std::size_t stride(unsigned axis) const noexcept { return strides_[axis]; }
  [[nodiscard]] std::size_t shift(unsigned axes) const noexcept {
    std::size_t result = 0;
    for (unsigned a = 1; a < N; ++a) result += (axes >> a & 1u) * strides_[a];
    return result;
  }
  [[nodiscard]] Index index_of(std::size_t row) const noexcept {
    Index index{};
    for (int a = 1; a < N; ++a) index[a] = row / strides_[a] % sizes_[a];
    return index;
  }
  [[nodiscard]] Word* high(std::size_t row) noexcept { return high_.data() + row * pitch(); }
  [[nodiscard]] const Word* high(std::size_t row) const noexcept { return high_.data() + row * pitch(); }

  /// `missing`: rows x pitch.
  void set_missing(std::vector<Word> missing) {
    missing_ = std::move(missing);
    tiles_.assign(rows_ * pitch(), 0);
    for (std::size_t row = 0; row < rows_; ++row)
      for (std::size_t w = 0; w < words_; ++w) {
        if (!has_faces(index_of(row), kAll)) break;
        Word any = 0;
        for (unsigned c = 0; c <= kAll; ++c) any |= ahead(missing_.data() + (row + shift(c)) * pitch() + w, c & 1u);
        tiles_[row * pitch() + w] = ~any & mask(w, true);
      }
    find_near_missing();
  }
  [[nodiscard]] bool any_missing() const noexcept { return !tiles_.empty(); }

  [[nodiscard]] FaceCorners corners_of(const FaceKind& kind) const noexcept {
    FaceCorners corners{1u << kind.grid_dim(), {}, {}};
    for (unsigned c = 0; c < corners.count; ++c) {
      const unsigned axes = kind.spread(c);
      corners.words[c] = shift(axes) * pitch();
      corners.ahead[c] = axes & 1u;
    }
    return corners;
  }
  /// The faces of a kind in word w of a row that have high and low corners and belong to a tile without missing
  /// corners.
  [[nodiscard]] Word critical(const FaceKind& kind, const FaceCorners& corners, std::size_t row, const Index& index,
                              std::size_t w) const noexcept {
    Word any = 0, all = ~Word{0};
    const Word* const at = high(row) + w;
    for (unsigned c = 0; c < corners.count; ++c) {
      const Word word = ahead(at + corners.words[c], corners.ahead[c]);
      any |= word;
      all &= word;
    }
    Word result = (kind.outward ? any : any & ~all) & mask(w, (kind.axes & 1u) != 0);
    if (result == 0) return 0;
    if (kind.outward) result &= border(kind, index, w);
    if (any_missing() && result != 0) result &= in_valid_tiles(kind, index, row, w);
    return result;
  }
  /// Whether faces along these axes start in the row.
  [[nodiscard]] bool has_faces(const Index& index, unsigned axes) const noexcept {
    for (int a = 1; a < N; ++a)
      if ((axes >> a & 1u) != 0 && index[a] + 1 >= sizes_[a]) return false;
    return (axes & 1u) == 0 || sizes_[0] > 1;
  }
  /// The high corners of a face; for outward faces, of the end inside the image.
  [[nodiscard]] unsigned signature(const FaceCorners& corners, std::size_t row, std::size_t i) const noexcept {
    unsigned result = 0;
    const Word* const at = high(row);
    for (unsigned c = 0; c < corners.count; ++c) {
      const std::size_t sample = i + corners.ahead[c];
      result |= static_cast<unsigned>(at[corners.words[c] + sample / kWordBits] >> (sample % kWordBits) & 1u) << c;
    }
    return result;
  }
  /// Whether no tile of the image around a face has missing corners.
  [[nodiscard]] bool is_surrounded(unsigned axes, std::size_t row, std::size_t i) const noexcept {
    if (!any_missing() || (near_missing_[row * pitch() + i / kWordBits] >> (i % kWordBits) & 1u) == 0) return true;
    const Index index = index_of(row);
    const unsigned across = kAll & ~axes;
    for (unsigned back = across;; back = (back - 1) & across) {
      if (is_inside(index, i, back) && !tile(row - shift(back), i - (back & 1u))) return false;
      if (back == 0) return true;
    }
  }

 private:
  /// Marks the samples that are corners of tiles with missing corners.
  void find_near_missing() {
    near_missing_.assign(rows_ * pitch(), 0);
    for (std::size_t row = 0; row < rows_; ++row) {
      if (!has_faces(index_of(row), kAll)) continue;
      Word before = 0;  // carry: the last tile of the previous word
      for (std::size_t w = 0; w <= words_; ++w) {
        const Word bad = w < words_ ? ~tiles_[row * pitch() + w] & mask(w, true) : 0;
        const Word corners = bad | bad << 1 | before;
        before = bad >> (kWordBits - 1);
        for (unsigned c = 0; c <= kAll && corners != 0; c += 2)
          near_missing_[(row + shift(c)) * pitch() + w] |= corners;
      }
    }
  }
  static Word ahead(const Word* at, unsigned shift) noexcept {
    return shift == 0 ? at[0] : at[0] >> 1 | at[1] << (kWordBits - 1);
  }
  [[nodiscard]] Word mask(std::size_t w, bool along_row) const noexcept {
    const std::size_t count = sizes_[0] - (along_row ? 1 : 0);
    if (count >= (w + 1) * kWordBits) return ~Word{0};
    return count <= w * kWordBits ? 0 : (Word{1} << (count - w * kWordBits)) - 1;
  }
  /// Whether the image has a tile one sample back along the axes in `back`.
  [[nodiscard]] bool is_inside(const Index& index, std::size_t i, unsigned back) const noexcept {
    for (unsigned a = 0; a < N; ++a) {
      const std::size_t at = a == 0 ? i : index[a], step = back >> a & 1u;
      if (at < step || at - step + 1 >= sizes_[a]) return false;
    }
    return true;
  }
  [[nodiscard]] bool tile(std::size_t row, std::size_t i) const noexcept {
    return (tiles_[row * pitch() + i / kWordBits] >> (i % kWordBits) & 1u) != 0;
  }
  [[nodiscard]] bool closes(unsigned axis) const noexcept { return (closed_axes_ >> axis & 1u) != 0; }
  [[nodiscard]] Word border(const FaceKind& kind, const Index& index, std::size_t w) const noexcept {
    for (unsigned a = 1; a < N; ++a)
      if (closes(a) && (kind.axes >> a & 1u) == 0 && (index[a] == 0 || index[a] + 1 == sizes_[a])) return ~Word{0};
    if ((kind.axes & 1u) != 0 || !closes(0)) return 0;
    Word result = w == 0 ? 1 : 0;
    if (w == (sizes_[0] - 1) / kWordBits) result |= Word{1} << ((sizes_[0] - 1) % kWordBits);
    return result;
  }
  [[nodiscard]] Word in_valid_tiles(const FaceKind& kind, const Index& index, std::size_t row,
                                    std::size_t w) const noexcept {
    Word result = 0;
    const unsigned across = kAll & ~kind.axes;
    for (unsigned back = across;; back = (back - 1) & across) {
      bool inside = true;
      for (unsigned a = 1; a < N; ++a) inside = inside && index[a] >= (back >> a & 1u);
      if (inside) {
        const Word* const at = tiles_.data() + (row - shift(back)) * pitch() + w;
        result |= (back & 1u) == 0 ? at[0] : at[0] << 1 | (w == 0 ? 0 : at[-1] >> (kWordBits - 1));
      }
      if (back == 0) return result;
    }
  }

  Index sizes_;
  unsigned closed_axes_;
  std::array<std::size_t, N> strides_{};
  std::size_t rows_ = 1;
  std::size_t words_;
  std::vector<Word> high_;
  std::vector<Word> missing_;
  std::vector<Word> tiles_;         ///< tiles without missing corners; empty: all tiles
  std::vector<Word> near_missing_;  ///< samples that are corners of tiles with missing corners
};

/// The faces of one kind that have facets, and the number of the first facet of each.
class FaceNumbers {
 public:
  void reset(std::size_t rows, std::size_t words) {
    words_ = words;
    bits.assign(rows * words, 0);
    before_.assign(rows * words, 0);
    first_facet.assign(rows, 0);
    first_entry.assign(rows, 0);
  }
  /// Call it after the bits are set. `has_types`: faces have a type (FaceFacets).
  void rank(bool has_types) {
    std::uint32_t count = 0;
    for (std::size_t w = 0; w < bits.size(); ++w) {
      before_[w] = count;
      count += static_cast<std::uint32_t>(std::popcount(bits[w]));
    }
    first_.resize(count);
    if (has_types) types_.resize(count);
  }
  /// The number of the first facet of a face that has one.
  [[nodiscard]] Index& first(std::size_t row, std::size_t i) noexcept { return first_[ordinal(row, i)]; }
  [[nodiscard]] Index first(std::size_t row, std::size_t i) const noexcept { return first_[ordinal(row, i)]; }
  [[nodiscard]] Index* first_of_row(std::size_t row) noexcept { return first_.data() + before_[row * words_]; }
  [[nodiscard]] std::uint16_t& type(std::size_t row, std::size_t i) noexcept { return types_[ordinal(row, i)]; }
  [[nodiscard]] std::uint16_t type(std::size_t row, std::size_t i) const noexcept { return types_[ordinal(row, i)]; }

  std::vector<Word> bits;                  ///< rows x words
  std::vector<std::uint64_t> first_facet;  ///< by row: number of facets; after the prefix sum, the first facet's number
  std::vector<std::uint64_t> first_entry;  ///< by row: number of boundary entries; after the prefix sum, the first one
  /// By row, for cubes resolved from the data: the same for points and segments inside, and for ends of segments.
  std::vector<std::uint64_t> first_point, first_segment, first_end;

 private:
  [[nodiscard]] std::size_t ordinal(std::size_t row, std::size_t i) const noexcept {
    const std::size_t w = row * words_ + i / kWordBits;
    return before_[w] + static_cast<std::size_t>(std::popcount(bits[w] & ((Word{1} << (i % kWordBits)) - 1)));
  }

  std::size_t words_ = 0;
  std::vector<std::uint32_t> before_;
  Buffer<Index> first_;
  Buffer<std::uint16_t> types_;
};

}  // namespace tegl::detail
