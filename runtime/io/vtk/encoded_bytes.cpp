// SPDX-License-Identifier: BSD-3-Clause
//
// Reads bytes of a file, also in base64 (RFC 4648).
#include "vtk/encoded_bytes.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>

#include "base/common.hpp"

namespace tegl::io_detail {

namespace {

constexpr std::size_t kByteBlock = std::size_t{1} << 16;

/// The value of a base64 digit, or -1.
int base64_digit(int c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

}  // namespace

EncodedBytes::EncodedBytes(const std::filesystem::path& path, std::uint64_t begin, std::uint64_t end, bool base64)
    : path_(path), file_(path, std::ios::binary), left_(end - std::min(begin, end)), base64_(base64) {
  file_.seekg(static_cast<std::streamoff>(begin));
  if (!file_) fail(ErrorCode::FileNotFound, path, "cannot be opened ({})", std::strerror(errno));
}

std::uint64_t EncodedBytes::at_most() const {
  const std::uint64_t stored = left_ + (block_.size() - at_);
  return base64_ ? stored / 4 * 3 + 3 : stored;
}

int EncodedBytes::next_character() {
  if (at_ == block_.size()) {
    block_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kByteBlock, left_)));
    at_ = 0;
    file_.read(reinterpret_cast<char*>(block_.data()), static_cast<std::streamsize>(block_.size()));
    block_.resize(static_cast<std::size_t>(file_.gcount()));
    left_ = block_.empty() ? 0 : left_ - block_.size();
    if (block_.empty()) return -1;
  }
  return block_[at_++];
}

bool EncodedBytes::next_group() {
  std::uint32_t bits = 0;
  int digits = 0, padding = 0;
  while (digits + padding < 4) {
    const int c = next_character();
    if (c == ' ' || (c >= '\t' && c <= '\r')) continue;
    if (c < 0 || c == '<') {
      if (c == '<') left_ = at_ = 0, block_.clear();
      if (digits == 0) return false;
      fail(ErrorCode::MalformedFile, path_, "base64 data ends within a group of four characters");
    }
    const int digit = base64_digit(c);
    if (c == '=' && digits >= 2) {
      ++padding;
    } else if (digit >= 0 && padding == 0) {
      bits = bits << 6U | static_cast<std::uint32_t>(digit);
      ++digits;
    } else {
      const char found = static_cast<char>(c);
      fail(ErrorCode::MalformedFile, path_, "{} in base64 data; expected letters, digits, '+', '/' and '='",
           shown(std::string_view(&found, 1)));
    }
  }
  bits <<= static_cast<unsigned>(6 * padding);
  group_ = {static_cast<unsigned char>(bits >> 16U), static_cast<unsigned char>(bits >> 8U),
            static_cast<unsigned char>(bits)};
  group_size_ = 3 - padding;
  group_at_ = 0;
  return true;
}

std::size_t EncodedBytes::read(std::span<unsigned char> to) {
  std::size_t done = 0;
  while (done < to.size()) {
    if (base64_) {
      if (group_at_ == group_size_ && !next_group()) break;
      to[done++] = group_[static_cast<std::size_t>(group_at_++)];
      continue;
    }
    if (at_ == block_.size()) {
      if (next_character() < 0) break;
      --at_;
    }
    const std::size_t count = std::min(to.size() - done, block_.size() - at_);
    std::memcpy(to.data() + done, block_.data() + at_, count);
    at_ += count;
    done += count;
  }
  return done;
}

}  // namespace tegl::io_detail
