// SPDX-License-Identifier: BSD-3-Clause
//
// The symmetry group against its definition, which the code does not use: all signed permutations, and the determinant
// by expansion.
#include "symmetry/symmetry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <tuple>

#include "base/error.hpp"

namespace tegl::gen {
namespace {

using Corners = std::vector<std::uint32_t>;
using Matrix = std::vector<std::vector<int>>;

/// M with M[axis[i]][i] = +-1, as documented.
Matrix matrix_of(const Element& g, int n) {
  Matrix m(static_cast<std::size_t>(n), std::vector<int>(static_cast<std::size_t>(n), 0));
  for (std::size_t i = 0; i < m.size(); ++i) {
    m[g.axis[i]][i] = (g.flip >> g.axis[i] & 1U) != 0 ? -1 : 1;
  }
  return m;
}

/// Expansion along the first row.
int determinant_of(const Matrix& m) {
  if (m.empty()) {
    return 1;
  }
  int sum = 0;
  for (std::size_t column = 0; column < m.size(); ++column) {
    if (m[0][column] == 0) {
      continue;
    }
    Matrix minor;
    for (std::size_t row = 1; row < m.size(); ++row) {
      minor.push_back(m[row]);
      minor.back().erase(minor.back().begin() + static_cast<std::ptrdiff_t>(column));
    }
    sum += (column % 2 == 0 ? 1 : -1) * m[0][column] * determinant_of(minor);
  }
  return sum;
}

/// The defining property of a symmetry of the cube: a bijection of corners that preserves adjacency.
bool keeps_edges(const Corners& image, int n) {
  for (std::uint32_t v = 0; v < image.size(); ++v) {
    for (int axis = 0; axis < n; ++axis) {
      const std::uint32_t difference = image[v] ^ image[v ^ (1U << axis)];
      if (difference == 0 || (difference & (difference - 1)) != 0) {
        return false;
      }
    }
  }
  return true;
}

/// The corner permutations of all n! 2^n signed permutations, by definition.
std::set<Corners> signed_permutations(int n) {
  std::set<Corners> result;
  std::vector<int> axis(static_cast<std::size_t>(n));
  std::iota(axis.begin(), axis.end(), 0);
  do {
    for (std::uint32_t flip = 0; flip < 1U << n; ++flip) {
      Corners image;
      for (std::uint32_t v = 0; v < 1U << n; ++v) {
        std::uint32_t w = 0;
        for (std::size_t i = 0; i < axis.size(); ++i) {
          w |= (v >> i & 1U) << axis[i];
        }
        image.push_back(w ^ flip);
      }
      result.insert(image);
    }
  } while (std::next_permutation(axis.begin(), axis.end()));
  return result;
}

TEST(Symmetry, OrdersAreTwoToTheNTimesNFactorialHalvedForRotationsDoubledWithInversion) {
  const std::vector<std::size_t> full{2, 8, 48, 384, 3840, 46080, 645120, 10321920};
  for (int n = 1; n <= kMaxDim; ++n) {
    const std::size_t order = full[static_cast<std::size_t>(n) - 1];
    EXPECT_EQ(group_order(n, GroupKind::Full, false), order);
    EXPECT_EQ(group_order(n, GroupKind::Full, true), 2 * order);
    EXPECT_EQ(group_order(n, GroupKind::Rotations, false), order / 2);
    EXPECT_EQ(group_order(n, GroupKind::Rotations, true), order);
  }
}

TEST(Symmetry, ClosedGroupHasTheExpectedOrder) {
  for (int n = 1; n <= 6; ++n) {
    for (const GroupKind kind : {GroupKind::Full, GroupKind::Rotations}) {
      for (const bool inversion : {false, true}) {
        EXPECT_EQ(group(n, kind, inversion).size(), group_order(n, kind, inversion)) << "n = " << n;
      }
    }
  }
}

TEST(Symmetry, FullGroupIsAllSignedPermutations) {
  for (int n = 1; n <= 5; ++n) {
    std::set<Corners> found;
    for (const Element& g : group(n, GroupKind::Full, false)) {
      const Corners image = corner_permutation(g, n);
      EXPECT_TRUE(keeps_edges(image, n));
      EXPECT_TRUE(found.insert(image).second) << "an element appears twice, n = " << n;
    }
    EXPECT_EQ(found, signed_permutations(n)) << "n = " << n;
  }
}

TEST(Symmetry, RotationsAreTheElementsOfDeterminantOne) {
  for (int n = 1; n <= 5; ++n) {
    std::vector<Element> positive = group(n, GroupKind::Full, false);
    const std::size_t removed = std::erase_if(positive, [](const Element& g) { return g.det != 1; });
    EXPECT_EQ(removed, positive.size()) << "half of the symmetries are rotations, n = " << n;
    EXPECT_EQ(group(n, GroupKind::Rotations, false), positive) << "n = " << n;
  }
}

TEST(Symmetry, InversionDoublesTheGroup) {
  for (const GroupKind kind : {GroupKind::Full, GroupKind::Rotations}) {
    std::vector<Element> expected = group(3, kind, false);
    const std::size_t half = expected.size();
    for (std::size_t i = 0; i < half; ++i) {
      expected.push_back(expected[i]);
      expected.back().inverts = true;
    }
    EXPECT_EQ(group(3, kind, true), expected);
  }
}

TEST(Symmetry, OrderIsIdentityFirstThenAscending) {
  const std::vector<Element> elements = group(4, GroupKind::Full, true);
  EXPECT_EQ(elements.front(), Element{});
  const auto key = [](const Element& g) { return std::make_tuple(g.inverts, g.axis, g.flip); };
  for (std::size_t i = 1; i < elements.size(); ++i) {
    EXPECT_LT(key(elements[i - 1]), key(elements[i]));
  }
}

TEST(Symmetry, DetIsTheDeterminantOfTheSignedPermutationMatrix) {
  for (int n = 1; n <= 5; ++n) {
    for (const Element& g : group(n, GroupKind::Full, true)) {
      ASSERT_EQ(g.det, determinant_of(matrix_of(g, n)));
    }
  }
}

TEST(Symmetry, ActsOnCornersAsItsMatrixDoesAboutTheCentre) {
  const int n = 4;
  for (const Element& g : group(n, GroupKind::Full, false)) {
    const Matrix m = matrix_of(g, n);
    for (std::uint32_t v = 0; v < 1U << n; ++v) {
      std::uint32_t expected = 0;
      for (std::size_t row = 0; row < m.size(); ++row) {
        int coordinate = 0;  // twice the coordinate about the centre: -1 or 1
        for (std::size_t i = 0; i < m.size(); ++i) {
          coordinate += m[row][i] * ((v >> i & 1U) != 0 ? 1 : -1);
        }
        expected |= (coordinate > 0 ? 1U : 0U) << row;
      }
      ASSERT_EQ(g.corner(v), expected);
    }
  }
}

TEST(Symmetry, IsClosedAndMultiplicative) {
  const int n = 3;
  const std::vector<Element> elements = group(n, GroupKind::Full, true);
  for (const Element& a : elements) {
    for (const Element& b : elements) {
      const Element ab = compose(a, b);
      ASSERT_NE(std::find(elements.begin(), elements.end(), ab), elements.end());
      ASSERT_EQ(ab.det, a.det * b.det);
      ASSERT_EQ(ab.inverts, a.inverts != b.inverts);
      for (std::uint32_t v = 0; v < 1U << n; ++v) {
        ASSERT_EQ(ab.corner(v), a.corner(b.corner(v)));
      }
    }
  }
}

TEST(Symmetry, InverseUndoes) {
  for (const Element& g : group(4, GroupKind::Full, true)) {
    ASSERT_EQ(compose(g, inverse(g)), Element{});
    ASSERT_EQ(compose(inverse(g), g), Element{});
  }
}

TEST(Symmetry, ActsOnSignaturesAsAGroup) {
  const int n = 3;
  const std::vector<Element> elements = group(n, GroupKind::Full, true);
  for (std::size_t i = 0; i < elements.size(); i += 5) {
    for (std::size_t j = 0; j < elements.size(); j += 7) {
      for (std::uint32_t s = 0; s < 256; ++s) {
        ASSERT_EQ(act(compose(elements[i], elements[j]), n, s), act(elements[i], n, act(elements[j], n, s)));
      }
    }
  }
}

TEST(Symmetry, ASignatureMovesWithItsCorners) {
  for (int n = 1; n <= kMaxSignatureDim; ++n) {
    for (const Element& g : group(n, GroupKind::Full, false)) {
      for (std::uint32_t v = 0; v < 1U << n; ++v) {
        ASSERT_EQ(act(g, n, 1U << v), 1U << g.corner(v));
      }
    }
  }
}

TEST(Symmetry, InversionComplementsTheSignature) {
  Element inversion;
  inversion.inverts = true;
  EXPECT_EQ(act(inversion, 1, 0b01), 0b10U);
  EXPECT_EQ(act(inversion, 2, 0b0001), 0b1110U);
  EXPECT_EQ(act(inversion, 3, 0), 255U);
  EXPECT_EQ(act(inversion, 5, 0), 0xFFFFFFFFU);
}

TEST(Symmetry, ReflectionAndInversionEachReverseOrientation) {
  Element mirror;
  mirror.flip = 1;
  mirror.det = determinant(mirror);
  Element inversion;
  inversion.inverts = true;
  EXPECT_FALSE(Element{}.reverses_orientation());
  EXPECT_TRUE(mirror.reverses_orientation());
  EXPECT_TRUE(inversion.reverses_orientation());
  EXPECT_FALSE(compose(mirror, inversion).reverses_orientation());
}

TEST(Symmetry, RefusesDimensionsThatItCannotDo) {
  for (const int n : {-1, 0, kMaxDim + 1}) {
    try {
      (void)group(n, GroupKind::Full, false);
      FAIL() << "accepted dimension " << n;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
      EXPECT_NE(std::string(error.what()).find("expected 1 to 8"), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW((void)act(Element{}, kMaxSignatureDim + 1, 0), Error);
}

}  // namespace
}  // namespace tegl::gen
