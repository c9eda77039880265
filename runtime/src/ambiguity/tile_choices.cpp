// SPDX-License-Identifier: BSD-3-Clause
//
// Finds the ambiguous faces of a tile and determines their choices by an estimator (see tile_choices.hpp).
#include "ambiguity/tile_choices.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "tegl/generated/tables.hpp"
#include "tegl/tile/cube_faces.hpp"
#include "tile/tesseract_fill.hpp"

namespace tegl::detail {

namespace {

/// Corner of the tile for a corner of the face with this base and axes.
constexpr unsigned spread_corner(unsigned corner, unsigned base, unsigned axes) noexcept {
  for (unsigned j = 0; axes != 0; axes &= axes - 1, ++j)
    base |= (corner >> j & 1u) << static_cast<unsigned>(std::countr_zero(axes));
  return base;
}

/// A face that has a choice.
struct ChoiceFace {
  std::uint8_t base, axes, dim;
  std::array<std::uint8_t, 16> corners{};
  std::array<std::uint16_t, 6> squares{};  ///< of a cube, in the order of tables::ResolvedTable
};

/// The faces of the N-cube that have choices, except the cube itself (N > 2), computed by the compiler.
template <int N>
struct ChoiceFaces {
  static constexpr CubeFaces kCube{N};
  static constexpr std::size_t kCount = kCube.cells().size() - kCube.first_choice() - (N > 2 ? 1 : 0);
  std::array<ChoiceFace, kCount> faces{};

  constexpr ChoiceFaces() {
    for (std::size_t f = 0; f < kCount; ++f) {
      const CubeFace& cell = kCube.cells()[kCube.first_choice() + f];
      ChoiceFace& face = faces[f];
      face.base = cell.base, face.axes = cell.axes, face.dim = cell.dim;
      for (unsigned v = 0; v < 1u << cell.dim; ++v)
        face.corners[v] = static_cast<std::uint8_t>(spread_corner(v, cell.base, cell.axes));
      if (cell.dim != 3) continue;
      unsigned rest = cell.axes;
      for (unsigned q = 0; q < 6; q += 2, rest &= rest - 1) {
        const unsigned axis = rest & (0 - rest);
        for (unsigned side = 0; side < 2; ++side)
          face.squares[q + side] = static_cast<std::uint16_t>(
              kCube.number(cell.base | (side != 0 ? axis : 0), cell.axes & ~axis) - kCube.first_choice());
      }
    }
  }
};

template <int N>
constexpr ChoiceFaces<N> kChoiceFaces{};

/// Whether a face has a choice: squares with two diagonal high corners, cubes with several polygons, and faces of four
/// dimensions that are not settled.
bool is_open(const ChoiceFace& face, unsigned signature, const TileKey& key) noexcept {
  if (face.dim == 2) return signature == 6 || signature == 9;
  if (face.dim == 4) return !ResolvedTesseract::is_settled(static_cast<std::uint16_t>(signature));
  unsigned high = 0;
  for (unsigned q = 0; q < 6; ++q) high |= (key.choice(face.squares[q]) == tile::Choice::high ? 1u : 0u) << q;
  const std::uint16_t list = ResolvedCubes::instance().list(signature, high, tile::Choice::separate);
  return ResolvedCubes::instance().summary(list).part_count > 1;
}

}  // namespace

template <int N>
tile::Choice TileChoices<N>::ask(CellKind<N> kind, const Index& base, unsigned face_base,
                                 unsigned axes) const noexcept {
  const unsigned shift = kind.spread(face_base), along = kind.spread(axes);
  Index at = base;
  for (int a = 0; a < N; ++a) at[a] += shift >> a & 1u;
  std::array<double, std::size_t{1} << N> values;
  estimator_.source().corner_values(at, along, values.data());
  const std::size_t count = std::size_t{1} << std::popcount(axes);
  if (count > 4) return estimator_.choice(at, along, std::span<const double>(values).first(count));
  return estimator_.is_square_high(at, along, std::span<const double>(values).template first<4>()) ? tile::Choice::high
                                                                                                   : tile::Choice::low;
}

template <int N>
TileKey TileChoices<N>::of_faces(CellKind<N> kind, const Index& base, std::uint64_t signature) const noexcept {
  constexpr unsigned kLast = 1u << (N - 1);
  TileKey key{signature, {}};
  for (std::size_t f = 0; f < kChoiceFaces<N>.faces.size(); ++f) {
    const ChoiceFace& face = kChoiceFaces<N>.faces[f];
    if (kind.is_cap() && ((face.base | face.axes) & kLast) != 0) continue;
    unsigned own = 0;
    for (unsigned v = 0; v < 1u << face.dim; ++v) own |= static_cast<unsigned>(signature >> face.corners[v] & 1u) << v;
    if (own == 0 || own + 1 == 1u << (1u << face.dim) || !is_open(face, own, key)) continue;
    key.choose(f, ask(kind, base, face.base, face.axes));
  }
  return key;
}

template <int N>
void TileChoices<N>::choose_own(TileKey& key, const Index& base) const noexcept {
  if constexpr (N > 2) key.choose(kChoiceFaces<N>.faces.size(), ask(CellKind<N>(0), base, 0, (1u << N) - 1));
}

template class TileChoices<2>;
template class TileChoices<3>;
template class TileChoices<4>;
template class TileChoices<5>;

}  // namespace tegl::detail
