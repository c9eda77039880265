// SPDX-License-Identifier: BSD-3-Clause
//
// Builds compact contours of 4D cells from those in their facets. A sphere is coned from a vertex if each of its
// triangles in a facet with that vertex has the vertex, so that the cone meets the cell's boundary in the sphere only,
// for all positions; otherwise it is coned from the mean of its points. Other components are filled as in the
// barycentric table, whose polygons have centres: these are moved into the cell, and the tetrahedra between them and
// the triangles of the facet are added. A tesseract whose facets are those of an image's has the image's contour.
#include "complex/built_cells.hpp"

#include <algorithm>
#include <bit>
#include <functional>
#include <utility>

#include "base/disjoint_sets.hpp"
#include "base/workers.hpp"
#include "complex/cell_cases.hpp"
#include "complex/edge_alpha.hpp"
#include "image/tile_heights.hpp"
#include "regions/separating_planes.hpp"
#include "tegl/generated/cells.hpp"
#include "tegl/generated/tables.hpp"
#include "tegl/shape_places.hpp"
#include "tegl/tile/corners.hpp"
#include "tile/extract_tables.hpp"
#include "tile/tesseract_fill.hpp"

namespace tegl::detail {

namespace {

using tables::CellShape;
using Triangle = FaceFillings::Triangle;
using Tetrahedron = std::array<std::uint8_t, 4>;

/// The place in the unit tesseract of a vertex that has a double (kDoubled).
template <class OnEdge>
TilePoint<4> doubled_place(unsigned cube, std::uint64_t mask, const std::array<double, 16>& values, double isovalue,
                           double epsilon, const OnEdge& on_edge) noexcept {
  if (cube == 8) return on_edge(static_cast<unsigned>(std::countr_zero(mask >> 16)));
  std::array<double, 8> of_cube;
  for (unsigned v = 0; v < 8; ++v) of_cube[v] = values[lifted_corner(cube, v)];
  if ((mask & 0xffu) != 0)
    return cube_point(cube, ResolvedCells::place_in_cube(static_cast<std::uint32_t>(mask), of_cube, isovalue, epsilon));
  Weighted<4> sum;  // the barycentre of a polygon
  for (std::uint64_t edges = mask >> 8; edges != 0; edges &= edges - 1)
    sum.add(on_edge(ResolvedCubes::lifted(cube, static_cast<unsigned>(std::countr_zero(edges)))), 1.0);
  for (double& x : sum.point) x /= sum.weight;
  return sum.point;
}

}  // namespace

BuiltCells::BuiltCells(CellShape shape, bool is_swept) : shape_(shape), table_(table_of(shape)) {
  table_.element_of = nullptr;
  for (const CellFacet& of : facets_of(shape)) {
    Facet& facet = facets_.emplace_back(Facet{&of, {}, is_swept && facets_.size() < 2});
    const tables::CellTable& table = table_of(of.shape);
    for (unsigned e = 0; e < table.edge_count; ++e)
      facet.edges[e] = edge_between(table_, of.corners[table.edges[2 * e]], of.corners[table.edges[2 * e + 1]]);
  }
}

unsigned BuiltCells::facet_signature(const Facet& facet, unsigned signature) noexcept {
  unsigned bits = 0;
  for (unsigned v = 0; v < facet.of->corner_count; ++v) bits |= (signature >> facet.of->corners[v] & 1u) << v;
  return bits;
}

std::array<Index, 8> BuiltCells::points_of(const Facet& facet, const Index* corners) noexcept {
  std::array<Index, 8> points{};
  for (unsigned v = 0; v < facet.of->corner_count; ++v) points[v] = corners[facet.of->corners[v]];
  return points;
}

CompactCells::CompactCells(CellShape shape, bool high_connected, bool is_swept)
    : BuiltCells(shape, is_swept), high_connected_(high_connected), barycentric_(table_of(shape)) {
  for (const Facet& facet : facets_)
    fillings_of_.push_back(&fillings_.try_emplace(facet.of->shape, facet.of->shape, high_connected).first->second);
  if (shape == CellShape::octahedron_prism)
    copied_ = std::make_unique<const DecidedCells>(shape, high_connected, is_swept);
}

CompactCells::~CompactCells() = default;

CellKey CompactCells::key(unsigned signature, const Index* corners, std::span<const double> /*values*/) const noexcept {
  CellKey key;
  key.signature = static_cast<std::uint16_t>(signature);
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    const unsigned bits = facet_signature(facets_[f], signature);
    const FaceFillings& of = *fillings_of_[f];
    key.fillings[f] = facets_[f].has_own ? of.own(bits) : of.choose(bits, points_of(facets_[f], corners).data());
  }
  return key;
}

std::span<const Triangle> CompactCells::triangles_in(std::size_t f, const CellKey& key) const {
  return fillings_of_[f]->triangles(facet_signature(facets_[f], key.signature), key.fillings[f]);
}

DecidedFacet CompactCells::in_facet(std::size_t f, const CellKey& key, const Index*) const {
  return {true, triangles_in(f, key)};
}

class CompactCells::Filler {
 public:
  Filler(const CompactCells& cells, const CellKey& key)
      : cells_(cells), key_(key), signature_(key.signature), shift_(cells.table_.corner_count) {
    for (std::size_t f = 0; f < cells.facets_.size(); ++f) {
      for (const std::uint8_t e : std::span(cells.facets_[f].edges).first(table_of_facet(f).edge_count))
        facets_of_edge_[e] |= 1u << f;
      const auto& edges = cells.facets_[f].edges;
      for (const Triangle& t : cells.triangles_in(f, key))
        sigma_.push_back({{edges[t[0]], edges[t[1]], edges[t[2]]}, f});
    }
  }

  BuiltContour operator()() {
    if (cells_.shape_ == CellShape::hexahedron_prism && is_of_image()) return std::move(built_);
    auto components = components_of(sigma_, cells_.table_.edge_count);
    const bool has_spheres =
        std::all_of(components.begin(), components.end(), [](const auto& c) { return is_sphere(c.second); });
    if (!has_spheres && has_unproved_copy()) return copied(cells_.high_connected_);
    if (!has_spheres) copy_barycentric(components);
    std::vector<std::size_t> ends;  // of the components' tetrahedra
    for (const auto& [root, component] : components) {
      add_sphere(component);
      ends.push_back(built_.tetrahedra.size());
    }
    if (has_spheres && ends.size() == 2 && may_meet(ends[0])) return copied(false);
    return std::move(built_);
  }

 private:
  using Piece = SigmaPiece<std::uint8_t>;
  using Component = std::vector<Piece>;

  [[nodiscard]] const tables::CellTable& table_of_facet(std::size_t f) const noexcept {
    return table_of(cells_.facets_[f].of->shape);
  }
  static std::uint32_t edges_of(const Triangle& t) noexcept { return 1u << t[0] | 1u << t[1] | 1u << t[2]; }
  static std::uint32_t edges_of(const Component& component) noexcept {
    std::uint32_t edges = 0;
    for (const Piece& piece : component) edges |= edges_of(piece.triangle);
    return edges;
  }
  /// By the Euler characteristic of a closed surface.
  static bool is_sphere(const Component& component) noexcept {
    return 2 * static_cast<std::size_t>(std::popcount(edges_of(component))) == component.size() + 4;
  }

  /// The tetrahedron between a triangle and a vertex inside the cell, with its positive side towards high.
  void add_cone(const Piece& piece, unsigned apex) {
    built_.tetrahedra.push_back(
        cone_of(piece.triangle, cells_.facets_[piece.facet].of->is_inverted, static_cast<std::uint8_t>(apex)));
  }

  /// Whether every triangle in a facet with a vertex has this vertex.
  [[nodiscard]] bool is_apex(unsigned vertex, const Component& component) const noexcept {
    return std::all_of(component.begin(), component.end(), [&](const Piece& piece) {
      return (facets_of_edge_[vertex] >> piece.facet & 1u) == 0 || (edges_of(piece.triangle) >> vertex & 1u) != 0;
    });
  }

  void add_sphere(const Component& component) {
    unsigned apex = cells_.table_.edge_count;
    std::ptrdiff_t most = 0;  // triangles at the apex, which need no tetrahedra
    for (std::uint32_t rest = edges_of(component); rest != 0; rest &= rest - 1) {
      const auto v = static_cast<unsigned>(std::countr_zero(rest));
      const auto around = std::count_if(component.begin(), component.end(),
                                        [&](const Piece& piece) { return (edges_of(piece.triangle) >> v & 1u) != 0; });
      if (around > most && is_apex(v, component)) apex = v, most = around;
    }
    if (most == 0) {
      apex += static_cast<unsigned>(built_.cones.size());
      built_.cones.push_back(std::uint64_t{edges_of(component)} << shift_);
    }
    for (const Piece& piece : component)
      if (most == 0 || (edges_of(piece.triangle) >> apex & 1u) == 0) add_cone(piece, apex);
  }

  /// Whether `gen` does not prove the table's copy of a side: in prisms over octahedra, copies for tori with more than
  /// ten polygons, two classes of signatures.
  [[nodiscard]] bool has_unproved_copy() const noexcept {
    constexpr unsigned kMostProved = 10;
    const CellContour contour(cells_.barycentric_, signature_, cells_.high_connected_);
    return cells_.copied_ != nullptr && contour.list().shared_vertices > kMostProved;
  }
  /// The contour with copies of the regions in facets.
  [[nodiscard]] BuiltContour copied(bool of_low_side) const {
    CellKey key = key_;
    if (of_low_side) key.tile = tile::Choice::high;
    return cells_.copied_->fill_as(key);
  }

  /// Whether the cones of two spheres, the first of which has the first tetrahedra, intersect for some positions. Of
  /// three spheres, hyperplanes divide any two.
  [[nodiscard]] bool may_meet(std::size_t first) const {
    if (cells_.copied_ == nullptr || !built_.cones.empty()) return false;
    std::vector<SeparatingPlanes::Tetrahedron> cones;
    for (const Tetrahedron& t : built_.tetrahedra) {
      auto& ends = cones.emplace_back();
      for (std::size_t k = 0; k < 4; ++k)
        ends[k] =
            static_cast<std::uint16_t>(1u << cells_.table_.edges[2 * t[k]] | 1u << cells_.table_.edges[2 * t[k] + 1]);
    }
    const std::span all(cones);
    return SeparatingPlanes(cells_.shape_).may_meet(all.first(first), all.subspan(first));
  }

  /// Fills the components that are not spheres, and those that the barycentric table fills together with them; removes
  /// them from `components`. Own vertices are numbered as cones, sides and collars.
  void copy_barycentric(std::map<Index, Component>& components) {
    const tables::CellTable& table = cells_.barycentric_;
    const CellContour contour(table, signature_, cells_.high_connected_);
    const tables::CellList& list = contour.list();
    DisjointSets sets(table.edge_count + list.added());
    for (unsigned i = 0; i < list.simplex_count; ++i)
      for (unsigned k = 1; k < 4; ++k) sets.join(contour.vertex(i, 0), contour.vertex(i, k));
    std::vector<bool> is_copied(table.edge_count + list.added());
    const auto root_of = [&](const Component& c) { return sets.find(c.front().triangle[0]); };
    for (const auto& [root, component] : components)
      if (!is_sphere(component)) is_copied[root_of(component)] = true;
    // vertices of the table in the order of the contract, with shared ones as collars
    std::vector<std::uint8_t> number(table.edge_count + list.added());
    for (unsigned v = 0; v < table.edge_count; ++v) number[v] = static_cast<std::uint8_t>(v);
    unsigned next = table.edge_count;
    const unsigned first_cone = list.shared_vertices, first_side = first_cone + list.cone_vertices;
    const auto take = [&](unsigned from, unsigned to, std::vector<std::uint64_t>& masks) {
      for (unsigned j = from; j < to; ++j) {
        if (!is_copied[sets.find(table.edge_count + j)]) continue;
        number[table.edge_count + j] = static_cast<std::uint8_t>(next++);
        masks.push_back(contour.mask(j));
      }
    };
    take(first_cone, first_side, built_.cones);
    const auto spheres = std::count_if(components.begin(), components.end(), [&](const auto& c) {
      return !is_copied[root_of(c.second)] && !has_apex(c.second);
    });
    next += static_cast<unsigned>(spheres);  // cones that are added later
    take(first_side, list.added(), built_.sides);
    take(0, first_cone, built_.collars);
    for (unsigned i = 0; i < list.simplex_count; ++i) {
      if (!is_copied[sets.find(contour.vertex(i, 0))]) continue;
      Tetrahedron t;
      for (unsigned k = 0; k < 4; ++k) t[k] = number[contour.vertex(i, k)];
      if (contour.reverses()) std::swap(t[2], t[3]);
      built_.tetrahedra.push_back(t);
    }
    for (auto at = components.begin(); at != components.end();) {
      if (!is_copied[root_of(at->second)]) {
        ++at;
        continue;
      }
      for (const Piece& piece : at->second)
        for (unsigned j = 0; j < first_cone; ++j)
          if (is_part(piece, contour.mask(j) >> shift_)) add_cone(piece, number[table.edge_count + j]);
      at = components.erase(at);
    }
  }

  [[nodiscard]] bool has_apex(const Component& component) const noexcept {
    for (std::uint32_t rest = edges_of(component); rest != 0; rest &= rest - 1)
      if (is_apex(static_cast<unsigned>(std::countr_zero(rest)), component)) return true;
    return false;
  }

  /// Whether a triangle is a part of the polygon with these points in the triangle's facet.
  [[nodiscard]] bool is_part(const Piece& piece, std::uint64_t polygon) const noexcept {
    if ((edges_of(piece.triangle) & ~polygon) != 0) return false;
    for (; polygon != 0; polygon &= polygon - 1)
      if ((facets_of_edge_[static_cast<std::size_t>(std::countr_zero(polygon))] >> piece.facet & 1u) == 0) return false;
    return true;
  }

  /// Whether the boundary is that of the tesseract's contour in images; if so, takes that contour.
  bool is_of_image() {
    const unsigned s = cells_.high_connected_ ? ~unsigned{signature_} & 0xffffu : signature_;
    const SimplexList<4> list(tables::kTile4Compact, s);
    std::array<std::uint8_t, 32> edge{};
    for (unsigned e = 0; e < 32; ++e) {
      const unsigned base = edge_base(4, e);
      edge[e] = edge_between(cells_.table_, base, base | 1u << e / 8);
    }
    constexpr unsigned kFirstOwn = tables::first_tile_vertex(4);
    std::vector<Tetrahedron> tetrahedra;
    std::vector<std::uint64_t> cones(list.list().cone_vertices);
    for (unsigned q = 0; q < list.size(); ++q) {
      Tetrahedron& t = tetrahedra.emplace_back();
      std::uint64_t edges = 0;
      for (unsigned j = 0; j < 4; ++j) {
        const unsigned v = list.stored(q, j);
        t[j] = static_cast<std::uint8_t>(v < kFirstOwn ? edge[list.mapped(v)] : 32 + v - kFirstOwn);
        if (v < kFirstOwn) edges |= std::uint64_t{1} << (16 + t[j]);
      }
      if (const unsigned apex = list.stored(q, 0); apex >= kFirstOwn && apex - kFirstOwn < cones.size())
        cones[apex - kFirstOwn] |= edges;
      if (list.reversed() != cells_.high_connected_) std::swap(t[2], t[3]);
    }
    if (boundary_of(tetrahedra) != sorted_sigma()) return false;
    built_ = {std::move(tetrahedra), {}, std::move(cones), {}, {}, true};
    for (unsigned j = 0; j < list.list().side_vertices; ++j) {
      std::uint64_t mask = 0;
      for (std::uint64_t rest = list.side_mask(j); rest != 0; rest &= rest - 1) {
        const auto bit = static_cast<unsigned>(std::countr_zero(rest));
        mask |= std::uint64_t{1} << (bit < 16 ? list.mapped_corner(bit) : 16u + list.mapped(bit - 16));
      }
      built_.sides.push_back(mask);
    }
    return true;
  }

  static std::vector<Triangle> boundary_of(const std::vector<Tetrahedron>& tetrahedra) {
    std::vector<Triangle> all, single;
    for (Tetrahedron t : tetrahedra) {
      std::sort(t.begin(), t.end());
      all.insert(all.end(), {{t[0], t[1], t[2]}, {t[0], t[1], t[3]}, {t[0], t[2], t[3]}, {t[1], t[2], t[3]}});
    }
    std::sort(all.begin(), all.end());
    for (std::size_t i = 0; i < all.size(); ++i)
      if (i + 1 < all.size() && all[i] == all[i + 1])
        ++i;
      else
        single.push_back(all[i]);
    return single;
  }
  [[nodiscard]] std::vector<Triangle> sorted_sigma() const {
    std::vector<Triangle> triangles;
    for (const Piece& piece : sigma_) {
      Triangle& t = triangles.emplace_back(piece.triangle);
      std::sort(t.begin(), t.end());
    }
    std::sort(triangles.begin(), triangles.end());
    return triangles;
  }

  const CompactCells& cells_;
  const CellKey& key_;
  std::uint16_t signature_;
  unsigned shift_;
  std::array<std::uint32_t, 32> facets_of_edge_{};  ///< as bits
  Component sigma_;
  BuiltContour built_;
};

void CompactCells::fill(std::span<const CellKey> keys, std::span<BuiltContour> contours) const {
  for (std::size_t k = 0; k < keys.size(); ++k) contours[k] = Filler(*this, keys[k])();
}

void BuiltCells::build(std::vector<CellKey> keys, const WorkOptions& work) {
  keys_ = std::move(keys);
  std::vector<BuiltContour> all(keys_.size());
  for_each_block(keys_.size(), 256, work.threads, work.progress, [&](std::size_t, std::size_t from, std::size_t to) {
    fill(std::span(keys_).subspan(from, to - from), std::span(all).subspan(from, to - from));
  });
  for (const BuiltContour& built : all) {
    tables::CellList& list = lists_.emplace_back();
    list.first_simplex = static_cast<std::uint32_t>(simplices_.size() / 4);
    list.first_mask = static_cast<std::uint32_t>(masks_.size());
    list.simplex_count = static_cast<std::uint16_t>(built.tetrahedra.size());
    list.shared_vertices = static_cast<std::uint8_t>(built.shared.size());
    list.cone_vertices = static_cast<std::uint8_t>(built.cones.size());
    list.side_vertices = static_cast<std::uint8_t>(built.sides.size());
    list.collar_vertices = static_cast<std::uint8_t>(built.collars.size());
    of_image_.push_back(built.of_image ? 1 : 0);
    for (const Tetrahedron& t : built.tetrahedra) simplices_.insert(simplices_.end(), t.begin(), t.end());
    for (const auto* masks : {&built.shared, &built.cones, &built.sides, &built.collars})
      masks_.insert(masks_.end(), masks->begin(), masks->end());
  }
  table_.lists = lists_.data();
  table_.simplices = simplices_.data();
  table_.masks = masks_.data();
}

std::array<double, 4> BuiltCells::place(std::uint64_t mask, const std::array<double, 16>& values, double isovalue,
                                        double epsilon) noexcept {
  const auto on_edge = [&](unsigned e) {
    const unsigned base = edge_base(4, e);
    return edge_point<4>(e, alpha_of(values[base], values[base | 1u << e / 8], isovalue, epsilon));
  };
  std::array<double, 16> heights;
  for (std::size_t v = 0; v < 16; ++v) heights[v] = values[v] - isovalue;
  const TileHeights<4> rays(heights, epsilon);
  const std::uint64_t points = mask & ((std::uint64_t{1} << 48) - 1);
  TilePoint<4> point;
  if ((mask & ResolvedTesseract::kIsDouble) != 0) {
    point = doubled_place(static_cast<unsigned>(mask >> kDoubled & 15u), points, values, isovalue, epsilon, on_edge);
    for (double& x : point) x = 0.25 + 0.5 * x;
  } else {
    point = mask_place<4>(points, std::identity(), on_edge, (mask & kIsUneven) != 0,
                          [&](const TilePoint<4>& end) { return rays.level(end); });
  }
  for (auto i = (mask & ResolvedTesseract::kRepeats) >> ResolvedTesseract::kRepeat; i != 0; --i)
    for (double& x : point) x = repeated_coordinate(x);
  return point;
}

std::uint32_t BuiltCells::variant(const CellKey& key) const noexcept {
  return static_cast<std::uint32_t>(std::lower_bound(keys_.begin(), keys_.end(), key) - keys_.begin());
}

}  // namespace tegl::detail
