// SPDX-License-Identifier: BSD-3-Clause
//
// The guarantees of a transversal, for every group and signature of dimension 1 to 4.
#include "symmetry/transversal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <string>

#include "base/error.hpp"

namespace tegl::gen {
namespace {

struct Case {
  int n;
  GroupKind kind;
  bool inversion;
};

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (int n = 1; n <= kMaxEnumeratedDim; ++n) {
    for (const GroupKind kind : {GroupKind::Full, GroupKind::Rotations}) {
      cases.push_back({n, kind, false});
      cases.push_back({n, kind, true});
    }
  }
  return cases;
}

class TransversalOf : public testing::TestWithParam<Case> {
 protected:
  const std::vector<Element> elements_ = group(GetParam().n, GetParam().kind, GetParam().inversion);
  const Transversal classes_ = transversal(GetParam().n, elements_);
  const std::size_t signatures_ = std::size_t{1} << (1U << GetParam().n);
};

INSTANTIATE_TEST_SUITE_P(Groups, TransversalOf, testing::ValuesIn(all_cases()), [](const auto& test) {
  return std::to_string(test.param.n) + "D" + (test.param.kind == GroupKind::Full ? "Full" : "Rotations") +
         (test.param.inversion ? "WithInversion" : "");
});

TEST_P(TransversalOf, OrbitsPartitionTheSignatures) {
  ASSERT_EQ(classes_.class_of.size(), signatures_);
  ASSERT_EQ(classes_.orbit_length.size(), classes_.representatives.size());
  EXPECT_EQ(std::accumulate(classes_.orbit_length.begin(), classes_.orbit_length.end(), std::size_t{0}), signatures_);
  std::vector<std::uint32_t> counted(classes_.representatives.size());
  for (const std::uint32_t c : classes_.class_of) {
    ASSERT_LT(c, counted.size());
    ++counted[c];
  }
  EXPECT_EQ(counted, classes_.orbit_length);
}

TEST_P(TransversalOf, RepresentativesAreTheSmallestOfTheirOrbitsInAscendingOrder) {
  EXPECT_TRUE(std::is_sorted(classes_.representatives.begin(), classes_.representatives.end()));
  std::vector<std::uint32_t> smallest(classes_.representatives.size(), ~0U);
  for (std::uint32_t s = 0; s < signatures_; ++s) {
    smallest[classes_.class_of[s]] = std::min(smallest[classes_.class_of[s]], s);
  }
  EXPECT_EQ(smallest, classes_.representatives);
}

TEST_P(TransversalOf, TheElementTakesTheRepresentativeToTheSignature) {
  for (std::uint32_t s = 0; s < signatures_; ++s) {
    ASSERT_LT(classes_.element_of[s], elements_.size());
    const std::uint32_t r = classes_.representatives[classes_.class_of[s]];
    ASSERT_EQ(act(elements_[classes_.element_of[s]], GetParam().n, r), s);
  }
}

TEST_P(TransversalOf, EveryElementKeepsEverySignatureInItsClass) {
  for (std::size_t g = 0; g < elements_.size(); g += GetParam().n == 4 ? 11 : 1) {
    const std::vector<std::uint32_t> permutation = corner_permutation(elements_[g], GetParam().n);
    for (std::uint32_t s = 0; s < signatures_; ++s) {
      ASSERT_EQ(classes_.class_of[act(elements_[g], permutation, s)], classes_.class_of[s]);
    }
  }
}

TEST_P(TransversalOf, OrbitLengthTimesStabiliserIsTheOrder) {
  for (std::size_t c = 0; c < classes_.representatives.size(); ++c) {
    const std::uint32_t r = classes_.representatives[c];
    const auto fixing = std::count_if(elements_.begin(), elements_.end(),
                                      [&](const Element& g) { return act(g, GetParam().n, r) == r; });
    ASSERT_EQ(static_cast<std::size_t>(fixing) * classes_.orbit_length[c], elements_.size()) << "signature " << r;
  }
}

TEST(Transversal, IsThatOfTheThesisInTwoAndThreeDimensions) {
  EXPECT_EQ(transversal(2, group(2, GroupKind::Rotations, false)).representatives,
            (std::vector<std::uint32_t>{0, 1, 3, 6, 7, 15}));
  const Transversal classes = transversal(3, group(3, GroupKind::Full, false));
  EXPECT_EQ(classes.representatives, (std::vector<std::uint32_t>{0,  1,  3,  6,  7,  15,  22,  23,  24,  25,  27,
                                                                 30, 31, 60, 61, 63, 105, 107, 111, 126, 127, 255}));
  EXPECT_EQ(classes.orbit_length,
            (std::vector<std::uint32_t>{1, 8, 12, 12, 24, 6, 8, 8, 4, 24, 24, 24, 24, 6, 24, 12, 2, 8, 12, 4, 8, 1}));
}

TEST(Transversal, RotationsAloneTellTheMirrorImagesOf27And29Apart) {
  const Transversal full = transversal(3, group(3, GroupKind::Full, false));
  const Transversal rotations = transversal(3, group(3, GroupKind::Rotations, false));
  std::vector<std::uint32_t> additional;
  std::set_difference(rotations.representatives.begin(), rotations.representatives.end(), full.representatives.begin(),
                      full.representatives.end(), std::back_inserter(additional));
  EXPECT_EQ(additional, std::vector<std::uint32_t>{29});
  EXPECT_EQ(full.class_of[27], full.class_of[29]);
  EXPECT_NE(rotations.class_of[27], rotations.class_of[29]);
}

TEST(Transversal, RefusesElementsThatAreNoGroup) {
  std::vector<Element> broken = group(3, GroupKind::Full, false);
  broken.pop_back();
  EXPECT_THROW((void)transversal(3, broken), Error) << "47 of 48 elements";
  const std::vector<Element> identity{Element{}};
  EXPECT_EQ(transversal(3, identity).representatives.size(), 256U) << "the trivial group is one";
  const std::vector<Element> without_identity{group(2, GroupKind::Rotations, false).back()};
  EXPECT_THROW((void)transversal(2, without_identity), Error);
}

TEST(Representatives, AreThoseOfTheEnumerationWithTheirOrbits) {
  for (int n = 2; n <= kMaxEnumeratedDim; ++n)
    for (const GroupKind kind : {GroupKind::Full, GroupKind::Rotations}) {
      const Transversal expected = transversal(n, group(n, kind, false));
      std::vector<std::uint32_t> signatures, lengths;
      const std::uint64_t sum = for_each_representative(n, kind, [&](const Representative& r) {
        signatures.push_back(r.signature);
        lengths.push_back(r.orbit_length);
      });
      EXPECT_EQ(signatures, expected.representatives);
      EXPECT_EQ(lengths, expected.orbit_length);
      EXPECT_EQ(sum, std::uint64_t{1} << (1u << n));
    }
}

TEST(Representatives, Of5dAreAsManyAsTheoryHasAndTheirOrbitsMakeUpAllSignatures) {
  for (const auto& [kind, expected] : {std::pair{GroupKind::Full, 1'228'158U}, {GroupKind::Rotations, 2'275'974U}}) {
    const std::vector<Element> elements = group(5, kind, false);
    std::vector<std::vector<std::uint32_t>> permutations;
    for (const Element& g : elements) permutations.push_back(corner_permutation(g, 5));
    std::uint32_t count = 0;
    std::int64_t last = -1;
    const std::uint64_t sum = for_each_representative(5, kind, [&](const Representative& r) {
      ASSERT_GT(std::int64_t{r.signature}, last) << "ascending";
      last = r.signature;
      if (count++ % 50'021 != 0) return;
      // Checks a sample against the definition.
      std::set<std::uint32_t> orbit;
      for (std::size_t g = 0; g < elements.size(); ++g) orbit.insert(act(elements[g], permutations[g], r.signature));
      EXPECT_EQ(*orbit.begin(), r.signature);
      EXPECT_EQ(orbit.size(), r.orbit_length);
    });
    EXPECT_EQ(count, expected);
    EXPECT_EQ(sum, std::uint64_t{1} << 32);
  }
}

TEST(Representatives, OfOtherDimensionsAreRefused) {
  for (const int n : {1, 6}) EXPECT_THROW((void)for_each_representative(n, GroupKind::Full, {}), Error);
}

TEST(Transversal, RefusesDimensionsThatItCannotEnumerate) {
  for (const int n : {0, kMaxEnumeratedDim + 1}) {
    try {
      (void)transversal(n, std::vector<Element>{Element{}});
      FAIL() << "accepted dimension " << n;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
    }
  }
}

}  // namespace
}  // namespace tegl::gen
