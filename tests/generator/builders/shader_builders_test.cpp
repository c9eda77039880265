// SPDX-License-Identifier: BSD-3-Clause
//
// The emitted builders in GLSL and WGSL, executed as C++: included below are the emitted texts, the WGSL with its
// declarations rewritten by wgsl_to_cpp.cmake. Contours are compared with the C++ builders, decisions with exact
// integers.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

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

// The builder of the cube with one fault each (CMakeLists.txt): a word of its table, the rule of the decider.
namespace glsl_wrong_word {
#include "glsl_wrong_word.glsl"
}  // namespace glsl_wrong_word
namespace glsl_wrong_decider {
#include "glsl_wrong_decider.glsl"
}  // namespace glsl_wrong_decider
namespace wgsl_wrong_word {
#include "wgsl_wrong_word.wgsl.inc"
}  // namespace wgsl_wrong_word
namespace wgsl_wrong_decider {
#include "wgsl_wrong_decider.wgsl.inc"
}  // namespace wgsl_wrong_decider

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

enum Rule : unsigned { kLow, kHigh, kMean, kDecider };

/// The first cube that differs from the C++ builder's; "" if none does.
template <class Build>
std::string fault_of_shader_cubes(const Build& build) {
  for (unsigned signature = 0; signature < 256; ++signature)
    for (unsigned high = 0; high < 64; ++high)
      for (const unsigned centre : {0u, 1u, 2u})
        if (numbers_of_cube(build(signature, high, centre)) != cube(signature, high, centre))
          return fmt::format("signature {}, squares {:#x}, centre {}", signature, high, centre);
  return "";
}

TEST(ShaderBuilders, GiveTheCubesOfTheCppBuilder) {
  EXPECT_EQ(fault_of_shader_cubes(glsl::tegl_builder3_build), "");
  EXPECT_EQ(fault_of_shader_cubes(wgsl::tegl_builder3_build), "");
  EXPECT_EQ(builders::kMaxTriangles, glsl::tegl_builder3_MAX_TRIANGLES);
  EXPECT_EQ(builders::kMaxOwnVertices, glsl::tegl_builder3_MAX_OWN_VERTICES);
}

TEST(ShaderBuilders, AWrongWordOfTheCubeIsFound) {
  EXPECT_EQ(fault_of_shader_cubes(glsl_wrong_word::tegl_builder3_build), "signature 3, squares 0x0, centre 0");
  EXPECT_EQ(fault_of_shader_cubes(wgsl_wrong_word::tegl_builder3_build), "signature 3, squares 0x0, centre 0");
  std::array<float, 8> values{1, 1, -1, -1, -1, -1, -1, -1};
  const Numbers expected = cube(3, 0, 0);
  EXPECT_EQ(numbers_of_cube(glsl::tegl_builder3_build_values(values.data(), 0.0f, kLow)), expected);
  EXPECT_NE(numbers_of_cube(glsl_wrong_word::tegl_builder3_build_values(values.data(), 0.0f, kLow)), expected);
  EXPECT_NE(numbers_of_cube(wgsl_wrong_word::tegl_builder3_build_values(values, 0.0f, kLow)), expected);
}

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

/// What a rule decides for a cube of given values.
struct DecidedCube {
  std::array<float, 8> values;
  unsigned signature = 0, high_squares = 0;
  Rule rule = kLow;
};

/// Calls visit(decided) for 20 000 random cubes by each rule. Returns the number of ambiguous squares.
template <class Visit>
unsigned visit_decided_cubes(const Visit& visit) {
  std::mt19937 random(7);
  unsigned decided = 0;
  for (int n = 0; n < 20000; ++n) {
    std::array<int, 8> values;
    DecidedCube of;
    for (unsigned v = 0; v < 8; ++v) {
      values[v] = static_cast<int>(random() % 41) - 20;
      of.values[v] = static_cast<float>(values[v]);
      of.signature |= values[v] >= 0 ? 1u << v : 0u;
    }
    for (const Rule rule : {kLow, kHigh, kMean, kDecider}) {
      of.rule = rule;
      of.high_squares = 0;
      for (unsigned q = 0; q < 6; ++q) {
        const unsigned axis = q / 2, u = axis == 0 ? 2 : 1, v = axis == 2 ? 2 : 4, first = (q & 1u) << axis;
        const bool ambiguous = (builders::ambiguous_squares(of.signature) >> q & 1u) != 0;
        decided += ambiguous ? 1 : 0;
        if (ambiguous &&
            centre_is_high({values[first], values[first + u], values[first + v], values[first + u + v]}, rule))
          of.high_squares |= 1u << q;
      }
      visit(of);
    }
  }
  return decided;
}

TEST(ShaderBuilders, DecideTheSquaresOfACubeByTheRule) {
  const unsigned decided = visit_decided_cubes([](const DecidedCube& of) {
    std::array<float, 8> values = of.values;
    const Numbers expected = cube(of.signature, of.high_squares, 0);
    ASSERT_EQ(glsl::tegl_builder3_high_squares(values.data(), 0.0f, of.rule), of.high_squares);
    ASSERT_EQ(wgsl::tegl_builder3_high_squares(values, 0.0f, of.rule), of.high_squares);
    ASSERT_EQ(numbers_of_cube(glsl::tegl_builder3_build_values(values.data(), 0.0f, of.rule)), expected);
    ASSERT_EQ(numbers_of_cube(wgsl::tegl_builder3_build_values(values, 0.0f, of.rule)), expected);
  });
  EXPECT_GT(decided, 10000u);
}

/// Only decisions by the decider are wrong, and so are contours.
TEST(ShaderBuilders, AWrongDeciderIsFound) {
  namespace glsl_wrong = glsl_wrong_decider;
  namespace wgsl_wrong = wgsl_wrong_decider;
  std::array<int, 4> wrong_glsl{}, wrong_wgsl{};  // by rule
  int wrong_contours = 0;
  visit_decided_cubes([&](const DecidedCube& of) {
    std::array<float, 8> values = of.values;
    const unsigned by_glsl = glsl_wrong::tegl_builder3_high_squares(values.data(), 0.0f, of.rule);
    const unsigned by_wgsl = wgsl_wrong::tegl_builder3_high_squares(values, 0.0f, of.rule);
    wrong_glsl[of.rule] += by_glsl != of.high_squares ? 1 : 0;
    wrong_wgsl[of.rule] += by_wgsl != of.high_squares ? 1 : 0;
    const Numbers contour = numbers_of_cube(glsl_wrong::tegl_builder3_build_values(values.data(), 0.0f, of.rule));
    ASSERT_EQ(numbers_of_cube(wgsl_wrong::tegl_builder3_build_values(values, 0.0f, of.rule)), contour);
    wrong_contours += contour != cube(of.signature, of.high_squares, 0) ? 1 : 0;
  });
  EXPECT_GT(wrong_glsl[kDecider], 1000);
  EXPECT_GT(wrong_contours, 1000);
  EXPECT_EQ(wrong_wgsl, wrong_glsl);
  EXPECT_EQ(wrong_glsl[kLow] + wrong_glsl[kHigh] + wrong_glsl[kMean], 0);
}

}  // namespace
}  // namespace tegl::test
