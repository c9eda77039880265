// SPDX-License-Identifier: BSD-3-Clause
#include "streaming.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "numbers.hpp"

namespace tegl::cli {

namespace {

/// "64x64x64x400" as numbers.
std::vector<std::size_t> parse_sizes(const std::string& text) {
  std::vector<std::size_t> sizes;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('x', begin), text.size());
    const std::string part = text.substr(begin, end - begin);
    const std::optional<double> size = parse_number(part);
    constexpr double kMost = 0x1p48;
    if (!size || !(*size >= 1 && *size <= kMost) || *size != static_cast<double>(static_cast<std::size_t>(*size)))
      throw Error(
          ErrorCode::InvalidArgument,
          fmt::format("--raw is '{}'; expected sizes such as 64x64x64x400, the one that runs fastest first", text));
    sizes.push_back(static_cast<std::size_t>(*size));
    begin = end + 1;
  }
  return sizes;
}

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

void StreamingOptions::add_to(CLI::App& app) {
  app.add_flag("--stream", stream_,
               "read layer by layer and write as it comes, with little memory: from netCDF, HDF5 or --raw, to .vtkhdf");
  raw_option_ = app.add_option("--raw", raw_, "FILE is raw values of these sizes, the axis that runs fastest first")
                    ->type_name("XxYxZ[xT]");
  raw_option_->needs(
      app.add_option("--raw-type", raw_type_, "their type: uint8, int8, uint16, int16, int32, float or double")
          ->needs(raw_option_));
  app.add_option("--raw-offset", raw_offset_, "bytes before the first value")
      ->needs(raw_option_)
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_flag("--raw-big-endian", raw_big_endian_, "the values' first byte is the highest")->needs(raw_option_);
}

bool StreamingOptions::wanted() const { return stream_ || raw_option_->count() > 0; }

OpenLayersResult StreamingOptions::open(const std::string& file, const std::string& variable) const {
  if (raw_option_->count() == 0) return open_layers(file, variable);
  if (!variable.empty())
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("--var {} with --raw; expected no variable: raw values have no name", variable));
  return open_raw_layers(file, {parse_sizes(raw_), raw_type_, raw_offset_, raw_big_endian_});
}

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
