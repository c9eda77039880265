// SPDX-License-Identifier: BSD-3-Clause
//
// Faces around vertices, as the library counts them with sets of 64 bits, against lists of all faces: on contours, and
// on random complexes with faces in many simplices, contradicting orientations and stars that are too large for the
// sets.
#include "mesh/faces_of_stars.hpp"

#include <map>
#include <numeric>
#include <optional>
#include <random>
#include <set>

#include <gmock/gmock.h>

#include "base/radix_sort.hpp"
#include "fields.hpp"
#include "mesh/incidence_data.hpp"
#include "mesh/open_ridges.hpp"
#include "only_targets.hpp"
#include "tegl/check.hpp"
#include "tegl/extract.hpp"
#include "track/link_sides.hpp"
#include "track/sides_across.hpp"

namespace tegl {
namespace {

template <int N>
using SimplexList = std::vector<std::array<Index, N>>;

/// Random simplices with different vertices, a few of them repeated or reversed.
template <int N>
SimplexList<N> random_rows(std::size_t count, Index vertices, std::mt19937& random) {
  SimplexList<N> rows;
  std::vector<Index> all(vertices);
  std::iota(all.begin(), all.end(), Index{0});
  while (rows.size() < count) {
    std::array<Index, N> row;
    std::sample(all.begin(), all.end(), row.begin(), N, random);
    std::shuffle(row.begin(), row.end(), random);
    rows.push_back(row);
    if (random() % 8 == 0) rows.push_back(row);
    if (random() % 8 == 0) {
      std::swap(row[0], row[1]);
      rows.push_back(row);
    }
  }
  return rows;
}

template <int N>
SimplexList<N> rows_of_contour() {
  const auto image = test::noise<double, N>(6, 1);
  const Contour<N, double> contour = extract<double>(image.view(), 0.5);
  return {contour.simplices.begin(), contour.simplices.end()};
}

template <int N>
std::span<const Index> flat(const SimplexList<N>& rows) {
  return {rows.data()->data(), rows.size() * N};
}

template <int N>
Index vertices_of(const SimplexList<N>& rows) {
  Index most = 0;
  for (const auto& row : rows) most = std::max(most, *std::max_element(row.begin(), row.end()));
  return most + 1;
}

/// A face by its sorted vertices, with the number of its simplices and the sum of the orientations that they induce.
template <int N>
struct ListedFaces {
  std::map<std::array<Index, N - 1>, std::pair<int, int>> ridges;
  std::array<std::set<std::vector<Index>>, N + 1> by_size;
};

template <int N>
int sort_signed(std::array<Index, N>& row) {
  int sign = 1;
  for (int i = 0; i < N; ++i)
    for (int j = i + 1; j < N; ++j)
      if (row[j] < row[i]) {
        std::swap(row[i], row[j]);
        sign = -sign;
      }
  return sign;
}

/// The vertices of a simplex except one, ascending.
template <int N>
std::array<Index, N - 1> face_without(const std::array<Index, N>& row, int omitted) {
  std::array<Index, N - 1> face;
  for (int i = 0, k = 0; i < N; ++i)
    if (i != omitted) face[k++] = row[i];
  std::sort(face.begin(), face.end());
  return face;
}

template <int N>
ListedFaces<N> list_faces(const SimplexList<N>& rows) {
  ListedFaces<N> faces;
  std::multiset<std::array<Index, N>> simplices;
  for (auto row : rows) {
    const int sign = sort_signed<N>(row);
    for (int omitted = 0; omitted < N; ++omitted) {
      std::array<Index, N - 1> ridge;
      for (int i = 0, k = 0; i < N; ++i)
        if (i != omitted) ridge[k++] = row[i];
      auto& [count, balance] = faces.ridges[ridge];
      ++count;
      balance += omitted % 2 == 0 ? sign : -sign;
    }
    for (unsigned mask = 1; mask < 1u << N; ++mask) {
      std::vector<Index> face;
      for (int i = 0; i < N; ++i)
        if ((mask >> i & 1u) != 0) face.push_back(row[i]);
      faces.by_size[face.size()].insert(face);
    }
  }
  return faces;
}

template <int N>
void expect_faces_as_listed(const SimplexList<N>& rows) {
  const ListedFaces<N> faces = list_faces<N>(rows);
  const std::size_t vertices = vertices_of<N>(rows);
  std::int64_t euler = 0;
  for (std::size_t size = 1; size < N; ++size)
    euler += (size % 2 == 1 ? 1 : -1) * static_cast<std::int64_t>(faces.by_size[size].size());
  euler += (N % 2 == 1 ? 1 : -1) * static_cast<std::int64_t>(rows.size());  // repeated simplices count
  std::uint64_t boundary = 0;
  std::set<std::array<Index, N - 1>> open;
  for (const auto& [ridge, found] : faces.ridges) {
    boundary += found.first == 1 ? 1 : 0;
    if (found.second != 0) open.insert(ridge);
  }
  const detail::Stars stars = detail::make_stars<N>(flat<N>(rows), vertices, 1);
  for (const bool with_euler : {false, true}) {
    detail::FacesOfStars<N> counter(flat<N>(rows).data(), vertices, with_euler);
    detail::FaceCounts counts;
    std::set<std::array<Index, N - 1>> met;
    for (Index v = 0; v < vertices; ++v)
      counts += counter.visit(v, stars.of(v), [&](const auto& ridge) { EXPECT_TRUE(met.insert(ridge).second); });
    EXPECT_EQ(counts.boundary, boundary);
    EXPECT_EQ(counts.open, open.size());
    EXPECT_EQ(met, open);
    if (with_euler) {
      EXPECT_EQ(counts.euler, euler);
    }
  }
  for (const unsigned threads : {1u, 3u}) {
    std::vector<std::array<Index, N - 1>> met;
    const detail::FaceCounts counts = detail::find_open_ridges<N>(flat<N>(rows), vertices, threads, {},
                                                                  [&](const auto& ridge) { met.push_back(ridge); });
    EXPECT_EQ(counts.boundary, boundary);
    EXPECT_EQ(counts.open, open.size());
    EXPECT_THAT(met, testing::ElementsAreArray(open));
  }
}

/// The simplices with each (N-2)-face.
template <int N>
std::map<std::array<Index, N - 1>, std::vector<Index>> simplices_by_face(const SimplexList<N>& rows) {
  std::map<std::array<Index, N - 1>, std::vector<Index>> found;
  for (Index s = 0; s < rows.size(); ++s)
    for (int omitted = 0; omitted < N; ++omitted) found[face_without<N>(rows[s], omitted)].push_back(s);
  return found;
}

template <int N>
void expect_incidence_as_listed(const SimplexList<N>& rows) {
  const ListedFaces<N> faces = list_faces<N>(rows);
  const auto of_face = simplices_by_face<N>(rows);
  const std::size_t vertices = vertices_of<N>(rows);
  const auto incidence = detail::make_incidence<N>(flat<N>(rows), vertices, true, 1, {});
  for (Index s = 0; s < rows.size(); ++s)
    for (int i = 0; i < N; ++i) {
      const std::vector<Index>& here = of_face.at(face_without<N>(rows[s], i));
      const Index other = here.front() == s ? here.back() : here.front();
      EXPECT_EQ(incidence.across[s][i], here.size() == 1 ? kNoSimplex : here.size() == 2 ? other : kSeveralSimplices);
    }
  std::int64_t boundary = 0, several = 0, conflicts = 0;
  for (const auto& [ridge, found] : faces.ridges) {
    boundary += found.first == 1 ? 1 : 0;
    several += found.first > 2 ? 1 : 0;
    conflicts += found.first == 2 && found.second != 0 ? 1 : 0;
  }
  for (const detail::IrregularFaces& irregular : incidence.irregular) {
    boundary -= irregular.boundary;
    several -= irregular.several;
    conflicts -= irregular.conflicts;
  }
  EXPECT_EQ(boundary, 0);
  EXPECT_EQ(several, 0);
  EXPECT_EQ(conflicts, 0);
  if constexpr (N == 4) {
    std::size_t ends = 0;
    for (Index v = 0; v < vertices; ++v) ends += incidence.edges_of(v);
    EXPECT_EQ(ends, 2 * faces.by_size[2].size());
  }
}

/// Rows with ascending vertices, as the sweep lists them.
template <int N>
void expect_single_faces_as_listed(SimplexList<N> rows) {
  for (auto& row : rows) std::sort(row.begin(), row.end());
  const ListedFaces<N> faces = list_faces<N>(rows);
  const std::size_t vertices = vertices_of<N>(rows);
  const detail::Stars stars = detail::make_stars<N>(flat<N>(rows), vertices, 1);
  detail::SingleFaces<N> finder(rows, vertices);
  std::set<std::array<Index, N - 1>> met;
  for (Index v = 0; v < vertices; ++v)
    finder.visit(v, stars.of(v), [&](Index s, int omitted) {
      std::array<Index, N - 1> ridge;
      for (int i = 0, k = 0; i < N; ++i)
        if (i != omitted) ridge[k++] = rows[s][i];
      EXPECT_EQ(ridge[0], v);
      EXPECT_TRUE(met.insert(ridge).second);
    });
  std::set<std::array<Index, N - 1>> single;
  for (const auto& [ridge, found] : faces.ridges)
    if (found.first == 1) single.insert(ridge);
  EXPECT_EQ(met, single);
}

/// Whether the vertices on one side of v are connected by edges between them in common simplices.
template <int N>
bool is_side_connected(const SimplexList<N>& rows, std::span<const Index> star, Index v, bool above) {
  std::set<Index> all, reached;
  for (const Index s : star)
    for (const Index u : rows[s])
      if (u != v && (u > v) == above) all.insert(u);
  if (all.empty()) return false;
  reached.insert(*all.begin());
  for (bool grows = true; grows;) {
    grows = false;
    for (const Index s : star) {
      const auto is_met = [&](Index u) { return reached.count(u) != 0; };
      if (std::none_of(rows[s].begin(), rows[s].end(), is_met)) continue;
      for (const Index u : rows[s])
        if (all.count(u) != 0) grows = reached.insert(u).second || grows;
    }
  }
  return reached == all;
}

template <int N>
void expect_sides_as_defined(SimplexList<N> rows) {
  for (auto& row : rows) std::sort(row.begin(), row.end());
  const std::size_t vertices = vertices_of<N>(rows);
  const detail::Stars stars = detail::make_stars<N>(flat<N>(rows), vertices, 1);
  detail::LinkSides<N> sides(rows, vertices);
  std::size_t settled = 0;
  for (Index v = 0; v < vertices; ++v) {
    const bool is_connected =
        is_side_connected<N>(rows, stars.of(v), v, true) && is_side_connected<N>(rows, stars.of(v), v, false);
    std::set<Index> link;
    for (const Index s : stars.of(v)) link.insert(rows[s].begin(), rows[s].end());
    const bool found = sides.are_connected(v, stars.of(v));
    if (link.size() <= 56) {
      EXPECT_EQ(found, is_connected) << "vertex " << v;
      ++settled;
    } else {
      EXPECT_TRUE(!found || is_connected) << "vertex " << v;
    }
  }
  if (stars.first.back() < 20 * vertices) {
    EXPECT_GT(settled, 0u);
  }
}

/// Rows with ascending vertices. Sides that are found connected must be; at least `least` vertices must be decided.
void expect_sides_across_are_connected(SimplexList<4> rows, std::size_t least) {
  for (auto& row : rows) std::sort(row.begin(), row.end());
  const std::size_t vertices = vertices_of<4>(rows);
  const auto incidence = detail::make_incidence<4>(flat<4>(rows), vertices, false, 1, {});
  std::vector<Index> ranks(vertices);
  std::iota(ranks.begin(), ranks.end(), Index{0});
  std::vector<detail::StarSides> sides(vertices);
  detail::find_sides({rows.data(), incidence.across.data(), incidence.stars}, 0, ranks, sides);
  std::size_t decided = 0;
  for (Index v = 0; v < vertices; ++v) {
    const std::span<const Index> star = incidence.stars.of(v);
    const detail::StarSides& found = sides[v];
    if (!found.are_connected) continue;
    ++decided;
    EXPECT_TRUE(is_side_connected<4>(rows, star, v, true)) << "vertex " << v;
    EXPECT_TRUE(is_side_connected<4>(rows, star, v, false)) << "vertex " << v;
    int growth = 0;
    for (const Index s : star) growth += (rows[s].front() == v ? 1 : 0) - (rows[s].back() == v ? 1 : 0);
    EXPECT_EQ(found.growth, growth);
    EXPECT_LT(rows[found.below].front(), v);
    EXPECT_NE(std::find(rows[found.below].begin(), rows[found.below].end(), v), rows[found.below].end());
  }
  EXPECT_GE(decided, least);
}

template <class T>
class FacesOfStarsTest : public testing::Test {};
template <int N>
using Dimension = std::integral_constant<int, N>;
using Dimensions = testing::Types<Dimension<2>, Dimension<3>, Dimension<4>>;
TYPED_TEST_SUITE(FacesOfStarsTest, Dimensions);

TYPED_TEST(FacesOfStarsTest, AreThoseOfAListOnContours) {
  constexpr int N = TypeParam::value;
  test::with_all_targets([&] {
    const SimplexList<N> rows = rows_of_contour<N>();
    ASSERT_GT(rows.size(), 10u);
    expect_faces_as_listed<N>(rows);
    expect_incidence_as_listed<N>(rows);
    expect_single_faces_as_listed<N>(rows);
    expect_sides_as_defined<N>(rows);
    // scalar code, which the library uses also for SSSE3, decides none
    const bool has_words = (hwy::SupportedTargets() & (HWY_SCALAR | HWY_EMU128 | HWY_SSSE3)) == 0;
    if constexpr (N == 4) expect_sides_across_are_connected(rows, has_words ? vertices_of<4>(rows) / 4 : 0);
  });
}

TYPED_TEST(FacesOfStarsTest, AreThoseOfAListOnRandomComplexes) {
  constexpr int N = TypeParam::value;
  test::with_all_targets([&] {
    std::mt19937 random(1);
    for (int run = 0; run < 200; ++run) {
      const auto vertices = static_cast<Index>(N + random() % 12);
      const SimplexList<N> rows = random_rows<N>(1 + random() % 40, vertices, random);
      expect_faces_as_listed<N>(rows);
      expect_incidence_as_listed<N>(rows);
      expect_single_faces_as_listed<N>(rows);
      expect_sides_as_defined<N>(rows);
      if constexpr (N == 4) expect_sides_across_are_connected(rows, 0);
      if (testing::Test::HasFailure()) FAIL() << "run " << run;
    }
  });
}

TYPED_TEST(FacesOfStarsTest, AreThoseOfAListOnLargeStars) {
  constexpr int N = TypeParam::value;
  test::with_all_targets([&] {
    std::mt19937 random(2);
    // a vertex in every simplex, with up to 400 others around it
    for (const Index vertices : {55u, 60u, 62u, 64u, 66u, 70u, 400u}) {
      SimplexList<N> rows = random_rows<N>(5 * vertices, vertices, random);
      const Index centre = static_cast<Index>(random() % vertices);
      for (auto& row : rows)
        if (std::find(row.begin(), row.end(), centre) == row.end()) row[random() % N] = centre;
      expect_faces_as_listed<N>(rows);
      expect_incidence_as_listed<N>(rows);
      expect_single_faces_as_listed<N>(rows);
      expect_sides_as_defined<N>(rows);
      if (testing::Test::HasFailure()) FAIL() << vertices << " vertices";
    }
  });
}

/// Whether the triangles of a link are a sphere or a disc, by its definition: each edge in one or two triangles, the
/// triangles around each vertex connected, all connected, and the Euler characteristic.
bool is_sphere_or_disc(const SimplexList<4>& rows, std::span<const Index> star, Index v) {
  std::map<std::array<Index, 2>, std::vector<Index>> of_edge;
  std::set<Index> vertices;
  for (const Index s : star)
    for (int i = 0; i < 4; ++i) {
      if (rows[s][i] == v) continue;
      vertices.insert(rows[s][i]);
      std::array<Index, 2> edge{};
      for (int j = 0, k = 0; j < 4; ++j)
        if (j != i && rows[s][j] != v) edge[k++] = rows[s][j];
      std::sort(edge.begin(), edge.end());
      of_edge[edge].push_back(s);
    }
  // connected across edges, of those at u or of all
  const auto is_connected = [&](std::optional<Index> u) {
    const auto has = [&](Index s) { return !u || std::find(rows[s].begin(), rows[s].end(), *u) != rows[s].end(); };
    std::set<Index> all, reached;
    for (const Index s : star)
      if (has(s)) all.insert(s);
    reached.insert(*all.begin());
    for (bool grows = true; grows;) {
      grows = false;
      for (const auto& [edge, sides] : of_edge) {
        if (u && edge[0] != *u && edge[1] != *u) continue;
        if (std::none_of(sides.begin(), sides.end(), [&](Index s) { return reached.count(s) != 0; })) continue;
        for (const Index s : sides) grows = reached.insert(s).second || grows;
      }
    }
    return reached == all;
  };
  bool is_closed = true;
  for (const auto& [edge, sides] : of_edge) {
    if (sides.size() > 2) return false;
    is_closed = is_closed && sides.size() == 2;
  }
  if (!std::all_of(vertices.begin(), vertices.end(), is_connected) || !is_connected({})) return false;
  return vertices.size() + star.size() == of_edge.size() + (is_closed ? 2 : 1);
}

TEST(LinksOfTetrahedra, AreGoodByDefinition) {
  test::with_all_targets([&] {
    std::mt19937 random(4);
    std::size_t good = 0, bad = 0;
    const SimplexList<4> contour = rows_of_contour<4>();
    for (int run = 0; run < 60; ++run) {
      // few vertices; or a contour with some of its vertices identified and tetrahedra left out
      SimplexList<4> rows;
      if (run % 2 == 0) {
        rows = random_rows<4>(1 + random() % 12, static_cast<Index>(5 + random() % 4), random);
      } else {
        const Index from = static_cast<Index>(random() % 200), to = static_cast<Index>(random() % 200);
        for (std::size_t s = 0; s < 1500 && s < contour.size(); ++s) {
          std::array<Index, 4> row = contour[s];
          std::replace(row.begin(), row.end(), from, to);
          if (random() % 400 != 0 && !detail::is_collapsed<4>(row.data())) rows.push_back(row);
        }
      }
      const std::size_t vertices = vertices_of<4>(rows);
      const detail::Stars stars = detail::make_stars<4>(flat<4>(rows), vertices, 1);
      std::size_t expected = 0;
      for (Index v = 0; v < vertices; ++v)
        if (const auto star = stars.of(v); !star.empty()) {
          const bool is_good = is_sphere_or_disc(rows, star, v);
          expected += is_good ? 0 : 1;
          ++(is_good ? good : bad);
        }
      const std::vector<double> coordinates(4 * vertices, 0.0);
      EXPECT_EQ(check(3, flat<4>(rows), 4, coordinates, {1, {}}).bad_links, expected) << "run " << run;
    }
    EXPECT_GT(good, 500u);
    EXPECT_GT(bad, 200u);
  });
}

/// What `check` and the incidence find does not depend on the numbers of vertices and tetrahedra: by row of `rows`,
/// `others` has it at the place `place_of(s)`, with the vertices `vertex_of(v)`. Its other rows repeat a vertex.
template <class VertexOf, class PlaceOf>
void expect_equal_faces(const SimplexList<4>& rows, const SimplexList<4>& others, const VertexOf& vertex_of,
                        const PlaceOf& place_of) {
  const Index vertices = vertices_of<4>(rows), other_vertices = vertices_of<4>(others);
  const auto incidence = detail::make_incidence<4>(flat<4>(rows), vertices, true, 2, {});
  const auto other = detail::make_incidence<4>(flat<4>(others), other_vertices, true, 2, {});
  for (Index v = 0; v < vertices; ++v) {
    ASSERT_EQ(other.euler_above[vertex_of(v)], incidence.euler_above[v]) << "vertex " << v;
    ASSERT_EQ(other.edges_of(vertex_of(v)), incidence.edges_of(v)) << "vertex " << v;
  }
  for (Index s = 0; s < rows.size(); ++s)
    for (int i = 0; i < 4; ++i) {
      const Index across = incidence.across[s][i];
      ASSERT_EQ(other.across[place_of(s)][i], across < kSeveralSimplices ? place_of(across) : across) << s << ", " << i;
    }
  const MeshReport report = check(3, flat<4>(rows), 4, std::vector<double>(std::size_t{4} * vertices, 0.0));
  const MeshReport found = check(3, flat<4>(others), 4, std::vector<double>(std::size_t{4} * other_vertices, 0.0));
  EXPECT_EQ(found.euler, report.euler);
  EXPECT_EQ(found.bad_links, report.bad_links);
  EXPECT_EQ(found.boundary_simplices, report.boundary_simplices);
  EXPECT_EQ(found.nonmanifold_simplices, report.nonmanifold_simplices);
  EXPECT_EQ(found.orientation_conflicts, report.orientation_conflicts);
}

/// Of a contour that is a manifold, or has bad links as two of its vertices are identified.
std::array<SimplexList<4>, 2> contours_with_links() {
  const SimplexList<4> rows = rows_of_contour<4>();
  SimplexList<4> identified = rows;
  const Index to = rows.front()[0], from = rows[rows.size() / 2][0];
  for (auto& row : identified) std::replace(row.begin(), row.end(), from, to);
  return {rows, identified};
}

std::uint64_t count_bad_links(const SimplexList<4>& rows) {
  return check(3, flat<4>(rows), 4, std::vector<double>(std::size_t{4} * vertices_of<4>(rows), 0.0)).bad_links;
}

// Many vertices of a link then differ from its centre by more than 16 bits, and some by exactly 2^16.
TEST(LinksOfTetrahedra, DoNotDependOnNumbersOfVertices) {
  const auto vertex_of = [](Index v) { return 256 * v; };
  for (const SimplexList<4>& rows : contours_with_links()) {
    SimplexList<4> others = rows;
    std::size_t far = 0, exactly = 0;
    for (auto& row : others) {
      for (Index& v : row) v = vertex_of(v);
      for (const Index v : row)
        for (const Index u : row) {
          far += u > v && u - v >= 1u << 16 ? 1 : 0;
          exactly += u > v && u - v == 1u << 16 ? 1 : 0;
        }
    }
    EXPECT_GT(far, rows.size());  // of six edges per tetrahedron
    EXPECT_GT(exactly, 0u);
    test::with_all_targets([&] { expect_equal_faces(rows, others, vertex_of, [](Index s) { return s; }); });
  }
}

// The boundary of a 4-simplex; the only vertex above the fourth one is just too far for 16 bits. The fourth one begins
// a block of vertices, in which nothing before it is too far.
TEST(LinksOfTetrahedra, DoNotDependOnAVertexJustTooFar) {
  constexpr std::array<Index, 5> kNumbers{0, 1, 2, 1u << 16, 2u << 16};
  SimplexList<4> rows, others;
  for (Index omitted = 0; omitted < 5; ++omitted) {
    std::array<Index, 4> row;
    for (Index v = 0, k = 0; v < 5; ++v)
      if (v != omitted) row[k++] = v;
    if (omitted % 2 == 1) std::swap(row[0], row[1]);
    rows.push_back(row);
    for (Index& v : row) v = kNumbers[v];
    others.push_back(row);
  }
  test::with_all_targets([&] {
    expect_equal_faces(
        rows, others, [&](Index v) { return kNumbers[v]; }, [](Index s) { return s; });
  });
}

// Neighbours then have numbers with equal lower 16 bits.
TEST(LinksOfTetrahedra, DoNotDependOnNumbersOfTetrahedra) {
  constexpr Index kApart = 4;
  const auto place_of = [](Index s) { return s / kApart + (s % kApart << 16); };
  const auto contours = contours_with_links();
  EXPECT_EQ(count_bad_links(contours[0]), 0u);
  EXPECT_GT(count_bad_links(contours[1]), 0u);
  for (const SimplexList<4>& rows : contours) {
    SimplexList<4> others(std::size_t{kApart} << 16);
    ASSERT_LT(rows.size() / kApart, 1u << 16);
    for (Index s = 0; s < rows.size(); ++s) others[place_of(s)] = rows[s];
    test::with_all_targets([&] {
      expect_equal_faces(
          rows, others, [](Index v) { return v; }, place_of);
      expect_sides_across_are_connected(others, 0);
    });
  }
}

/// Suspension of a torus of 7 vertices and of a tetrahedron's boundary. The links of its two apexes are not connected,
/// but have the Euler characteristic of a sphere.
SimplexList<4> suspended_torus_and_sphere() {
  std::vector<std::array<Index, 3>> triangles;
  for (Index v = 0; v < 7; ++v) {
    triangles.push_back({v, (v + 1) % 7, (v + 3) % 7});
    triangles.push_back({v, (v + 3) % 7, (v + 2) % 7});
  }
  triangles.insert(triangles.end(), {{7, 8, 9}, {7, 10, 8}, {7, 9, 10}, {8, 10, 9}});
  SimplexList<4> rows;
  for (const auto& [a, b, c] : triangles) {
    rows.push_back({11, a, b, c});
    rows.push_back({12, a, c, b});
  }
  return rows;
}

// A tetrahedron around the torus with the lower 16 bits of one around the sphere would connect the two.
TEST(LinksOfTetrahedra, AreBadIfTetrahedraWithEqualLowerBitsConnectThem) {
  constexpr Index kApart = 2;
  const auto place_of = [](Index s) { return s / kApart + (s % kApart << 16); };
  SimplexList<4> rows = suspended_torus_and_sphere();
  EXPECT_EQ(count_bad_links(rows), 2u);
  std::mt19937 random(5);
  for (int run = 0; run < 8; ++run) {
    std::shuffle(rows.begin(), rows.end(), random);
    SimplexList<4> others((std::size_t{1} << 16) + rows.size());
    for (Index s = 0; s < rows.size(); ++s) others[place_of(s)] = rows[s];
    test::with_all_targets([&] {
      EXPECT_EQ(count_bad_links(others), 2u) << "run " << run;
      expect_equal_faces(
          rows, others, [](Index v) { return v; }, place_of);
    });
  }
}

/// A closed contour without faults, with a few, and with a simplex that repeats a vertex.
template <int N>
void expect_open_ridges_as_listed() {
  const auto image = test::noise<double, N>(N == 2 ? 24 : 10 - N, 1);
  const Contour<N, double> contour = extract<double>(image.view(), 0.5, {.close = true});
  SimplexList<N> rows(contour.simplices.begin(), contour.simplices.end());
  const auto find = [&] {
    return detail::find_open_ridges<N>(flat<N>(rows), contour.vertices.size(), 1, {}, [](const auto&) {});
  };
  EXPECT_EQ(find().open, 0u);
  rows.push_back(rows[3]);
  rows.back()[1] = rows.back()[0];
  EXPECT_EQ(find().open, 0u);
  rows.pop_back();
  std::swap(rows[rows.size() / 2][0], rows[rows.size() / 2][1]);  // reversed
  rows.push_back(rows[rows.size() / 3]);                          // twice
  rows.erase(rows.begin() + 1);                                   // missing
  EXPECT_GT(find().open, find().boundary);
  expect_faces_as_listed<N>(rows);
}

TEST(OpenRidges, AreThoseOfTheList) {
  expect_open_ridges_as_listed<2>();
  expect_open_ridges_as_listed<3>();
  expect_open_ridges_as_listed<4>();
  expect_open_ridges_as_listed<5>();
}

TEST(RadixSort, IsStableForAnyNumberOfThreads) {
  struct Item {
    std::uint64_t key;
    std::size_t number;
    bool operator==(const Item&) const = default;
  };
  std::mt19937_64 random(3);
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{1000}, std::size_t{300'000}})
    for (const unsigned bits : {3u, 20u, 64u}) {
      std::vector<Item> items;
      for (std::size_t i = 0; i < count; ++i) items.push_back({bits == 64 ? random() : random() % (1u << bits), i});
      std::vector<Item> expected = items;
      std::stable_sort(expected.begin(), expected.end(), [](const Item& a, const Item& b) { return a.key < b.key; });
      for (const unsigned threads : {1u, 2u, 3u, 0u}) {
        std::vector<Item> sorted = items;
        detail::sort_by_bits(
            sorted, bits, [](const Item& item) { return item.key; }, threads);
        EXPECT_TRUE(sorted == expected) << count << " items, " << bits << " bits, " << threads << " threads";
      }
    }
}

}  // namespace
}  // namespace tegl
