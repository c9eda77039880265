// SPDX-License-Identifier: BSD-3-Clause
//
// Parses units of time and converts times between them.
#include "base/time_units.hpp"

#include <algorithm>
#include <chrono>
#include <initializer_list>
#include <regex>
#include <string_view>

#include "base/common.hpp"

namespace tegl::io_detail {

namespace {

/// Seconds of a unit, by its name; 0 for unknown units. (Months and years vary in length.)
double seconds_of(std::string_view name) {
  struct Unit {
    double seconds;
    std::initializer_list<std::string_view> names;
  };
  static const Unit kUnits[] = {{1e-3, {"ms", "msec", "msecs", "millisecond", "milliseconds"}},
                                {1, {"s", "sec", "secs", "second", "seconds"}},
                                {60, {"min", "mins", "minute", "minutes"}},
                                {3600, {"h", "hr", "hrs", "hour", "hours"}},
                                {86400, {"d", "day", "days"}},
                                {7 * 86400, {"week", "weeks"}}};
  const std::string small = lower(name);
  for (const Unit& unit : kUnits)
    if (std::find(unit.names.begin(), unit.names.end(), small) != unit.names.end()) return unit.seconds;
  return 0;
}

/// Seconds from 1970-01-01 UTC to the reference time of a unit; nullopt for other forms and dates before 1582-10-15.
std::optional<double> moment(const std::string& since) {
  static const std::regex kForm(
      R"((\d{1,6})-(\d{1,2})-(\d{1,2})(?:[T\s]\s*(\d{1,2})(?::(\d{1,2})(?::(\d{1,2}(?:\.\d*)?))?)?)?\s*)"
      R"((Z|UTC|GMT|([+-])(\d{1,2}):?(\d{2})?)?)",
      std::regex::icase);
  std::smatch found;
  if (!std::regex_match(since, found, kForm)) return std::nullopt;
  const auto whole = [&](std::size_t group) { return found[group].matched ? std::stoi(found[group]) : 0; };
  using namespace std::chrono;
  const year_month_day date{year(whole(1)), month(static_cast<unsigned>(whole(2))),
                            day(static_cast<unsigned>(whole(3)))};
  const double second = found[6].matched ? std::stod(found[6]) : 0.0;
  constexpr year_month_day kReform{year(1582), month(10), day(15)};
  if (!date.ok() || whole(1) > 32767 || date < kReform || whole(4) > 23 || whole(5) > 59 || second >= 60)
    return std::nullopt;
  const double zone = (found[8] == "-" ? -1.0 : 1.0) * (whole(9) * 3600.0 + whole(10) * 60.0);
  return static_cast<double>(sys_days(date).time_since_epoch().count()) * 86400.0 + whole(4) * 3600.0 +
         whole(5) * 60.0 + second - zone;
}

}  // namespace

TimeUnit split_time_unit(const std::string& unit) {
  static const std::regex kSince(R"(\s*(\S+)\s+since\s+(.*\S)\s*)", std::regex::icase);
  std::smatch found;
  if (!std::regex_match(unit, found, kSince)) return {unit, "", seconds_of(trim(unit))};
  return {found[1], found[2], seconds_of(found[1].str())};
}

std::optional<double> convert_time(double value, const std::string& from, const std::string& to) {
  if (from == to) return value;
  const TimeUnit own = split_time_unit(from);
  const TimeUnit wanted = split_time_unit(to);
  if (own.seconds == 0 || wanted.seconds == 0 || own.since.empty() != wanted.since.empty()) return std::nullopt;
  const double same = own.seconds == wanted.seconds ? value : value * own.seconds / wanted.seconds;
  if (own.since == wanted.since) return same;
  const std::optional<double> start = moment(own.since);
  const std::optional<double> origin = moment(wanted.since);
  if (!start || !origin) return std::nullopt;
  return same + (*start - *origin) / wanted.seconds;
}

}  // namespace tegl::io_detail
