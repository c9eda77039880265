// SPDX-License-Identifier: BSD-3-Clause
//
// WideUint against built-in arithmetic, and its errors.
#include "base/wide_uint.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <random>

#include "base/error.hpp"

namespace tegl::gen {
namespace {

constexpr std::uint64_t kLargest = std::numeric_limits<std::uint64_t>::max();

TEST(WideUint, AgreesWithBuiltInArithmeticWhereThatReaches) {
  std::mt19937_64 random(20240229);
  for (int i = 0; i < 10'000; ++i) {
    const std::uint64_t a = random() >> (1 + random() % 63);
    const std::uint64_t b = random() >> (1 + random() % 63);
    WideUint sum{a};
    sum += WideUint{b};
    ASSERT_EQ(sum, WideUint{a + b});
    const std::uint64_t small = (b >> 32) + 1;
    WideUint quotient{a};
    ASSERT_EQ(quotient.divide(small), a % small);
    ASSERT_EQ(quotient, WideUint{a / small});
    ASSERT_EQ(WideUint{a} < WideUint{b}, a < b);
    ASSERT_EQ(WideUint{a}.to_decimal(), std::to_string(a));
  }
}

TEST(WideUint, MultiplicationIsUndoneByDivision) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 2'000; ++i) {
    WideUint product{random()};
    const WideUint start = product;
    std::vector<std::uint64_t> factors;
    for (int k = 0; k < 7; ++k) {
      factors.push_back((random() >> 32) + 1);
      product *= factors.back();
    }
    for (const std::uint64_t factor : factors) {
      product = product.exactly_divided_by(factor);
    }
    ASSERT_EQ(product, start);
  }
}

TEST(WideUint, MultipliesByFactorsOfMoreThan32Bits) {
  WideUint square{kLargest};
  square *= kLargest;
  EXPECT_EQ(square.to_decimal(), "340282366920938463426481119284349108225");
}

TEST(WideUint, WritesPowersOfTwoInDecimal) {
  EXPECT_EQ(WideUint{}.to_decimal(), "0");
  EXPECT_EQ(WideUint::power_of_two(0).to_decimal(), "1");
  EXPECT_EQ(WideUint::power_of_two(64).to_decimal(), "18446744073709551616");
  EXPECT_EQ(WideUint::power_of_two(256).to_decimal(),
            "115792089237316195423570985008687907853269984665640564039457584007913129639936");
  EXPECT_EQ(WideUint{1'000'000'000}.to_decimal(), "1000000000") << "zeros inside and after a group of nine digits";
  EXPECT_EQ(WideUint{5'000'000'070'000'000'003}.to_decimal(), "5000000070000000003");
}

TEST(WideUint, CarriesThroughEveryLimb) {
  WideUint all_ones = WideUint::power_of_two(WideUint::kBits - 1);
  for (int i = 0; i < WideUint::kBits - 1; ++i) {
    all_ones += WideUint::power_of_two(i);
  }
  WideUint sum{1};
  for (int i = 0; i < WideUint::kBits; ++i) {
    EXPECT_EQ(sum, WideUint::power_of_two(i));
    EXPECT_LT(sum, all_ones.exactly_divided_by(1)) << i;
    if (i + 1 < WideUint::kBits) {
      sum += sum;
    }
  }
  EXPECT_THROW(all_ones += WideUint{1}, Error);
}

TEST(WideUint, ThrowsInsteadOfWrappingAround) {
  WideUint half = WideUint::power_of_two(WideUint::kBits - 1);
  WideUint sum = half;
  EXPECT_THROW(sum += half, Error);
  WideUint product = half;
  EXPECT_THROW(product *= 2, Error);
  product = WideUint::power_of_two(WideUint::kBits - 32);
  EXPECT_THROW(product *= std::uint64_t{1} << 32, Error);
  EXPECT_THROW((void)WideUint::power_of_two(WideUint::kBits), Error);
  EXPECT_THROW((void)WideUint::power_of_two(-1), Error);
}

TEST(WideUint, RefusesInexactDivisionAndDivisorsItCannotDo) {
  EXPECT_THROW((void)WideUint{7}.exactly_divided_by(2), Error);
  WideUint seven{7};
  EXPECT_THROW(seven.divide(0), Error);
  EXPECT_THROW(seven.divide(std::uint64_t{1} << 32), Error);
}

}  // namespace
}  // namespace tegl::gen
