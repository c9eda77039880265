// SPDX-License-Identifier: BSD-3-Clause
//
// Implements read_cell_mesh: chooses the cells to contour, and combines files over time.
#include "tegl/io/cell_meshes.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>

#include "base/common.hpp"
#include "base/raw_image.hpp"
#include "tegl/delaunay.hpp"
#include "tegl/equal_cells.hpp"
#include "vtk/mesh_times.hpp"
#include "vtk/point_table.hpp"
#include "vtk/pvd.hpp"
#include "vtk/vtk_cells.hpp"
#include "vtk/vtk_variables.hpp"

namespace tegl {

namespace fs = std::filesystem;

namespace {

using namespace io_detail;

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// The mesh of one file.
struct FileMesh {
  int dim = 3;                          ///< of the cells
  std::vector<std::string> axis_names;  ///< as many as dimensions
  std::vector<double> points;           ///< #P x dim
  std::vector<CellType> types;
  std::vector<Index> corners;
  std::vector<std::uint64_t> ends;                        ///< of cells in `corners`
  std::vector<Index> face_corners;                        ///< of polyhedra
  std::vector<std::uint64_t> face_ends, face_lists_ends;  ///< as in CellLists
  std::vector<double> values;                             ///< #P
  std::optional<double> time;
  std::string variable;
  std::vector<std::string> remarks;
  std::vector<std::string> doubts;   ///< remarks on values of which one of several is taken, with the file's name
  std::vector<std::size_t> numbers;  ///< of the cells in the file; empty: as here
};

/// Adds the faces of a prism between two polygons.
void add_prism_faces(std::span<const Index> own, std::size_t sides, FileMesh& mesh) {
  const auto end_face = [&] { mesh.face_ends.push_back(mesh.face_corners.size()); };
  for (const std::size_t layer : {std::size_t{0}, sides}) {
    for (std::size_t v = 0; v < sides; ++v) mesh.face_corners.push_back(own[layer + v]);
    end_face();
  }
  for (std::size_t v = 0; v < sides; ++v) {
    const std::size_t next = (v + 1) % sides;
    for (const std::size_t corner : {v, next, sides + next, sides + v}) mesh.face_corners.push_back(own[corner]);
    end_face();
  }
}

/// Adds a cell as one or several of the types of Complex. Throws for other types.
void add_cell(std::uint8_t type, std::span<const Index> own, std::size_t number, FileMesh& mesh, const fs::path& path) {
  const auto add = [&](CellType as, std::span<const Index> corners) {
    for (std::size_t i = 0; i < corners.size(); ++i)
      if (std::find(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(i), corners[i]) !=
          corners.begin() + static_cast<std::ptrdiff_t>(i))
        fail(ErrorCode::UnsupportedData, path, "cell {} ({}) has the corner {} twice; expected different corners",
             number, name_of_type(type), corners[i]);
    mesh.types.push_back(as);
    mesh.corners.insert(mesh.corners.end(), corners.begin(), corners.end());
    mesh.ends.push_back(mesh.corners.size());
    mesh.face_lists_ends.push_back(mesh.face_ends.size());
  };
  constexpr std::uint8_t kStrip = 6, kPolygon = 7, kPentagonalPrism = 15, kHexagonalPrism = 16;
  constexpr std::size_t kMostCorners = 32;  // of polygons, whose prisms over time then have 64
  if (type == kStrip) {
    for (std::size_t i = 0; i + 3 <= own.size(); ++i) add(CellType::triangle, own.subspan(i, 3));
  } else if (type == kPolygon && own.size() == 4) {
    add(CellType::quadrilateral, own);
  } else if (type == kPolygon && own.size() >= 5 && own.size() <= kMostCorners) {
    add(CellType::polygon, own);
  } else if (type == kPentagonalPrism || type == kHexagonalPrism) {
    const std::size_t sides = type == kPentagonalPrism ? 5 : 6;
    if (own.size() != 2 * sides)
      fail(ErrorCode::MalformedFile, path, "cell {} ({}) has {} corners; expected {}", number, name_of_type(type),
           own.size(), 2 * sides);
    add_prism_faces(own, sides, mesh);
    add(CellType::polyhedron, own);
  } else if (type == kPolygon && own.size() >= 3) {
    for (std::size_t i = 1; i + 1 < own.size(); ++i) add(CellType::triangle, std::array{own[0], own[i], own[i + 1]});
  } else if (name_of(static_cast<CellType>(type)) == "unknown" || type >= 100) {
    fail(ErrorCode::UnsupportedData, path, "cell {} is a {} (VTK's type {}) of {} corners; expected {}", number,
         name_of_type(type), type, own.size(),
         mesh.dim == 2 ? "triangles, quadrilaterals, pixels, strips of triangles and polygons"
                       : "tetrahedra, hexahedra, voxels, wedges, pyramids, prisms and polyhedra");
  } else if (type == static_cast<std::uint8_t>(CellType::polyhedron)) {
    add(CellType::polyhedron, own);
  } else {
    if (own.size() != corner_count(static_cast<CellType>(type)))
      fail(ErrorCode::MalformedFile, path, "cell {} ({}) has {} corners; expected {}", number, name_of_type(type),
           own.size(), corner_count(static_cast<CellType>(type)));
    add(static_cast<CellType>(type), own);
  }
}

/// Keeps the cells of the largest dimension; `kept` gets their numbers.
void add_cells(const StoredCells& stored, FileMesh& mesh, std::vector<std::size_t>& kept, const fs::path& path) {
  mesh.dim = 0;
  for (std::size_t c = 0; c < stored.types.size(); ++c) {
    const int dim = dimension_of(stored.types[c]);
    if (dim < 0)
      fail(ErrorCode::UnsupportedData, path, "cell {} has VTK's type {}, which is unknown", c, stored.types[c]);
    mesh.dim = std::max(mesh.dim, dim);
  }
  if (mesh.dim < 2)
    fail(ErrorCode::UnsupportedData, path, "{} cells, none of 2 or 3 dimensions; expected cells with a contour",
         stored.types.size());
  std::size_t others = 0, hidden = 0;
  std::vector<Index> own;
  for (std::size_t c = 0; c < stored.types.size(); ++c) {
    if (dimension_of(stored.types[c]) != mesh.dim) {
      ++others;
      continue;
    }
    if (!stored.is_hidden.empty() && stored.is_hidden[c]) {
      ++hidden;
      continue;
    }
    own.clear();
    const auto point_of = [&](std::int64_t stored_corner) {
      const auto corner = static_cast<Index>(stored_corner);
      return stored.same_point.empty() ? corner : stored.same_point[corner];
    };
    for (std::uint64_t i = c == 0 ? 0 : stored.ends[c - 1]; i < stored.ends[c]; ++i)
      own.push_back(point_of(stored.corners[static_cast<std::size_t>(i)]));
    if (!stored.face_lists_ends.empty())
      for (std::uint64_t f = c == 0 ? 0 : stored.face_lists_ends[c - 1]; f < stored.face_lists_ends[c]; ++f) {
        for (std::uint64_t i = f == 0 ? 0 : stored.face_ends[f - 1]; i < stored.face_ends[f]; ++i)
          mesh.face_corners.push_back(point_of(stored.face_corners[static_cast<std::size_t>(i)]));
        mesh.face_ends.push_back(mesh.face_corners.size());
      }
    const std::size_t before = mesh.types.size();
    add_cell(stored.types[c], own, c, mesh, path);
    if (mesh.numbers.empty() && c + 1 != mesh.types.size()) {  // the first cell with another number than in the file
      mesh.numbers.resize(before);
      std::iota(mesh.numbers.begin(), mesh.numbers.end(), std::size_t{0});
    }
    if (!mesh.numbers.empty() || c + 1 != mesh.types.size()) mesh.numbers.resize(mesh.types.size(), c);
    kept.push_back(c);
  }
  if (std::none_of(mesh.types.begin(), mesh.types.end(),
                   [](CellType type) { return type == CellType::polygon || type == CellType::polyhedron; })) {
    mesh.ends.clear();
    mesh.face_lists_ends.clear();
  }
  if (others > 0)
    mesh.remarks.push_back(fmt::format("cells of fewer than {} dimensions are left out: {}", mesh.dim, others));
  if (hidden > 0) mesh.remarks.push_back(fmt::format("cells hidden by vtkGhostType are left out: {}", hidden));
}

/// The mean, at each point, of the values of the cells that have it.
std::vector<double> means_at_points(const std::vector<double>& of_cells, const StoredCells& stored,
                                    const std::vector<std::size_t>& kept) {
  std::vector<double> sums(static_cast<std::size_t>(stored.point_count()), 0.0);
  std::vector<std::uint32_t> counts(sums.size(), 0);
  for (const std::size_t c : kept)
    for (std::uint64_t i = c == 0 ? 0 : stored.ends[c - 1]; i < stored.ends[c]; ++i) {
      const auto corner = static_cast<std::size_t>(stored.corners[static_cast<std::size_t>(i)]);
      const std::size_t point = stored.same_point.empty() ? corner : stored.same_point[corner];
      sums[point] += of_cells[c];
      ++counts[point];
    }
  for (std::size_t p = 0; p < sums.size(); ++p) sums[p] = counts[p] == 0 ? kMissing : sums[p] / counts[p];
  return sums;
}

/// Keeps the coordinates of a 3D mesh, or two of a 2D mesh in a plane across the third, of #P x 3 `points`.
void set_points(const std::vector<double>& points, FileMesh& mesh, const fs::path& path) {
  std::vector<std::size_t> axes = {0, 1, 2};
  if (mesh.dim == 2) {
    std::array<double, 3> least{}, most{};
    least.fill(std::numeric_limits<double>::infinity());
    most.fill(-std::numeric_limits<double>::infinity());
    for (const Index corner : mesh.corners)
      for (std::size_t a = 0; a < 3; ++a) {
        const double x = points[3 * std::size_t{corner} + a];
        least[a] = std::min(least[a], x);
        most[a] = std::max(most[a], x);
      }
    std::size_t across = 3;
    while (across > 0 && most[across - 1] > least[across - 1]) --across;
    if (across == 0)
      fail(ErrorCode::UnsupportedData, path,
           "cells of 2 dimensions on a surface in space (x from {} to {}, y from {} to {}, z from {} to {}); expected "
           "them in a plane where x, y or z is constant",
           least[0], most[0], least[1], most[1], least[2], most[2]);
    axes.erase(axes.begin() + static_cast<std::ptrdiff_t>(across - 1));
  }
  for (const std::size_t a : axes) mesh.axis_names.emplace_back(1, "xyz"[a]);
  for (std::size_t p = 0; p < points.size(); p += 3)
    for (const std::size_t a : axes) mesh.points.push_back(points[p + a]);
}

/// Makes a complex of the cells if there are polyhedra, whose faces it checks, so that an error has the file and the
/// number that the cell has there. `kept`: these numbers.
void check_polyhedra(const FileMesh& mesh, const std::vector<std::size_t>& kept, const fs::path& path) {
  if (std::find(mesh.types.begin(), mesh.types.end(), CellType::polyhedron) == mesh.types.end()) return;
  std::vector<std::array<double, 3>> anywhere(mesh.points.size() / 3);
  try {
    (void)Complex<3>(std::move(anywhere),
                     {mesh.types, mesh.corners, mesh.ends, mesh.face_corners, mesh.face_ends, mesh.face_lists_ends});
  } catch (const Error& error) {
    const std::string_view what = error.what(), prefix = "cell ";
    if (!what.starts_with(prefix)) fail(error.code(), path, "{}", what);
    std::size_t cell = 0;
    const char* const end = std::from_chars(what.data() + prefix.size(), what.data() + what.size(), cell).ptr;
    fail(ErrorCode::UnsupportedData, path, "cell {}{}", kept[cell], end);
  }
}

/// Two equal cells of a mesh, as text with their numbers in the file; empty if there are none.
std::string equal_cells_of(const FileMesh& mesh, const StoredCells& stored) {
  CellLists lists{mesh.types, mesh.corners};
  if (!mesh.ends.empty())
    lists = {mesh.types, mesh.corners, mesh.ends, mesh.face_corners, mesh.face_ends, mesh.face_lists_ends};
  const auto equal = find_equal_cells(lists);
  if (!equal) return {};
  const auto number_of = [&](std::size_t cell) { return mesh.numbers.empty() ? cell : mesh.numbers[cell]; };
  const std::size_t first = number_of(equal->first), second = number_of(equal->second);
  const auto piece_of = [&](std::size_t cell) {
    return std::ranges::upper_bound(stored.piece_ends, cell) - stored.piece_ends.begin();
  };
  const std::string what = fmt::format("cell {} has the same corners as cell {}", second, first);
  if (piece_of(first) == piece_of(second)) return what + "; expected each cell once";
  return fmt::format(
      "{}: the pieces {} and {} (of {}) repeat cells; expected other cells in each piece, or copies marked "
      "by 'vtkGhostType'",
      what, piece_of(first), piece_of(second), stored.piece_ends.size());
}

template <int N>
std::vector<Index> delaunay_of(const std::vector<double>& coordinates) {
  std::vector<std::array<double, N>> points(coordinates.size() / N);
  for (std::size_t i = 0; i < coordinates.size(); ++i) points[i / N][i % N] = coordinates[i];
  return delaunay_corners<N>(points);
}

void refuse_values_of_points(const fs::path& path, const std::string& variable, const CellMeshOptions& options) {
  if (options.cells_to_points)
    fail(ErrorCode::InvalidArgument, path,
         "'{}' has values of points; expected values of cells for cells_to_points (--cells-to-points)", variable);
}

/// The Delaunay triangulation of a table's points.
FileMesh read_table(const fs::path& path, const CellMeshOptions& options, const Progress& progress) {
  PointTable table = read_point_table(path, options.variable, progress);
  const std::size_t column = choose_column(table, options.variable, path);
  refuse_values_of_points(path, table.value_names[column], options);
  FileMesh mesh;
  mesh.dim = static_cast<int>(table.dim());
  mesh.values = table.column(column);
  mesh.variable = table.value_names[column];
  mesh.axis_names = std::move(table.axis_names);
  mesh.points = std::move(table.coordinates);
  try {
    mesh.corners = mesh.dim == 2   ? delaunay_of<2>(mesh.points)
                   : mesh.dim == 3 ? delaunay_of<3>(mesh.points)
                                   : delaunay_of<4>(mesh.points);
  } catch (const Error& error) {
    const bool is_of_points = error.code() == ErrorCode::InvalidArgument;  // in a line, too near to each other
    fail(is_of_points ? ErrorCode::MalformedFile : error.code(), path, "{}", error.what());
  }
  constexpr std::array kTypes = {CellType::triangle, CellType::tetrahedron, CellType::simplex4};
  mesh.types.assign(mesh.corners.size() / static_cast<std::size_t>(mesh.dim + 1),
                    kTypes[static_cast<std::size_t>(mesh.dim - 2)]);
  return mesh;
}

/// Adds a remark if points of several pieces at one place have different values, of which the first is taken.
void note_differing_values(const StoredCells& stored, FileMesh& mesh, const std::string& name, const fs::path& path) {
  std::size_t differing = 0, one = 0;
  for (std::size_t p = 0; p < stored.same_point.size(); ++p) {
    const double value = mesh.values[p], taken = mesh.values[stored.same_point[p]];
    if (value == taken || (std::isnan(value) && std::isnan(taken))) continue;
    if (differing++ == 0) one = p;
  }
  if (differing == 0) return;
  mesh.doubts.push_back(fmt::format(
      "{}: '{}' has different values at {} point{} that pieces have in common, such as {} and {} at ({}, {}, {}); the "
      "value of the first piece is taken",
      path.string(), name, differing, differing == 1 ? "" : "s", mesh.values[stored.same_point[one]], mesh.values[one],
      stored.points[3 * one], stored.points[3 * one + 1], stored.points[3 * one + 2]));
}

FileMesh read_vtk(const fs::path& path, const CellMeshOptions& options, const Progress& progress) {
  require_readable_file(path);
  const VtkFile file(path, progress);
  FileMesh mesh;
  const StoredCells stored = read_cells(file, progress);
  const VtkVariable variable = choose_variable(file, variables_of(file), options.variable);
  if (variable.on_cells && !options.cells_to_points)
    fail(ErrorCode::UnsupportedData, path,
         "array '{}' has values of cells; expected values of points, or the option to make point values of them by the "
         "mean of the cells at each point: cells_to_points (--cells-to-points)",
         variable.name);
  if (!variable.on_cells) refuse_values_of_points(path, variable.name, options);
  std::vector<std::size_t> kept;
  if (std::string remark = file.remark_on_extension(); !remark.empty()) mesh.remarks.push_back(std::move(remark));
  add_cells(stored, mesh, kept, path);
  const ValueArray values =
      chosen_part(read_cell_values(file, variable.parent(), variable.name, variable.components, progress), variable);
  mesh.values = std::visit([](const auto& all) { return std::vector<double>(all.begin(), all.end()); }, values);
  for (const VtkVariable& one : repeated_variables(file))
    if (one.name == variable.name && one.on_cells == variable.on_cells)
      mesh.doubts.push_back(remark_on_repeated(one, path));
  if (!variable.on_cells) note_differing_values(stored, mesh, variable.name, path);
  if (variable.on_cells) mesh.values = means_at_points(mesh.values, stored, kept);
  set_points(stored.points, mesh, path);
  check_polyhedra(mesh, kept, path);
  if (const std::string equal = equal_cells_of(mesh, stored); !equal.empty())
    fail(ErrorCode::UnsupportedData, path, "{}", equal);
  mesh.time = file.time();
  mesh.variable = options.variable.empty() ? variable.name : options.variable;
  return mesh;
}

FileMesh read_file(const fs::path& path, const CellMeshOptions& options, const Progress& progress) {
  return is_point_table(path) ? read_table(path, options, progress) : read_vtk(path, options, progress);
}

/// The first cell that differs from that of another mesh with as many cells and points, as text.
std::string first_other_cell(const FileMesh& one, const FileMesh& first) {
  const auto number_of = [&](std::size_t c) { return one.numbers.empty() ? c : one.numbers[c]; };
  const auto ends_at = [](const std::vector<std::uint64_t>& ends, std::size_t i) { return i == 0 ? 0 : ends[i - 1]; };
  const auto part = [&](const std::vector<Index>& list, std::uint64_t begin, std::uint64_t end) {
    return std::span(list).subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin));
  };
  std::uint64_t begin = 0;
  for (std::size_t c = 0; c < one.types.size(); ++c) {
    if (one.types[c] != first.types[c])
      return fmt::format("cell {} is a {}, and a {} there", number_of(c), name_of(one.types[c]),
                         name_of(first.types[c]));
    const std::uint64_t end = one.ends.empty() ? begin + corner_count(one.types[c]) : one.ends[c];
    const std::uint64_t other_end = first.ends.empty() ? begin + corner_count(first.types[c]) : first.ends[c];
    const auto own = part(one.corners, begin, end), other = part(first.corners, begin, other_end);
    if (!std::ranges::equal(own, other))
      return fmt::format("cell {} ({}) has the points {}, and {} there", number_of(c), name_of(one.types[c]),
                         fmt::join(own, ", "), fmt::join(other, ", "));
    begin = end;
    if (one.face_lists_ends.empty() || first.face_lists_ends.empty()) continue;
    bool are_equal = one.face_lists_ends[c] == first.face_lists_ends[c];
    for (std::uint64_t f = ends_at(one.face_lists_ends, c); are_equal && f < one.face_lists_ends[c]; ++f) {
      const auto face = static_cast<std::size_t>(f);
      const std::uint64_t start = ends_at(one.face_ends, face);
      are_equal = one.face_ends[face] == first.face_ends[face] &&
                  std::ranges::equal(part(one.face_corners, start, one.face_ends[face]),
                                     part(first.face_corners, start, one.face_ends[face]));
    }
    if (!are_equal) return fmt::format("cell {} ({}) has other faces", number_of(c), name_of(one.types[c]));
  }
  return "polyhedra have other faces";
}

/// How the cells of a mesh differ from those of another, as text; empty if they are equal.
std::string difference_of_cells(const FileMesh& one, const FileMesh& first) {
  if (one.dim != first.dim) return fmt::format("they are of {} dimensions, {} there", one.dim, first.dim);
  if (one.types.size() != first.types.size() || one.points.size() != first.points.size())
    return fmt::format("{} cells and {} points, {} and {} there", one.types.size(),
                       one.points.size() / static_cast<std::size_t>(one.dim), first.types.size(),
                       first.points.size() / static_cast<std::size_t>(first.dim));
  if (one.types == first.types && one.corners == first.corners && one.ends == first.ends &&
      one.face_corners == first.face_corners && one.face_ends == first.face_ends &&
      one.face_lists_ends == first.face_lists_ends)
    return {};
  return first_other_cell(one, first);
}

template <int N>
Complex<N> complex_of(const CellMesh& mesh, std::vector<std::array<double, N>> points) {
  if (mesh.ends.empty()) return Complex<N>(std::move(points), mesh.types, mesh.corners);
  return Complex<N>(std::move(points), CellLists{mesh.types, mesh.corners, mesh.ends, mesh.face_corners, mesh.face_ends,
                                                 mesh.face_lists_ends});
}

template <int N>
AnyComplex complex_of(const CellMesh& mesh) {
  std::vector<std::array<double, N>> points(mesh.points.size() / N);
  for (std::size_t i = 0; i < mesh.points.size(); ++i) points[i / N][i % N] = mesh.points[i];
  if (mesh.times.size() < 2) {
    Complex<N> complex = complex_of<N>(mesh, std::move(points));
    complex.set_values(mesh.values);
    return complex;
  }
  if constexpr (N < 4) {
    const std::size_t count = mesh.values.size() / mesh.times.size();
    std::vector<std::array<double, N>> first(
        points.begin(), points.begin() + static_cast<std::ptrdiff_t>(std::min(count, points.size())));
    const Complex<N> complex = complex_of<N>(mesh, std::move(first));
    const std::span<const std::array<double, N>> moving(points);
    return in_time<N>(complex, mesh.times, mesh.values, mesh.points_move ? moving : moving.first(0));
  } else {
    throw Error(ErrorCode::UnsupportedData, "a 4D mesh at several times; expected one in 2 or 3 dimensions");
  }
}

}  // namespace

bool is_cell_mesh_file(const fs::path& path, bool allow_outside_paths) {
  const auto is_mesh = [](const fs::path& file) {
    const std::string name = lower_name(file);
    return name.ends_with(".vtu") || name.ends_with(".vts") || is_point_table(file);
  };
  return is_pvd(path) ? is_mesh(read_pvd(path, allow_outside_paths).front().file) : is_mesh(path);
}

CellMesh read_cell_mesh(std::span<const fs::path> given, const CellMeshOptions& given_options) {
  if (given.empty()) throw Error(ErrorCode::InvalidArgument, "no files; expected at least one");
  CellMeshOptions options = given_options;
  CellMesh mesh;
  mesh.files.assign(given.begin(), given.end());
  fs::path collection;  // that the times are from
  if (given.size() == 1 && is_pvd(given[0])) {
    std::vector<double> times;
    mesh.files.clear();
    for (PvdStep& step : read_pvd(given[0], options.allow_outside_paths)) {
      mesh.files.push_back(std::move(step.file));
      times.push_back(step.time);
    }
    if (options.times.empty() && !options.time_step && times.size() > 1) {
      options.times = std::move(times);
      collection = given[0];
    }
  }
  sort_files(options, mesh.files);
  std::vector<std::optional<double>> own_times;
  FileMesh first;
  for (std::size_t i = 0; i < mesh.files.size(); ++i) {
    const fs::path& path = mesh.files[i];
    const auto of_all = [&](double fraction) {
      return options.work.progress((static_cast<double>(i) + fraction) / static_cast<double>(mesh.files.size()));
    };
    FileMesh one = read_file(path, options, options.work.progress ? Progress(of_all) : Progress());
    own_times.push_back(one.time);
    if (mesh.remarks.empty()) mesh.remarks = std::move(one.doubts);  // of the first file that has any
    if (i == 0) {
      first = std::move(one);
      mesh.points = first.points;
      mesh.values = first.values;
      continue;
    }
    if (const std::string difference = difference_of_cells(one, first); !difference.empty())
      fail(ErrorCode::UnsupportedData, path, "has other cells than {}: {}; expected the same cells at all times",
           mesh.files[0].string(), difference);
    if (one.axis_names != first.axis_names)
      fail(ErrorCode::UnsupportedData, path, "has the axes {}, not {} as {}; expected the same",
           fmt::join(one.axis_names, ", "), fmt::join(first.axis_names, ", "), mesh.files[0].string());
    if (one.dim == 4)
      fail(ErrorCode::UnsupportedData, path, "has 4 axes and is one of several files; expected one file");
    if (one.points != first.points && !mesh.points_move) {
      mesh.points_move = true;
      const std::vector<double> still = mesh.points;
      for (std::size_t k = 1; k < i; ++k) mesh.points.insert(mesh.points.end(), still.begin(), still.end());
    }
    if (mesh.points_move) mesh.points.insert(mesh.points.end(), one.points.begin(), one.points.end());
    mesh.values.insert(mesh.values.end(), one.values.begin(), one.values.end());
  }
  mesh.dim = first.dim;
  mesh.types = std::move(first.types);
  mesh.corners = std::move(first.corners);
  mesh.ends = std::move(first.ends);
  mesh.face_corners = std::move(first.face_corners);
  mesh.face_ends = std::move(first.face_ends);
  mesh.face_lists_ends = std::move(first.face_lists_ends);
  mesh.variable = std::move(first.variable);
  mesh.remarks.insert(mesh.remarks.begin(), first.remarks.begin(), first.remarks.end());
  mesh.axis_names = std::move(first.axis_names);
  sort_by_own_times(options, own_times, mesh);
  mesh.times = times_of(own_times, options, mesh.files, collection);
  return mesh;
}

AnyComplex to_complex(const CellMesh& mesh) {
  if (mesh.dim == 4) return complex_of<4>(mesh);
  return mesh.dim == 2 ? complex_of<2>(mesh) : complex_of<3>(mesh);
}

namespace {

/// Adds the smallest and the largest value, and the number of missing ones.
template <class Values>
void add_range(const Values& values, CellMeshArray& array) {
  array.min = array.max = kMissing;
  for (const auto value : values) {
    const auto number = static_cast<double>(value);
    array.missing += std::isnan(number) ? 1 : 0;
    array.min = std::fmin(array.min, number);
    array.max = std::fmax(array.max, number);
  }
}

/// The smallest and the largest coordinate along each axis.
std::vector<std::array<double, 2>> bounds_of(const std::vector<double>& points, std::size_t dim) {
  std::vector<std::array<double, 2>> bounds(dim, {kMissing, kMissing});
  for (std::size_t i = 0; i < points.size(); ++i)
    bounds[i % dim] = {std::fmin(bounds[i % dim][0], points[i]), std::fmax(bounds[i % dim][1], points[i])};
  return bounds;
}

/// A remark on two equal cells; empty if there are none, or if cells are of types that have no contour.
std::string remark_on_equal_cells(const StoredCells& stored, const fs::path& path) {
  FileMesh mesh;
  std::vector<std::size_t> kept;
  try {
    add_cells(stored, mesh, kept, path);
  } catch (const Error&) {
    return {};  // the types are listed
  }
  const std::string equal = equal_cells_of(mesh, stored);
  return equal.empty() ? equal : fmt::format("{}: {}", path.string(), equal);
}

CellMeshInfo describe_table(const fs::path& path, const CellMeshOptions& options) {
  const PointTable table = read_point_table(path, options.variable, options.work.progress);
  CellMeshInfo info;
  info.type = "table of points";
  info.points = table.lines.size();
  info.axis_names = table.axis_names;
  info.bounds = bounds_of(table.coordinates, table.dim());
  for (std::size_t c = 0; c < table.value_names.size(); ++c) {
    info.arrays.push_back({.name = table.value_names[c], .type = "double"});
    add_range(table.column(c), info.arrays.back());
  }
  return info;
}

}  // namespace

CellMeshInfo describe_cell_mesh(const fs::path& given, const CellMeshOptions& options) {
  if (is_point_table(given)) return describe_table(given, options);
  CellMeshInfo info;
  fs::path path = given;
  if (is_pvd(given)) {
    const auto steps = read_pvd(given, options.allow_outside_paths);
    for (const PvdStep& step : steps) info.times.push_back(step.time);
    path = steps.front().file;
  }
  require_readable_file(path);
  const VtkFile file(path, options.work.progress);
  const StoredCells stored = read_cells(file, options.work.progress);
  info.type = file.type();
  if (std::string remark = file.remark_on_extension(); !remark.empty()) info.remarks.push_back(std::move(remark));
  if (std::string remark = remark_on_equal_cells(stored, path); !remark.empty())
    info.remarks.push_back(std::move(remark));
  info.points = stored.point_count();
  std::map<std::uint8_t, std::uint64_t> counts;
  for (const std::uint8_t type : stored.types) ++counts[type];
  for (const auto& [type, count] : counts) info.cells.emplace_back(name_of_type(type), count);
  info.axis_names = {"x", "y", "z"};
  info.bounds = bounds_of(stored.points, 3);
  for (const VtkVariable& one : repeated_variables(file)) info.remarks.push_back(remark_on_repeated(one, path));
  for (const VtkVariable& variable : variables_of(file)) {
    constexpr std::uint64_t kMost = std::numeric_limits<int>::max();
    info.arrays.push_back({.name = variable.name,
                           .on_cells = variable.on_cells,
                           .components = static_cast<int>(std::min(variable.components, kMost)),
                           .type = std::string(variable.type)});
    std::visit([&](const auto& values) { add_range(values, info.arrays.back()); },
               read_cell_values(file, variable.parent(), variable.name, variable.components, options.work.progress));
  }
  return info;
}

}  // namespace tegl
