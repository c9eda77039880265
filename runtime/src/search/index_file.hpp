// SPDX-License-Identifier: BSD-3-Clause
//
// Indexes of active tiles as bytes: a head that says what they belong to, values and arrays, and a checksum. Numbers
// are in the machine's byte order, which the head tells.
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

/// A hash of 64 bits that goes on from `seed`. Any change within 8 bytes changes it; it is no protection against
/// intent.
std::uint64_t hash_bytes(const void* data, std::size_t bytes, std::uint64_t seed) noexcept;

/// The name of a value type, as in IndexedImage.
template <Value T>
std::string_view value_type_name() noexcept;

/// Arrays go in pieces, each hashed from the hash before: a file that is cut short does not make room for all that it
/// promises.
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
  /// How many there are, then the elements.
  template <class V>
  void array(const std::vector<V>& values) {
    static_assert(std::is_arithmetic_v<V>);
    value<std::uint64_t>(values.size());
    for (std::size_t first = 0; first < values.size(); first += kPieceElements)
      bytes(values.data() + first, std::min(values.size() - first, kPieceElements) * sizeof(V));
  }
  void text(std::string_view text);
  /// The checksum; last.
  void finish();

 private:
  void bytes(const void* data, std::size_t bytes);

  ByteSink& to_;
  std::uint64_t sum_ = 0;
};

/// Reads what IndexWriter wrote, in the same order. Throws MalformedFile where it cannot be.
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
  /// At most so many elements. `what` names them in messages.
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
  /// Reads an array whose elements have so many bytes, and keeps none. How many there were.
  std::uint64_t pass_array(std::size_t element_bytes, const char* what);
  std::string text(std::size_t most, const char* what);
  /// Compares the checksum, and that nothing comes behind it.
  void finish();

  /// Throws MalformedFile: "damaged index: `what` ...".
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
