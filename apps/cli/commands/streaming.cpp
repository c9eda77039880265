// SPDX-License-Identifier: BSD-3-Clause
//
// Implements streamed extraction of one or several isovalues to files.
#include "commands/streaming.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <span>
#include <utility>

#include "base/empty_result.hpp"
#include "base/numbers.hpp"
#include "base/progress.hpp"
#include "input/extraction.hpp"
#include "input/ranged_layers.hpp"
#include "io/meshes/contour_file.hpp"
#include "output/output.hpp"
#include "tegl/curved.hpp"
#include "tegl/stream.hpp"

namespace tegl::cli {

namespace {

/// The pending files of streamed contours.
template <int N, class Real>
class StreamedFiles {
 public:
  /// Opens the output of each result. Throws EmptyResult if the image has no tiles.
  StreamedFiles(const Grid<N>& grid, const AxisPeriods<N>& periods, const StreamOptions& options,
                std::vector<ContourResult>& results)
      : options_(options), results_(results) {
    require_samples(grid.axes, options.lattice);
    for (const ContourResult& result : results) {
      files_.push_back(std::make_unique<PendingContour<N, Real>>(written_.stage(result.output), grid, result.isovalue,
                                                                 options.compression, periods));
      contours_.push_back({*result.isovalue, files_.back().get()});
    }
  }

  [[nodiscard]] std::span<const StreamedContour<N, Real>> contours() const { return contours_; }

  /// Checks the range of values, completes the files and the results. Returns remarks.
  std::vector<std::string> finish(const std::vector<ExtractedSize>& extracted, const ValueRange& range,
                                  const std::string& unit) {
    std::vector<std::string> remarks;
    for (std::size_t i = 0; i < contours_.size(); ++i) {
      const double isovalue = contours_[i].isovalue;
      const bool outside = !range.has_both_sides(isovalue);
      if (outside && !options_.allow_empty) throw outside_error(isovalue, range, unit);
      if (!outside && extracted[i].size.simplices == 0) remarks.push_back(remark_on_missing(isovalue));
    }
    for (const auto& file : files_) file->close();
    written_.keep();
    // report
    const double seconds = watch_.lap();
    for (std::size_t i = 0; i < results_.size(); ++i) {
      ContourResult& result = results_[i];
      result.image_dim = N;
      result.stats = extracted[i].stats;
      result.streamed = MeshSize{N - 1, extracted[i].size.vertices, extracted[i].size.simplices};
      result.seconds.add(extracted[i].stats);
      result.seconds.write = std::max(0.0, seconds - result.seconds.total());
    }
    return remarks;
  }

 private:
  const StreamOptions& options_;
  std::vector<ContourResult>& results_;
  Stopwatch watch_;
  WrittenFiles written_;
  std::vector<std::unique_ptr<PendingContour<N, Real>>> files_;
  std::vector<StreamedContour<N, Real>> contours_;
};

/// The least and the greatest isovalue.
std::pair<double, double> isovalue_range(const std::vector<ContourResult>& results) {
  const auto [least, most] =
      std::ranges::minmax_element(results, {}, [](const ContourResult& result) { return *result.isovalue; });
  return {*least->isovalue, *most->isovalue};
}

template <class Real, class T, int N>
std::vector<ExtractedSize> extract_all(LayerReader<T, N>& layers, std::span<const StreamedContour<N, Real>> contours,
                                       const StreamOptions& options, const AxisPeriods<N>& periods) {
  if (!options.lattice) return extract_streamed_several<Real>(layers, contours, options.extract, periods);
  return extract_lattice_streamed_several<Real>(layers, *options.lattice, contours, options.extract, periods);
}

/// Throws InvalidArgument for axes of --periodic with samples that repeat the first ones, whose values are not known.
template <int N>
void refuse_repeated(const Grid<N>& grid, const std::vector<std::string>& periodic) {
  const NamedPeriods named = named_periods(grid, {}, periodic);
  for (std::size_t i = 0; i < named.axes.size(); ++i) {
    const int a = named.axes[i];
    if (repeated_longitudes<N>(grid, {}, a, named.periods[i]) == 0) continue;
    const auto axis = static_cast<std::size_t>(a);
    throw Error(
        ErrorCode::InvalidArgument,
        fmt::format("--stream with --periodic {}, whose last samples are at the longitudes of the first, 360 "
                    "degrees further; expected it without --stream, which leaves them out, or a file without them",
                    axis_label(grid.axes[axis].name, axis)));
  }
}

template <class Real, class T, int N>
std::vector<std::string> stream_typed(LayerReader<T, N>& source, const std::string& unit, const StreamOptions& options,
                                      std::vector<ContourResult>& results) {
  refuse_repeated<N>(source.grid(), options.periodic);
  const AxisPeriods<N> periods = periods_of(source.grid(), options.periodic);
  StreamedFiles<N, Real> files(source.grid(), periods, options, results);
  const auto [least, most] = isovalue_range(results);
  RangedLayers<T, N> layers(source, least, most);
  const auto extracted = extract_all<Real>(layers, files.contours(), options, periods);
  return files.finish(extracted, layers.range(), unit);
}

}  // namespace

void require_streamed_additions(bool shape_normals, bool attributes) {
  if (!shape_normals && !attributes) return;
  throw Error(ErrorCode::InvalidArgument,
              fmt::format("{} with a streamed contour, which is never in memory as a whole; expected {}",
                          attributes ? "--attribute" : "--normals geometric or flat",
                          attributes ? "an image that fits into memory" : "normals from the gradient"));
}

void require_output_grows(const std::string& output) {
  const MeshFileFormat* const format = find_mesh_file_format(output);
  if (format != nullptr && format->extension == ".vtkhdf") return;
  throw Error(
      ErrorCode::WriteFailed,
      fmt::format("{}: this format cannot be written in parts, which a streamed contour needs; expected .vtkhdf",
                  output));
}

void require_open_files(std::size_t contours) {
  constexpr rlim_t kOthers = 32;  // standard streams, inputs, files opened by libraries
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
  const rlim_t needed = contours + kOthers;
  if (needed <= limit.rlim_cur) return;
  const rlim_t own = limit.rlim_cur;
  limit.rlim_cur = std::min(needed, limit.rlim_max);
  if (needed <= limit.rlim_max && setrlimit(RLIMIT_NOFILE, &limit) == 0) return;
  const rlim_t most = std::max(own, limit.rlim_max);
  throw Error(ErrorCode::InvalidArgument,
              fmt::format("--iso has {} numbers; --stream keeps a file open for each, and the system allows {} open "
                          "files (ulimit -n): expected at most {} numbers per run",
                          contours, most, most > kOthers ? most - kOthers : 1));
}

std::vector<std::string> stream_contours(OpenLayersResult& input, const StreamOptions& options,
                                         std::vector<ContourResult>& results) {
  const auto typed = [&]<class T, int N>(const std::unique_ptr<LayerReader<T, N>>& layers) {
    return options.single_precision ? stream_typed<float>(*layers, input.info.value_unit, options, results)
                                    : stream_typed<double>(*layers, input.info.value_unit, options, results);
  };
  return std::visit([&](const auto& any) { return std::visit(typed, any); }, input.layers);
}

}  // namespace tegl::cli
