// SPDX-License-Identifier: BSD-3-Clause
//
// The emitted builders in GLSL and WGSL, executed as C++: included below are the emitted texts, the WGSL with its
// declarations rewritten by wgsl_to_cpp.cmake. Contours are compared with the C++ builders, decisions with exact
// integers.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "builder2.hpp"
#include "builder3.hpp"

// GLSL's array constructor differs from C++; the emitted text leaves it to these macros.
#define TEGL_ARRAY_BEGIN {
#define TEGL_ARRAY_END }

namespace tegl::test {
namespace {

using uint = std::uint32_t;
using u32 = std::uint32_t;
using f32 = float;

/// WGSL's function of the same name.
template <class Value>
Value select(Value if_false, Value if_true, bool condition) {
  return condition ? if_true : if_false;
}

namespace glsl {
#include "builder2.glsl"
#include "builder3.glsl"
}  // namespace glsl
namespace wgsl {
#include "builder2.wgsl.inc"
#include "builder3.wgsl.inc"
}  // namespace wgsl

/// Segments or triangles, and masks, as numbers.
using Numbers = std::vector<std::uint32_t>;

template <class Contour>
Numbers numbers_of_square(const Contour& contour) {
  return {contour.vertices, contour.vertices + 2 * contour.segments};
}

Numbers numbers_of_square(const builders::SquareContour& contour) {
  return {contour.segments[0], contour.segments[0] + 2 * contour.count};
}

template <class Contour>
Numbers numbers_of_cube(const Contour& contour) {
  Numbers numbers(contour.vertices, contour.vertices + 3 * contour.triangles);
  numbers.insert(numbers.end(), contour.masks, contour.masks + contour.own_vertices);
  return numbers;
}

Numbers numbers_of_cube(const builders::CubeContour& contour) {
  Numbers numbers(contour.vertices[0], contour.vertices[0] + 3 * contour.triangles);
  numbers.insert(numbers.end(), contour.masks, contour.masks + contour.own_vertices);
  return numbers;
}

Numbers square(unsigned signature, bool centre_high) {
  builders::SquareContour contour;
  builders::build_square(signature, centre_high, contour);
  return numbers_of_square(contour);
}

Numbers cube(unsigned signature, unsigned high_squares, unsigned centre) {
  builders::CubeContour contour;
  builders::build_cube(signature, high_squares, static_cast<builders::Choice>(centre), contour);
  return numbers_of_cube(contour);
}

TEST(ShaderBuilders, GiveTheSquaresOfTheCppBuilder) {
  for (unsigned signature = 0; signature < 16; ++signature)
    for (const bool high : {false, true}) {
      EXPECT_EQ(numbers_of_square(glsl::tegl_builder2_build(signature, high)), square(signature, high));
      EXPECT_EQ(numbers_of_square(wgsl::tegl_builder2_build(signature, high)), square(signature, high));
    }
}

TEST(ShaderBuilders, GiveTheCubesOfTheCppBuilder) {
  for (unsigned signature = 0; signature < 256; ++signature)
    for (unsigned high = 0; high < 64; ++high)
      for (const unsigned centre : {0u, 1u, 2u}) {
        const Numbers expected = cube(signature, high, centre);
        ASSERT_EQ(numbers_of_cube(glsl::tegl_builder3_build(signature, high, centre)), expected) << signature;
        ASSERT_EQ(numbers_of_cube(wgsl::tegl_builder3_build(signature, high, centre)), expected) << signature;
      }
  EXPECT_EQ(builders::kMaxTriangles, glsl::tegl_builder3_MAX_TRIANGLES);
  EXPECT_EQ(builders::kMaxOwnVertices, glsl::tegl_builder3_MAX_OWN_VERTICES);
}

enum Rule : unsigned { kLow, kHigh, kMean, kDecider };

/// The sign of the centre of a square, with the isovalue subtracted from the values: the mean, or the value at the
/// saddle (a d - b c) / (a + d - b - c) of the bilinear interpolant.
bool centre_is_high(const std::array<int, 4>& values, Rule rule) {
  const auto& [a, b, c, d] = values;
  if (rule == kMean) return a + b + c + d >= 0;
  if (rule != kDecider) return rule == kHigh;
  const int divisor = a + d - b - c, dividend = a * d - b * c;
  return divisor > 0 ? dividend >= 0 : dividend <= 0;
}

TEST(ShaderBuilders, DecideSquaresByTheRule) {
  constexpr int kIsovalue = 3;
  for (int code = 0; code < 9 * 9 * 9 * 9; ++code) {
    std::array<int, 4> values{code % 9 - 4, code / 9 % 9 - 4, code / 81 % 9 - 4, code / 729 - 4};
    unsigned signature = 0;
    std::array<float, 4> samples;
    for (unsigned v = 0; v < 4; ++v) {
      signature |= values[v] >= 0 ? 1u << v : 0u;
      samples[v] = static_cast<float>(values[v] + kIsovalue);
    }
    for (const Rule rule : {kLow, kHigh, kMean, kDecider}) {
      const Numbers expected =
          square(signature, builders::is_ambiguous_square(signature) && centre_is_high(values, rule));
      ASSERT_EQ(numbers_of_square(glsl::tegl_builder2_build_values(samples.data(), kIsovalue, rule)), expected) << code;
      ASSERT_EQ(numbers_of_square(wgsl::tegl_builder2_build_values(samples, kIsovalue, rule)), expected) << code;
    }
  }
}

TEST(ShaderBuilders, DecideTheSquaresOfACubeByTheRule) {
  std::mt19937 random(7);
  unsigned decided = 0;
  for (int n = 0; n < 20000; ++n) {
    std::array<int, 8> values;
    std::array<float, 8> samples;
    unsigned signature = 0;
    for (unsigned v = 0; v < 8; ++v) {
      values[v] = static_cast<int>(random() % 41) - 20;
      samples[v] = static_cast<float>(values[v]);
      signature |= values[v] >= 0 ? 1u << v : 0u;
    }
    for (const Rule rule : {kLow, kHigh, kMean, kDecider}) {
      unsigned high = 0;
      for (unsigned q = 0; q < 6; ++q) {
        const unsigned axis = q / 2, u = axis == 0 ? 2 : 1, v = axis == 2 ? 2 : 4, first = (q & 1u) << axis;
        const bool ambiguous = (builders::ambiguous_squares(signature) >> q & 1u) != 0;
        decided += ambiguous ? 1 : 0;
        if (ambiguous &&
            centre_is_high({values[first], values[first + u], values[first + v], values[first + u + v]}, rule))
          high |= 1u << q;
      }
      const Numbers expected = cube(signature, high, 0);
      ASSERT_EQ(glsl::tegl_builder3_high_squares(samples.data(), 0.0f, rule), high);
      ASSERT_EQ(wgsl::tegl_builder3_high_squares(samples, 0.0f, rule), high);
      ASSERT_EQ(numbers_of_cube(glsl::tegl_builder3_build_values(samples.data(), 0.0f, rule)), expected);
      ASSERT_EQ(numbers_of_cube(wgsl::tegl_builder3_build_values(samples, 0.0f, rule)), expected);
    }
  }
  EXPECT_GT(decided, 10000u);
}

}  // namespace
}  // namespace tegl::test
