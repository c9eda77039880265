// SPDX-License-Identifier: BSD-3-Clause
//
// Builds a 4D tile from its eight cubes: their lists, the components of Sigma, and the filling of each.
#include "tile/tesseract_fill.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "tegl/table_contract.hpp"
#include "tegl/tile/corners.hpp"
#include "tile/cube_regions.hpp"
#include "tile/local_simplices.hpp"
#include "tile/variant_table.hpp"

namespace tegl::detail {
namespace {

using tile::Choice;

constexpr unsigned kCubes = ResolvedCubes::kCubes;
constexpr unsigned kMaskEdge = 16;  ///< bit of edge 0 in masks

constexpr std::uint32_t word(std::array<std::uint8_t, 4> vertices) { return std::bit_cast<std::uint32_t>(vertices); }

/// Corners of each square and cube, as bit sets.
constexpr std::array<std::uint32_t, 24> kCornersOfSquares = [] {
  std::array<std::uint32_t, 24> result{};
  for (unsigned q = 0; q < 24; ++q)
    for (unsigned v = 0; v < 16; ++v)
      if ((v & ~unsigned{kTesseractSquares[q].axes}) == kTesseractSquares[q].base) result[q] |= 1u << v;
  return result;
}();
constexpr std::array<std::uint32_t, 8> kCornersOfCubes = [] {
  std::array<std::uint32_t, 8> result{};
  for (unsigned f = 0; f < 8; ++f) result[f] = static_cast<std::uint32_t>(face_corners(4, f));
  return result;
}();

/// A pair of axes that squares span. Bit i of `base` is set if corner i is the lowest corner of such a square;
/// square[i] is then its number.
struct SquarePlane {
  unsigned a, b;
  std::uint32_t base;
  std::array<std::uint8_t, 16> square;
};
constexpr std::array<SquarePlane, 6> kSquarePlanes = [] {
  std::array<SquarePlane, 6> result{};
  std::size_t plane = 0;
  for (unsigned a = 0; a < 4; ++a)
    for (unsigned b = a + 1; b < 4; ++b, ++plane) {
      result[plane].a = a;
      result[plane].b = b;
      for (unsigned q = 0; q < 24; ++q)
        if (kTesseractSquares[q].axes == (1u << a | 1u << b)) {
          result[plane].base |= 1u << kTesseractSquares[q].base;
          result[plane].square[kTesseractSquares[q].base] = static_cast<std::uint8_t>(q);
        }
    }
  return result;
}();

/// Ambiguous squares among the 24.
std::uint32_t ambiguous_squares(std::uint32_t signature) {
  std::array<std::uint32_t, 4> changes;  // bit v: corner v and the next one along axis a differ
  for (unsigned a = 0; a < 4; ++a) changes[a] = signature ^ signature >> (1u << a);
  std::uint32_t result = 0;
  for (const SquarePlane& plane : kSquarePlanes) {
    const std::uint32_t along_b = changes[plane.b];
    std::uint32_t found = changes[plane.a] & along_b & along_b >> (1u << plane.a) & plane.base;
    for (; found != 0; found &= found - 1) result |= 1u << plane.square[std::countr_zero(found)];
  }
  return result;
}

Choice choice_of(const ResolvedKey& key, unsigned cube) {
  if ((key.low_cubes >> cube & 1u) != 0) return Choice::low;
  return (key.high_cubes >> cube & 1u) != 0 ? Choice::high : Choice::separate;
}

}  // namespace

ResolvedTesseract::ResolvedTesseract(Triangulation triangulation)
    : is_barycentric_(triangulation == Triangulation::barycentric),
      cubes_(ResolvedCubes::instance(triangulation)),
      in_table_(in_table().data()) {}

const CubeRegions& ResolvedTesseract::regions() {
  if (regions_ == nullptr)
    regions_ = &CubeRegions::instance(is_barycentric_ ? Triangulation::barycentric : Triangulation::compact);
  return *regions_;
}

const std::vector<ResolvedTesseract::InTable>& ResolvedTesseract::in_table() {
  static const std::vector<InTable> entries = [] {
    std::vector<InTable> result;
    for (unsigned s = 0; s < 65536; ++s) {
      const tables::List& list = tables::kTile4Compact.lists[tables::kTile4Compact.list_of[s]];
      result.push_back({list.first_simplex, list.simplex_count,
                        static_cast<std::uint16_t>(unsigned{list.cone_vertices} + list.side_vertices)});
    }
    return result;
  }();
  return entries;
}

const ResolvedView& ResolvedTesseract::find(const ResolvedKey& key, const ResolvedCubes::Lists& lists) {
  find_cubes(lists);
  const bool has_regions = find_joined(key);
  simplex_count_ = 0;
  masks_.clear();
  if (is_in_table(key)) {
    const InTable& entry = in_table_[key.signature];
    if (entry.own_vertices == 0) {
      view_ = {tables::kTile4Compact.simplices + 4 * std::size_t{entry.first_simplex}, entry.simplex_count, 0, nullptr};
      return view_;
    }
    take_from_table(key);
  } else {
    fill(key, has_regions);
  }
  view_ = {reinterpret_cast<const std::uint8_t*>(simplices_.data()), static_cast<std::uint32_t>(simplex_count_),
           static_cast<std::uint32_t>(masks_.size()), masks_.data()};
  return view_;
}

ResolvedSize ResolvedTesseract::size(const ResolvedKey& key, const ResolvedCubes::Lists& lists) {
  find_cubes(lists);
  const bool has_regions = find_joined(key);
  if (is_in_table(key)) {
    const InTable& entry = in_table_[key.signature];
    return {entry.simplex_count, entry.own_vertices};
  }
  const bool high = choose_cones(key, has_regions);
  ResolvedSize size{0, 0};
  for (unsigned c = 0; c < component_count_; ++c) {
    const Component& component = components_[c];
    if (component.is_coned) {
      const unsigned apex = apex_of(component);
      size.simplices += component.triangles;
      if (apex < kFirstOwn)
        size.simplices -= static_cast<std::uint32_t>(std::popcount(component.vertices & cubes_.beside(apex))) - 1;
      else
        ++size.own_vertices;
    } else if (is_first_of_region(c)) {
      add_region_size(component.region, high, size);
    }
  }
  return size;
}

ResolvedCubes::Lists ResolvedTesseract::lists_of(const ResolvedKey& key) const noexcept {
  const std::uint64_t signatures = cubes_.signatures(key.signature), squares = cubes_.squares(key.squares);
  ResolvedCubes::Lists lists;
  for (unsigned f = 0; f < kCubes; ++f)
    lists[f] = cubes_.list(signatures >> (8 * f) & 255u, squares >> (8 * f) & 63u, choice_of(key, f));
  return lists;
}

void ResolvedTesseract::find_cubes(const ResolvedCubes::Lists& lists) {
  unsigned others = 0, count = 0, opposite = 0;
  lists_ = lists;
  triangle_count_ = 0;
  apexes_ = ~std::uint32_t{0};
  for (unsigned f = 0; f < kCubes; ++f) {
    const ResolvedCubes::Summary& summary = cubes_.summary(lists[f]);
    apexes_ &= cubes_.apexes(f, lists[f]);
    others |= summary.is_not_low;
    triangle_count_ += summary.triangle_count;
    // Copies as many parts as a cube can have, without a branch on their number; the next cube overwrites the surplus.
    const std::uint32_t first = cubes_.first_part(f) + summary.first_part;
    for (unsigned i = 0; i < ResolvedCubes::kMostParts; ++i) parts_.data()[count + i] = first + i;
    std::memcpy(&part_vertices_.data()[count], cubes_.part_vertices() + first,
                ResolvedCubes::kMostParts * sizeof(std::uint64_t));
    count += summary.part_count;
    if (f < 2) opposite = f == 0 ? count : count | opposite << 8;
  }
  part_count_ = count;
  as_low_ = others == 0;
  // Find parts connected to the first one in a single sweep. Cubes 0 and 1 share no vertices, so the parts of cube 1
  // come last.
  std::uint64_t vertices = count == 0 ? 0 : part_vertices_[0];
  std::uint32_t connected = 0;
  const auto look_at = [&](unsigned from, unsigned to) {
    for (unsigned i = from; i < to; ++i) {
      const std::uint64_t of_part = part_vertices_.data()[i];
      const std::uint64_t meets = (of_part & vertices) != 0 ? 1 : 0;
      vertices |= of_part & (0 - meets);
      connected |= static_cast<std::uint32_t>(meets << i);
    }
  };
  const unsigned first_of_1 = opposite >> 8, end_of_1 = opposite & 255u;
  look_at(0, first_of_1);
  look_at(end_of_1, count);
  look_at(first_of_1, end_of_1);
  find_components(vertices, connected);
}

/// `vertices`, `connected`: vertices and set of parts known to be connected to the first part.
void ResolvedTesseract::find_components(std::uint64_t vertices, std::uint32_t connected) {
  component_count_ = 0;
  auto left = static_cast<std::uint32_t>((std::uint64_t{1} << part_count_) - 1) & ~connected;
  while (connected != 0) {
    std::uint32_t triangles = triangle_count_;
    // add parts until none is connected
    for (bool grown = left != 0; grown;) {
      grown = false;
      for (std::uint32_t rest = left; rest != 0; rest &= rest - 1) {
        const std::uint64_t of_part = part_vertices_[std::countr_zero(rest)];
        if ((of_part & vertices) == 0) continue;
        vertices |= of_part;
        connected |= rest & (0 - rest);
        grown = true;
      }
      left &= ~connected;
    }
    // triangles of the component, unless it has all
    if (left != 0 || component_count_ != 0) {
      triangles = 0;
      for (std::uint32_t rest = connected; rest != 0; rest &= rest - 1)
        triangles += part(static_cast<unsigned>(std::countr_zero(rest))).triangle_count;
    }
    const bool is_sphere = 2 * static_cast<unsigned>(std::popcount(vertices)) == triangles + 4;
    components_[component_count_++] = {vertices, connected, triangles, 0, is_sphere, false};
    connected = left & (0 - left);
    left ^= connected;
    if (connected != 0) vertices = part_vertices_[std::countr_zero(connected)];
  }
}

/// The table has the low-connected contour, with spheres coned and other components filled as with a low centre.
bool ResolvedTesseract::is_in_table(const ResolvedKey& key) const {
  if (!as_low_ || is_barycentric_) return false;
  if (key.tile == Choice::separate) return true;
  for (unsigned c = 0; c < component_count_; ++c)
    if (!components_[c].is_sphere && key.tile == Choice::high) return false;
  if (component_count_ < 2) return true;
  std::uint32_t seen = 0;
  for (unsigned c = 0; c < component_count_; ++c) {
    if ((components_[c].region & seen) != 0) return false;
    seen |= components_[c].region;
  }
  return true;
}

void ResolvedTesseract::take_from_table(const ResolvedKey& key) {
  const tables::TileTable& table = tables::kTile4Compact;
  const tables::List& list = table.lists[table.list_of[key.signature]];
  constexpr unsigned kFirstOfTable = tables::first_tile_vertex(4);
  simplices_.resize(list.simplex_count);
  const std::uint8_t* at = table.simplices + 4 * std::size_t{list.first_simplex};
  for (unsigned j = 0; j < list.cone_vertices; ++j) masks_.push_back(0);
  for (unsigned j = 0; j < list.side_vertices; ++j) masks_.push_back(table.side_masks[list.first_side + j]);
  for (; simplex_count_ < list.simplex_count; ++simplex_count_, at += 4) {
    std::array<std::uint8_t, 4> vertices = {at[0], at[1], at[2], at[3]};
    for (std::uint8_t& v : vertices)
      if (v >= kFirstOfTable) v = static_cast<std::uint8_t>(v - kFirstOfTable + kFirstOwn);
    simplices_[simplex_count_] = word(vertices);
    // A cone's apex is its simplices' first vertex. It lies at the mean of the vertices that it is coned to.
    if (vertices[0] < kFirstOwn || vertices[0] >= kFirstOwn + list.cone_vertices) continue;
    for (unsigned i = 1; i < 4; ++i) masks_[vertices[0] - kFirstOwn] |= std::uint64_t{1} << (kMaskEdge + vertices[i]);
  }
}

/// If the tile's centre may join several components, finds the region beside each. Returns whether this is so.
bool ResolvedTesseract::find_joined(const ResolvedKey& key) {
  const bool joins = component_count_ > 1 && key.tile != Choice::separate;
  if (joins) find_regions(key, key.tile == Choice::low);
  return joins;
}

/// Finds for each component the corners of one sign that are connected, in the tile's boundary, to those beside it.
void ResolvedTesseract::find_regions(const ResolvedKey& key, bool high) {
  const std::uint32_t corners = high ? key.signature : ~std::uint32_t{key.signature} & 0xffffu;
  if (component_count_ == 1) {  // one region on either side
    components_[0].region = corners;
    return;
  }
  // Sets of corners that faces connect although no edge does.
  std::array<std::uint32_t, 8 + 24> joined;
  unsigned count = 0;
  const unsigned cubes = high ? key.high_cubes & ~unsigned{key.low_cubes} : key.low_cubes;
  for (unsigned rest = cubes; rest != 0; rest &= rest - 1)
    joined[count++] = corners & kCornersOfCubes[std::countr_zero(rest)];
  for (std::uint32_t rest = ambiguous_squares(key.signature) & (high ? key.squares : ~key.squares); rest != 0;
       rest &= rest - 1)
    joined[count++] = corners & kCornersOfSquares[std::countr_zero(rest)];
  // grow the region of each component
  std::uint32_t seen = 0;
  for (unsigned c = 0; c < component_count_; ++c) {
    const auto edge = static_cast<unsigned>(std::countr_zero(components_[c].vertices));
    const std::uint32_t one = 1u << edge_base(4, edge);
    const std::uint32_t from = (corners & one) != 0 ? one : one << (1u << edge / 8);
    if ((from & seen) != 0) {
      for (unsigned d = 0; d < c; ++d)
        if ((components_[d].region & from) != 0) components_[c].region = components_[d].region;
      continue;
    }
    std::uint32_t reached = from;
    for (std::uint32_t before = 0; reached != before;) {
      before = reached;
      reached = with_neighbours(with_neighbours(reached) & corners) & corners;
      for (unsigned j = 0; j < count; ++j) reached |= (reached & joined[j]) != 0 ? joined[j] : 0;
    }
    components_[c].region = reached;
    seen |= reached;
  }
}

/// Chooses the components to cone: spheres, but if the tile's centre may join, only the sole ones beside their region.
/// Returns which side is copied to fill the others; their regions are then known.
bool ResolvedTesseract::choose_cones(const ResolvedKey& key, bool joins) {
  const bool high = key.tile != Choice::high;
  bool all = true;
  for (unsigned c = 0; c < component_count_; ++c) {
    components_[c].is_coned = components_[c].is_sphere && (!joins || is_alone(c));
    all = all && components_[c].is_coned;
  }
  if (!all && !joins) find_regions(key, high);
  return high;
}

/// Whether it is the first component beside its region that is not coned.
bool ResolvedTesseract::is_first_of_region(unsigned component) const {
  for (unsigned d = 0; d < component; ++d)
    if (!components_[d].is_coned && components_[d].region == components_[component].region) return false;
  return true;
}

void ResolvedTesseract::fill(const ResolvedKey& key, bool joins) {
  constexpr std::size_t kMore = ResolvedCubes::kWordsBehind;
  if (simplices_.size() < triangle_count_ + kMore) simplices_.resize(triangle_count_ + kMore);
  const bool high = choose_cones(key, joins);
  for (unsigned c = 0; c < component_count_; ++c)
    if (components_[c].is_coned) cone(components_[c]);
  for (unsigned c = 0; c < component_count_; ++c)
    if (!components_[c].is_coned && is_first_of_region(c)) fill_region(components_[c].region, high);
}

bool ResolvedTesseract::is_alone(unsigned component) const {
  for (unsigned d = 0; d < component_count_; ++d)
    if (d != component && components_[d].region == components_[component].region) return false;
  return true;
}

/// Of the vertices that may be the cone's apex, returns the one with most triangles; kFirstOwn if there is none.
/// Adjacent vertices are exactly the component's vertices in the apex's cubes. In the barycentric triangulation only a
/// tetrahedron has such an apex.
unsigned ResolvedTesseract::apex_of(const Component& component) const {
  if (is_barycentric_)
    return component.triangles == 4 ? static_cast<unsigned>(std::countr_zero(component.vertices)) : kFirstOwn;
  auto apexes = static_cast<std::uint32_t>(component.vertices) & (component_count_ == 1 ? apexes_ : ~std::uint32_t{0});
  unsigned cubes = 0;
  for (std::uint32_t rest = component.parts; component_count_ > 1 && rest != 0 && apexes != 0; rest &= rest - 1) {
    const ResolvedCubes::Part& of_part = part(static_cast<unsigned>(std::countr_zero(rest)));
    apexes &= (cubes >> of_part.cube & 1u) != 0 ? ~cubes_.edges_of(of_part.cube) : of_part.apexes;
    cubes |= 1u << of_part.cube;
  }
  unsigned apex = kFirstOwn;
  int most = 0;
  for (; apexes != 0; apexes &= apexes - 1) {
    const auto e = static_cast<unsigned>(std::countr_zero(apexes));
    const int around = std::popcount(component.vertices & cubes_.beside(e));
    if (around > most) most = around, apex = e;
  }
  return apex;
}

void ResolvedTesseract::cone(const Component& component) {
  unsigned apex = apex_of(component);
  const bool is_own = apex == kFirstOwn;
  if (is_own) {
    const std::uint64_t edges = component.vertices & 0xffffffffu;
    apex = add_own(edges << kMaskEdge | (is_barycentric_ ? kIsBarycentre : 0));
  }
  const std::uint32_t first = ResolvedCubes::apex_word(apex), repeated = apex * 0x01010101u;
  Word* out = simplices_.data() + simplex_count_;
  for (std::uint32_t rest = component.parts; rest != 0; rest &= rest - 1) {
    const ResolvedCubes::Part& of_part = part(static_cast<unsigned>(std::countr_zero(rest)));
    const std::uint32_t* const triangles = cubes_.triangles(of_part);
    if (is_own) {
      // Copied by whole registers; the next part overwrites the surplus.
      for (unsigned t = 0; t < of_part.triangle_count; t += ResolvedCubes::kWordsBehind)
        for (unsigned i = t; i < t + ResolvedCubes::kWordsBehind; ++i) out[i] = triangles[i] | first;
      out += of_part.triangle_count;
      continue;
    }
    for (unsigned t = 0; t < of_part.triangle_count; ++t) {
      const std::uint32_t simplex = triangles[t] | first;
      // If the apex occurs only once in the simplex, one byte of the difference is zero. All bytes are less than 128.
      const std::uint32_t zero_bytes = ~((simplex ^ repeated) + 0x7f7f7f7fu) & 0x80808080u;
      *out = simplex;
      out += (zero_bytes & (zero_bytes - 1)) == 0 ? 1 : 0;
    }
  }
  simplex_count_ = static_cast<std::size_t>(out - simplices_.data());
}

/// Copies a region of the tile's boundary. The copy keeps the vertices of Sigma and adds a vertex for each corner and
/// for each vertex that the cubes' regions add. Coned spheres beside the region are first cut off from it: the copy
/// uses duplicates of their vertices and is closed by another cone.
void ResolvedTesseract::fill_region(unsigned corners, bool high) {
  std::array<std::uint8_t, 16> copy{};
  for (unsigned rest = corners; rest != 0; rest &= rest - 1) {
    const auto v = static_cast<unsigned>(std::countr_zero(rest));
    copy[v] = static_cast<std::uint8_t>(add_own(std::uint64_t{1} << v));
  }
  std::array<std::uint8_t, ResolvedCubes::kVertices> sigma;
  for (unsigned v = 0; v < sigma.size(); ++v) sigma[v] = static_cast<std::uint8_t>(v);
  for (unsigned c = 0; c < component_count_; ++c)
    if (components_[c].is_coned && components_[c].region == corners) cap(components_[c], corners, sigma);
  const std::size_t first_centre = masks_.size();
  for (unsigned f = 0; f < kCubes; ++f) add_cube_regions(f, corners, high, first_centre, copy, sigma);
}

void ResolvedTesseract::add_region_size(unsigned corners, bool high, ResolvedSize& size) {
  const CubeRegions& all = regions();
  size.own_vertices += static_cast<std::uint32_t>(std::popcount(corners));
  for (unsigned c = 0; c < component_count_; ++c)
    if (components_[c].is_coned && components_[c].region == corners) {
      size.own_vertices += static_cast<std::uint32_t>(std::popcount(components_[c].vertices)) + 1;
      size.simplices += components_[c].triangles;
    }
  for (unsigned f = 0; f < kCubes; ++f)
    for (const CubeRegions::Region& region : all.regions(lists_[f], high))
      if (is_in(f, region, corners)) {
        size.own_vertices += region.centre_count;
        size.simplices += region.tetrahedron_count;
      }
}

bool ResolvedTesseract::is_in(unsigned cube, const CubeRegions::Region& region, unsigned corners) noexcept {
  return (corners >> lifted_corner(cube, static_cast<unsigned>(std::countr_zero(unsigned{region.corners}))) & 1u) != 0;
}

/// Duplicates the vertices of a component, and closes the copy by a cone.
void ResolvedTesseract::cap(const Component& component, unsigned corners, std::span<std::uint8_t> sigma) {
  std::uint64_t all = 0;
  for (std::uint64_t rest = component.vertices; rest != 0; rest &= rest - 1) {
    const auto v = static_cast<unsigned>(std::countr_zero(rest));
    const std::uint64_t mask = mask_of(v, corners);
    all |= mask;
    sigma[v] = static_cast<std::uint8_t>(add_own(mask));
  }
  const auto apex = static_cast<std::uint8_t>(add_own(all));
  for (std::uint32_t rest = component.parts; rest != 0; rest &= rest - 1) {
    const ResolvedCubes::Part& of_part = part(static_cast<unsigned>(std::countr_zero(rest)));
    for (unsigned t = 0; t < of_part.triangle_count; ++t) {
      const auto triangle = std::bit_cast<std::array<std::uint8_t, 4>>(cubes_.triangles(of_part)[t]);
      add_simplex({apex, sigma[triangle[2]], sigma[triangle[1]], sigma[triangle[3]]});
    }
  }
}

/// Mask of a vertex between a vertex of Sigma and a region: its edges, and their corners in the region.
std::uint64_t ResolvedTesseract::mask_of(unsigned vertex, unsigned corners) const {
  std::uint64_t mask = 0;
  const auto add_edge = [&](unsigned e) {
    const unsigned base = edge_base(4, e);
    mask |= std::uint64_t{1} << (kMaskEdge + e) | ((1u << base | 1u << (base | 1u << e / 8)) & corners);
  };
  if (vertex < ResolvedCubes::kEdges) {
    add_edge(vertex);
    return mask;
  }
  const unsigned cube = (vertex - ResolvedCubes::kEdges) / ResolvedCubes::kMostOwn;
  const unsigned own = (vertex - ResolvedCubes::kEdges) % ResolvedCubes::kMostOwn;
  for (std::uint32_t rest = cubes_.mask(lists_[cube], own); rest != 0; rest &= rest - 1) {
    const auto v = static_cast<unsigned>(std::countr_zero(rest));
    if (v < 8)
      mask |= std::uint64_t{1} << lifted_corner(cube, v);
    else
      add_edge(cubes_.lifted(cube, v - 8));
  }
  return mask;
}

void ResolvedTesseract::add_cube_regions(unsigned cube, unsigned corners, bool high, std::size_t first_centre,
                                         std::span<const std::uint8_t, 16> copy,
                                         std::span<const std::uint8_t, ResolvedCubes::kVertices> sigma) {
  const CubeRegions& all = regions();
  std::array<std::uint8_t, CubeRegions::kVertices> local{};
  for (unsigned v = 0; v < 8; ++v) local[v] = copy[lifted_corner(cube, v)];
  for (unsigned v = 0; v < 12 + ResolvedCubes::kMostOwn; ++v)
    local[CubeRegions::kFirstEdge + v] = sigma[cubes_.lifted(cube, v)];
  for (const CubeRegions::Region& region : all.regions(lists_[cube], high)) {
    if (!is_in(cube, region, corners)) continue;
    unsigned centre = CubeRegions::kFirstCentre;
    for (const std::uint32_t mask : all.centres(region)) {
      std::uint64_t lifted = 0;
      for (std::uint32_t rest = mask; rest != 0; rest &= rest - 1) {
        const auto v = static_cast<unsigned>(std::countr_zero(rest));
        lifted |= std::uint64_t{1} << (v < 8 ? lifted_corner(cube, v) : kMaskEdge + cubes_.lifted(cube, v - 8));
      }
      local[centre++] = static_cast<std::uint8_t>(add_apart(lifted, first_centre));
    }
    static_assert(CubeRegions::kMoreTetrahedra >= kMoreSimplices, "map_simplices reads so many behind them");
    const auto tetrahedra = all.tetrahedra(region);
    const std::size_t needed = simplex_count_ + tetrahedra.size() + kMoreSimplices;
    if (simplices_.size() < needed) simplices_.resize(std::max(2 * simplex_count_ + 256, needed));
    map_simplices(tetrahedra.data()->data(), tetrahedra.size(), local.data(), cubes_.is_reversed(cube),
                  reinterpret_cast<std::uint8_t*>(simplices_.data() + simplex_count_));
    simplex_count_ += tetrahedra.size();
  }
}

void ResolvedTesseract::add_simplex(const std::array<std::uint8_t, 4>& vertices) {
  if (simplex_count_ == simplices_.size()) simplices_.resize(2 * simplex_count_ + 64);
  simplices_[simplex_count_++] = word(vertices);
}

unsigned ResolvedTesseract::add_own(std::uint64_t mask) {
  masks_.push_back(mask);
  return kFirstOwn + static_cast<unsigned>(masks_.size()) - 1;
}

/// Adds an own vertex. If own vertices from `first` on have the same mask, it counts them as repetitions. This happens
/// if the same curve cuts regions of two cubes in the square between them.
unsigned ResolvedTesseract::add_apart(std::uint64_t mask, std::size_t first) {
  constexpr std::uint64_t kPoints = (std::uint64_t{1} << kRepeat) - 1;
  std::uint64_t repeats = 0;
  for (std::size_t j = first; j < masks_.size(); ++j) repeats += (masks_[j] & kPoints) == mask ? 1 : 0;
  return add_own(mask | repeats << kRepeat);
}

}  // namespace tegl::detail
