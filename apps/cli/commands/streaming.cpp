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

#include "base/empty_result.hpp"
#include "base/numbers.hpp"
#include "base/progress.hpp"
#include "input/extraction.hpp"
#include "input/ranged_layers.hpp"
#include "io/meshes/contour_file.hpp"
#include "output/output.hpp"
#include "tegl/stream.hpp"

namespace tegl::cli {

namespace {

template <int N, class Real, class T>
std::vector<std::string> stream_typed(LayerReader<T, N>& source, const std::string& unit, const StreamOptions& options,
                                      std::vector<ContourResult>& results) {
  // check the axes
  for (int a = 0; a < N; ++a)
    if (source.grid().axes[a].size() < 2)
      throw EmptyResult(fmt::format("the axis '{}' has 1 sample; expected at least 2 samples along every axis",
                                    axis_label(source.grid().axes[a].name, static_cast<std::size_t>(a))));
  // open the output files
  const auto [least, most] =
      std::ranges::minmax_element(results, {}, [](const ContourResult& result) { return *result.isovalue; });
  RangedLayers<T, N> layers(source, *least->isovalue, *most->isovalue);
  WrittenFiles written;
  std::vector<std::unique_ptr<PendingContour<N, Real>>> files;
  std::vector<StreamedContour<N, Real>> contours;
  std::vector<std::string> remarks;
  Stopwatch watch;
  for (const ContourResult& result : results) {
    files.push_back(std::make_unique<PendingContour<N, Real>>(written.stage(result.output), layers.grid(),
                                                              result.isovalue, options.compression));
    contours.push_back({*result.isovalue, files.back().get()});
  }
  // extract, check the range of values, complete the files
  const std::vector<ExtractedSize> extracted = extract_streamed_several<Real>(layers, contours, options.extract);
  for (std::size_t i = 0; i < contours.size(); ++i) {
    const double isovalue = contours[i].isovalue;
    const bool outside = !layers.range().has_both_sides(isovalue);
    if (outside && !options.allow_empty) throw outside_error(isovalue, layers.range(), unit);
    if (!outside && extracted[i].size.simplices == 0) remarks.push_back(remark_on_missing(isovalue));
  }
  for (const auto& file : files) file->close();
  written.keep();
  // report
  const double seconds = watch.lap();
  for (std::size_t i = 0; i < results.size(); ++i) {
    results[i].image_dim = N;
    results[i].stats = extracted[i].stats;
    results[i].streamed = MeshSize{N - 1, extracted[i].size.vertices, extracted[i].size.simplices};
    results[i].seconds.add(extracted[i].stats);
    results[i].seconds.write = std::max(0.0, seconds - results[i].seconds.total());
  }
  return remarks;
}

}  // namespace

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
    return options.single_precision ? stream_typed<N, float>(*layers, input.info.value_unit, options, results)
                                    : stream_typed<N, double>(*layers, input.info.value_unit, options, results);
  };
  return std::visit([&](const auto& any) { return std::visit(typed, any); }, input.layers);
}

}  // namespace tegl::cli
