// SPDX-License-Identifier: BSD-3-Clause
//
// Fixed points, isotropy groups and kinds of elements by definition, and against tables 6.8, 6.9 and 7.5 of the thesis.
// The thesis's tables are typed from a scan. `?` stands for a character that the scan damaged and matches any.
#include "symmetry/group_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "base/error.hpp"
#include "symmetry/counting.hpp"

namespace tegl::gen {
namespace {

std::string word_of(const GroupTable& table, std::size_t g) {
  return word_text(table.elements[g].word, table.generators);
}

std::vector<GroupTable> group_tables(int n) {
  std::vector<GroupTable> result;
  for (const GroupKind kind : {GroupKind::Rotations, GroupKind::Full})
    for (const bool inversion : {false, true}) result.push_back(group_table(n, kind, inversion));
  return result;
}

TEST(GroupTable, FixedSignaturesAreThoseThatTheElementMapsToThemselves) {
  for (const int n : {2, 3}) {
    for (const GroupTable& table : group_tables(n)) {
      for (const ElementRow& row : table.elements) {
        std::vector<std::uint32_t> fixed;
        for (std::uint32_t s = 0; s < 1U << (1U << n); ++s)
          if (act(row.element, n, s) == s) fixed.push_back(s);
        ASSERT_EQ(row.fixed_signatures, fixed);
        ASSERT_EQ(row.fixed, fixed.size());
      }
    }
  }
}

TEST(GroupTable, FixedSignaturesOf4dAreCountedRight) {
  const GroupTable table = group_table(4, GroupKind::Full, true);
  for (std::size_t g = 0; g < table.elements.size(); g += 7) {
    const ElementRow& row = table.elements[g];
    const std::vector<std::uint32_t> corners = corner_permutation(row.element, 4);
    std::uint64_t fixed = 0;
    for (std::uint32_t s = 0; s < 65536; ++s) fixed += act(row.element, corners, s) == s ? 1U : 0U;
    ASSERT_EQ(row.fixed, fixed) << word_of(table, g);
  }
}

TEST(GroupTable, FixedPointsAddUpToOrderTimesClasses) {
  for (const int n : {2, 3, 4}) {
    for (const GroupTable& table : group_tables(n)) {
      EXPECT_EQ(table.elements.size(), group_order(n, table.kind, table.inversion));
      EXPECT_EQ(WideUint{table.classes.size()}, burnside_orbits(n, table.kind, table.inversion));
      EXPECT_EQ(table.fixed_sum, table.elements.size() * table.classes.size());
    }
  }
}

TEST(GroupTable, IsotropyGroupsHoldTheElementsThatFixTheSignature) {
  for (const int n : {2, 3, 4}) {
    for (const GroupTable& table : group_tables(n)) {
      for (const ClassRow& row : table.classes) {
        std::vector<std::size_t> isotropy;
        for (std::size_t g = 0; g < table.elements.size(); ++g)
          if (act(table.elements[g].element, n, row.signature) == row.signature) isotropy.push_back(g);
        ASSERT_EQ(row.isotropy, isotropy) << row.signature;
      }
    }
  }
}

/// The images of corner and inversion that identify an element.
using Key = std::pair<std::vector<std::uint32_t>, bool>;

std::set<Key> generated(const GroupTable& table, const std::vector<std::size_t>& by) {
  std::vector<Element> elements{Element{}};
  std::set<Key> keys{{corner_permutation(Element{}, table.dim), false}};
  for (std::size_t done = 0; done < elements.size(); ++done) {
    for (const std::size_t g : by) {
      const Element image = compose(table.elements[g].element, elements[done]);
      if (keys.emplace(corner_permutation(image, table.dim), image.inverts).second) elements.push_back(image);
    }
  }
  return keys;
}

TEST(GroupTable, IsotropyGroupsAreGeneratedByTheirGeneratorsNoneOfWhichCanBeLeftOut) {
  for (const int n : {2, 3, 4}) {
    const GroupTable table = group_table(n, GroupKind::Full, n == 3);
    for (const ClassRow& row : table.classes) {
      EXPECT_EQ(generated(table, row.isotropy_by).size(), row.isotropy.size()) << row.signature;
      EXPECT_TRUE(
          std::includes(row.isotropy.begin(), row.isotropy.end(), row.isotropy_by.begin(), row.isotropy_by.end()));
      for (std::size_t i = 0; i < row.isotropy_by.size(); ++i) {
        std::vector<std::size_t> others = row.isotropy_by;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
        EXPECT_LT(generated(table, others).size(), row.isotropy.size()) << row.signature;
      }
    }
  }
}

TEST(GroupTable, ElementsOfOneKindAreAConjugacyClass) {
  for (const int n : {2, 3, 4}) {
    const GroupTable table = group_table(n, GroupKind::Full, false);
    std::map<std::vector<int>, std::uint64_t> elements;
    std::map<std::vector<int>, std::set<std::string>> kinds;
    for (const ElementRow& row : table.elements) {
      ++elements[row.cycles];
      kinds[row.cycles].insert(row.kind);
      EXPECT_EQ(row.kind.empty(), n == 4);
    }
    const std::vector<CycleType> types = cycle_types(n);
    EXPECT_EQ(elements.size(), types.size());
    for (const CycleType& type : types) {
      std::vector<int> cycles = type.positive;
      for (const int length : type.negative) cycles.push_back(-length);
      EXPECT_EQ(elements[cycles], type.elements);
      EXPECT_EQ(kinds[cycles].size(), 1U);
    }
  }
}

TEST(GroupTable, RefusesDimensionsThatItCannotDo) {
  for (const int n : {1, 5}) EXPECT_THROW((void)group_table(n, GroupKind::Full, false), Error);
}

// --- The thesis -----------------------------------------------------------------------------------------------

/// True if the printed text can be read as this one.
bool reads(const std::string& printed, const std::string& text) {
  return printed.size() == text.size() &&
         std::equal(printed.begin(), printed.end(), text.begin(), [](char p, char t) { return p == '?' || p == t; });
}

// Damaged: the base of rho^2, the exponent of rho^3, and the last number, which reads 5; the sum 16 + 2 + 4 + 2 in the
// text has it.
TEST(ThesisGroups, Table68FixedPointsOfTheFourRotations) {
  struct Row {
    std::string element;
    std::vector<std::uint32_t> set;
    std::string count;
  };
  const std::vector<Row> printed{{"1", {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}, "16"},
                                 {"rho", {0, 15}, "2"},
                                 {"????2", {0, 6, 9, 15}, "4"},
                                 {"rho??", {0, 15}, "?"}};
  const GroupTable table = group_table(2, GroupKind::Rotations, false);
  ASSERT_EQ(table.elements.size(), printed.size());
  for (std::size_t g = 0; g < printed.size(); ++g) {
    EXPECT_TRUE(reads(printed[g].element, word_of(table, g))) << word_of(table, g);
    EXPECT_EQ(table.elements[g].fixed_signatures, printed[g].set);
    EXPECT_TRUE(reads(printed[g].count, std::to_string(table.elements[g].fixed)));
  }
  EXPECT_EQ(table.fixed_sum, 16U + 2U + 4U + 2U);
  EXPECT_EQ(table.fixed_sum / table.elements.size(), 6U);
}

// Damaged: the exponent in {1, rho^2}. The first two columns of the class of 6 are blank: they repeat those of 3.
TEST(ThesisGroups, Table69IsotropyGroupsOfTheSixClasses) {
  struct Row {
    int high_corners;
    std::uint32_t with_as_many;
    std::uint32_t signature;
    std::string isotropy;
    std::uint32_t orbit;
  };
  const std::vector<Row> printed{{0, 1, 0, "G", 1},          {1, 4, 1, "{1}", 4}, {2, 6, 3, "{1}", 4},
                                 {2, 6, 6, "{1, rho^?}", 2}, {3, 4, 7, "{1}", 4}, {4, 1, 15, "G", 1}};
  const GroupTable table = group_table(2, GroupKind::Rotations, false);
  ASSERT_EQ(table.classes.size(), printed.size());
  std::map<int, std::uint32_t> with_as_many;
  for (const ClassRow& row : table.classes) with_as_many[row.high_corners] += row.orbit_length;
  for (std::size_t c = 0; c < printed.size(); ++c) {
    const ClassRow& row = table.classes[c];
    EXPECT_EQ(row.high_corners, printed[c].high_corners);
    EXPECT_EQ(with_as_many[row.high_corners], printed[c].with_as_many);
    EXPECT_EQ(row.signature, printed[c].signature);
    EXPECT_TRUE(reads(printed[c].isotropy, isotropy_name(table, row))) << isotropy_name(table, row);
    EXPECT_EQ(row.orbit_length, printed[c].orbit);
  }
}

/// True if the printed words can be read as the computed ones, in some order: a matching by trying all choices.
bool read_as(const std::vector<std::string>& printed, std::vector<std::string> words, std::size_t first = 0) {
  if (first == printed.size()) return true;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (!reads(printed[first], words[i])) continue;
    std::vector<std::string> rest = words;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
    if (read_as(printed, rest, first + 1)) return true;
  }
  return false;
}

// Damaged: many of the axes, and exponents that read 0 or %. Of the eight thirds of a turn the first four words are
// legible but for two axes; the last four run together (pipupspx,?gpwpipsz) and are left out here.
TEST(ThesisGroups, Table75RotationsOfTheCubeAsWords) {
  struct Row {
    const char* kind;
    std::size_t elements;            ///< as in section 7.4.4
    std::vector<std::string> words;  ///< the legible ones
  };
  const std::vector<Row> printed{
      {"identity", 1, {"1"}},
      {"quarter turn about a face axis", 6, {"rho_x", "rho_y", "rho_?", "rho_?^?", "rho_?^3", "rho_?^3"}},
      {"half turn about a face axis", 3, {"rho_?^?", "rho_?^?", "rho_?^2"}},
      {"half turn about an edge axis",
       6,
       {"rho_?^? rho_z", "rho_?^? rho_y", "rho_?^? rho_?", "rho_?^2 rho_z", "rho_?^? rho_y", "rho_?^2 rho_x"}},
      {"third of a turn about a corner axis", 8, {"rho_x rho_y", "rho_y rho_z", "rho_? rho_?", "rho_x rho_z"}}};
  const GroupTable table = group_table(3, GroupKind::Rotations, false);
  std::size_t g = 0;
  for (const Row& row : printed) {
    std::vector<std::string> words;
    for (std::size_t i = 0; i < row.elements; ++i, ++g) {
      ASSERT_LT(g, table.elements.size());
      EXPECT_EQ(table.elements[g].kind, row.kind);
      words.push_back(word_of(table, g));
    }
    EXPECT_TRUE(read_as(row.words, words)) << row.kind;
  }
  EXPECT_EQ(g, table.elements.size());
}

// Section 7.4.7: with the mirror in the centre, which commutes with all rotations, the group has 48 elements.
TEST(ThesisGroups, TheOther24SymmetriesOfTheCubeAreRotationsWithTheMirror) {
  const GroupTable table = group_table(3, GroupKind::Full, false);
  ASSERT_EQ(table.elements.size(), 48U);
  const auto mu = static_cast<std::uint8_t>(table.generators.size() - 1);
  ASSERT_EQ(table.generators[mu].name, "mu");
  std::set<Word> rotations, mirrored;
  for (const ElementRow& row : table.elements) {
    if (row.element.det > 0) {
      rotations.insert(row.word);
    } else {
      ASSERT_EQ(row.word.back(), mu);
      mirrored.emplace(row.word.begin(), row.word.end() - 1);
    }
    const Element& centre = table.generators[mu].element;
    EXPECT_EQ(compose(row.element, centre), compose(centre, row.element));
  }
  EXPECT_EQ(mirrored, rotations);
}

}  // namespace
}  // namespace tegl::gen
