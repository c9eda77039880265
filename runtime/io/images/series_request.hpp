// SPDX-License-Identifier: BSD-3-Clause
//
// A user's request for a file series, for the program and the Python package: its checks, with the names of the user
// interface in error messages.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tegl/error.hpp"
#include "tegl/io/series.hpp"

namespace tegl {

/// A user's request for a series. Each option may be missing.
struct SeriesRequest {
  std::string variable = {};                      ///< as in SeriesOptions
  std::optional<std::vector<double>> times = {};  ///< coordinate of each file along the new axis
  std::optional<double> time_step = {};           ///< or the distance between adjacent files
  std::optional<std::string> time_unit = {};      ///< unit of the new axis
  std::optional<SeriesOrder> sort = {};           ///< order of the files
  std::optional<RawLayout> raw = {};              ///< as in SeriesOptions
  std::vector<FixedIndex> fixed = {};             ///< as in SeriesOptions
  bool allow_outside_paths = false;               ///< as in SeriesOptions
};

/// The names of these options in error messages, as the user interface has them: "--times" on a command line.
struct SeriesWords {
  std::string_view times = {};      ///< for SeriesRequest::times
  std::string_view time_step = {};  ///< for SeriesRequest::time_step
  std::string_view time_unit = {};  ///< for SeriesRequest::time_unit
  std::string_view sort = {};       ///< for SeriesRequest::sort
  std::string_view by_time = {};    ///< for the value SeriesOrder::coordinate
  std::string_view by_name = {};    ///< for the value SeriesOrder::by_name
  std::string_view given = {};      ///< for the value SeriesOrder::given
};

/// Converts a request to options, and checks that it is consistent and fits the files. Errors, all InvalidArgument with
/// the names of `words`: options for several files with one file; `times` with `time_step`; a step with an order by
/// times; a number of times other than the number of files; a step of 0; and files without `sort` in the order of a
/// shell, frame_10 before frame_2, because a contour through these looks right and is wrong. (DICOM files have their
/// own positions and may be in any order.)
SeriesOptions series_options(std::span<const std::filesystem::path> files, const SeriesRequest& request,
                             const SeriesWords& words);

/// Text to append to an error of read_series or open_series: if the files are not in monotone order, it names the
/// conflicting options. Else empty.
std::string series_hint(const Error& error, const SeriesOptions& options, const SeriesWords& words);

}  // namespace tegl
