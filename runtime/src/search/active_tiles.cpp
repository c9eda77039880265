// SPDX-License-Identifier: BSD-3-Clause
//
// Common parts of all indexes of active tiles: order, rows, and the head of a file.
#include "tegl/active_tiles.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <initializer_list>
#include <utility>

#include <fmt/format.h>

#include "search/active_tiles_methods.hpp"
#include "search/index_file.hpp"

namespace tegl {

namespace {

constexpr std::array<std::string_view, 5> kMethodNames = {"full-scan", "interval-tree", "span-space", "min-max-tree",
                                                          "seed-set"};

/// Radix sort, lowest digit first: O(tiles).
void sort_by_digits(std::vector<TileNumber>& tiles, TileNumber end) {
  constexpr unsigned kDigitBits = 12;
  constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
  std::vector<TileNumber> sorted(tiles.size());
  std::array<std::size_t, kDigits> next;
  for (unsigned shift = 0; (end - 1) >> shift != 0; shift += kDigitBits) {
    next.fill(0);
    for (const TileNumber tile : tiles) ++next[tile >> shift & (kDigits - 1)];
    std::size_t sum = 0;
    for (std::size_t& first : next) sum += std::exchange(first, sum);
    for (const TileNumber tile : tiles) sorted.data()[next[tile >> shift & (kDigits - 1)]++] = tile;
    tiles.swap(sorted);
  }
}

/// Sorts in time proportional to the number of tiles in the list, not in the grid: many by a bit set, few by
/// comparisons, others by radix sort.
void put_in_order(std::vector<TileNumber>& tiles, TileNumber end) {
  constexpr std::size_t kFew = 4096;
  constexpr TileNumber kTilesPerBit = 32;
  if (tiles.size() < kFew) return std::sort(tiles.begin(), tiles.end());
  if (tiles.size() < end / kTilesPerBit) return sort_by_digits(tiles, end);
  std::vector<std::uint64_t> bits((end + 63) / 64);
  for (const TileNumber tile : tiles) bits.data()[tile / 64] |= std::uint64_t{1} << (tile % 64);
  TileNumber* to = tiles.data();
  for (std::size_t w = 0; w < bits.size(); ++w)
    for (std::uint64_t word = bits.data()[w]; word != 0; word &= word - 1)
      *to++ = w * 64 + static_cast<unsigned>(std::countr_zero(word));
}

/// The upper 64 bits of a product.
std::uint64_t high_half(std::uint64_t a, std::uint64_t b) noexcept {
  __extension__ using Wide = unsigned __int128;
  return static_cast<std::uint64_t>(static_cast<Wide>(a) * b >> 64);
}

/// Bytes of a value of the named type; throws MalformedFile if there is none.
std::size_t bytes_of_value(ValueType type) {
  std::size_t bytes = 0;
  const auto compare = [&]<Value... T>() { ((bytes = kValueType<T> == type ? sizeof(T) : bytes), ...); };
  compare.operator()<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::int32_t, float, double>();
  return bytes;
}

void require_finite(double isovalue) {
  if (!std::isfinite(isovalue))
    throw Error(ErrorCode::InvalidIsovalue, fmt::format("isovalue {}; expected a finite number", isovalue));
}

}  // namespace

std::string_view active_method_name(ActiveMethod method) noexcept {
  return kMethodNames[static_cast<std::size_t>(method)];
}

std::vector<ActiveMethod> active_methods() {
  std::vector<ActiveMethod> methods;
  for (std::size_t i = 0; i < kMethodNames.size(); ++i) methods.push_back(static_cast<ActiveMethod>(i));
  return methods;
}

void TileRowSet::add_all() noexcept {
  std::fill(words_.begin(), words_.end(), ~std::uint64_t{0});
  if (rows_ % 64 != 0) words_.back() >>= 64 - rows_ % 64;
}

std::size_t TileRowSet::count() const noexcept {
  std::size_t count = 0;
  for (const std::uint64_t word : words_) count += static_cast<std::size_t>(std::popcount(word));
  return count;
}

template <int N>
requires DimensionBetween<N, 2, 5>
void TileRowSet::add_rows_of(const TileGrid<N>& grid, const std::vector<TileNumber>& tiles) noexcept {
  // Consecutive tiles are often in one row. The row is computed only if the tile is outside the last row, by a
  // multiplication if tile numbers have 32 bits. (Lemire, Kaser, Kurz, Faster Remainder by Direct Computation, 2019.)
  const TileNumber along = grid.size(0);
  const bool narrow = grid.count() <= std::uint64_t{1} << 32 && along > 1;
  const std::uint64_t inverse = ~std::uint64_t{0} / along + 1;
  TileNumber first = 1;
  TileNumber end = 0;
  for (const TileNumber tile : tiles) {
    if (tile >= first && tile < end) continue;
    const std::size_t row = narrow ? high_half(inverse, tile) : grid.row(tile);
    first = row * along;
    end = first + along;
    add(row);
  }
}

template <int N>
requires DimensionBetween<N, 2, 5> std::vector<TileNumber> ActiveTiles<N>::find(double isovalue)
const {
  require_finite(isovalue);
  std::vector<TileNumber> tiles;
  if (grid_.count() == 0) return tiles;
  collect(isovalue, tiles);
  if (!std::is_sorted(tiles.begin(), tiles.end())) put_in_order(tiles, grid_.count());
  return tiles;
}

template <int N>
requires DimensionBetween<N, 2, 5> TileRowSet ActiveTiles<N>::find_rows(double isovalue)
const {
  require_finite(isovalue);
  TileRowSet rows(grid_.rows());
  if (grid_.count() != 0) collect_rows(isovalue, rows);
  return rows;
}

template <int N>
requires DimensionBetween<N, 2, 5>
void ActiveTiles<N>::collect_rows(double isovalue, TileRowSet& rows) const {
  std::vector<TileNumber> tiles;
  collect(isovalue, tiles);
  rows.add_rows_of(grid_, tiles);
}

template <int N>
requires DimensionBetween<N, 2, 5>
void ActiveTiles<N>::save(ByteSink& to) const {
  if (!is_complete())
    throw Error(ErrorCode::InvalidArgument, "chosen tiles cannot be saved; expected an index of all active tiles");
  detail::IndexWriter writer(to);
  detail::write_head(writer, method(), image_);
  write(writer);
  writer.finish();
}

namespace detail {

void write_magic(IndexWriter& to, ActiveMethod method, int dim) {
  to.value(kIndexMagic);
  to.value(kIndexByteOrder);
  to.value(kIndexVersion);
  to.text(active_method_name(method));
  to.value(static_cast<std::uint32_t>(dim));
}

ActiveTilesHead read_head(IndexReader& from) {
  if (from.value<std::array<char, 8>>("name of the format") != kIndexMagic)
    throw Error(ErrorCode::MalformedFile, "not an index of active tiles; expected a file written by 'tegl index'");
  if (from.value<std::uint32_t>("byte order") != kIndexByteOrder)
    throw Error(ErrorCode::UnsupportedFormat,
                "the index was written on a machine with another byte order; build it again");
  ActiveTilesHead head;
  head.version = from.value<std::uint32_t>("version");
  if (head.version != kIndexVersion)
    throw Error(ErrorCode::UnsupportedFormat,
                fmt::format("the index has version {}; expected {}: build it again", head.version, kIndexVersion));
  constexpr std::size_t kLongName = 64;
  const std::string method = from.text(kLongName, "name of the method");
  const auto* const name = std::find(kMethodNames.begin(), kMethodNames.end(), method);
  if (name == kMethodNames.end())
    throw Error(ErrorCode::UnsupportedFormat, fmt::format("the index is of the method '{}'; expected one of {}", method,
                                                          fmt::join(kMethodNames, ", ")));
  head.method = static_cast<ActiveMethod>(name - kMethodNames.begin());
  const auto dim = from.value<std::uint32_t>("dimension");
  if (dim < 2 || dim > 5) IndexReader::damaged(fmt::format("it is of dimension {}; expected 2 to 5", dim));
  for (std::uint32_t a = 0; a < dim; ++a) head.sizes.push_back(from.value<std::uint64_t>("sizes of the image"));
  const std::string type_name = from.text(kLongName, "value type");
  const std::optional<ValueType> type = parse_value_type(type_name);
  if (!type || bytes_of_value(*type) == 0) IndexReader::damaged(fmt::format("it is of values of type '{}'", type_name));
  head.value_type = *type;
  head.digest = from.value<std::uint64_t>("digest of the values");
  head.any_missing = from.value<std::uint8_t>("note of missing values") != 0;
  return head;
}

void require_same_image(const ActiveTilesHead& head, std::span<const std::size_t> sizes, ValueType value_type,
                        std::uint64_t digest) {
  if (!std::equal(head.sizes.begin(), head.sizes.end(), sizes.begin(), sizes.end()) || head.value_type != value_type)
    throw Error(ErrorCode::InvalidArgument, fmt::format("the index is of an image of {} {}; expected the one of {} {}",
                                                        fmt::join(head.sizes, " x "), name_of(head.value_type),
                                                        fmt::join(sizes, " x "), name_of(value_type)));
  if (head.digest != digest)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("the index is of an image with other values: digest {:016x}; expected {:016x}", head.digest,
                            digest));
}

}  // namespace detail

ActiveTilesHead read_active_tiles_head(ByteSource& from) {
  detail::IndexReader reader(from);
  return detail::read_head(reader);
}

ActiveTilesHead check_active_tiles(ByteSource& from) {
  detail::IndexReader reader(from);
  ActiveTilesHead head = detail::read_head(reader);
  const std::size_t value = bytes_of_value(head.value_type);
  constexpr std::size_t kPlace = 8, kTile = 4;
  const auto pass = [&](std::initializer_list<std::size_t> arrays) {
    for (const std::size_t bytes : arrays) reader.pass_array(bytes, "arrays of the method");
  };
  switch (head.method) {
    case ActiveMethod::full_scan:
      break;
    case ActiveMethod::interval_tree:
      pass({value, kPlace, kTile, value, kTile, value});
      break;
    case ActiveMethod::span_space:
      pass({value, kPlace, kTile, value, value});
      break;
    case ActiveMethod::min_max_tree:
      reader.value<std::uint32_t>("length of bricks");
      reader.value<std::uint32_t>("width of bricks");
      while (reader.pass_array(value, "minimum values") > 1) pass({value});  // the maxima
      pass({value});
      break;
    case ActiveMethod::seed_set:
      pass({sizeof(TileNumber)});
      break;
  }
  reader.finish();
  return head;
}

#define TEGL_INSTANTIATE(N)      \
  template class ActiveTiles<N>; \
  template void TileRowSet::add_rows_of<N>(const TileGrid<N>&, const std::vector<TileNumber>&) noexcept;
TEGL_INSTANTIATE(2)
TEGL_INSTANTIATE(3)
TEGL_INSTANTIATE(4)
TEGL_INSTANTIATE(5)
#undef TEGL_INSTANTIATE

}  // namespace tegl
