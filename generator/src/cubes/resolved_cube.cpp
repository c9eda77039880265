// SPDX-License-Identifier: BSD-3-Clause
//
// Fills one or several polygons on a cube's boundary: a single polygon as a balanced fan, unless a chord of it lies in
// a square; then by search. The surface between several polygons is radial (cube_tunnel.hpp). Every filling must pass
// the certificate, and every list is proved to be embedded.
#include "cubes/resolved_cube.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "base/error.hpp"
#include "base/fnv.hpp"
#include "base/lattice.hpp"
#include "cubes/cube_embedding.hpp"
#include "cubes/cube_frame.hpp"
#include "cubes/cube_sides.hpp"
#include "cubes/cube_tunnel.hpp"
#include "cubes/surface_search.hpp"
#include "filling/balanced.hpp"
#include "filling/resolutions.hpp"
#include "tegl/tile/certificate.hpp"

namespace tegl::gen {

namespace {

using tile::Choice;
using tile::FaceLattice;
using tile::TileFacets;
using tile::VertexId;

constexpr std::size_t kEdges = CubeFrame::kEdges;
constexpr std::size_t kOwn = kEdges;  ///< number of the first vertex that is not an edge point
constexpr std::size_t kMaxOwn = 4;
using Polygon = CubePolygon;
using Triangles = CubeTriangles;

/// The polygons of Sigma, each from its smallest edge on, in ascending order of these edges.
std::vector<Polygon> polygons_of(const CubeFrame& frame, const TileFacets& tile) {
  constexpr std::uint8_t kNoEdge = 255;
  std::array<std::uint8_t, kEdges> next{};
  next.fill(kNoEdge);
  for (std::size_t j = 0; j < tile.sigma.size(); ++j) {
    std::uint8_t from = frame.edge_of_face[tile.vertices[tile.sigma[j][0]].face];
    std::uint8_t to = frame.edge_of_face[tile.vertices[tile.sigma[j][1]].face];
    if (tile.sigma_sign[j] < 0) std::swap(from, to);
    next[from] = to;
  }
  std::vector<Polygon> polygons;
  for (std::uint8_t e = 0; e < kEdges; ++e) {
    if (next[e] == kNoEdge) continue;
    Polygon& polygon = polygons.emplace_back();
    for (std::uint8_t at = e; next[at] != kNoEdge;) {
      polygon.push_back(at);
      at = std::exchange(next[at], kNoEdge);
    }
  }
  return polygons;
}

/// The tile with Sigma restricted to some polygons, for certifying a filling of only these.
class Alone {
 public:
  Alone(const CubeFrame& frame, const TileFacets& tile, const std::vector<Polygon>& boundary)
      : frame_(&frame), tile_(tile) {
    unsigned edges = 0;
    for (const Polygon& polygon : boundary)
      for (const std::uint8_t e : polygon) edges |= 1u << e;
    tile_.sigma.clear(), tile_.sigma_sign.clear();
    for (std::size_t j = 0; j < tile.sigma.size(); ++j) {
      if (((edges >> frame.edge_of_face[tile.vertices[tile.sigma[j][0]].face]) & 1u) == 0) continue;
      tile_.sigma.push_back(tile.sigma[j]), tile_.sigma_sign.push_back(tile.sigma_sign[j]);
    }
    for (std::size_t q = 0; q < tile.in_face.size(); ++q) {
      tile_.in_face[q].clear(), tile_.in_face_sign[q].clear();
      for (std::size_t j = 0; j < tile.in_face[q].size(); ++j) {
        if (((edges >> frame.edge_of_face[tile.vertices[tile.in_face[q][j][0]].face]) & 1u) == 0) continue;
        tile_.in_face[q].push_back(tile.in_face[q][j]), tile_.in_face_sign[q].push_back(tile.in_face_sign[q][j]);
      }
    }
    for (VertexId v = 0; v < tile_.vertices.size(); ++v)
      if (tile_.vertices[v].kind == tile::VertexKind::edge) id_[frame.edge_of_face[tile_.vertices[v].face]] = v;
    for (std::uint32_t own = 0; own < kMaxOwn; ++own) {
      id_[kOwn + own] = static_cast<VertexId>(tile_.vertices.size());
      tile_.vertices.push_back({tile::VertexKind::side, frame.lattice.tile(), own, tile::kNoVertex, {}});
    }
  }

  bool passes(const Triangles& filling) {
    tile::Facet facet;
    for (const CubeTriangle& t : filling) {
      tile::Simplex& simplex = facet.simplices.emplace_back(tile::kNoSimplex);
      for (std::size_t i = 0; i < 3; ++i) simplex[i] = id_[t[i]];
    }
    tile_.facets.assign(1, facet);
    return certifier_.certify(frame_->lattice, tile_) == tile::Fault::none;
  }

 private:
  const CubeFrame* frame_;
  TileFacets tile_;
  std::array<VertexId, kEdges + kMaxOwn> id_{};
  tile::Certifier certifier_;
};

/// Collects the entries of the table.
class Table {
 public:
  explicit Table(const CubeFrame& frame) : frame_(frame), builder_(frame.lattice), radial_(frame) {
    table_.squares.assign(frame.squares.begin(), frame.squares.end());
  }

  void open_signature(unsigned ambiguous) {
    table_.first_entry.push_back(static_cast<std::uint16_t>(table_.entries.size()));
    table_.ambiguous.push_back(static_cast<std::uint8_t>(ambiguous));
  }

  void add(Signature signature, unsigned high_squares, std::vector<Choice>& choices) {
    signature_ = signature, high_squares_ = high_squares;
    tables::ResolvedEntry entry{};
    for (const Choice choice : {Choice::separate, Choice::low, Choice::high}) {
      choices.back() = choice;
      tile_ = builder_.build(signature, {choices, tile::Alternative::low}, tile::Geometry::without);
      const std::vector<Polygon> polygons = polygons_of(frame_, tile_);
      entry.components = static_cast<std::uint8_t>(polygons.size());
      tables::ResolvedList& list = choice == Choice::separate ? entry.separate
                                   : choice == Choice::low    ? entry.low
                                                              : entry.high;
      if (choice != Choice::separate && tile_.facets.size() == polygons.size()) {
        list = entry.separate;
        continue;
      }
      list.first_triangle = static_cast<std::uint16_t>(table_.triangles.size() / 3);
      list.first_mask = static_cast<std::uint16_t>(table_.masks.size());
      for (const CubeSurface& filling : fillings(polygons, choice)) write(list, filling);
    }
    table_.entries.push_back(entry);
  }

  [[nodiscard]] std::size_t replaced() const { return replaced_.size(); }
  /// The table; then the next one begins.
  ResolvedCube take() {
    ResolvedCube result = std::exchange(table_, {});
    table_.squares = result.squares;
    return result;
  }

 private:
  /// The polygons that bound a facet of the tile.
  [[nodiscard]] std::vector<Polygon> around(const tile::Facet& facet, const std::vector<Polygon>& polygons) const {
    unsigned edges = 0;
    for (const tile::Simplex& s : facet.simplices)
      for (int i = 0; i < tile::size(s); ++i)
        if (const tile::Vertex& v = tile_.vertices[s[i]]; v.kind == tile::VertexKind::edge)
          edges |= 1u << frame_.edge_of_face[v.face];
    std::vector<Polygon> result;
    for (const Polygon& polygon : polygons)
      if (((edges >> polygon[0]) & 1u) != 0) result.push_back(polygon);
    return result;
  }

  /// The fillings of all facets. If two discs may intersect, they become radial as well. If a side of the cube is not
  /// divided, another filling of a disc is taken.
  [[nodiscard]] std::vector<CubeSurface> fillings(const std::vector<Polygon>& polygons, Choice choice) {
    std::vector<std::vector<Polygon>> boundaries;
    for (const tile::Facet& facet : tile_.facets) boundaries.push_back(around(facet, polygons));
    std::vector<CubeSurface> result;
    for (const std::vector<Polygon>& boundary : boundaries)
      result.push_back(boundary.size() == 1 ? disc(boundary) : radial(boundary, choice == Choice::low));
    for (std::size_t f = 0; f < result.size(); ++f)
      for (std::size_t g = 0; g < f; ++g) {
        if (are_apart(result[f], result[g])) continue;
        for (const std::size_t one : {f, g})
          if (boundaries[one].size() == 1) result[one] = radial(boundaries[one], encloses_high(boundaries[one][0]));
        if (!are_apart(result[f], result[g])) fail("two facets may intersect", boundaries.size());
      }
    return has_divided_sides(result) ? result : with_another_disc(std::move(result), boundaries);
  }

  /// Whether both sides of the cube with this contour are divided into tetrahedra that are positive for all positions.
  [[nodiscard]] bool has_divided_sides(const std::vector<CubeSurface>& surfaces) {
    std::vector<RegionTriangle> contour;
    std::vector<std::uint32_t> masks;
    for (const CubeSurface& surface : surfaces) {
      for (const CubeTriangle& t : surface.triangles) {
        RegionTriangle& triangle = contour.emplace_back();
        for (std::size_t i = 0; i < 3; ++i)
          triangle[i] = static_cast<std::uint8_t>(RegionVertices::kFirstEdge + t[i] + (t[i] < kOwn ? 0 : masks.size()));
      }
      masks.insert(masks.end(), surface.masks.begin(), surface.masks.end());
    }
    const auto key = std::tuple(signature_, high_squares_, contour);
    if (divided_.contains(key)) return true;
    const RegionFrame frame = region_frame(masks, 0, contour, false);
    const auto is_divided = [&](bool is_high) {
      const auto regions = CubeSide{static_cast<unsigned>(signature_), high_squares_, is_high}.regions(contour);
      return std::all_of(regions.begin(), regions.end(), [&](const std::vector<RegionTriangle>& region) {
        return divide_side_region(regions_, frame, region, is_high).has_value();
      });
    };
    if (!is_divided(false) || !is_divided(true)) return false;
    divided_.insert(key);
    return true;
  }

  /// A polygon, and whether none, some or all of the cube's ambiguous squares are high. The emitted builder of the cube
  /// knows no more, so every cube fills such a polygon alike.
  using PolygonKind = std::pair<Polygon, int>;
  [[nodiscard]] PolygonKind kind_of(const Polygon& polygon) const {
    return {polygon, high_squares_ == 0 ? 0 : high_squares_ == table_.ambiguous.back() ? 2 : 1};
  }

  /// Replaces one disc by another one, so that both sides of the cube are divided. The table has to be made again:
  /// other cubes may have the same polygon.
  [[nodiscard]] std::vector<CubeSurface> with_another_disc(std::vector<CubeSurface> surfaces,
                                                           const std::vector<std::vector<Polygon>>& boundaries) {
    for (std::size_t f = 0; f < surfaces.size(); ++f) {
      if (boundaries[f].size() > 1 || boundaries[f][0].size() == 3) continue;
      const CubeSurface before = surfaces[f];
      const auto is_accepted = [&](const CubeSurface& surface) {
        for (std::size_t g = 0; g < surfaces.size(); ++g)
          if (g != f && !are_apart(surface, surfaces[g])) return false;
        surfaces[f] = surface;
        return has_divided_sides(surfaces);
      };
      const PolygonKind kind = kind_of(boundaries[f][0]);
      if (!replaced_.contains(kind) && flat_disc(boundaries[f], is_accepted)) {
        replaced_[kind] = surfaces[f];
        return surfaces;
      }
      surfaces[f] = before;
    }
    fail("a side that is not divided into positive tetrahedra", boundaries.size());
  }

  /// Fills a polygon without own vertices by the first filling that passes the certificate, does not intersect itself
  /// and is accepted: a fan, from a vertex with a number as large as possible, or another one.
  [[nodiscard]] std::optional<CubeSurface> flat_disc(const std::vector<Polygon>& boundary,
                                                     const std::function<bool(const CubeSurface&)>& accepts) {
    Alone alone(frame_, tile_, boundary);
    const auto is_admissible = [&](const Triangles& filling) {
      return embedding({}).is_embedded(filling) && alone.passes(filling) && accepts({filling, {}});
    };
    Polygon apexes = boundary[0];
    std::sort(apexes.rbegin(), apexes.rend());
    for (const std::uint8_t apex : apexes)
      if (const Triangles fan = fan_from(apex, boundary[0]); is_admissible(fan)) return CubeSurface{fan, {}};
    SurfaceSearch search(frame_, boundary, {});
    search.may_add = [&](const CubeTriangle& t, const Triangles& others) { return embedding({}).may_add(t, others); };
    search.accepts = is_admissible;
    auto found = search.run();
    return found ? std::optional(CubeSurface{std::move(*found), {}}) : std::nullopt;
  }

  /// Fills a polygon without, otherwise with an own vertex.
  [[nodiscard]] CubeSurface disc(const std::vector<Polygon>& boundary) {
    if (const auto known = replaced_.find(kind_of(boundary[0])); known != replaced_.end()) return known->second;
    if (auto found = flat_disc(boundary, [](const CubeSurface&) { return true; })) return *found;
    Alone alone(frame_, tile_, boundary);
    const auto is_admissible = [&](const Triangles& filling, const std::vector<std::uint32_t>& masks) {
      return embedding(masks).is_embedded(filling) && alone.passes(filling);
    };
    SurfaceSearch::Point mean{};
    std::uint32_t mask = 0;
    for (const std::uint8_t e : boundary[0]) {
      for (std::size_t a = 0; a < 3; ++a) mean[a] += frame_.midpoint(e)[a] / static_cast<double>(boundary[0].size());
      mask |= std::uint32_t{1} << (8 + e);
    }
    SurfaceSearch coned(frame_, boundary, {&mean, 1});
    coned.may_add = [&](const CubeTriangle& t, const Triangles& others) {
      return embedding({mask}).may_add(t, others);
    };
    coned.accepts = [&](const Triangles& filling) { return is_admissible(filling, {mask}); };
    if (auto found = coned.run()) return {std::move(*found), {mask}};
    fail("no filling passes", 1);
  }

  /// Fills polygons by a radial surface, parallel to the region of this sign.
  [[nodiscard]] CubeSurface radial(const std::vector<Polygon>& boundary, bool is_high) {
    const std::optional<CubeSurface> surface = radial_.fill(static_cast<unsigned>(signature_), boundary, is_high);
    if (!surface || !Alone(frame_, tile_, boundary).passes(surface->triangles))
      fail("no radial filling passes", boundary.size());
    return *surface;
  }

  /// Proofs for own vertices with these masks. They are kept, as few sets of masks occur.
  [[nodiscard]] CubeEmbedding& embedding(const std::vector<std::uint32_t>& masks) {
    return embeddings_.try_emplace(masks, frame_, masks).first->second;
  }

  [[nodiscard]] bool are_apart(const CubeSurface& a, const CubeSurface& b) {
    std::vector<std::uint32_t> masks = a.masks;
    masks.insert(masks.end(), b.masks.begin(), b.masks.end());
    Triangles shifted = b.triangles;
    for (CubeTriangle& t : shifted)
      for (std::uint8_t& v : t) v = static_cast<std::uint8_t>(v < kOwn ? v : v + a.masks.size());
    return embedding(masks).holds_between(a.triangles, shifted);
  }

  /// True if fewer corners are on the polygon's high side than on its low side.
  [[nodiscard]] bool encloses_high(const Polygon& polygon) const {
    unsigned high = 0, low = 0;
    for (const std::uint8_t e : polygon)
      for (const std::uint8_t v : frame_.cube().edges[e]) ((signature_ >> v & 1u) != 0 ? high : low) |= 1u << v;
    return std::popcount(high) < std::popcount(low);
  }

  [[noreturn]] void fail(const char* why, std::size_t polygons) const {
    throw Error(ErrorCode::CertificateFailed, fmt::format("cube of signature {}, high squares {:#x}, {} polygons: {}",
                                                          signature_, high_squares_, polygons, why));
  }

  void write(tables::ResolvedList& list, const CubeSurface& filling) {
    for (const CubeTriangle& t : filling.triangles)
      for (const std::uint8_t v : t)
        table_.triangles.push_back(static_cast<std::uint8_t>(v < kOwn ? v : v + list.own_vertices));
    list.triangle_count = static_cast<std::uint8_t>(list.triangle_count + filling.triangles.size());
    list.own_vertices = static_cast<std::uint8_t>(list.own_vertices + filling.masks.size());
    table_.masks.insert(table_.masks.end(), filling.masks.begin(), filling.masks.end());
  }

  const CubeFrame& frame_;
  tile::FacetBuilder builder_;
  RadialFilling radial_;
  std::map<std::vector<std::uint32_t>, CubeEmbedding> embeddings_;
  RegionProof regions_;
  std::set<std::tuple<Signature, unsigned, std::vector<RegionTriangle>>> divided_;  ///< has_divided_sides
  std::map<PolygonKind, CubeSurface> replaced_;                                     ///< with_another_disc
  ResolvedCube table_;
  // State of the current entry.
  Signature signature_ = 0;
  unsigned high_squares_ = 0;
  TileFacets tile_;
};

/// Adds every signature and resolution.
void add_all(const CubeFrame& frame, Table& table) {
  std::vector<Choice> choices(frame.lattice.faces().size(), Choice::separate);
  for (Signature s = 0; s < 256; ++s) {
    const auto polygons = ambiguous_polygons(frame.lattice, s);
    unsigned ambiguous = 0;
    for (unsigned q = 0; q < 6; ++q)
      if (std::find(polygons.begin(), polygons.end(), frame.face_of_square[q]) != polygons.end()) ambiguous |= 1u << q;
    table.open_signature(ambiguous);
    // All subsets of the ambiguous squares in ascending order; a subset holds the squares with a high centre.
    unsigned high = 0;
    do {
      for (unsigned q = 0; q < 6; ++q)
        choices[frame.face_of_square[q]] = ((high >> q) & 1u) != 0 ? Choice::high : Choice::low;
      table.add(s, high, choices);
      high = (high - ambiguous) & ambiguous;
    } while (high != 0);
  }
}

}  // namespace

ResolvedCube make_resolved_cube() {
  const CubeFrame frame;
  Table table(frame);
  for (;;) {
    const std::size_t replaced = table.replaced();
    add_all(frame, table);
    ResolvedCube result = table.take();
    if (table.replaced() == replaced) return result;
  }
}

std::uint64_t digest(const ResolvedCube& table) {
  Fnv hash;
  const auto take = [&hash](std::uint64_t value) { hash.add(value); };
  for (const auto value : table.first_entry) take(value);
  for (const auto value : table.ambiguous) take(value);
  for (const tables::ResolvedEntry& e : table.entries) {
    for (const tables::ResolvedList& l : {e.separate, e.low, e.high})
      take(l.first_triangle), take(l.triangle_count), take(l.own_vertices), take(l.first_mask);
    take(e.components);
  }
  for (const auto value : table.triangles) take(value);
  for (const auto value : table.masks) take(value);
  return hash.value();
}

}  // namespace tegl::gen
