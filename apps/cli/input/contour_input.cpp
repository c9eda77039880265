// SPDX-License-Identifier: BSD-3-Clause
//
// Reads the contour of commands whose FILE is an image or a saved contour.
#include "input/contour_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/empty_result.hpp"
#include "base/numbers.hpp"
#include "input/lattice_attributes.hpp"
#include "input/mesh_input.hpp"
#include "input/point_arrays.hpp"
#include "output/output.hpp"

namespace tegl::cli {

namespace {

/// Converts the coordinates to double.
template <int N, class Real>
Contour<N, double> widened(Contour<N, Real> contour) {
  if constexpr (std::is_same_v<Real, double>) {
    return contour;
  } else {
    const auto widen = [](const auto& from, auto& to) {
      to.resize(from.size());
      for (std::size_t i = 0; i < from.size(); ++i) std::copy(from[i].begin(), from[i].end(), to[i].begin());
    };
    Contour<N, double> result;
    widen(contour.vertices, result.vertices);
    widen(contour.normals, result.normals);
    result.simplices = std::move(contour.simplices);
    result.axis_names = std::move(contour.axis_names);
    result.axis_units = std::move(contour.axis_units);
    result.direction = contour.direction;
    result.periods = std::move(contour.periods);
    result.vertex_attributes = std::move(contour.vertex_attributes);
    result.simplex_attributes = std::move(contour.simplex_attributes);
    return result;
  }
}

/// The range of a curved coordinate.
CutAxis cut_axis_of(const CurvedAxis& one) {
  CutAxis axis{one.name, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < one.size(); ++i) {
    axis.first = std::fmin(axis.first, one[i]);
    axis.last = std::fmax(axis.last, one[i]);
  }
  axis.is_longitude = is_longitude_unit(one.unit);
  return axis;
}

}  // namespace

std::vector<std::string> take_grid(ReadImageResult& input, const std::string& file, const ExtractionOptions& options,
                                   Tiling& tiling, std::optional<std::uint64_t>& folded_cells) {
  options.refuse_cells_with_tiling(input.info.samples_are_cells, file);
  if (options.samples_are_as_in_file()) tiling.of_cells = input.info.samples_are_cells;
  if (tiling.of_cells) tiling.cell_faces = input.info.cell_faces;
  options.take_lattice(input.info, file, tiling);
  if (input.info.curved.empty()) {
    const std::string remark = take_longitudes(input.image, options, tiling);
    return {remark, leave_out_repeated(input.image, tiling)};
  }
  options.refuse_lattice(input.info, file, "the curved grid of " + file);
  options.refuse_other_tiling("the curved grid of " + file);
  tiling.curved = std::move(input.info.curved);
  const std::string remark = take_longitudes(input.image, options, tiling);
  const std::string left_out = leave_out_repeated(input.image, tiling);
  const auto of_owned = [&]<Value T, int N>(const OwnedImage<T, N>& owned) -> std::string {
    const GridFolds<N> folds =
        find_folds<N>(owned.grid, tiling.curved, {}, seams_of(owned.grid, tiling.curved, tiling.periodic));
    folded_cells = folds.cells;
    if (folds.cells == 0) return "";
    return fmt::format(
        "the curved grid is folded in {}, the first at the sample ({}): the contour may overlap itself there",
        counted(folds.cells, "cell", "cells"), fmt::join(folds.first, ", "));
  };
  return {remark, left_out, std::visit([&](const auto& typed) { return std::visit(of_owned, typed); }, input.image)};
}

namespace {

/// Leaves out the last `count` samples along an axis.
template <Value T, int N>
void leave_out(OwnedImage<T, N>& owned, std::size_t axis, std::size_t count) {
  Axis& along = owned.grid.axes[axis];
  std::size_t row = 1;
  for (std::size_t a = 0; a < axis; ++a) row *= owned.grid.axes[a].size();
  const std::size_t block = row * along.size(), kept = block - row * count;
  T* const values = owned.values.data();
  std::size_t end = 0;
  for (std::size_t first = 0; first < owned.values.size(); first += block, end += kept)
    std::copy(values + first, values + first + kept, values + end);
  owned.values.resize(end);
  along = along.part(0, along.size() - count);
}

}  // namespace

std::string leave_out_repeated(AnyImage& image, Tiling& tiling) {
  if (tiling.periodic.empty()) return "";
  const auto of_owned = [&]<Value T, int N>(OwnedImage<T, N>& owned) {
    const NamedPeriods named = named_periods(owned.grid, tiling.curved, tiling.periodic);
    const auto is_longer = [&](int a) { return repeated_longitudes<N>(owned.grid, tiling.curved, a) > 0; };
    if (std::none_of(named.axes.begin(), named.axes.end(), is_longer)) return std::string();  // copies no coordinates
    WithoutRepeated<T, N> kept = without_repeated<T, N>(owned.view(), tiling.curved, named.axes, named.periods);
    tiling.curved = std::move(kept.curved);
    std::vector<std::string> texts;
    for (std::size_t a = 0; a < N; ++a) {
      const std::size_t count = kept.left_out[a];
      if (count == 0) continue;
      leave_out(owned, a, count);
      const std::string name = axis_label(owned.grid.axes[a].name, a);
      texts.push_back(
          count == 1
              ? fmt::format("the last sample along {} repeats the first one, so it is left out", name)
              : fmt::format("the last {} samples along {} repeat the first ones, so they are left out", count, name));
    }
    return fmt::format("{}", fmt::join(texts, "; "));
  };
  return std::visit([&](auto& typed) { return std::visit(of_owned, typed); }, image);
}

bool has_repeated_longitudes(const AnyLayers& layers) {
  const auto of_one = []<Value T, int N>(const std::unique_ptr<LayerReader<T, N>>& one) {
    const Grid<N> grid = one->grid();
    bool any = false;
    for (int a = 0; a < N && !any; ++a) any = repeated_longitudes<N>(grid, {}, a) > 0;
    return any;
  };
  return std::visit([&](const auto& typed) { return std::visit(of_one, typed); }, layers);
}

CutSpace space_of(const AnyImage& image, const std::vector<CurvedAxis>& curved,
                  const std::vector<std::string>& periodic) {
  CutSpace space = space_of(image);
  for (const CurvedAxis& one : curved) space.axes[static_cast<std::size_t>(one.axis)] = cut_axis_of(one);
  if (curved.empty() || periodic.empty()) return space;
  const auto take_seams = [&]<Value T, int N>(const OwnedImage<T, N>& owned) {
    const std::vector<CurvedSeam<N>> seams = seams_of(owned.grid, curved, periodic);
    std::vector<Period<N>> periods;
    for (const CurvedSeam<N>& seam : seams) periods.push_back({seam.vector, {}, 0.0});
    take_periods(space, periods);
  };
  std::visit([&](const auto& typed) { std::visit(take_seams, typed); }, image);
  return space;
}

CutSpace space_of_cells(const AnyImage& image, const CellFaces& faces) {
  const auto of_owned = [&]<Value T, int N>(const OwnedImage<T, N>& owned) {
    Grid<N> grid = owned.grid;
    for (std::size_t a = 0; a < N; ++a) {
      const bool is_given = a < faces.size() && !faces[a].empty();
      grid.axes[a] = Axis::rectilinear(is_given ? faces[a] : cell_faces(owned.grid.axes[a]));
      grid.axes[a].name = owned.grid.axes[a].name;
      grid.axes[a].unit = owned.grid.axes[a].unit;
    }
    return space_of(grid);
  };
  return std::visit([&](const auto& typed) { return std::visit(of_owned, typed); }, image);
}

namespace {

template <Value T, int N>
CutSpace space_of_longer(const OwnedImage<T, N>& owned, const std::vector<std::string>& periodic) {
  Grid<N> grid = owned.grid;
  const AxisPeriods<N> periods = periods_of(grid, periodic);
  std::array<bool, N> is_longer{};
  for (std::size_t a = 0; a < N; ++a) {
    Axis& axis = grid.axes[a];
    // shorter periods are errors of the extraction
    is_longer[a] = periods[a] > std::abs(axis[axis.size() - 1] - axis[0]);
    if (is_longer[a]) axis = longer_axis(axis, periods[a]);
  }
  CutSpace space = space_of(grid);
  std::vector<Period<N>> of_world;
  for (std::size_t b = 0; b < N; ++b) {
    if (!is_longer[b]) continue;
    Vector<N>& vector = of_world.emplace_back().vector;
    for (std::size_t a = 0; a < N; ++a) vector[a] = grid.linear[a][b] * periods[b];
  }
  take_periods(space, of_world);
  return space;
}

}  // namespace

CutSpace space_of_periods(const AnyImage& image, const std::vector<std::string>& periodic) {
  const auto of_owned = [&](const auto& owned) { return space_of_longer(owned, periodic); };
  return std::visit([&](const auto& typed) { return std::visit(of_owned, typed); }, image);
}

CutSpace space_of_periods(const AnyImage5d& image, const std::vector<std::string>& periodic) {
  return std::visit([&](const auto& owned) { return space_of_longer(owned, periodic); }, image);
}

Mesh read_finite_mesh(const std::string& file, const ReadMeshOptions& options) {
  if (find_mesh_file_format(file) == nullptr)
    throw Error(ErrorCode::UnsupportedFormat,
                fmt::format("{}: no saved contour, by its name; expected {}: 'tegl contour' makes one of an image",
                            file, kContourFiles));
  Mesh mesh = read_mesh(file, options);
  const auto is_finite = [](double x) { return std::isfinite(x); };
  const auto first = std::find_if_not(mesh.coordinates.begin(), mesh.coordinates.end(), is_finite);
  if (first == mesh.coordinates.end()) return mesh;
  const auto others = mesh.coordinates.end() - first - 1 - std::count_if(first + 1, mesh.coordinates.end(), is_finite);
  throw Error(
      ErrorCode::MalformedFile,
      fmt::format("a coordinate of vertex {} is {}{}; expected finite ones",
                  (first - mesh.coordinates.begin()) / mesh.space_dim, std::isnan(*first) ? std::abs(*first) : *first,
                  others == 0 ? ""
                              : fmt::format(", and {} are not finite",
                                            counted(others, "other", "others"))));  // NaN is printed without its sign
}

Mesh read_saved_contour(const std::string& file, const ReadMeshOptions& options, bool allow_empty) {
  Mesh mesh = read_finite_mesh(file, options);
  if (mesh.simplices.empty() && !allow_empty)
    throw EmptyResult("the saved contour is empty; expected one with simplices (--allow-empty: an empty result)");
  return mesh;
}

AnyContour to_any_contour(Mesh&& mesh) {
  // Some formats return segments of a planar mesh with a third coordinate, 0.
  const int dim = mesh.dim == 1 ? 2 : mesh.space_dim;
  if (dim == 2) return to_contour<2>(std::move(mesh));
  if (dim == 3) return to_contour<3>(std::move(mesh));
  if (dim == 4) return to_contour<4>(std::move(mesh));
  return to_contour<5>(std::move(mesh));
}

void throw_5d() {
  throw Error(ErrorCode::UnsupportedData,
              "holds a 5D contour; expected one in 2 to 4 dimensions: slice it first ('tegl slice')");
}

MeshSize ContourInput::size() const {
  return std::visit(
      [&](const auto& any) {
        return MeshSize{space_dim() - 1, any.vertices.size(), any.simplices.size()};
      },
      contour);
}

std::string ContourInput::axis_name(int axis) const {
  const auto a = static_cast<std::size_t>(axis);
  return std::visit([&](const auto& any) { return axis_label(any.axis_names.at(a), a); }, contour);
}

std::string ContourInput::axis_unit(int axis) const {
  return std::visit([&](const auto& any) { return any.axis_units.at(static_cast<std::size_t>(axis)); }, contour);
}

std::string unroll_input(ContourInput& input) {
  return std::visit(
      [&]<int N>(Contour<N, double>& contour) -> std::string {
        if (contour.periods.empty()) return "";
        contour = unroll(contour).contour;
        return "the contour is unrolled: it ends at both ends of its periodic axes";
      },
      input.contour);
}

ContourResult ContourInput::to_result() const {
  ContourResult result;
  result.input = file;
  result.variable = variable;
  result.image_dim = space_dim();
  result.isovalue = isovalue;
  result.stats = stats;
  result.folded_cells = folded_cells;
  result.seconds = seconds;
  return result;
}

void add_input_keys(Json& json, const ContourInput& input) {
  json["input"] = input.file.json();
  json["variable"] = input.variable.empty() ? Json(nullptr) : Json(input.variable);
  json["image_dim"] = input.space_dim();
  json["isovalue"] = input.isovalue ? Json(*input.isovalue) : Json(nullptr);
  if (input.folded_cells) json["folded_cells"] = *input.folded_cells;
}

std::string input_text(const ContourInput& input) {
  std::string text = input_line(input.file, input.variable);
  if (input.isovalue) text += report_line("isovalue", number(*input.isovalue));
  const MeshSize size = input.size();
  text += report_line("contour", fmt::format("{}, {}", counted(size.vertices, "vertex", "vertices"),
                                             counted_simplices(size.dim, size.simplices)));
  return text;
}

void refuse_image_options(const std::vector<std::string>& files, std::vector<std::string> refused,
                          const ImageOptions& images, const std::string& expected) {
  const std::string& file = files.front();
  if (files.size() > 1)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{} is a saved contour, and one of {} files; expected one saved contour, or images only",
                            file, files.size()));
  for (std::string& option : images.given()) refused.push_back(std::move(option));
  if (refused.empty()) return;
  throw Error(ErrorCode::InvalidArgument, fmt::format("{} is a saved contour, which does not take {}; expected {}",
                                                      file, fmt::join(refused, ", "), expected));
}

namespace {

using Ends = std::pair<std::optional<double>, std::optional<double>>;

template <int N>
Ends ends_of_grid(const Grid<N>& grid) {
  constexpr int kLast = N - 1;
  for (int a = 0; a < kLast; ++a)
    if (grid.linear[kLast][a] != 0) return {};
  const Axis& axis = grid.axes[kLast];
  const auto world = [&](double at) { return grid.linear[kLast][kLast] * at + grid.offset[kLast]; };
  return std::minmax({world(axis[0]), world(axis[axis.size() - 1])});
}

}  // namespace

Ends ends_of_last_axis(const AnyImage& image) {
  const auto of_owned = [&](const auto& owned) { return ends_of_grid(owned.grid); };
  return std::visit([&](const auto& typed) { return std::visit(of_owned, typed); }, image);
}

ContourInputCommand::ContourInputCommand(CLI::App& program, const std::string& name, const std::string& description,
                                         Files files)
    : Command(
          program, name, description,
          "an image or a mesh of cells (with --iso), or a contour saved by 'tegl contour' (.vtkhdf, .ply, .glb ...)",
          files) {
  options_.add_to(app(), false);
  options_.add_tiling_to(app());
  add_image_options();
  add_quiet();
}

ContourInput ContourInputCommand::read_mesh_contour(ProgressBar& bar) {
  ContourInput result;
  Stopwatch watch;
  result.isovalue = options_.isovalue();
  refuse_options_of_images(file(), options_, images());
  ExtractOptions options = options_.library_options();
  const MeshInput input = read_mesh_input(files(), images(), bar.stage("read"), false);
  remark(input.mesh.remarks);
  result.variable = input.mesh.variable;
  require_mesh_contour(input.mesh, *result.isovalue, allows_empty(), options.ambiguity);
  result.single_precision = options_.single_precision();
  result.last_axis = space_of(input).axes.back();
  result.last_axis_of = "mesh";
  if (input.is_moving()) result.ends = {input.mesh.times.front(), input.mesh.times.back()};
  std::vector<PointArray> arrays;
  if (attributes_of_meshes_ != nullptr)
    arrays = read_point_arrays(*attributes_of_meshes_, input.mesh, files(), images(), bar);
  take_order(input.mesh.files);
  result.file = inputs();
  result.seconds.read = watch.lap();
  options.work.progress = bar.stage("contour");
  result.contour = extract_mesh_and_use<AnyContour>(
      input, *result.isovalue, options, options_.single_precision(), [&](auto extraction) {
        result.stats = extraction.stats;
        add_point_arrays(extraction.contour, input, *result.isovalue, options, arrays);
        options_.add_shape_normals(extraction.contour);
        return AnyContour(widened(std::move(extraction.contour)));
      });
  if (result.size().simplices == 0) remark(remark_without_contour(input.mesh, *result.isovalue));
  result.seconds.add(*result.stats);
  return result;
}

void ContourInputCommand::contour_5d(const ReadImage5dResult& input, ExtractOptions options, ProgressBar& bar,
                                     Stopwatch& watch, ContourInput& result) const {
  options_.require_to_5d();
  result.variable = input.info.variable;
  require_contour(input, *result.isovalue, allows_empty(), std::nullopt);
  result.last_axis = space_of(input.image).axes.back();
  result.ends = std::visit([](const auto& owned) { return ends_of_grid(owned.grid); }, input.image);
  result.single_precision = options_.single_precision();
  result.seconds.read = watch.lap();
  options.work.progress = bar.stage("contour");
  result.contour = extract_and_use<AnyContour>(
      input.image, *result.isovalue, options, options_.single_precision(),
      [&](auto extraction) {
        result.stats = extraction.stats;
        return AnyContour(widened(std::move(extraction.contour)));
      },
      options_.tiling());
  result.seconds.add(*result.stats);
}

ContourInput ContourInputCommand::read_contour(ProgressBar& bar, bool keep_image, CurvedGrids curved) {
  require_inputs();
  ContourInput result;
  result.file = inputs();
  Stopwatch watch;
  // a saved contour
  if (find_mesh_file_format(file()) != nullptr) {
    std::vector<std::string> given = options_.given();
    std::erase(given, "--threads");
    refuse_image_options(files(), given, images(), "no option for images except --threads");
    Mesh mesh = read_saved_contour(file(), mesh_options(bar.stage("read")), allows_empty());
    result.isovalue = mesh.isovalue;
    result.contour = to_any_contour(std::move(mesh));
    result.seconds.read = watch.lap();
    return result;
  }
  if (are_cell_meshes(files(), images())) return read_mesh_contour(bar);
  // an image to be contoured
  result.isovalue = options_.isovalue();
  ExtractOptions options = options_.library_options();
  Tiling tiling = options_.tiling();
  auto any = keep_image ? read(bar.stage("read"), curved) : read_to_5d(bar.stage("read"), curved);
  result.file = inputs();
  if (const auto* const in_5d = std::get_if<ReadImage5dResult>(&any)) {
    contour_5d(*in_5d, options, bar, watch, result);
    return result;
  }
  ReadImageResult input = std::move(std::get<ReadImageResult>(any));
  remark(take_grid(input, file(), options_, tiling, result.folded_cells));
  result.variable = input.info.variable;
  require_contour(input, *result.isovalue, allows_empty(), tiling.lattice);
  result.is_curved = !tiling.curved.empty();
  result.lattice = tiling.lattice;
  if (attributes_of_meshes_ != nullptr) refuse_attributes_on_lattices(*attributes_of_meshes_, tiling);
  result.last_axis = space_of(input.image, tiling.curved).axes.back();
  result.ends = ends_of_last_axis(input.image);
  for (const CurvedAxis& one : tiling.curved)
    if (one.axis == image_dim(input.image) - 1) result.ends = {result.last_axis->first, result.last_axis->last};
  result.single_precision = options_.single_precision();
  result.seconds.read = watch.lap();
  options.work.progress = bar.stage("contour");
  result.contour = extract_and_use<AnyContour>(
      input.image, *result.isovalue, options, options_.single_precision(),
      [&](auto extraction) {
        result.stats = extraction.stats;
        options_.add_shape_normals(extraction.contour);
        return AnyContour(widened(std::move(extraction.contour)));
      },
      tiling);
  if (result.size().simplices == 0) remark(remark_without_contour(input.image, *result.isovalue));
  result.seconds.add(*result.stats);
  if (keep_image) result.image = std::move(input);
  return result;
}

}  // namespace tegl::cli
