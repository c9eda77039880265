// SPDX-License-Identifier: BSD-3-Clause
//
// Checks cells, sorts them by type, and finds their orientations.
#include "complex/cell_groups.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <Eigen/LU>

#include "base/workers.hpp"
#include "polytope/recognised_polyhedron.hpp"
#include "polytope/recognised_polytope.hpp"
#include "tegl/error.hpp"
#include "tegl/generated/cells.hpp"

namespace tegl::detail {

namespace {

using tables::CellShape;

constexpr CellKind kKinds[] = {
    {CellType::triangle, "triangle", CellShape::triangle, false},
    {CellType::pixel, "pixel", CellShape::quadrilateral, false},
    {CellType::quadrilateral, "quadrilateral", CellShape::quadrilateral, true},
    {CellType::tetrahedron, "tetrahedron", CellShape::tetrahedron, false},
    {CellType::voxel, "voxel", CellShape::hexahedron, false},
    {CellType::hexahedron, "hexahedron", CellShape::hexahedron, true},
    {CellType::wedge, "wedge", CellShape::wedge, false},
    {CellType::pyramid, "pyramid", CellShape::pyramid, true},
    {CellType::simplex4, "simplex4", CellShape::simplex4, false},
    {CellType::tetrahedron_prism, "tetrahedron_prism", CellShape::tetrahedron_prism, false},
    {CellType::voxel_prism, "voxel_prism", CellShape::hexahedron_prism, false},
    {CellType::hexahedron_prism, "hexahedron_prism", CellShape::hexahedron_prism, true},
    {CellType::wedge_prism, "wedge_prism", CellShape::wedge_prism, false},
    {CellType::pyramid_prism, "pyramid_prism", CellShape::pyramid_prism, true},
    {CellType::octahedron, "octahedron", CellShape::octahedron, false},
    {CellType::cell16, "cell16", CellShape::cell16, false},
    {CellType::octahedron_prism, "octahedron_prism", CellShape::octahedron_prism, false},
};

const CellKind& kind_of(CellType type) {
  const CellKind* const kind = find_kind(type);
  if (kind == nullptr)
    throw Error(
        ErrorCode::InvalidArgument,
        fmt::format(
            "cell type {}; expected 5, 8 to 14, 100 to 102, or 110 to 115 (7, 42 and 103 have any number of corners)",
            static_cast<int>(type)));
  return *kind;
}

const CellKind& kind_in(int dim, CellType type, std::size_t cell) {
  const CellKind* const kind = find_kind(type);
  if (kind != nullptr && static_cast<int>(table_of(kind->shape).dim) == dim) return *kind;
  std::string expected;
  for (const CellKind& k : kKinds)
    if (static_cast<int>(table_of(k.shape).dim) == dim)
      expected += fmt::format("{}{} ({})", expected.empty() ? "" : ", ", static_cast<int>(k.type), k.name);
  const char* const with_lists = dim == 2 ? "7 (polygon)" : dim == 3 ? "42 (polyhedron)" : "103 (polytope)";
  throw Error(ErrorCode::InvalidArgument,
              fmt::format("cell {}: type {} ({}); expected a {}D cell: {}, or {} in CellLists", cell,
                          static_cast<int>(type), name_of(type), dim, expected, with_lists));
}

/// Checks that corners are different points.
void check_corners(std::size_t cell, std::size_t points, std::span<const Index> corners) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (corners[i] >= points)
      throw Error(ErrorCode::InvalidArgument, fmt::format("cell {}: corner {} is point {}; expected a number below {}",
                                                          cell, i, corners[i], points));
    for (std::size_t j = 0; j < i; ++j)
      if (corners[j] == corners[i])
        throw Error(ErrorCode::InvalidArgument,
                    fmt::format("cell {}: corners {} and {} are both point {}; expected different points", cell, j, i,
                                corners[i]));
  }
}

/// Appends a cell's corners in the order of the table, checked.
void add_cell(const CellKind& kind, std::size_t cell, std::size_t points, const Index* corners, CellGroup& group) {
  const std::size_t count = group.corner_count, first = group.corners.size();
  check_corners(cell, points, {corners, count});
  group.corners.resize(first + count);
  for (std::size_t i = 0; i < count; ++i) group.corners[first + table_corner(kind, i)] = corners[i];
}

void require_cells(std::size_t cells) {
  constexpr std::size_t kMost = std::numeric_limits<Index>::max();
  if (cells > kMost) throw Error(ErrorCode::TooLarge, fmt::format("{} cells; expected at most {}", cells, kMost));
}

CellGroup empty_group(CellShape shape) { return {shape, table_of(shape).corner_count, {}}; }

/// The differences of a shape's reference corners from their mean.
template <int N>
std::vector<std::array<double, N>> centred_corners(const tables::CellTable& table) {
  std::vector<std::array<double, N>> corners(table.corner_count);
  for (std::size_t i = 0; i < N; ++i) {
    double mean = 0;
    for (std::uint32_t v = 0; v < table.corner_count; ++v)
      mean += table.corners[v * N + i] / double(table.corner_count);
    for (std::uint32_t v = 0; v < table.corner_count; ++v) corners[v][i] = table.corners[v * N + i] - mean;
  }
  return corners;
}

/// The orientation of a cell.
enum class CellSign { kept, inverted, unknown };

/// The sign of the best affine map from reference corners to points; `unknown` for a cell that is flat up to the
/// rounding of its coordinates.
template <int N>
CellSign sign_of(const std::vector<std::array<double, N>>& reference, const Index* corners,
                 const std::vector<std::array<double, N>>& points) {
  constexpr double kFlat = 0x1p-30;  // of the volume of a box with the map's rows or columns as edges
  Eigen::Matrix<double, N, N> map = Eigen::Matrix<double, N, N>::Zero();
  const std::array<double, N>& origin = points[corners[0]];
  for (std::size_t v = 0; v < reference.size(); ++v)
    for (int i = 0; i < N; ++i)
      for (int k = 0; k < N; ++k) map(i, k) += reference[v][i] * (points[corners[v]][k] - origin[k]);
  // very large and very small cells: the determinant's sign without overflow or underflow
  for (int k = 0; k < N; ++k) {
    const double largest = map.col(k).cwiseAbs().maxCoeff();
    if (largest == 0 || (largest > 0x1p-30 && largest < 0x1p30)) continue;
    const int exponent = std::ilogb(largest);
    for (int i = 0; i < N; ++i) map(i, k) = std::scalbn(map(i, k), -exponent);
  }
  const double volume = map.determinant(), flat = volume * volume / (kFlat * kFlat);
  double rows = 1, columns = 1;
  for (int i = 0; i < N; ++i) {
    rows *= map.row(i).squaredNorm();
    columns *= map.col(i).squaredNorm();
  }
  if (flat <= rows && flat <= columns) return CellSign::unknown;
  return volume < 0 ? CellSign::inverted : CellSign::kept;
}

}  // namespace

const CellKind* find_kind(CellType type) noexcept {
  const auto* const found =
      std::find_if(std::begin(kKinds), std::end(kKinds), [type](const CellKind& kind) { return kind.type == type; });
  return found == std::end(kKinds) ? nullptr : found;
}

const tables::CellTable& table_of(CellShape shape) noexcept {
  return tables::cell_table(shape, Triangulation::barycentric);
}

std::size_t table_corner(const CellKind& kind, std::size_t i) noexcept {
  if (!kind.is_ring) return i;
  // a layer of a pyramid has 5 corners, of another cell 4
  const std::size_t layer =
      kind.shape == CellShape::pyramid || kind.shape == CellShape::pyramid_prism ? std::size_t{5} : std::size_t{4};
  const std::size_t in_layer = i % layer;
  return in_layer == 2 ? i + 1 : in_layer == 3 ? i - 1 : i;
}

CellShape prism_of(CellShape shape) noexcept {
  switch (shape) {
    case CellShape::triangle:
      return CellShape::wedge;
    case CellShape::quadrilateral:
      return CellShape::hexahedron;
    case CellShape::tetrahedron:
      return CellShape::tetrahedron_prism;
    case CellShape::wedge:
      return CellShape::wedge_prism;
    case CellShape::pyramid:
      return CellShape::pyramid_prism;
    case CellShape::octahedron:
      return CellShape::octahedron_prism;
    default:
      return CellShape::hexahedron_prism;
  }
}

std::vector<CellRange> ranges_of(const CellGroups& cells) {
  constexpr std::size_t kCells = std::size_t{1} << 14;
  std::vector<CellRange> ranges;
  for (std::size_t g = 0; g < cells.groups.size(); ++g)
    for (std::size_t from = 0; from < cells.groups[g].size(); from += kCells)
      ranges.push_back({g, from, std::min(cells.groups[g].size(), from + kCells)});
  return ranges;
}

CellGroups group_cells(int dim, std::size_t points, CellType type, std::span<const Index> corners) {
  const CellKind& kind = kind_in(dim, type, 0);
  CellGroups cells;
  CellGroup group = empty_group(kind.shape);
  if (corners.size() % group.corner_count != 0)
    throw Error(ErrorCode::InvalidArgument, fmt::format("{} corners; expected a multiple of {} for cells of type {}",
                                                        corners.size(), group.corner_count, kind.name));
  cells.cell_count = corners.size() / group.corner_count;
  require_cells(cells.cell_count);
  group.corners.reserve(corners.size());
  for (std::size_t c = 0; c < cells.cell_count; ++c)
    add_cell(kind, c, points, corners.data() + c * group.corner_count, group);
  if (cells.cell_count > 0) cells.groups.push_back(std::move(group));
  return cells;
}

CellGroups group_cells(int dim, std::size_t points, std::span<const CellType> types, std::span<const Index> corners) {
  require_cells(types.size());
  std::vector<CellGroup> groups;
  for (unsigned s = 0; s < tables::kCellShapes; ++s) groups.push_back(empty_group(static_cast<CellShape>(s)));
  std::size_t at = 0;
  for (std::size_t c = 0; c < types.size(); ++c) {
    const CellKind& kind = kind_in(dim, types[c], c);
    CellGroup& group = groups[static_cast<std::size_t>(kind.shape)];
    if (corners.size() - at < group.corner_count)
      throw Error(ErrorCode::InvalidArgument, fmt::format("cell {}: {} corners are left; a {} has {}", c,
                                                          corners.size() - at, kind.name, group.corner_count));
    add_cell(kind, c, points, corners.data() + at, group);
    at += group.corner_count;
  }
  if (at != corners.size())
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{} corners; expected {} for these {} cells", corners.size(), at, types.size()));
  std::erase_if(groups, [](const CellGroup& group) { return group.corners.empty(); });
  return {std::move(groups), types.size()};
}

namespace {

void check_lists(const CellLists& cells) {
  const auto check = [](const char* what, const std::vector<std::uint64_t>& ends, std::size_t size) {
    for (std::size_t i = 0; i < ends.size(); ++i)
      if (const std::uint64_t begin = i == 0 ? 0 : ends[i - 1]; ends[i] < begin || ends[i] > size)
        throw Error(ErrorCode::InvalidArgument,
                    fmt::format("end {} of {}: {} after {}; expected ascending numbers up to {}", i, what, ends[i],
                                begin, size));
    if (const std::uint64_t last = ends.empty() ? 0 : ends.back(); last != size)
      throw Error(ErrorCode::InvalidArgument, fmt::format("the last end of {} is {}; expected {}", what, last, size));
  };
  if (cells.ends.size() != cells.types.size())
    throw Error(ErrorCode::InvalidArgument, fmt::format("{} ends of corners; expected one for each of the {} cells",
                                                        cells.ends.size(), cells.types.size()));
  if (cells.face_lists_ends.size() != cells.types.size() && !cells.face_lists_ends.empty())
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{} ends of lists of faces; expected one for each of the {} cells, or none",
                            cells.face_lists_ends.size(), cells.types.size()));
  if (cells.facet_lists_ends.size() != cells.types.size() && !cells.facet_lists_ends.empty())
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{} ends of lists of facets; expected one for each of the {} cells, or none",
                            cells.facet_lists_ends.size(), cells.types.size()));
  check("corners", cells.ends, cells.corners.size());
  check("faces", cells.face_ends, cells.face_corners.size());
  check("lists of facets", cells.facet_lists_ends, cells.facet_ends.size());
  if (cells.facet_ends.empty()) return check("lists of faces", cells.face_lists_ends, cells.face_ends.size());
  if (!cells.face_lists_ends.empty())
    throw Error(
        ErrorCode::InvalidArgument,
        fmt::format("{} ends of lists of faces beside {} facets; expected none: the faces of polytopes belong to "
                    "their facets",
                    cells.face_lists_ends.size(), cells.facet_ends.size()));
  check("facets", cells.facet_ends, cells.face_ends.size());
}

/// Appends cells that may be polygons, polyhedra and 4D polytopes.
class ListedCells {
 public:
  ListedCells(int dim, std::size_t points, const CellLists& cells) : dim_(dim), points_(points), cells_(cells) {
    for (unsigned s = 0; s < tables::kCellShapes; ++s) groups_.push_back(empty_group(static_cast<CellShape>(s)));
  }

  void add(std::size_t c) {
    const std::uint64_t begin = c == 0 ? 0 : cells_.ends[c - 1];
    const std::span<const Index> corners(cells_.corners.data() + begin, cells_.ends[c] - begin);
    const CellType type = cells_.types[c];
    if (type == CellType::polygon && dim_ == 2) return add_polygon(c, corners);
    if (type == CellType::polyhedron && dim_ == 3) return add_polyhedron(c, corners);
    if (type == CellType::polytope && dim_ == 4) return add_polytope(c, corners);
    const CellKind& kind = kind_in(dim_, type, c);
    CellGroup& group = groups_[static_cast<std::size_t>(kind.shape)];
    if (corners.size() != group.corner_count)
      throw Error(ErrorCode::InvalidArgument, fmt::format("cell {}: {} corners; expected {}, of a {}", c,
                                                          corners.size(), group.corner_count, kind.name));
    add_cell(kind, c, points_, corners.data(), group);
  }

  CellGroups take() {
    std::erase_if(groups_, [](const CellGroup& group) { return group.corners.empty(); });
    if (dim_ == 4) polytopes_.find_entangled_facets();
    return {std::move(groups_), cells_.types.size(), std::move(polytopes_)};
  }

 private:
  void add_known(CellType type, std::size_t c, std::span<const Index> corners) {
    const CellKind& kind = kind_of(type);
    add_cell(kind, c, points_, corners.data(), groups_[static_cast<std::size_t>(kind.shape)]);
  }

  void add_polygon(std::size_t c, std::span<const Index> corners) {
    if (corners.size() < 3 || corners.size() > kPolytopeCorners)
      throw Error(ErrorCode::InvalidArgument, fmt::format("cell {}: a polygon of {} corners; expected 3 to {}", c,
                                                          corners.size(), kPolytopeCorners));
    if (corners.size() < 5)
      return add_known(corners.size() == 3 ? CellType::triangle : CellType::quadrilateral, c, corners);
    check_corners(c, points_, corners);
    polytopes_.add_polygon(corners);
  }

  void add_polyhedron(std::size_t c, std::span<const Index> corners) {
    const std::uint64_t first = c == 0 || cells_.face_lists_ends.empty() ? 0 : cells_.face_lists_ends[c - 1];
    const std::uint64_t last = cells_.face_lists_ends.empty() ? 0 : cells_.face_lists_ends[c];
    const std::uint64_t begin = first == 0 ? 0 : cells_.face_ends[first - 1];
    ends_.clear();
    for (std::uint64_t f = first; f < last; ++f) ends_.push_back(cells_.face_ends[f] - begin);
    const std::span<const Index> faces(cells_.face_corners.data() + begin, ends_.empty() ? 0 : ends_.back());
    RecognisedPolyhedron found = recognise_polyhedron(c, points_, faces, ends_);
    if (!corners.empty()) require_same_corners(c, corners, found.corners);
    static constexpr CellType kTypes[] = {CellType::tetrahedron, CellType::pyramid, CellType::wedge,
                                          CellType::hexahedron, CellType::octahedron};
    if (found.shape != PolyhedronShape::other)
      return add_known(kTypes[static_cast<std::size_t>(found.shape)], c, found.corners);
    polytopes_.add_polyhedron(found.corners, std::move(found.rings), std::move(found.ends));
  }

  void add_polytope(std::size_t c, std::span<const Index> corners) {
    const bool has_facets = !cells_.facet_lists_ends.empty();
    const std::uint64_t first = c == 0 || !has_facets ? 0 : cells_.facet_lists_ends[c - 1];
    const std::uint64_t last = has_facets ? cells_.facet_lists_ends[c] : 0;
    const std::uint64_t first_face = first == 0 ? 0 : cells_.facet_ends[first - 1];
    const std::uint64_t begin = first_face == 0 ? 0 : cells_.face_ends[first_face - 1];
    ends_.clear();
    facet_ends_.clear();
    for (std::uint64_t f = first; f < last; ++f) facet_ends_.push_back(cells_.facet_ends[f] - first_face);
    for (std::uint64_t k = 0; !facet_ends_.empty() && k < facet_ends_.back(); ++k)
      ends_.push_back(cells_.face_ends[first_face + k] - begin);
    const std::span<const Index> faces(cells_.face_corners.data() + begin, ends_.empty() ? 0 : ends_.back());
    RecognisedPolytope found = recognise(c, {faces, ends_, facet_ends_});
    if (!corners.empty()) require_same_corners(c, corners, found.corners);
    static constexpr CellType kTypes[] = {
        CellType::tetrahedron_prism, CellType::pyramid_prism, CellType::wedge_prism, CellType::hexahedron_prism,
        CellType::octahedron_prism,  CellType::simplex4,      CellType::cell16};
    if (found.kind != PolytopeKind::other)
      return add_known(kTypes[static_cast<std::size_t>(found.kind)], c, found.corners);
    polytopes_.add_polytope(std::move(found));
  }

  /// recognise_polytope, usually once for all cells with the same lists up to the numbers of their points. `corners` of
  /// what is kept are places among the distinct points.
  RecognisedPolytope recognise(std::size_t c, const PolytopeLists& lists) {
    std::vector<Index> distinct;
    // Both lists follow their lengths, so different ones have different keys.
    std::vector<std::uint64_t> key = {lists.face_ends.size(), lists.facet_ends.size()};
    key.insert(key.end(), lists.face_ends.begin(), lists.face_ends.end());
    key.insert(key.end(), lists.facet_ends.begin(), lists.facet_ends.end());
    for (const Index p : lists.corners) {
      const auto at = static_cast<std::size_t>(std::find(distinct.begin(), distinct.end(), p) - distinct.begin());
      if (at == distinct.size()) distinct.push_back(p);
      if (p >= points_ || at == kPolytopeCorners) return recognise_polytope(c, points_, lists);  // an error
      key.push_back(at);
    }
    auto known = recognised_.find(key);
    if (known == recognised_.end()) {
      RecognisedPolytope found = recognise_polytope(c, points_, lists);
      for (Index& p : found.corners)
        p = static_cast<Index>(std::find(distinct.begin(), distinct.end(), p) - distinct.begin());
      if (recognised_.size() == kMostRecognised) recognised_.clear();
      known = recognised_.emplace(std::move(key), std::move(found)).first;
    }
    RecognisedPolytope result = known->second;
    for (Index& p : result.corners) p = distinct[p];
    return result;
  }

  void require_same_corners(std::size_t c, std::span<const Index> corners, const std::vector<Index>& of_faces) const {
    check_corners(c, points_, corners);
    std::vector<Index> given(corners.begin(), corners.end()), found(of_faces);
    std::sort(given.begin(), given.end());
    std::sort(found.begin(), found.end());
    if (given == found) return;
    const auto [at, other] = std::mismatch(given.begin(), given.end(), found.begin(), found.end());
    const bool is_given = other == found.end() || (at != given.end() && *at < *other);
    throw Error(
        ErrorCode::InvalidArgument,
        fmt::format("cell {}: point {} is {}; expected the points of the faces as corners", c, is_given ? *at : *other,
                    is_given ? "a corner and in no face" : "in a face and not among the corners"));
  }

  int dim_;
  std::size_t points_;
  const CellLists& cells_;
  std::vector<CellGroup> groups_;
  Polytopes polytopes_;
  std::vector<std::uint64_t> ends_, facet_ends_;
  static constexpr std::size_t kMostRecognised = 4096;  ///< in meshes without repeated lists these are all different
  std::map<std::vector<std::uint64_t>, RecognisedPolytope> recognised_;
};

}  // namespace

CellGroups group_cells(int dim, std::size_t points, const CellLists& cells) {
  require_cells(cells.types.size());
  check_lists(cells);
  ListedCells listed(dim, points, cells);
  for (std::size_t c = 0; c < cells.types.size(); ++c) listed.add(c);
  return listed.take();
}

template <int N>
CellSigns find_cell_signs(const CellGroups& cells, const std::vector<std::array<double, N>>& points) {
  CellSigns signs;
  for (const CellGroup& group : cells.groups) {
    const auto reference = centred_corners<N>(table_of(group.shape));
    std::vector<std::uint64_t>& inverted = signs.emplace_back(block_count(group.size(), 64));
    std::atomic<bool> any_kept = false, any_inverted = false;
    std::vector<std::uint64_t> unknown(inverted.size());
    for_each_item(inverted.size(), 0, {}, [&](std::size_t w) {
      const std::size_t first = 64 * w, count = std::min<std::size_t>(64, group.size() - first);
      for (std::size_t c = 0; c < count; ++c) {
        const CellSign sign = sign_of<N>(reference, group.cell(first + c), points);
        inverted[w] |= std::uint64_t{sign == CellSign::inverted} << c;
        unknown[w] |= std::uint64_t{sign == CellSign::unknown} << c;
      }
      if (inverted[w] != 0) any_inverted.store(true, std::memory_order_relaxed);
      if (std::popcount(inverted[w] | unknown[w]) != static_cast<int>(count))
        any_kept.store(true, std::memory_order_relaxed);
    });
    // Flat cells: corners are in one order in most meshes, and in all that Delaunay triangulations give.
    if (any_inverted && !any_kept)
      for (std::size_t w = 0; w < inverted.size(); ++w) inverted[w] |= unknown[w];
  }
  signs.push_back(find_polytope_signs<N>(cells.polytopes, points));
  return signs;
}
template CellSigns find_cell_signs<2>(const CellGroups&, const std::vector<std::array<double, 2>>&);
template CellSigns find_cell_signs<3>(const CellGroups&, const std::vector<std::array<double, 3>>&);
template CellSigns find_cell_signs<4>(const CellGroups&, const std::vector<std::array<double, 4>>&);

}  // namespace tegl::detail

namespace tegl {

std::string_view name_of(CellType type) noexcept {
  if (type == CellType::polygon) return "polygon";
  if (type == CellType::polyhedron) return "polyhedron";
  if (type == CellType::polytope) return "polytope";
  const detail::CellKind* const kind = detail::find_kind(type);
  return kind == nullptr ? "unknown" : kind->name;
}

std::size_t corner_count(CellType type) { return detail::table_of(detail::kind_of(type).shape).corner_count; }

int dimension(CellType type) {
  if (type == CellType::polygon) return 2;
  if (type == CellType::polyhedron) return 3;
  if (type == CellType::polytope) return 4;
  return static_cast<int>(detail::table_of(detail::kind_of(type).shape).dim);
}

}  // namespace tegl
