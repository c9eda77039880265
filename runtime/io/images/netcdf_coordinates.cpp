// SPDX-License-Identifier: BSD-3-Clause
//
// Reads the coordinates of netCDF variables: coordinate variables as axes, and coordinates in arrays of two or more
// dimensions as curved axes.
//
// Based on: "NetCDF Climate and Forecast (CF) Metadata Conventions" 1.10, sections 4 and 5.
#include "images/netcdf_coordinates.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include <fmt/ranges.h>

#include "base/common.hpp"
#include "images/netcdf_packing.hpp"
#include "tegl/curved.hpp"

namespace tegl::io_detail {

namespace {

/// Uniform only if that gives the same coordinates bit by bit.
Axis make_axis(std::vector<double> coordinates) {
  const std::size_t size = coordinates.size();
  if (size >= 2)
    for (const double step :
         {coordinates[1] - coordinates[0], (coordinates[size - 1] - coordinates[0]) / static_cast<double>(size - 1)}) {
      if (step == 0.0 || !std::isfinite(step) || !std::isfinite(coordinates[0])) continue;
      const Axis uniform = Axis::uniform(size, coordinates[0], step);
      bool equal = true;
      for (std::size_t i = 0; i < size && equal; ++i) equal = uniform[i] == coordinates[i];
      if (equal) return uniform;
    }
  return Axis::rectilinear(std::move(coordinates));
}

enum class Coordinate { other, longitude, latitude, vertical, projected_x, projected_y };

Coordinate coordinate_of(const NcFile& file, const NcVariable& variable) {
  const std::string unit = lower(file.text(variable, "units"));
  const std::string name = lower(file.text(variable, "standard_name"));
  const std::string axis = lower(file.text(variable, "axis"));
  const auto is_degrees = [&](std::string_view to) {  // degrees_east, degree_E, degreesE
    if (!unit.starts_with("degree")) return false;
    const std::string_view rest = std::string_view(unit).substr(unit.starts_with("degrees") ? 7 : 6);
    const std::string_view letter = to.substr(0, 1);
    return rest == letter || (rest.starts_with('_') && (rest.substr(1) == letter || rest.substr(1) == to));
  };
  if (name == "longitude" || is_degrees("east")) return Coordinate::longitude;
  if (name == "latitude" || is_degrees("north")) return Coordinate::latitude;
  if (name == "projection_x_coordinate" || axis == "x") return Coordinate::projected_x;
  if (name == "projection_y_coordinate" || axis == "y") return Coordinate::projected_y;
  if (axis == "z" || !file.text(variable, "positive").empty()) return Coordinate::vertical;
  return Coordinate::other;
}

/// Coordinates of larger size, such as 1e20, are no places but mark missing ones.
struct Limit {
  double most;
  std::string_view expected;
};

Limit limit_of(Coordinate coordinate) {
  if (coordinate == Coordinate::longitude) return {720.0, "-720 to 720"};  // also of other turns
  if (coordinate == Coordinate::latitude) return {90.01, "-90 to 90"};     // rounded numbers
  return {1e19, "at most 1e19"};
}

/// Whether numbers ascend or descend strictly.
bool is_monotonic(const std::vector<double>& values) {
  return std::ranges::adjacent_find(values, std::greater_equal()) == values.end() ||
         std::ranges::adjacent_find(values, std::less_equal()) == values.end();
}

/// From the attribute "positive" of a vertical coordinate. Without it, pressures increase downwards (CF conventions,
/// section 4.3).
AxisDirection direction_of(const NcFile& file, const NcVariable& coordinate) {
  static constexpr std::array<std::string_view, 21> kPressures = {
      "pa",         "pascal",      "pascals", "hpa",  "hectopascal", "hectopascals", "kpa",
      "kilopascal", "kilopascals", "bar",     "bars", "mb",          "mbar",         "mbars",
      "millibar",   "millibars",   "db",      "dbar", "dbars",       "decibar",      "decibars"};
  const std::string positive = lower(file.text(coordinate, "positive"));
  if (positive == "down") return AxisDirection::down;
  if (positive == "up") return AxisDirection::up;
  const std::string unit = lower(file.text(coordinate, "units"));
  return std::ranges::find(kPressures, unit) != kPressures.end() ? AxisDirection::down : AxisDirection::unknown;
}

/// Whether a time unit's reference date is before 1582-10-15, when the standard calendar changes from Julian to
/// Gregorian.
bool starts_before_the_reform(const std::string& unit) {
  int year = 0;
  int month = 1;
  int day = 1;
  const std::size_t start = unit.find(" since ");
  if (start == std::string::npos || std::sscanf(unit.c_str() + start + 7, "%d-%d-%d", &year, &month, &day) < 1)
    return true;
  return std::tuple(year, month, day) < std::tuple(1582, 10, 15);
}

/// The unit, with the calendar appended if it is not the standard one (CF conventions, section 4.4.1): "days since
/// 2000-01-01 (noleap)" must not be read as a date, nor "days since 0001-01-01 (proleptic_gregorian)" as a Julian one.
std::string unit_of(const NcFile& file, const NcVariable& coordinate) {
  const std::string unit = file.text(coordinate, "units");
  const std::string calendar = file.text(coordinate, "calendar");
  const std::string known = lower(calendar);
  const bool is_common = known.empty() || known == "standard" || known == "gregorian" ||
                         (known == "proleptic_gregorian" && !starts_before_the_reform(unit));
  return is_common || unit.find(" since ") == std::string::npos ? unit : fmt::format("{} ({})", unit, calendar);
}

/// An axis with its direction in the file.
struct AxisOfFile {
  Axis axis;
  AxisDirection direction = AxisDirection::unknown;
  bool is_time = false;
};

AxisOfFile read_axis(const NcFile& file, const NcVariable& variable, std::size_t dimension) {
  const std::string name = file.dimension_name(variable, dimension);
  const auto coordinate = file.coordinate(variable, dimension);
  Axis axis = Axis::uniform(variable.sizes[dimension]);
  std::string unit;
  std::string role;
  AxisDirection direction = AxisDirection::unknown;
  if (coordinate) {
    std::vector<double> values =
        std::visit([](const auto& stored) { return std::vector<double>(stored.begin(), stored.end()); },
                   unpack(file.values(*coordinate, whole(*coordinate)), read_packing(file, *coordinate)));
    const Coordinate meaning = coordinate_of(file, *coordinate);
    const auto [most, expected] = limit_of(meaning);
    const auto wrong = std::ranges::find_if(values, [most = most](double x) { return std::abs(x) > most; });
    if (wrong != values.end() && (meaning == Coordinate::longitude || meaning == Coordinate::latitude))
      fail(ErrorCode::MalformedFile, file.path(), "coordinate variable '{}': number {} is {}; expected degrees from {}",
           coordinate->name, wrong - values.begin(), *wrong, expected);
    if (meaning == Coordinate::longitude && !is_monotonic(values)) {
      std::vector<double> continued = values;
      continue_longitudes(continued, std::array{continued.size()});
      if (is_monotonic(continued)) values = std::move(continued);
    }
    try {
      axis = make_axis(std::move(values));
    } catch (const Error& e) {
      fail(e.code(), file.path(), "coordinate variable '{}': {}", coordinate->name, e.what());
    }
    unit = unit_of(file, *coordinate);
    direction = direction_of(file, *coordinate);
    role = file.text(*coordinate, "axis") + " " + file.text(*coordinate, "standard_name") + " ";
  }
  axis.name = name;
  axis.unit = unit;
  const bool is_time = role.starts_with("T ") || role.ends_with(" time ") ||
                       unit.find(" since ") != std::string::npos || lower(name) == "t" || lower(name) == "time";
  return {std::move(axis), direction, is_time};
}

/// Adds the coordinate of a dimension of which one index is read; times come first. Errors of its coordinate variable
/// are ignored.
void add_single(const NcFile& file, const NcVariable& variable, std::size_t dimension, std::size_t index,
                std::vector<SingleAxis>& singles) {
  try {
    const AxisOfFile all = read_axis(file, variable, dimension);
    Axis axis = Axis::uniform(1, all.axis[index]);
    axis.name = all.axis.name;
    axis.unit = all.axis.unit;
    singles.insert(all.is_time ? singles.begin() : singles.end(), SingleAxis{std::move(axis), all.direction});
  } catch (const Error&) {
    return;
  }
}

// ---- coordinates in arrays of two or more dimensions (CF conventions, section 5.2) ---------------------------------

/// A coordinate variable with the axes of the image that it differs along.
struct CurvedVariable {
  NcVariable variable;
  std::vector<std::size_t> axes;  ///< by dimension, fastest first; only those of which more than one index is read
  unsigned along = 0;
};

using CurvedVariables = std::multimap<Coordinate, CurvedVariable>;

/// The variables that the attribute "coordinates" names and that differ along two or more axes of the image, by
/// meaning: the first of each, and all others.
CurvedVariables curved_variables(const NcFile& file, const NcVariable& of, const VariableGrid& grid,
                                 std::vector<std::string>& remarks) {
  CurvedVariables result;
  const std::string names = file.text(of, "coordinates");
  const std::vector<NcVariable> all = file.variables();
  for (const std::string_view word : words(names))
    for (const NcVariable& variable : all) {
      if (variable.name.substr(variable.name.rfind('/') + 1) != word || !is_numeric(variable.type)) continue;
      CurvedVariable one{variable, {}, 0};
      bool is_known = true;
      for (std::size_t d = variable.dimensions.size(); d-- > 0;) {
        const auto found = std::ranges::find(of.dimensions, variable.dimensions[d]);
        is_known = is_known && found != of.dimensions.end();
        const auto dimension = static_cast<std::size_t>(found - of.dimensions.begin());
        const auto axis = std::ranges::find(grid.dimensions, dimension);
        if (!is_known || axis == grid.dimensions.end()) continue;
        one.axes.push_back(static_cast<std::size_t>(axis - grid.dimensions.begin()));
        one.along |= 1u << one.axes.back();
      }
      if (!is_known || variable.dimensions.size() < 2) continue;
      const Coordinate meaning = coordinate_of(file, variable);
      if (one.axes.size() >= 2) {
        if (meaning == Coordinate::other || !result.contains(meaning)) result.emplace(meaning, std::move(one));
      } else if (one.axes.size() == 1 && meaning != Coordinate::other)
        remarks.push_back(
            fmt::format("the coordinate '{}' is not used: one index is read of its other dimensions; the axis "
                        "'{}' has indices or its own coordinates",
                        variable.name, grid.grid.axes[one.axes.front()].name));
    }
  return result;
}

/// Adds a remark on two or more coordinates of unknown meaning along two axes that have no others. `two_free`: see
/// find_curved.
template <class TwoFree>
void remark_on_unused(const CurvedVariables& variables, const TwoFree& two_free, std::vector<std::string>& remarks) {
  std::vector<std::string> names;
  for (auto [at, end] = variables.equal_range(Coordinate::other); at != end; ++at)
    if (two_free(at->second.along) != 0) names.push_back(fmt::format("'{}'", at->second.variable.name));
  if (names.size() < 2) return;
  remarks.push_back(fmt::format(
      "the coordinates {} are not used, and the axes have indices: they are neither longitude and latitude nor x and y "
      "by their attributes 'axis' (X and Y) or 'standard_name' (projection_x_coordinate, projection_y_coordinate)",
      fmt::join(names, ", ")));
}

/// The sizes of the axes that a coordinate differs along, fastest first.
std::vector<std::size_t> sizes_along(const CurvedVariable& one, const std::vector<Axis>& axes) {
  std::vector<std::size_t> sizes;
  for (std::size_t a = 0; a < axes.size(); ++a)
    if ((one.along >> a & 1u) != 0) sizes.push_back(axes[a].size());
  return sizes;
}

/// Makes coordinates missing that are too large to be places, and adds a remark on them.
void hide_large(Coordinate meaning, const CurvedVariable& one, const std::vector<Axis>& axes,
                std::vector<double>& values, std::vector<std::string>& remarks) {
  const auto [most, expected] = limit_of(meaning);
  const auto is_large = [most = most](double x) { return std::abs(x) > most; };
  const auto first = std::ranges::find_if(values, is_large);
  if (first == values.end()) return;
  std::vector<std::size_t> index;
  auto rest = static_cast<std::size_t>(first - values.begin());
  for (const std::size_t size : sizes_along(one, axes)) {
    index.push_back(rest % size);
    rest /= size;
  }
  const auto others = std::count_if(first + 1, values.end(), is_large);
  remarks.push_back(fmt::format("the coordinate '{}' is {} at ({}){}; expected {}: such places are unknown",
                                one.variable.name, *first, fmt::join(index, ", "),
                                others == 0 ? "" : fmt::format(", and too large at {} more", others), expected));
  std::ranges::replace_if(values, is_large, std::numeric_limits<double>::quiet_NaN());
}

/// The values of a coordinate variable, in the order of the image's axes.
std::vector<double> read_curved(const NcFile& file, const NcVariable& of, const NcSlab& slab, const CurvedVariable& one,
                                const std::vector<Axis>& axes) {
  NcSlab part = whole(one.variable);
  for (std::size_t d = 0; d < one.variable.dimensions.size(); ++d) {
    const auto j =
        static_cast<std::size_t>(std::ranges::find(of.dimensions, one.variable.dimensions[d]) - of.dimensions.begin());
    part.start[d] = slab.start[j];
    part.count[d] = slab.count[j];
  }
  const auto stored = std::visit([](const auto& values) { return std::vector<double>(values.begin(), values.end()); },
                                 unpack(file.values(one.variable, part), read_packing(file, one.variable)));
  // strides of the result by the variable's dimensions, fastest first
  std::vector<std::size_t> strides(one.axes.size(), 1);
  for (std::size_t i = 0; i < one.axes.size(); ++i)
    for (const std::size_t other : one.axes)
      if (other < one.axes[i]) strides[i] *= axes[other].size();
  std::vector<double> result(stored.size());
  for (std::size_t s = 0; s < stored.size(); ++s) {
    std::size_t at = 0;
    for (std::size_t i = 0, rest = s; i < one.axes.size(); rest /= axes[one.axes[i]].size(), ++i)
      at += rest % axes[one.axes[i]].size() * strides[i];
    result[at] = std::isfinite(stored[s]) ? stored[s] : std::numeric_limits<double>::quiet_NaN();
  }
  return result;
}

}  // namespace

VariableGrid read_grid(const NcFile& file, const NcVariable& variable, const NcSlab& slab) {
  VariableGrid result;
  // axes in the order of the file, from the fastest
  std::vector<Axis>& axes = result.grid.axes;
  std::vector<bool> is_time;
  std::vector<std::size_t> dimension_of;
  for (std::size_t d = variable.sizes.size(); d-- > 0;) {  // from the fastest dimension
    if (slab.count[d] == 1) {
      add_single(file, variable, d, slab.start[d], result.grid.single);
      continue;
    }
    AxisOfFile read = read_axis(file, variable, d);
    axes.push_back(std::move(read.axis));
    result.directions.push_back(read.direction);
    is_time.push_back(read.is_time);
    dimension_of.push_back(d);
  }
  // move time, or else the slowest axis, to the end; the scale of a scale space stays there
  const bool keeps_last = is_time.back() || axes.back().name == "log2_sigma";
  const auto found = keeps_last ? is_time.end() - 1 : std::find(is_time.begin(), is_time.end(), true);
  const std::ptrdiff_t last = found == is_time.end() ? std::ssize(axes) - 1 : found - is_time.begin();
  const auto move_last = [&](auto& list) { std::rotate(list.begin() + last, list.begin() + last + 1, list.end()); };
  move_last(axes);
  move_last(result.directions);
  result.has_time = found != is_time.end();
  result.time_axis = static_cast<std::size_t>(last);
  result.last_dimension = dimension_of[result.time_axis];
  move_last(dimension_of);
  result.dimensions = std::move(dimension_of);
  const auto n = static_cast<Eigen::Index>(axes.size());
  result.grid.linear = Eigen::MatrixXd::Identity(n, n);
  result.grid.offset = Eigen::VectorXd::Zero(n);
  return result;
}

std::vector<CurvedAxis> find_curved(const NcFile& file, const NcVariable& variable, const NcSlab& slab,
                                    VariableGrid& grid, std::vector<std::string>& remarks) {
  std::vector<Axis>& axes = grid.grid.axes;
  std::vector<CurvedAxis> result;
  const auto variables = curved_variables(file, variable, grid, remarks);
  const auto add = [&](const std::pair<const Coordinate, CurvedVariable>& found, std::size_t axis) {
    const auto& [meaning, one] = found;
    Axis indices = Axis::uniform(axes[axis].size());
    indices.name = axes[axis].name;
    axes[axis] = std::move(indices);
    std::vector<double> values = read_curved(file, variable, slab, one, axes);
    hide_large(meaning, one, axes, values, remarks);
    if (meaning == Coordinate::longitude) continue_longitudes(values, sizes_along(one, axes));
    result.push_back({static_cast<int>(axis), one.along, std::move(values),
                      one.variable.name.substr(one.variable.name.rfind('/') + 1), file.text(one.variable, "units")});
    grid.directions[axis] = direction_of(file, one.variable);
  };
  const std::size_t in_space = axes.size() - (grid.has_time ? 1 : 0);
  // the first two of these axes without coordinate variables of their own, as bits; 0: fewer
  const auto two_free = [&](unsigned along) {
    unsigned free = 0;
    for (std::size_t a = 0; a < in_space && std::popcount(free) < 2; ++a)
      if ((along >> a & 1u) != 0 && !file.coordinate(variable, grid.dimensions[a])) free |= 1u << a;
    return std::popcount(free) == 2 ? free : 0u;
  };
  unsigned taken = 0;
  for (const auto& [first, second] : {std::pair(Coordinate::longitude, Coordinate::latitude),
                                      std::pair(Coordinate::projected_x, Coordinate::projected_y)}) {
    const auto x = variables.find(first), y = variables.find(second);
    if (taken != 0 || x == variables.end() || y == variables.end() || x->second.along != y->second.along) continue;
    taken = two_free(x->second.along);
    if (taken == 0) continue;
    add(*x, static_cast<std::size_t>(std::countr_zero(taken)));
    add(*y, static_cast<std::size_t>(std::bit_width(taken) - 1));
  }
  if (taken == 0) remark_on_unused(variables, two_free, remarks);
  if (const auto vertical = variables.find(Coordinate::vertical); vertical != variables.end())
    for (std::size_t a = in_space; a-- > 0;)
      if ((vertical->second.along & ~taken) >> a & 1u) {
        add(*vertical, a);
        break;
      }
  return result;
}

void hide_unknown(const std::vector<CurvedAxis>& curved, const std::vector<Axis>& axes, ValueArray& values) {
  const auto hide = [&]<class T>(ValueVector<T>& all) {
    if constexpr (std::is_floating_point_v<T>)
      for (const CurvedAxis& one : curved) {
        if (std::ranges::none_of(one.values, [](double x) { return std::isnan(x); })) continue;
        for (std::size_t s = 0; s < all.size(); ++s) {
          std::size_t at = 0, stride = 1;
          for (std::size_t a = 0, rest = s; a < axes.size(); rest /= axes[a].size(), ++a) {
            if ((one.along >> a & 1u) == 0) continue;
            at += rest % axes[a].size() * stride;
            stride *= axes[a].size();
          }
          if (std::isnan(one.values[at])) all[s] = std::numeric_limits<T>::quiet_NaN();
        }
      }
  };
  std::visit(hide, values);
}

}  // namespace tegl::io_detail
