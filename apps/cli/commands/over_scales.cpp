// SPDX-License-Identifier: BSD-3-Clause
//
// Implements --scale-space: the scale space of an image, in memory or by layers.
#include "commands/over_scales.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "base/interrupt.hpp"
#include "commands/image_makers.hpp"
#include "tegl/scale_space.hpp"

namespace tegl::cli {

void ScaleSpaceArguments::add_to(CLI::App& app) {
  option_ = app.add_option("--scale-space", text_,
                           "contour the image smoothed at these scales, with the scale as one more axis, as by 'tegl "
                           "scale-space': FIRST:LAST:COUNT or a list, in units of the axes; with --stream the image is "
                           "in memory, but not the scale space")
                ->type_name("SIGMAS");
  app.add_option("--factors", factors_, kFactorsHelp)->type_name("NUMBERS");
}

void ScaleSpaceArguments::refuse(bool given, const std::string& with) const {
  if (given && are_given())
    throw Error(ErrorCode::InvalidArgument, fmt::format("--scale-space with {}; expected one of the two", with));
}

void ScaleSpaceArguments::require() {
  if (!are_given() && !factors_.empty())
    throw Error(ErrorCode::InvalidArgument, fmt::format("--factors {} without --scale-space; expected both", factors_));
  if (!are_given()) return;
  sigmas_ = parse_sigmas("--scale-space", text_);
  if (sigmas_.size() < 2)
    throw Error(ErrorCode::InvalidArgument, fmt::format("--scale-space {} has one scale; expected at least two, as in "
                                                        "0.5:8:24: the scale is an axis of the contour",
                                                        text_));
}

void ScaleSpaceArguments::apply(std::variant<ReadImageResult, ReadImage5dResult>& input, unsigned threads,
                                Progress progress) const {
  ScaleSpaceOptions options;
  options.filter.work = {threads, std::move(progress)};
  if (std::holds_alternative<ReadImage5dResult>(input))
    throw Error(ErrorCode::InvalidArgument, "--scale-space with an image of 5 axes; expected 2 to 4 axes");
  ReadImageResult from = std::move(std::get<ReadImageResult>(input));
  const auto of_owned = [&]<Value T, int N>(const OwnedImage<T, N>& owned) {
    options.factors = parse_factors(factors_, N);
    auto scales = ScaleSpaceLayers<T, N>(owned.view(), sigmas_, options).all();
    if constexpr (N == 4)
      input = ReadImage5dResult{std::move(scales), std::move(from.info)};
    else
      input = ReadImageResult{AnyImageN<N + 1>(std::move(scales)), std::move(from.info)};
  };
  std::visit([&](const auto& typed) { std::visit(of_owned, typed); }, from.image);
}

OpenLayersResult ScaleSpaceArguments::layers(const ReadImageResult& input, unsigned threads) const {
  ScaleSpaceOptions options;
  options.filter.work = {threads, [](double) { return !InterruptHandler::requested(); }};
  OpenLayersResult result;
  result.info = input.info;
  const auto of_owned = [&]<Value T, int N>(const OwnedImage<T, N>& owned) {
    if constexpr (N == 4) {
      throw Error(ErrorCode::InvalidArgument,
                  "--scale-space and --stream with an image of 4 axes; expected 2 or 3: contours in 5D are made in "
                  "memory");
    } else {
      options.factors = parse_factors(factors_, N);
      std::unique_ptr<LayerReader<FilteredValue<T>, N + 1>> layers =
          std::make_unique<ScaleSpaceLayers<T, N>>(owned.view(), sigmas_, options);
      result.layers = AnyLayersN<N + 1>(std::move(layers));
    }
  };
  std::visit([&](const auto& typed) { std::visit(of_owned, typed); }, input.image);
  return result;
}

}  // namespace tegl::cli
