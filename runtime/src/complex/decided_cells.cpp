// SPDX-License-Identifier: BSD-3-Clause
//
// Builds the contours of 4D cells whose ambiguous faces are decided from the data. Sigma, the contour in the cell's
// boundary, is put together from the contours in its facets. Components that are spheres are coned: in compact contours
// from one of their vertices if every triangle in a facet with that vertex has it, otherwise from their barycentre.
// Other components, and all if the cell's centre joins them, are filled with copies of the regions of one side of the
// boundary, moved towards the centre. If components are to stay separate, such a copy passes the spheres beside its
// region: it is a copy of the region with everything behind them. A region of a facet is a cone, as each of its
// polygons is a disc; in a hexahedron with a tunnel it is the table's (CubeRegions), around a tunnel in an octahedron a
// ring of cones. A tesseract with the facets of an image's tesseract has the image's contour.
#include <algorithm>
#include <bit>
#include <iterator>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "base/disjoint_sets.hpp"
#include "complex/built_cells.hpp"
#include "complex/cell_cases.hpp"
#include "regions/facet_regions.hpp"
#include "regions/oriented_tetrahedra.hpp"
#include "regions/region_parts.hpp"
#include "regions/separating_planes.hpp"
#include "regions/tunnel_regions.hpp"
#include "tegl/generated/cells.hpp"
#include "tegl/tile/corners.hpp"
#include "tile/extract_tables.hpp"
#include "tile/image_tesseract.hpp"
#include "tile/tesseract_fill.hpp"
#include "tile/variant_table.hpp"

namespace tegl::detail {

namespace {

using tables::CellShape;
/// Vertices of a cell while its contour is built: edges, then shared vertices; the others from these numbers on.
using Local = std::uint16_t;
constexpr Local kShared = 64, kCones = 256, kSides = 512, kCollars = 768, kCorners = 1024, kCentres = 1280,
                kLocals = 2304;
using Triangle = std::array<Local, 3>;
using Tetrahedron = std::array<Local, 4>;

}  // namespace

DecidedCells::DecidedCells(CellShape shape, Triangulation triangulation, FaceRule rule, double isovalue, bool is_swept)
    : BuiltCells(shape, is_swept), triangulation_(triangulation), rule_(rule), isovalue_(isovalue) {
  for (const Facet& facet : facets_) {
    std::vector<std::uint8_t>& in_facet = quadrilaterals_in_.emplace_back();
    for (const auto& corners : quadrilaterals_of(facet.of->shape)) {
      std::array<std::uint8_t, 4> of_cell{};
      for (std::size_t i = 0; i < 4; ++i) of_cell[i] = facet.of->corners[corners[i]];
      auto found = std::find_if(quadrilaterals_.begin(), quadrilaterals_.end(), [&](const auto& q) {
        return std::is_permutation(q.begin(), q.end(), of_cell.begin());
      });
      if (found == quadrilaterals_.end()) found = quadrilaterals_.insert(found, of_cell);
      in_facet.push_back(static_cast<std::uint8_t>(found - quadrilaterals_.begin()));
    }
    if (facet.of->shape == CellShape::wedge && wedges_ == nullptr)
      wedges_ = std::make_unique<ResolvedCells>(CellShape::wedge, tables::cell_table(CellShape::wedge, triangulation),
                                                triangulation, rule, isovalue);
    if (facet.of->shape == CellShape::octahedron && octahedra_ == nullptr)
      octahedra_ = std::make_unique<ResolvedCells>(CellShape::octahedron,
                                                   tables::cell_table(CellShape::octahedron, triangulation),
                                                   triangulation, rule, isovalue);
    if (triangulation == Triangulation::compact && facet.of->shape != CellShape::hexahedron &&
        fillings_.count(facet.of->shape) == 0)
      fillings_.try_emplace(facet.of->shape,
                            std::array{FaceFillings(facet.of->shape, false), FaceFillings(facet.of->shape, true)});
  }
}

DecidedCells::DecidedCells(CellShape shape, bool high_connected, bool is_swept)
    : DecidedCells(shape, Triangulation::compact, {FaceRule::By::means, true}, 0.0, is_swept) {
  high_connected_ = high_connected;
}

DecidedCells::~DecidedCells() = default;

bool DecidedCells::has_frame(unsigned signature, unsigned squares, tile::Choice choice) const noexcept {
  if (triangulation_ == Triangulation::compact) return true;
  return has_tunnel(CubeContour(0, signature, squares, choice).list);
}

/// Builds contours one after the other.
class DecidedCells::Filler {
 public:
  explicit Filler(const DecidedCells& cells)
      : cells_(cells),
        corners_(cells.table_.corner_count),
        edges_(cells.table_.edge_count),
        cubes_(ResolvedCubes::instance(cells.triangulation_)),
        regions_of_(CubeRegions::instance(cells.triangulation_)),
        tesseract_(make_resolved_tesseract(cells.triangulation_)) {
    for (std::uint8_t e = 0; e < edges_; ++e) {
      const unsigned p = cells.table_.edges[2 * e], q = cells.table_.edges[2 * e + 1];
      edge_between_[16 * p + q] = edge_between_[16 * q + p] = e;
    }
    for (std::size_t f = 0; f < cells.facets_.size(); ++f)
      for (unsigned e = 0; e < table_of(cells.facets_[f].of->shape).edge_count; ++e)
        facets_of_edge_[cells.facets_[f].edges[e]] |= 1u << f;
  }

  BuiltContour operator()(const CellKey& key) {
    begin(key);
    const bool has_image = cells_.shape_ == CellShape::hexahedron_prism && key.fillings == CellKey().fillings;
    has_image ? take_from_image() : fill();
    return std::move(built_);
  }

 private:
  using Piece = SigmaPiece<Local>;
  using Component = std::vector<Piece>;
  using Components = std::map<Index, Component>;

  void begin(const CellKey& key) {
    key_ = &key;
    built_ = {};
    sigma_.clear();
    tetrahedra_.clear();
    fans_.clear();
    centres_.clear();
    contours_.assign(cells_.facets_.size(), std::nullopt);
  }

  void fill() {
    for (std::size_t f = 0; f < cells_.facets_.size(); ++f) add_contour(f);
    auto components = components_of(sigma_, kCones);
    if ((joins() && components.size() > 1) ||
        std::any_of(components.begin(), components.end(), [](const auto& c) { return !is_sphere(c.second); }))
      copy_regions(key_->tile != tile::Choice::high, components);
    else
      copy_if_cones_meet(components);
    for (const auto& [root, component] : components) add_sphere(component);
    finish();
  }

  /// Whether the cell's centre joins components. By a fixed rule, `tile` has only the side that is copied.
  [[nodiscard]] bool joins() const noexcept { return !cells_.high_connected_ && key_->tile != tile::Choice::separate; }

  static Local corner_of(const Facet& facet, unsigned v) { return static_cast<Local>(kCorners + facet.of->corners[v]); }
  [[nodiscard]] std::uint64_t bit_of(Local v) const noexcept {
    return std::uint64_t{1} << (v < edges_ ? corners_ + v : v - unsigned{kCorners});
  }

  void add_contour(std::size_t f) {
    const Facet& facet = cells_.facets_[f];
    const unsigned bits = facet_signature(facet, key_->signature);
    if (bits == 0 || bits + 1 == 1u << facet.of->corner_count) return;
    if (facet.of->shape == CellShape::hexahedron) return add_cube(f, bits);
    const bool has_ring = cells_.has_ring(f, *key_);
    const auto variant =
        has_ring ? ResolvedCells::tunnel_variant(*cells_.lone_pair_in(f, bits))
        : facet.of->shape == CellShape::octahedron  // by `low` in contours that are decided
            ? std::uint16_t{cells_.high_connected_}
            : ResolvedCells::variant(bits, cells_.ambiguous_in(f, key_->signature), cells_.high_in(f, *key_));
    if (variant < 2 && cells_.triangulation_ == Triangulation::compact) {
      for (const auto& t : cells_.fillings_.at(facet.of->shape)[variant].triangles(bits, key_->fillings[f]))
        sigma_.push_back({{facet.edges[t[0]], facet.edges[t[1]], facet.edges[t[2]]}, f});
      return;
    }
    const tables::CellTable& table = tables::cell_table(facet.of->shape, cells_.triangulation_);
    const CellContour contour = variant < 2 ? CellContour(table, bits, variant == 1)
                                            : (has_ring ? cells_.octahedra_ : cells_.wedges_)->contour(variant);
    const Local first = first_own_[f] = static_cast<Local>(kShared + built_.shared.size());
    for (unsigned j = 0; j < contour.list().added(); ++j) {
      std::uint64_t mask = 0;
      for (std::uint64_t rest = contour.mask(j) >> table.corner_count; rest != 0; rest &= rest - 1)
        mask |= bit_of(facet.edges[static_cast<std::size_t>(std::countr_zero(rest))]);
      built_.shared.push_back(mask);
    }
    for (unsigned i = 0; i < contour.list().simplex_count; ++i) {
      Triangle t;
      for (unsigned k = 0; k < 3; ++k) {
        const unsigned v = contour.vertex(i, k);
        t[k] = v < table.edge_count ? facet.edges[v] : static_cast<Local>(first + v - table.edge_count);
      }
      if (contour.reverses()) std::swap(t[1], t[2]);
      sigma_.push_back({t, f});
    }
  }

  /// The cell's vertex on an edge of a cube's frame.
  [[nodiscard]] Local on_edge(const Facet& facet, const CubeFrame& frame, unsigned e) const noexcept {
    const unsigned base = edge_base(3, e);
    const unsigned p = facet.of->corners[frame.corner(base)], q = facet.of->corners[frame.corner(base | 1u << e / 4)];
    return edge_between_[16 * p + q];
  }
  /// The mask in the cell of corners (bit v) and edges (bit 8 + e) of a cube's frame.
  [[nodiscard]] std::uint64_t mask_of(const Facet& facet, const CubeFrame& frame, std::uint32_t mask) const noexcept {
    std::uint64_t result = 0;
    for (unsigned v = 0; v < 8; ++v)
      if ((mask >> v & 1u) != 0) result |= bit_of(corner_of(facet, frame.corner(v)));
    for (unsigned e = 0; e < 12; ++e)
      if ((mask >> (8 + e) & 1u) != 0) result |= bit_of(on_edge(facet, frame, e));
    return result;
  }

  /// Adds a cube's own vertex.
  void add_shared(std::size_t f, const CubeFrame& frame, unsigned list, unsigned own) {
    const bool is_mean = own < cubes_.summary(list).barycentres;
    built_.shared.push_back(mask_of(cells_.facets_[f], frame, cubes_.mask(list, own)) |
                            (is_mean ? 0 : std::uint64_t{1} << (kOwnOfFacet + f)));
  }

  void add_cube(std::size_t f, unsigned bits) {
    const Facet& facet = cells_.facets_[f];
    const auto choice = static_cast<tile::Choice>(key_->cubes >> 2 * f & 3u);
    const CubeContour& of = contours_[f].emplace(key_->fillings[f], bits, cells_.high_in(f, *key_), choice);
    first_own_[f] = static_cast<Local>(kShared + built_.shared.size());
    for (unsigned j = 0; j < cubes_.own_vertices(of.list); ++j) add_shared(f, of.frame, of.list, j);
    const std::span<const std::uint8_t> triangles = cubes_.triangles_of(of.list);
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
      Triangle t;
      for (std::size_t k = 0; k < 3; ++k) {
        const unsigned v = triangles[i + k];
        t[k] = v < 12 ? on_edge(facet, of.frame, v) : static_cast<Local>(first_own_[f] + v - 12);
      }
      if (of.frame.is_mirrored()) std::swap(t[1], t[2]);
      sigma_.push_back({t, f});
    }
  }

  /// The tetrahedron between a triangle and a vertex inside the cell, with its positive side towards high.
  [[nodiscard]] Tetrahedron cone_of(const Piece& piece, Local apex) const noexcept {
    return detail::cone_of(piece.triangle, cells_.facets_[piece.facet].of->is_inverted, apex);
  }

  /// The vertex of a sphere that its cone starts at; kLocals: its barycentre.
  [[nodiscard]] Local apex_of(const Component& component) const {
    Local apex = kLocals;
    std::ptrdiff_t most = 0;  // triangles at the apex, which need no tetrahedra
    for (const Local v : vertices_of(component)) {
      if (v >= edges_ || (cells_.triangulation_ == Triangulation::barycentric && component.size() > 4)) break;
      const auto around = std::count_if(component.begin(), component.end(),
                                        [&](const Piece& piece) { return has_vertex(piece.triangle, v); });
      const bool is_apex =
          component.size() == 4 || std::all_of(component.begin(), component.end(), [&](const Piece& p) {
            return (facets_of_edge_[v] >> p.facet & 1u) == 0 || has_vertex(p.triangle, v);
          });
      if (around > most && is_apex) apex = v, most = around;
    }
    return apex;
  }

  void add_sphere(const Component& component) {
    Local apex = apex_of(component);
    const bool is_inside = apex == kLocals;
    if (is_inside) {
      apex = static_cast<Local>(kCones + built_.cones.size());
      std::uint64_t mask = 0;
      for (const Local v : vertices_of(component)) mask |= v < edges_ ? bit_of(v) : 0;
      built_.cones.push_back(mask);
    }
    for (const Piece& piece : component)
      if (is_inside || !has_vertex(piece.triangle, apex)) tetrahedra_.push_back(cone_of(piece, apex));
  }

  /// The cone of a sphere by the ends of its vertices' edges; empty if some vertices are not on edges.
  [[nodiscard]] std::vector<SeparatingPlanes::Tetrahedron> cone_on_edges(const Component& component) const {
    std::vector<SeparatingPlanes::Tetrahedron> cone;
    const Local apex = apex_of(component);
    if (apex == kLocals || vertices_of(component).back() >= edges_) return cone;
    const auto ends = [&](Local v) { return static_cast<std::uint16_t>(span_of(v)); };
    for (const auto& [t, facet] : component)
      if (!has_vertex(t, apex)) cone.push_back({ends(apex), ends(t[0]), ends(t[1]), ends(t[2])});
    return cone;
  }

  /// If the cones of two spheres intersect for some positions, fills each with a copy of a region that it alone bounds.
  void copy_if_cones_meet(Components& components) {
    if (components.size() != 2) return;  // of three, hyperplanes divide any two
    const Component &a = components.begin()->second, &b = components.rbegin()->second;
    if (!SeparatingPlanes(cells_.shape_).may_meet(cone_on_edges(a), cone_on_edges(b))) return;
    // of the three regions, the middle one is on the other side than the two others
    for (const bool high : {true, false}) {
      DisjointSets sets = find_regions(high);
      if (sets.find(a.front().triangle[0]) == sets.find(b.front().triangle[0])) continue;
      copy(
          sets, [](Index) { return true; }, components);
      return;
    }
  }

  /// Fills components with copies of the regions beside them on one side, and removes them.
  void copy_regions(bool high, Components& components) {
    DisjointSets sets = find_regions(high);
    std::map<Index, std::vector<const Component*>> beside;
    for (const auto& [root, component] : components) beside[sets.find(first_of(component))].push_back(&component);
    std::map<Index, bool> is_copied;
    std::vector<Index> passing;  // regions whose copies pass spheres beside them
    for (const auto& [region, of] : beside) {
      const auto spheres =
          std::count_if(of.begin(), of.end(), [](const Component* component) { return is_sphere(*component); });
      const bool has_others = static_cast<std::size_t>(spheres) < of.size();
      is_copied[region] = has_others || (of.size() > 1 && joins());
      if (has_others && spheres > 0 && !joins()) passing.push_back(region);
    }
    for (std::size_t f = 0; f < contours_.size() && !passing.empty(); ++f)  // its regions cannot be divided otherwise
      if (has_tunnel(f) && components_in(f, components) > 1) passing.clear();
    if (!passing.empty()) pass_spheres(high, sets, passing, components);
    for (const Index region : passing) is_copied[region] = false;
    copy(
        sets, [&](Index region) { return is_copied[region]; }, components);
  }

  /// Fills the components beside regions whose copies pass spheres, and removes them. A sphere that is alone beside the
  /// region behind it is filled with a copy of that region, nearer to the boundary, otherwise coned.
  void pass_spheres(bool high, DisjointSets& sets, const std::vector<Index>& passing, Components& components) {
    const std::vector<Tetrahedron> regions = std::move(regions_);
    DisjointSets behind = find_regions(!high);
    std::map<Index, unsigned> around;  // components by region
    for (const auto& [root, component] : components) ++around[behind.find(first_of(component))];
    const auto is_done = [&](const Component& c) {
      return std::find(passing.begin(), passing.end(), sets.find(first_of(c))) != passing.end();
    };
    for (const auto& [root, sphere] : components) {
      if (!is_done(sphere) || !is_sphere(sphere)) continue;
      const Index region = behind.find(first_of(sphere));
      if (around[region] > 1)
        add_sphere(sphere);
      else
        add_copies(tetrahedra_in(region, behind, regions_), sphere, true);
    }
    for (const Index region : passing) copy_past_spheres(high, region, sets, behind, components);
    std::erase_if(components, [&](const auto& c) { return is_done(c.second); });
    regions_ = regions;
  }

  /// Fills the components beside a region that are no spheres: with a copy of the region as it were if everything
  /// behind the spheres was on its side.
  void copy_past_spheres(bool high, Index region, DisjointSets& sets, DisjointSets& behind,
                         const Components& components) {
    RegionParts parts(sets, behind, kLocals, region);
    auto [sigma, boundary] = parts.pass_spheres(components);
    CellKey key = *key_;
    for (unsigned v = 0; v < corners_; ++v) {
      const bool is_near = (key_->signature >> v & 1u) == (high ? 1u : 0u);
      if (!is_near && parts.is_passed(kCorners + v)) key.signature ^= static_cast<std::uint16_t>(1u << v);
    }
    auto contours = contours_;
    for (std::size_t f = 0; f < contours.size(); ++f) {
      if (std::any_of(sigma.begin(), sigma.end(), [&](const Piece& piece) { return piece.facet == f; })) continue;
      contours[f].reset();
      key.cubes = static_cast<std::uint16_t>(key.cubes & ~(3u << 2 * f));
    }
    const CellKey* const own = std::exchange(key_, &key);
    sigma_.swap(sigma);
    contours_.swap(contours);
    DisjointSets joined = find_regions(high);
    add_copies(tetrahedra_in(joined.find(first_of(boundary)), joined, regions_), boundary, false);
    key_ = own;
    sigma_.swap(sigma);
    contours_.swap(contours);
  }

  [[nodiscard]] bool has_tunnel(std::size_t f) const noexcept {
    return contours_[f] && detail::has_tunnel(contours_[f]->list);
  }

  /// Divides the regions of one side into tetrahedra, and returns those that are connected, by vertices.
  DisjointSets find_regions(bool high) {
    regions_.clear();
    fans_.clear();
    for (const bool tunnels : {true, false})  // the triangles in quadrilaterals are those beside tunnels
      for (std::size_t f = 0; f < cells_.facets_.size(); ++f)
        if (has_tunnel(f) == tunnels) tunnels ? add_cube_regions(f, high) : add_regions(f, high);
    DisjointSets sets(kLocals);
    for (const Tetrahedron& t : regions_)
      for (std::size_t k = 1; k < 4; ++k) sets.join(t[0], t[k]);
    return sets;
  }

  /// Adds copies of regions, and removes the components beside them. `sets`: of find_regions.
  template <class IsCopied>
  void copy(DisjointSets& sets, const IsCopied& is_copied, Components& components) {
    const Component boundary = take_components(
        components, [&](const Component& component) { return is_copied(sets.find(first_of(component))); });
    std::vector<Tetrahedron> copied;
    std::copy_if(regions_.begin(), regions_.end(), std::back_inserter(copied),
                 [&](const Tetrahedron& t) { return is_copied(sets.find(t[0])); });
    add_copies(std::move(copied), boundary, false);
  }

  /// Adds copies of tetrahedra, which keep the vertices of their boundary. `collars`: half as far from there as others.
  void add_copies(std::vector<Tetrahedron> copies, const Component& boundary, bool collars) {
    std::vector<bool> is_kept(kLocals);
    std::vector<Triangle> starts;
    for (const Piece& piece : boundary) {
      starts.push_back(face_of(cone_of(piece, kLocals), 3));
      for (const Local v : piece.triangle) is_kept[v] = true;
    }
    std::vector<Local> copy_of(kLocals);  // 0: no copy yet
    std::vector<std::uint64_t>& masks = collars ? built_.collars : built_.sides;
    for (Tetrahedron& t : copies)
      for (Local& v : t) {
        if (is_kept[v]) continue;
        if (copy_of[v] == 0) {
          copy_of[v] = static_cast<Local>((collars ? kCollars : kSides) + masks.size());
          masks.push_back(v < kCentres ? bit_of(v) : centres_[v - kCentres]);
        }
        v = copy_of[v];
      }
    orient(copies, std::move(starts));
    tetrahedra_.insert(tetrahedra_.end(), copies.begin(), copies.end());
  }

  Local add_centre(std::uint64_t mask) {
    centres_.push_back(mask);
    return static_cast<Local>(kCentres + centres_.size() - 1);
  }

  /// The corners that a vertex in a quadrilateral lies between; all if it is not in the cell's edges.
  [[nodiscard]] unsigned span_of(Local v) const noexcept {
    if (v < edges_) return 1u << cells_.table_.edges[2 * v] | 1u << cells_.table_.edges[2 * v + 1];
    return v >= kCorners && v < kCentres ? 1u << (v - kCorners) : 0xffffu;
  }

  /// The regions of a cube with a tunnel.
  void add_cube_regions(std::size_t f, bool high) {
    const Facet& facet = cells_.facets_[f];
    const CubeFrame& frame = contours_[f]->frame;
    const auto corner = [&](unsigned v) { return corner_of(facet, frame.corner(v)); };
    const auto edge = [&](unsigned e) { return on_edge(facet, frame, e); };
    const auto centre = [&](std::uint32_t mask) { return add_centre(mask_of(facet, frame, mask)); };
    auto faces = add_tunnel_regions(regions_of_, cubes_, contours_[f]->list, high, static_cast<Local>(first_own_[f]),
                                    corner, edge, centre, regions_);
    for (const Piece& piece : sigma_)
      if (piece.facet == f) faces.erase(sorted(piece.triangle));
    for (const std::uint8_t q : cells_.quadrilaterals_in_[f]) {
      const unsigned square = corners_of(q);
      add_square_fan(
          faces, square, [&](Local v) { return (span_of(v) & ~square) == 0; }, fans_, regions_);
    }
  }

  /// The region of an octahedron around a tunnel: between its four quadrilaterals and the boundary, in as many sectors.
  void add_ring(std::size_t f, const RegionSides<Local>& sides) {
    for (unsigned j = 0; j < 4; ++j) {
      const auto centre = static_cast<Local>(first_own_[f] + j);  // of the quadrilateral
      std::uint64_t sector = built_.shared[centre - kShared];
      std::vector<Triangle> walls;
      for (unsigned v = 0; v < corners_; ++v) {  // the walls to both neighbours
        Triangle wall{static_cast<Local>(kCorners + v), 0, 0};
        std::size_t count = 1;
        for (Local e = 0; e < edges_ && count < 3; ++e)
          if ((built_.shared[centre - kShared] & bit_of(e)) != 0 &&
              (cells_.table_.edges[2 * e] == v || cells_.table_.edges[2 * e + 1] == v))
            wall[count++] = e;
        const unsigned lone = key_->signature >> v & 1u;
        if (count < 3 || lone == (static_cast<tile::Choice>(key_->cubes >> 2 * f & 3u) == tile::Choice::high ? 1u : 0u))
          continue;
        sector |= bit_of(wall[0]);
        walls.push_back(wall);
      }
      const auto is_in = [&](Local v) { return (sector & bit_of(v)) != 0; };
      cone_sector(sides, walls, centre, is_in, add_centre(sector), regions_);
    }
  }

  /// The regions of a facet in which all polygons are discs, or of an octahedron.
  void add_regions(std::size_t f, bool high) {
    const Facet& facet = cells_.facets_[f];
    RegionSides<Local> sides;
    for (const CellFacet& face : facets_of(facet.of->shape)) {
      std::vector<std::uint8_t> around;
      for (unsigned i = 0; i < face.corner_count; ++i) around.push_back(facet.of->corners[face.corners[i]]);
      if (face.corner_count == 4) std::swap(around[2], around[3]);
      add_parts(around, high, sides);
    }
    for (const Piece& piece : sigma_)
      if (piece.facet == f) sides.of_contour.push_back(piece.triangle);
    const auto inside = high ? tile::Choice::high : tile::Choice::low;
    if (cells_.has_ring(f, *key_) && static_cast<tile::Choice>(key_->cubes >> 2 * f & 3u) != inside)
      return add_ring(f, sides);
    const auto add = [&](const std::vector<Local>& vertices) {
      std::uint64_t mask = 0;
      for (const Local v : vertices) mask |= bit_of(v);
      return add_centre(mask);
    };
    cone_regions(sides, kCorners, kLocals, add, regions_);
  }

  /// The parts of a polygon on one side, with their triangles. `around`: its corners in order.
  void add_parts(std::span<const std::uint8_t> around, bool high, RegionSides<Local>& sides) const {
    const std::size_t count = around.size();
    unsigned polygon = 0;
    for (const std::uint8_t v : around) polygon |= 1u << v;
    const auto is_in = [&](std::size_t i) { return (key_->signature >> around[i % count] & 1u) == (high ? 1u : 0u); };
    const auto edge = [&](std::size_t i) {
      return Local{edge_between_[16u * around[i % count] + around[(i + 1) % count]]};
    };
    const auto corner = [&](std::size_t i) { return static_cast<Local>(kCorners + around[i % count]); };
    const std::size_t first = sides.parts.size();
    const bool is_apart = count == 4 && is_square_joined(polygon) != high;
    add_polygon_parts(count, is_apart, is_in, corner, edge, sides.parts);
    const auto fan = fans_.find(polygon);
    if (fan == fans_.end()) return add_part_triangles(first, sides);
    sides.triangles.insert(sides.triangles.end(), fan->second.begin(), fan->second.end());
  }

  /// `square`: its corners.
  [[nodiscard]] bool is_square_joined(unsigned square) const noexcept {
    for (std::size_t q = 0; q < cells_.quadrilaterals_.size(); ++q)
      if (corners_of(q) == square) return (key_->squares >> q & 1u) != 0;
    return false;
  }
  [[nodiscard]] unsigned corners_of(std::size_t quadrilateral) const noexcept {
    const auto& of = cells_.quadrilaterals_[quadrilateral];
    return 1u << of[0] | 1u << of[1] | 1u << of[2] | 1u << of[3];
  }

  void finish() {
    const std::size_t first_cone = edges_ + built_.shared.size(), first_side = first_cone + built_.cones.size(),
                      first_collar = first_side + built_.sides.size();
    if (first_collar + built_.collars.size() > 256) throw std::length_error("a cell with more than 256 vertices");
    for (const Tetrahedron& t : tetrahedra_) {
      auto& to = built_.tetrahedra.emplace_back();
      for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t v = t[k];
        to[k] = static_cast<std::uint8_t>(v >= kCollars  ? first_collar + v - kCollars
                                          : v >= kSides  ? first_side + v - kSides
                                          : v >= kCones  ? first_cone + v - kCones
                                          : v >= kShared ? edges_ + v - kShared
                                                         : v);
      }
    }
  }

  /// The tesseract of an image with this key. Facet f is its cube of the same corners, in the same order.
  [[nodiscard]] ResolvedKey image_key(std::array<std::size_t, 8>& facet_of) const noexcept {
    ResolvedKey key;
    key.signature = key_->signature;
    key.tile = key_->tile;
    for (std::size_t f = 0; f < 8; ++f) {
      const unsigned cube = cube_with_corners(cells_.facets_[f].of->corners);
      facet_of[cube] = f;
      const auto choice = static_cast<tile::Choice>(key_->cubes >> 2 * f & 3u);
      if (choice == tile::Choice::low) key.low_cubes = static_cast<std::uint8_t>(key.low_cubes | 1u << cube);
      if (choice == tile::Choice::high) key.high_cubes = static_cast<std::uint8_t>(key.high_cubes | 1u << cube);
    }
    for (unsigned q = 0; q < 24; ++q) key.squares |= (is_square_joined(corners_of_square(q)) ? 1u : 0u) << q;
    return key;
  }

  void take_from_image() {
    std::array<std::size_t, 8> facet_of{};
    const ResolvedKey key = image_key(facet_of);
    const ResolvedCubes::Lists lists = ResolvedTesseract::lists_of(key);
    const ResolvedView& view = tesseract_.find(key, lists);
    std::array<Local, 256> local{};
    for (unsigned e = 0; e < 32; ++e) local[e] = on_edge_of_image(e);
    for (unsigned cube = 0; cube < 8; ++cube) add_own_of_cube(cube, facet_of[cube], lists[cube], local);
    // as images: a compact contour that does not depend on the data has plain means
    const bool is_even = cells_.triangulation_ == Triangulation::compact && !ambiguous_signatures<4>()[key_->signature];
    for (unsigned j = 0; j < view.own_vertices; ++j) {
      const std::uint64_t mask = view.masks[j];
      Local& to = local[ResolvedTesseract::kFirstOwn + j];
      if ((mask & ResolvedTesseract::kIsBarycentre) != 0) {
        to = static_cast<Local>(kCones + built_.cones.size());
        std::uint64_t& cone = built_.cones.emplace_back(0);
        for (std::uint32_t edges = edges_around(view, ResolvedTesseract::kFirstOwn + j); edges != 0; edges &= edges - 1)
          cone |= bit_of(on_edge_of_image(static_cast<unsigned>(std::countr_zero(edges))));
        continue;
      }
      to = static_cast<Local>(kSides + built_.sides.size());
      built_.sides.push_back((mask & ResolvedTesseract::kIsDouble) != 0
                                 ? doubled_mask(cubes_, lists, static_cast<unsigned>(mask & 0xffu), kDoubled) |
                                       (mask & (ResolvedTesseract::kIsDouble | ResolvedTesseract::kRepeats))
                                 : mask | (is_even ? 0 : kIsUneven));
    }
    for (std::uint32_t i = 0; i < view.simplex_count; ++i) {
      Tetrahedron& t = tetrahedra_.emplace_back();
      for (std::size_t k = 0; k < 4; ++k) t[k] = local[view.simplices[4 * i + k]];
    }
    built_.of_image = true;
    finish();
  }

  void add_own_of_cube(unsigned cube, std::size_t f, unsigned list, std::array<Local, 256>& local) {
    if (list == ResolvedCubes::kNone) return;
    for (unsigned j = 0; j < cubes_.own_vertices(list); ++j) {
      local[ResolvedCubes::kEdges + ResolvedCubes::kMostOwn * cube + j] =
          static_cast<Local>(kShared + built_.shared.size());
      add_shared(f, CubeFrame::of_number(0), list, j);
    }
  }

  /// The cell's vertex on an edge of an image's tesseract.
  [[nodiscard]] Local on_edge_of_image(unsigned e) const noexcept {
    const unsigned base = edge_base(4, e);
    return edge_between_[16 * base + (base | 1u << e / 8)];
  }

  const DecidedCells& cells_;
  unsigned corners_, edges_;
  const ResolvedCubes& cubes_;
  const CubeRegions& regions_of_;
  ResolvedTesseract tesseract_;
  std::array<std::uint8_t, 256> edge_between_{};    ///< by 16 * corner + corner
  std::array<std::uint32_t, 32> facets_of_edge_{};  ///< as bits
  // The current contour:
  const CellKey* key_ = nullptr;
  BuiltContour built_;
  Component sigma_;
  std::vector<Tetrahedron> tetrahedra_, regions_;
  std::map<unsigned, std::vector<Triangle>> fans_;  ///< by corners of the quadrilateral: its triangles, sorted
  std::vector<std::uint64_t> centres_;              ///< masks
  std::vector<std::optional<CubeContour>> contours_;
  std::array<Local, 16> first_own_{};
};

BuiltContour DecidedCells::fill_as(CellKey key) const {
  for (std::size_t q = 0; q < quadrilaterals_.size(); ++q)
    key.squares |= (high_connected_ && is_ambiguous_square(key.signature, quadrilaterals_[q]) ? 1u : 0u) << q;
  return Filler(*this)(key);
}

void DecidedCells::fill(std::span<const CellKey> keys, std::span<BuiltContour> contours) const {
  Filler filler(*this);
  for (std::size_t k = 0; k < keys.size(); ++k) contours[k] = filler(keys[k]);
}

}  // namespace tegl::detail
