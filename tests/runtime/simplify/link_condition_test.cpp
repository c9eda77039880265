// SPDX-License-Identifier: BSD-3-Clause
//
// The link condition on random links, against sets of all their faces.
#include "simplify/link_condition.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <type_traits>
#include <vector>

namespace tegl::detail {
namespace {

template <class Dimension>
class LinkConditions : public testing::Test {};
using Dimensions =
    testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(LinkConditions, Dimensions);

/// All faces of simplices, as sets of vertices.
class Faces {
 public:
  void add(const std::vector<Index>& simplex) {
    for (unsigned part = 1; part < 1u << simplex.size(); ++part) {
      std::set<Index> face;
      for (std::size_t i = 0; i < simplex.size(); ++i)
        if ((part >> i & 1u) != 0) face.insert(simplex[i]);
      all_.insert(face);
    }
  }
  [[nodiscard]] bool has(const std::set<Index>& face) const { return all_.count(face) != 0; }
  [[nodiscard]] const std::set<std::set<Index>>& all() const { return all_; }

 private:
  std::set<std::set<Index>> all_;
};

TYPED_TEST(LinkConditions, AgreesWithTheSetsOfFaces) {
  constexpr int N = TypeParam::value;
  std::mt19937 random(N);
  LinkCondition<N> condition;
  const auto draw = [&](std::size_t size, Index vertices) {
    std::set<Index> drawn;
    while (drawn.size() < size) drawn.insert(1000 * std::uniform_int_distribution<Index>(0, vertices - 1)(random));
    std::vector<Index> simplex(drawn.begin(), drawn.end());
    std::shuffle(simplex.begin(), simplex.end(), random);
    return simplex;
  };
  const auto face_of = [](const std::vector<Index>& simplex) {
    typename LinkCondition<N>::Face face{};
    std::copy(simplex.begin(), simplex.end(), face.begin());
    return face;
  };
  int held = 0, failed = 0;
  for (int round = 0; round < 4000; ++round) {
    const Index vertices = std::uniform_int_distribution<Index>(N, 6 * N)(random);
    Faces of_uv, of_u, of_v;
    condition.clear(100);
    for (int i = std::uniform_int_distribution<int>(0, 8)(random); i-- > 0;) {
      const std::vector<Index> simplex = draw(N - 2, vertices);
      of_uv.add(simplex);
      condition.add_to_uv(face_of(simplex));
    }
    condition.complete_uv();
    for (int i = std::uniform_int_distribution<int>(0, 4)(random); i-- > 0;) {
      const std::vector<Index> simplex = draw(N - 1, vertices);
      of_u.add(simplex);
      condition.add_to_u(face_of(simplex));
    }
    bool holds = true;
    for (int i = std::uniform_int_distribution<int>(0, 4)(random); i-- > 0;) {
      const std::vector<Index> simplex = draw(N - 1, vertices);
      of_v.add(simplex);
      holds = condition.add_to_v(face_of(simplex)) && holds;
    }
    const bool expected = std::none_of(of_u.all().begin(), of_u.all().end(),
                                       [&](const auto& face) { return of_v.has(face) && !of_uv.has(face); });
    ASSERT_EQ(holds, expected) << round;
    (expected ? held : failed) += 1;
  }
  EXPECT_GT(held, 400);
  EXPECT_GT(failed, 400);
}

TEST(FewVertices, KeepsANumberForEachVertexUntilItIsCleared) {
  FewVertices few;
  std::mt19937 random(1);
  for (const std::size_t size : {3, 40, 7, 500, 2}) {
    SCOPED_TRACE(size);
    few.clear(size);
    std::set<Index> vertices;
    while (vertices.size() < size) vertices.insert(static_cast<Index>(random()));
    std::uint32_t next = 0;
    for (const Index v : vertices) {
      EXPECT_EQ(few[v], FewVertices::kNew);
      few[v] = next++;
    }
    next = 0;
    for (const Index v : vertices) EXPECT_EQ(few[v], next++);
  }
}

}  // namespace
}  // namespace tegl::detail
