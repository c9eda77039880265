// SPDX-License-Identifier: BSD-3-Clause
//
// The step of the recursion over dimension: builds contour, high part and low part of a face from the pieces of its own
// faces.
#include "pieces.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace tegl::tile {

namespace {

Simplex mapped(const Simplex& simplex, const std::vector<VertexId>& map) {
  Simplex result = kNoSimplex;
  for (int i = 0; i < kMaxVertices && simplex[i] != kNoVertex; ++i) result[i] = map[simplex[i]];
  return result;  // maps are ascending
}

/// Appends a vertex whose number exceeds all others.
Simplex with_last(const Simplex& simplex, VertexId last) {
  Simplex result = simplex;
  result[static_cast<std::size_t>(size(simplex))] = last;
  return result;
}

/// Joins the vertices of each simplex.
void join_vertices(const Simplices& simplices, VertexSets& sets) {
  for (const Simplex& s : simplices)
    for (int i = 1; i < kMaxVertices && s[i] != kNoVertex; ++i) sets.join(s[0], s[i]);
}

/// Sorts simplices by components. start[c] is the first position of component c; the last entry is the total.
template <class Visit>
void group(const Simplices& simplices, VertexSets& sets, std::vector<std::uint32_t>& number_of,
           std::vector<std::uint32_t>& start, const Visit& visit) {
  constexpr std::uint32_t kNew = ~std::uint32_t{0};
  start.assign(1, 0);
  // count per component, in order of first appearance
  for (const Simplex& s : simplices) {
    std::uint32_t& number = number_of[sets.find(s[0])];
    if (number == kNew) {
      number = static_cast<std::uint32_t>(start.size() - 1);
      start.push_back(0);
    }
    ++start[number + 1];
  }
  // prefix sum, then write
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<std::uint32_t> next(start.begin(), start.end());
  for (std::size_t j = 0; j < simplices.size(); ++j) visit(j, next[number_of[sets.find(simplices[j][0])]]++);
}

/// Euler characteristic of a closed manifold. Constant time for points, curves, surfaces and 3-manifolds.
int closed_euler_characteristic(std::span<const Simplex> simplices, std::size_t vertices) {
  switch (size(simplices.front())) {
    case 1:
      return 2;  // one point: with the other end of the curve
    case 2:
    case 4:
      return 0;
    case 3:
      return static_cast<int>(vertices) - static_cast<int>(simplices.size() / 2);
    default:
      return euler_characteristic({simplices.begin(), simplices.end()});
  }
}

}  // namespace

void Piece::clear() {
  own.clear(), of.clear(), facets.clear(), contour.clear(), sign.clear(), high.clear(), low.clear();
}

std::size_t Piece::bytes() const {
  return sizeof(Piece) + own.capacity() * sizeof(OwnVertex) + facets.capacity() * sizeof(PieceFacet) + sign.capacity() +
         (of.capacity() + contour.capacity() + high.capacity() + low.capacity()) * sizeof(Simplex);
}

void PieceBuilder::number(std::uint32_t face, std::vector<VertexId>& map) const {
  map.clear();
  for (const std::uint32_t h : (*closures_)[face]) {
    const std::size_t count = h == face_ ? piece_->own.size() : pieces_[h]->own.size();
    for (std::size_t k = 0; k < count; ++k) map.push_back(static_cast<VertexId>(base_[h] + k));
  }
}

void PieceBuilder::build(std::uint32_t face, std::span<const Piece* const> pieces, Choice choice,
                         Alternative alternative, bool with_parts, Piece& piece) {
  face_ = face, pieces_ = pieces, piece_ = &piece, with_parts_ = with_parts;
  piece.clear();
  next_number_ = next_centre_ = 0;
  centre_high_ = choice == Choice::separate ? alternative == Alternative::high : choice == Choice::high;
  number_vertices();
  if (this->face().dim == 1) return build_edge();
  collect_sigma();
  const bool separate = choice == Choice::separate;
  if (this->face().dim > 2 && separate)
    for (Component& c : components_)
      if (shown_to_be_sphere(c)) cap(c);
  const bool all_coned = std::all_of(components_.begin(), components_.end(), [](auto& c) { return c.coned(); });
  if (all_coned && !with_parts) return;
  collect_regions();
  if (this->face().dim > 2 && !separate) cap_what_stands_apart();
  fill_parts();
}

void PieceBuilder::number_vertices() {
  base_.resize(lattice_->faces().size());
  owner_.clear();
  for (const std::uint32_t h : (*closures_)[face_]) {
    base_[h] = static_cast<VertexId>(owner_.size());
    if (h != face_) owner_.insert(owner_.end(), pieces_[h]->own.size(), h);
  }
  if (owner_.size() >= kNoVertex) throw std::length_error("more than 65535 vertices in a tile");
}

VertexId PieceBuilder::new_vertex(VertexKind kind, VertexId copied, std::span<const Simplex> of) {
  const std::size_t id = owner_.size();
  if (id >= kNoVertex) throw std::length_error("more than 65535 vertices in a tile");
  // Centres are counted separately: the tile itself has none, and its contour keeps the numbers that it has in the role
  // of a face.
  std::uint32_t& number = kind == VertexKind::centre ? next_centre_ : next_number_;
  const auto begin = static_cast<std::uint32_t>(piece_->of.size());
  piece_->of.insert(piece_->of.end(), of.begin(), of.end());
  piece_->own.push_back({kind, number++, copied, begin, static_cast<std::uint32_t>(piece_->of.size())});
  owner_.push_back(face_);
  return static_cast<VertexId>(id);
}

void PieceBuilder::build_edge() {
  const bool first = !pieces_[face().faces[0]]->high.empty(), second = !pieces_[face().faces[1]]->high.empty();
  const auto corner = [&](std::size_t i) { return base_[face().faces[i]]; };
  const auto simplex = [](VertexId a, VertexId b) {
    Simplex s = kNoSimplex;
    s[0] = a, s[1] = b;
    return s;
  };
  if (first == second) {
    side(first).push_back(simplex(corner(0), corner(1)));
    return;
  }
  const VertexId point = new_vertex(VertexKind::edge);
  piece_->contour = {simplex(point, kNoVertex)};
  piece_->sign = {static_cast<std::int8_t>(second ? 1 : -1)};
  piece_->facets = {{Filling::simplex, 2, 0, 1}};
  side(first).push_back(simplex(corner(0), point));
  side(second).push_back(simplex(corner(1), point));
}

void PieceBuilder::collect_sigma() {
  // contours of the faces in this face's numbering
  unsorted_.clear(), unsorted_sign_.clear();
  for (std::size_t j = 0; j < face().faces.size(); ++j) {
    const Piece& piece = *pieces_[face().faces[j]];
    number(face().faces[j], map_);
    for (std::size_t i = 0; i < piece.contour.size(); ++i) {
      unsorted_.push_back(mapped(piece.contour[i], map_));
      unsorted_sign_.push_back(static_cast<std::int8_t>(piece.sign[i] * face().signs[j]));
    }
  }
  // components
  sets_.reset(owner_.size());
  join_vertices(unsorted_, sets_);
  group_.assign(owner_.size(), ~std::uint32_t{0});
  sigma_.resize(unsorted_.size()), sigma_sign_.resize(unsorted_.size());
  group(unsorted_, sets_, group_, start_, [&](std::size_t from, std::size_t to) {
    sigma_[to] = unsorted_[from], sigma_sign_[to] = unsorted_sign_[from];
  });
  components_.clear();
  for (std::size_t c = 0; c + 1 < start_.size(); ++c) components_.push_back({.begin = start_[c], .end = start_[c + 1]});
}

/// Collects the regions and, per region, the components of Sigma that bound it.
void PieceBuilder::collect_regions() {
  regions_.clear();
  for (const bool high : {true, false}) {
    unsorted_.clear();
    for (const std::uint32_t g : face().faces) {
      const Simplices& part = high ? pieces_[g]->high : pieces_[g]->low;
      if (part.empty()) continue;
      number(g, map_);
      for (const Simplex& s : part) unsorted_.push_back(mapped(s, map_));
    }
    sets_.reset(owner_.size());
    join_vertices(unsorted_, sets_);
    group_.assign(owner_.size(), ~std::uint32_t{0});
    Simplices& sorted = sides_[high ? 1 : 0];
    sorted.resize(unsorted_.size());
    group(unsorted_, sets_, group_, start_, [&](std::size_t from, std::size_t to) { sorted[to] = unsorted_[from]; });
    const auto first = static_cast<std::uint32_t>(regions_.size());
    for (std::size_t r = 0; r + 1 < start_.size(); ++r)
      regions_.push_back({high, start_[r], start_[r + 1], {}, static_cast<std::uint32_t>(regions_.size())});
    for (std::uint32_t c = 0; c < components_.size(); ++c) {
      const std::uint32_t r = first + group_[sets_.find(sigma_[components_[c].begin][0])];
      components_[c].region[high ? 1 : 0] = r;
      regions_[r].around.push_back(c);
    }
  }
}

/// By construction Sigma is a closed manifold: a connected curve is a circle, a surface is identified by its Euler
/// characteristic, and 3-manifolds have a test of their own.
bool PieceBuilder::shown_to_be_sphere(const Component& component) {
  const std::span<const Simplex> simplices = sigma_of(component);
  const int vertices = size(simplices.front());
  if (vertices <= 2) return true;
  if (vertices == 3) {
    find_vertices(simplices);
    return closed_euler_characteristic(simplices, found_.size()) == 2;
  }
  if (vertices == 4) {
    tetrahedra_.clear();
    for (const Simplex& s : simplices) tetrahedra_.push_back({s[0], s[1], s[2], s[3]});
    return three_sphere_test_(tetrahedra_);
  }
  if (!adjacency_.build(simplices)) return false;
  all_.resize(simplices.size());
  std::iota(all_.begin(), all_.end(), std::uint32_t{0});
  return shelling_.shape(simplices, adjacency_, all_, kNoVertex) == Shape::sphere ||
         shape_of({simplices.begin(), simplices.end()}) == Shape::sphere;
}

void PieceBuilder::euler_characteristics(std::vector<int>& result) {
  result.clear();
  for (const Component& c : components_) {
    find_vertices(sigma_of(c));
    result.push_back(closed_euler_characteristic(sigma_of(c), found_.size()));
  }
}

/// Writes the vertices of the simplices, in order of first use, to found_.
void PieceBuilder::find_vertices(std::span<const Simplex> simplices) {
  mark_.resize(std::max(mark_.size(), owner_.size()));
  ++epoch_;
  found_.clear();
  for (const Simplex& s : simplices)
    for (int i = 0; i < kMaxVertices && s[i] != kNoVertex; ++i)
      if (mark_[s[i]] != epoch_) mark_[s[i]] = epoch_, found_.push_back(s[i]);
}

/// True if all vertices in found_ lie in one proper face.
bool PieceBuilder::in_one_face() const {
  Signature corners = 0;
  for (const VertexId v : found_) corners |= lattice_->faces()[owner_[v]].corners;
  return std::any_of(face().faces.begin(), face().faces.end(),
                     [&](std::uint32_t g) { return (corners & ~lattice_->faces()[g].corners) == 0; });
}

/// Adds the ball with the given boundary: one simplex if the boundary is a simplex's, else a cone from a new vertex.
void PieceBuilder::ball(std::span<const Simplex> boundary, VertexKind kind, Simplices& to) {
  find_vertices(boundary);
  const auto width = static_cast<std::size_t>(size(boundary[0]));
  if (found_.size() == width + 1 && boundary.size() == width + 1 && !in_one_face()) {
    Simplex simplex = kNoSimplex;
    std::copy(found_.begin(), found_.end(), simplex.begin());
    std::sort(simplex.begin(), simplex.begin() + static_cast<std::ptrdiff_t>(width + 1));
    to.push_back(simplex);
    return;
  }
  const VertexId apex = new_vertex(kind, kNoVertex, boundary);
  for (const Simplex& s : boundary) to.push_back(with_last(s, apex));
}

void PieceBuilder::cap(Component& component) {
  component.cap_begin = static_cast<std::uint32_t>(piece_->contour.size());
  const std::span<const Simplex> boundary = sigma_of(component);
  ball(boundary, VertexKind::barycentre, piece_->contour);
  component.cap_end = static_cast<std::uint32_t>(piece_->contour.size());
  const auto bounds_sign = std::span(sigma_sign_).subspan(component.begin, boundary.size());
  const int euler = closed_euler_characteristic(boundary, found_.size());
  if (component.cap_end - component.cap_begin == 1)
    return orient(component.cap_begin, euler, Filling::simplex, boundary, bounds_sign);
  // The apex is the last vertex, so the face opposite to it, a simplex of Sigma, gets the sign of that position.
  const int apex_sign = size(boundary[0]) % 2 == 0 ? 1 : -1;
  for (const int s : bounds_sign) piece_->sign.push_back(static_cast<std::int8_t>(s * apex_sign));
  piece_->facets.push_back({Filling::cone, euler, component.cap_begin, component.cap_end});
}

/// If one sphere bounds the region to be copied, the copy joins nothing. A cone has fewer simplices.
void PieceBuilder::cap_what_stands_apart() {
  for (Component& c : components_)
    if (regions_[c.region[centre_high_ ? 0 : 1]].around.size() == 1 && shown_to_be_sphere(c)) cap(c);
}

/// Appends a region and the caps of the coned components of Sigma around it.
void PieceBuilder::capped(const Region& region, Simplices& to) const {
  const Simplices& simplices = sides_[region.high ? 1 : 0];
  to.insert(to.end(), simplices.begin() + region.begin, simplices.begin() + region.end);
  for (const std::uint32_t c : region.around)
    to.insert(to.end(), piece_->contour.begin() + components_[c].cap_begin,
              piece_->contour.begin() + components_[c].cap_end);
}

/// Caps divide the face into parts; each part is filled separately.
void PieceBuilder::fill_parts() {
  for (const Component& c : components_) {
    if (c.coned()) continue;
    const std::uint32_t from = regions_[c.region[0]].part, to = regions_[c.region[1]].part;
    for (Region& region : regions_)
      if (region.part == from) region.part = to;
  }
  for (std::uint32_t r = 0; r < regions_.size(); ++r) {
    // Each part is processed at its first region.
    const std::uint32_t part = regions_[r].part;
    const auto same = [&](const Region& region) { return region.part == part; };
    const auto end = regions_.end(), here = regions_.begin() + r;
    if (std::find_if(regions_.begin(), here, same) != here) continue;
    if (std::find_if(here + 1, end, same) != end) {
      fill_around_centre(part);
    } else if (with_parts_) {
      original_.clear();
      capped(regions_[r], original_);
      ball(original_, VertexKind::centre, side(regions_[r].high));
    }
  }
}

/// Copies the regions of one sign inwards. The remaining part, between the copies and the other regions, holds the
/// centre and is coned.
void PieceBuilder::fill_around_centre(std::uint32_t part) {
  around_.clear();
  for (const Region& region : regions_) {
    if (region.part != part) continue;
    if (region.high == centre_high_) {
      if (with_parts_) capped(region, around_);
      continue;
    }
    const std::size_t begin = piece_->contour.size();
    face().dim == 2 ? cut_corner(region) : copy_inwards(region);
    around_.insert(around_.end(), piece_->contour.begin() + static_cast<std::ptrdiff_t>(begin), piece_->contour.end());
  }
  if (with_parts_) ball(around_, VertexKind::centre, side(centre_high_));
}

/// Dimension 2: the segment between the ends of a run of corners of one sign cuts it off.
void PieceBuilder::cut_corner(const Region& region) {
  Simplex segment = kNoSimplex;
  Simplex ends[2];
  std::int8_t signs[2] = {};
  for (std::size_t i = 0; i < 2; ++i) {
    const std::uint32_t at = components_[region.around[i]].begin;
    ends[i] = sigma_[at], signs[i] = sigma_sign_[at];
    segment[i] = ends[i][0];
  }
  if (segment[0] > segment[1]) std::swap(segment[0], segment[1]);
  const auto begin = static_cast<std::uint32_t>(piece_->contour.size());
  piece_->contour.push_back(segment);
  orient(begin, 2, Filling::simplex, ends, signs);
  if (!with_parts_) return;
  original_.clear();
  capped(region, original_);
  original_.push_back(segment);
  ball(original_, VertexKind::centre, side(region.high));
}

/// The copy keeps the vertices of the components of Sigma that it bounds; all other vertices are new. Between region
/// and copy lies one prism per simplex, degenerate at the kept vertices. If the region has a cap, two prisms are
/// stacked: a single one would have edges from the cap to the copy. Both belong to the contour, which would then not be
/// a full subcomplex of the part.
void PieceBuilder::copy_inwards(const Region& region) {
  original_.clear();
  capped(region, original_);
  // boundary of the copy: the components without a cap
  unsorted_.clear(), unsorted_sign_.clear();
  bool has_cap = false;
  for (const std::uint32_t c : region.around) {
    const Component& component = components_[c];
    has_cap |= component.coned();
    if (component.coned()) continue;
    unsorted_.insert(unsorted_.end(), sigma_.begin() + component.begin, sigma_.begin() + component.end);
    unsorted_sign_.insert(unsorted_sign_.end(), sigma_sign_.begin() + component.begin,
                          sigma_sign_.begin() + component.end);
  }
  find_vertices(unsorted_);
  const int euler = closed_euler_characteristic(unsorted_, found_.size());
  image_.assign(owner_.size(), kNoVertex);
  for (const VertexId v : found_) image_[v] = v;
  between_ = image_;
  // copy of each simplex, and the prisms below it
  const auto begin = static_cast<std::uint32_t>(piece_->contour.size());
  for (const Simplex& s : original_) {
    Simplex copy = image(s, image_, VertexKind::side);
    if (with_parts_ && has_cap) {
      const Simplex middle = image(s, between_, VertexKind::centre);
      add_prism(s, middle, side(region.high));
      add_prism(middle, copy, side(region.high));
    } else if (with_parts_) {
      add_prism(s, copy, side(region.high));
    }
    sort_vertices(copy);
    piece_->contour.push_back(copy);
  }
  orient(begin, euler, Filling::side, unsorted_, unsorted_sign_);
}

/// The simplex of the images, unsorted. Creates missing images.
Simplex PieceBuilder::image(const Simplex& simplex, std::vector<VertexId>& images, VertexKind kind) {
  Simplex result = simplex;
  for (int i = 0; i < kMaxVertices && simplex[i] != kNoVertex; ++i) {
    VertexId& to = images[simplex[i]];
    if (to == kNoVertex) to = new_vertex(kind, simplex[i]);
    result[i] = to;
  }
  return result;
}

/// Adds the prism between two corresponding simplices, triangulated in vertex order.
void PieceBuilder::add_prism(const Simplex& from, const Simplex& to, Simplices& part) {
  for (int i = 0; i + 1 < kMaxVertices && from[i] != kNoVertex; ++i) {
    if (from[i] == to[i]) continue;
    Simplex prism = with_apex(from[0], to);
    std::copy(from.begin(), from.begin() + i + 1, prism.begin());
    sort_vertices(prism);
    part.push_back(prism);
  }
}

/// Orients the facet that consists of the contour's simplices from `begin` on. One simplex at Sigma takes its sign from
/// Sigma; simplices that share a face induce opposite signs on it.
void PieceBuilder::orient(std::uint32_t begin, int boundary_euler, Filling filling, std::span<const Simplex> bounds,
                          std::span<const std::int8_t> bounds_sign) {
  const std::span<const Simplex> simplices = std::span(piece_->contour).subspan(begin);
  if (!adjacency_.build(simplices)) throw std::logic_error("a facet that branches");
  const std::size_t width = adjacency_.vertices_per_simplex();
  const auto induced = [&](std::size_t j, const Simplex& face) {  // the sign of a face in a simplex's boundary
    for (std::size_t i = 0; i < width; ++i)
      if (simplices[j][i] != face[i]) return i % 2 == 0 ? 1 : -1;
    return 0;
  };
  piece_->sign.resize(piece_->contour.size(), 0);
  std::int8_t* const sign = piece_->sign.data() + begin;
  // first simplex with a face on Sigma
  all_.clear();
  for (std::uint32_t j = 0; j < simplices.size() && all_.empty(); ++j)
    for (std::size_t i = 0; i < width && all_.empty(); ++i) {
      if (adjacency_.neighbour(j, i) != Adjacency::kNone) continue;
      const Simplex face = without(simplices[j], static_cast<int>(i));
      const auto at = std::find(bounds.begin(), bounds.end(), face);
      if (at == bounds.end()) continue;
      sign[j] = static_cast<std::int8_t>(bounds_sign[static_cast<std::size_t>(at - bounds.begin())] * induced(j, face));
      all_.push_back(j);
    }
  // propagate the sign to the neighbours
  for (std::size_t k = 0; k < all_.size(); ++k)
    for (std::size_t i = 0; i < width; ++i) {
      const std::uint32_t j = all_[k], n = adjacency_.neighbour(j, i);
      if (n == Adjacency::kNone || sign[n] != 0) continue;
      const Simplex face = without(simplices[j], static_cast<int>(i));
      sign[n] = static_cast<std::int8_t>(-sign[j] * induced(j, face) * induced(n, face));
      all_.push_back(n);
    }
  if (all_.size() != simplices.size()) throw std::logic_error("a facet that does not hang together");
  piece_->facets.push_back({filling, boundary_euler, begin, static_cast<std::uint32_t>(piece_->contour.size())});
}

}  // namespace tegl::tile
