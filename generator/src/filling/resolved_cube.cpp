// SPDX-License-Identifier: BSD-3-Clause
//
// Fills one or several polygons on a cube's boundary: a single polygon as a balanced fan, if its chords do not lie in a
// square. Others are filled by search: for an open edge of the front, every vertex is tried as the third one of its triangle, until no
// edge is open. The number of triangles determines the surface: a disc, or a sphere with holes. If every such surface
// has a chord in a square, the filling is a copy of the region between the polygons, pushed inwards. Every filling must
// pass the certificate.
#include "filling/resolved_cube.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "base/error.hpp"
#include "base/fnv.hpp"
#include "base/lattice.hpp"
#include "filling/balanced.hpp"
#include "filling/resolutions.hpp"
#include "tegl/tile/certificate.hpp"

namespace tegl::gen {

namespace {

using tile::Choice;
using tile::FaceLattice;
using tile::TileFacets;
using tile::VertexId;

constexpr std::size_t kEdges = 12;
constexpr std::size_t kOwn = kEdges;  ///< number of the first vertex that is not an edge point
constexpr std::size_t kMaxOwn = 8;
using Triangle = std::array<std::uint8_t, 3>;
using Polygon = std::vector<std::uint8_t>;  ///< edges, with high on the left seen from outside
using Triangles = std::vector<Triangle>;

/// The cube's edges and squares in the numbering of the table contract.
struct Frame {
  FaceLattice lattice = FaceLattice::cube(3);
  CubeLattice tiles{3};
  std::vector<std::uint8_t> edge_of_face = std::vector<std::uint8_t>(lattice.faces().size());
  std::vector<std::uint32_t> face_of_square = std::vector<std::uint32_t>(6);
  std::vector<std::array<std::uint8_t, 4>> squares = std::vector<std::array<std::uint8_t, 4>>(6);
  std::array<unsigned, kEdges + 1> squares_of{};             ///< by edge: set of the squares that contain it
  std::array<std::array<double, 3>, kEdges + 1> position{};  ///< midpoint of each edge

  Frame() {
    const Tile& cube = tiles.tile(3);
    for (std::uint8_t e = 0; e < kEdges; ++e)
      edge_of_face[lattice.find(Signature{1} << cube.edges[e][0] | Signature{1} << cube.edges[e][1]).value()] = e;
    for (std::size_t q = 0; q < 6; ++q) {
      std::copy_n(cube.faces[q].corner.begin(), 4, squares[q].begin());
      face_of_square[q] = lattice.find(cube.faces[q].corners()).value();
      for (const std::uint8_t e : cube.faces[q].edge) squares_of[e] |= 1u << q;
    }
    for (std::size_t e = 0; e < kEdges; ++e)
      for (std::size_t i = 0; i < 3; ++i)
        position[e][i] = (cube.corners[cube.edges[e][0]][i] + cube.corners[cube.edges[e][1]][i]) / 2;
  }
};

/// The polygons of Sigma, each from its smallest edge on, in ascending order of these edges.
std::vector<Polygon> polygons_of(const Frame& frame, const TileFacets& tile) {
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
  Alone(const Frame& frame, const TileFacets& tile, const std::vector<Polygon>& boundary)
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
    for (const Triangle& t : filling) {
      tile::Simplex& simplex = facet.simplices.emplace_back(tile::kNoSimplex);
      for (std::size_t i = 0; i < 3; ++i) simplex[i] = id_[t[i]];
    }
    tile_.facets.assign(1, facet);
    return certifier_.certify(frame_->lattice, tile_) == tile::Fault::none;
  }

 private:
  const Frame* frame_;
  TileFacets tile_;
  std::array<VertexId, kEdges + kMaxOwn> id_{};
  tile::Certifier certifier_;
};

/// Search for a connected surface of genus 0 with the given boundary and the shortest inner edges.
class Search {
 public:
  Search(const Frame& frame, Alone& alone, const std::vector<Polygon>& boundary, bool own_vertex)
      : frame_(frame), alone_(alone), position_(frame.position) {
    for (const Polygon& polygon : boundary)
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const std::uint8_t a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        open_[a][b] = used_[a][b] = used_[b][a] = true;
        vertices_.push_back(a);
      }
    const std::size_t points = vertices_.size();
    // Number of triangles from Euler's formula, V - E + F = 2 - holes.
    triangles_ = points + 2 * boundary.size() - 4 + (own_vertex ? 2 : 0);
    if (!own_vertex) return;
    for (std::size_t i = 0; i < 3; ++i) {
      position_[kOwn][i] = 0;
      for (const std::uint8_t e : vertices_) position_[kOwn][i] += frame.position[e][i] / static_cast<double>(points);
    }
    vertices_.push_back(kOwn);
  }

  std::optional<Triangles> run() {
    advance(0);
    return std::exchange(best_, std::nullopt);
  }

 private:
  [[nodiscard]] double length(std::size_t a, std::size_t b) const {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double d = position_[a][i] - position_[b][i];
      sum += d * d;
    }
    return sum;
  }

  /// True if the edge closes an open one, or is new and does not lie in a square.
  [[nodiscard]] bool possible(std::size_t from, std::size_t to) const {
    return open_[from][to] || (!used_[from][to] && (frame_.squares_of[from] & frame_.squares_of[to]) == 0);
  }

  /// Adds an edge of a triangle. Returns true if it closed an open edge; take_back() needs that value.
  bool put(std::size_t from, std::size_t to, double& cost) {
    if (open_[from][to]) return open_[from][to] = false, true;
    open_[to][from] = used_[from][to] = used_[to][from] = true;
    cost += length(from, to);
    return false;
  }

  void take_back(std::size_t from, std::size_t to, bool closed) {
    if (closed)
      open_[from][to] = true;
    else
      open_[to][from] = used_[from][to] = used_[to][from] = false;
  }

  // Extends the front at its first open edge. Prunes by cost.
  void advance(double cost) {
    constexpr double kEqual = 1e-9;
    if (best_ && cost > best_cost_ - kEqual) return;
    std::size_t a = 0, b = 0;
    while (a <= kOwn && !open_[a][b])
      if (++b > kOwn) ++a, b = 0;
    if (a > kOwn) return consider(cost);
    if (filling_.size() == triangles_) return;
    for (const std::uint8_t c : vertices_) {
      if (c == a || c == b || !possible(b, c) || !possible(c, a)) continue;
      double sum = cost;
      open_[a][b] = false;
      const bool second = put(b, c, sum), third = put(c, a, sum);
      filling_.push_back({static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b), c});
      advance(sum);
      filling_.pop_back();
      take_back(c, a, third), take_back(b, c, second);
      open_[a][b] = true;
    }
  }

  void consider(double cost) {
    if (filling_.size() != triangles_ || !connected() || !alone_.passes(filling_)) return;
    best_ = filling_, best_cost_ = cost;
  }

  [[nodiscard]] bool connected() const {
    unsigned reached = 1u << filling_[0][0], before = 0;
    while (reached != std::exchange(before, reached))
      for (const Triangle& t : filling_) {
        const unsigned own = 1u << t[0] | 1u << t[1] | 1u << t[2];
        if ((own & reached) != 0) reached |= own;
      }
    return std::all_of(vertices_.begin(), vertices_.end(), [&](unsigned v) { return ((reached >> v) & 1u) != 0; });
  }

  const Frame& frame_;
  Alone& alone_;
  std::array<std::array<double, 3>, kEdges + 1> position_;
  std::vector<std::uint8_t> vertices_;
  std::size_t triangles_ = 0;
  bool open_[kEdges + 1][kEdges + 1] = {};  ///< directed edges that still need a triangle
  bool used_[kEdges + 1][kEdges + 1] = {};
  Triangles filling_;
  std::optional<Triangles> best_;
  double best_cost_ = 0;
};

/// A copy of a region of the cube's boundary: in each square a fan from a corner. Copies of corners are own vertices,
/// so no edge is a chord between two edge points.
class SideFilling {
 public:
  SideFilling(const Frame& frame, Signature signature, unsigned high_squares, bool high)
      : frame_(frame), signature_(signature), high_squares_(high_squares), high_(high) {}

  /// The triangles of the region bounded by these polygons. Writes to `corners` the corner of each own vertex.
  Triangles run(const std::vector<Polygon>& boundary, std::vector<std::uint8_t>& corners) {
    for (std::size_t q = 0; q < 6; ++q) square(q);
    unsigned reached = 1u << boundary[0][0], before = 0;
    while (reached != std::exchange(before, reached))
      for (const Triangle& t : all_)
        if ((bits(t) & reached) != 0) reached |= bits(t);
    Triangles filling;
    for (Triangle t : all_) {
      if ((bits(t) & reached) == 0) continue;
      for (std::uint8_t& v : t) {
        if (v < kEdges) continue;
        const auto corner = static_cast<std::uint8_t>(v - kEdges);
        const auto at = std::find(corners.begin(), corners.end(), corner);
        v = static_cast<std::uint8_t>(kOwn + static_cast<std::size_t>(at - corners.begin()));
        if (at == corners.end()) corners.push_back(corner);
      }
      filling.push_back(t);
    }
    turn(filling, boundary);
    return filling;
  }

 private:
  static unsigned bits(const Triangle& t) { return 1u << t[0] | 1u << t[1] | 1u << t[2]; }
  [[nodiscard]] bool inside(std::uint8_t corner) const { return (((signature_ >> corner) & 1u) != 0) == high_; }

  void square(std::size_t q) {
    // The square's corners in cyclic order, with the same orientation for all six squares seen from outside.
    std::array<std::uint8_t, 4> ring = {frame_.squares[q][0], frame_.squares[q][1], frame_.squares[q][3],
                                        frame_.squares[q][2]};
    if (frame_.tiles.tile(3).faces[q].sign < 0) std::reverse(ring.begin(), ring.end());
    std::vector<std::uint8_t> outline;  // of the inside part if joined; corner c is kEdges + c
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint8_t here = ring[i], next = ring[(i + 1) % 4];
      if (inside(here)) outline.push_back(static_cast<std::uint8_t>(kEdges + here));
      if (inside(here) != inside(next)) outline.push_back(frame_.tiles.tile(3).edge_between(here, next));
    }
    const bool joined = (((high_squares_ >> q) & 1u) != 0) == high_;
    const auto is_corner = [](std::uint8_t v) { return v >= kEdges; };
    const auto count = std::count_if(outline.begin(), outline.end(), is_corner);
    if (count == 2 && outline.size() == 6 && !joined) {
      for (std::size_t i = 0; i < 6; ++i)
        if (is_corner(outline[i])) all_.push_back({outline[(i + 5) % 6], outline[i], outline[(i + 1) % 6]});
      return;
    }
    if (count == 0) return;
    // Fan from a corner without adjacent edge points if there are three corners, else from any corner.
    std::size_t from = 0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const bool better = is_corner(outline[i]) && (!is_corner(outline[from]) ||
                                                    (count == 3 && is_corner(outline[(i + 1) % outline.size()]) &&
                                                     is_corner(outline[(i + outline.size() - 1) % outline.size()])));
      if (better) from = i;
    }
    for (std::size_t i = 1; i + 1 < outline.size(); ++i)
      all_.push_back({outline[from], outline[(from + i) % outline.size()], outline[(from + i + 1) % outline.size()]});
  }

  /// Reverses all triangles if they do not match the boundary's orientation.
  static void turn(Triangles& filling, const std::vector<Polygon>& boundary) {
    const std::uint8_t a = boundary[0][0], b = boundary[0][1];
    const bool right = std::any_of(filling.begin(), filling.end(), [&](const Triangle& t) {
      return (t[0] == a && t[1] == b) || (t[1] == a && t[2] == b) || (t[2] == a && t[0] == b);
    });
    if (!right)
      for (Triangle& t : filling) std::swap(t[1], t[2]);
  }

  const Frame& frame_;
  Signature signature_;
  unsigned high_squares_;
  bool high_;
  Triangles all_;
};

/// Collects the entries of the table.
class Table {
 public:
  explicit Table(const Frame& frame) : frame_(frame), builder_(frame.lattice) { table_.squares = frame.squares; }

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
      for (const tile::Facet& facet : tile_.facets) fill(list, around(facet, polygons), choice);
    }
    table_.entries.push_back(entry);
  }

  ResolvedCube& table() { return table_; }

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

  // Fills a boundary by the first filling that passes the certificate: balanced fan, search without and with an own
  // vertex, copy of the region.
  void fill(tables::ResolvedList& list, const std::vector<Polygon>& boundary, Choice choice) {
    Alone alone(frame_, tile_, boundary);
    if (boundary.size() == 1)
      if (const Triangles fan = balanced_fan(boundary[0]); alone.passes(fan)) return write(list, fan, {});
    if (const auto flat = Search(frame_, alone, boundary, false).run()) return write(list, *flat, {});
    if (const auto coned = Search(frame_, alone, boundary, true).run()) {
      std::uint32_t mask = 0;
      for (const Polygon& polygon : boundary)
        for (const std::uint8_t e : polygon) mask |= std::uint32_t{1} << (8 + e);
      return write(list, *coned, {mask});
    }
    std::vector<std::uint8_t> corners;
    const Triangles side = SideFilling(frame_, signature_, high_squares_, choice == Choice::low).run(boundary, corners);
    if (corners.size() > kMaxOwn || !alone.passes(side))
      throw Error(ErrorCode::CertificateFailed,
                  fmt::format("cube of signature {}, high squares {:#x}: no filling of its {} polygons passes",
                              signature_, high_squares_, boundary.size()));
    std::vector<std::uint32_t> masks;
    for (const std::uint8_t corner : corners) masks.push_back(std::uint32_t{1} << corner);
    write(list, side, masks);
  }

  void write(tables::ResolvedList& list, const Triangles& filling, const std::vector<std::uint32_t>& masks) {
    for (const Triangle& t : filling)
      for (const std::uint8_t v : t)
        table_.triangles.push_back(static_cast<std::uint8_t>(v < kOwn ? v : v + list.own_vertices));
    list.triangle_count = static_cast<std::uint8_t>(list.triangle_count + filling.size());
    list.own_vertices = static_cast<std::uint8_t>(list.own_vertices + masks.size());
    table_.masks.insert(table_.masks.end(), masks.begin(), masks.end());
  }

  const Frame& frame_;
  tile::FacetBuilder builder_;
  ResolvedCube table_;
  // State of the current entry.
  Signature signature_ = 0;
  unsigned high_squares_ = 0;
  TileFacets tile_;
};

}  // namespace

ResolvedCube make_resolved_cube() {
  const Frame frame;
  Table table(frame);
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
  return std::move(table.table());
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
