// SPDX-License-Identifier: BSD-3-Clause
//
// The certificate of the words by which lists of cubes are looked up finds a wrong word of each kind.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/error.hpp"
#include "builders/cube_words.hpp"
#include "builders/tesseract_arrays.hpp"

namespace tegl::gen {
namespace {

const TesseractArrays& made_arrays() {
  static const TesseractArrays arrays = make_tesseract_arrays();
  return arrays;
}

bool is_certified(const CubeWords& words, const TesseractArrays& arrays) {
  try {
    certify(words, arrays);
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(ErrorCode::CertificateFailed, error.code());
    return false;
  }
}

TEST(CubeWords, AnyChangedBitOfAnyWordIsFound) {
  const TesseractArrays& arrays = made_arrays();
  const std::vector<CubeWords> made = make_cube_words(arrays);
  ASSERT_EQ(6u, made.size());
  for (const CubeWords& words : made) {
    ASSERT_EQ(arrays.cube.entries.size(), words.words.size());
    ASSERT_TRUE(is_certified(words, arrays));
    for (std::size_t entry = 0; entry < words.words.size(); entry += 5)
      for (unsigned bit = 0; bit < 32; ++bit) {
        CubeWords changed = words;
        changed.words[entry] ^= std::uint32_t{1} << bit;
        ASSERT_FALSE(is_certified(changed, arrays)) << "entry " << entry << ", bit " << bit;
      }
  }
}

TEST(CubeWords, OtherWordsAreFound) {
  const TesseractArrays& arrays = made_arrays();
  std::vector<CubeWords> made = make_cube_words(arrays);
  // words with another content
  CubeWords other = made[0];
  other.content = CubeWords::Content::by_centre;
  EXPECT_FALSE(is_certified(other, arrays));
  // words of the other triangulation, whose lists have other vertices
  other = made[0];
  other.triangulation = Triangulation::compact;
  EXPECT_FALSE(is_certified(other, arrays));
  // too few or too many
  other = made[0];
  other.words.pop_back();
  EXPECT_FALSE(is_certified(other, arrays));
  other = made[0];
  other.words.push_back(0);
  EXPECT_FALSE(is_certified(other, arrays));
}

}  // namespace
}  // namespace tegl::gen
