// SPDX-License-Identifier: BSD-3-Clause
//
// Reading and writing of indexes of active tiles; see index_file.hpp.
#include "search/index_file.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include <fmt/format.h>

namespace tegl::detail {

namespace {

constexpr std::uint64_t kOdd[2] = {0x9E3779B97F4A7C15u, 0xD6E8FEB86659FD93u};

/// A bijection of `word` for a fixed lane: different words give different lanes.
constexpr std::uint64_t mix(std::uint64_t lane, std::uint64_t word) noexcept {
  return std::rotl((lane ^ word) * kOdd[0], 29) * kOdd[1];
}

}  // namespace

std::uint64_t hash_bytes(const void* data, std::size_t bytes, std::uint64_t seed) noexcept {
  constexpr std::size_t kLanes = 4;  // independent lanes hide the latency of multiplications
  constexpr std::size_t kBlock = kLanes * sizeof(std::uint64_t);
  std::array<std::uint64_t, kLanes> lanes{seed, seed + 1, seed + 2, seed + 3};
  const auto* from = static_cast<const unsigned char*>(data);
  std::array<std::uint64_t, kLanes> words{};
  const auto take = [&] {
    for (std::size_t i = 0; i < kLanes; ++i) lanes[i] = mix(lanes[i], words[i]);
  };
  std::size_t left = bytes;
  for (; left >= kBlock; left -= kBlock, from += kBlock) {
    std::memcpy(words.data(), from, kBlock);
    take();
  }
  if (left > 0) {
    words.fill(0);
    std::memcpy(words.data(), from, left);
    take();
  }
  std::uint64_t hash = mix(seed, bytes);
  for (const std::uint64_t lane : lanes) hash = mix(hash, lane ^ lane >> 32);
  return hash ^ hash >> 31;
}

void IndexWriter::bytes(const void* data, std::size_t bytes) {
  if (bytes == 0) return;
  sum_ = hash_bytes(data, bytes, sum_);
  to_.write(data, bytes);
}

void IndexWriter::text(std::string_view text) {
  value<std::uint64_t>(text.size());
  bytes(text.data(), text.size());
}

void IndexWriter::finish() {
  const std::uint64_t sum = sum_;
  to_.write(&sum, sizeof(sum));
}

void IndexReader::bytes(void* data, std::size_t bytes, const char* what) {
  if (bytes == 0) return;
  const std::size_t count = from_.read(data, bytes);
  if (count != bytes)
    damaged(fmt::format("{} bytes for the {}; expected {}: the file is truncated", count, what, bytes));
  sum_ = hash_bytes(data, bytes, sum_);
}

std::uint64_t IndexReader::pass_array(std::size_t element_bytes, const char* what) {
  const auto count = value<std::uint64_t>(what);
  std::vector<char> piece;
  for (std::uint64_t passed = 0; passed < count; passed += kPieceElements) {
    piece.resize(std::min<std::uint64_t>(count - passed, kPieceElements) * element_bytes);
    bytes(piece.data(), piece.size(), what);
  }
  return count;
}

std::string IndexReader::text(std::size_t most, const char* what) {
  const auto count = value<std::uint64_t>(what);
  if (count > most) too_many(what, count, most);
  std::string text(count, ' ');
  bytes(text.data(), text.size(), what);
  return text;
}

void IndexReader::finish() {
  std::uint64_t sum = 0;
  if (from_.read(&sum, sizeof(sum)) != sizeof(sum)) damaged("no checksum at the end: the file is truncated");
  if (sum != sum_) damaged(fmt::format("its checksum is {:016x}; expected {:016x}", sum_, sum));
  char more = 0;
  if (from_.read(&more, 1) != 0) damaged("bytes after its end");
}

void IndexReader::damaged(const std::string& what) {
  throw Error(ErrorCode::MalformedFile, "the index is damaged: " + what);
}

void IndexReader::too_many(const char* what, std::uint64_t count, std::uint64_t most) {
  damaged(fmt::format("{} of {}; expected at most {}", count, what, most));
}

void require_offsets(const std::vector<std::uint64_t>& offsets, std::uint64_t end, const char* what) {
  if (offsets.empty() || offsets.front() != 0 || offsets.back() != end ||
      !std::is_sorted(offsets.begin(), offsets.end()))
    IndexReader::damaged(fmt::format("the positions of the {} do not ascend from 0 to {}", what, end));
}

}  // namespace tegl::detail
