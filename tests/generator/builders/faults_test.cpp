// SPDX-License-Identifier: BSD-3-Clause
//
// Copies of the emitted builders with one fault each (CMakeLists.txt): the checks of the other tests find every one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "builder_checks.hpp"
#include "meeting_cones.hpp"
#include "missing_axis.hpp"
#include "missing_barycentre.hpp"
#include "missing_cube.hpp"
#include "missing_neighbours.hpp"
#include "missing_repeats.hpp"
#include "reversed_regions.hpp"
#include "swapped_corners.hpp"
#include "swapped_cubes.hpp"
#include "swapped_ends.hpp"
#include "swapped_frame.hpp"
#include "swapped_map.hpp"
#include "swapped_pair.hpp"
#include "swapped_part.hpp"
#include "swapped_ring.hpp"
#include "swapped_squares.hpp"
#include "swapped_vertices.hpp"
#include "tesseract_checks.hpp"
#include "turned_copy.hpp"
#include "wrong_centre.hpp"
#include "wrong_centre_double.hpp"
#include "wrong_centre_edges.hpp"
#include "wrong_copy.hpp"
#include "wrong_corners.hpp"
#include "wrong_double.hpp"
#include "wrong_edges.hpp"
#include "wrong_end.hpp"
#include "wrong_filling.hpp"
#include "wrong_kind.hpp"
#include "wrong_mask.hpp"
#include "wrong_mean.hpp"
#include "wrong_nested_corner.hpp"
#include "wrong_own_vertices.hpp"
#include "wrong_plane.hpp"
#include "wrong_resolution.hpp"
#include "wrong_run.hpp"
#include "wrong_segment.hpp"
#include "wrong_side.hpp"
#include "wrong_sign.hpp"
#include "wrong_square.hpp"
#include "wrong_tetrahedron.hpp"
#include "wrong_triangle.hpp"

namespace tegl::test {
namespace {

// The contour of a builder in namespace `space`.
#define TEGL_SQUARE(space)                                \
  [](unsigned signature, bool centre_high) {              \
    space::SquareContour contour;                         \
    space::build_square(signature, centre_high, contour); \
    return contour;                                       \
  }
#define TEGL_CUBE(space)                                                                     \
  [](unsigned signature, unsigned high_squares, Choice centre) {                             \
    space::CubeContour contour;                                                              \
    space::build_cube(signature, high_squares, static_cast<space::Choice>(centre), contour); \
    return contour;                                                                          \
  }

TEST(FaultyBuilder, OfTheSquareIsFound) {
  EXPECT_NE(fault_of_squares(TEGL_SQUARE(builders::wrong_segment)), "");
  EXPECT_NE(fault_of_squares(TEGL_SQUARE(builders::edges::swapped_ring)), "");
  EXPECT_NE(fault_of_squares(TEGL_SQUARE(builders::edges::wrong_run)), "");
}

TEST(FaultyBuilder, OfTheCubeIsFound) {
  EXPECT_NE(fault_of_cubes(TEGL_CUBE(builders::edges::swapped_map)), "");
  EXPECT_NE(fault_of_cubes(TEGL_CUBE(builders::edges::wrong_corners)), "");
  EXPECT_NE(fault_of_cubes(TEGL_CUBE(builders::edges::wrong_sign)), "");
  EXPECT_NE(fault_of_cubes(TEGL_CUBE(builders::edges::missing_axis)), "");
  EXPECT_NE(fault_of_cubes(TEGL_CUBE(builders::edges::wrong_square)), "");
  EXPECT_NE(fault_of_cubes(TEGL_CUBE(builders::edges::wrong_end)), "");
  EXPECT_NE(fault_of_cubes(TEGL_CUBE(builders::edges::wrong_filling)), "");
  EXPECT_NE(fault_of_cubes(TEGL_CUBE(builders::edges::wrong_mask)), "");
  EXPECT_NE(fault_of_cubes(TEGL_CUBE(builders::edges::wrong_kind)), "");
  EXPECT_NE(fault_of_cubes(TEGL_CUBE(builders::wrong_triangle)), "");
  EXPECT_NE(fault_of_cubes(TEGL_CUBE(builders::wrong_resolution)), "");
  EXPECT_NE(fault_of_barycentric_cubes(TEGL_CUBE(builders::edges::barycentric::wrong_own_vertices)), "");
}

/// A builder with keys of its own type.
template <class Tesseract, class Key>
class Copied {
 public:
  explicit Copied(Triangulation triangulation = Triangulation::compact) : builder_(triangulation) {}
  auto size(const ResolvedKey& key) { return builder_.size(converted(key)); }
  builders::ResolvedView find(const ResolvedKey& key) { return converted(builder_.find(converted(key))); }
  builders::ResolvedView find(const ResolvedKey& key, const builders::ResolvedCubes::Lists& lists,
                              std::uint32_t apart) {
    return converted(builder_.find(converted(key), lists, apart));
  }
  static builders::ResolvedCubes::Lists lists_of(const ResolvedKey& key) { return Tesseract::lists_of(converted(key)); }

 private:
  static Key converted(const ResolvedKey& key) {
    return {key.squares, key.signature, key.low_cubes, key.high_cubes, key.tile};
  }
  template <class View>
  static builders::ResolvedView converted(const View& view) {
    return {view.simplices, view.simplex_count, view.own_vertices, view.masks};
  }

  Tesseract builder_;
};

/// Whether the checks find a fault among random tiles. Only tiles whose numbers differ from the right builder's are
/// checked, every second one with centres of squares and of the tile only.
template <class Builder>
bool is_found(Builder builder) {
  GeneralTesseract general;
  builders::ResolvedTesseract right;
  RandomKeys keys(4);
  for (int i = 0; i < 200000; ++i) {
    ResolvedKey key = keys();
    if (i % 2 == 0) key.low_cubes = key.high_cubes = 0;
    if (tesseract_numbers(builder, key) == tesseract_numbers(right, key) &&
        tesseract_numbers(builder, key, known_of_sigma(key)) == tesseract_numbers(right, key))
      continue;
    if (!fault_of_tesseract(builder, general, key, Triangulation::compact, false).empty()) return true;
  }
  return false;
}
#define TEGL_COPY(space, ...) Copied<builders::space::ResolvedTesseract, builders::space::ResolvedKey>(__VA_ARGS__)

TEST(FaultyBuilder, OfTheTesseractIsFound) {
  EXPECT_TRUE(is_found(builders::edges::swapped_cubes::ResolvedTesseract()));
  EXPECT_TRUE(is_found(builders::edges::swapped_squares::ResolvedTesseract()));
  EXPECT_TRUE(is_found(builders::edges::swapped_ends::ResolvedTesseract()));
  EXPECT_TRUE(is_found(builders::edges::wrong_plane::ResolvedTesseract()));
  EXPECT_TRUE(is_found(builders::edges::missing_neighbours::ResolvedTesseract()));
  EXPECT_TRUE(is_found(builders::edges::reversed_regions::ResolvedTesseract()));
  EXPECT_TRUE(is_found(builders::edges::missing_cube::ResolvedTesseract()));
  EXPECT_TRUE(is_found(builders::edges::swapped_corners::ResolvedTesseract()));
}

TEST(FaultyBuilder, OfTheTesseractWithItsArraysIsFound) {
  EXPECT_TRUE(is_found(TEGL_COPY(wrong_side)));
  EXPECT_TRUE(is_found(TEGL_COPY(swapped_vertices)));
  EXPECT_TRUE(is_found(TEGL_COPY(swapped_pair)));
  EXPECT_TRUE(is_found(TEGL_COPY(swapped_part)));
  EXPECT_TRUE(is_found(TEGL_COPY(wrong_tetrahedron)));
  EXPECT_TRUE(is_found(TEGL_COPY(swapped_frame)));
}

/// Cones of several components without the test that a hyperplane divides them: the topology is right, but cones meet.
TEST(FaultyBuilder, OfConesThatMeetIsFound) {
  GeneralTesseract general;
  const gen::CubeLattice lattice(4);
  const gen::EmbeddingProof proof(lattice.tile(4));
  builders::edges::meeting_cones::ResolvedTesseract wrong;
  builders::ResolvedTesseract right;
  RandomKeys keys(5);
  int found = 0;
  for (int i = 0; i < 200000 && found < 3; ++i) {
    ResolvedKey key = keys();
    key.low_cubes = key.high_cubes = 0;
    const auto view = wrong.find(key);
    if (!is_on_edges(view) || tesseract_numbers(wrong, key) == tesseract_numbers(right, key)) continue;
    EXPECT_EQ(fault_of_tesseract(wrong, general, key, Triangulation::compact, false), "");
    const std::string fault = fault_of_embedding(proof, key, view);
    if (fault.empty()) continue;
    EXPECT_EQ(text_of(key) + "simplices intersect for some positions", fault);
    ++found;
  }
  EXPECT_EQ(3, found);
}

/// Nested copies with the orientation of the copy around them. The right ones pass all checks.
TEST(FaultyBuilder, OfNestedCopiesIsFound) {
  GeneralTesseract general;
  builders::edges::turned_copy::ResolvedTesseract wrong;
  builders::ResolvedTesseract right;
  RandomKeys keys(6);
  int nested = 0, found = 0;
  for (int i = 0; i < 200000 && nested < 100; ++i) {
    ResolvedKey key = keys();
    key.low_cubes = key.high_cubes = 0;
    key.tile = Choice::separate;
    right.find(key);
    if (!right.is_nested()) continue;
    ++nested;
    EXPECT_EQ(fault_of_tesseract(right, general, key, Triangulation::compact, false), "");
    found += fault_of_tesseract(wrong, general, key, Triangulation::compact, false).empty() ? 0 : 1;
  }
  EXPECT_EQ(nested, 100);
  EXPECT_EQ(found, 100);
}

/// What is wrong with the masks of the first random tile whose numbers differ from the right builder's.
template <class Builder>
std::string fault_of_masks(Builder wrong, Triangulation triangulation) {
  builders::ResolvedTesseract right(triangulation);
  RandomKeys keys(4);
  for (int i = 0; i < 200000; ++i) {
    const ResolvedKey key = keys();
    if (tesseract_numbers(wrong, key) == tesseract_numbers(right, key)) continue;
    EXPECT_EQ(TesseractMasks(key, right.find(key), triangulation).fault(), "") << text_of(key);
    const builders::ResolvedView& view = wrong.find(key);
    return TesseractMasks(key, view, triangulation).fault();
  }
  return "no tesseract with other numbers";
}

/// Faults that change nothing but masks.
TEST(FaultyBuilder, OfMasksIsFound) {
  using testing::HasSubstr;
  using namespace builders::edges;
  constexpr Triangulation kCompact = Triangulation::compact, kBarycentric = Triangulation::barycentric;
  EXPECT_THAT(fault_of_masks(wrong_mean::ResolvedTesseract(), kCompact), HasSubstr("the mean of a cone has the mask"));
  EXPECT_THAT(fault_of_masks(wrong_edges::ResolvedTesseract(), kCompact), HasSubstr("mask"));
  EXPECT_THAT(fault_of_masks(TEGL_COPY(missing_barycentre, kBarycentric), kBarycentric),
              HasSubstr("the mean of a cone has the mask"));
  EXPECT_THAT(fault_of_masks(wrong_copy::ResolvedTesseract(), kCompact), HasSubstr("without the corners"));
  EXPECT_THAT(fault_of_masks(wrong_nested_corner::ResolvedTesseract(), kCompact), HasSubstr("a copy that"));
  EXPECT_THAT(fault_of_masks(wrong_double::ResolvedTesseract(), kCompact), HasSubstr("other than the"));
  EXPECT_THAT(fault_of_masks(wrong_centre::ResolvedTesseract(), kCompact), HasSubstr("other than the"));
  EXPECT_THAT(fault_of_masks(wrong_centre_edges::ResolvedTesseract(), kCompact), HasSubstr("other than the"));
  EXPECT_THAT(fault_of_masks(TEGL_COPY(wrong_centre_double, kBarycentric), kBarycentric), HasSubstr("a double of"));
  EXPECT_THAT(fault_of_masks(missing_repeats::ResolvedTesseract(), kCompact), HasSubstr("repeats 0 others; expected"));
}

}  // namespace
}  // namespace tegl::test
