// SPDX-License-Identifier: BSD-3-Clause
//
// Implements --positions: checks the options and reads the second image.
#include "input/positions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#include "base/empty_result.hpp"
#include "base/numbers.hpp"
#include "input/attributes.hpp"
#include "output/output.hpp"

namespace tegl::cli {

namespace {

/// Calls f with the image of any type.
template <class F>
void visit_image(AnyImage& image, const F& f) {
  std::visit([&](auto& typed) { std::visit(f, typed); }, image);
}
template <class F>
void visit_image(AnyImage5d& image, const F& f) {
  std::visit(f, image);
}
template <class F>
void visit_image(const AnyImage& image, const F& f) {
  std::visit([&](const auto& typed) { std::visit(f, typed); }, image);
}
template <class F>
void visit_image(const AnyImage5d& image, const F& f) {
  std::visit(f, image);
}

/// The values of samples next to a label that no sample has, for an error.
template <class Values>
std::string values_beside(const Values& values, double label) {
  double below = -std::numeric_limits<double>::infinity(), above = std::numeric_limits<double>::infinity();
  for (const auto each : values) {
    const auto value = static_cast<double>(each);
    if (value < label) below = std::max(below, value);
    if (value > label) above = std::min(above, value);
  }
  if (std::isinf(below) && std::isinf(above)) return "; all samples are missing";
  if (std::isinf(below)) return fmt::format("; expected one that samples have: the least is {}", number(above));
  if (std::isinf(above)) return fmt::format("; expected one that samples have: the greatest is {}", number(below));
  return fmt::format("; expected one that samples have, such as {} or {}", number(below), number(above));
}

/// Replaces an image by the mask of a label. Missing samples stay missing.
template <class AnyDimension>
void take_label(AnyDimension& image, double label, bool allow_empty) {
  AnyDimension mask;
  visit_image(image, [&]<Value T, int N>(OwnedImage<T, N>& from) {
    using Mask = std::conditional_t<std::is_floating_point_v<T>, float, std::uint8_t>;
    constexpr bool kOnlyReals = std::is_same_v<AnyDimension, AnyImage5d>;
    using To = std::conditional_t<kOnlyReals, float, Mask>;
    OwnedImage<To, N> to{std::move(from.grid), detail::ValueVector<To>(from.values.size())};
    bool any = false;
    for (std::size_t i = 0; i < to.values.size(); ++i) {
      const auto value = static_cast<double>(from.values[i]);
      // 0.7 as a float is another number than as a double
      const bool is_labelled =
          value == (std::is_same_v<T, float> ? static_cast<double>(static_cast<float>(label)) : label);
      any = any || is_labelled;
      to.values[i] = static_cast<To>(is_labelled ? 1 : 0);
      if constexpr (std::is_floating_point_v<To>)
        if (std::isnan(value)) to.values[i] = std::numeric_limits<To>::quiet_NaN();
    }
    if (!any && !allow_empty)
      throw EmptyResult(
          fmt::format("--label {}: no sample has this value{}", number(label), values_beside(from.values, label)));
    if constexpr (kOnlyReals)
      mask = std::move(to);
    else
      mask = AnyImageN<N>(std::move(to));
  });
  image = std::move(mask);
}

bool has_isovalue(const ExtractionOptions& options) {
  const std::vector<std::string> given = options.given();
  return std::find(given.begin(), given.end(), "--iso") != given.end();
}

/// The two values of an image. Throws InvalidArgument if it has more or fewer.
template <class AnyDimension>
std::pair<double, double> two_values_of(const AnyDimension& image) {
  std::vector<double> found;
  visit_image(image, [&](const auto& owned) {
    for (const auto value : owned.values) {
      const auto wide = static_cast<double>(value);
      if (std::isnan(wide) || std::find(found.begin(), found.end(), wide) != found.end()) continue;
      found.push_back(wide);
      if (found.size() > 2) break;
    }
  });
  if (found.size() != 2)
    throw Error(ErrorCode::InvalidArgument,
                found.size() > 2
                    ? fmt::format("--iso is missing, and the image has more than two values, such as {}, {} and {}; "
                                  "expected --iso, or --label for the samples of one value",
                                  number(found[0]), number(found[1]), number(found[2]))
                    : "--iso is missing, and the image has less than two values; expected --iso");
  return std::minmax({found[0], found[1]});
}

}  // namespace

void PositionArguments::add_to(CLI::App& app) {
  app.add_option("--positions", rule_,
                 "where vertices lie between two samples: linear interpolation; relaxed: smooth surfaces of masks and "
                 "labels without stair steps; filtered: linear in a second image (--positions-image), clamped to the "
                 "side of each sample; gravitation: moved towards neighbouring samples, for masks")
      ->check(CLI::IsMember({"linear", "filtered", "gravitation", "relaxed"}))
      ->capture_default_str();
  app.add_option("--label", label_,
                 "the contour of a label image around the samples of this value: of 1 there and 0 elsewhere, at 1/2; "
                 "in place of --iso")
      ->type_name("NUMBER");
  app.get_option("--iso")->required(false);  // see isovalues
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

std::vector<SpelledNumber> PositionArguments::isovalues(const ExtractionOptions& options) const {
  if (has_label() && has_isovalue(options))
    throw Error(ErrorCode::InvalidArgument, fmt::format("--label {} with --iso; expected one of the two", label_));
  if (has_label()) return {{0.5, "0.5"}};
  if (finds_isovalue(options)) return {{std::numeric_limits<double>::quiet_NaN(), "{iso}"}};
  return options.isovalues();
}

bool PositionArguments::finds_isovalue(const ExtractionOptions& options) const {
  return !has_label() && rule_ == "relaxed" && !has_isovalue(options);
}

std::string PositionArguments::apply(std::variant<ReadImageResult, ReadImage5dResult>& input,
                                     std::vector<ContourResult>& results, bool allow_empty) const {
  if (has_label()) {
    const double label = parse_finite("--label", label_);
    std::visit([&](auto& read) { take_label(read.image, label, allow_empty); }, input);
    for (ContourResult& result : results) result.label = label;
    return "";
  }
  if (!std::isnan(*results.front().isovalue)) return "";
  const auto [low, high] = std::visit([](const auto& read) { return two_values_of(read.image); }, input);
  for (ContourResult& result : results) result.isovalue = low + (high - low) / 2;
  return fmt::format("no --iso: the isovalue is {}, the middle of the image's two values, {} and {}",
                     number(*results.front().isovalue), number(low), number(high));
}

void PositionArguments::refuse(const std::string& with) const {
  if (has_label() && (with == "--stream" || with == "--index" || with == "--facets"))
    throw Error(ErrorCode::InvalidArgument, fmt::format("--label {} with {}; expected one of the two", label_, with));
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
  if (file_.empty()) return;
  try {
    require_input(parse_file_and_variable(file_).file, Folders::allowed);
  } catch (const Error& error) {
    throw Error(error.code(), fmt::format("--positions-image {}", error.what()));
  }
}

PositionOptions PositionArguments::without_image() const {
  PositionOptions options;
  options.rule = rule_ == "filtered"      ? Positions::filtered
                 : rule_ == "gravitation" ? Positions::gravitation
                 : rule_ == "relaxed"     ? Positions::relaxed
                                          : Positions::linear;
  options.last_axis_weight = parse_finite("--last-axis-weight", weight_);
  return options;
}

PositionOptions PositionArguments::library_options_5d() const {
  if (!are_linear() && rule_ != "relaxed")
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("--positions {} with an image of 5 axes; expected --positions linear or relaxed", rule_));
  return without_image();
}

PositionOptions PositionArguments::library_options(const AnyImage& image, ReadImageOptions reading,
                                                   PositionValues& values) const {
  PositionOptions options = without_image();
  if (options.rule != Positions::filtered) return options;
  const FileAndVariable from = parse_file_and_variable(file_);
  reading.variable = from.variable;
  const ReadImageResult other = read_other_image(from.file, reading);
  if (other.info.lattice)  // its samples do not lie on a cubic grid
    throw Error(ErrorCode::UnsupportedData,
                fmt::format("--positions-image {} is on the lattice {}; expected an image on a cubic grid", file_,
                            name_of(*other.info.lattice)));
  const auto expected = sizes_of(image), actual = sizes_of(other.image);
  if (actual != expected)
    throw Error(ErrorCode::UnsupportedData,
                fmt::format("--positions-image {} has {} samples; expected {}, as the image", file_,
                            fmt::join(actual, " x "), fmt::join(expected, " x ")));
  const auto copy = [&]<Value T, int N>(const OwnedImage<T, N>& owned) {
    // float holds all integers of 16 bits, but not all of 32
    using Held = std::conditional_t<std::is_same_v<T, float> || sizeof(T) < sizeof(float), float, double>;
    options.filtered = values.emplace<std::vector<Held>>(owned.values.begin(), owned.values.end());
  };
  std::visit([&](const auto& typed) { std::visit(copy, typed); }, other.image);
  return options;
}

}  // namespace tegl::cli
