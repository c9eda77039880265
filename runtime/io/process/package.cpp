// SPDX-License-Identifier: BSD-3-Clause
//
// Implements packing of numbers, texts and small arrays as bytes.
#include "process/package.hpp"

#include <sys/mman.h>

namespace tegl::io_detail {

namespace {

constexpr std::size_t kAlignment = 8;  ///< of arrays within the bytes

std::size_t padding(std::size_t position) { return (kAlignment - position % kAlignment) % kAlignment; }

}  // namespace

Mapping& Mapping::operator=(Mapping&& other) noexcept {
  std::swap(begin_, other.begin_);
  std::swap(bytes_, other.bytes_);
  return *this;
}

Mapping::~Mapping() {
  if (begin_ != nullptr) munmap(begin_, bytes_);
}

void Packer::text(std::string_view value) {
  number(static_cast<std::uint64_t>(value.size()));
  append(value.data(), value.size());
}

void Packer::append(const void* data, std::size_t bytes) {
  if (bytes == 0) return;
  const auto* const first = static_cast<const unsigned char*>(data);
  bytes_.insert(bytes_.end(), first, first + bytes);
}

void Packer::align() { bytes_.resize(bytes_.size() + padding(bytes_.size())); }

std::span<const unsigned char> Unpacker::take(std::size_t bytes) {
  if (bytes > left_.size()) throw BadPackage();
  const auto taken = left_.first(bytes);
  left_ = left_.subspan(bytes);
  return taken;
}

std::size_t Unpacker::count(std::size_t most) {
  const auto value = number<std::uint64_t>();
  if (value > most) throw BadPackage();
  return static_cast<std::size_t>(value);
}

std::string Unpacker::text() {
  const auto bytes = take(count(left_.size()));
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Unpacker::Array Unpacker::head(std::size_t item) {
  constexpr std::size_t kMost = std::size_t{1} << 60;
  Array array{};
  array.large = number<std::uint8_t>() != 0;
  array.size = count(kMost / item);
  array.capacity = count(kMost / item);
  if (array.size > array.capacity || (array.large && array.capacity * item < detail::kLargeValues)) throw BadPackage();
  take(padding(package_.bytes().size() - left_.size()));
  return array;
}

Mapping& Unpacker::next_block() {
  if (blocks_used_ >= package_.blocks.size()) throw BadPackage();
  return package_.blocks[blocks_used_++];
}

void Unpacker::require_end() const {
  if (!left_.empty() || blocks_used_ != package_.blocks.size()) throw BadPackage();
}

}  // namespace tegl::io_detail
