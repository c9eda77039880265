// SPDX-License-Identifier: BSD-3-Clause
//
// File format of indexes of active tiles: a head that identifies the image and the method, values and arrays, and a
// checksum. Numbers are in the byte order of the machine, which the head records.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "tegl/active_tiles.hpp"

namespace tegl::detail {

/// A 64-bit hash, continued from `seed`. It detects any change within 8 bytes. It is not cryptographic.
std::uint64_t hash_bytes(const void* data, std::size_t bytes, std::uint64_t seed) noexcept;

/// Arrays are written and read in pieces of this many elements, each hashed from the hash before. So a truncated file
/// does not make the reader allocate all that its counts claim.
inline constexpr std::size_t kPieceElements = std::size_t{1} << 22;

/// Writes an index, piece by piece.
class IndexWriter {
 public:
  explicit IndexWriter(ByteSink& to) : to_(to) {}

  template <class V>
  void value(const V& value) {
    static_assert(std::is_trivially_copyable_v<V> && std::has_unique_object_representations_v<V>);
    bytes(&value, sizeof(V));
  }
  /// Writes the number of elements, then the elements.
  template <class V>
  void array(const std::vector<V>& values) {
    static_assert(std::is_arithmetic_v<V>);
    value<std::uint64_t>(values.size());
    for (std::size_t first = 0; first < values.size(); first += kPieceElements)
      bytes(values.data() + first, std::min(values.size() - first, kPieceElements) * sizeof(V));
  }
  void text(std::string_view text);
  /// Writes the checksum. Call it last.
  void finish();

 private:
  void bytes(const void* data, std::size_t bytes);

  ByteSink& to_;
  std::uint64_t sum_ = 0;
};

/// Reads the output of IndexWriter in the same order. Throws MalformedFile if the data do not fit.
class IndexReader {
 public:
  explicit IndexReader(ByteSource& from) : from_(from) {}

  template <class V>
  V value(const char* what) {
    static_assert(std::is_trivially_copyable_v<V> && std::has_unique_object_representations_v<V>);
    V value;
    bytes(&value, sizeof(V), what);
    return value;
  }
  /// At most `most` elements. `what` names them in messages.
  template <class V>
  std::vector<V> array(std::uint64_t most, const char* what) {
    static_assert(std::is_arithmetic_v<V>);
    const auto count = value<std::uint64_t>(what);
    if (count > most) too_many(what, count, most);
    std::vector<V> values;
    while (values.size() < count) {
      const std::size_t first = values.size();
      values.resize(first + std::min<std::uint64_t>(count - first, kPieceElements));
      bytes(values.data() + first, (values.size() - first) * sizeof(V), what);
    }
    return values;
  }
  /// Reads and discards an array with elements of `element_bytes` bytes. Returns the number of elements.
  std::uint64_t pass_array(std::size_t element_bytes, const char* what);
  std::string text(std::size_t most, const char* what);
  /// Checks the checksum, and that no bytes follow it.
  void finish();

  /// Throws MalformedFile: "the index is damaged: `what`".
  [[noreturn]] static void damaged(const std::string& what);

 private:
  void bytes(void* data, std::size_t bytes, const char* what);
  [[noreturn]] static void too_many(const char* what, std::uint64_t count, std::uint64_t most);

  ByteSource& from_;
  std::uint64_t sum_ = 0;
};

/// Throws MalformedFile unless `offsets` ascend from 0 to `end`.
void require_offsets(const std::vector<std::uint64_t>& offsets, std::uint64_t end, const char* what);

}  // namespace tegl::detail
