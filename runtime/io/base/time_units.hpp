// SPDX-License-Identifier: BSD-3-Clause
//
// Units of time as files spell them: "h", "days since 2000-01-01", "Hours Since 1900-1-1 00:00:0.0 UTC".
#pragma once

#include <optional>
#include <string>

namespace tegl::io_detail {

/// A unit of time and, if it counts from a moment, that moment.
struct TimeUnit {
  std::string name;    ///< as it is spelled
  std::string since;   ///< likewise; empty: of durations
  double seconds = 0;  ///< how long it is; 0: unknown, or of no one length, as months
};

TimeUnit split_time_unit(const std::string& unit);

/// What a number of one unit is in another; nothing where that is not known: of units of other lengths than ms to
/// weeks, of durations and moments, and of moments that are not both after the Gregorian reform (1582-10-15) or in a
/// calendar of its own, as in "days since 1950-01-01 (noleap)", unless both count from the same one.
std::optional<double> convert_time(double value, const std::string& from, const std::string& to);

}  // namespace tegl::io_detail
