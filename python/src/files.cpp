// SPDX-License-Identifier: BSD-3-Clause
//
// Image and contour files for Python.
#include <fmt/format.h>

#include "binding.hpp"
#include "docs.hpp"
#include "io/images/series_request.hpp"
#include "points.hpp"
#include "tegl/io/cell_meshes.hpp"
#include "tegl/io/images.hpp"
#include "tegl/io/meshes.hpp"
#include "tegl/io/series.hpp"

namespace tegl::python {

namespace {

template <int N>
void put_grid(py::dict& result, const Grid<N>& grid) {
  py::list axes;
  py::list names;
  py::list units;
  for (const Axis& axis : grid.axes) {
    if (axis.is_uniform()) {
      axes.append(py::make_tuple(axis.origin(), axis.step()));
    } else {
      std::vector<double> coordinates;
      for (std::size_t i = 0; i < axis.size(); ++i) coordinates.push_back(axis[i]);
      axes.append(py::cast(coordinates));
    }
    names.append(axis.name);
    units.append(axis.unit);
  }
  result["axes"] = axes;
  result["names"] = names;
  result["units"] = units;
  result["affine"] = py::none();
  if (!grid.has_world_map()) return;
  std::vector<std::vector<double>> affine;
  for (int row = 0; row < N; ++row) {
    std::vector<double> numbers;
    for (int column = 0; column < N; ++column) numbers.push_back(grid.linear[row][column]);
    numbers.push_back(grid.offset[row]);
    affine.push_back(std::move(numbers));
  }
  result["affine"] = py::cast(affine);
}

template <class T, int N>
void put_image(py::dict& result, OwnedImage<T, N>& image) {
  put_grid(result, image.grid);
  result["array"] = owned_samples(std::move(image));
}

/// The name of the argument that selects one of several variables or series, for the error message of a missing choice.
const char* choosing_argument(const std::vector<std::filesystem::path>& files) {
  return std::filesystem::is_directory(files.front()) || are_dicom_files(files) ? "series=" : "variable=";
}

constexpr SeriesWords kWords{"times", "time_step", "time_unit", "sort", "sort='time'", "sort='name'", "sort='given'"};

std::variant<ReadSeriesResult, ReadSeries5dResult> read_with_hint(const std::vector<std::filesystem::path>& files,
                                                                  const SeriesOptions& options) {
  try {
    return read_series_to_5d(files, options);
  } catch (const Error& error) {
    if (const std::string hint = series_hint(error, options, kWords); !hint.empty())
      throw Error(error.code(), error.what() + hint);
    if (error.code() != ErrorCode::VariableNotFound || !options.variable.empty()) throw;
    throw Error(error.code(), fmt::format("{} (choose it with {})", error.what(), choosing_argument(files)));
  }
}

py::list directions_of(const ImageInfo& info) {
  py::list result;
  for (const AxisDirection direction : info.axis_directions)
    result.append(direction == AxisDirection::up ? "up" : direction == AxisDirection::down ? "down" : "unknown");
  return result;
}

/// Remarks become warnings of the caller.
void warn_of(const std::vector<std::string>& remarks) {
  for (const std::string& remark : remarks)
    if (PyErr_WarnEx(PyExc_UserWarning, remark.c_str(), 2) != 0) throw py::error_already_set();
}

py::dict read_any(const std::vector<std::string>& paths, const std::string& variable,
                  const std::optional<std::vector<double>>& times, std::optional<double> time_step,
                  const std::optional<std::string>& time_unit, const std::optional<std::string>& sort,
                  const std::vector<std::pair<std::string, std::size_t>>& fixed, bool allow_outside_paths,
                  bool separate_process, const py::object& progress) {
  Call call(progress);
  const std::vector<std::filesystem::path> files(paths.begin(), paths.end());
  SeriesRequest request{variable, times, time_step, time_unit, {}, {}, {}, false};
  if (sort)
    request.sort = named<SeriesOrder>(
        "sort", *sort,
        {{"given", SeriesOrder::given}, {"name", SeriesOrder::by_name}, {"time", SeriesOrder::coordinate}});
  for (const auto& [dimension, index] : fixed) request.fixed.push_back({dimension, index});
  request.allow_outside_paths = allow_outside_paths;
  const Progress tell = call.progress();
  auto any = call.run([&] {
    const FileLock lock(tell);
    SeriesOptions options = series_options(files, request, kWords);
    options.work.progress = tell;
    options.separate_process = separate_process;
    return read_with_hint(files, options);
  });
  const ImageInfo& info = std::visit([](auto& read) -> const ImageInfo& { return read.info; }, any);
  warn_of(info.remarks);
  py::dict result;
  const auto put_one = [&](auto& image) { put_image(result, image); };
  if (auto* const read = std::get_if<ReadSeries5dResult>(&any))
    std::visit(put_one, read->image);
  else
    std::visit([&](auto& images) { std::visit(put_one, images); }, std::get<ReadSeriesResult>(any).image);
  put(result, "format", info.format);
  put(result, "variable", info.variable);
  put(result, "variables", info.variables);
  put(result, "value_unit", info.value_unit);
  put(result, "value_name", info.value_name);
  put(result, "world_frame", info.world_frame);
  result["axis_directions"] = directions_of(info);
  result["samples_are_cells"] = info.samples_are_cells;
  result["lattice"] = info.lattice ? py::object(py::str(std::string(name_of(*info.lattice)))) : py::object(py::none());
  result["cell_faces"] = py::cast(info.cell_faces);
  py::list curved;
  for (const CurvedAxis& one : info.curved)
    curved.append(py::make_tuple(one.axis, one.along, coordinates_of(one), one.name, one.unit));
  result["curved"] = curved;
  return result;
}

/// An array of the library's memory.
template <class T>
py::array owned_array(std::vector<T>&& values, const std::vector<py::ssize_t>& shape) {
  auto kept = std::make_unique<std::vector<T>>(std::move(values));
  const T* const data = kept->data();
  const py::capsule owner(kept.release(), [](void* memory) { delete static_cast<std::vector<T>*>(memory); });
  return py::array(py::dtype::of<T>(), shape, data, owner);
}

/// The same for a list.
template <class T>
py::array owned_list(std::vector<T>&& values) {
  const auto size = static_cast<py::ssize_t>(values.size());
  return owned_array(std::move(values), {size});
}

py::dict read_mesh_of_cells(const std::vector<std::string>& paths, const std::string& variable, bool cells_to_points,
                            const std::vector<double>& times, bool allow_outside_paths, const py::object& progress) {
  Call call(progress);
  const std::vector<std::filesystem::path> files(paths.begin(), paths.end());
  CellMeshOptions options;
  options.variable = variable;
  options.cells_to_points = cells_to_points;
  options.times = times;
  options.allow_outside_paths = allow_outside_paths;
  options.work.progress = call.progress();
  CellMesh mesh = call.run([&] { return read_cell_mesh(files, options); });
  warn_of(mesh.remarks);
  const auto dim = static_cast<py::ssize_t>(mesh.dim);
  const auto steps = static_cast<py::ssize_t>(mesh.times.size());
  const auto layers = static_cast<py::ssize_t>(std::max<std::size_t>(1, mesh.times.size()));
  const auto count = static_cast<py::ssize_t>(mesh.values.size()) / layers;
  std::vector<std::uint8_t> types;
  for (const CellType type : mesh.types) types.push_back(static_cast<std::uint8_t>(type));
  const auto cells = static_cast<py::ssize_t>(types.size()), corners = static_cast<py::ssize_t>(mesh.corners.size());
  py::dict result;
  result["points"] = mesh.points_move ? owned_array(std::move(mesh.points), {steps, count, dim})
                                      : owned_array(std::move(mesh.points), {count, dim});
  result["types"] = owned_array(std::move(types), {cells});
  result["corners"] = owned_array(std::move(mesh.corners), {corners});
  result["ends"] = owned_list(std::move(mesh.ends));
  result["face_corners"] = owned_list(std::move(mesh.face_corners));
  result["face_ends"] = owned_list(std::move(mesh.face_ends));
  result["face_lists_ends"] = owned_list(std::move(mesh.face_lists_ends));
  result["values"] =
      steps > 0 ? owned_array(std::move(mesh.values), {steps, count}) : owned_array(std::move(mesh.values), {count});
  result["times"] = owned_array(std::move(mesh.times), {steps});
  put(result, "variable", mesh.variable);
  put(result, "axis_names", mesh.axis_names);
  return result;
}

void write_any(const AnyContour& contour, const std::string& path, const py::object& progress) {
  Call call(progress);
  const Progress tell = call.progress();
  call.run([&] {
    MeshView mesh = std::visit([](const auto& c) { return MeshView(c); }, contour.contour);
    mesh.isovalue = contour.isovalue;
    const FileLock lock(tell);
    write_mesh(mesh, path, {.work = {.progress = tell}});
  });
}

std::unique_ptr<AnyContour> load_any(const std::string& path, bool allow_outside_paths, bool separate_process,
                                     const py::object& progress) {
  Call call(progress);
  const Progress tell = call.progress();
  Mesh mesh = call.run([&] {
    const FileLock lock(tell);
    ReadMeshOptions options;
    options.work.progress = tell;
    options.allow_outside_paths = allow_outside_paths;
    options.separate_process = separate_process;
    return read_mesh(path, options);
  });
  const py::gil_scoped_release release;
  auto result = std::make_unique<AnyContour>();
  result->isovalue = mesh.isovalue;
  if (mesh.dim == 1)
    result->contour = to_contour<2>(std::move(mesh));
  else if (mesh.dim == 2)
    result->contour = to_contour<3>(std::move(mesh));
  else if (mesh.dim == 3)
    result->contour = to_contour<4>(std::move(mesh));
  else
    result->contour = to_contour<5>(std::move(mesh));
  return result;
}

}  // namespace

void bind_files(py::module_& m) {
  m.def("read_series", &read_any, py::arg("paths"), py::arg("variable"), py::arg("times"), py::arg("time_step"),
        py::arg("time_unit"), py::arg("sort"), py::arg("fixed"), py::arg("allow_outside_paths"),
        py::arg("separate_process"), py::arg("progress"), doc::read_series);
  m.def("read_cell_mesh", &read_mesh_of_cells, py::arg("paths"), py::arg("variable"), py::arg("cells_to_points"),
        py::arg("times"), py::arg("allow_outside_paths"), py::arg("progress"), doc::read_cell_mesh);
  m.def("write_contour", &write_any, py::arg("contour"), py::arg("path"), py::arg("progress"), doc::write_mesh);
  m.def("load_contour", &load_any, py::arg("path"), py::arg("allow_outside_paths"), py::arg("separate_process"),
        py::arg("progress"), doc::read_mesh);
}

}  // namespace tegl::python
