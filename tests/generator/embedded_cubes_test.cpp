// SPDX-License-Identifier: BSD-3-Clause
//
// The compiled tables of cubes with resolved ambiguities do not intersect themselves: by the proof, which reads
// triangles and masks only; by sampled positions, in exact integers, which share nothing with it; faults.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "cubes/cube_certificate.hpp"
#include "cubes/cube_embedding.hpp"
#include "tegl/generated/tables.hpp"

namespace tegl::gen {
namespace {

using tables::kTile3Resolved;

struct List {
  std::string name;
  CubeTriangles triangles;
  std::vector<std::uint32_t> masks;

  [[nodiscard]] bool has_tunnel() const {  // the only surfaces with three or more vertices on rays
    return std::count_if(masks.begin(), masks.end(), is_on_ray) > 2;
  }
};

/// The lists of kTile3Resolved, by entry and choice.
std::vector<List> compact_lists() {
  std::vector<List> result;
  for (std::uint32_t s = 0; s < 256; ++s) {
    const auto resolutions = 1u << std::popcount(unsigned{kTile3Resolved.ambiguous_squares[s]});
    for (std::uint32_t r = 0; r < resolutions; ++r) {
      const tables::ResolvedEntry& entry = kTile3Resolved.entries[kTile3Resolved.first_entry[s] + r];
      for (const tables::ResolvedList* from : {&entry.separate, &entry.low, &entry.high}) {
        List& list = result.emplace_back();
        list.name = fmt::format("cube of signature {}, resolution {}", s, r);
        for (std::size_t t = 0; t < from->triangle_count; ++t) {
          const std::uint8_t* const v = kTile3Resolved.triangles + 3 * (from->first_triangle + t);
          list.triangles.push_back({v[0], v[1], v[2]});
        }
        list.masks.assign(kTile3Resolved.masks + from->first_mask,
                          kTile3Resolved.masks + from->first_mask + from->own_vertices);
      }
    }
  }
  return result;
}

/// The lists of resolved keys in the table of 3D images. Barycentres have the edges of their triangles as masks.
std::vector<List> lists_by_key(Triangulation triangulation) {
  const tables::TileTable& table = tables::variant_table(3, triangulation).tile;
  std::vector<List> result;
  for (unsigned s = 0; s < 256; ++s) {
    if (!tables::kAmbiguous3[s]) continue;
    const auto resolutions = 1u << std::popcount(unsigned{kTile3Resolved.ambiguous_squares[s]});
    for (unsigned variant = 1; variant < 1 + 3 * resolutions; ++variant) {
      const tables::List& from = table.lists[table.list_of[s | variant << 8]];
      List& list = result.emplace_back();
      list.name = fmt::format("key {:#x}", s | variant << 8);
      list.masks.resize(from.cone_vertices);
      for (std::size_t t = 0; t < from.simplex_count; ++t) {
        const std::uint8_t* const v = table.simplices + 3 * (from.first_simplex + t);
        list.triangles.push_back({v[0], v[1], v[2]});
        if (v[0] >= 12 && v[0] < 12 + from.cone_vertices) list.masks[v[0] - 12u] |= 1u << (8 + v[1]) | 1u << (8 + v[2]);
      }
      for (std::size_t j = 0; j < from.side_vertices; ++j)
        list.masks.push_back(static_cast<std::uint32_t>(table.side_masks[from.first_side + j]));
    }
  }
  return result;
}

using Point = std::array<std::int64_t, 3>;

std::int64_t orientation(const Point& a, const Point& b, const Point& c, const Point& d) {
  std::array<Point, 3> rows;
  for (std::size_t i = 0; i < 3; ++i) rows[0][i] = b[i] - a[i], rows[1][i] = c[i] - a[i], rows[2][i] = d[i] - a[i];
  return rows[0][0] * (rows[1][1] * rows[2][2] - rows[1][2] * rows[2][1]) -
         rows[0][1] * (rows[1][0] * rows[2][2] - rows[1][2] * rows[2][0]) +
         rows[0][2] * (rows[1][0] * rows[2][1] - rows[1][1] * rows[2][0]);
}

int sign_of(std::int64_t x) { return (x > 0) - (x < 0); }

/// Whether a segment crosses the inside of a triangle.
bool crosses(const Point& from, const Point& to, const std::array<Point, 3>& t) {
  if (sign_of(orientation(t[0], t[1], t[2], from)) * sign_of(orientation(t[0], t[1], t[2], to)) != -1) return false;
  const int first = sign_of(orientation(from, to, t[0], t[1]));
  return first != 0 && first == sign_of(orientation(from, to, t[1], t[2])) &&
         first == sign_of(orientation(from, to, t[2], t[0]));
}

/// Random positions of all vertices of a list whose own vertices are on rays or, with equal weights, means.
class Positions {
 public:
  explicit Positions(std::uint32_t seed) : random_(seed) {}

  std::vector<Point> draw(const List& list) {
    std::vector<Point> points;
    for (const auto& [a, b] : frame_.cube().edges) {
      const std::int64_t t = position();
      Point& point = points.emplace_back();
      for (std::size_t i = 0; i < 3; ++i)
        point[i] = kScale * (ray_to_corner(a)[i] * (kSteps - t) + ray_to_corner(b)[i] * t);
    }
    for (const std::uint32_t mask : list.masks) {
      Point point{};
      const std::int64_t level = position();
      if (is_on_ray(mask)) {
        for (std::size_t i = 0; i < 3; ++i) point[i] = kScale * level * ray_of(mask)[i];
      } else {
        const auto count = std::popcount(mask >> 8 & 0xfffu);
        for (std::size_t e = 0; e < 12; ++e)
          for (std::size_t i = 0; i < 3; ++i)
            if ((mask >> (8 + e) & 1u) != 0) point[i] += points[e][i] / count;
      }
      points.push_back(point);
    }
    return points;
  }

  /// Whether an edge of a triangle crosses another triangle.
  static bool intersect(const List& list, const std::vector<Point>& points) {
    for (const CubeTriangle& t : list.triangles)
      for (const CubeTriangle& u : list.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
          const std::uint8_t a = t[i], b = t[(i + 1) % 3];
          if (std::find(u.begin(), u.end(), a) != u.end() || std::find(u.begin(), u.end(), b) != u.end()) continue;
          if (crosses(points[a], points[b], {points[u[0]], points[u[1]], points[u[2]]})) return true;
        }
    return false;
  }
  bool may_intersect(const List& list, int tries) {
    for (int i = 0; i < tries; ++i)
      if (intersect(list, draw(list))) return true;
    return false;
  }

 private:
  static constexpr std::int64_t kSteps = 256;
  static constexpr std::int64_t kScale = 2520;  ///< divisible by 1 to 10, and almost by 12

  /// Uniform, or near an end.
  std::int64_t position() {
    const std::int64_t near = 1 + random_() % 8;
    const auto kind = random_() % 3;
    return kind == 0 ? 1 + random_() % (kSteps - 1) : kind == 1 ? near : kSteps - near;
  }

  CubeFrame frame_;
  std::mt19937 random_;
};

void expect_proved(const std::vector<List>& lists, std::size_t count) {
  CubeListCertifier certifier;
  for (const List& list : lists) EXPECT_NO_THROW(certifier.certify(list.triangles, list.masks, list.name)) << list.name;
  EXPECT_EQ(certifier.proved(), count);
}

TEST(EmbeddedCubes, EveryListIsProved) {
  expect_proved(compact_lists(), 656 * 3);
  for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric}) {
    const std::vector<List> lists = lists_by_key(triangulation);
    EXPECT_GT(lists.size(), 1500u);
    expect_proved(lists, lists.size());
  }
}

TEST(EmbeddedCubes, NoListIntersectsItselfAtSampledPositions) {
  Positions positions(1);
  std::size_t tunnels = 0;
  for (const List& list : compact_lists()) {
    tunnels += list.has_tunnel() ? 1 : 0;
    EXPECT_FALSE(positions.may_intersect(list, list.masks.empty() ? 5 : 50)) << list.name;
  }
  EXPECT_EQ(tunnels, 324u);  // as in ResolvedCube.EveryEntryIsCertifiedAndIsTheSurfaceThatTheBuilderFinds
  for (const List& list : lists_by_key(Triangulation::barycentric))
    EXPECT_FALSE(positions.may_intersect(list, 5)) << list.name;
}

/// The reason why a list is not certified; "" if it is.
std::string fault_of(const List& list) {
  try {
    CubeListCertifier().certify(list.triangles, list.masks, list.name);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(EmbeddedCubes, AnExchangedChordOfATunnelIsFoundByName) {
  Positions positions(2);
  std::size_t exchanged = 0, found = 0, seen = 0;
  for (const List& list : compact_lists()) {
    if (!list.has_tunnel()) continue;
    for (std::size_t i = 0; i < list.triangles.size(); i += 3)
      for (std::size_t j = 0; j < list.triangles.size(); ++j)
        for (std::size_t k = 0; k < 3; ++k) {
          // triangles (a, b, c) and (b, a, d)
          const CubeTriangle &t = list.triangles[i], &u = list.triangles[j];
          const std::uint8_t a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
          const auto at = static_cast<std::size_t>(std::find(u.begin(), u.end(), b) - u.begin());
          if (at == 3 || u[(at + 1) % 3] != a) continue;
          List changed = list;
          changed.triangles[i] = {c, u[(at + 2) % 3], b};
          changed.triangles[j] = {u[(at + 2) % 3], c, a};
          ++exchanged;
          const std::string fault = fault_of(changed);
          if (fault.empty()) {
            EXPECT_FALSE(positions.may_intersect(changed, 20)) << list.name;
            continue;
          }
          ++found;
          EXPECT_EQ(fault.find(list.name), 0u) << fault;
          seen += positions.may_intersect(changed, 20) ? 1 : 0;
        }
  }
  // Some exchanged chords give another surface that is embedded. Of the others, samples confirm most.
  EXPECT_GT(exchanged, 1000u);
  EXPECT_GT(found, 500u);
  EXPECT_GT(seen, found / 2);
}

TEST(EmbeddedCubes, AVertexOnTheOppositeRayIsFoundByName) {
  std::size_t changes = 0;
  for (const List& list : compact_lists()) {
    if (!list.has_tunnel()) continue;
    for (std::size_t j = 0; j < list.masks.size(); ++j) {
      if (!is_on_ray(list.masks[j])) continue;
      List changed = list;
      changed.masks[j] = 0;
      for (unsigned v = 0; v < 8; ++v) changed.masks[j] |= (list.masks[j] >> v & 1u) << (7 - v);
      EXPECT_EQ(fault_of(changed).find(list.name), 0u);
      ++changes;
    }
  }
  EXPECT_GT(changes, 3 * 324u - 1);
}

TEST(EmbeddedCubes, AFlatTriangleIsFound) {
  // The vertices of a square's two rays and of its own ray are on a line for some levels.
  const CubeFrame frame;
  const std::vector<std::uint32_t> masks = {0b00000001, 0b00001000, 0b00001111};
  EXPECT_FALSE(CubeEmbedding(frame, masks).is_embedded({{12, 13, 14}}));
  const std::vector<std::uint32_t> apart = {0b00000001, 0b00001000, 0b01000000};
  EXPECT_TRUE(CubeEmbedding(frame, apart).is_embedded({{12, 13, 14}}));
}

TEST(EmbeddedCubes, ComplementsOfTunnelsHaveTheSameTriangles) {
  // An entry's complement: all corners and all ambiguous squares inverted, and low exchanged with high.
  const auto as_set = [](const tables::ResolvedList& list, bool reversed) {
    std::multiset<std::vector<std::uint32_t>> result;
    for (std::size_t t = 0; t < list.triangle_count; ++t) {
      const std::uint8_t* const v = kTile3Resolved.triangles + 3 * (list.first_triangle + t);
      std::array<std::uint32_t, 3> triangle;
      for (std::size_t i = 0; i < 3; ++i)
        triangle[i] = v[i] < 12 ? v[i] : 0x100u + kTile3Resolved.masks[list.first_mask + v[i] - 12u];
      if (reversed) std::swap(triangle[1], triangle[2]);
      std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
      result.insert({triangle.begin(), triangle.end()});
    }
    return result;
  };
  std::size_t tunnels = 0;
  for (std::uint32_t s = 0; s < 256; ++s) {
    const auto last = (1u << std::popcount(unsigned{kTile3Resolved.ambiguous_squares[s]})) - 1;
    for (std::uint32_t r = 0; r <= last; ++r) {
      const tables::ResolvedEntry& entry = kTile3Resolved.entries[kTile3Resolved.first_entry[s] + r];
      const tables::ResolvedEntry& other = kTile3Resolved.entries[kTile3Resolved.first_entry[255 - s] + last - r];
      for (const auto& [list, complement] : {std::pair{&entry.low, &other.high}, std::pair{&entry.high, &other.low}}) {
        const auto triangles = as_set(*list, false), reversed = as_set(*complement, true);
        for (const auto& triangle : triangles)
          if (triangle.back() >= 0x100 && (triangle.back() & 0xffu) != 0) {
            ++tunnels;
            EXPECT_TRUE(reversed.contains(triangle)) << s << " " << r;
          }
      }
    }
  }
  EXPECT_GT(tunnels, 324u);
}

}  // namespace
}  // namespace tegl::gen
