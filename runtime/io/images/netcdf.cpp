// SPDX-License-Identifier: BSD-3-Clause
//
// Reads netCDF variables as images: selects the variable, reads coordinate variables as axes, applies packing and
// missing values.
//
// Based on: "NetCDF Climate and Forecast (CF) Metadata Conventions" 1.10, sections 2.5, 4, 5 and 8; the attribute
// conventions of the NetCDF Users' Guide.
#include "images/netcdf.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include <fmt/ranges.h>

#include "base/collected_values.hpp"
#include "base/common.hpp"
#include "base/reading_process.hpp"
#include "base/stored_integers.hpp"
#include "images/netcdf_file.hpp"
#include "images/netcdf_packing.hpp"

namespace tegl::io_detail {

namespace {

/// Number of dimensions longer than 1.
std::size_t rank(const std::vector<std::size_t>& sizes) {
  return static_cast<std::size_t>(std::count_if(sizes.begin(), sizes.end(), [](std::size_t size) { return size > 1; }));
}

bool is_image_rank(std::size_t axes) { return axes >= 2 && axes <= 5; }

/// Names and sizes of the dimensions longer than 1, fastest first.
ImageVariable describe(const NcFile& file, const NcVariable& variable) {
  ImageVariable result;
  result.name = variable.name;
  for (std::size_t d = variable.sizes.size(); d-- > 0;) {
    if (variable.sizes[d] == 1) continue;
    result.sizes.push_back(variable.sizes[d]);
    result.axes.push_back(file.dimension_name(variable, d));
  }
  return result;
}

/// The samples of a variable at fixed indices. Fixed dimensions that the variable does not have are ignored.
NcSlab slab_of(const NcFile& file, const NcVariable& variable, const std::vector<FixedIndex>& fixed) {
  NcSlab slab = whole(variable);
  for (std::size_t d = 0; d < variable.sizes.size() && !fixed.empty(); ++d) {
    const std::string name = file.dimension_name(variable, d);
    for (const FixedIndex& one : fixed) {
      if (one.dimension != name) continue;
      if (one.index >= variable.sizes[d])
        fail(ErrorCode::InvalidArgument, file.path(), "{}={}; expected an index from 0 to {} of the dimension of '{}'",
             name, one.index, variable.sizes[d] - std::min<std::size_t>(variable.sizes[d], 1), variable.name);
      slab.start[d] = one.index;
      slab.count[d] = 1;
    }
  }
  return slab;
}

/// Throws unless the variable has each fixed dimension, and each is given once.
void require_dimensions(const NcFile& file, const NcVariable& variable, const std::vector<FixedIndex>& fixed) {
  std::vector<std::string> names;
  for (std::size_t d = 0; d < variable.sizes.size(); ++d) names.push_back(file.dimension_name(variable, d));
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    const std::string& name = fixed[i].dimension;
    if (std::ranges::find(names, name) == names.end())
      fail(ErrorCode::InvalidArgument, file.path(), "variable '{}' has no dimension '{}'; expected one of {}",
           variable.name, name, fmt::join(names, ", "));
    for (std::size_t j = 0; j < i; ++j)
      if (fixed[j].dimension == name)
        fail(ErrorCode::InvalidArgument, file.path(), "two indices of the dimension '{}', {} and {}; expected one",
             name, fixed[j].index, fixed[i].index);
  }
}

/// The variables that are images, possibly after fixing some dimensions.
std::vector<NcVariable> image_variables(const NcFile& file, const std::vector<NcVariable>& all) {
  std::set<std::string, std::less<>> auxiliary;  // bounds or coordinates of other variables
  for (const NcVariable& variable : all)
    for (const char* attribute : {"bounds", "climatology", "coordinates", "cell_measures", "grid_mapping"}) {
      const std::string names = file.text(variable, attribute);
      for (const std::string_view word : words(names)) auxiliary.emplace(word);
    }
  std::vector<NcVariable> result;
  for (const NcVariable& variable : all) {
    const std::string plain = variable.name.substr(variable.name.rfind('/') + 1);
    const bool empty = std::find(variable.sizes.begin(), variable.sizes.end(), 0U) != variable.sizes.end();
    if (is_numeric(variable.type) && rank(variable.sizes) >= 2 && !empty && !auxiliary.contains(plain))
      result.push_back(variable);
  }
  return result;
}

/// Sizes of all dimensions, fastest first.
std::string image_shape(const NcVariable& variable) {
  return shape_text(std::vector<std::size_t>(variable.sizes.rbegin(), variable.sizes.rend()));
}

std::string listing(const std::vector<NcVariable>& variables) {
  std::vector<std::string> items;
  for (const NcVariable& variable : variables)
    items.push_back(fmt::format("{} ({})", variable.name, image_shape(variable)));
  return fmt::format("{}", fmt::join(items, ", "));
}

NcVariable choose(const NcFile& file, const std::vector<NcVariable>& all, const std::vector<NcVariable>& candidates,
                  const ReadImageOptions& options) {
  const std::string& wanted = options.variable;
  if (!wanted.empty()) {
    for (const NcVariable& variable : all)
      if (variable.name == wanted || variable.name == "/" + wanted) return variable;
    fail(ErrorCode::VariableNotFound, file.path(), "no variable '{}'; expected one of {}", wanted,
         candidates.empty() ? "none: no variable here has 2 or more axes" : listing(candidates));
  }
  if (candidates.size() == 1) return candidates[0];
  // one of 2 to 4 axes before one of 5
  std::vector<NcVariable> usual, fitting;
  for (const NcVariable& variable : candidates) {
    const std::size_t axes = rank(slab_of(file, variable, options.fixed).count);
    if (is_image_rank(axes)) fitting.push_back(variable);
    if (is_image_rank(axes) && axes < 5) usual.push_back(variable);
  }
  if (usual.size() == 1) return usual[0];
  if (fitting.size() == 1) return fitting[0];
  if (candidates.empty())
    fail(ErrorCode::UnsupportedData, file.path(), "no variable with 2 to 5 axes longer than 1; it has {}",
         all.empty() ? "no variables" : listing(all));
  fail(ErrorCode::VariableNotFound, file.path(), "{} variables, and none chosen; expected one of {}", candidates.size(),
       listing(candidates));
}

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

/// The grid of a variable, and the dimension that becomes the image's last axis: time, else the slowest one.
struct VariableGrid {
  RawGrid grid;
  std::vector<AxisDirection> directions;  ///< of the grid's axes
  std::size_t last_dimension = 0;
  std::size_t time_axis = 0;            ///< index of the last axis in the file, from the fastest
  bool has_time = false;                ///< whether the last axis is time
  std::vector<std::size_t> dimensions;  ///< of the variable, by axis
};

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

/// Moves the grid's last axis to the end; the values have the file's order and `count` samples along that axis.
ValueArray in_order(ValueArray&& values, const VariableGrid& grid, std::size_t count) {
  const std::vector<Axis>& axes = grid.grid.axes;
  std::size_t inner = 1;
  std::size_t outer = 1;
  for (std::size_t a = 0; a + 1 < axes.size(); ++a) (a < grid.time_axis ? inner : outer) *= axes[a].size();
  return outer == 1 || count == 1 ? std::move(values) : with_axis_last(values, inner, count, outer);
}

// ---- coordinates in arrays of two or more dimensions (CF conventions, section 5.2) ---------------------------------

enum class Coordinate { other, longitude, latitude, vertical };

Coordinate coordinate_of(const NcFile& file, const NcVariable& variable) {
  const std::string unit = lower(file.text(variable, "units"));
  const std::string name = lower(file.text(variable, "standard_name"));
  const auto is_degrees = [&](std::string_view to) {
    return unit.starts_with("degree") && (unit.ends_with(to) || unit.ends_with(fmt::format("_{}", to.substr(0, 1))));
  };
  if (name == "longitude" || is_degrees("_east")) return Coordinate::longitude;
  if (name == "latitude" || is_degrees("_north")) return Coordinate::latitude;
  if (lower(file.text(variable, "axis")) == "z" || !file.text(variable, "positive").empty())
    return Coordinate::vertical;
  return Coordinate::other;
}

/// A coordinate variable with the axes of the image that it differs along.
struct CurvedVariable {
  NcVariable variable;
  std::vector<std::size_t> axes;  ///< by dimension, fastest first; only those of which more than one index is read
  unsigned along = 0;
};

/// The variables that the attribute "coordinates" names and that differ along two or more axes of the image, by
/// meaning.
std::map<Coordinate, CurvedVariable> curved_variables(const NcFile& file, const NcVariable& of,
                                                      const VariableGrid& grid, std::vector<std::string>& remarks) {
  std::map<Coordinate, CurvedVariable> result;
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
      if (one.axes.size() >= 2)
        result.emplace(meaning, std::move(one));
      else if (one.axes.size() == 1 && meaning != Coordinate::other)
        remarks.push_back(
            fmt::format("the coordinate '{}' is not used: one index is read of its other dimensions; the axis "
                        "'{}' has indices or its own coordinates",
                        variable.name, grid.grid.axes[one.axes.front()].name));
    }
  result.erase(Coordinate::other);
  return result;
}

/// Continues longitudes across 360 degrees, from each value to the next.
void unwrap(std::vector<double>& longitudes, std::size_t row) {
  double first = std::numeric_limits<double>::quiet_NaN();
  double last = first;
  for (std::size_t i = 0; i < longitudes.size(); ++i) {
    const double& reference = i % row == 0 && !std::isnan(first) ? first : last;
    double& value = longitudes[i];
    if (std::isnan(value)) continue;
    if (!std::isnan(reference)) value += 360.0 * std::round((reference - value) / 360.0);
    if (i % row == 0) first = value;
    last = value;
  }
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

/// The curved axes of the image; the grid then has indices there. Longitude and latitude are used if their axes have no
/// coordinate variables of their own.
std::vector<CurvedAxis> find_curved(const NcFile& file, const NcVariable& variable, const NcSlab& slab,
                                    VariableGrid& grid, std::vector<std::string>& remarks) {
  std::vector<Axis>& axes = grid.grid.axes;
  std::vector<CurvedAxis> result;
  const auto variables = curved_variables(file, variable, grid, remarks);
  const auto add = [&](const CurvedVariable& one, std::size_t axis) {
    Axis indices = Axis::uniform(axes[axis].size());
    indices.name = axes[axis].name;
    axes[axis] = std::move(indices);
    result.push_back({static_cast<int>(axis), one.along, read_curved(file, variable, slab, one, axes),
                      one.variable.name.substr(one.variable.name.rfind('/') + 1), file.text(one.variable, "units")});
    grid.directions[axis] = direction_of(file, one.variable);
  };
  const std::size_t in_space = axes.size() - (grid.has_time ? 1 : 0);
  unsigned taken = 0;
  const auto longitude = variables.find(Coordinate::longitude);
  const auto latitude = variables.find(Coordinate::latitude);
  if (longitude != variables.end() && latitude != variables.end() &&
      longitude->second.along == latitude->second.along) {
    std::vector<std::size_t> two;
    for (std::size_t a = 0; a < in_space && two.size() < 2; ++a)
      if ((longitude->second.along >> a & 1u) != 0 && !file.coordinate(variable, grid.dimensions[a])) two.push_back(a);
    if (two.size() == 2) {
      add(longitude->second, two[0]);
      unwrap(result.back().values, axes[two[0]].size());
      add(latitude->second, two[1]);
      taken = 1u << two[0] | 1u << two[1];
    }
  }
  if (const auto vertical = variables.find(Coordinate::vertical); vertical != variables.end())
    for (std::size_t a = in_space; a-- > 0;)
      if ((vertical->second.along & ~taken) >> a & 1u) {
        add(vertical->second, a);
        break;
      }
  return result;
}

/// Makes samples with unknown coordinates missing, if the values have a missing value.
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

struct Found {
  NcVariable variable;
  NcSlab slab;
  ImageInfo info;
};

/// Throws unless the selected samples of a variable form an image.
void require_image(const NcFile& file, const NcVariable& variable, const NcSlab& slab) {
  if (std::find(variable.sizes.begin(), variable.sizes.end(), 0U) != variable.sizes.end())
    fail(ErrorCode::UnsupportedData, file.path(), "variable '{}' is {}; expected at least one sample", variable.name,
         image_shape(variable));
  const std::size_t axes = rank(slab.count);
  if (is_image_rank(axes)) return;
  const bool is_fixed = axes < rank(variable.sizes);
  if (axes < 2)
    fail(ErrorCode::UnsupportedData, file.path(), "variable '{}' is {}{}; expected 2 to 5 axes longer than 1",
         variable.name, variable.sizes.empty() ? "a single value" : image_shape(variable),
         is_fixed ? fmt::format(", of which the fixed indices leave {}", axes) : "");
  const ImageVariable described = describe(file, variable);
  fail(ErrorCode::UnsupportedData, file.path(),
       "variable '{}' is {} ({}){}; expected 2 to 5 axes longer than 1, or a fixed index of another dimension, such "
       "as {}=0",
       variable.name, shape_text(described.sizes), fmt::join(described.axes, ", "),
       is_fixed ? fmt::format(", of which the fixed indices leave {}", axes) : "", described.axes.back());
}

/// Throws unless only the slowest dimensions have one index: times of images on a lattice.
void require_whole_lattice(const NcFile& file, Lattice lattice, const NcSlab& slab) {
  const auto first = std::ranges::find_if(slab.count, [](std::size_t count) { return count > 1; });
  if (std::find(first, slab.count.end(), 1U) != slab.count.end())
    fail(ErrorCode::UnsupportedData, file.path(),
         "one index of a dimension of samples on the lattice {}; expected all of its samples", name_of(lattice));
}

/// Finds the requested variable, and checks that it can be an image.
Found find_variable(const NcFile& file, const ReadImageOptions& options) {
  const auto all = file.variables();
  const auto candidates = image_variables(file, all);
  const NcVariable variable = choose(file, all, candidates, options);
  require_dimensions(file, variable, options.fixed);
  const NcSlab slab = slab_of(file, variable, options.fixed);
  require_image(file, variable, slab);
  ImageInfo info;
  info.format = "netCDF";
  info.variable = variable.name;
  for (const NcVariable& candidate : candidates) info.variables.push_back(candidate.name);
  info.value_unit = file.text(variable, "units");
  info.value_name = file.text(variable, "long_name");
  if (info.value_name.empty()) info.value_name = file.text(variable, "standard_name");
  info.stored_type = parse_value_type(nc_type_name(variable.type));
  info.lattice = lattice_of_text(file.text(variable, kLatticeKey), file.path());
  if (info.lattice && !options.as_cubic) require_whole_lattice(file, *info.lattice, slab);
  return {variable, slab, info};
}

/// Restricts a slab to `count` layers along a dimension, from layer `first`.
NcSlab layers_of(NcSlab slab, std::size_t dimension, std::size_t first, std::size_t count) {
  slab.start[dimension] = first;
  slab.count[dimension] = count;
  return slab;
}

/// Reads and unpacks the values of a slab, block by block unless they stay as they are stored.
ValueArray unpacked_values(const NcFile& file, const NcVariable& variable, const NcSlab& slab, const Packing& packing,
                           const Progress& progress) {
  const bool is_real = variable.type == NC_FLOAT || variable.type == NC_DOUBLE;
  // blocks of layers along the slowest dimension with more than one sample: they are contiguous in memory
  std::size_t along = 0;
  while (along + 1 < slab.count.size() && slab.count[along] == 1) ++along;
  std::size_t layer = 1;
  for (std::size_t d = along + 1; d < slab.count.size(); ++d) layer *= slab.count[d];
  const std::size_t layers = slab.count.empty() ? 0 : slab.count[along];
  if (layers * layer <= CollectedValues::kBlock || (!is_real && !packing.any_attribute))
    return unpack(file.values(variable, slab, progress), packing);
  if (is_real && file.is_one_piece(variable, slab))
    return file.values(variable, slab, progress, [&](ValueArray& values, std::size_t first, std::size_t count) {
      unpack_reals(values, first, count, packing);
    });
  file.require_stored(variable, slab);
  expect_memory(kBytesPerValue * layers * layer);                // of all blocks: they are collected in one array
  const std::size_t chunk = file.block_length(variable, along);  // no chunk is read twice
  const std::size_t step = std::max<std::size_t>(1, CollectedValues::kBlock / layer / chunk) * chunk;
  CollectedValues all(layers * layer);
  for (std::size_t first = 0; first < layers; first += step) {
    const std::size_t count = std::min(step, layers - first);
    const auto of_all = [&](double fraction) {
      return progress((static_cast<double>(first) + fraction * static_cast<double>(count)) /
                      static_cast<double>(layers));
    };
    NcSlab part = slab;
    part.start[along] += first;
    part.count[along] = count;
    all.add(unpack(file.values(variable, part, progress ? Progress(of_all) : Progress()), packing));
  }
  return all.take();
}

/// Reads the values of a slab as they are stored and sets their scaling; unpacked if that is not possible.
ValueArray stored_values(const NcFile& file, const NcVariable& variable, const NcSlab& slab, const Packing& packing,
                         const Progress& progress, std::optional<ValueScaling>& scaling) {
  if (variable.type == NC_FLOAT || variable.type == NC_DOUBLE)
    return unpacked_values(file, variable, slab, packing, progress);
  ValueArray values = file.values(variable, slab, progress);
  scaling = stored_scaling(values, packing);
  if (!scaling) return unpack(std::move(values), packing);
  return scaling->slope < 0 ? in_reverse_order(std::move(values)) : std::move(values);
}

}  // namespace

RawImage read_netcdf(const std::filesystem::path& path, Extent extent, const ReadImageOptions& options) {
  // header
  const NcFile file(path, options.work.progress, options.allow_outside_paths);
  Found found = find_variable(file, options);
  VariableGrid grid = read_grid(file, found.variable, found.slab);
  found.info.curved = find_curved(file, found.variable, found.slab, grid, found.info.remarks);
  found.info.axis_directions = std::move(grid.directions);
  // values
  RawImage image;
  const Packing packing = read_packing(file, found.variable);
  const NcSlab slab = extent == Extent::header ? layers_of(found.slab, grid.last_dimension, 0, 0) : found.slab;
  if (options.keep_stored && packing.any_attribute && found.info.curved.empty())
    image.values = stored_values(file, found.variable, slab, packing, options.work.progress, found.info.scaling);
  else
    image.values = unpacked_values(file, found.variable, slab, packing, options.work.progress);
  if (extent == Extent::whole) image.values = in_order(std::move(image.values), grid, grid.grid.axes.back().size());
  if (extent == Extent::whole) hide_unknown(found.info.curved, grid.grid.axes, image.values);
  image.grid = std::move(grid.grid);
  image.info = std::move(found.info);
  return image;
}

RawLayers open_netcdf_layers(const std::filesystem::path& path, const ReadImageOptions& options) {
  const auto file = std::make_shared<const NcFile>(path, options.work.progress, options.allow_outside_paths);
  if (file->is_compressed())
    fail(ErrorCode::UnsupportedData, path,
         "is compressed as a whole and cannot be read layer by layer; expected an uncompressed file");
  Found found = find_variable(*file, options);
  file->require_stored(found.variable, found.slab);
  VariableGrid grid = read_grid(*file, found.variable, found.slab);
  found.info.curved = find_curved(*file, found.variable, found.slab, grid, found.info.remarks);
  found.info.axis_directions = grid.directions;
  const Packing packing = read_packing(*file, found.variable);
  expect_memory(2 * file->chunk_bytes(found.variable, sizeof(double)));
  return {grid.grid, found.info, file->block_length(found.variable, grid.last_dimension),
          [file, packing, grid, variable = found.variable, slab = found.slab](std::size_t first, std::size_t count) {
            const NcSlab layers = layers_of(slab, grid.last_dimension, first, count);
            return in_order(unpack(file->values(variable, layers), packing), grid, count);
          }};
}

std::vector<ImageVariable> list_netcdf(const std::filesystem::path& path, bool allow_outside_paths) {
  const NcFile file(path, {}, allow_outside_paths);
  std::vector<ImageVariable> result;
  for (const NcVariable& variable : image_variables(file, file.variables())) {
    ImageVariable& entry = result.emplace_back(describe(file, variable));
    entry.unit = file.text(variable, "units");
    entry.long_name = file.text(variable, "long_name");
  }
  return result;
}

}  // namespace tegl::io_detail
