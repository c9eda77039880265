// SPDX-License-Identifier: BSD-3-Clause
//
// Images as results: checks of the output file, writing, and the report.
#pragma once

#include <cstdint>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "base/progress.hpp"
#include "output/output.hpp"
#include "output/result.hpp"
#include "tegl/io/image_writer.hpp"

namespace tegl::cli {

/// Formats of images, for help and errors.
inline constexpr const char* kImageFiles =
    ".nrrd, .nc (netCDF), which also holds uneven axes, or .vti (VTK) in 2D and 3D";

/// Throws WriteFailed unless `output` is probably writable as an image: a known extension, an existing writable folder,
/// not a directory, not one of the inputs.
void require_image_output(const std::string& output, const std::vector<std::string>& inputs);

/// Adds --threads to a command.
void add_threads_option(CLI::App& app, unsigned& threads);

/// An image that was made and written.
struct ImageResult {
  std::string heading;   ///< "Gaussian filter of brain.nii.gz"
  InputFiles input;      ///< no names: made without an input
  std::string variable;  ///< of the input
  std::string what;      ///< for JSON: "gaussian"
  std::string output;
  std::vector<std::size_t> sizes = {};
  ValueType type = ValueType::float32;
  std::uint64_t output_bytes = 0;
  double read_seconds = 0, make_seconds = 0, write_seconds = 0;
  std::vector<std::pair<std::string, std::string>> lines = {};  ///< more lines of the report: label and value
  Json more = Json::object();                                   ///< more keys

  [[nodiscard]] Json json() const;
  [[nodiscard]] std::string text(const Console& console) const;
  /// Prints the report as JSON, as text, or not at all.
  void report(const Console& console, bool as_json, bool quiet) const;
};

/// Writes an image in memory, and completes the result.
template <Value T, int N>
void write_image_result(const Image<T, N>& image, const ImageInfo& info, ProgressBar& bar, ImageResult& result) {
  Stopwatch watch;
  for (int a = 0; a < N; ++a) result.sizes.push_back(image.size(a));
  result.type = kValueType<T>;
  const WorkOptions work{0, bar.stage("write")};
  result.output_bytes = write_file(result.output, [&] { write_image(image, result.output, info, work); });
  result.write_seconds = watch.lap();
}

/// Layers that keep the error of reading them, to distinguish it from errors of the output.
template <Value T, int N>
class WatchedLayers final : public LayerReader<T, N> {
 public:
  explicit WatchedLayers(LayerReader<T, N>& layers) : layers_(layers) {}
  [[nodiscard]] const Grid<N>& grid() const noexcept override { return layers_.grid(); }
  void read(std::size_t k, T* to) override {
    try {
      layers_.read(k, to);
    } catch (...) {
      error_ = std::current_exception();
      throw;
    }
  }
  [[nodiscard]] const std::exception_ptr& error() const noexcept { return error_; }

 private:
  LayerReader<T, N>& layers_;
  std::exception_ptr error_;
};

/// Writes an image layer by layer, each computed when it is written, and completes the result. Errors of the reader
/// keep their codes; others are WriteFailed, as those of write_image_result.
template <Value T, int N>
void stream_image_result(LayerReader<T, N>& layers, const ImageInfo& info, ProgressBar& bar, ImageResult& result) {
  Stopwatch watch;
  for (const Axis& axis : layers.grid().axes) result.sizes.push_back(axis.size());
  result.type = kValueType<T>;
  WatchedLayers<T, N> watched(layers);
  const WorkOptions work{0, bar.stage("stream")};
  try {
    result.output_bytes = write_file(result.output, [&] { write_layers(watched, result.output, info, work); });
  } catch (const Error&) {
    if (watched.error()) std::rethrow_exception(watched.error());
    throw;
  }
  result.make_seconds = watch.lap();
}

}  // namespace tegl::cli
