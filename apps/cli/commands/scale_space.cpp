// SPDX-License-Identifier: BSD-3-Clause
//
// tegl scale-space: writes an image smoothed at many scales as an image with one more axis.
#include "tegl/scale_space.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/empty_result.hpp"
#include "base/numbers.hpp"
#include "base/progress.hpp"
#include "base/statistics.hpp"
#include "commands/image_makers.hpp"
#include "output/image_result.hpp"
#include "tegl/extract.hpp"
#include "tegl/measure.hpp"

namespace tegl::cli {

namespace {

constexpr const char* kScaleSpaceExamples =
    "Examples:\n"
    "  tegl scale-space terrain.nrrd --sigmas 0.5:16:24 -o scales.nrrd\n"
    "  tegl contour scales.nrrd --iso 600 -o scales.ply                   (the isolines over sigma: a surface)\n"
    "  tegl scale-space head.nii.gz --sigmas 0.5:8:24 --iso 60 -o scales.nrrd\n"
    "  tegl track scales.nrrd --iso 60 --longest 10 -o tracks.svg         (which parts vanish at which scale)\n"
    "  tegl slice scales.nrrd --iso 60 --at log2_sigma=1.5 -o smooth.ply\n"
    "  tegl scale-space head.nii.gz --sigmas 1:16:20 --laplacian -o blobs.nrrd\n"
    "The last axis of the result is log2_sigma: a unit is an octave. With --iso, the contour is measured at each "
    "scale,\n"
    "and the most stable scale is reported, where its size changes least with log sigma.";

/// Layers that are measured as they are read: the size of the contour at an isovalue. The last one throws EmptyResult
/// if the isovalue is outside of the values of all.
template <class Real, int N>
class MeasuredLayers final : public LayerReader<Real, N> {
 public:
  MeasuredLayers(LayerReader<Real, N>& layers, std::optional<double> isovalue, unsigned threads)
      : layers_(layers), isovalue_(isovalue), threads_(threads) {
    for (int a = 0; a + 1 < N; ++a) of_layer_.axes[a] = layers.grid().axes[a];
    for (int row = 0; row + 1 < N; ++row) {
      std::copy_n(layers.grid().linear[row].begin(), N - 1, of_layer_.linear[row].begin());
      of_layer_.offset[row] = layers.grid().offset[row];
    }
  }
  [[nodiscard]] const Grid<N>& grid() const noexcept override { return layers_.grid(); }
  void read(std::size_t k, Real* to) override {
    layers_.read(k, to);
    if (!isovalue_) return;
    ExtractOptions options;
    options.work.threads = threads_;
    const Image<Real, N - 1> layer(to, of_layer_);
    sizes_.push_back(measure(extract(layer, *isovalue_, options)).size);
    std::size_t samples = 1;
    for (const Axis& axis : of_layer_.axes) samples *= axis.size();
    range_.read(std::span<const Real>(to, samples), *isovalue_, *isovalue_);
    if (k + 1 == grid().axes[N - 1].size() && !range_.has_both_sides(*isovalue_))
      throw EmptyResult(fmt::format("the isovalue {} lies outside of the values at all scales, which are {} .. {}",
                                    number(*isovalue_), number(range_.min), number(range_.max)));
  }
  /// Length, area or volume of the contour of each layer.
  [[nodiscard]] const std::vector<double>& sizes() const noexcept { return sizes_; }

 private:
  LayerReader<Real, N>& layers_;
  std::optional<double> isovalue_;
  unsigned threads_;
  ValueRange range_ = {};
  Grid<N - 1> of_layer_ = {};
  std::vector<double> sizes_;
};

class ScaleSpaceCommand final : public Command {
 public:
  explicit ScaleSpaceCommand(CLI::App& program)
      : Command(
            program, "scale-space", "Smooth an image at many scales: an image with the scale as one more axis",
            "the image in 2D to 4D: NIfTI, NRRD, MetaImage, NumPy (.npy, .npz), netCDF (.nc, also gzipped) or DICOM "
            "(a folder)",
            Files::image) {
    app()
        .add_option("--sigmas", sigmas_,
                    "the scales: FIRST:LAST:COUNT with a constant quotient, or a list: 0.5,1,2; sigma of the discrete "
                    "Gaussian in units of the axes")
        ->type_name("NUMBERS")
        ->required();
    app()
        .add_option("-o,--output", output_, std::string("the scale space: ") + kImageFiles)
        ->type_name("FILE")
        ->required();
    app().add_flag("--samples", samples_, "sigmas count samples, not units of the axes");
    app().add_option("--factors", factors_, kFactorsHelp)->type_name("NUMBERS");
    app().add_flag(
        "--laplacian", laplacian_,
        "not the smoothed values but the scale-normalised Laplacian, which is greatest at blobs of this scale");
    app()
        .add_option("--iso", iso_,
                    "measure the contour at this isovalue at each scale, and report the most stable scale")
        ->type_name("NUMBER");
    app()
        .add_option("--border", border_,
                    "samples beyond the border: as those at the border, the opposite ones, or none")
        ->check(CLI::IsMember({"extended", "cyclic", "missing"}))
        ->capture_default_str();
    add_threads_option(app(), threads_);
    add_image_options();
    add_quiet();
    app().footer(kScaleSpaceExamples);
  }

  ExitCode run(const Streams& streams) override {
    // validate options and files
    const std::vector<double> sigmas = parse_sigmas("--sigmas", sigmas_);
    static_cast<void>(scale_axis(sigmas));
    if (!iso_.empty()) isovalue_ = parse_finite("--iso", iso_);
    require_inputs();
    require_image_output(output_, files());
    // read, smooth and write
    ProgressBar bar(streams.err, wants_progress());
    ImageResult result;
    result.what = laplacian_ ? "laplacian" : "values";
    result.output = output_;
    Stopwatch watch;
    const ReadImageResult input = read(bar.stage("read"));
    result.input = inputs();
    result.heading = fmt::format("Scale space of {}", result.input.text());
    result.variable = input.info.variable;
    result.read_seconds = watch.lap();
    std::visit(
        [&](const auto& any) {
          std::visit([&](const auto& image) { write_scales(image, sigmas, input.info, bar, result); }, any);
        },
        input.image);
    // report
    bar.clear();
    result.report(streams.out, json(), quiet());
    return ExitCode::Ok;
  }

 private:
  template <class T, int N>
  void write_scales(const OwnedImage<T, N>& image, const std::vector<double>& sigmas, const ImageInfo& info,
                    ProgressBar& bar, ImageResult& result) {
    ScaleSpaceOptions options;
    options.quantity = laplacian_ ? ScaleQuantity::laplacian : ScaleQuantity::values;
    options.in_samples = samples_;
    options.factors = parse_factors(factors_, N);
    options.filter.borders = {border_ == "extended" ? FilterBorder::extended
                              : border_ == "cyclic" ? FilterBorder::cyclic
                                                    : FilterBorder::missing};
    options.filter.work.threads = threads_;
    ScaleSpaceLayers<T, N> layers(image.view(), sigmas, options);
    MeasuredLayers<FilteredValue<T>, N + 1> measured(layers, isovalue_, threads_);
    ImageInfo of_scales = info;
    of_scales.samples_are_cells = false;  // a scale has no extent
    if (!of_scales.axis_directions.empty()) of_scales.axis_directions.push_back(AxisDirection::unknown);
    stream_image_result(measured, of_scales, bar, result);
    report(sigmas, measured.sizes(), result);
  }

  void report(const std::vector<double>& sigmas, const std::vector<double>& sizes, ImageResult& result) const {
    result.lines.emplace_back(
        "scales", fmt::format("{}, sigma {} to {}", sigmas.size(), number(sigmas.front()), number(sigmas.back())));
    result.more["sigmas"] = sigmas;
    if (!isovalue_) return;
    result.more["isovalue"] = *isovalue_;
    result.more["sizes_of_contour"] = sizes;
    const StableScale stable = most_stable_scale(sigmas, sizes);
    result.more["most_stable"] =
        stable.sigma == 0 ? Json(nullptr)
                          : Json{{"sigma", stable.sigma}, {"layer", stable.layer}, {"change", stable.change}};
    result.lines.emplace_back("most stable",
                              stable.sigma == 0
                                  ? fmt::format("none: no contour at {} at three scales in a row", number(*isovalue_))
                                  : fmt::format("sigma {}: the size of the contour at {} changes as sigma^{:.3f}",
                                                number(stable.sigma), number(*isovalue_), stable.change));
  }

  std::string sigmas_, output_, iso_, factors_;
  std::string border_ = "extended";
  std::optional<double> isovalue_;
  unsigned threads_ = 0;
  bool samples_ = false;
  bool laplacian_ = false;
};

}  // namespace

namespace {

/// Scales as the library takes them; its errors get the option's name.
template <class Make>
auto scales_of(const char* option, const std::string& text, const Make& make) {
  try {
    return make();
  } catch (const Error& error) {
    throw Error(error.code(), fmt::format("{} {}: {}", option, text, error.what()));
  }
}

}  // namespace

std::vector<double> parse_sigmas(const char* option, const std::string& text) {
  const std::vector<std::string_view> range = split(text, ':');
  if (range.size() == 3) {
    const double count = parse_finite(option, range[2]);
    if (count != std::floor(count) || count < 2 || count > 10000)
      throw Error(
          ErrorCode::InvalidArgument,
          fmt::format("{} {} has the count {}; expected a whole number from 2 to 10000", option, text, range[2]));
    const double first = parse_finite(option, range[0]), last = parse_finite(option, range[1]);
    return scales_of(option, text, [&] { return scale_sigmas(first, last, static_cast<std::size_t>(count)); });
  }
  std::vector<double> sigmas;
  for (const std::string_view part : split(text, ',')) sigmas.push_back(parse_finite(option, part));
  static_cast<void>(scales_of(option, text, [&] { return scale_axis(sigmas); }));
  return sigmas;
}

std::vector<double> parse_factors(const std::string& text, std::size_t axes) {
  std::vector<double> numbers;
  if (text.empty()) return numbers;
  for (const std::string_view part : split(text, ',')) {
    numbers.push_back(parse_finite("--factors", part));
    if (numbers.back() < 0)
      throw Error(ErrorCode::InvalidArgument, fmt::format("--factors is {}; expected numbers of 0 or more", text));
  }
  if (numbers.size() != axes)
    throw Error(ErrorCode::InvalidArgument, fmt::format("--factors has {}; expected {}, one for each axis",
                                                        counted(numbers.size(), "number", "numbers"), axes));
  return numbers;
}

std::unique_ptr<Command> make_scale_space_command(CLI::App& program) {
  return std::make_unique<ScaleSpaceCommand>(program);
}

}  // namespace tegl::cli
