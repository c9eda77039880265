// SPDX-License-Identifier: BSD-3-Clause
//
// Converts a user's request for a file series to options, with checks.
#include "images/series_request.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace tegl {

namespace fs = std::filesystem;

namespace {

/// Throws if an option for several files is used with one file.
void require_several(std::span<const fs::path> files, const SeriesRequest& request, const SeriesWords& words) {
  if (files.size() != 1) return;
  for (const auto& [is_given, word] :
       {std::pair(request.times.has_value(), &words.times), std::pair(request.time_step.has_value(), &words.time_step),
        std::pair(request.time_unit.has_value(), &words.time_unit), std::pair(request.sort.has_value(), &words.sort)})
    if (is_given)
      throw Error(
          ErrorCode::InvalidArgument,
          fmt::format("{} with one file, {}; expected several files that become one image", *word, files[0].string()));
}

/// Throws if the files are in a shell's order, with frame_10 before frame_2.
void require_order_that_is_meant(std::span<const fs::path> files, const SeriesWords& words) {
  for (std::size_t i = 1; i < files.size(); ++i) {
    const std::string& a = files[i - 1].native();
    const std::string& b = files[i].native();
    if (a < b && natural_less(b, a))
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("{} comes before {}, as shells list names; expected {} for the order of the numbers in "
                              "them, or {} for this one",
                              a, b, words.by_name, words.given));
  }
}

}  // namespace

SeriesOptions series_options(std::span<const fs::path> files, const SeriesRequest& request, const SeriesWords& words) {
  const auto refuse = [](const std::string& text) { throw Error(ErrorCode::InvalidArgument, text); };
  require_several(files, request, words);
  if (request.times && request.time_step)
    refuse(fmt::format("{} with {}; expected one of the two", words.times, words.time_step));
  if (request.sort == SeriesOrder::coordinate && request.time_step)
    refuse(fmt::format("{} with {}, which follows the order; expected {}, or those of the headers", words.by_time,
                       words.time_step, words.times));
  if (request.times && request.times->size() != files.size())
    refuse(fmt::format("{} has {} numbers for {} files; expected one for each", words.times, request.times->size(),
                       files.size()));
  if (request.time_step && std::isfinite(*request.time_step) && !std::isnormal(*request.time_step))
    refuse(fmt::format("{} is {}; expected a number of a size of at least {:.2g}", words.time_step, *request.time_step,
                       std::numeric_limits<double>::min()));
  if (request.raw && !request.fixed.empty())
    refuse(fmt::format("an index of the dimension '{}' with raw values, whose dimensions have no names; expected none",
                       request.fixed[0].dimension));
  if (!request.sort && (request.raw || !are_dicom_files(files))) require_order_that_is_meant(files, words);
  SeriesOptions options;
  options.variable = request.variable;
  options.coordinates = request.times.value_or(std::vector<double>());
  options.step = request.time_step;
  options.unit = request.time_unit.value_or("");
  options.order = request.sort.value_or(SeriesOrder::given);
  options.raw = request.raw;
  options.fixed = request.fixed;
  options.allow_outside_paths = request.allow_outside_paths;
  return options;
}

std::string series_hint(const Error& error, const SeriesOptions& options, const SeriesWords& words) {
  if (error.code() != ErrorCode::InvalidArgument || options.order != SeriesOrder::by_name ||
      options.coordinates.empty())
    return "";
  return fmt::format(" ({}, with {}, which go with the files as listed)", words.by_name, words.times);
}

}  // namespace tegl
