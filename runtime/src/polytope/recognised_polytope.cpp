// SPDX-License-Identifier: BSD-3-Clause
//
// Checks, orients and recognises a 4D polytope.
//
// Each face is in two facets, and the facets around an edge are one cycle, so the facets are a 3D manifold away from
// corners. Around a corner they are a closed connected surface, and a sphere if its Euler characteristic is 2: then
// they are a manifold, whose Euler characteristic is 0.
#include "polytope/recognised_polytope.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/disjoint_sets.hpp"
#include "polytope/polytope_faces.hpp"
#include "polytope/solid_facets.hpp"
#include "tegl/error.hpp"

namespace tegl::detail {

namespace {

constexpr std::size_t kMostFacets =
    kPolytopeCorners * (kPolytopeCorners - 3) / 2;  // of a polytope with so many corners
using Ring = std::vector<std::uint8_t>;
using Bits = std::uint64_t;

constexpr Bits bit(std::size_t v) noexcept { return Bits{1} << v; }

Bits bits_of(std::span<const std::uint8_t> corners) noexcept {
  Bits bits = 0;
  for (const std::uint8_t v : corners) bits |= bit(v);
  return bits;
}

/// Whether a ring has the edge from a to b in this direction.
bool has_edge(const Ring& ring, std::uint8_t a, std::uint8_t b) noexcept {
  for (std::size_t i = 0; i < ring.size(); ++i)
    if (ring[i] == a && ring[(i + 1) % ring.size()] == b) return true;
  return false;
}

/// A ring with its smallest corner first, and the smaller one of the two corners beside it second.
Ring standard(Ring ring) {
  std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
  if (ring[1] > ring.back()) std::reverse(ring.begin() + 1, ring.end());
  return ring;
}

/// A polytope while it is checked.
class CheckedPolytope {
 public:
  CheckedPolytope(std::size_t cell, std::size_t points, const PolytopeLists& lists) : cell_(cell), points_(points) {
    if (lists.facet_ends.size() < 5 || lists.facet_ends.size() > kMostFacets)
      fail("a polytope of {} facets; expected 5 to {}", lists.facet_ends.size(), kMostFacets);
    for (std::size_t f = 0; f < lists.facet_ends.size(); ++f) add_facet(f, lists);
    find_faces();
    check_meetings();
    orient();
    for (const auto& [ends, facets] : facets_at_) check_edge(ends[0], ends[1], facets);
    for (std::size_t v = 0; v < corners_.size(); ++v) check_corner(v);
    check_curves();
  }

  RecognisedPolytope take() {
    RecognisedPolytope result;
    std::vector<std::uint8_t> order;
    result.kind = kind(order);
    if (result.kind == PolytopeKind::other) {
      result.corners = std::move(corners_);
      result.facets = std::move(facets_);
    } else {
      for (const std::uint8_t v : order) result.corners.push_back(corners_[v]);
    }
    return result;
  }

 private:
  /// The two facets at a face.
  struct Face {
    Ring ring;  ///< standard
    std::array<std::size_t, 2> facets;
    std::size_t count = 0;
  };
  using Edge = std::array<std::uint8_t, 2>;

  template <class... Arguments>
  [[noreturn]] void fail(fmt::format_string<Arguments...> format, Arguments&&... arguments) const {
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{}: {}", cell_.name(), fmt::format(format, std::forward<Arguments>(arguments)...)));
  }
  [[nodiscard]] std::string names(const Ring& ring) const {
    std::string text;
    for (std::size_t i = 0; i < ring.size(); ++i)
      text += fmt::format("{}{}", i == 0 ? "" : i + 1 == ring.size() ? " and " : ", ", corners_[ring[i]]);
    return text;
  }

  void add_facet(std::size_t f, const PolytopeLists& lists) {
    const std::uint64_t first = f == 0 ? 0 : lists.facet_ends[f - 1];
    const std::uint64_t begin = first == 0 ? 0 : lists.face_ends[first - 1];
    std::vector<std::uint64_t> ends;
    for (std::uint64_t k = first; k < lists.facet_ends[f]; ++k) ends.push_back(lists.face_ends[k] - begin);
    const std::size_t size = ends.empty() ? 0 : ends.back();
    const RecognisedPolyhedron found =
        recognise_polyhedron({cell_.cell, f}, points_, lists.corners.subspan(begin, size), ends);
    for (const Index p : lists.corners.subspan(begin, size)) (void)corner_of(p);  // in the order of the lists
    RecognisedPolytope::Facet& facet = facets_.emplace_back();
    facet.shape = found.shape;
    facet.rings = found.rings;
    facet.ends = found.ends;
    facet.corners.resize(found.corners.size());
    for (std::size_t i = 0; i < found.corners.size(); ++i)
      facet.corners[known_corner(found.shape, i)] = corner_of(found.corners[i]);
    corners_of_.push_back(bits_of(facet.corners));
    std::vector<Ring>& rings = rings_.emplace_back();
    const auto add_ring = [&](std::span<const std::uint8_t> of_facet) {
      Ring& ring = rings.emplace_back();
      for (const std::uint8_t v : of_facet) ring.push_back(facet.corners[v]);
    };
    if (found.shape == PolyhedronShape::other) {
      for (std::size_t k = 0, from = 0; k < found.ends.size(); from = found.ends[k++])
        add_ring(std::span(found.rings).subspan(from, found.ends[k] - from));
    } else {
      const PolytopeFaces faces = faces_of_known(found.shape);
      for (std::size_t k = 0; k < faces.face_count(); ++k) add_ring(faces.ring(k));
    }
  }

  std::uint8_t corner_of(Index p) {
    const auto at = static_cast<std::size_t>(std::find(corners_.begin(), corners_.end(), p) - corners_.begin());
    if (at == kPolytopeCorners)
      fail("a polytope of more than {} corners; expected at most {}", kPolytopeCorners, kPolytopeCorners);
    if (at == corners_.size()) corners_.push_back(p);
    return static_cast<std::uint8_t>(at);
  }

  void find_faces() {
    for (std::size_t f = 0; f < facets_.size(); ++f)
      for (const Ring& ring : rings_[f]) {
        for (std::size_t i = 0; i < ring.size(); ++i) {
          const auto [a, b] = std::minmax(ring[i], ring[(i + 1) % ring.size()]);
          std::vector<std::size_t>& at = facets_at_[{a, b}];
          if (at.empty() || at.back() != f) at.push_back(f);
        }
        Face& face = faces_.try_emplace(bits_of(ring), Face{standard(ring), {}}).first->second;
        if (face.count == 2)
          fail("the face of the points {} is in the facets {}, {} and {}; expected two facets", names(face.ring),
               face.facets[0], face.facets[1], f);
        if (face.ring != standard(ring))
          fail(
              "the face of the points {} of the facet {} has them in another order in the facet {}; expected the same "
              "edges",
              names(face.ring), face.facets[0], f);
        face.facets[face.count++] = f;
      }
    for (const auto& [bits, face] : faces_)
      if (face.count < 2)
        fail("the face of the points {} is in the facet {} only; expected two facets: a closed polytope",
             names(face.ring), face.facets[0]);
  }

  void check_meetings() const {
    const auto is_edge_of = [&](Bits both, std::size_t f) {
      const Edge ends = {static_cast<std::uint8_t>(std::countr_zero(both)),
                         static_cast<std::uint8_t>(63 - std::countl_zero(both))};
      const auto at = facets_at_.find(ends);
      return at != facets_at_.end() && std::binary_search(at->second.begin(), at->second.end(), f);
    };
    for (std::size_t f = 0; f < facets_.size(); ++f)
      for (std::size_t g = 0; g < f; ++g) {
        const Bits both = corners_of_[f] & corners_of_[g];
        const int count = std::popcount(both);
        if (count < 2 || (count == 2 && is_edge_of(both, f) && is_edge_of(both, g))) continue;
        const auto face = faces_.find(both);
        if (face != faces_.end() && face->second.facets == std::array{g, f}) continue;
        fail("the facets {} and {} share {} points, among them {} and {}; expected nothing, a point, an edge or a face",
             g, f, count, corners_[static_cast<std::size_t>(std::countr_zero(both))],
             corners_[static_cast<std::size_t>(63 - std::countl_zero(both))]);
      }
  }

  /// Whether the two facets at a face have its corners in the same direction.
  [[nodiscard]] bool are_alike(const Face& face) const {
    const auto is_along = [&](std::size_t f) {
      const auto ring = std::find_if(rings_[f].begin(), rings_[f].end(),
                                     [&](const Ring& r) { return bits_of(r) == bits_of(face.ring); });
      return has_edge(*ring, face.ring[0], face.ring[1]);
    };
    return is_along(face.facets[0]) == is_along(face.facets[1]);
  }

  /// Gives all facets the orientation of the first one.
  void orient() {
    std::vector<std::vector<std::pair<std::size_t, bool>>> beside(facets_.size());  // other facets; in one direction
    for (const auto& [bits, face] : faces_) {
      const bool alike = are_alike(face);
      for (const std::size_t k : {0u, 1u}) beside[face.facets[k]].emplace_back(face.facets[1 - k], alike);
    }
    std::vector<bool> is_known(facets_.size());
    std::vector<std::size_t> known{0};
    is_known[0] = true;
    for (std::size_t i = 0; i < known.size(); ++i)
      for (const auto& [other, alike] : beside[known[i]]) {
        const bool is_inverted = facets_[known[i]].is_inverted != alike;
        if (!is_known[other]) {
          is_known[other] = true;
          facets_[other].is_inverted = is_inverted;
          known.push_back(other);
        } else if (facets_[other].is_inverted != is_inverted) {
          fail("the facets {} and {} cannot have one orientation; expected a sphere around the polytope", known[i],
               other);
        }
      }
    if (known.size() != facets_.size())
      fail("{} of {} facets are connected by faces; expected all", known.size(), facets_.size());
  }

  /// The facets at an edge or corner that are connected by faces there. `at`: bits of the edge or corner.
  [[nodiscard]] std::size_t parts_around(Bits at, const std::vector<std::size_t>& facets) const {
    DisjointSets sets(facets_.size());
    for (const auto& [bits, face] : faces_)
      if ((bits & at) == at && is_at(face, at))
        sets.join(static_cast<Index>(face.facets[0]), static_cast<Index>(face.facets[1]));
    std::size_t parts = 0;
    for (const std::size_t f : facets) parts += sets.find(static_cast<Index>(f)) == f ? 1 : 0;
    return parts;
  }
  /// Whether an edge or corner whose corners a face has is in the face.
  [[nodiscard]] static bool is_at(const Face& face, Bits at) noexcept {
    const auto a = static_cast<std::uint8_t>(std::countr_zero(at)),
               b = static_cast<std::uint8_t>(63 - std::countl_zero(at));
    return a == b || has_edge(face.ring, a, b) || has_edge(face.ring, b, a);
  }

  void check_edge(std::uint8_t a, std::uint8_t b, const std::vector<std::size_t>& facets) const {
    if (const std::size_t parts = parts_around(bit(a) | bit(b), facets); parts != 1)
      fail("the facets at the edge between the points {} and {} are {} cycles; expected one around the edge",
           corners_[a], corners_[b], parts);
  }

  void check_corner(std::size_t v) const {
    std::vector<std::size_t> facets;
    for (std::size_t f = 0; f < facets_.size(); ++f)
      if ((corners_of_[f] & bit(v)) != 0) facets.push_back(f);
    if (const std::size_t parts = parts_around(bit(v), facets); parts != 1)
      fail("the facets at the point {} are {} parts; expected one around the point", corners_[v], parts);
    const auto edges = std::count_if(facets_at_.begin(), facets_at_.end(),
                                     [&](const auto& each) { return each.first[0] == v || each.first[1] == v; });
    const auto faces =
        std::count_if(faces_.begin(), faces_.end(), [&](const auto& each) { return (each.first & bit(v)) != 0; });
    const auto euler = edges - faces + static_cast<std::ptrdiff_t>(facets.size());
    if (euler != 2)
      fail(
          "at the point {} are {} edges, {} faces and {} facets, with the Euler characteristic {}; expected 2, that of "
          "a sphere around the point",
          corners_[v], edges, faces, facets.size(), euler);
  }

  /// Each closed curve of edges is the sum of faces' borders, modulo 2: the borders of faces have the rank that the
  /// closed curves have, E - V + 1.
  void check_curves() const {
    std::map<Edge, std::size_t> number;
    for (const auto& [ends, facets] : facets_at_) number.emplace(ends, number.size());
    constexpr std::size_t kWords = kPolytopeCorners * (kPolytopeCorners - 1) / 128 + 1;
    using Row = std::array<std::uint64_t, kWords>;
    std::vector<std::optional<Row>> pivots(number.size());  // by highest edge
    std::size_t rank = 0;
    for (const auto& [bits, face] : faces_) {
      Row row{};
      for (std::size_t i = 0; i < face.ring.size(); ++i) {
        const auto [a, b] = std::minmax(face.ring[i], face.ring[(i + 1) % face.ring.size()]);
        const std::size_t e = number.at({a, b});
        row[e / 64] ^= std::uint64_t{1} << e % 64;
      }
      for (std::size_t e = number.size(); e-- > 0;) {
        if ((row[e / 64] >> e % 64 & 1u) == 0) continue;
        if (!pivots[e]) {
          pivots[e] = row;
          ++rank;
          break;
        }
        for (std::size_t w = 0; w < kWords; ++w) row[w] ^= (*pivots[e])[w];
      }
    }
    const std::size_t curves = number.size() + 1 - corners_.size();
    if (rank != curves)
      fail("{} of {} independent closed curves of edges bound faces; expected all: a sphere around the polytope", rank,
           curves);
  }

  [[nodiscard]] bool are_neighbours(std::uint8_t a, std::uint8_t b) const {
    return facets_at_.count({std::min(a, b), std::max(a, b)}) != 0;
  }

  /// The shape, and its corners in order.
  PolytopeKind kind(std::vector<std::uint8_t>& order) const {
    const bool has_tetrahedra = std::all_of(
        facets_.begin(), facets_.end(), [](const auto& facet) { return facet.shape == PolyhedronShape::tetrahedron; });
    if (has_tetrahedra && corners_.size() == 5) {
      order = {0, 1, 2, 3, 4};
      return PolytopeKind::simplex4;
    }
    if (has_tetrahedra && corners_.size() == 8 && facets_.size() == 16 && find_opposite(order))
      return PolytopeKind::cell16;
    for (std::size_t f = 0; f < facets_.size(); ++f)
      if (facets_[f].shape != PolyhedronShape::other && find_prism(f, order))
        return static_cast<PolytopeKind>(facets_[f].shape);
    return PolytopeKind::other;
  }

  /// The corners in pairs without an edge: with 16 different facets of one of each pair, this is the 16-cell.
  bool find_opposite(std::vector<std::uint8_t>& order) const {
    order.clear();
    for (std::uint8_t v = 0; v < 8; ++v) {
      if (std::find(order.begin(), order.end(), v) != order.end()) continue;
      std::vector<std::uint8_t> apart;
      for (std::uint8_t w = 0; w < 8; ++w)
        if (w != v && !are_neighbours(v, w)) apart.push_back(w);
      if (apart.size() != 1 || std::find(order.begin(), order.end(), apart[0]) != order.end()) return false;
      order.insert(order.end(), {v, apart[0]});
    }
    return true;
  }

  /// Whether the polytope is the prism over a facet: that and its opposite facet, and a prism over each face.
  bool find_prism(std::size_t f, std::vector<std::uint8_t>& order) const {
    const RecognisedPolytope::Facet& base = facets_[f];
    if (corners_.size() != 2 * base.corners.size() || facets_.size() != rings_[f].size() + 2) return false;
    std::array<std::uint8_t, kPolytopeCorners> above{};
    for (const std::uint8_t v : base.corners) {
      std::vector<std::uint8_t> others;
      for (std::uint8_t w = 0; w < corners_.size(); ++w)
        if ((corners_of_[f] & bit(w)) == 0 && are_neighbours(v, w)) others.push_back(w);
      if (others.size() != 1) return false;
      above[v] = others[0];
    }
    const auto above_of = [&](std::span<const std::uint8_t> corners) {
      Bits bits = 0;
      for (const std::uint8_t v : corners) bits |= bit(above[v]);
      return bits;
    };
    std::vector<Bits> expected = {corners_of_[f], above_of(base.corners)}, found = corners_of_;
    for (const Ring& ring : rings_[f]) expected.push_back(bits_of(ring) | above_of(ring));
    std::sort(expected.begin(), expected.end());
    std::sort(found.begin(), found.end());
    if (expected != found) return false;
    order.resize(2 * base.corners.size());
    for (std::size_t i = 0; i < base.corners.size(); ++i) {
      order[i] = base.corners[known_corner(base.shape, i)];
      order[i + base.corners.size()] = above[order[i]];
    }
    return true;
  }

  CellPlace cell_;
  std::size_t points_;
  std::vector<Index> corners_;
  std::vector<RecognisedPolytope::Facet> facets_;
  std::vector<Bits> corners_of_;                        ///< by facet
  std::vector<std::vector<Ring>> rings_;                ///< by facet: its faces, in its own orientation
  std::map<Bits, Face> faces_;                          ///< by corners
  std::map<Edge, std::vector<std::size_t>> facets_at_;  ///< by ends, the smaller first; ascending
};

}  // namespace

RecognisedPolytope recognise_polytope(std::size_t cell, std::size_t points, const PolytopeLists& lists) {
  return CheckedPolytope(cell, points, lists).take();
}

}  // namespace tegl::detail
