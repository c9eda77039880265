// SPDX-License-Identifier: BSD-3-Clause
//
// Options of commands that contour an image, and common steps before and after the extraction.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "base/empty_result.hpp"
#include "base/progress.hpp"
#include "base/statistics.hpp"
#include "input/cuts.hpp"
#include "output/output.hpp"
#include "output/result.hpp"
#include "tegl/cells.hpp"
#include "tegl/curved.hpp"
#include "tegl/division.hpp"
#include "tegl/extract.hpp"
#include "tegl/io/images.hpp"
#include "tegl/lattice.hpp"
#include "tegl/periodic.hpp"
#include "tegl/polygons.hpp"
#include "tegl/slice.hpp"

namespace tegl::cli {

/// The cells between samples, if the grid is periodic, curved or a lattice, its cells are divided, or samples are
/// cells.
struct Tiling {
  std::vector<std::string> periodic = {};  ///< the axes of --periodic
  std::optional<Lattice> lattice = {};     ///< of --lattice, or of the file
  std::optional<Division> division = {};   ///< of --division
  std::vector<CurvedAxis> curved = {};     ///< of the image's curved grid
  bool of_cells = false;                   ///< of --samples-are
  CellFaces cell_faces = {};               ///< of the file
  [[nodiscard]] bool is_plain() const {
    return periodic.empty() && !lattice && !division && curved.empty() && !of_cells;
  }
};

/// The options --iso, --triangulation, --ambiguity, --close, --normals, --gradient-direction, --epsilon, --threads,
/// --precision, and --allow-empty, which saved contours allow too.
class ExtractionOptions {
 public:
  /// Adds the options to a command. A command that only contours images requires --iso and allows triangulation of
  /// polygons. This object must outlive the parse.
  void add_to(CLI::App& app, bool of_images_alone);

  /// Adds --periodic, --lattice, --division and --samples-are to a command, which must outlive this object.
  /// `without_periods`: other options of the command that are refused with --periodic.
  void add_tiling_to(CLI::App& app, std::vector<std::string> without_periods = {});
  /// Adds --samples-are only.
  void add_samples_are_to(CLI::App& app);
  /// The values of these options. Throws InvalidArgument if two are given.
  [[nodiscard]] Tiling tiling() const;
  /// The first of them that is given, with its value, as in "--periodic x"; empty: none.
  [[nodiscard]] std::string given_tiling() const;
  /// Throws InvalidArgument with one of them. `with`: another option or a command. With --samples-are file it depends
  /// on the file: see refuse_cells.
  void refuse_tiling(const std::string& with) const;
  /// As refuse_tiling, but allows --periodic.
  void refuse_other_tiling(const std::string& with) const;
  /// Throws InvalidArgument with --periodic, unless it is none.
  void refuse_periodic_with(const std::string& other) const;
  /// Takes the lattice that the file records to the tiling, unless --lattice is given. Throws InvalidArgument for
  /// options that choose other cells.
  void take_lattice(const ImageInfo& info, const std::string& file, Tiling& tiling) const;
  /// Throws InvalidArgument if the file records a lattice and --lattice is not given. `with`: as refuse_tiling.
  void refuse_lattice(const ImageInfo& info, const std::string& file, const std::string& with) const;
  /// Throws InvalidArgument if --samples-are file is given and the samples of FILE are cells. `with`: as refuse_tiling.
  void refuse_cells(bool samples_are_cells, const std::string& file, const std::string& with) const;
  /// As refuse_cells, for the options of other tilings.
  void refuse_cells_with_tiling(bool samples_are_cells, const std::string& file) const;
  /// Throws InvalidArgument with options that 5D contours do not have.
  void require_to_5d() const;
  /// Whether --periodic is auto.
  [[nodiscard]] bool finds_longitudes() const;
  /// With --periodic auto, takes the longitudes that run around the globe to the tiling, of which curved axes are
  /// known. `around`: their axes. Returns a remark on them, or on those that end at both ends without --periodic, or an
  /// empty text.
  template <int N>
  [[nodiscard]] std::string take_longitudes(const Grid<N>& grid, const std::vector<int>& around, Tiling& tiling) const;
  /// Whether the samples are on a lattice, of --lattice or of the file.
  [[nodiscard]] bool has_lattice(const ImageInfo& info) const {
    return lattice_.empty() ? info.lattice.has_value() : has_lattice();
  }
  /// Whether the file decides if its samples are cells.
  [[nodiscard]] bool samples_are_as_in_file() const { return samples_ == "file"; }
  /// Whether samples are points, whatever the file.
  [[nodiscard]] bool samples_are_points() const { return samples_ == "points"; }

  /// The names of the options that were given.
  [[nodiscard]] std::vector<std::string> given() const;

  /// --iso as a number. Throws InvalidArgument if it is missing, not a finite number, or several.
  [[nodiscard]] double isovalue() const;
  /// The numbers of --iso, which may be a list and may be repeated. Throws InvalidArgument if there is none, or a
  /// number occurs twice.
  [[nodiscard]] std::vector<SpelledNumber> isovalues() const;
  /// Whether a value outside of the data gives an empty result and not an error (--allow-empty).
  [[nodiscard]] bool allows_empty() const { return allow_empty_; }
  /// Value of --threads: 0 for all of the machine.
  [[nodiscard]] unsigned threads() const { return threads_; }
  /// True for --precision float.
  [[nodiscard]] bool single_precision() const { return precision_ == "float"; }
  /// The triangulation of polygons in --triangulation; none for the triangulations of `extract`.
  [[nodiscard]] std::optional<PolygonTriangulation> polygon_triangulation() const;
  /// The library's options, without progress. Throws InvalidArgument for an epsilon outside of [0, 0.5), and for a
  /// triangulation of polygons unless `knows_polygons`: then the caller triangulates them.
  [[nodiscard]] ExtractOptions library_options(bool knows_polygons = false) const;
  /// Value of --triangulation.
  [[nodiscard]] const std::string& triangulation() const { return triangulation_; }
  /// Value of --normals; empty: none.
  [[nodiscard]] const std::string& normals() const { return normals_; }
  /// Whether --normals requests normals computed from the contour's shape.
  [[nodiscard]] bool wants_shape_normals() const { return normals_ == "geometric" || normals_ == "flat"; }
  /// Adds these normals to the contour: `geometric` as its normals, `flat` as attribute "normal" of its simplices.
  template <int N, class Real>
  void add_shape_normals(Contour<N, Real>& contour) const;

 private:
  [[nodiscard]] bool has_lattice() const { return !lattice_.empty() && lattice_ != "cubic"; }
  /// The axes of --periodic; empty with none.
  [[nodiscard]] std::vector<std::string> periodic() const;
  /// Whether --periodic may be given with the other options.
  [[nodiscard]] bool knows_periods(const Tiling& tiling) const;
  /// As given_tiling, without --periodic.
  [[nodiscard]] std::string given_other_tiling() const;
  void refuse_lattice_with(const std::string& other) const;
  void refuse_division_with(const std::string& other) const;

  const CLI::App* app_ = nullptr;  ///< of add_tiling_to
  std::vector<std::string> without_periods_;
  std::vector<CLI::Option*> options_;
  std::vector<std::string> isos_;
  std::vector<std::string> periodic_;
  std::string lattice_;
  std::string division_;
  std::string samples_ = "points";
  std::string triangulation_ = "compact";
  std::string ambiguity_ = "low";
  std::string direction_ = "descent";
  std::string epsilon_ = "0";
  std::string precision_ = "double";
  bool close_ = false;
  bool allow_empty_ = false;
  std::string normals_;
  unsigned threads_ = 0;
};

/// The dimension of the image.
int image_dim(const AnyImage& image);
inline int image_dim(const AnyImage5d&) { return 5; }

/// The error of an isovalue without samples on both sides, for the range of all samples. `unit`: of the values; may be
/// empty.
EmptyResult outside_error(double isovalue, const ValueRange& range, const std::string& unit);

/// Throws EmptyResult unless an image with these axes has cells: at least two samples along every axis, and the layers
/// that the lattice needs.
void require_samples(std::span<const Axis> axes, std::optional<Lattice> lattice);

/// Throws EmptyResult, with the reason, unless a contour of the isovalue can exist: cells (require_samples), and
/// samples on both sides of the isovalue. If only the latter fails, it is no error with `allow_empty`. Return the
/// isovalue of the samples, which may be stored integers (ImageInfo::scaling).
double require_contour(const ReadImageResult& input, double isovalue, bool allow_empty, std::optional<Lattice> lattice);
double require_contour(const ReadImage5dResult& input, double isovalue, bool allow_empty,
                       std::optional<Lattice> lattice);

/// The remark that missing samples prevent a contour.
std::string remark_on_missing(double isovalue);

/// The remark about an empty contour: empty if the isovalue is outside of the values, which was allowed; else that
/// missing samples prevent a contour. `of_samples`: the result of require_contour.
template <class Image>
std::string remark_without_contour(const Image& image, double isovalue, double of_samples) {
  return value_range(image, of_samples).has_both_sides(of_samples) ? remark_on_missing(isovalue) : std::string();
}
template <class Image>
std::string remark_without_contour(const Image& image, double isovalue) {
  return remark_without_contour(image, isovalue, isovalue);
}

/// Why simplices of a contour have zero size, for reports: samples equal the isovalue, unless `epsilon` excludes that,
/// or, in 4D, missing values. `of_samples`: the result of require_contour. Reads the samples of 4D images of real
/// numbers.
std::string reason_of_zero_size(const AnyImage& image, double of_samples, double epsilon);

/// Axes, and for each of them its period in its own unit; NaN: none is given.
struct NamedPeriods {
  std::vector<int> axes = {};
  std::vector<double> periods = {};
};
/// The axes that --periodic names, as periods_of and seams_of take them. Throws as these do.
template <int N>
NamedPeriods named_periods(const Grid<N>& grid, const std::vector<CurvedAxis>& curved,
                           const std::vector<std::string>& names);

/// The periods that --periodic names: axes by name, letter or `longitude`, `all`, or NAME=PERIOD, but not auto or none.
/// Throws InvalidArgument, with all names, for others.
template <int N>
AxisPeriods<N> periods_of(const Grid<N>& grid, const std::vector<std::string>& names);
/// The seams that --periodic names on a curved grid: axes by their names or those of their coordinates, as periods_of.
/// The name of longitudes stands for the axis along which they run around the globe.
template <int N>
std::vector<CurvedSeam<N>> seams_of(const Grid<N>& grid, const std::vector<CurvedAxis>& curved,
                                    const std::vector<std::string>& names);

/// A wrapped contour, unrolled if `unroll` is set or if only .vtkhdf could hold its periods. Vertices then have the
/// attribute "original". Other contours are returned unchanged.
template <int N, class Real>
Contour<N, Real> unrolled_for(Contour<N, Real> contour, const std::string& output, bool unroll) {
  const MeshFileFormat* const format = find_mesh_file_format(output);
  if (contour.periods.empty() || (!unroll && format != nullptr && format->extension == ".vtkhdf")) return contour;
  Unrolled<N, Real> result = tegl::unroll(contour);
  Attribute& attribute = result.contour.vertex_attributes.emplace_back(Attribute{"original", "", 1, {}});
  attribute.values.assign(result.originals.begin(), result.originals.end());
  return std::move(result.contour);
}

/// The remark on slices across periods for which a wrapped contour is unrolled.
inline constexpr const char* kUnrolledForCuts =
    "the contour is unrolled for slices along which it does not repeat itself within 32 periods: it ends at both ends "
    "of its periodic axes";

/// Extracts the contour of an image whose cells are divided and passes it to `use`, as extract_and_use.
template <class Result, class T, int N, class Use>
Result extract_divided_and_use(const OwnedImage<T, N>& owned, double isovalue, const ExtractOptions& options,
                               bool single_precision, const Use& use, const Tiling& tiling) {
  const AxisPeriods<N> periods = periods_of(owned.grid, tiling.periodic);
  if (single_precision)
    return use(extract_divided_with_stats<float>(owned.view(), *tiling.division, isovalue, options, periods));
  return use(extract_divided_with_stats<double>(owned.view(), *tiling.division, isovalue, options, periods));
}

/// Extracts the contour of an image of any type and passes it to `use`, as Extraction<N, float> or
/// Extraction<N, double>.
template <class Result, class Use>
Result extract_and_use(const AnyImage& image, double isovalue, const ExtractOptions& options, bool single_precision,
                       const Use& use, const Tiling& tiling = {}) {
  const auto of_owned = [&]<Value T, int N>(const OwnedImage<T, N>& owned) -> Result {
    if (!tiling.curved.empty()) {
      const std::vector<CurvedSeam<N>> seams = seams_of(owned.grid, tiling.curved, tiling.periodic);
      if (single_precision)
        return use(extract_curved_with_stats<float>(owned.view(), tiling.curved, isovalue, options, seams));
      return use(extract_curved_with_stats<double>(owned.view(), tiling.curved, isovalue, options, seams));
    }
    if (tiling.of_cells) {
      if (single_precision)
        return use(extract_cells_with_stats<float>(owned.view(), isovalue, {}, options, tiling.cell_faces));
      return use(extract_cells_with_stats<double>(owned.view(), isovalue, {}, options, tiling.cell_faces));
    }
    if (tiling.lattice) {
      const AxisPeriods<N> periods = periods_of(owned.grid, tiling.periodic);
      if (single_precision)
        return use(extract_lattice_with_stats<float>(owned.view(), *tiling.lattice, isovalue, options, periods));
      return use(extract_lattice_with_stats<double>(owned.view(), *tiling.lattice, isovalue, options, periods));
    }
    if (tiling.division)
      return extract_divided_and_use<Result>(owned, isovalue, options, single_precision, use, tiling);
    if (!tiling.periodic.empty()) {
      const AxisPeriods<N> periods = periods_of(owned.grid, tiling.periodic);
      if (single_precision) return use(extract_periodic_with_stats<float>(owned.view(), periods, isovalue, options));
      return use(extract_periodic_with_stats<double>(owned.view(), periods, isovalue, options));
    }
    if (single_precision) return use(extract_with_stats<float>(owned.view(), isovalue, options));
    return use(extract_with_stats<double>(owned.view(), isovalue, options));
  };
  return std::visit([&](const auto& typed) { return std::visit(of_owned, typed); }, image);
}

/// As above, for an image in 5 dimensions, of whose tilings only divisions are used.
template <class Result, class Use>
Result extract_and_use(const AnyImage5d& image, double isovalue, const ExtractOptions& options, bool single_precision,
                       const Use& use, const Tiling& tiling = {}) {
  return std::visit(
      [&](const auto& owned) -> Result {
        if (tiling.division)
          return extract_divided_and_use<Result>(owned, isovalue, options, single_precision, use, tiling);
        if (single_precision) return use(extract_with_stats<float>(owned.view(), isovalue, options));
        return use(extract_with_stats<double>(owned.view(), isovalue, options));
      },
      image);
}

/// Checks the mesh; sets the report and the seconds of the check.
void check_result(ContourResult& result, unsigned threads, ProgressBar& bar);

/// Writes the mesh to its output; sets the file size and the seconds.
void write_result(ContourResult& result, ProgressBar& bar);
/// As above, for one of several files.
void write_result(ContourResult& result, ProgressBar& bar, WrittenFiles& written);

}  // namespace tegl::cli
