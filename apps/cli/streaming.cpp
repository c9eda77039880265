// SPDX-License-Identifier: BSD-3-Clause
#include "streaming.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "numbers.hpp"
#include "progress.hpp"

namespace tegl::cli {

namespace {

template <int N, class Real, class T>
void stream_typed(LayerReader<T, N>& layers, double isovalue, const ExtractOptions& options, ContourResult& result) {
  for (int a = 0; a < N; ++a)
    if (layers.grid().axes[a].size() < 2)
      throw Error(ErrorCode::EmptyResult,
                  fmt::format("the axis '{}' has 1 sample; a contour needs at least 2 samples along every axis",
                              axis_label(layers.grid().axes[a].name, static_cast<std::size_t>(a))));
  ContourFile<N, Real> file(result.output, layers.grid(), isovalue);
  ExtractStats& stats = result.stats.emplace();
  Stopwatch watch;
  const StreamedSize size = extract_streamed<Real>(layers, isovalue, options, file, &stats);
  if (size.simplices == 0)
    throw Error(ErrorCode::EmptyResult,
                fmt::format("no contour at {}: no neighbouring samples lie on both sides of it", number(isovalue)));
  file.commit();
  result.streamed = MeshSize{N - 1, size.vertices, size.simplices};
  result.seconds.add(stats);
  result.seconds.write = std::max(0.0, watch.lap() - result.seconds.total());
}

}  // namespace

void stream_contour(OpenLayersResult& input, double isovalue, const ExtractOptions& options, bool single_precision,
                    ContourResult& result) {
  const auto typed = [&]<class T, int N>(const std::unique_ptr<LayerReader<T, N>>& layers) {
    result.image_dim = N;
    if (single_precision)
      stream_typed<N, float>(*layers, isovalue, options, result);
    else
      stream_typed<N, double>(*layers, isovalue, options, result);
  };
  std::visit([&](const auto& any) { std::visit(typed, any); }, input.layers);
}

}  // namespace tegl::cli
