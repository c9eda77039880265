// SPDX-License-Identifier: BSD-3-Clause
//
// Reads binary and text STL. STL repeats a vertex for every triangle; vertices with equal coordinates, bit by bit, are
// merged. Normals and attribute bytes are skipped.
//
// Based on: 3D Systems, "StereoLithography Interface Specification", 1989.
#include "meshes/stl_reader.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <unordered_map>
#include <vector>

#include "base/common.hpp"
#include "base/mesh_data.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

using Bits = std::array<std::uint32_t, 3>;

struct BitsHash {
  std::size_t operator()(const Bits& bits) const noexcept {
    std::uint64_t hash = 0;
    for (const std::uint32_t part : bits) hash = (hash ^ part) * 0x9E3779B97F4A7C15U ^ hash >> 29;
    return static_cast<std::size_t>(hash);
  }
};

using Point = std::array<float, 3>;

constexpr std::size_t kHeaderBytes = 84;  // 80 arbitrary bytes, and the number of triangles
constexpr std::size_t kTriangleBytes = 50;

class StlReader {
 public:
  StlReader(const fs::path& path, ReadProgress& progress)
      : path_(path), progress_(progress), bytes_(read_bytes(path, 0, static_cast<std::size_t>(size_of_file(path)))) {}

  Mesh run() {
    mesh_.dim = 2;
    mesh_.space_dim = 3;
    // Headers of binary files may also begin with "solid".
    const std::string_view text(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
    const std::string_view start = text.substr(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
    if (lower(start.substr(0, 5)) == "solid" && !has_exact_size())
      read_text(text);
    else
      read_binary();
    if (mesh_.simplices.empty()) fail(ErrorCode::UnsupportedData, path_, "no triangles; expected a surface");
    mesh_.axis_names.resize(3);
    mesh_.axis_units.resize(3);
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] std::uint32_t word_at(std::size_t offset) const {
    std::uint32_t word = 0;
    for (std::size_t i = 4; i-- > 0;) word = word << 8 | bytes_[offset + i];
    return word;
  }

  [[nodiscard]] bool has_exact_size() const {
    return bytes_.size() >= kHeaderBytes &&
           bytes_.size() - kHeaderBytes == kTriangleBytes * std::uint64_t{word_at(kHeaderBytes - 4)};
  }

  void read_binary() {
    if (bytes_.size() < kHeaderBytes)
      fail(ErrorCode::MalformedFile, path_, "{} bytes that do not begin with 'solid'; expected {} or more of STL",
           bytes_.size(), kHeaderBytes);
    const std::size_t triangles = word_at(kHeaderBytes - 4);
    const std::size_t most = (bytes_.size() - kHeaderBytes) / kTriangleBytes;
    if (triangles > most)
      fail(ErrorCode::MalformedFile, path_, "{} triangles in {} bytes; expected at most {}", triangles, bytes_.size(),
           most);
    mesh_.simplices.reserve(3 * triangles);
    for (std::size_t t = 0; t < triangles; ++t) {
      constexpr std::size_t kNormalBytes = 12;
      const std::size_t corners = kHeaderBytes + t * kTriangleBytes + kNormalBytes;
      for (std::size_t corner = 0; corner < 3; ++corner) {
        Point point;
        for (std::size_t a = 0; a < 3; ++a) point[a] = std::bit_cast<float>(word_at(corners + 12 * corner + 4 * a));
        add_corner(point);
      }
      progress_.add_rows(t, kTriangleBytes);
    }
  }

  /// Removes and returns the next word; empty at the end.
  static std::string_view next_word(std::string_view& text) {
    constexpr std::string_view kBlanks = " \t\r\n\v\f";
    text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
    const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
    text.remove_prefix(word.size());
    return word;
  }

  /// Parses "facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet", in any case.
  void read_text(std::string_view text) {
    std::size_t corners = 0;
    for (std::string_view word = next_word(text); !word.empty(); word = next_word(text)) {
      const std::string key = lower(word.substr(0, 16));
      if (key == "solid" || key == "endsolid") {
        text.remove_prefix(std::min(text.find('\n'), text.size()));  // name of the solid
      } else if (key == "facet") {
        require_closed(corners);
      } else if (key == "normal") {
        for (int i = 0; i < 3; ++i) next_word(text);
      } else if (key == "vertex") {
        add_corner(read_point(text));
        if (++corners > 3) require_corners(corners, 3);
      } else if (key == "endfacet") {
        require_corners(corners, 3);
        corners = 0;
        progress_.add(kTextBytes);
      } else if (key != "outer" && key != "loop" && key != "endloop") {
        fail(ErrorCode::MalformedFile, path_, "{} after facet {}; expected a keyword of STL, such as 'vertex'",
             shown(word), mesh_.simplices.size() / 3);
      }
    }
    require_closed(corners);
  }

  void require_corners(std::size_t corners, std::size_t expected) const {
    if (corners != expected)
      fail(ErrorCode::MalformedFile, path_, "facet {} of {} vertices; expected 3",
           (mesh_.simplices.size() - corners) / 3, corners);
  }

  /// Throws if a facet has begun; `corners`: its number of corners so far.
  void require_closed(std::size_t corners) const {
    if (corners > 0)
      fail(ErrorCode::MalformedFile, path_, "facet {} without 'endfacet'; expected it after 3 vertices",
           (mesh_.simplices.size() - corners) / 3);
  }

  Point read_point(std::string_view& text) const {
    Point point;
    for (float& coordinate : point) {
      const std::string_view word = next_word(text);
      double value = 0;
      if (!parse_number(word, value) ||
          (std::isfinite(value) && std::abs(value) > double{std::numeric_limits<float>::max()}))
        fail(ErrorCode::MalformedFile, path_, "{} in facet {}; expected a coordinate in the range of float",
             shown(word), mesh_.simplices.size() / 3);
      coordinate = static_cast<float>(value);
    }
    return point;
  }

  /// Adds a corner; vertices are numbered in order of first occurrence.
  void add_corner(const Point& point) {
    Bits bits;
    for (std::size_t a = 0; a < 3; ++a) bits[a] = std::bit_cast<std::uint32_t>(point[a] + 0.0F);  // -0 becomes 0
    const auto [found, is_new] = numbers_.emplace(bits, static_cast<Index>(numbers_.size()));
    if (is_new) {
      if (numbers_.size() > std::numeric_limits<Index>::max())
        fail(ErrorCode::TooLarge, path_, "{} vertices; expected less than 2^32", numbers_.size());
      for (const float value : point) mesh_.coordinates.push_back(double{value});
    }
    mesh_.simplices.push_back(found->second);
  }

  static constexpr std::size_t kTextBytes = 160;  ///< approximate size of a facet
  const fs::path& path_;
  ReadProgress& progress_;
  std::vector<unsigned char> bytes_;
  std::unordered_map<Bits, Index, BitsHash> numbers_;
  Mesh mesh_;
};

}  // namespace

Mesh read_stl(const fs::path& path, ReadProgress& progress) { return StlReader(path, progress).run(); }

}  // namespace tegl::io_detail
