// SPDX-License-Identifier: BSD-3-Clause
//
// Orbit counts: golden values (computed independently, from explicit corner cycles in another language), cycle types
// against the elements, and Burnside's lemma against enumeration.
#include "symmetry/counting.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>

#include "base/error.hpp"
#include "symmetry/transversal.hpp"

namespace tegl::gen {
namespace {

/// Orbits of dimension index + 1: full, rotations, full + inversion, rotations + inversion.
const std::vector<std::array<std::string, 4>> kOrbits{
    {"3", "4", "2", "2"},
    {"6", "6", "4", "4"},
    {"22", "23", "14", "15"},
    {"402", "496", "222", "272"},
    {"1228158", "2275974", "616126", "1139718"},
    {"400507806843728", "800648638402240", "200253952527184", "400324361277120"},
    {"527471432057653004017274030725792", "1054942853799126580390222487977120", "263735716028826576482466871188128",
     "527471426899563371259916252708000"},
    {"11218076601767519586965281984173341005925142853855481024470471657123840",
     "22436153203535039105819651040959324360753617244078062654624560815030272",
     "5609038300883759793482640992086670939164957990135057216103303119630336",
     "11218076601767519552909825520479662659024161568505076150264998609305600"},
};

struct Kind {
  GroupKind group;
  bool inversion;
};
constexpr std::array<Kind, 4> kKinds{Kind{GroupKind::Full, false}, Kind{GroupKind::Rotations, false},
                                     Kind{GroupKind::Full, true}, Kind{GroupKind::Rotations, true}};

TEST(Counting, BurnsideGivesTheKnownNumbersInEveryDimension) {
  for (int n = 1; n <= kMaxDim; ++n) {
    for (std::size_t k = 0; k < kKinds.size(); ++k) {
      EXPECT_EQ(burnside_orbits(n, kKinds[k].group, kKinds[k].inversion).to_decimal(),
                kOrbits[static_cast<std::size_t>(n) - 1][k])
          << "n = " << n << ", group " << k;
    }
  }
}

TEST(Counting, EnumerationGivesTheSameNumbers) {
  for (int n = 1; n <= kMaxEnumeratedDim; ++n) {
    for (std::size_t k = 0; k < kKinds.size(); ++k) {
      const std::vector<Element> elements = group(n, kKinds[k].group, kKinds[k].inversion);
      const Transversal classes = transversal(n, elements);
      EXPECT_EQ(std::to_string(classes.representatives.size()), kOrbits[static_cast<std::size_t>(n) - 1][k])
          << "n = " << n << ", group " << k;
      EXPECT_NO_THROW(require_burnside_count(classes, n, kKinds[k].group, kKinds[k].inversion));
    }
  }
}

/// The cycle type found by following the cycles of axes and corners.
CycleType followed(const Element& g, int n) {
  CycleType type;
  type.det = g.det;
  std::uint32_t seen_axes = 0;
  for (int i = 0; i < n; ++i) {
    int length = 0;
    bool reversed = false;
    for (int j = i; (seen_axes >> j & 1U) == 0; j = g.axis[static_cast<std::size_t>(j)]) {
      seen_axes |= 1U << j;
      ++length;
      reversed ^= (g.flip >> j & 1U) != 0;
    }
    if (length > 0) {
      (reversed ? type.negative : type.positive).push_back(length);
    }
  }
  std::sort(type.positive.rbegin(), type.positive.rend());
  std::sort(type.negative.rbegin(), type.negative.rend());
  return type;
}

struct CornerCycles {
  std::uint64_t count = 0;
  bool all_even = true;
};

CornerCycles corner_cycles(const Element& g, int n) {
  CornerCycles result;
  std::vector<bool> seen(std::size_t{1} << n);
  for (std::uint32_t start = 0; start < seen.size(); ++start) {
    int length = 0;
    for (std::uint32_t v = start; !seen[v]; v = g.corner(v)) {
      seen[v] = true;
      ++length;
    }
    result.count += length > 0 ? 1 : 0;
    result.all_even &= length % 2 == 0;
  }
  return result;
}

TEST(Counting, CycleTypesDescribeTheElementsOfTheGroup) {
  for (int n = 1; n <= 5; ++n) {
    std::map<std::pair<std::vector<int>, std::vector<int>>, CycleType> types;
    for (const CycleType& type : cycle_types(n)) {
      EXPECT_TRUE(types.emplace(std::pair{type.positive, type.negative}, type).second) << "a type appears twice";
    }
    std::map<std::pair<std::vector<int>, std::vector<int>>, std::uint64_t> elements;
    for (const Element& g : group(n, GroupKind::Full, false)) {
      const CycleType expected = followed(g, n);
      const auto found = types.find({expected.positive, expected.negative});
      ASSERT_NE(found, types.end());
      const CornerCycles cycles = corner_cycles(g, n);
      ASSERT_EQ(found->second.corner_cycles, cycles.count);
      ASSERT_EQ(found->second.corner_cycles_all_even(), cycles.all_even);
      ASSERT_EQ(found->second.det, g.det);
      ++elements[found->first];
    }
    EXPECT_EQ(elements.size(), types.size()) << "n = " << n;
    for (const auto& [cycles, type] : types) {
      EXPECT_EQ(type.elements, elements[cycles]) << "n = " << n;
    }
  }
}

TEST(Counting, NumberOfCycleTypesIsThatOfPairsOfPartitions) {
  const std::array<std::size_t, kMaxDim> pairs{2, 5, 10, 20, 36, 65, 110, 185};
  for (int n = 1; n <= kMaxDim; ++n) {
    EXPECT_EQ(cycle_types(n).size(), pairs[static_cast<std::size_t>(n) - 1]);
  }
}

// A published generator for 4D tables typed its group generators by hand. They were meant to be rotations, but generate
// the 192 elements that permute the axes evenly, which gives 479 classes. The order equals that of the rotations and
// does not reveal the fault; the second count does.
TEST(Counting, TheWrongGroupOf192ElementsAnd479ClassesIsFoundOut) {
  std::vector<Element> wrong = group(4, GroupKind::Full, false);
  std::erase_if(wrong, [](const Element& g) {
    Element unflipped = g;
    unflipped.flip = 0;
    return determinant(unflipped) != 1;
  });
  ASSERT_EQ(wrong.size(), group_order(4, GroupKind::Rotations, false));
  EXPECT_TRUE(std::any_of(wrong.begin(), wrong.end(), [](const Element& g) { return g.det != 1; }));
  const Transversal classes = transversal(4, wrong);
  EXPECT_EQ(classes.representatives.size(), 479U);
  try {
    require_burnside_count(classes, 4, GroupKind::Rotations, false);
    FAIL() << "479 classes were accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::CountMismatch);
    EXPECT_NE(std::string(error.what()).find("479 classes by enumeration, 496 by"), std::string::npos) << error.what();
  }
  EXPECT_EQ(burnside_orbits(4, GroupKind::Rotations, false), WideUint{496});
  EXPECT_EQ(burnside_orbits(4, GroupKind::Full, false), WideUint{402});
}

TEST(Counting, RefusesDimensionsThatItCannotDo) {
  EXPECT_THROW((void)burnside_orbits(0, GroupKind::Full, false), Error);
  EXPECT_THROW((void)burnside_orbits(kMaxDim + 1, GroupKind::Full, false), Error);
}

}  // namespace
}  // namespace tegl::gen
