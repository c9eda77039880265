// SPDX-License-Identifier: BSD-3-Clause
//
// Fills Sigma component by component. A sphere is coned, from its barycentre (barycentric) or from one of its own
// vertices (compact). A component of higher genus is filled by a copy of one side of the tile's boundary. A simplex in
// the tile's boundary must belong to Sigma's own triangulation, because the neighbouring tile may contain it too. This
// condition restricts the choice of chords and apexes below.
//
// Based on: M. Liversage, thesis, 1994, sections 8.1.18 and 10.1.3 (cones).
#include "filling/filling.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <stdexcept>

#include "base/simplex_key.hpp"
#include "filling/ball_dissection.hpp"
#include "filling/side_filling.hpp"
#include "filling/sigma_complex.hpp"
#include "tegl/tile/disjoint_sets.hpp"

namespace tegl::gen {

namespace {

struct Component {
  std::vector<LocalSimplex> boundary;
  std::vector<std::uint8_t> vertices;  // ascending
  int euler = 0;
};

int euler_of(int vertices_per_simplex, const Component& c) {
  const int v = static_cast<int>(c.vertices.size());
  const int f = static_cast<int>(c.boundary.size());
  return vertices_per_simplex == 2 ? v - f : v - 3 * f / 2 + f;  // Sigma is closed: 3 F = 2 E
}

/// Components of Sigma, ordered by smallest vertex; spheres first, so that cone vertices precede side vertices.
std::vector<Component> components_of(int n, const std::vector<LocalSimplex>& boundary) {
  detail::BasicDisjointSets<std::size_t> sets(256);
  for (const LocalSimplex& s : boundary)
    for (int i = 1; i < n - 1; ++i) sets.join(s[0], s[i]);
  std::array<int, 256> number;
  number.fill(-1);
  std::vector<Component> components;
  std::vector<std::uint8_t> order;
  for (const LocalSimplex& s : boundary) order.push_back(static_cast<std::uint8_t>(sets.find(s[0])));
  std::vector<std::uint8_t> roots(order);
  std::sort(roots.begin(), roots.end());
  roots.erase(std::unique(roots.begin(), roots.end()), roots.end());
  // number the components, then collect their simplices and vertices
  for (const std::uint8_t r : roots) {
    number[r] = static_cast<int>(components.size());
    components.emplace_back();
  }
  for (std::size_t i = 0; i < boundary.size(); ++i) components[number[order[i]]].boundary.push_back(boundary[i]);
  for (Component& c : components) {
    std::set<std::uint8_t> vertices;
    for (const LocalSimplex& s : c.boundary) vertices.insert(s.begin(), s.begin() + (n - 1));
    c.vertices.assign(vertices.begin(), vertices.end());
    c.euler = euler_of(n - 1, c);
  }
  const int sphere = n == 3 ? 0 : 2;
  std::stable_partition(components.begin(), components.end(), [&](const Component& c) { return c.euler == sphere; });
  return components;
}

/// The polygon of a 3-tile's component, from its smallest vertex along its orientation.
std::vector<std::uint8_t> cycle_of(const Component& c) {
  std::array<std::uint8_t, 256> next{};
  for (const LocalSimplex& s : c.boundary) next[s[0]] = s[1];
  std::vector<std::uint8_t> cycle{c.vertices.front()};
  while (next[cycle.back()] != cycle.front()) cycle.push_back(next[cycle.back()]);
  if (cycle.size() != c.boundary.size()) throw std::logic_error("a component of a 3-tile's Sigma is not one cycle");
  return cycle;
}

/// Triangulates a polygon by chords that do not lie in the tile's boundary: as a fan from its smallest vertex if its
/// chords are allowed, else by chords of minimum total squared length (vertices at edge midpoints; ties go to the
/// first). The fan from the smallest vertex in every cube allows a convex facet of a 4-tile to be coned from its own
/// smallest vertex.
class ChordTriangulation {
 public:
  ChordTriangulation(const FaceContours& faces, std::vector<std::uint8_t> polygon)
      : faces_(faces), polygon_(std::move(polygon)) {}

  /// Triangles as positions in the polygon; empty if every triangulation has a forbidden chord.
  std::vector<std::array<std::size_t, 3>> best() {
    std::vector<std::array<std::size_t, 3>> fan;
    double cost = 0;
    for (std::size_t k = 1; k + 1 < polygon_.size(); ++k) {
      fan.push_back({0, k, k + 1});
      cost += chord(0, k);
    }
    if (cost < kForbidden) return fan;
    const auto result = solve(0, polygon_.size() - 1);
    return result.cost < kForbidden ? result.triangles : std::vector<std::array<std::size_t, 3>>{};
  }

 private:
  static constexpr double kForbidden = 1e9;
  struct Result {
    double cost;
    std::vector<std::array<std::size_t, 3>> triangles;
  };

  double chord(std::size_t i, std::size_t j) const {
    if (j == i + 1 || (i == 0 && j + 1 == polygon_.size())) return 0;  // a side
    const std::uint8_t a = polygon_[i], b = polygon_[j];
    if ((faces_.faces_of(a) & faces_.faces_of(b)) != 0) return kForbidden;  // the chord would lie in a face
    const Tile& tile = faces_.tile();
    double sum = 0;
    for (int k = 0; k < tile.dim; ++k) {
      const auto mid = [&](std::uint8_t e) {
        return 0.5 * (tile.corners[tile.edges[e][0]][k] + tile.corners[tile.edges[e][1]][k]);
      };
      sum += (mid(a) - mid(b)) * (mid(a) - mid(b));
    }
    return sum;
  }

  Result solve(std::size_t i, std::size_t j) const {
    if (j < i + 2) return {0, {}};
    Result best{2 * kForbidden, {}};
    for (std::size_t k = i + 1; k < j; ++k) {
      const double own = chord(i, k) + chord(k, j);
      if (own >= kForbidden) continue;
      Result left = solve(i, k), right = solve(k, j);
      const double cost = own + left.cost + right.cost;
      if (cost >= best.cost) continue;
      best.cost = cost;
      best.triangles = {{i, k, j}};
      best.triangles.insert(best.triangles.end(), left.triangles.begin(), left.triangles.end());
      best.triangles.insert(best.triangles.end(), right.triangles.begin(), right.triangles.end());
    }
    return best;
  }

  const FaceContours& faces_;
  std::vector<std::uint8_t> polygon_;
};

bool cut_by_chords(const FaceContours& faces, const std::vector<std::uint8_t>& cycle, LocalFacet& facet) {
  // Both orientations of a polygon must get the same triangles: start at the smallest vertex, go towards its smaller
  // neighbour, and reverse the triangles if that is against the orientation.
  std::vector<std::uint8_t> polygon(cycle);
  const bool turned = polygon.back() < polygon[1];
  if (turned) std::reverse(polygon.begin() + 1, polygon.end());
  const auto triangles = ChordTriangulation(faces, polygon).best();
  for (const auto& t : triangles) {
    LocalSimplex simplex{polygon[t[0]], polygon[t[1]], polygon[t[2]]};
    if (turned) std::swap(simplex[1], simplex[2]);
    facet.simplices.push_back(simplex);
  }
  return !triangles.empty();
}

/// The cone from one of the component's own vertices over all simplices that do not contain it.
std::vector<LocalSimplex> pulled_cone(const Component& c, std::uint8_t apex) {
  std::vector<LocalSimplex> cone;
  for (const LocalSimplex& s : c.boundary)
    if (s[0] != apex && s[1] != apex && s[2] != apex) cone.push_back({apex, s[0], s[1], s[2]});
  return cone;
}

bool pull(const FaceContours& faces, const Component& c, LocalFacet& facet) {
  const SigmaComplex sigma(faces, c.boundary);
  for (const std::uint8_t apex : c.vertices) {
    auto cone = pulled_cone(c, apex);
    if (!facet.simplices.empty() && cone.size() >= facet.simplices.size()) continue;
    if (std::all_of(cone.begin(), cone.end(), [&](const LocalSimplex& s) { return sigma.allows(s); }))
      facet.simplices = std::move(cone);
  }
  return !facet.simplices.empty();
}

/// The cone from an added vertex.
std::vector<LocalSimplex> cone(int n, const Component& c, std::uint8_t apex) {
  std::vector<LocalSimplex> result;
  for (const LocalSimplex& s : c.boundary) {
    LocalSimplex simplex{apex};
    std::copy_n(s.begin(), n - 1, simplex.begin() + 1);
    result.push_back(simplex);
  }
  return result;
}

/// The key of a simplex, and the sign of the permutation that sorts its vertices.
SignedFace signed_face(const LocalSimplex& s, int count) { return {key_of(s, count), parity(s, count)}; }

/// True if the oriented boundary of the n-vertex simplices is exactly `boundary`.
bool is_bounded_by(int n, const std::vector<LocalSimplex>& simplices, const std::vector<LocalSimplex>& boundary) {
  std::vector<SignedFace> sum;
  sum.reserve(static_cast<std::size_t>(n) * simplices.size());
  for (const LocalSimplex& s : simplices)
    for (int drop = 0; drop < n; ++drop) {
      const auto [key, sign] = signed_face(without(s, drop, n), n - 1);
      sum.push_back({key, drop % 2 == 0 ? sign : -sign});
    }
  // add the signs of equal faces; faces with the sum 0 are inside
  std::sort(sum.begin(), sum.end());
  auto end = sum.begin();
  for (auto at = sum.begin(); at != sum.end();) {
    SignedFace total{at->key, 0};
    for (; at != sum.end() && at->key == total.key; ++at) total.sign += at->sign;
    if (total.sign != 0) *end++ = total;
  }
  sum.erase(end, sum.end());
  if (sum.size() != boundary.size()) return false;
  return std::all_of(boundary.begin(), boundary.end(), [&](const LocalSimplex& s) {
    const SignedFace face = signed_face(s, n - 1);
    const auto found = std::lower_bound(sum.begin(), sum.end(), face);
    return found != sum.end() && *found == face;
  });
}

/// Takes the part of the hull's contour that the component bounds. Returns false if there is none.
bool take_from_hull(int n, const std::vector<LocalSimplex>& hull, const Component& c, LocalFacet& facet) {
  std::vector<LocalSimplex> part;
  for (const LocalSimplex& s : hull) {
    const auto inside = std::count_if(s.begin(), s.begin() + n, [&](std::uint8_t v) {
      return std::binary_search(c.vertices.begin(), c.vertices.end(), v);
    });
    if (inside == n) part.push_back(s);
    if (inside != 0 && inside != n) return false;  // the hull joins components that the rule keeps separate
  }
  if (!is_bounded_by(n, part, c.boundary)) return false;
  facet.simplices = std::move(part);
  return true;
}

/// The corners of `inside` connected with `corner` by edges and diagonals of squares.
Signature joined_with(const Tile& tile, Signature inside, std::uint8_t corner) {
  const auto near = [&](std::uint32_t a, std::uint32_t b) {
    int distance = 0;
    for (int i = 0; i < tile.dim; ++i) distance += tile.corners[a][i] != tile.corners[b][i] ? 1 : 0;
    return distance <= 2;
  };
  Signature reached = Signature{1} << corner;
  for (bool grown = true; grown;) {
    grown = false;
    for (std::uint32_t a = 0; a < tile.corner_count(); ++a)
      for (std::uint32_t b = 0; b < tile.corner_count(); ++b)
        if (((reached >> a) & 1u) != 0 && ((inside >> b) & 1u) != 0 && ((reached >> b) & 1u) == 0 && near(a, b)) {
          reached |= Signature{1} << b;
          grown = true;
        }
  }
  return reached;
}

/// Fills a component from the hull of the side that the alternative joins. If that hull joins more than the rule does,
/// uses the hull of the component's own part of that side.
bool fill_from_hull(const FaceContours& faces, const HullContours& hulls, Signature signature, const Component& c,
                    LocalFacet& facet) {
  const Tile& tile = faces.tile();
  const bool low = faces.alternative() == Alternative::low;
  const Signature inside = low ? ~signature & tile.full() : signature;
  const auto [a, b] = tile.edges[facet.points.front()];
  const Signature own = joined_with(tile, inside, ((inside >> a) & 1u) != 0 ? a : b);
  for (const Signature corners : {inside, own}) {
    auto hull = hulls.contour(corners);
    if (!low)  // the hull's outside is the low side
      for (LocalSimplex& s : hull) std::swap(s[tile.dim - 1], s[tile.dim - 2]);
    if (take_from_hull(tile.dim, hull, c, facet)) return true;
  }
  return false;
}

/// Number of facets of the tile's faces that lie in a component.
std::uint32_t facets_around(const FaceContours& faces, Signature signature, const Component& c) {
  std::uint32_t count = 0;
  for (std::uint32_t f = 0; f < faces.tile().faces.size(); ++f)
    for (const LocalFacet& facet : faces.face_contour(f, signature).facets)
      if (std::binary_search(c.vertices.begin(), c.vertices.end(), faces.lift(f, facet.points.front()))) ++count;
  return count;
}

/// Fills a component with one simplex if it is that simplex's boundary.
bool fill_simplex(int n, const Component& c, LocalFacet& facet) {
  if (c.vertices.size() != static_cast<std::size_t>(n)) return false;
  facet.simplices = n == 3 ? std::vector{LocalSimplex{facet.points[0], facet.points[1], facet.points[2]}}
                           : pulled_cone(c, c.vertices.front());
  return true;
}

/// Orients tetrahedra that fill a component so that the component is their oriented boundary. Propagates signs over
/// shared triangles.
std::vector<LocalSimplex> oriented(std::vector<LocalSimplex> tetrahedra, const Component& c) {
  std::map<Key, int> known;  // triangle -> sign that a tetrahedron on it needs
  for (const LocalSimplex& s : c.boundary) {
    const auto [key, sign] = signed_face(s, 3);
    known[key] = sign;
  }
  std::vector<LocalSimplex> result;
  while (!tetrahedra.empty()) {
    const std::size_t before = tetrahedra.size();
    std::erase_if(tetrahedra, [&](const LocalSimplex& t) {
      std::array<SignedFace, 4> faces{};
      int sign = 0;
      for (int drop = 0; drop < 4; ++drop) {
        faces[drop] = signed_face(without(t, drop, 4), 3);
        if (drop % 2 != 0) faces[drop].sign = -faces[drop].sign;
        const auto found = known.find(faces[drop].key);
        if (found != known.end() && sign == 0) sign = found->second * faces[drop].sign;
      }
      if (sign == 0) return false;
      for (const auto& [face, own] : faces) known.try_emplace(face, -sign * own);  // for the other side
      result.push_back(t);
      if (sign < 0) std::swap(result.back()[2], result.back()[3]);
      return true;
    });
    if (tetrahedra.size() == before) throw std::logic_error("a filling that is not connected");
  }
  return result;
}

std::vector<LocalSimplex> all_of(const BallDissection& ball, std::uint8_t own_vertex) {
  std::vector<LocalSimplex> result = ball.tetrahedra;
  for (const LocalSimplex& t : ball.rest) result.push_back({own_vertex, t[0], t[1], t[2]});  // the cone vertex first
  return result;
}

void take_dissection(const BallDissection& ball, const Component& c, std::uint8_t own_vertex, LocalFacet& facet) {
  facet.simplices = oriented(all_of(ball, own_vertex), c);
  facet.filling = ball.rest.empty() ? Filling::pulled : Filling::cone;
}

/// Whether simplices are embedded for all positions; the own vertex is the mean of the vertices that it is coned to.
bool are_embedded(const FaceContours& faces, const EmbeddingProof& proof, std::uint8_t own_vertex,
                  const std::vector<LocalSimplex>& simplices) {
  EmbeddingProof::Means means(own_vertex - faces.tile().edge_count() + 1u);
  for (const LocalSimplex& s : simplices)
    if (s[0] == own_vertex) means.back() |= 1u << s[1] | 1u << s[2] | 1u << s[3];
  return proof.holds(simplices, means);
}

/// Fills a component with few simplices: from the hull, as a cone from one of its own vertices (a polygon: by chords),
/// or by a dissection of the ball, whichever gives the fewest. The dissection may add one cone vertex.
bool fill_smallest(const FaceContours& faces, const HullContours& hulls, Signature signature, const Component& c,
                   std::uint8_t own_vertex, LocalFacet& facet) {
  LocalFacet other;
  facet.filling = Filling::pulled;
  const bool from_hull = fill_from_hull(faces, hulls, signature, c, facet);
  const bool from_own = faces.dim() == 3 ? !from_hull && cut_by_chords(faces, facet.points, other)
                        : c.euler == 2   ? pull(faces, c, other)
                                         : false;
  if (from_own && (!from_hull || other.simplices.size() < facet.simplices.size()))
    facet.simplices = std::move(other.simplices);
  if (faces.dim() == 4 && c.euler == 2) {
    const std::size_t limit = facet.simplices.empty() ? c.boundary.size() - 1 : facet.simplices.size() - 1;
    BallDissection ball = dissect_ball(c.boundary, SigmaComplex(faces, c.boundary), limit);
    if (!ball.empty()) take_dissection(std::move(ball), c, own_vertex, facet);
  }
  return !facet.simplices.empty();
}

/// The smallest filling of a sphere that is embedded for all positions: a cone from one of its own vertices or a
/// dissection, if it has fewer simplices than the cone from inside.
bool fill_embedded(const FaceContours& faces, const EmbeddingProof& proof, const Component& c, std::uint8_t own_vertex,
                   LocalFacet& facet) {
  const SigmaComplex sigma(faces, c.boundary);
  std::size_t limit = c.boundary.size() - 1;
  for (const std::uint8_t apex : c.vertices) {
    auto cone = pulled_cone(c, apex);
    if (cone.size() > limit || !proof.holds(cone) ||
        !std::all_of(cone.begin(), cone.end(), [&](const LocalSimplex& s) { return sigma.allows(s); }))
      continue;
    limit = cone.size() - 1;
    facet.simplices = std::move(cone);
    facet.filling = Filling::pulled;
  }
  const BallDissection ball = dissect_ball(c.boundary, sigma, limit, [&](const BallDissection& candidate) {
    return are_embedded(faces, proof, own_vertex, all_of(candidate, own_vertex));
  });
  if (!ball.empty()) take_dissection(ball, c, own_vertex, facet);
  return !facet.simplices.empty();
}

/// Fills a component compactly so that it is embedded for all positions. Returns false if no such filling has fewer
/// simplices than the cone from inside.
bool fill_compact(const FaceContours& faces, const FillingSources& sources, Signature signature, const Component& c,
                  std::uint8_t own_vertex, LocalFacet& facet) {
  if (!fill_smallest(faces, *sources.hulls, signature, c, own_vertex, facet)) return false;
  if (are_embedded(faces, *sources.proof, own_vertex, facet.simplices)) return true;
  facet.simplices.clear();
  return faces.dim() == 4 && c.euler == 2 && fill_embedded(faces, *sources.proof, c, own_vertex, facet);
}

}  // namespace

void fill(const FaceContours& faces, const FillingSources& sources, Signature signature, TileContour& contour) {
  const int n = faces.dim();
  const bool compact = faces.triangulation() == Triangulation::compact;
  for (const Component& c : components_of(n, contour.boundary)) {
    LocalFacet facet;
    facet.boundary_euler = c.euler;
    facet.boundary_facets = facets_around(faces, signature, c);
    for (const std::uint8_t v : c.vertices)
      if (v < faces.tile().edge_count()) facet.points.push_back(v);
    if (n == 3) facet.points = cycle_of(c);
    if (fill_simplex(n, c, facet)) {
      facet.filling = Filling::simplex;
    } else if (const auto own = static_cast<std::uint8_t>(faces.own_base() + contour.cone_vertices);
               compact && fill_compact(faces, sources, signature, c, own, facet)) {
      if (facet.filling == Filling::cone) ++contour.cone_vertices;
    } else if (n == 4 && c.euler != 2) {
      facet.filling = Filling::side;
      fill_by_side(faces, *sources.side_regions, signature, c.boundary, contour, facet);
    } else {
      facet.filling = Filling::cone;
      facet.simplices = cone(n, c, static_cast<std::uint8_t>(faces.own_base() + contour.cone_vertices++));
    }
    contour.facets.push_back(std::move(facet));
  }
}

}  // namespace tegl::gen
