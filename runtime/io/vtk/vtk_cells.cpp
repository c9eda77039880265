// SPDX-License-Identifier: BSD-3-Clause
//
// Reads points and cells of VTK's UnstructuredGrid and StructuredGrid.
#include "vtk/vtk_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>

#include "base/common.hpp"
#include "base/raw_image.hpp"
#include "vtk/structured.hpp"

namespace tegl::io_detail {

namespace {

struct TypeOfVtk {
  std::uint8_t number;
  int dimension;
  std::string_view name;
};

/// The types of vtkCellType.h.
constexpr std::array<TypeOfVtk, 64> kTypesOfVtk = {{{0, 0, "empty cell"},
                                                    {1, 0, "vertex"},
                                                    {2, 0, "poly-vertex"},
                                                    {3, 1, "line"},
                                                    {4, 1, "poly-line"},
                                                    {5, 2, "triangle"},
                                                    {6, 2, "triangle strip"},
                                                    {7, 2, "polygon"},
                                                    {8, 2, "pixel"},
                                                    {9, 2, "quadrilateral"},
                                                    {10, 3, "tetrahedron"},
                                                    {11, 3, "voxel"},
                                                    {12, 3, "hexahedron"},
                                                    {13, 3, "wedge"},
                                                    {14, 3, "pyramid"},
                                                    {15, 3, "pentagonal prism"},
                                                    {16, 3, "hexagonal prism"},
                                                    {21, 1, "quadratic edge"},
                                                    {22, 2, "quadratic triangle"},
                                                    {23, 2, "quadratic quadrilateral"},
                                                    {24, 3, "quadratic tetrahedron"},
                                                    {25, 3, "quadratic hexahedron"},
                                                    {26, 3, "quadratic wedge"},
                                                    {27, 3, "quadratic pyramid"},
                                                    {28, 2, "biquadratic quadrilateral"},
                                                    {29, 3, "triquadratic hexahedron"},
                                                    {30, 2, "quadratic linear quadrilateral"},
                                                    {31, 3, "quadratic linear wedge"},
                                                    {32, 3, "biquadratic quadratic wedge"},
                                                    {33, 3, "biquadratic quadratic hexahedron"},
                                                    {34, 2, "biquadratic triangle"},
                                                    {35, 1, "cubic line"},
                                                    {36, 2, "quadratic polygon"},
                                                    {37, 3, "triquadratic pyramid"},
                                                    {41, 3, "convex point set"},
                                                    {42, 3, "polyhedron"},
                                                    {51, 1, "parametric curve"},
                                                    {52, 2, "parametric surface"},
                                                    {53, 2, "parametric triangle"},
                                                    {54, 2, "parametric quadrilateral"},
                                                    {55, 3, "parametric tetrahedron"},
                                                    {56, 3, "parametric hexahedron"},
                                                    {60, 1, "higher-order edge"},
                                                    {61, 2, "higher-order triangle"},
                                                    {62, 2, "higher-order quadrilateral"},
                                                    {63, 2, "higher-order polygon"},
                                                    {64, 3, "higher-order tetrahedron"},
                                                    {65, 3, "higher-order wedge"},
                                                    {66, 3, "higher-order pyramid"},
                                                    {67, 3, "higher-order hexahedron"},
                                                    {68, 1, "Lagrange curve"},
                                                    {69, 2, "Lagrange triangle"},
                                                    {70, 2, "Lagrange quadrilateral"},
                                                    {71, 3, "Lagrange tetrahedron"},
                                                    {72, 3, "Lagrange hexahedron"},
                                                    {73, 3, "Lagrange wedge"},
                                                    {74, 3, "Lagrange pyramid"},
                                                    {75, 1, "Bezier curve"},
                                                    {76, 2, "Bezier triangle"},
                                                    {77, 2, "Bezier quadrilateral"},
                                                    {78, 3, "Bezier tetrahedron"},
                                                    {79, 3, "Bezier hexahedron"},
                                                    {80, 3, "Bezier wedge"},
                                                    {81, 3, "Bezier pyramid"}}};

const TypeOfVtk* find_type(std::uint8_t number) {
  const auto found = std::find_if(kTypesOfVtk.begin(), kTypesOfVtk.end(),
                                  [&](const TypeOfVtk& type) { return type.number == number; });
  return found == kTypesOfVtk.end() ? nullptr : found;
}

void require_count(std::uint64_t count, const char* what, const VtkFile& file) {
  if (count >= std::numeric_limits<Index>::max())
    fail(ErrorCode::TooLarge, file.path(), "{} {}; expected fewer than {}", count, what,
         std::numeric_limits<Index>::max());
}

void append_points(const std::vector<double>& own, StoredCells& all, const VtkFile& file) {
  for (std::size_t i = 0; i < own.size(); ++i)
    if (!std::isfinite(own[i]))
      fail(ErrorCode::MalformedFile, file.path(), "point {} has the coordinate {}; expected finite ones",
           all.point_count() + i / 3, own[i]);
  all.points.insert(all.points.end(), own.begin(), own.end());
  require_count(all.point_count(), "points", file);
}

VtkArray points_array(const VtkFile& file, const XmlElement& piece) {
  const VtkArray array = file.array(piece, "Points", "");
  if (array.components != 3)
    fail(ErrorCode::MalformedFile, file.path(), "points of {} components; expected 3", array.components);
  return array;
}

constexpr std::uint8_t kPolyhedron = 42;

/// Appends the faces of a piece's polyhedra as VTK 9.4 and later write them: `face_connectivity` has the corners of all
/// faces, `face_offsets` the end of each face in it, `polyhedron_to_faces` the faces of each polyhedron and
/// `polyhedron_offsets` the end of each cell in it; cells of other types have no faces.
void append_listed_faces(const VtkFile& file, const XmlElement& piece, std::uint64_t points, std::size_t first_cell,
                         std::int64_t first_point, StoredCells& all) {
  const std::size_t cells = all.types.size() - first_cell;
  const auto read = [&](const char* name, std::optional<std::uint64_t> count = std::nullopt) {
    return file.read_integers(file.array(piece, "Cells", name), count);
  };
  const auto corners = read("face_connectivity"), face_ends = read("face_offsets"), faces = read("polyhedron_to_faces");
  const auto ends = read("polyhedron_offsets", cells);
  const auto size = [](const auto& numbers) { return static_cast<std::int64_t>(numbers.size()); };
  for (std::size_t f = 0; f < face_ends.size(); ++f)
    if (const std::int64_t from = f == 0 ? 0 : face_ends[f - 1]; face_ends[f] < from || face_ends[f] > size(corners))
      fail(ErrorCode::MalformedFile, file.path(),
           "face {} has the corners {} to {} of {}; expected ascending face_offsets", f, from, face_ends[f],
           corners.size());
  std::vector<std::uint8_t> uses(face_ends.size());  // limits the memory for what a small file can name
  for (std::size_t c = 0; c < cells; ++c) {
    const std::size_t cell = first_cell + c;
    const std::int64_t begin = c == 0 ? 0 : ends[c - 1];
    if (ends[c] < begin || ends[c] > size(faces))
      fail(ErrorCode::MalformedFile, file.path(),
           "cell {} has the faces {} to {} of {}; expected ascending polyhedron_offsets", cell, begin, ends[c],
           faces.size());
    if (all.types[cell] != kPolyhedron && ends[c] != begin)
      fail(ErrorCode::MalformedFile, file.path(), "cell {} is a {} with {} faces; expected faces of polyhedra only",
           cell, name_of_type(all.types[cell]), ends[c] - begin);
    for (std::int64_t i = begin; i < ends[c]; ++i) {
      const std::int64_t face = faces[static_cast<std::size_t>(i)];
      if (face < 0 || face >= size(face_ends))
        fail(ErrorCode::MalformedFile, file.path(), "cell {} has the face {}; expected 0 to {}, the last face", cell,
             face, size(face_ends) - 1);
      if (++uses[static_cast<std::size_t>(face)] > 2)
        fail(ErrorCode::MalformedFile, file.path(),
             "cell {} has the face {}, which is listed twice before; expected each face at most twice, in two cells",
             cell, face);
      const std::int64_t to = face_ends[static_cast<std::size_t>(face)];
      for (std::int64_t k = face == 0 ? 0 : face_ends[static_cast<std::size_t>(face) - 1]; k < to; ++k) {
        const std::int64_t corner = corners[static_cast<std::size_t>(k)];
        if (corner < 0 || corner >= static_cast<std::int64_t>(points))
          fail(ErrorCode::MalformedFile, file.path(), "face {} has the point {}; expected 0 to {}, the last point",
               face, corner, static_cast<std::int64_t>(points) - 1);
        all.face_corners.push_back(first_point + corner);
      }
      all.face_ends.push_back(all.face_corners.size());
    }
    all.face_lists_ends.push_back(all.face_ends.size());
  }
}

/// Appends the faces of a piece's polyhedra: `faces` has for each of them the number of faces, then of each face the
/// number of corners and the corners; `faceoffsets` has the end of each cell in it, or -1.
void append_faces(const VtkFile& file, const XmlElement& piece, std::uint64_t points, std::size_t first_cell,
                  std::int64_t first_point, StoredCells& all) {
  const std::size_t cells = all.types.size() - first_cell;
  const auto begin = all.types.begin() + static_cast<std::ptrdiff_t>(first_cell);
  if (std::find(begin, all.types.end(), kPolyhedron) == all.types.end()) {
    all.face_lists_ends.resize(all.types.size(), all.face_ends.size());
    return;
  }
  const auto arrays = file.arrays(piece.child("Cells"));
  const auto has_array = [&](std::string_view name) {
    return std::any_of(arrays.begin(), arrays.end(), [&](const VtkArray& array) { return array.name == name; });
  };
  if (has_array("face_connectivity")) return append_listed_faces(file, piece, points, first_cell, first_point, all);
  if (!has_array("faces"))
    fail(ErrorCode::MalformedFile, file.path(),
         "polyhedra without the array 'faces'; expected 'faces' and 'faceoffsets', or 'face_connectivity', "
         "'face_offsets', 'polyhedron_to_faces' and 'polyhedron_offsets'");
  const auto faces = file.read_integers(file.array(piece, "Cells", "faces"), std::nullopt);
  const auto ends = file.read_integers(file.array(piece, "Cells", "faceoffsets"), cells);
  std::int64_t at = 0;
  for (std::size_t c = 0; c < cells; ++c) {
    const std::size_t cell = first_cell + c;
    if (all.types[cell] == kPolyhedron) {
      const std::int64_t end = ends[c];
      if (end <= at || end > static_cast<std::int64_t>(faces.size()))
        fail(ErrorCode::MalformedFile, file.path(),
             "cell {} has the faces {} to {} of {} numbers; expected ascending faceoffsets", cell, at, end,
             faces.size());
      const auto next = [&](std::int64_t least, std::int64_t most, const char* what) {
        if (at >= end)
          fail(ErrorCode::MalformedFile, file.path(),
               "cell {} has faces that end within a face, before {}; expected the rest of it", cell, what);
        const std::int64_t number = faces[static_cast<std::size_t>(at++)];
        if (number < least || number > most)
          fail(ErrorCode::MalformedFile, file.path(), "cell {} has {} {} in its faces; expected {} to {}", cell, what,
               number, least, most);
        return number;
      };
      for (std::int64_t rest = next(0, end - at, "the number of faces"); rest > 0; --rest) {
        for (std::int64_t corners = next(0, end - at, "the number of corners"); corners > 0; --corners)
          all.face_corners.push_back(first_point + next(0, static_cast<std::int64_t>(points) - 1, "the point"));
        all.face_ends.push_back(all.face_corners.size());
      }
      if (at != end)
        fail(ErrorCode::MalformedFile, file.path(), "cell {} has {} numbers after its faces; expected none", cell,
             end - at);
    }
    all.face_lists_ends.push_back(all.face_ends.size());
  }
}

/// Appends a piece of an UnstructuredGrid.
void append_piece(const VtkFile& file, const XmlElement& piece, StoredCells& all) {
  const std::uint64_t points = file.whole_number(piece, "NumberOfPoints");
  const std::uint64_t cells = file.whole_number(piece, "NumberOfCells");
  require_count(points, "points", file);
  require_count(cells, "cells", file);
  const auto first_point = static_cast<std::int64_t>(all.point_count());
  const std::uint64_t first_corner = all.corners.size(), first_cell = all.types.size();
  if (points > 0) append_points(file.read_doubles(points_array(file, piece), 3 * points), all, file);
  if (cells == 0) return;
  const auto types = file.read_integers(file.array(piece, "Cells", "types"), cells);
  const auto ends = file.read_integers(file.array(piece, "Cells", "offsets"), cells);
  const auto corners = file.read_integers(file.array(piece, "Cells", "connectivity"), std::nullopt);
  const auto count = static_cast<std::int64_t>(corners.size());
  for (std::size_t c = 0; c < types.size(); ++c) {
    const std::int64_t begin = c == 0 ? 0 : ends[c - 1];
    if (ends[c] < begin || ends[c] > count)
      fail(ErrorCode::MalformedFile, file.path(), "cell {} has the corners {} to {} of {}; expected ascending offsets",
           first_cell + c, begin, ends[c], count);
    if (types[c] < 0 || types[c] > 255)
      fail(ErrorCode::MalformedFile, file.path(), "cell {} has the type {}; expected 0 to 255", first_cell + c,
           types[c]);
    for (std::int64_t i = begin; i < ends[c]; ++i)
      if (const std::int64_t corner = corners[static_cast<std::size_t>(i)];
          corner < 0 || corner >= static_cast<std::int64_t>(points))
        fail(ErrorCode::MalformedFile, file.path(), "cell {} has the corner {}; expected 0 to {}, the last point",
             first_cell + c, corner, static_cast<std::int64_t>(points) - 1);
    all.types.push_back(static_cast<std::uint8_t>(types[c]));
    all.ends.push_back(first_corner + static_cast<std::uint64_t>(ends[c]));
  }
  for (std::int64_t i = 0; i < ends.back(); ++i)
    all.corners.push_back(first_point + corners[static_cast<std::size_t>(i)]);
  append_faces(file, piece, points, first_cell, first_point, all);
  require_count(all.types.size(), "cells", file);
}

/// Finds the points of later pieces that lie where a point of an earlier piece lies.
void find_same_points(StoredCells& all, const std::vector<std::uint64_t>& piece_ends) {
  std::vector<Index> order(all.same_point);
  const auto at = [&](Index p) { return std::span(all.points).subspan(3 * std::size_t{p}, 3); };
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    const auto left = at(a), right = at(b);
    for (std::size_t i = 0; i < 3; ++i)
      if (left[i] != right[i]) return left[i] < right[i];
    return a < b;
  });
  const auto piece_of = [&](Index p) { return std::upper_bound(piece_ends.begin(), piece_ends.end(), p); };
  Index first = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || !std::ranges::equal(at(order[i]), at(first))) first = order[i];
    if (piece_of(order[i]) != piece_of(first)) all.same_point[order[i]] = first;
  }
}

/// The cells of a structured grid: hexahedra, or quadrilaterals if one axis has one point.
void add_structured_cells(const VtkFile& file, StoredCells& all) {
  const auto sizes = whole_extent(file).sizes(false);
  std::vector<std::size_t> axes;
  for (std::size_t a = 0; a < 3; ++a)
    if (sizes[a] > 1) axes.push_back(a);
  if (axes.size() < 2)
    fail(ErrorCode::UnsupportedData, file.path(), "a structured grid of {} points; expected at least 2 along two axes",
         shape_text(sizes));
  const std::array<std::int64_t, 3> steps = {1, static_cast<std::int64_t>(sizes[0]),
                                             static_cast<std::int64_t>(sizes[0] * sizes[1])};
  const std::int64_t u = steps[axes[0]], v = steps[axes[1]], w = axes.size() == 3 ? steps[axes[2]] : 0;
  const auto cells = whole_extent(file).sizes(true);
  require_count(cells[0] * cells[1] * cells[2], "cells", file);
  for (std::uint64_t z = 0; z < cells[2]; ++z)
    for (std::uint64_t y = 0; y < cells[1]; ++y)
      for (std::uint64_t x = 0; x < cells[0]; ++x) {
        const std::int64_t p = static_cast<std::int64_t>((z * sizes[1] + y) * sizes[0] + x);
        for (const std::int64_t layer : {p, p + w}) {
          for (const std::int64_t corner : {layer, layer + u, layer + u + v, layer + v}) all.corners.push_back(corner);
          if (w == 0) break;
        }
        all.types.push_back(static_cast<std::uint8_t>(w == 0 ? CellType::quadrilateral : CellType::hexahedron));
        all.ends.push_back(all.corners.size());
      }
}

/// Marks the cells that are hidden or belong to another piece.
void find_hidden(const VtkFile& file, StoredCells& all) {
  if (file.type() == "StructuredGrid") {
    all.is_hidden = hidden_in_structured(file, true);
    return;
  }
  const auto pieces = file.pieces();
  if (std::none_of(pieces.begin(), pieces.end(), [&](const auto* piece) { return ghosts_of(file, *piece, true); }))
    return;
  const auto append = [&](const ValueArray& ghosts) {
    std::visit(
        [&]<class T>(const ValueVector<T>& values) {
          for (const T value : values) {
            const GhostMarks marks(static_cast<std::uint64_t>(value), true);
            all.is_hidden.push_back(marks.is_hidden || marks.is_duplicate);
          }
        },
        ghosts);
  };
  for (const XmlElement* const piece : pieces) {
    const std::uint64_t count = file.whole_number(*piece, "NumberOfCells");
    if (const auto ghosts = ghosts_of(file, *piece, true); ghosts && count > 0)
      append(file.read(*ghosts, count));
    else
      all.is_hidden.insert(all.is_hidden.end(), static_cast<std::size_t>(count), false);
  }
}

}  // namespace

int dimension_of(std::uint8_t type) {
  const TypeOfVtk* const found = find_type(type);
  return found == nullptr ? -1 : found->dimension;
}

std::string_view name_of_type(std::uint8_t type) {
  const TypeOfVtk* const found = find_type(type);
  return found == nullptr ? "unknown type" : found->name;
}

StoredCells read_cells(const VtkFile& file, const Progress& progress) {
  StoredCells all;
  if (file.type() == "StructuredGrid") {
    points_array(file, *file.pieces().front());
    const std::string name = file.array(*file.pieces().front(), "Points", "").name;
    const ValueArray points = read_structured(file, "Points", name, 3, false, progress);
    append_points(std::visit([](const auto& v) { return std::vector<double>(v.begin(), v.end()); }, points), all, file);
    add_structured_cells(file, all);
  } else if (file.type() == "UnstructuredGrid") {
    std::vector<std::uint64_t> piece_ends;
    for (const XmlElement* const piece : file.pieces()) {
      append_piece(file, *piece, all);
      piece_ends.push_back(all.point_count());
      all.piece_ends.push_back(all.types.size());
      tick(progress, 0.5, file.path());
    }
    all.same_point.resize(static_cast<std::size_t>(all.point_count()));
    std::iota(all.same_point.begin(), all.same_point.end(), Index{0});
    if (piece_ends.size() > 1) find_same_points(all, piece_ends);
  } else {
    fail(ErrorCode::UnsupportedData, file.path(), "holds {}; expected a mesh: UnstructuredGrid or StructuredGrid",
         shown(file.type()));
  }
  find_hidden(file, all);
  return all;
}

ValueArray read_cell_values(const VtkFile& file, std::string_view parent, const std::string& name,
                            std::uint64_t components, const Progress& progress) {
  const bool of_cells = parent == "CellData";
  if (file.type() == "StructuredGrid") return read_structured(file, parent, name, components, of_cells, progress);
  ValueArray all;
  bool is_first = true;
  for (const XmlElement* const piece : file.pieces()) {
    const std::uint64_t count = file.whole_number(*piece, of_cells ? "NumberOfCells" : "NumberOfPoints");
    if (count == 0) continue;
    require_count(count, of_cells ? "cells" : "points", file);
    const VtkArray array = file.array(*piece, parent, name);
    if (array.components != components)
      fail(ErrorCode::MalformedFile, file.path(), "array {} has {} components; expected {}", shown(array.name),
           array.components, components);
    ValueArray own = file.read(array, checked_bytes(std::array{count, components}, 1, file.path()), progress);
    if (std::exchange(is_first, false)) {
      all = std::move(own);
      continue;
    }
    if (own.index() != all.index())
      fail(ErrorCode::MalformedFile, file.path(), "array '{}' has the type {} in one piece and {} in another", name,
           type_name(all), type_name(own));
    std::visit(
        [&]<class T>(ValueVector<T>& to) {
          const auto& from = std::get<ValueVector<T>>(own);
          to.insert(to.end(), from.begin(), from.end());
        },
        all);
  }
  return all;
}

}  // namespace tegl::io_detail
