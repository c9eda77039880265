// SPDX-License-Identifier: BSD-3-Clause
//
// tegl filter: filters an image, in memory or layer by layer.
#include "tegl/filter.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/numbers.hpp"
#include "base/progress.hpp"
#include "input/commands.hpp"
#include "output/image_result.hpp"

namespace tegl::cli {

namespace {

constexpr const char* kFilterExamples =
    "Examples:\n"
    "  tegl filter head.nii.gz --gaussian 1.5 -o smooth.nrrd              (sigma in the units of the axes, here mm)\n"
    "  tegl filter heart.nii.gz --gaussian 1.5 --time-sigma 20 -o smooth.nrrd\n"
    "  tegl filter ocean.nc --var TEMP --gaussian 1,1,0,0.5 --samples --border cyclic,extended,extended,cyclic -o "
    "smooth.nc\n"
    "  tegl filter scan.mha --median 1 -o clean.nrrd\n"
    "  tegl filter scan.mha --bilateral 2 --value-sigma 30 -o clean.nrrd\n"
    "  tegl filter mask.nrrd --contextual 0.5 -o smooth.nrrd              (smooths steps, keeps details)\n"
    "  tegl filter mask.nrrd --curvature 2 -o smooth.nrrd                 (removes details smaller than about 2)\n"
    "  tegl filter terrain.nrrd --kernel 3x3:1,2,1,2,4,2,1,2,1 --normalize -o smooth.nrrd\n"
    "The result has the grid of the image; its samples are float, or double for an image of doubles.";

/// The numbers of a list such as "1.5,1.5,3".
std::vector<double> numbers_of(const char* option, const std::string& text) {
  std::vector<double> numbers;
  for (const std::string_view part : split(text, ',')) numbers.push_back(parse_finite(option, part));
  return numbers;
}

/// Whether an axis is a time: the last of four, or one with such a name.
bool is_time(const std::string& name, std::size_t axis) {
  return axis == 3 || equal_ignoring_case(name, "t") || equal_ignoring_case(name, "time");
}

class FilterCommand final : public Command {
 public:
  explicit FilterCommand(CLI::App& program)
      : Command(program, "filter", "Filter an image before it is contoured: Gaussian, median, bilateral, any kernel",
                "the image: NIfTI, NRRD, MetaImage, NumPy (.npy, .npz), netCDF (.nc, also gzipped) or DICOM (a folder)",
                Files::image) {
    add_kinds();
    add_details();
    add_image_options();
    add_quiet();
    app().footer(kFilterExamples);
  }

  ExitCode run(const Streams& streams) override {
    // validate options and files
    require_options();
    require_inputs();
    require_image_output(output_, files());
    ProgressBar bar(streams.err, wants_progress());
    warn_ = [&](const std::string& text) {
      bar.clear();
      streams.err.write(fmt::format("tegl: {}\n", text));
    };
    ImageResult result;
    result.heading = fmt::format("{} of {}", title(), inputs().text());
    result.what = kind_;
    result.output = output_;
    // filter and write
    if (stream_)
      stream(bar, result);
    else
      filter(bar, result);
    result.input = inputs();
    // report
    bar.clear();
    result.report(streams.out, json(), quiet());
    return ExitCode::Ok;
  }

 private:
  /// The options of which exactly one is given.
  struct Kind {
    const char* name;
    const char* type;
    const char* help;
    const char* title;
  };
  static constexpr std::array<Kind, 8> kKinds = {{
      {"gaussian", "SIGMA", "Gaussian; sigma in units of the axes, one number, or one for each axis",
       "Gaussian filter"},
      {"discrete-gaussian", "SIGMA", "discrete Gaussian, of which two in a row are one", "Discrete Gaussian filter"},
      {"binomial", "SIGMA", "binomial weights (1/4, 1/2, 1/4 for sigma 0.71 samples)", "Binomial filter"},
      {"median", "RADIUS", "median of a box; radius in samples, one number, or one for each axis", "Median"},
      {"bilateral", "SIGMA", "bilateral filter, with --value-sigma: smooths, but not across large differences",
       "Bilateral filter"},
      {"contextual", "NUMBER", "low-pass filter for the contour at this isovalue: smooths its steps, keeps its details",
       "Contextual low-pass filter"},
      {"curvature", "TIME",
       "curvature flow of this duration, in the square of the axes' unit: a ball of radius r gets the radius "
       "sqrt(r^2 - 4 TIME) in 3D; details vanish first",
       "Curvature flow"},
      {"kernel", "SIZES:WEIGHTS",
       "convolution with any kernel: odd sizes, one for each axis, the fastest first, and its weights, as in "
       "3x1:-0.5,0,0.5",
       "Convolution"},
  }};

  void add_kinds() {
    for (std::size_t i = 0; i < kKinds.size(); ++i)
      app().add_option(fmt::format("--{}", kKinds[i].name), values_[i], kKinds[i].help)->type_name(kKinds[i].type);
  }

  void add_details() {
    app()
        .add_option("-o,--output", output_, std::string("the filtered image: ") + kImageFiles)
        ->type_name("FILE")
        ->required();
    app().add_flag("--samples", samples_, "sigmas, and the time of --curvature, count samples, not units of the axes");
    time_option_ = app().add_option("--time-sigma", time_sigma_,
                                    "sigma along the time (the last of four axes, or an axis named t or time), in its "
                                    "unit; default: 0 if --gaussian and others have one number");
    time_option_->type_name("NUMBER");
    value_option_ = app().add_option("--value-sigma", value_sigma_, "with --bilateral: sigma of the values");
    value_option_->type_name("NUMBER");
    app()
        .add_option("--border", borders_,
                    "samples beyond the border: those at the border (extended), the opposite ones (cyclic), or none "
                    "(missing); one word, or one for each axis")
        ->type_name("WORDS")
        ->capture_default_str();
    app().add_flag(
        "--fill", fill_,
        "missing samples get values from their neighbours; by default they stay missing. Not for --contextual");
    app().add_flag("--normalize", normalize_, "with --kernel: divide the weights by their sum");
    app().add_flag("--stream", stream_, "read, filter and write layer by layer, for images larger than memory");
    add_threads_option(app(), threads_);
  }

  [[nodiscard]] std::string title() const {
    return std::find_if(kKinds.begin(), kKinds.end(), [&](const Kind& kind) { return kind.name == kind_; })->title;
  }

  [[nodiscard]] std::string option() const { return "--" + kind_; }

  void require_options() {
    std::vector<std::string> given, known;
    for (std::size_t i = 0; i < kKinds.size(); ++i) {
      known.push_back(fmt::format("--{}", kKinds[i].name));
      if (app().count(known.back()) == 0) continue;
      given.push_back(known.back());
      kind_ = kKinds[i].name;
      value_ = values_[i];
    }
    const auto refuse = [](const std::string& message) { throw Error(ErrorCode::InvalidArgument, message); };
    if (given.size() != 1)
      refuse(fmt::format("{}; expected one of {}",
                         given.empty() ? "no filter" : fmt::format("{} together", fmt::join(given, " and ")),
                         fmt::join(known, ", ")));
    const bool has_sigma = kind_.ends_with("gaussian") || kind_ == "binomial" || kind_ == "bilateral";
    if (samples_ && !has_sigma && kind_ != "curvature")
      refuse(fmt::format("--samples with {}, which has no sigma", option()));
    if (time_option_->count() > 0 && !has_sigma)
      refuse(fmt::format("--time-sigma with {}; expected it with a sigma", option()));
    if ((value_option_->count() > 0) != (kind_ == "bilateral"))
      refuse(kind_ == "bilateral" ? "--bilateral without --value-sigma; expected the sigma of the values"
                                  : fmt::format("--value-sigma with {}; expected it with --bilateral", option()));
    if (fill_ && (kind_ == "contextual" || kind_ == "curvature"))
      refuse(fmt::format("--fill with {}, which leaves missing samples unchanged", option()));
    if (normalize_ && kind_ != "kernel")
      refuse(fmt::format("--normalize with {}; expected it with --kernel", option()));
  }

  /// One number for each axis: those given, or the one given for all axes except the time.
  template <int N>
  std::array<double, N> per_axis(const Grid<N>& grid) const {
    const std::string name = option();
    const std::vector<double> given = numbers_of(name.c_str(), value_);
    std::array<double, N> result{};
    std::size_t times = 0;
    for (std::size_t a = 0; a < N; ++a) times += is_time(grid.axes[a].name, a) ? 1 : 0;
    const bool without_time = given.size() + times == N && time_option_->count() > 0;
    if (given.size() != 1 && given.size() != N && !without_time)
      throw Error(ErrorCode::InvalidArgument, fmt::format("{} has {}; expected one, or one for each of {} axes", name,
                                                          counted(given.size(), "number", "numbers"), N));
    if (given.size() == N && times > 0 && time_option_->count() > 0)
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("{} {} and --time-sigma {} both give a sigma of the time; expected one of the two", name,
                              value_, time_sigma_));
    if (times == 0 && time_option_->count() > 0)
      throw Error(ErrorCode::InvalidArgument, "--time-sigma, but no axis is a time; expected an axis named t or time");
    for (std::size_t a = 0, next = 0; a < N; ++a) {
      const bool from_time = is_time(grid.axes[a].name, a) && given.size() != N;
      if (from_time) {
        result[a] = time_option_->count() > 0 ? parse_finite("--time-sigma", time_sigma_) : 0.0;
      } else {
        result[a] = given.size() == 1 ? given[0] : given[next++];
      }
      if (result[a] < 0)
        throw Error(ErrorCode::InvalidArgument,
                    fmt::format("{} is {}; expected 0 or more", from_time ? "--time-sigma" : name, number(result[a])));
    }
    return result;
  }

  template <int N>
  std::array<double, N> sigmas(const Grid<N>& grid) const {
    const std::array<double, N> given = per_axis(grid);
    if (samples_) return given;
    try {
      return sigmas_in_samples<N>(grid, given);
    } catch (const Error& error) {
      throw Error(error.code(), fmt::format("{} (--samples, with a sigma for each axis)", error.what()));
    }
  }

  template <int N>
  Filter filter_of(const Grid<N>& grid) {
    if (kind_ == "contextual") return ContextualLowPass{parse_finite("--contextual", value_)};
    if (kind_ == "kernel") return kernel(N);
    if (kind_ == "curvature") return curvature_flow(grid);
    if (kind_ == "median") {
      MedianFilter filter;
      for (const double radius : per_axis(grid)) {
        if (radius != std::floor(radius) || radius > 1000)
          throw Error(ErrorCode::InvalidArgument,
                      fmt::format("--median is {}; expected whole numbers from 0 to 1000", value_));
        filter.radii.push_back(static_cast<std::size_t>(radius));
      }
      return filter;
    }
    const std::array<double, N> along = sigmas(grid);
    if (kind_ == "bilateral")
      return BilateralFilter{{along.begin(), along.end()}, parse_finite("--value-sigma", value_sigma_)};
    SeparableConvolution filter;
    for (const double sigma : along)
      filter.weights.push_back(sigma == 0            ? AxisWeights()
                               : kind_ == "gaussian" ? gaussian_weights(sigma)
                               : kind_ == "binomial" ? binomial_weights(sigma)
                                                     : discrete_gaussian_weights(sigma));
    return filter;
  }

  /// The flow along all axes except the time.
  template <int N>
  Filter curvature_flow(const Grid<N>& grid) {
    CurvatureFlow flow{{}, parse_finite("--curvature", value_)};
    if (flow.time < 0)
      throw Error(ErrorCode::InvalidArgument, fmt::format("--curvature is {}; expected 0 or more", value_));
    std::array<double, N> ones{};
    for (std::size_t a = 0; a < N; ++a) {
      ones[a] = is_time(grid.axes[a].name, a) ? 0.0 : 1.0;
      if (ones[a] != 0.0 && !samples_ && !grid.axes[a].is_uniform())
        throw Error(
            ErrorCode::InvalidArgument,
            fmt::format("--curvature along the axis '{}', whose steps differ; expected even steps, or --samples: "
                        "all steps have the length 1",
                        axis_label(grid.axes[a].name, a)));
    }
    if (!samples_) ones = sigmas_in_samples<N>(grid, ones);
    double square = 0;
    int flowing = 0;
    for (std::size_t a = 0; a < N; ++a) {
      flow.spacing.push_back(ones[a] == 0 ? 0.0 : 1 / ones[a]);
      const double extent = flow.spacing.back() * static_cast<double>(grid.axes[a].size() - 1);
      square += extent * extent;
      flowing += ones[a] == 0 ? 0 : 1;
    }
    warn_of_time(flow, square / 4, flowing);
    return flow;
  }

  /// Warns, before the flow begins, if a ball as large as the image vanishes in its time.
  void warn_of_time(const CurvatureFlow& flow, double square_of_radius, int flowing) const {
    if (flowing < 2 || 2.0 * (flowing - 1) * flow.time < square_of_radius) return;
    warn_(fmt::format(
        "--curvature {}: all closed contours vanish in this time, as a ball around the image does in {}; {}", value_,
        number(square_of_radius / (2.0 * (flowing - 1))), counted(step_count(flow), "step", "steps")));
  }

  [[nodiscard]] Filter kernel(std::size_t axes) const {
    const std::size_t colon = value_.find(':');
    if (colon == std::string::npos)
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("--kernel is '{}'; expected sizes and weights, as in 3x1:-0.5,0,0.5", value_));
    Convolution filter;
    for (const std::string_view part : split(std::string_view(value_).substr(0, colon), 'x')) {
      const double size = parse_finite("--kernel", part);
      if (size < 1 || size != std::floor(size) || size > 100000)
        throw Error(ErrorCode::InvalidArgument, fmt::format("--kernel has the size {}; expected odd numbers", part));
      filter.sizes.push_back(static_cast<std::size_t>(size));
    }
    if (filter.sizes.size() != axes)
      throw Error(ErrorCode::InvalidArgument, fmt::format("--kernel has {}; expected {}, one for each axis",
                                                          counted(filter.sizes.size(), "size", "sizes"), axes));
    filter.weights = numbers_of("--kernel", value_.substr(colon + 1));
    if (!normalize_) return filter;
    double sum = 0;
    for (const double weight : filter.weights) sum += weight;
    if (sum == 0)
      throw Error(ErrorCode::InvalidArgument, "--normalize with weights whose sum is 0; expected another sum");
    for (double& weight : filter.weights) weight /= sum;
    return filter;
  }

  [[nodiscard]] FilterOptions options(Progress progress) const {
    FilterOptions options{{}, fill_, {threads_, std::move(progress)}};
    for (const std::string_view word : split(borders_, ',')) {
      if (word != "extended" && word != "cyclic" && word != "missing")
        throw Error(ErrorCode::InvalidArgument,
                    fmt::format("--border is '{}'; expected extended, cyclic or missing, once or for each axis", word));
      options.borders.push_back(word == "extended" ? FilterBorder::extended
                                : word == "cyclic" ? FilterBorder::cyclic
                                                   : FilterBorder::missing);
    }
    return options;
  }

  void filter(ProgressBar& bar, ImageResult& result) {
    Stopwatch watch;
    const ReadImageResult input = read(bar.stage("read"));
    result.variable = input.info.variable;
    result.read_seconds = watch.lap();
    const auto typed = [&]<class T, int N>(const OwnedImage<T, N>& image) {
      const auto filtered = filter_image(image.view(), filter_of(image.grid), options(bar.stage("filter")));
      result.make_seconds = watch.lap();
      write_image_result(filtered.view(), input.info, bar, result);
    };
    std::visit([&](const auto& any) { std::visit(typed, any); }, input.image);
  }

  void stream(ProgressBar& bar, ImageResult& result) {
    OpenLayersResult input = open();
    result.variable = input.info.variable;
    const auto typed = [&]<class T, int N>(const std::unique_ptr<LayerReader<T, N>>& layers) {
      const auto filtered = filter_layers(*layers, filter_of(layers->grid()), options({}));
      stream_image_result(*filtered, input.info, bar, result);
    };
    std::visit([&](const auto& any) { std::visit(typed, any); }, input.layers);
  }

  std::array<std::string, kKinds.size()> values_;
  std::string kind_, value_, time_sigma_, value_sigma_, output_;
  std::string borders_ = "extended";
  std::function<void(const std::string& text)> warn_;  ///< prints at once
  CLI::Option* time_option_ = nullptr;
  CLI::Option* value_option_ = nullptr;
  unsigned threads_ = 0;
  bool samples_ = false;
  bool fill_ = false;
  bool normalize_ = false;
  bool stream_ = false;
};

}  // namespace

std::unique_ptr<Command> make_filter_command(CLI::App& program) { return std::make_unique<FilterCommand>(program); }

}  // namespace tegl::cli
