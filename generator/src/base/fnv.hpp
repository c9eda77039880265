// SPDX-License-Identifier: BSD-3-Clause
//
// Digests of tables: the hash function FNV-1a of 64 bits.
// Based on: G. Fowler, L. C. Noll, K.-P. Vo, D. Eastlake, The FNV non-cryptographic hash algorithm (Internet draft).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tegl::gen {

class Fnv {
 public:
  /// Adds the bytes of an integer, lowest first.
  template <class T>
  void add(T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      hash_ ^= static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i));
      hash_ *= 0x100000001b3u;
    }
  }
  /// Adds the number of values, and the values.
  template <class T>
  void add(const std::vector<T>& values) {
    add(static_cast<std::uint64_t>(values.size()));
    for (const T v : values) add(v);
  }
  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

}  // namespace tegl::gen
