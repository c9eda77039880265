// SPDX-License-Identifier: BSD-3-Clause
//
// Tiles of four dimensions with every face resolved independently: each passes the certificate, its Sigma consists of
// entries of the resolved cube's table, and its filling agrees with the builder of single tiles.
#include "tile/tesseract_fill.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <bitset>
#include <map>
#include <random>
#include <set>
#include <span>
#include <vector>

#include "ambiguity/tesseract_decision.hpp"
#include "tegl/generated/tables.hpp"
#include "tegl/tile/certificate.hpp"
#include "tegl/tile/corners.hpp"
#include "tegl/tile/facets.hpp"
#include "tegl/tile_facets.hpp"

namespace tegl::detail {
namespace {

using tile::Choice;
using tile::FaceLattice;
using tile::kNoSimplex;
using tile::Simplex;
using tile::Simplices;
using tile::VertexId;

constexpr unsigned kFirstOwn = ResolvedTesseract::kFirstOwn;

Choice cube_choice(const ResolvedKey& key, unsigned cube) {
  if ((key.low_cubes >> cube & 1u) != 0) return Choice::low;
  return (key.high_cubes >> cube & 1u) != 0 ? Choice::high : Choice::separate;
}

unsigned cube_signature(unsigned signature, unsigned cube) {
  unsigned result = 0;
  for (unsigned v = 0; v < 8; ++v) result |= (signature >> lifted_corner(cube, v) & 1u) << v;
  return result;
}

/// The high squares of a cube, in the table's numbering.
unsigned cube_squares(std::uint32_t squares, unsigned cube) {
  unsigned result = 0;
  for (unsigned q = 0; q < 6; ++q) {
    const unsigned axis = q / 2 < cube / 2 ? q / 2 : q / 2 + 1;
    const unsigned base = (q % 2) << axis | (cube % 2) << (cube / 2), axes = 15u ^ 1u << axis ^ 1u << (cube / 2);
    for (unsigned s = 0; s < kTesseractSquares.size(); ++s)
      if (kTesseractSquares[s].base == base && kTesseractSquares[s].axes == axes) result |= (squares >> s & 1u) << q;
  }
  return result;
}

const tables::ResolvedList& list_of(const ResolvedKey& key, unsigned cube) {
  const unsigned signature = cube_signature(key.signature, cube), high = cube_squares(key.squares, cube);
  unsigned entry = tables::kTile3Resolved.first_entry[signature];
  for (unsigned q = 0, at = 0; q < 6; ++q)
    if ((tables::kTile3Resolved.ambiguous_squares[signature] >> q & 1u) != 0) entry += (high >> q & 1u) << at++;
  const tables::ResolvedEntry& lists = tables::kTile3Resolved.entries[entry];
  const Choice choice = cube_choice(key, cube);
  return choice == Choice::separate ? lists.separate : choice == Choice::low ? lists.low : lists.high;
}

/// Whether a list was numbered for an entry and a choice with these triangles.
bool has_list(const CubeList& number, const tables::ResolvedList& list) {
  const tables::ResolvedEntry& entry = tables::kTile3Resolved.entries[number.entry];
  const tables::ResolvedList& of = number.choice == 0 ? entry.separate : number.choice == 1 ? entry.low : entry.high;
  return of.first_triangle == list.first_triangle;
}

/// The triangles of a cube.
std::span<const std::uint8_t> triangles_of(const ResolvedKey& key, unsigned cube, Triangulation triangulation) {
  const tables::ResolvedList& list = list_of(key, cube);
  if (triangulation == Triangulation::compact)
    return {tables::kTile3Resolved.triangles + 3 * std::size_t{list.first_triangle},
            3 * std::size_t{list.triangle_count}};
  // The lists that 3D images use.
  const ResolvedCubes& cubes = ResolvedCubes::instance(Triangulation::barycentric);
  const auto& lists = cubes.lists();
  const unsigned signature = cube_signature(key.signature, cube);
  for (unsigned number = 0; number < lists.size(); ++number) {
    if (lists[number].signature != signature || !has_list(lists[number], list)) continue;
    const tables::TileTable& table = variant_table<3>(Triangulation::barycentric).tile;
    const tables::List& of_key = table.lists[table.list_of[cubes.key(number)]];
    return {table.simplices + 3 * std::size_t{of_key.first_simplex}, 3 * std::size_t{of_key.simplex_count}};
  }
  return {};
}

/// Random keys: uniform, or from the mean of uniform noise.
class Keys {
 public:
  ResolvedKey uniform() {
    ResolvedKey key;
    key.signature = static_cast<std::uint16_t>(random_());
    if (random_() % 4 == 0) key.signature &= static_cast<std::uint16_t>(random_());
    if (random_() % 4 == 0) key.signature |= static_cast<std::uint16_t>(random_());
    key.squares = static_cast<std::uint32_t>(random_()) & 0xffffffu;
    key.low_cubes = static_cast<std::uint8_t>(random_());
    key.high_cubes = static_cast<std::uint8_t>(random_() & ~key.low_cubes);
    key.tile = static_cast<Choice>(random_() % 3);
    return key;
  }

  ResolvedKey of_means() {
    std::array<double, 16> values;
    for (double& value : values) value = std::uniform_real_distribution<double>(-1, 1)(random_);
    const auto is_high = [&](unsigned base, unsigned axes) {
      double sum = 0;
      for (unsigned v = 0; v < 16; ++v)
        if ((v & ~axes) == base) sum += values[v];
      return sum >= 0;
    };
    ResolvedKey key;
    for (unsigned v = 0; v < 16; ++v) key.signature |= static_cast<std::uint16_t>((is_high(v, 0) ? 1u : 0u) << v);
    for (unsigned q = 0; q < 24; ++q)
      key.squares |= (is_high(kTesseractSquares[q].base, kTesseractSquares[q].axes) ? 1u : 0u) << q;
    for (unsigned f = 0; f < 8; ++f)
      (is_high((f % 2) << (f / 2), 15u ^ 1u << (f / 2)) ? key.high_cubes : key.low_cubes) |=
          static_cast<std::uint8_t>(1u << f);
    key.tile = is_high(0, 15) ? Choice::high : Choice::low;
    return key;
  }

 private:
  std::mt19937_64 random_{20};
};

/// Converts a looked-up tile to the form of built tiles.
class AsBuilt {
 public:
  AsBuilt() {
    for (unsigned e = 0; e < 32; ++e) {
      const unsigned base = edge_base(4, e);
      edge_face_[e] = static_cast<std::uint32_t>(face_number<4>(base, 1u << (e >> 3)));
    }
  }

  [[nodiscard]] const FaceLattice& lattice() const { return lattice_; }

  tile::TileFacets operator()(const ResolvedKey& key, const ResolvedView& view,
                              Triangulation triangulation = Triangulation::compact) const {
    tile::TileFacets tile;
    for (unsigned v = 0; v < kFirstOwn + view.own_vertices; ++v) {
      tile::Vertex vertex;
      vertex.kind = v < 32 ? tile::VertexKind::edge : tile::VertexKind::side;
      vertex.face = v < 32          ? edge_face_[v]
                    : v < kFirstOwn ? face_of_cube((v - 32) / ResolvedCubes::kMostOwn)
                                    : lattice_.tile();
      vertex.number = v;
      tile.vertices.push_back(vertex);
    }
    const std::vector<std::uint32_t>& faces = lattice_.faces().back().faces;
    tile.in_face.resize(faces.size()), tile.in_face_sign.resize(faces.size());
    for (unsigned f = 0; f < 8; ++f) {
      const auto g = static_cast<std::size_t>(std::find(faces.begin(), faces.end(), face_of_cube(f)) - faces.begin());
      const unsigned in_cube = cube_signature(key.signature, f);
      if (in_cube == 0 || in_cube == 255) continue;
      const std::span<const std::uint8_t> list = triangles_of(key, f, triangulation);
      for (const std::uint8_t* at = list.data(); at != list.data() + list.size(); at += 3) {
        Simplex triangle = kNoSimplex;
        for (unsigned i = 0; i < 3; ++i)
          triangle[i] = static_cast<VertexId>(ResolvedCubes::instance().lifted(f, at[i]));
        const int sign = tile::sort_vertices(triangle);
        tile.in_face[g].push_back(triangle), tile.in_face_sign[g].push_back(sign);
        tile.sigma.push_back(triangle), tile.sigma_sign.push_back(sign * lattice_.faces().back().signs[g]);
      }
    }
    tile::Facet& facet = tile.facets.emplace_back();
    for (std::uint32_t q = 0; q < view.simplex_count; ++q) {
      Simplex& simplex = facet.simplices.emplace_back(kNoSimplex);
      for (unsigned i = 0; i < 4; ++i) simplex[i] = view.simplices[4 * q + i];
    }
    return tile;
  }

  /// The tile made by FacetBuilder.
  const tile::TileFacets& built(const ResolvedKey& key) {
    std::vector<Choice> choices(lattice_.faces().size(), Choice::separate);
    for (unsigned q = 0; q < 24; ++q)
      choices[face_number<4>(kTesseractSquares[q].base, kTesseractSquares[q].axes)] =
          (key.squares >> q & 1u) != 0 ? Choice::high : Choice::low;
    for (unsigned f = 0; f < 8; ++f) choices[face_of_cube(f)] = cube_choice(key, f);
    choices[lattice_.tile()] = key.tile;
    return builder_.build(key.signature, {choices, tile::Alternative::low}, tile::Geometry::without);
  }

 private:
  static std::uint32_t face_of_cube(unsigned f) {
    return static_cast<std::uint32_t>(face_number<4>((f % 2) << (f / 2), 15u ^ 1u << (f / 2)));
  }

  FaceLattice lattice_ = FaceLattice::cube(4);
  std::array<std::uint32_t, 32> edge_face_{};
  tile::FacetBuilder builder_{FaceLattice::cube(4)};
};

/// Topology of a filling on the points on the tile's edges, independent of its triangulation: which points are
/// connected, and which closed curves along the segments in squares bound in it (mod 2), as a reduced basis.
class Topology {
 public:
  static constexpr std::size_t kMostColumns = 2048;
  using Row = std::bitset<kMostColumns>;

  explicit Topology(const tile::TileFacets& tile) {
    std::map<VertexId, std::uint32_t> edge_of;
    for (VertexId v = 0; v < tile.vertices.size(); ++v)
      if (tile.vertices[v].kind == tile::VertexKind::edge) edge_of[v] = tile.vertices[v].face;
    std::map<VertexId, VertexId> root;
    const auto find = [&](VertexId v) {
      root.try_emplace(v, v);
      while (root[v] != v) v = root[v];
      return v;
    };
    // Edges between points of one square first, named by these points: equal in all triangulations.
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<VertexId, VertexId>> segments;
    std::set<std::pair<VertexId, VertexId>> others;
    const FaceLattice lattice = FaceLattice::cube(4);
    std::set<std::array<VertexId, 3>> triangles;
    for (const tile::Facet& facet : tile.facets)
      for (const Simplex& s : facet.simplices)
        for (int omitted = 0; omitted < 4; ++omitted) {
          std::array<VertexId, 3> t;
          for (int i = 0, k = 0; i < 4; ++i)
            if (i != omitted) t[k++] = s[i];
          std::sort(t.begin(), t.end());
          triangles.insert(t);
          for (int i = 1; i < 3; ++i) root[find(t[i])] = find(t[0]);
          for (const auto& [a, b] : {std::pair{t[0], t[1]}, {t[0], t[2]}, {t[1], t[2]}}) {
            const auto at_a = edge_of.find(a), at_b = edge_of.find(b);
            if (at_a != edge_of.end() && at_b != edge_of.end() && in_square(lattice, at_a->second, at_b->second))
              segments[std::minmax(at_a->second, at_b->second)] = {a, b};
            else
              others.insert({a, b});
          }
        }
    std::map<std::pair<VertexId, VertexId>, std::size_t> column;
    std::size_t next = 0;
    for (const auto& edge : others) column[edge] = next++;
    const std::size_t first_segment = next;
    for (const auto& [name, edge] : segments) {
      column[edge] = next++;
      segments_.push_back(name);
    }
    EXPECT_LE(next, kMostColumns);
    reduce(triangles, column, first_segment, next);
    for (const auto& [v, face] : edge_of)
      if (root.contains(v)) parts_[find(v)].insert(face);
  }

  friend bool operator==(const Topology& a, const Topology& b) {
    std::set<std::set<std::uint32_t>> parts_a, parts_b;
    for (const auto& [v, part] : a.parts_) parts_a.insert(part);
    for (const auto& [v, part] : b.parts_) parts_b.insert(part);
    return parts_a == parts_b && a.segments_ == b.segments_ && a.bounding_ == b.bounding_;
  }

 private:
  static bool in_square(const FaceLattice& lattice, std::uint32_t a, std::uint32_t b) {
    const tile::Signature both = lattice.faces()[a].corners | lattice.faces()[b].corners;
    return std::any_of(lattice.faces().begin(), lattice.faces().end(),
                       [&](const tile::Face& f) { return f.dim == 2 && (both & ~f.corners) == 0; });
  }

  void reduce(const std::set<std::array<VertexId, 3>>& triangles,
              const std::map<std::pair<VertexId, VertexId>, std::size_t>& column, std::size_t first_segment,
              std::size_t columns) {
    std::vector<Row> pivot(columns);
    std::vector<bool> has(columns, false);
    for (const auto& t : triangles) {
      Row row;
      row.flip(column.at({t[0], t[1]})), row.flip(column.at({t[0], t[2]})), row.flip(column.at({t[1], t[2]}));
      for (std::size_t c = row._Find_first(); c < columns; c = row._Find_first()) {
        if (!has[c]) {
          has[c] = true, pivot[c] = row;
          break;
        }
        row ^= pivot[c];
      }
    }
    for (std::size_t c = columns; c-- > first_segment;) {
      if (!has[c]) continue;
      for (std::size_t d = c + 1; d < columns; ++d)
        if (has[d] && pivot[c][d]) pivot[c] ^= pivot[d];
      bounding_.push_back(pivot[c] >> first_segment);
    }
  }

  std::map<VertexId, std::set<std::uint32_t>> parts_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> segments_;
  std::vector<Row> bounding_;
};

/// One signature of each class under the symmetries of the tile, generated by swaps of axes and one reversal.
std::vector<std::uint16_t> class_representatives() {
  const auto moved = [](unsigned signature, const auto& to) {
    unsigned result = 0;
    for (unsigned v = 0; v < 16; ++v) result |= (signature >> v & 1u) << to(v);
    return result;
  };
  std::vector<bool> seen(65536);
  std::vector<std::uint16_t> result;
  for (unsigned first = 0; first < seen.size(); ++first) {
    if (seen[first]) continue;
    result.push_back(static_cast<std::uint16_t>(first));
    std::vector<unsigned> reached{first};
    seen[first] = true;
    for (std::size_t i = 0; i < reached.size(); ++i) {
      std::vector<unsigned> images{moved(reached[i], [](unsigned v) { return v ^ 1u; })};
      for (unsigned a = 0; a < 3; ++a)
        images.push_back(moved(reached[i], [a](unsigned v) {
          const unsigned swapped = (v >> a ^ v >> (a + 1)) & 1u;
          return v ^ (swapped << a | swapped << (a + 1));
        }));
      for (const unsigned image : images)
        if (!seen[image]) seen[image] = true, reached.push_back(image);
    }
  }
  return result;
}

/// Counts the genera of the components of Sigma.
void note_genera(const tile::TileFacets& tile, std::map<int, int>& count) {
  std::vector<VertexId> root(tile.vertices.size());
  for (VertexId v = 0; v < root.size(); ++v) root[v] = v;
  const auto find = [&](VertexId v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  for (const Simplex& t : tile.sigma) root[find(t[1])] = root[find(t[2])] = find(t[0]);
  std::map<VertexId, std::pair<std::set<VertexId>, int>> parts;
  for (const Simplex& t : tile.sigma) {
    auto& [vertices, triangles] = parts[find(t[0])];
    vertices.insert({t[0], t[1], t[2]});
    ++triangles;
  }
  for (const auto& [v, part] : parts) ++count[(2 - static_cast<int>(part.first.size()) + part.second / 2) / 2];
}

class ResolvedTiles : public ::testing::Test {
 protected:
  /// Certifies a key in the compact triangulation, and every fourth key in the barycentric one.
  void expect_certified(const ResolvedKey& key) {
    ASSERT_NO_FATAL_FAILURE(expect_certified(key, tile_, Triangulation::compact));
    if (keys_certified_++ % 4 == 0) expect_certified(key, barycentric_, Triangulation::barycentric);
  }

  void expect_certified(const ResolvedKey& key, ResolvedTesseract& from, Triangulation triangulation) {
    const ResolvedSize size = from.size(key);
    const ResolvedView& view = from.find(key);
    ASSERT_EQ(size.simplices, view.simplex_count);
    ASSERT_EQ(size.own_vertices, view.own_vertices);
    ASSERT_LT(kFirstOwn + view.own_vertices, 256u);
    const tile::TileFacets tile = as_built_(key, view, triangulation);
    note_genera(tile, genera_);
    const tile::Fault fault = certifier_.certify(as_built_.lattice(), tile);
    ASSERT_EQ(fault, tile::Fault::none) << tile::name_of(fault) << " signature " << key.signature << " squares "
                                        << key.squares << " low " << int{key.low_cubes} << " high "
                                        << int{key.high_cubes} << " tile " << static_cast<int>(key.tile);
  }

  Keys keys_;
  AsBuilt as_built_;
  ResolvedTesseract tile_, barycentric_{Triangulation::barycentric};
  std::size_t keys_certified_ = 0;
  tile::Certifier certifier_;
  std::map<int, int> genera_;  ///< genus -> number of components of Sigma
};

TEST_F(ResolvedTiles, RandomKeysPassTheCertificate) {
  for (int i = 0; i < 40000; ++i)
    ASSERT_NO_FATAL_FAILURE(expect_certified(i % 2 == 0 ? keys_.uniform() : keys_.of_means()));
}

TEST_F(ResolvedTiles, RandomResolutionsOfEveryClassPassTheCertificateUpToGenus5) {
  const auto signatures = class_representatives();
  EXPECT_EQ(signatures.size(), 402u);
  for (const std::uint16_t signature : signatures)
    for (int i = 0; i < 150; ++i) {
      ResolvedKey key = keys_.uniform();
      key.signature = signature;
      ASSERT_NO_FATAL_FAILURE(expect_certified(key));
    }
  for (int genus = 0; genus <= 5; ++genus) EXPECT_GT(genera_[genus], 0) << "genus " << genus;
}

TEST_F(ResolvedTiles, WhereNothingIsToBeChosenTheyAreThoseOfTheBalancedTable) {
  std::size_t settled = 0;
  for (unsigned s = 0; s < 65536; s += 7) {
    if (!ResolvedTesseract::is_settled(static_cast<std::uint16_t>(s))) continue;
    ++settled;
    ResolvedKey key = keys_.uniform();
    key.signature = static_cast<std::uint16_t>(s);
    const ResolvedView& view = tile_.find(key);
    const tables::List& list = tables::kTile4Balanced.lists[tables::kTile4Balanced.list_of[s]];
    ASSERT_EQ(view.simplex_count, list.simplex_count);
    ASSERT_EQ(view.own_vertices, std::uint32_t{list.cone_vertices} + list.side_vertices);
    const std::uint8_t* const stored = tables::kTile4Balanced.simplices + 4 * std::size_t{list.first_simplex};
    if (view.own_vertices == 0) {
      ASSERT_TRUE(std::equal(stored, stored + 4 * std::size_t{list.simplex_count}, view.simplices)) << s;
    }
  }
  EXPECT_GT(settled, 500u);
}

TEST_F(ResolvedTiles, FillingsAreThoseOfTheEngine) {
  for (int i = 0; i < 2000; ++i) {
    const ResolvedKey key = i % 2 == 0 ? keys_.uniform() : keys_.of_means();
    const tile::TileFacets found = as_built_(key, tile_.find(key));
    ASSERT_EQ(Topology(found), Topology(as_built_.built(key)))
        << " signature " << key.signature << " squares " << key.squares << " low " << int{key.low_cubes} << " high "
        << int{key.high_cubes} << " tile " << static_cast<int>(key.tile);
    if (i % 4 != 0) continue;
    ASSERT_EQ(Topology(as_built_(key, barycentric_.find(key), Triangulation::barycentric)),
              Topology(as_built_.built(key)))
        << "barycentric, signature " << key.signature << " squares " << key.squares;
  }
}

TEST_F(ResolvedTiles, BarycentricSpheresAreConedFromBarycentres) {
  for (int i = 0; i < 2000; ++i) {
    ResolvedKey key = keys_.of_means();
    if (!ResolvedTesseract::is_settled(key.signature)) continue;
    const ResolvedView& view = barycentric_.find(key);
    ASSERT_LE(view.own_vertices, 1u);
    if (view.own_vertices == 0) {
      ASSERT_LE(view.simplex_count, 1u);
      continue;
    }
    ASSERT_NE(view.masks[0] & ResolvedTesseract::kIsBarycentre, 0u);
    for (std::uint32_t q = 0; q < view.simplex_count; ++q) ASSERT_EQ(view.simplices[4 * q], kFirstOwn);
  }
}

TEST(ResolvedCones, VectorInstructionsAddTheSame) {
  constexpr std::size_t kMost = ResolvedCubes::kCubes * ResolvedCubes::kMostTriangles + ResolvedCubes::kWordsBehind;
  std::array<std::uint32_t, kMost> one_by_one{}, at_once{};
  for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric}) {
    const ResolvedCubes& cubes = ResolvedCubes::instance(triangulation);
    for (unsigned list = 0; list < ResolvedCubes::kLists; ++list) {
      std::array<ResolvedCubes::Triangles, ResolvedCubes::kCubes> triangles;
      for (unsigned f = 0; f < ResolvedCubes::kCubes; ++f) triangles[f] = cubes.triangles(f, list);
      for (unsigned apex = 0; apex <= kFirstOwn; ++apex) {
        const auto* const end =
            ResolvedTesseract::add_cones(triangles.data(), triangles.size(), apex, one_by_one.data());
        const auto count = static_cast<std::size_t>(end - one_by_one.data());
        ASSERT_EQ(add_cones(triangles.data(), triangles.size(), apex, at_once.data()), at_once.data() + count)
            << "list " << list << " apex " << apex;
        ASSERT_TRUE(
            std::equal(at_once.begin(), at_once.begin() + static_cast<std::ptrdiff_t>(count), one_by_one.begin()))
            << "list " << list << " apex " << apex;
      }
    }
  }
}

}  // namespace
}  // namespace tegl::detail
