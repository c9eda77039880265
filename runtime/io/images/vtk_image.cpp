// SPDX-License-Identifier: BSD-3-Clause
//
// Makes images of VTK's ImageData and RectilinearGrid, and, on curved grids, of StructuredGrid.
#include "images/vtk_image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/ranges.h>
#include <Eigen/LU>

#include "base/common.hpp"
#include "base/sample_reader.hpp"
#include "vtk/structured.hpp"
#include "vtk/vtk_variables.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

using Sizes = std::array<std::uint64_t, 3>;

/// An open file with the chosen array.
struct OpenVtkImage {
  explicit OpenVtkImage(const fs::path& path, const Progress& progress) : file(path, progress) {
    if (file.type() != "ImageData" && file.type() != "RectilinearGrid" && file.type() != "StructuredGrid")
      fail(ErrorCode::UnsupportedData, path, "holds a mesh ({}); expected an image: ImageData or RectilinearGrid{}",
           shown(file.type()),
           file.type() == "UnstructuredGrid" && lower(path.extension().string()) != ".vtu"
               ? ", or the extension .vtu for this mesh"
               : "");
    all = variables_of(file);
  }

  VtkFile file;
  std::vector<VtkVariable> all;
  VtkVariable variable;
  Sizes sizes{};
  RawGrid grid;
  ImageInfo info;
};

/// Axes of more than one sample first, at least two in all: images of a plane across x or y have two axes, too.
std::array<std::size_t, 3> order_of_axes(const Sizes& sizes) {
  std::array<std::size_t, 3> order = {0, 1, 2};
  std::stable_partition(order.begin(), order.end(), [&](std::size_t a) { return sizes[a] > 1; });
  std::sort(order.begin(), order.begin() + std::max<std::ptrdiff_t>(2, std::count_if(sizes.begin(), sizes.end(),
                                                                                     [](auto n) { return n > 1; })));
  return order;
}

/// The grid of ImageData: sample (i, j, k) lies at origin + direction * (spacing * (i, j, k)).
RawGrid uniform_grid(const OpenVtkImage& image, const std::array<std::size_t, 3>& order) {
  const VtkFile& file = image.file;
  const auto origin = file.numbers(file.data(), "Origin", 3, {0, 0, 0});
  const auto spacing = file.numbers(file.data(), "Spacing", 3, {1, 1, 1});
  const auto direction = file.numbers(file.data(), "Direction", 9, {1, 0, 0, 0, 1, 0, 0, 0, 1});
  const double size = Eigen::Map<const Eigen::Matrix3d>(direction.data()).determinant();
  const bool is_3d = std::ranges::all_of(image.sizes, [](std::uint64_t count) { return count > 1; });
  if (is_3d && !(std::abs(size) > 1e-12))
    fail(ErrorCode::MalformedFile, file.path(), "Direction is '{}', whose determinant is {}; expected three directions",
         fmt::join(direction, " "), size);
  const VtkExtent whole = whole_extent(file);
  const double shift = image.variable.on_cells ? 0.5 : 0.0;
  Eigen::Matrix3d affine;
  Eigen::Vector3d first;
  for (Eigen::Index row = 0; row < 3; ++row)
    for (Eigen::Index column = 0; column < 3; ++column)
      affine(row, column) =
          direction[static_cast<std::size_t>(3 * row + column)] * spacing[static_cast<std::size_t>(column)];
  for (std::size_t a = 0; a < 3; ++a)
    first(static_cast<Eigen::Index>(a)) =
        static_cast<double>(whole.first[a]) + (whole.last[a] > whole.first[a] ? shift : 0.0);
  const Eigen::Vector3d offset = Eigen::Map<const Eigen::Vector3d>(origin.data()) + affine * first;
  // in the order of the axes
  Eigen::MatrixXd ordered(3, 3);
  Eigen::VectorXd ordered_offset(3);
  std::vector<std::size_t> sizes;
  for (std::size_t a = 0; a < 3; ++a) {
    sizes.push_back(static_cast<std::size_t>(image.sizes[order[a]]));
    ordered_offset(static_cast<Eigen::Index>(a)) = offset(static_cast<Eigen::Index>(order[a]));
    for (std::size_t b = 0; b < 3; ++b)
      ordered(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) =
          affine(static_cast<Eigen::Index>(order[a]), static_cast<Eigen::Index>(order[b]));
  }
  return affine_grid(sizes, ordered, ordered_offset, file.path());
}

/// The coordinates of the points along an axis of a RectilinearGrid.
std::vector<double> point_coordinates(const OpenVtkImage& image, std::size_t axis) {
  const VtkFile& file = image.file;
  const VtkExtent whole = whole_extent(file);
  const std::uint64_t count = whole.sizes(false)[axis];
  std::vector<double> all(static_cast<std::size_t>(0));
  std::vector<bool> present;
  for (const XmlElement* const piece : file.pieces()) {
    const VtkExtent extent = read_extent(file, *piece, "Extent");
    const XmlElement* const parent = piece->child("Coordinates");
    const auto arrays = file.arrays(parent);
    if (arrays.size() != 3)
      fail(ErrorCode::MalformedFile, file.path(), "<Coordinates> has {} arrays; expected 3", arrays.size());
    const auto own = file.read_doubles(arrays[axis], extent.sizes(false)[axis]);
    if (extent.first[axis] < whole.first[axis] || extent.last[axis] > whole.last[axis])
      fail(ErrorCode::MalformedFile, file.path(), "a piece from {} to {} along axis {}; expected {} to {} or less",
           extent.first[axis], extent.last[axis], axis, whole.first[axis], whole.last[axis]);
    // Grows with the coordinates that are there, so a false extent costs no memory.
    const auto begin = static_cast<std::size_t>(extent.first[axis] - whole.first[axis]);
    if (begin > all.size())
      fail(ErrorCode::MalformedFile, file.path(), "pieces without the coordinates {} to {} along axis {}", all.size(),
           begin - 1, axis);
    if (begin + own.size() > all.size()) all.resize(begin + own.size());
    std::copy(own.begin(), own.end(), all.begin() + static_cast<std::ptrdiff_t>(begin));
  }
  if (all.size() != count)
    fail(ErrorCode::MalformedFile, file.path(), "{} coordinates along axis {}; expected {}", all.size(), axis, count);
  return all;
}

/// The grid of a RectilinearGrid. Samples of cells are at their middles, and the faces of cells are stored.
RawGrid rectilinear_grid(OpenVtkImage& image, const std::array<std::size_t, 3>& order) {
  RawGrid grid{{}, Eigen::MatrixXd::Identity(3, 3), Eigen::VectorXd::Zero(3), {}};
  for (const std::size_t a : order) {
    std::vector<double> coordinates = point_coordinates(image, a);
    for (const double x : coordinates)
      if (!std::isfinite(x))
        fail(ErrorCode::MalformedFile, image.file.path(), "a coordinate along axis {} is {}; expected finite numbers",
             a, x);
    if (image.variable.on_cells) {
      std::vector<double>& faces = image.info.cell_faces.emplace_back();
      if (coordinates.size() > 1) {
        faces = coordinates;
        coordinates.pop_back();
        for (std::size_t i = 0; i < coordinates.size(); ++i) coordinates[i] = (faces[i] + faces[i + 1]) / 2;
      }
    }
    try {
      grid.axes.push_back(coordinates.size() > 1 ? axis_of(coordinates) : Axis::uniform(1, coordinates.front()));
    } catch (const Error& error) {
      fail(error.code(), image.file.path(), "axis {}: {}", a, error.what());
    }
  }
  return grid;
}

/// Throws UnsupportedData if cells or points are hidden.
void require_no_hidden(const VtkFile& file) {
  for (const bool of_cells : {true, false}) {
    const std::vector<bool> is_hidden = hidden_in_structured(file, of_cells);
    if (const auto count = std::ranges::count(is_hidden, true); count > 0)
      fail(ErrorCode::UnsupportedData, file.path(),
           "a curved grid with hidden cells or points ({} {} by the array 'vtkGhostType'); expected none, or the file "
           "as "
           "a mesh, which leaves hidden cells out",
           count, of_cells ? "cells" : "points");
  }
}

/// The coordinates x, y and z of the points of a StructuredGrid.
std::array<std::vector<double>, 3> coordinates_of_points(const VtkFile& file, const Progress& progress) {
  const VtkArray array = file.array(*file.pieces().front(), "Points", "");
  if (array.components != 3)
    fail(ErrorCode::MalformedFile, file.path(), "points of {} components; expected 3", array.components);
  std::array<std::vector<double>, 3> columns;
  std::visit(
      [&](const auto& numbers) {
        for (std::size_t i = 0; i < numbers.size(); ++i) {
          const auto x = static_cast<double>(numbers[i]);
          if (!std::isfinite(x))
            fail(ErrorCode::MalformedFile, file.path(), "the coordinate {} of point {} is {}; expected finite numbers",
                 "xyz"[i % 3], i / 3, x);
          columns[i % 3].push_back(x);
        }
      },
      read_structured(file, "Points", array.name, 3, false, progress));
  return columns;
}

/// The grid of a StructuredGrid: indices i, j and k, and coordinates x, y and z, of which a plane grid drops the one
/// that is constant.
RawGrid curved_grid(OpenVtkImage& image, const std::array<std::size_t, 3>& order, const Progress& progress) {
  const VtkFile& file = image.file;
  if (image.variable.on_cells)
    fail(ErrorCode::UnsupportedData, file.path(),
         "'{}' has values of cells on a curved grid; expected values of points, or the file read as a mesh",
         image.variable.name);
  const auto dims = std::ranges::count_if(image.sizes, [](auto size) { return size > 1; });
  if (dims < 2)
    fail(ErrorCode::UnsupportedData, file.path(), "a structured grid of {} points; expected at least 2 along two axes",
         fmt::join(image.sizes, " x "));
  auto columns = coordinates_of_points(file, progress);
  require_no_hidden(file);
  std::size_t dropped = 3;
  for (std::size_t c = 0; c < 3 && dims == 2; ++c)
    if (std::ranges::all_of(columns[c], [&](double x) { return x == columns[c].front(); })) dropped = c;
  if (dims == 2 && dropped == 3)
    fail(ErrorCode::UnsupportedData, file.path(),
         "a structured grid of {} points on a curved surface; expected one in a plane where x, y or z is constant",
         fmt::join(image.sizes, " x "));
  RawGrid grid{{}, Eigen::MatrixXd::Identity(3, 3), Eigen::VectorXd::Zero(3), {}};
  for (std::size_t c = 0; c < 3; ++c) {
    grid.axes.push_back(Axis::uniform(static_cast<std::size_t>(image.sizes[order[c]])));
    if (c == dropped) continue;  // below
    CurvedAxis& one = image.info.curved.emplace_back();
    one.axis = static_cast<int>(image.info.curved.size()) - 1;
    one.along = dims == 2 ? 3u : 7u;
    one.values = std::move(columns[c]);
    one.name = std::string(1, "xyz"[c]);
  }
  if (dropped == 3) return grid;
  grid.axes[2] = Axis::uniform(1, columns[dropped].front());
  grid.axes[2].name = std::string(1, "xyz"[dropped]);
  return grid;
}

std::unique_ptr<OpenVtkImage> open_vtk(const fs::path& path, const ReadImageOptions& options) {
  if (!options.fixed.empty())
    fail(ErrorCode::InvalidArgument, path,
         "an index of the dimension '{}' for a file whose dimensions have no names; expected none, or a netCDF file",
         options.fixed[0].dimension);
  auto image = std::make_unique<OpenVtkImage>(path, options.work.progress);
  image->variable = choose_variable(image->file, image->all, options.variable);
  image->sizes = whole_extent(image->file).sizes(image->variable.on_cells);
  const auto order = order_of_axes(image->sizes);
  const bool is_curved = image->file.type() == "StructuredGrid";
  image->grid = is_curved                           ? curved_grid(*image, order, options.work.progress)
                : image->file.type() == "ImageData" ? uniform_grid(*image, order)
                                                    : rectilinear_grid(*image, order);
  for (std::size_t a = 0; a < 3; ++a)
    if (std::string& name = image->grid.axes[a].name; name.empty())
      name = std::string(1, (is_curved ? "ijk" : "xyz")[order[a]]);
  if (const auto time = image->file.time()) {
    image->grid.single.push_back({Axis::uniform(1, *time)});
    image->grid.single.back().axis.name = "t";
  }
  ImageInfo& info = image->info;
  info.format = "VTK";
  info.variable = options.variable.empty() ? image->variable.name : options.variable;
  info.variables = scalar_names(image->all);
  info.stored_type = parse_value_type(image->variable.type);
  info.samples_are_cells = image->variable.on_cells;
  if (std::string remark = image->file.remark_on_extension(); !remark.empty())
    info.remarks.push_back(std::move(remark));
  if (info.samples_are_cells)
    info.remarks.push_back(
        fmt::format("'{}' has values of cells: the samples are at the cells' centres", info.variable));
  drop_trailing_axes(image->grid, info);
  return image;
}

ValueArray read_values(const OpenVtkImage& image, const Progress& progress) {
  const VtkVariable& variable = image.variable;
  return chosen_part(
      read_structured(image.file, variable.parent(), variable.name, variable.components, variable.on_cells, progress),
      variable);
}

/// A reader of the samples in parts, if the file stores them so.
std::shared_ptr<SampleReader> reader_of_parts(const OpenVtkImage& image) {
  const auto pieces = image.file.pieces();
  if (pieces.size() != 1 || image.variable.components != 1) return nullptr;
  const VtkArray array = image.file.array(*pieces.front(), image.variable.parent(), image.variable.name);
  const std::uint64_t count = image.sizes[0] * image.sizes[1] * image.sizes[2];
  const auto place = image.file.place_of_raw(array, count);
  if (!place || read_extent(image.file, *pieces.front(), "Extent") != whole_extent(image.file)) return nullptr;
  StoredSamples samples;
  samples.path = image.file.path();
  samples.offset = *place;
  samples.type = array.type;
  samples.sizes = {count};
  samples.swapped = image.file.is_swapped();
  return std::make_shared<SampleReader>(std::move(samples));
}

}  // namespace

RawImage read_vtk_image(const fs::path& path, Extent extent, const ReadImageOptions& options) {
  const auto image = open_vtk(path, options);
  ValueArray values =
      extent == Extent::whole ? read_values(*image, options.work.progress) : empty_values(image->variable);
  return {std::move(image->grid), std::move(values), std::move(image->info)};
}

RawLayers open_vtk_layers(const fs::path& path, const ReadImageOptions& options) {
  const std::shared_ptr<OpenVtkImage> image = open_vtk(path, options);
  RawLayers layers;
  layers.grid = image->grid;
  layers.info = image->info;
  const std::size_t layer =
      static_cast<std::size_t>(image->sizes[0] * image->sizes[1] * image->sizes[2]) / layers.grid.axes.back().size();
  if (const auto parts = reader_of_parts(*image)) {
    layers.read = [parts, layer](std::size_t first, std::size_t count) {
      return parts->read(first * layer, count * layer, {});
    };
    return layers;
  }
  layers.read = [image, layer, all = std::make_shared<std::optional<ValueArray>>()](std::size_t first,
                                                                                    std::size_t count) {
    if (count == 0) return empty_values(image->variable);
    if (!*all) *all = read_values(*image, {});
    return std::visit(
        [&]<class T>(const ValueVector<T>& values) -> ValueArray {
          const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first * layer);
          return ValueVector<T>(begin, begin + static_cast<std::ptrdiff_t>(count * layer));
        },
        **all);
  };
  return layers;
}

std::vector<ImageVariable> list_vtk_image(const fs::path& path) {
  const OpenVtkImage image(path, {});
  std::vector<ImageVariable> list;
  for (const VtkVariable& variable : image.all) {
    if (variable.components != 1) continue;
    std::vector<std::size_t> sizes;
    for (const std::uint64_t size : whole_extent(image.file).sizes(variable.on_cells))
      if (size > 1) sizes.push_back(static_cast<std::size_t>(size));
    list.push_back({variable.name, std::move(sizes), "", variable.on_cells ? "values of cells" : "", {}});
  }
  return list;
}

}  // namespace tegl::io_detail
