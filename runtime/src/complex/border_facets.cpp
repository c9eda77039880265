// SPDX-License-Identifier: BSD-3-Clause
//
// Lists the facets of the shapes of cells, and finds the border of a complex by sorting all facets.
#include "complex/border_facets.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include <Eigen/LU>

#include "base/progress.hpp"
#include "base/radix_sort.hpp"
#include "base/workers.hpp"
#include "polytope/prism_facets.hpp"
#include "tegl/tile/corners.hpp"

namespace tegl::detail {

namespace {

using tables::CellShape;
using Corners = std::vector<unsigned>;

/// Three corners of a 3D shape, two of a polygon, that are not in one plane or line with corner 0.
std::array<unsigned, 3> frame_of(CellShape shape) noexcept {
  switch (shape) {
    case CellShape::pyramid:
    case CellShape::hexahedron:
    case CellShape::octahedron:
      return {1, 2, 4};
    default:
      return {1, 2, 3};
  }
}

/// The sign of the determinant of the vectors from corner 0 to others, and one more vector.
int orientation(const tables::CellTable& table, const Corners& corners, const Eigen::VectorXd* last) {
  const auto dim = static_cast<Eigen::Index>(table.dim);
  Eigen::MatrixXd columns(dim, dim);
  for (Eigen::Index k = 0; k < dim; ++k)
    for (Eigen::Index i = 0; i < dim; ++i) {
      const auto at = [&](unsigned v) {
        return static_cast<double>(table.corners[v * table.dim + static_cast<unsigned>(i)]);
      };
      columns(i, k) =
          last != nullptr && k == dim - 1 ? (*last)(i) : at(corners[static_cast<std::size_t>(k) + 1]) - at(corners[0]);
    }
  return columns.determinant() < 0 ? -1 : 1;
}

CellFacet make_facet(CellShape cell, CellShape shape, const Corners& corners) {
  CellFacet facet{shape, static_cast<std::uint8_t>(corners.size()), {}, false};
  for (std::size_t i = 0; i < corners.size(); ++i) facet.corners[i] = static_cast<std::uint8_t>(corners[i]);
  const tables::CellTable& table = table_of(cell);
  Eigen::VectorXd inwards = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(table.dim));
  for (unsigned i = 0; i < table.dim; ++i)
    for (unsigned v = 0; v < table.corner_count; ++v)
      inwards(i) += table.corners[v * table.dim + i] - table.corners[corners[0] * table.dim + i];
  Corners in_cell{corners[0]}, in_facet{0};
  for (const unsigned v : frame_of(shape)) {
    if (in_cell.size() == table.dim) break;
    in_cell.push_back(corners[corners.size() == 2 ? 1 : v]);
    in_facet.push_back(v);
  }
  const int own = corners.size() == 2 ? 1 : orientation(table_of(shape), in_facet, nullptr);
  facet.is_inverted = orientation(table, in_cell, &inwards) != own;
  return facet;
}

struct Face {
  CellShape shape;
  Corners corners;
};

std::vector<Face> faces_of(CellShape shape);

/// The facets of a base x an interval.
std::vector<Face> faces_of_prism(CellShape base) {
  const unsigned count = table_of(base).corner_count;
  const auto with_above = [count](Corners corners) {
    for (std::size_t i = 0, size = corners.size(); i < size; ++i) corners.push_back(corners[i] + count);
    return corners;
  };
  Corners lower, upper;
  for (unsigned v = 0; v < count; ++v) {
    lower.push_back(v);
    upper.push_back(v + count);
  }
  std::vector<Face> faces{{base, lower}, {base, upper}};
  for (const Face& face : faces_of(base)) faces.push_back({prism_of(face.shape), with_above(face.corners)});
  return faces;
}

/// The facets of a shape; edges have the shape of a triangle.
std::vector<Face> faces_of(CellShape shape) {
  const auto all = [](CellShape of, std::initializer_list<Corners> lists) {
    std::vector<Face> faces;
    for (const Corners& corners : lists) faces.push_back({of, corners});
    return faces;
  };
  switch (shape) {
    case CellShape::triangle:
      return all(CellShape::triangle, {{0, 1}, {1, 2}, {0, 2}});
    case CellShape::quadrilateral:
      return all(CellShape::triangle, {{0, 2}, {1, 3}, {0, 1}, {2, 3}});
    case CellShape::tetrahedron:
      return all(CellShape::triangle, {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}});
    case CellShape::pyramid: {
      std::vector<Face> faces = all(CellShape::triangle, {{0, 1, 4}, {0, 2, 4}, {1, 3, 4}, {2, 3, 4}});
      faces.push_back({CellShape::quadrilateral, {0, 1, 2, 3}});
      return faces;
    }
    case CellShape::wedge: {
      std::vector<Face> faces = all(CellShape::quadrilateral, {{0, 1, 3, 4}, {1, 2, 4, 5}, {0, 2, 3, 5}});
      faces.push_back({CellShape::triangle, {0, 1, 2}});
      faces.push_back({CellShape::triangle, {3, 4, 5}});
      return faces;
    }
    case CellShape::hexahedron: {
      std::vector<Face> faces(6, {CellShape::quadrilateral, {}});
      for (unsigned f = 0; f < 6; ++f)
        for (unsigned v = 0; v < 4; ++v) faces[f].corners.push_back(lifted_corner(f, v));
      return faces;
    }
    case CellShape::octahedron: {
      std::vector<Face> faces;
      for (unsigned i = 0; i < 8; ++i)
        faces.push_back({CellShape::triangle, {i & 1u, 2 + (i >> 1 & 1u), 4 + (i >> 2)}});
      return faces;
    }
    case CellShape::simplex4:
      return all(CellShape::tetrahedron, {{0, 1, 2, 3}, {0, 1, 2, 4}, {0, 1, 3, 4}, {0, 2, 3, 4}, {1, 2, 3, 4}});
    case CellShape::cell16: {
      std::vector<Face> faces;
      for (unsigned i = 0; i < 16; ++i)
        faces.push_back({CellShape::tetrahedron, {i & 1u, 2 + (i >> 1 & 1u), 4 + (i >> 2 & 1u), 6 + (i >> 3)}});
      return faces;
    }
    case CellShape::tetrahedron_prism:
      return faces_of_prism(CellShape::tetrahedron);
    case CellShape::wedge_prism:
      return faces_of_prism(CellShape::wedge);
    case CellShape::pyramid_prism:
      return faces_of_prism(CellShape::pyramid);
    case CellShape::octahedron_prism:
      return faces_of_prism(CellShape::octahedron);
    case CellShape::hexahedron_prism:
      return faces_of_prism(CellShape::hexahedron);
  }
  return {};
}

/// A facet by its corners in ascending order, followed by the largest number.
template <std::size_t kCorners>
struct FacetUse {
  std::array<Index, kCorners> key;
  std::uint64_t place;
};

/// The points that name a facet of a polytope.
std::vector<Index> points_known_by(const Polytopes& polytopes, std::size_t cell, std::size_t number) {
  if (polytopes.shape(cell).dim() != 4) return facet_points(polytopes, cell, number);
  const PrismFacet facet = facet_of_prism(polytopes.shape(cell), number);
  std::vector<Index> points;
  if (facet.is_tabled()) {
    for (const std::uint8_t v : facet.corners) points.push_back(polytopes.cell(cell)[v]);
  } else {
    const auto key = key_of_facet(facet, polytopes.cell(cell));
    points.assign(key.begin(), key.end());
  }
  return points;
}

template <std::size_t kCorners>
BorderFacets find_border_of(std::size_t points, const CellGroups& cells, const WorkOptions& work) {
  std::vector<std::uint64_t> first{0};  // by group
  for (const CellGroup& group : cells.groups)
    first.push_back(first.back() + std::uint64_t{group.size()} * facets_of(group.shape).size());
  // list
  std::vector<FacetUse<kCorners>> uses(first.back());
  const auto set_key = [](FacetUse<kCorners>& use, const auto& point_of, std::size_t count) {
    use.key.fill(std::numeric_limits<Index>::max());
    for (std::size_t i = 0; i < count; ++i) use.key[i] = point_of(i);
    std::sort(use.key.begin(), use.key.end());
  };
  const std::vector<CellRange> ranges = ranges_of(cells);
  for_each_item(ranges.size(), work.threads, part_of(work.progress, 0.0, 0.3), [&](std::size_t r) {
    const auto [g, from, to] = ranges[r];
    const auto facets = facets_of(cells.groups[g].shape);
    std::uint64_t place = first[g] + from * facets.size();
    for (std::size_t c = from; c < to; ++c)
      for (const CellFacet& facet : facets) {
        FacetUse<kCorners>& use = uses[place];
        const Index* const corners = cells.groups[g].cell(c);
        set_key(
            use, [&](std::size_t i) { return corners[facet.corners[i]]; }, facet.corner_count);
        use.place = place++;
      }
  });
  // Of a face of a polyhedron, the four smallest corners: different faces share two at most. Likewise of a facet of a
  // prism (key_of_facet).
  std::vector<std::uint64_t> first_of{first.back()};  // by polytope
  for (std::size_t c = 0; c < cells.polytopes.size(); ++c)
    first_of.push_back(first_of.back() + cells.polytopes.shape(c).facet_count());
  uses.resize(first_of.back());
  for_each_item(cells.polytopes.size(), work.threads, nullptr, [&](std::size_t c) {
    for (std::size_t f = 0; f < cells.polytopes.shape(c).facet_count(); ++f) {
      std::vector<Index> points_of = points_known_by(cells.polytopes, c, f);
      std::sort(points_of.begin(), points_of.end());
      FacetUse<kCorners>& use = uses[first_of[c] + f];
      set_key(
          use, [&](std::size_t i) { return points_of[i]; }, std::min(points_of.size(), kCorners));
      use.place = first_of[c] + f;
    }
  });
  // sort by the first corner, then those of each corner
  const auto bits = static_cast<unsigned>(std::bit_width(points));
  sort_by_bits(
      uses, bits, [](const auto& use) { return std::uint64_t{use.key[0]}; }, work.threads);
  tell(work.progress, 0.7);
  std::vector<std::uint64_t> single;
  for (auto at = uses.begin(); at != uses.end();) {
    const auto end = std::find_if(at, uses.end(), [&](const auto& use) { return use.key[0] != at->key[0]; });
    std::sort(at, end, [](const auto& a, const auto& b) { return a.key < b.key; });
    while (at != end) {
      const auto next = std::find_if(at, end, [&](const auto& use) { return use.key != at->key; });
      if (next - at == 1) single.push_back(at->place);
      at = next;
    }
  }
  std::sort(single.begin(), single.end());
  tell(work.progress, 1.0);
  BorderFacets border;
  std::uint32_t g = 0;
  const auto groups = static_cast<std::uint32_t>(cells.groups.size());
  std::size_t c = 0;
  for (const std::uint64_t place : single) {
    while (g < groups && place >= first[g + 1]) ++g;
    if (g == groups) {
      while (place >= first_of[c + 1]) ++c;
      border.push_back({g, static_cast<Index>(c), static_cast<std::uint8_t>(place - first_of[c])});
      continue;
    }
    const std::size_t count = facets_of(cells.groups[g].shape).size();
    border.push_back(
        {g, static_cast<Index>((place - first[g]) / count), static_cast<std::uint8_t>((place - first[g]) % count)});
  }
  return border;
}

}  // namespace

std::vector<Index> facet_points(const Polytopes& polytopes, std::size_t cell, std::size_t facet) {
  const PolytopeShape& shape = polytopes.shape(cell);
  const Index* const corners = polytopes.cell(cell);
  if (shape.face_count() == 1) return {corners[facet], corners[(facet + 1) % shape.corner_count()]};
  std::vector<Index> points;
  for (const std::uint8_t v : shape.ring(facet)) points.push_back(corners[v]);
  return points;
}

std::span<const CellFacet> facets_of(CellShape shape) {
  static const auto kFacets = [] {
    std::array<std::vector<CellFacet>, tables::kCellShapes> facets;
    for (unsigned s = 0; s < tables::kCellShapes; ++s)
      for (const Face& face : faces_of(static_cast<CellShape>(s)))
        facets[s].push_back(make_facet(static_cast<CellShape>(s), face.shape, face.corners));
    return facets;
  }();
  return kFacets[static_cast<std::size_t>(shape)];
}

BorderFacets find_border(std::size_t points, const CellGroups& cells, const WorkOptions& work) {
  const bool is_empty = cells.groups.empty();
  if (is_empty && cells.polytopes.size() == 0) return {};
  switch (is_empty ? static_cast<unsigned>(cells.polytopes.dim()) : table_of(cells.groups.front().shape).dim) {
    case 2:
      return find_border_of<2>(points, cells, work);
    case 3:
      return find_border_of<4>(points, cells, work);
    default:
      return find_border_of<8>(points, cells, work);
  }
}

}  // namespace tegl::detail
