// SPDX-License-Identifier: BSD-3-Clause
//
// Checks of a builder of 5-cubes against the general builder of tiles and against the definition of Sigma. The builder
// is a parameter, so that copies with faults can be checked.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "../coned_part.hpp"
#include "builder5.hpp"
#include "tegl/tile/certificate.hpp"
#include "tegl/tile/corners.hpp"
#include "tegl/tile/disjoint_sets.hpp"
#include "tegl/tile/facets.hpp"

namespace tegl::test {

/// The ways in which random keys are made.
enum class FiveKeys { low, few_high, smooth, resolved, few_high_resolved, squares };
inline constexpr std::array kAllFiveKeys = {FiveKeys::low,      FiveKeys::few_high,          FiveKeys::smooth,
                                            FiveKeys::resolved, FiveKeys::few_high_resolved, FiveKeys::squares};

/// A random key. It depends on the generator's state only.
template <class Key>
Key random_five_key(std::mt19937_64& random, FiveKeys how) {
  Key key;
  key.signature = static_cast<std::uint32_t>(random());
  if (how == FiveKeys::few_high || how == FiveKeys::few_high_resolved)
    key.signature &= static_cast<std::uint32_t>(random());
  if (how == FiveKeys::smooth) {  // one side of a hyperplane
    std::normal_distribution<double> normal;
    std::array<double, 5> slope;
    for (double& x : slope) x = normal(random);
    const double level = 0.6 * normal(random);
    key.signature = 0;
    for (unsigned v = 0; v < 32; ++v) {
      double value = -level;
      for (unsigned a = 0; a < 5; ++a) value += (v >> a & 1u) != 0 ? 0.5 * slope[a] : -0.5 * slope[a];
      key.signature |= (value > 0 ? 1u : 0u) << v;
    }
  }
  if (how == FiveKeys::squares) key.high_squares = {random(), random() & 0xffffu};  // all else is separate
  if (how != FiveKeys::resolved && how != FiveKeys::few_high_resolved) return key;
  key.high_squares = {random(), random() & 0xffffu};
  key.low_cubes = random() & 0xff'ffff'ffffu;
  key.high_cubes = random() & ~key.low_cubes & 0xff'ffff'ffffu;
  key.low_tesseracts = static_cast<std::uint16_t>(random() & 0x3ffu);
  key.high_tesseracts = static_cast<std::uint16_t>(random() & ~unsigned{key.low_tesseracts} & 0x3ffu);
  key.tile = static_cast<tile::Choice>(random() % 3);
  return key;
}

/// Checks tiles of one builder. Every check returns an empty text, or what is wrong.
template <class Builder, class Key, class Cube>
class FiveCubeChecks {
 public:
  FiveCubeChecks() {
    for (unsigned e = 0; e < 80; ++e)
      edge_[e] = find(Cube::kEdges[e][0], unsigned{Cube::kEdges[e][0]} ^ Cube::kEdges[e][1]);
    for (unsigned q = 0; q < 80; ++q) square_[q] = find(Cube::kSquares[q].base, Cube::kSquares[q].axes);
    for (unsigned c = 0; c < 40; ++c) cube_[c] = find(Cube::kCubes[c].face.base, Cube::kCubes[c].face.axes);
    for (unsigned f = 0; f < 10; ++f) tesseract_[f] = find(f % 2 << f / 2, 31u ^ 1u << f / 2);
  }

  /// Builds the tile of a key. Checks the points of own vertices and the certificate, and compares the components that
  /// its facets join with the general builder's.
  std::string fault_of(const Key& key) {
    const auto contour = builder_.build(key);
    if (std::string fault = fault_of_own(key, contour); !fault.empty()) return fault;
    const tile::TileFacets built = as_built(contour);
    if (const tile::Fault fault = certifier_.certify(lattice_, built); fault != tile::Fault::none)
      return fmt::format("signature {:#x}: {}", key.signature, tile::name_of(fault));
    const tile::TileFacets& expected =
        general_.build(key.signature, {.choices = choices_of(key), .alternative = tile::Alternative::low});
    if (contour.components != expected.sigma_euler.size())
      return fmt::format("signature {:#x}: {} components, expected {}", key.signature, contour.components,
                         expected.sigma_euler.size());
    if (facets_of(built) != facets_of(expected))
      return fmt::format("signature {:#x}: facets join other vertices, or have other Euler characteristics",
                         key.signature);
    return "";
  }

  /// Checks that each own vertex of the key's tile lies inside its face for all positions of the points on edges. Its
  /// edges are critical, and all its points are in its face. If it has corners, it lies on a ray from the centre;
  /// otherwise at a mean, so that its edges must not all be in one facet of the face. Those with the same points are
  /// numbered in order.
  std::string fault_of_own_vertices(const Key& key) { return fault_of_own(key, builder_.build(key)); }

  /// In the low-connected contour, Sigma separates the corners that edges connect, and the low ones that squares
  /// connect, too. It has one component less than there are such sets, as the boundary is simply connected.
  std::string fault_by_definition(std::uint32_t signature) {
    Key key;
    key.signature = signature;
    const auto contour = builder_.build(key);
    tegl::detail::BasicDisjointSets<std::uint16_t> sets;
    sets.reset(32);
    const auto is_high = [&](unsigned v) { return (signature >> v & 1u) != 0; };
    for (unsigned v = 0; v < 32; ++v)
      for (unsigned a = 0; a < 5; ++a) {
        if (is_high(v) == is_high(v ^ 1u << a))
          sets.join(static_cast<std::uint16_t>(v), static_cast<std::uint16_t>(v ^ 1u << a));
        for (unsigned b = 0; b < a; ++b) {
          const unsigned opposite = v ^ 1u << a ^ 1u << b;
          if (!is_high(v) && !is_high(opposite))
            sets.join(static_cast<std::uint16_t>(v), static_cast<std::uint16_t>(opposite));
        }
      }
    std::set<std::uint16_t> roots;
    for (std::uint16_t v = 0; v < 32; ++v) roots.insert(sets.find(v));
    if (contour.components + 1 == roots.size()) return "";
    return fmt::format("signature {:#x}: {} components of Sigma between {} regions", signature, contour.components,
                       roots.size());
  }

  /// Facets by definition, of a key in which each cube, each tesseract and the tile have a centre, low or high: their
  /// Euler characteristics.
  std::string fault_by_centres(const Key& key) {
    const auto is_high = [&](unsigned base, unsigned axes) {
      for (unsigned q = 0; q < 80; ++q)
        if (Cube::kSquares[q].base == base && Cube::kSquares[q].axes == axes)
          return (key.high_squares[q / 64] >> (q % 64) & 1u) != 0;
      for (unsigned c = 0; c < 40; ++c)
        if (Cube::kCubes[c].face.base == base && Cube::kCubes[c].face.axes == axes)
          return (key.high_cubes >> c & 1u) != 0;
      const auto axis = static_cast<unsigned>(std::countr_zero(~axes));
      return (key.high_tesseracts >> (2 * axis + (base >> axis)) & 1u) != 0;
    };
    std::multiset<long> eulers;
    for (const auto& [edges, euler] : facets_of(as_built(builder_.build(key)))) eulers.insert(euler);
    if (eulers == eulers_of_facets(5, key.signature, key.tile == tile::Choice::high, is_high)) return "";
    return fmt::format("signature {:#x}: facets differ from the definition", key.signature);
  }

  /// The first of `count` random tiles of one kind that fails a check.
  std::string fault_of_random(FiveKeys how, std::size_t count) {
    std::mt19937_64 random(7);
    for (std::size_t i = 0; i < count; ++i) {
      const Key key = random_five_key<Key>(random, how);
      if (std::string fault = fault_of(key); !fault.empty()) return fault;
      if (std::string fault = fault_by_definition(key.signature); !fault.empty()) return fault;
    }
    return "";
  }

 private:
  static constexpr unsigned kFirstOwn = Builder::kFirstOwn;

  std::uint32_t find(unsigned base, unsigned axes) const {
    tile::Signature corners = 0;
    for (unsigned v = 0; v < 32; ++v)
      if ((v & ~axes) == base) corners |= tile::Signature{1} << v;
    return lattice_.find(corners).value();
  }

  std::span<const tile::Choice> choices_of(const Key& key) {
    using tile::Choice;
    choices_.assign(lattice_.faces().size(), Choice::separate);
    const auto of = [](std::uint64_t low, std::uint64_t high, unsigned i) {
      return (low >> i & 1u) != 0 ? Choice::low : (high >> i & 1u) != 0 ? Choice::high : Choice::separate;
    };
    for (unsigned q = 0; q < 80; ++q)
      choices_[square_[q]] = (key.high_squares[q / 64] >> (q % 64) & 1u) != 0 ? Choice::high : Choice::low;
    for (unsigned c = 0; c < 40; ++c) choices_[cube_[c]] = of(key.low_cubes, key.high_cubes, c);
    for (unsigned f = 0; f < 10; ++f) choices_[tesseract_[f]] = of(key.low_tesseracts, key.high_tesseracts, f);
    choices_.back() = key.tile;
    return choices_;
  }

  /// See fault_of_own_vertices.
  static std::string fault_of_own(const Key& key, const typename Builder::Contour& contour) {
    std::map<std::array<std::uint64_t, 4>, unsigned> repeats;  // by face and points
    for (std::size_t i = 0; i < contour.own.size(); ++i) {
      const auto& [points, repeat, face] = contour.own[i];
      // by axis and side of the 5-cube: whether it has all points, as bit 2 * axis + side
      unsigned all_in = 0x3ff;
      const auto add = [&](unsigned v) {
        for (unsigned a = 0; a < 5; ++a) all_in &= ~(1u << (2 * a + ((v >> a & 1u) ^ 1u)));
      };
      for (unsigned v = 0; v < 32; ++v)
        if ((points.corners >> v & 1u) != 0) add(v);
      bool are_critical = true;
      for (unsigned e = 0; e < 80; ++e)
        if ((points.edges[e / 64] >> e % 64 & 1u) != 0) {
          const auto& [from, to] = Cube::kEdges[e];
          add(from), add(to);
          are_critical = are_critical && ((key.signature >> from ^ key.signature >> to) & 1u) != 0;
        }
      const auto has_fault = [&](const char* fault) {
        return fmt::format("signature {:#x}, own vertex {}: {}", key.signature, i, fault);
      };
      if (!are_critical) return has_fault("an edge without a point");
      if (face != Builder::kTile && (all_in >> face & 1u) == 0) return has_fault("points outside of its face");
      if (points.corners == 0 && (face == Builder::kTile ? all_in : all_in & ~(1u << face)) != 0)
        return has_fault("a mean in the boundary of its face");
      const auto expected = repeats[{face, points.corners, points.edges[0], points.edges[1]}]++;
      if (repeat != expected) return has_fault("numbers of equal points are not in order");
    }
    return "";
  }

  /// The contour in the form of the general builder.
  tile::TileFacets as_built(const typename Builder::Contour& contour) const {
    tile::TileFacets built;
    for (unsigned v = 0; v < kFirstOwn + contour.own.size(); ++v) {
      tile::Vertex& vertex = built.vertices.emplace_back();
      vertex.kind = v < 80 ? tile::VertexKind::edge : tile::VertexKind::side;
      vertex.number = v;
      vertex.face = v < 80          ? edge_[v]
                    : v < kFirstOwn ? cube_[(v - 80) / ((kFirstOwn - 80) / 40)]
                                    : face_of_own(contour.own[v - kFirstOwn].face);
    }
    const tile::Face& whole = lattice_.faces().back();
    built.in_face.resize(10), built.in_face_sign.resize(10);
    for (std::size_t i = 0; i < builder_.sigma().size(); ++i) {
      tile::Simplex s = tile::kNoSimplex;
      std::copy_n(builder_.sigma()[i].begin(), 4, s.begin());
      const int sign = tile::sort_vertices(s, 4);
      const std::uint32_t face = tesseract_[builder_.tesseract_of()[i]];
      const auto g =
          static_cast<std::size_t>(std::find(whole.faces.begin(), whole.faces.end(), face) - whole.faces.begin());
      built.sigma.push_back(s), built.sigma_sign.push_back(sign);
      built.in_face[g].push_back(s), built.in_face_sign[g].push_back(sign * whole.signs[g]);
    }
    // connected parts of the simplices are facets
    tegl::detail::BasicDisjointSets<std::uint16_t> sets;
    sets.reset(built.vertices.size());
    for (const auto& s : contour.simplices)
      for (unsigned i = 1; i < 5; ++i) sets.join(s[0], s[i]);
    std::map<std::uint16_t, std::size_t> number;
    for (const auto& s : contour.simplices) {
      const auto [at, is_new] = number.try_emplace(sets.find(s[0]), built.facets.size());
      if (is_new) built.facets.emplace_back();
      tile::Simplex simplex = tile::kNoSimplex;
      std::copy_n(s.begin(), 5, simplex.begin());
      built.facets[at->second].simplices.push_back(simplex);
    }
    return built;
  }

  std::uint32_t face_of_own(unsigned face) const { return face == Builder::kTile ? lattice_.tile() : tesseract_[face]; }

  /// Per facet: the edges of the tile that it crosses, and its Euler characteristic.
  std::vector<std::pair<std::set<std::uint32_t>, int>> facets_of(const tile::TileFacets& built) const {
    std::vector<std::pair<std::set<std::uint32_t>, int>> result;
    for (const tile::Facet& facet : built.facets) {
      auto& [edges, euler] = result.emplace_back();
      tile::Simplices sorted = facet.simplices;
      for (tile::Simplex& s : sorted) {
        tile::sort_vertices(s, 5);
        for (int i = 0; i < 5; ++i)
          if (const tile::Vertex& v = built.vertices[s[i]]; v.kind == tile::VertexKind::edge) edges.insert(v.face);
      }
      euler = tile::euler_characteristic(sorted);
    }
    std::sort(result.begin(), result.end());
    return result;
  }

  tile::FaceLattice lattice_ = tile::FaceLattice::cube(5);
  Builder builder_;
  tile::FacetBuilder general_{tile::FaceLattice::cube(5)};
  tile::Certifier certifier_;
  std::array<std::uint32_t, 80> edge_{}, square_{};
  std::array<std::uint32_t, 40> cube_{};
  std::array<std::uint32_t, 10> tesseract_{};
  std::vector<tile::Choice> choices_;
};

}  // namespace tegl::test
