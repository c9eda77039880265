// SPDX-License-Identifier: BSD-3-Clause
//
// Units of time in the spellings of files: "h", "days since 2000-01-01", "Hours Since 1900-1-1 00:00:0.0 UTC".
#pragma once

#include <optional>
#include <string>

namespace tegl::io_detail {

/// A unit of time, with its reference time if it has one.
struct TimeUnit {
  std::string name;    ///< as spelled
  std::string since;   ///< reference time, as spelled; empty for durations
  double seconds = 0;  ///< length of the unit; 0 if unknown or variable, as for months
};

TimeUnit split_time_unit(const std::string& unit);

/// Converts a time between units; nullopt if that is not possible: for units other than ms to weeks, between durations
/// and times with a reference, and for different reference times unless both are after the Gregorian reform
/// (1582-10-15) and without a calendar of their own, as in "days since 1950-01-01 (noleap)".
std::optional<double> convert_time(double value, const std::string& from, const std::string& to);

}  // namespace tegl::io_detail
