// SPDX-License-Identifier: BSD-3-Clause
//
// Lists (ResolvedCubes) of the eight cubes of many tesseracts, looked up in the lanes of registers. Compiled for
// several instruction sets, the best of which is chosen at run time; all give identical results.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "tegl/tile/triangulation.hpp"
#include "tile/tesseract_fill.hpp"

namespace tegl::detail {

/// Two numbers below 1024 for each signature of a cube and each set of high ones among its squares, in one word, so
/// that one lookup finds all about a cube.
class CubeListTable {
 public:
  enum class Content {
    separate,   ///< twice the list of the choice `separate`
    by_centre,  ///< the lists of the choices `low` and `high`, which are equal if there is no choice
    with_joins  ///< the list of the choice `separate`, and the entry of the table of resolved cubes
  };
  static constexpr unsigned kBits = 10;  ///< of a number
  // Flags:
  static constexpr unsigned kFirstHasVertices = 20, kSecondHasVertices = 21;  ///< of the first, the second list
  /// The choice matters (by_centre), or one pair of edges may join (with_joins): the two contents share this bit, which
  /// `find_lists` returns as `with_choice`.
  static constexpr unsigned kHasChoiceOrPair = 22;
  static constexpr unsigned kHasPairs = 23;  ///< several pairs of edges may join (with_joins)
  static constexpr std::size_t kWords = std::size_t{64} << 8;

  /// Made at the first call for each content and triangulation.
  static const CubeListTable& instance(Content content, Triangulation triangulation) noexcept;
  /// By signature + 256 * (set of high squares).
  [[nodiscard]] const std::uint32_t* words() const noexcept { return words_.data(); }

 private:
  template <Content kContent, Triangulation kTriangulation>
  static const CubeListTable& instance() noexcept;
  CubeListTable(Content content, Triangulation triangulation) noexcept;

  alignas(64) std::array<std::uint32_t, kWords> words_;
};

/// The cubes of a tesseract: by byte, from the lowest on, their signatures and their high squares. `second`: bit set of
/// the cubes whose second number is wanted.
struct WantedLists {
  std::uint64_t signatures, squares;
  unsigned second;
};
/// The lists of the cubes of a tesseract, and flags.
struct FoundLists {
  ResolvedCubes::Lists wanted, second;
  // Sets of cubes, as bits:
  std::uint8_t with_vertices;
  std::uint8_t with_choice;  ///< or with one pair
  std::uint8_t with_pairs;
};
/// `found`: as many as `faces`.
void find_lists(const CubeListTable& table, std::span<const WantedLists> faces, FoundLists* found) noexcept;

}  // namespace tegl::detail
