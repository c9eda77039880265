// SPDX-License-Identifier: BSD-3-Clause
//
// The head of an index's file, and whether it is that of an image.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "index_file.hpp"
#include "tegl/active_tiles.hpp"

namespace tegl::detail {

inline constexpr std::array<char, 8> kIndexMagic = {'T', 'E', 'G', 'L', 'I', 'D', 'X', '\n'};
inline constexpr std::uint32_t kIndexByteOrder = 0x01020304;
/// To be raised with any change of what is behind it.
inline constexpr std::uint32_t kIndexVersion = 1;

void write_magic(IndexWriter& to, ActiveMethod method, int dim);

template <int N>
void write_head(IndexWriter& to, ActiveMethod method, const IndexedImage<N>& image) {
  write_magic(to, method, N);
  for (const std::size_t size : image.sizes) to.value(std::uint64_t{size});
  to.text(image.value_type);
  to.value(image.digest);
  to.value(static_cast<std::uint8_t>(image.any_missing ? 1 : 0));
}

/// Throws MalformedFile, UnsupportedFormat.
ActiveTilesHead read_head(IndexReader& from);

/// Throws InvalidArgument, saying what differs.
void require_same_image(const ActiveTilesHead& head, std::span<const std::size_t> sizes, std::string_view value_type,
                        std::uint64_t digest);

}  // namespace tegl::detail
