// SPDX-License-Identifier: BSD-3-Clause
//
// Implements --positions: checks the options and reads the second image.
#include "input/positions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/numbers.hpp"
#include "input/attributes.hpp"
#include "output/output.hpp"

namespace tegl::cli {

namespace {

/// The sizes of an image.
std::vector<std::size_t> sizes_of(const AnyImage& image) {
  const auto of_owned = [](const auto& owned) {
    std::vector<std::size_t> sizes;
    for (const Axis& axis : owned.grid.axes) sizes.push_back(axis.size());
    return sizes;
  };
  return std::visit([&](const auto& typed) { return std::visit(of_owned, typed); }, image);
}

}  // namespace

void PositionArguments::add_to(CLI::App& app) {
  app.add_option("--positions", rule_,
                 "where vertices lie between two samples: linear interpolation; relaxed: smooth surfaces of masks and "
                 "labels without stair steps; filtered: linear in a second image (--positions-image), clamped to the "
                 "side of each sample; gravitation: moved towards neighbouring samples, for masks")
      ->check(CLI::IsMember({"linear", "filtered", "gravitation", "relaxed"}))
      ->capture_default_str();
  app.add_option(
         "--positions-image", file_,
         "for --positions filtered: the second image, FILE or FILE:VARIABLE (netCDF), with as many samples along "
         "each axis")
      ->type_name("FILE[:VAR]");
  app.add_option(
         "--last-axis-weight", weight_,
         "for --positions relaxed: weight of the smoothing along the last axis, such as the time, relative to the "
         "others; 0: each layer by itself")
      ->type_name("NUMBER")
      ->capture_default_str();
}

void PositionArguments::refuse(const std::string& with) const {
  if (!are_linear())
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("--positions {} with {}; expected one of the two", rule_, with));
}

void PositionArguments::require() const {
  if (rule_ == "filtered" && file_.empty())
    throw Error(ErrorCode::InvalidArgument,
                "--positions filtered without --positions-image; expected the second image");
  if (rule_ != "filtered" && !file_.empty())
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("--positions-image with --positions {}; expected --positions filtered", rule_));
  if (const double weight = parse_finite("--last-axis-weight", weight_); weight < 0 || weight > 1e6)
    throw Error(ErrorCode::InvalidArgument, fmt::format("--last-axis-weight is {}; expected 0 to 1000000", weight_));
  if (rule_ != "relaxed" && parse_finite("--last-axis-weight", weight_) != 1)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("--last-axis-weight with --positions {}; expected --positions relaxed", rule_));
  if (!file_.empty()) require_input(parse_file_and_variable(file_).file, Folders::allowed);
}

PositionOptions PositionArguments::library_options(const AnyImage& image, ReadImageOptions reading,
                                                   std::vector<float>& values) const {
  PositionOptions options;
  options.rule = rule_ == "filtered"      ? Positions::filtered
                 : rule_ == "gravitation" ? Positions::gravitation
                 : rule_ == "relaxed"     ? Positions::relaxed
                                          : Positions::linear;
  options.last_axis_weight = parse_finite("--last-axis-weight", weight_);
  if (options.rule != Positions::filtered) return options;
  const FileAndVariable from = parse_file_and_variable(file_);
  reading.variable = from.variable;
  const ReadImageResult other = read_other_image(from.file, reading);
  const auto expected = sizes_of(image), actual = sizes_of(other.image);
  if (actual != expected)
    throw Error(ErrorCode::UnsupportedData,
                fmt::format("--positions-image {} has {} samples; expected {}, as the image", file_,
                            fmt::join(actual, " x "), fmt::join(expected, " x ")));
  const auto copy = [&](const auto& owned) { values.assign(owned.values.begin(), owned.values.end()); };
  std::visit([&](const auto& typed) { std::visit(copy, typed); }, other.image);
  options.filtered = values;
  return options;
}

}  // namespace tegl::cli
