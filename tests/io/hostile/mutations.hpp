// SPDX-License-Identifier: BSD-3-Clause
//
// Mutations of files for the fuzz tests: bits and bytes, binary and text numbers at the limits of a type, keywords of
// the formats, repeated, removed or foreign blocks, deep nesting, and truncation.
#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <random>
#include <span>
#include <string>
#include <string_view>

namespace tegl::test {

/// Mutates the bytes of a file. Deterministic for a seed.
class Mutator {
 public:
  /// `others`: valid files of the same format, as a source of blocks.
  Mutator(std::uint64_t seed, std::span<const std::string* const> others) : random_(seed), others_(others) {}

  std::string mutated(std::string bytes) {
    for (std::size_t i = 1 + below(below(4) == 0 ? 12 : 3); i > 0 && !bytes.empty(); --i) step(bytes);
    return bytes;
  }

 private:
  static constexpr std::size_t kHeader = 600;  ///< most headers end within this many bytes

  std::size_t below(std::size_t n) { return static_cast<std::size_t>(random_() % std::max<std::size_t>(1, n)); }
  /// A position in the file; two of three are in the first bytes.
  std::size_t place(const std::string& bytes) {
    return below(below(3) != 0 ? std::min(bytes.size(), kHeader) : bytes.size());
  }

  void step(std::string& bytes) {
    const std::size_t at = place(bytes);
    switch (below(12)) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ 1 << below(8));
        return;
      case 1:
        bytes[at] = static_cast<char>(random_());
        return;
      case 2:
        bytes[at] = "\x00\xff\x7f\x80\n\"[{"[below(8)];
        return;
      case 3:
        bytes.insert(at, 1 + below(4), "9\xff\0\n -"[below(6)]);
        return;
      case 4:
        overwrite_binary_number(bytes, at);
        return;
      case 5:
      case 6:
        replace_text_number(bytes, at);
        return;
      case 7:
        bytes.erase(at, 1 + below(below(2) == 0 ? 4 : 64));
        return;
      case 8: {  // repeats a block once or often
        const std::string block = bytes.substr(at, 1 + below(64));
        std::string repeated;
        for (std::size_t n = below(4) == 0 ? 1 + below(2000) : 1; n > 0; --n) repeated += block;
        bytes.insert(at, repeated);
        return;
      }
      case 9:
        insert_block_of_other(bytes, at);
        return;
      case 10:
        insert_text(bytes, at);
        return;
      default:
        if (below(4) == 0) bytes.resize(below(bytes.size()));
        return;
    }
  }

  /// Overwrites a number of 1, 2, 4 or 8 bytes by one at the limit of its range, or near the existing one.
  void overwrite_binary_number(std::string& bytes, std::size_t at) {
    const std::size_t size = std::size_t(1) << below(4);
    at -= at % size;
    if (at + size > bytes.size()) return;
    static constexpr std::array<std::uint64_t, 14> kEdges = {
        0,          1,          0x7f,       0xff,        0x7fff,     0xffff,     0x10000,
        0x7fffffff, 0x80000000, 0xffffffff, 0x100000000, 1ull << 62, 1ull << 63, ~std::uint64_t(0)};
    std::uint64_t number = kEdges[below(kEdges.size())];
    if (below(3) == 0) {
      number = 0;
      std::memcpy(&number, bytes.data() + at, size);
      number += below(2) == 0 ? 1 + below(16) : ~std::uint64_t(below(16));
    }
    std::array<char, 8> stored{};
    std::memcpy(stored.data(), &number, 8);
    if (below(2) == 0) std::reverse(stored.begin(), stored.begin() + static_cast<std::ptrdiff_t>(size));
    std::memcpy(bytes.data() + at, stored.data(), size);
  }

  /// Replaces the next text number after `at`, if any, by one at the limit of a type.
  void replace_text_number(std::string& bytes, std::size_t at) {
    static constexpr std::array<std::string_view, 20> kNumbers = {
        "0",          "-1",         "1",   "3",     "255",   "256",  "32768", "65536", "2147483647",
        "2147483648", "4294967295", "1e9", "1e308", "1e309", "-0.0", "nan",   "inf",   "18446744073709551616",
        "0x10",       "1000000"};
    while (at < bytes.size() && std::isdigit(static_cast<unsigned char>(bytes[at])) == 0) ++at;
    std::size_t end = at;
    while (end < bytes.size() && std::isdigit(static_cast<unsigned char>(bytes[end])) != 0) ++end;
    if (end == at) return;
    bytes.replace(at, end - at, kNumbers[below(kNumbers.size())]);
  }

  void insert_block_of_other(std::string& bytes, std::size_t at) {
    if (others_.empty()) return;
    const std::string& other = *others_[below(others_.size())];
    if (other.empty()) return;
    const std::string block = other.substr(place(other), 1 + below(below(2) == 0 ? 32 : 512));
    if (below(2) == 0)
      bytes.insert(at, block);
    else
      bytes.replace(at, block.size(), block);
  }

  /// Inserts brackets, quotes, long words, or lines of the text formats.
  void insert_text(std::string& bytes, std::size_t at) {
    static constexpr std::array<std::string_view, 16> kWords = {"[",
                                                                "{\"a\":",
                                                                "\"",
                                                                "\\",
                                                                "../",
                                                                "/etc/passwd",
                                                                "%s%n",
                                                                "\x1b[2J",
                                                                "\n\n",
                                                                "ElementDataFile = LIST\n",
                                                                "data file: LIST\n",
                                                                "property uchar a\n",
                                                                "element vertex 1\n",
                                                                "labels: \"a\" \"b\"\n",
                                                                "f 1 2 3\n",
                                                                "list"};
    const std::string_view word = kWords[below(kWords.size())];
    static constexpr std::array<std::size_t, 6> kTimes = {1, 1, 1, 2, 300, 5000};
    std::string text;
    for (std::size_t n = kTimes[below(kTimes.size())]; n > 0; --n) text += word;
    bytes.insert(at, text);
  }

  std::mt19937_64 random_;
  std::span<const std::string* const> others_;
};

}  // namespace tegl::test
