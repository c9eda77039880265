// SPDX-License-Identifier: BSD-3-Clause
//
// Tables by which the lists of many cubes are looked up in the lanes of registers: all about a cube in one word.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "builders/cube_lists.hpp"
#include "builders/tesseract_arrays.hpp"
#include "tegl/tile/triangulation.hpp"

namespace tegl::gen {

/// The words of builder4_lookup.hpp (CubeListTable) by entry of the resolved cube.
struct CubeWords {
  enum class Content : std::uint8_t { separate, by_centre, with_joins };  ///< as CubeListTable::Content
  static constexpr std::array<Content, 3> kContents = {Content::separate, Content::by_centre, Content::with_joins};
  static constexpr unsigned kBits = 10;  ///< of a number
  // Flags:
  static constexpr unsigned kFirstHasVertices = 20, kSecondHasVertices = 21, kHasChoiceOrPair = 22, kHasPairs = 23;

  Content content = Content::separate;
  Triangulation triangulation = Triangulation::compact;
  std::vector<std::uint32_t> words;
};

/// Makes and certifies the words: by content; of each, barycentric and compact.
[[nodiscard]] std::vector<CubeWords> make_cube_words(const TesseractArrays& arrays);

/// Compares each word with the lists that it names: their signature, high squares, choice and own vertices; and with
/// the pairs of edges that may join. Throws Error{CertificateFailed}, with the entry.
void certify(const CubeWords& words, const TesseractArrays& arrays);

/// The definitions of the arrays from which builder4_lookup.cpp makes its tables.
[[nodiscard]] std::string words_text(const std::vector<CubeWords>& words, const TesseractArrays& arrays);

}  // namespace tegl::gen
