// SPDX-License-Identifier: BSD-3-Clause
#include "streaming.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "numbers.hpp"
#include "output.hpp"
#include "progress.hpp"
#include "tegl/stream_several.hpp"

namespace tegl::cli {

namespace {

template <int N, class Real, class T>
void stream_typed(LayerReader<T, N>& layers, const ExtractOptions& options, std::vector<ContourResult>& results) {
  for (int a = 0; a < N; ++a)
    if (layers.grid().axes[a].size() < 2)
      throw Error(ErrorCode::EmptyResult,
                  fmt::format("the axis '{}' has 1 sample; a contour needs at least 2 samples along every axis",
                              axis_label(layers.grid().axes[a].name, static_cast<std::size_t>(a))));
  std::vector<std::unique_ptr<ContourFile<N, Real>>> files;
  std::vector<StreamedContour<N, Real>> contours;
  WrittenFiles written;
  Stopwatch watch;
  for (const ContourResult& result : results) {
    const std::filesystem::path file = written.stage(result.output);
    written.with_target_names(
        [&] { files.push_back(std::make_unique<ContourFile<N, Real>>(file, layers.grid(), result.isovalue)); });
    contours.push_back({*result.isovalue, files.back().get(), {}, {}});
  }
  written.with_target_names([&] {
    extract_streamed_several<Real, T, N>(layers, contours, options);
    for (const auto& contour : contours)
      if (contour.size.simplices == 0)
        throw Error(
            ErrorCode::EmptyResult,
            fmt::format("no contour at {}: no neighbouring samples lie on both sides of it", number(contour.isovalue)));
    for (const auto& file : files) file->commit();
  });
  written.keep();
  const double seconds = watch.lap();
  for (std::size_t i = 0; i < results.size(); ++i) {
    results[i].image_dim = N;
    results[i].stats = contours[i].stats;
    results[i].streamed = MeshSize{N - 1, contours[i].size.vertices, contours[i].size.simplices};
    results[i].seconds.add(contours[i].stats);
    results[i].seconds.write = std::max(0.0, seconds - results[i].seconds.total());
  }
}

}  // namespace

void require_open_files(std::size_t contours) {
  constexpr rlim_t kOthers = 32;  // standard streams, inputs, what libraries have open
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
  const rlim_t needed = contours + kOthers;
  if (needed <= limit.rlim_cur) return;
  const rlim_t own = limit.rlim_cur;
  limit.rlim_cur = std::min(needed, limit.rlim_max);
  if (needed <= limit.rlim_max && setrlimit(RLIMIT_NOFILE, &limit) == 0) return;
  const rlim_t most = std::max(own, limit.rlim_max);
  throw Error(
      ErrorCode::InvalidArgument,
      fmt::format("--iso has {} numbers to be streamed in one pass, each into a file that is open all along, and "
                  "the system allows {} open files (ulimit -n); expected at most {}: more in several runs",
                  contours, most, most > kOthers ? most - kOthers : 1));
}

void stream_contours(OpenLayersResult& input, const ExtractOptions& options, bool single_precision,
                     std::vector<ContourResult>& results) {
  const auto typed = [&]<class T, int N>(const std::unique_ptr<LayerReader<T, N>>& layers) {
    if (single_precision)
      stream_typed<N, float>(*layers, options, results);
    else
      stream_typed<N, double>(*layers, options, results);
  };
  std::visit([&](const auto& any) { std::visit(typed, any); }, input.layers);
}

}  // namespace tegl::cli
