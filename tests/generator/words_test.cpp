// SPDX-License-Identifier: BSD-3-Clause
//
// Group elements as words: each word multiplied out letter by letter, the lengths against a search of its own, and the
// generators against the thesis.
#include "symmetry/words.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "base/error.hpp"

namespace tegl::gen {
namespace {

using Corners = std::vector<std::uint32_t>;

struct NamedGroup {
  int dim;
  GroupKind kind;
  bool inversion;
};

std::vector<NamedGroup> named_groups() {
  std::vector<NamedGroup> result;
  for (int n = 2; n <= 4; ++n)
    for (const GroupKind kind : {GroupKind::Rotations, GroupKind::Full})
      for (const bool inversion : {false, true}) result.push_back({n, kind, inversion});
  return result;
}

std::string name_of(const NamedGroup& c) {
  return std::to_string(c.dim) + (c.kind == GroupKind::Full ? "D, full" : "D, rotations") +
         (c.inversion ? ", inversion" : "");
}

TEST(Words, EachWordAppliedLetterByLetterIsItsElement) {
  for (const NamedGroup& c : named_groups()) {
    SCOPED_TRACE(name_of(c));
    const std::vector<Element> elements = group(c.dim, c.kind, c.inversion);
    const std::vector<Generator> generators = named_generators(c.dim, c.kind, c.inversion);
    const std::vector<Word> words = shortest_words(elements, generators);
    ASSERT_EQ(words.size(), elements.size());
    for (std::size_t g = 0; g < elements.size(); ++g) {
      ASSERT_EQ(product(words[g], generators), elements[g]) << word_text(words[g], generators);
      for (std::uint32_t v = 0; v < 1U << c.dim; ++v) {
        std::uint32_t image = v;
        bool inverts = false;
        for (const std::uint8_t letter : words[g]) {  // the first letter acts first
          image = generators[letter].element.corner(image);
          inverts ^= generators[letter].element.inverts;
        }
        ASSERT_EQ(image, elements[g].corner(v)) << word_text(words[g], generators);
        ASSERT_EQ(inverts, elements[g].inverts);
      }
    }
  }
}

/// The smallest number of generators whose product is each element, found on permutations of corners.
std::map<std::pair<Corners, bool>, std::size_t> lengths(const NamedGroup& c) {
  const std::vector<Generator> generators = named_generators(c.dim, c.kind, c.inversion);
  std::map<std::pair<Corners, bool>, std::size_t> result{{{corner_permutation(Element{}, c.dim), false}, 0}};
  for (std::size_t length = 0, before = 0; before != result.size(); ++length) {
    before = result.size();
    const auto known = result;
    for (const auto& [element, shortest] : known) {
      if (shortest != length) continue;
      for (const Generator& generator : generators) {
        Corners images;
        for (const std::uint32_t v : element.first) images.push_back(generator.element.corner(v));
        result.try_emplace({images, element.second != generator.element.inverts}, length + 1);
      }
    }
  }
  return result;
}

TEST(Words, NoShorterWordExists) {
  for (const NamedGroup& c : named_groups()) {
    SCOPED_TRACE(name_of(c));
    const auto shortest = lengths(c);
    const std::vector<Element> elements = group(c.dim, c.kind, c.inversion);
    ASSERT_EQ(shortest.size(), elements.size());
    const std::vector<Word> words = shortest_words(elements, named_generators(c.dim, c.kind, c.inversion));
    for (std::size_t g = 0; g < elements.size(); ++g)
      ASSERT_EQ(words[g].size(), shortest.at({corner_permutation(elements[g], c.dim), elements[g].inverts}));
  }
}

// Thesis, 7.4.5 and 7.4.7: at most four generators for a rotation of the cube, at most five with the mirror.
TEST(Words, OfTheCubeHaveFourLettersAtMostAndFiveWithTheMirror) {
  for (const GroupKind kind : {GroupKind::Rotations, GroupKind::Full}) {
    const std::vector<Word> words = shortest_words(group(3, kind, false), named_generators(3, kind, false));
    const auto longest =
        std::max_element(words.begin(), words.end(), [](const Word& a, const Word& b) { return a.size() < b.size(); });
    EXPECT_EQ(longest->size(), kind == GroupKind::Full ? 5U : 4U);
  }
}

/// A generator as a map of corners written as in the thesis: one letter for each digit of the image, the highest axis
/// first; a lower-case letter is the complement of a digit.
std::uint32_t mapped(const std::string& image, const std::string& digits, std::uint32_t corner) {
  std::uint32_t result = 0;
  for (const char letter : image) {
    const bool complement = letter >= 'a';
    const std::size_t at = digits.find(complement ? static_cast<char>(letter - 'a' + 'A') : letter);
    const std::uint32_t digit = corner >> (digits.size() - 1 - at) & 1U;
    result = result << 1 | (complement ? 1 - digit : digit);
  }
  return result;
}

// Equation (6.10): rho(YX) = X(1-Y). Section 7.4.10: the order of the digits is legible in the scan; the bars over the
// complemented ones are not, so these follow from "quarter turn in the positive direction" (7.4.5).
TEST(Words, GeneratorsMoveCornersAsInTheThesis) {
  const auto expect_map = [](const Generator& generator, const std::string& name, const std::string& digits,
                             const std::string& image) {
    EXPECT_EQ(generator.name, name);
    for (std::uint32_t v = 0; v < 1U << digits.size(); ++v)
      EXPECT_EQ(generator.element.corner(v), mapped(image, digits, v)) << name << ", corner " << v;
  };
  expect_map(named_generators(2, GroupKind::Rotations, false).at(0), "rho", "YX", "Xy");
  const std::vector<Generator> cube = named_generators(3, GroupKind::Full, false);
  ASSERT_EQ(cube.size(), 4U);
  expect_map(cube[0], "rho_x", "ZYX", "YzX");
  expect_map(cube[1], "rho_y", "ZYX", "xYZ");
  expect_map(cube[2], "rho_z", "ZYX", "ZXy");
  expect_map(cube[3], "mu", "ZYX", "zyx");
}

TEST(Words, AreWrittenWithPowersTheFirstLetterFirst) {
  const std::vector<Generator> cube = named_generators(3, GroupKind::Full, true);
  EXPECT_EQ(word_text({}, cube), "1");
  EXPECT_EQ(word_text({0}, cube), "rho_x");
  EXPECT_EQ(word_text({0, 0, 1}, cube), "rho_x^2 rho_y");
  EXPECT_EQ(word_text({1, 0, 0, 0, 3, 4}, cube), "rho_y rho_x^3 mu iota");
}

TEST(Words, ShorterOnesThenFewerPowersThenHigherPowersPrecede) {
  const std::vector<Word> ascending{{},        {0},       {1},       {0, 0},    {0, 1},   {1, 0},
                                    {0, 0, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}, {0, 1, 0}};
  for (std::size_t i = 0; i < ascending.size(); ++i)
    for (std::size_t j = 0; j < ascending.size(); ++j)
      EXPECT_EQ(precedes(ascending[i], ascending[j]), i < j) << i << " and " << j;
}

TEST(Words, GeneratorsOfAnotherGroupAreRefused) {
  const std::vector<Element> full = group(3, GroupKind::Full, false);
  const std::vector<Element> rotations = group(3, GroupKind::Rotations, false);
  for (const auto& [elements, kind] : {std::pair{full, GroupKind::Rotations}, std::pair{rotations, GroupKind::Full}}) {
    try {
      (void)shortest_words(elements, named_generators(3, kind, false));
      FAIL() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::Internal);
    }
  }
}

TEST(Words, RefusesDimensionsThatHaveNoNames) {
  for (const int n : {1, 5}) {
    try {
      (void)named_generators(n, GroupKind::Full, false);
      FAIL() << "accepted dimension " << n;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
      EXPECT_NE(std::string(error.what()).find("expected 2 to 4"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace tegl::gen
