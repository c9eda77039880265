// SPDX-License-Identifier: BSD-3-Clause
//
// Tiles built at run time, in the form that an extraction reads: the vertices of a tile's contour by face, the
// dependencies of their positions, and the simplices.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "tegl/error.hpp"
#include "tegl/tile/cube_faces.hpp"
#include "tegl/tile/facets.hpp"
#include "tegl/tile/triangulation.hpp"

namespace tegl::detail {

/// Returns build(). Builders throw std::length_error for tiles with too many vertices; this becomes Error{TooLarge}.
template <class Build>
decltype(auto) too_large_as_error(const Build& build) {
  try {
    return build();
  } catch (const std::length_error& error) {
    throw Error(ErrorCode::TooLarge, error.what());
  }
}

/// The contour of a tile, with its own vertex numbers. The contour's vertices come first: by face, and within a face by
/// the number that all tiles at the face agree on. Vertices follow that only positions depend on.
struct BuiltTile {
  struct Vertex {
    tile::VertexKind kind;
    std::uint16_t face;                          ///< number in the lattice
    std::uint16_t copied;                        ///< side: the vertex that it copies; kNone: a mean
    std::uint32_t first, end;                    ///< barycentre, centre, mean: its range in `of`
    std::uint32_t first_edge = 0, end_edge = 0;  ///< barycentre with others in its face: its range in `edges`
    std::uint8_t repeats = 0;                    ///< mean: earlier vertices of the face with the same points
    bool is_even = true;                         ///< mean: all points have the same weight
  };
  /// A face that has the vertices [first, first + count) of the contour.
  struct FaceVertices {
    std::uint16_t face, first, count;
    bool by_edges;  ///< only barycentres, and several: numbered by the lowest edge connected to each
  };
  /// Flag of the first vertex of a simplex below a barycentre: that vertex is the barycentre of the facet to which the
  /// simplex belongs.
  static constexpr std::uint16_t kIsMiddle = 0x8000;

  static constexpr std::uint16_t kNone = 0xffff;

  std::vector<FaceVertices> faces;  ///< in lattice order
  std::vector<Vertex> vertices;
  /// Barycentre: simplices of dim - 1 vertices; centre: vertices; mean: corners, then vertices on edges, each followed
  /// by its number in the face's own frame, in which edges are counted after the corners.
  std::vector<std::uint16_t> of;
  std::vector<std::uint16_t> edges;      ///< vertices on edges below a barycentre
  std::vector<std::uint16_t> simplices;  ///< n vertices each; the positive side faces high corners
  bool has_sides = false;                ///< has side fillings, so it depends on the order of the axes
  bool is_settled = true;                ///< its boundary's contour is one sphere: its own choice does not matter

  BuiltTile() = default;
  /// Throws Error{TooLarge} for a tile with more than 32768 vertices.
  BuiltTile(const CubeFaces& cube, const tile::TileFacets& tile);
  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  void list_edges(std::size_t barycentre);
};

/// Determines the contour in a tile: its high corners and the choices for its faces.
struct TileKey {
  std::uint64_t signature = 0;
  /// Two bits (tile::Choice) for each face of dimension 2 or more, in lattice order.
  std::array<std::uint64_t, 5> choices{};

  friend bool operator==(const TileKey&, const TileKey&) = default;
  friend auto operator<=>(const TileKey&, const TileKey&) = default;
  [[nodiscard]] bool has_choices() const noexcept { return choices != decltype(choices){}; }
  [[nodiscard]] tile::Choice choice(std::size_t number) const noexcept {
    return static_cast<tile::Choice>(choices[number / 32] >> (2 * (number % 32)) & 3u);
  }
  void choose(std::size_t number, tile::Choice choice) noexcept {
    choices[number / 32] |= static_cast<std::uint64_t>(choice) << (2 * (number % 32));
  }
};

struct TileKeyHash {
  std::size_t operator()(const TileKey& key) const noexcept {
    std::uint64_t hash = key.signature;
    for (const std::uint64_t word : key.choices) hash = (hash ^ hash >> 29 ^ word) * 0x9e3779b97f4a7c15u;
    return hash ^ hash >> 32;
  }
};

/// Builds tiles, one at a time.
class TileMaker {
 public:
  TileMaker() = default;
  TileMaker(const TileMaker&) = delete;
  TileMaker& operator=(const TileMaker&) = delete;
  virtual ~TileMaker() = default;
  /// Throws Error{TooLarge} for a tile with too many vertices.
  virtual BuiltTile make(const TileKey& key) = 0;
  /// Memory that it keeps from tile to tile.
  [[nodiscard]] virtual std::size_t kept_bytes() const = 0;
};

/// Which tiles a BuiltTiles builds.
struct TileKind {
  tile::Alternative alternative = tile::Alternative::low;
  /// Compact tiles exist for N = 5 (five_cube_tile.hpp). Tiles of other dimensions are barycentric.
  Triangulation triangulation = Triangulation::barycentric;
  bool is_estimated = false;  ///< ambiguities are resolved from the data
};

}  // namespace tegl::detail
