// SPDX-License-Identifier: BSD-3-Clause
//
// Converts keys and contours between the numbering of the lattice, which extractions use, and the numbering of the
// builder of 5-cubes.
#include "tile/five_cube_tile.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "builder5.hpp"
#include "tile/five_cube_numbers.hpp"

namespace tegl::detail {

namespace {

using builders::FiveCube;
using builders::FiveCubeBuilder;
using builders::FiveKey;
using builders::ResolvedCubes;
using builders::ResolvedTesseract;
using Id = FiveCubeBuilder::Id;
using tile::Choice;

constexpr unsigned kTile = FiveCubeBuilder::kTile;
constexpr CubeFaces kCube(5);
constexpr const FiveCubeNumbers& kNumbers = kFiveCubeNumbers;

class FiveCubeMaker final : public TileMaker {
 public:
  explicit FiveCubeMaker(const TileKind& kind) : kind_(kind) {}

  BuiltTile make(const TileKey& key) override {
    FiveKey of = key_of(key);
    const bool is_high = kind_.alternative == tile::Alternative::high;
    if (is_high) of.signature = ~of.signature;  // the contour of the complement, reversed
    return too_large_as_error([&] { return converted(of, builder_.build(of), is_high); });
  }
  [[nodiscard]] std::size_t kept_bytes() const override { return 0; }

 private:
  [[nodiscard]] FiveKey key_of(const TileKey& key) const {
    FiveKey result;
    result.signature = static_cast<std::uint32_t>(key.signature);
    if (!key.has_choices()) return result;
    const auto choice = [&](std::size_t face) { return key.choice(face - kCube.first_choice()); };
    for (unsigned q = 0; q < 80; ++q)
      if (choice(kNumbers.squares[q]) == Choice::high) result.high_squares[q / 64] |= std::uint64_t{1} << (q % 64);
    for (unsigned c = 0; c < 40; ++c) {
      const Choice of = choice(kNumbers.cubes[c]);
      if (of == Choice::low) result.low_cubes |= std::uint64_t{1} << c;
      if (of == Choice::high) result.high_cubes |= std::uint64_t{1} << c;
    }
    for (unsigned f = 0; f < 10; ++f) {
      const Choice of = choice(kNumbers.tesseracts[f]);
      if (of == Choice::low) result.low_tesseracts = static_cast<std::uint16_t>(result.low_tesseracts | 1u << f);
      if (of == Choice::high) result.high_tesseracts = static_cast<std::uint16_t>(result.high_tesseracts | 1u << f);
    }
    result.tile = choice(kCube.tile());
    return result;
  }

  /// Appends a vertex; without a face among `faces`, only positions depend on it.
  static std::uint16_t add(BuiltTile& tile, tile::VertexKind kind, std::size_t face, bool is_of_contour) {
    const auto number = static_cast<std::uint16_t>(tile.vertices.size());
    const auto at = static_cast<std::uint16_t>(face);
    tile.vertices.push_back({kind, at, BuiltTile::kNone, 0, 0});
    if (!is_of_contour) return number;
    if (tile.faces.empty() || tile.faces.back().face != at) tile.faces.push_back({at, number, 0, false});
    ++tile.faces.back().count;
    return number;
  }

  /// Lists the vertices inside of cubes, tesseracts and the 5-cube, by face.
  void find_inner(const FiveCubeBuilder::Contour& contour) {
    by_face_.clear();
    for (unsigned c = 0; c < 40; ++c)
      for (unsigned j = 0; j < builder_.cube_vertices(c); ++j)
        by_face_.emplace_back(kNumbers.cubes[c],
                              static_cast<Id>(FiveCubeBuilder::kFirstOfCubes + ResolvedCubes::kMostOwn * c + j));
    for (std::size_t i = 0; i < contour.own.size(); ++i) {
      const unsigned f = contour.own[i].face;
      by_face_.emplace_back(f == kTile ? static_cast<std::uint16_t>(kCube.tile()) : kNumbers.tesseracts[f],
                            static_cast<Id>(FiveCubeBuilder::kFirstOwn + i));
    }
    std::sort(by_face_.begin(), by_face_.end());
  }

  BuiltTile converted(const FiveKey& key, const FiveCubeBuilder::Contour& contour, bool is_reversed) {
    BuiltTile tile;
    tile.is_settled = contour.is_settled;
    number_.assign(FiveCubeBuilder::kFirstOwn + contour.own.size(), BuiltTile::kNone);
    corner_.fill(BuiltTile::kNone);
    // the contour's vertices by face, ascending: on edges, then inside of faces
    std::size_t critical = 0;
    for (const auto& ends : FiveCube::kEdges) critical += (key.signature >> ends[0] ^ key.signature >> ends[1]) & 1u;
    find_inner(contour);
    tile.vertices.reserve(critical + by_face_.size());
    tile.faces.reserve(critical + by_face_.size());
    for (const unsigned e : kNumbers.edge_order) {
      const auto& ends = FiveCube::kEdges[e];
      if (((key.signature >> ends[0] ^ key.signature >> ends[1]) & 1u) != 0)
        number_[e] = add(tile, tile::VertexKind::edge, kNumbers.edges[e], true);
    }
    for (const auto& [face, id] : by_face_) number_[id] = add(tile, tile::VertexKind::side, face, true);
    // their positions
    for (const auto& [face, id] : by_face_)
      id < FiveCubeBuilder::kFirstOwn ? place_in_cube(tile, id)
                                      : place_own(tile, id, contour.own[id - FiveCubeBuilder::kFirstOwn], key);
    tile.of.shrink_to_fit();
    // simplices
    tile.simplices.reserve(5 * contour.simplices.size());
    for (FiveCubeBuilder::Simplex s : contour.simplices) {
      if (is_reversed) std::swap(s[3], s[4]);
      for (const Id v : s) tile.simplices.push_back(number_[v]);
    }
    return tile;
  }

  std::uint16_t corner(BuiltTile& tile, unsigned v) {
    if (corner_[v] == BuiltTile::kNone) corner_[v] = add(tile, tile::VertexKind::corner, kCube.number(v, 0), false);
    return corner_[v];
  }

  void place_in_cube(BuiltTile& tile, Id id) {
    const unsigned cube = (id - FiveCubeBuilder::kFirstOfCubes) / ResolvedCubes::kMostOwn;
    const unsigned j = (id - FiveCubeBuilder::kFirstOfCubes) % ResolvedCubes::kMostOwn;
    const auto first = static_cast<std::uint32_t>(tile.of.size());
    for (std::uint32_t rest = builder_.cube_mask(cube, j); rest != 0; rest &= rest - 1) {
      const auto i = static_cast<unsigned>(std::countr_zero(rest));
      const FiveCube::Cube& of = FiveCube::kCubes[cube];
      tile.of.push_back(i < 8 ? corner(tile, of.corners[i]) : number_[of.edges[i - 8]]);
      tile.of.push_back(static_cast<std::uint16_t>(i));
    }
    BuiltTile::Vertex& vertex = tile.vertices[number_[id]];
    vertex.first = first, vertex.end = static_cast<std::uint32_t>(tile.of.size());
    vertex.is_even = false;
  }

  void place_own(BuiltTile& tile, Id id, const FiveCubeBuilder::Own& own, const FiveKey& key) {
    const auto first = static_cast<std::uint32_t>(tile.of.size());
    const FiveCubeNumbers::Frame& frame = kNumbers.frames[own.face];
    for (std::uint32_t rest = own.points.corners; rest != 0; rest &= rest - 1) {
      const auto v = static_cast<unsigned>(std::countr_zero(rest));
      tile.of.push_back(corner(tile, v));
      tile.of.push_back(static_cast<std::uint16_t>(frame.number_of_corner(v)));
    }
    for (unsigned word = 0; word < 2; ++word)
      for (std::uint64_t rest = own.points.edges[word]; rest != 0; rest &= rest - 1) {
        const unsigned e = 64 * word + static_cast<unsigned>(std::countr_zero(rest));
        tile.of.push_back(number_[e]);
        tile.of.push_back(static_cast<std::uint16_t>(frame.number_of_edge(e)));
      }
    BuiltTile::Vertex& vertex = tile.vertices[number_[id]];
    vertex.first = first, vertex.end = static_cast<std::uint32_t>(tile.of.size());
    vertex.repeats = own.repeat;
    vertex.is_even = is_even(own, key);
  }

  /// Barycentres of the 5-cube are plain means, which keeps the second order of smooth contours. In a tesseract, as in
  /// 4D images: if it is resolved from the data, the mean is uneven.
  [[nodiscard]] bool is_even(const FiveCubeBuilder::Own& own, const FiveKey& key) const {
    if (own.face == kTile) return own.points.corners == 0;
    return !kind_.is_estimated || ResolvedTesseract::is_settled(FiveCube::signatures(key.signature)[own.face]);
  }

  TileKind kind_;
  FiveCubeBuilder builder_;
  // The current tile.
  std::vector<std::uint16_t> number_;  ///< by the builder's vertex
  std::array<std::uint16_t, 32> corner_{};
  std::vector<std::pair<std::uint16_t, Id>> by_face_;
};

}  // namespace

std::unique_ptr<TileMaker> five_cube_maker(const TileKind& kind) { return std::make_unique<FiveCubeMaker>(kind); }

}  // namespace tegl::detail
