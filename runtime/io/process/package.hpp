// SPDX-License-Identifier: BSD-3-Clause
//
// Transfers values between two processes: numbers, texts and arrays as bytes; large arrays in shared memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "../../src/base/block_source.hpp"
#include "base/value_array.hpp"
#include "tegl/contour.hpp"

namespace tegl::io_detail {

/// Mapped pages of a memory file; unmaps them on destruction.
class Mapping {
 public:
  Mapping() = default;
  Mapping(void* begin, std::size_t bytes) noexcept : begin_(begin), bytes_(bytes) {}
  Mapping(Mapping&& other) noexcept : begin_(other.take()), bytes_(other.bytes_) {}
  Mapping& operator=(Mapping&& other) noexcept;
  Mapping(const Mapping&) = delete;
  Mapping& operator=(const Mapping&) = delete;
  ~Mapping();
  [[nodiscard]] std::size_t bytes() const noexcept { return begin_ == nullptr ? 0 : bytes_; }
  [[nodiscard]] const unsigned char* data() const noexcept { return static_cast<const unsigned char*>(begin_); }
  /// Releases the pages to the caller.
  void* take() noexcept { return std::exchange(begin_, nullptr); }

 private:
  void* begin_ = nullptr;
  std::size_t bytes_ = 0;
};

/// Packs values to be sent. Arrays of 2 MiB and more are not copied and must live until they are sent.
class Packer {
 public:
  /// A block that holds one array, in whole pages.
  struct Block {
    const void* begin;
    std::size_t bytes;
    std::size_t used;  ///< bytes up to the end of the array
  };

  template <class T>
  requires std::is_trivially_copyable_v<T>
  void number(T value) { append(&value, sizeof(T)); }
  void text(std::string_view value);
  template <class T>
  void array(const ValueVector<T>& values) {
    array_at(values, values.capacity() * sizeof(T) >= detail::kLargeValues, detail::kValuesOffset,
             detail::block_of_values(values.capacity() * sizeof(T)));
  }
  template <class T>
  void array(const Buffer<T>& values) {
    array_at(values, values.capacity() * sizeof(T) >= detail::kLargeBlock, 0,
             detail::block_of_buffer(values.capacity() * sizeof(T)));
  }
  [[nodiscard]] std::span<const unsigned char> bytes() const noexcept { return bytes_; }
  [[nodiscard]] const std::vector<Block>& blocks() const noexcept { return blocks_; }

 private:
  template <class Vector>
  void array_at(const Vector& values, bool large, std::size_t offset, std::size_t block) {
    number(static_cast<std::uint8_t>(large));
    number(static_cast<std::uint64_t>(values.size()));
    number(static_cast<std::uint64_t>(values.capacity()));
    align();
    if (large)
      blocks_.push_back({reinterpret_cast<const unsigned char*>(values.data()) - offset, block,
                         offset + values.size() * sizeof(values[0])});
    else
      append(values.data(), values.size() * sizeof(values[0]));
  }
  void append(const void* data, std::size_t bytes);
  void align();

  std::vector<unsigned char> bytes_;
  std::vector<Block> blocks_;
};

/// A received package.
struct Package {
  std::vector<unsigned char> small;  ///< the bytes, unless they are in `large`
  Mapping large;
  std::vector<Mapping> blocks;
  [[nodiscard]] std::span<const unsigned char> bytes() const noexcept {
    return large.bytes() > 0 ? std::span(large.data(), large.bytes()) : std::span(small);
  }
};

/// Thrown by Unpacker if a package is invalid.
struct BadPackage {};

/// Reads a package of an untrusted process: each size is checked against the available bytes.
class Unpacker {
 public:
  explicit Unpacker(Package& package) : package_(package), left_(package.bytes()) {}

  template <class T>
  requires std::is_trivially_copyable_v<T> T number() {
    T value;
    const auto bytes = take(sizeof(T));
    std::memcpy(static_cast<void*>(&value), bytes.data(), sizeof(T));
    return value;
  }
  /// An integer, at most `most`.
  std::size_t count(std::size_t most);
  std::string text();
  /// Takes over the memory of a large array.
  template <class T>
  void array(ValueVector<T>& to) {
    array_in(to, [](std::size_t bytes) { return detail::block_of_values(bytes); });
  }
  template <class T>
  void array(Buffer<T>& to) {
    array_in(to, [](std::size_t bytes) { return detail::block_of_buffer(bytes); });
  }
  /// A view of the samples; valid while the package lives, or while `block` lives if they are in it.
  template <class T>
  std::span<const T> view(const Mapping& block) {
    const Array array = head(sizeof(T));
    const unsigned char* at = nullptr;
    if (!array.large) {
      at = take(array.size * sizeof(T)).data();
    } else {
      if (block.bytes() < detail::kValuesOffset + array.size * sizeof(T)) throw BadPackage();
      at = block.data() + detail::kValuesOffset;
    }
    return {reinterpret_cast<const T*>(at), array.size};
  }
  /// Throws unless everything has been read.
  void require_end() const;

 private:
  struct Array {
    bool large;
    std::size_t size, capacity;
  };

  template <class Vector, class BlockSize>
  void array_in(Vector& to, const BlockSize& block_size) {
    using T = typename Vector::value_type;
    const Array array = head(sizeof(T));
    to = Vector();
    if (array.large) {
      adopt(next_block(), block_size(array.capacity * sizeof(T)), [&] { to.reserve(array.capacity); });
      to.resize(array.size);
    } else {
      const auto bytes = take(array.size * sizeof(T));
      to.resize(array.size);
      std::memcpy(to.data(), bytes.data(), bytes.size());
    }
  }
  /// Makes `reserve` allocate this block.
  template <class Reserve>
  static void adopt(Mapping& block, std::size_t bytes, const Reserve& reserve) {
    AdoptedBlock source(block);
    if (bytes != block.bytes()) throw BadPackage();
    detail::BlockSource* const before = detail::exchange_block_source(&source);
    try {
      reserve();
    } catch (...) {
      detail::exchange_block_source(before);
      throw;
    }
    detail::exchange_block_source(before);
    if (block.bytes() != 0) throw BadPackage();
  }
  class AdoptedBlock final : public detail::BlockSource {
   public:
    explicit AdoptedBlock(Mapping& block) : block_(block) {}
    void* allocate(std::size_t bytes) noexcept override { return bytes == block_.bytes() ? block_.take() : nullptr; }
    bool release(void*, std::size_t) noexcept override { return false; }

   private:
    Mapping& block_;
  };

  std::span<const unsigned char> take(std::size_t bytes);
  Array head(std::size_t item);
  Mapping& next_block();

  Package& package_;
  std::span<const unsigned char> left_;
  std::size_t blocks_used_ = 0;
};

}  // namespace tegl::io_detail
