// SPDX-License-Identifier: BSD-3-Clause
//
// Combines several files to one image: checks that they match, computes coordinates along the new axis, and reads the
// values file by file.
#include "images/members.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "base/common.hpp"
#include "base/reading_process.hpp"
#include "base/time_units.hpp"
#include "tegl/curved.hpp"
#include "tegl/periodic.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

/// The header of one file of the series.
struct Member {
  fs::path path;
  RawGrid grid;
  ImageInfo info;
  std::size_t type = 0;  ///< index of ValueArray
  double at = 0;         ///< coordinate along the new axis
};

std::vector<std::size_t> sizes_of(const RawGrid& grid) {
  std::vector<std::size_t> sizes;
  for (const Axis& axis : grid.axes) sizes.push_back(axis.size());
  return sizes;
}

const char* name_of_type(std::size_t type) {
  ValueArray array;
  const auto search = [&]<std::size_t... I>(std::index_sequence<I...>) {
    ((I == type ? (void)(array = ValueArray(std::in_place_index<I>)) : void()), ...);
  };
  search(std::make_index_sequence<std::variant_size_v<ValueArray>>());
  return type_name(array);
}

/// Throws unless `member` has the same grid as `first`, within the tolerance.
void require_same_grid(const Member& member, const Member& first) {
  if (sizes_of(member.grid) != sizes_of(first.grid))
    fail(ErrorCode::UnsupportedData, member.path, "has {} samples; expected {}, as {}",
         shape_text(sizes_of(member.grid)), shape_text(sizes_of(first.grid)), first.path.string());
  constexpr double kTolerance = 1e-3;  // of a step; allows for rounding by writers
  // axes: unit and coordinates
  for (std::size_t a = 0; a < first.grid.axes.size(); ++a) {
    const Axis& axis = member.grid.axes[a];
    const Axis& expected = first.grid.axes[a];
    const std::string label = expected.name.empty() ? fmt::format("{}", a) : "'" + expected.name + "'";
    if (axis.unit != expected.unit)
      fail(ErrorCode::UnsupportedData, member.path, "has the axis {} in '{}'; expected '{}', as {}", label, axis.unit,
           expected.unit, first.path.string());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const double step = expected.size() < 2 ? expected.step()
                          : i == 0            ? expected[1] - expected[0]
                                              : expected[i] - expected[i - 1];
      if (std::abs(axis[i] - expected[i]) <= kTolerance * std::abs(step)) continue;
      if (i == 0)
        fail(ErrorCode::UnsupportedData, member.path, "has the origin {} along axis {}; expected {}, as {}", axis[0],
             label, expected[0], first.path.string());
      fail(ErrorCode::UnsupportedData, member.path,
           "has other steps along axis {}: sample {} lies at {}; expected {}, as {}", label, i, axis[i], expected[i],
           first.path.string());
    }
  }
  // World map: maximum displacement of the farthest corner, in steps of the finest axis.
  double least = std::abs(first.grid.axes[0].step());
  double extent = 1;
  for (const Axis& axis : first.grid.axes) {
    least = std::min(least, std::abs(axis.step()));
    extent = std::max(extent, static_cast<double>(axis.size()) * std::abs(axis.step()));
  }
  const bool turned = ((member.grid.linear - first.grid.linear).array().abs() * extent > kTolerance * least).any();
  const bool shifted = ((member.grid.offset - first.grid.offset).array().abs() > kTolerance * least).any();
  if (turned || shifted)
    fail(ErrorCode::UnsupportedData, member.path, "has another {} in space than {}; expected the same",
         turned ? "orientation" : "origin", first.path.string());
}

/// "cubic" for none.
std::string_view name_of_lattice(std::optional<Lattice> lattice) { return lattice ? name_of(*lattice) : "cubic"; }

/// The lattice of images on `lattice` over time.
std::optional<Lattice> lattice_in_time(std::optional<Lattice> lattice, const fs::path& path) {
  if (!lattice) return std::nullopt;
  if (*lattice != Lattice::fcc)
    fail(ErrorCode::UnsupportedData, path,
         "is on the lattice {}, and one of several files; expected files on the lattice fcc or cubic ones",
         name_of(*lattice));
  return Lattice::fcc_in_time;
}

void require_same(const Member& member, const Member& first) {
  if (member.type != first.type)
    fail(ErrorCode::UnsupportedData, member.path, "has values of type {}; expected {}, as {}",
         name_of_type(member.type), name_of_type(first.type), first.path.string());
  if (member.info.value_unit != first.info.value_unit)
    fail(ErrorCode::UnsupportedData, member.path, "has values in '{}'; expected '{}', as {}", member.info.value_unit,
         first.info.value_unit, first.path.string());
  if (member.info.world_frame != first.info.world_frame)
    fail(ErrorCode::UnsupportedData, member.path, "is in the frame '{}'; expected '{}', as {}", member.info.world_frame,
         first.info.world_frame, first.path.string());
  if (member.info.lattice != first.info.lattice)
    fail(ErrorCode::UnsupportedData, member.path, "is on the lattice {}; expected {}, as {}",
         name_of_lattice(member.info.lattice), name_of_lattice(first.info.lattice), first.path.string());
  require_same_grid(member, first);
}

/// The coordinates of the files along the first removed axis in which they differ; empty if there is none. `found` gets
/// its direction if all files agree.
std::vector<double> own_coordinates(const std::vector<Member>& members, SingleAxis& found) {
  const std::vector<SingleAxis>& singles = members.front().grid.single;
  for (std::size_t s = 0; s < singles.size(); ++s) {
    const std::string& unit = singles[s].axis.unit;
    std::vector<double> coordinates;
    for (const Member& member : members) {
      if (member.grid.single.size() != singles.size()) return {};
      const Axis& axis = member.grid.single[s].axis;
      // Files may each have their own reference time, with coordinate 0.
      const std::optional<double> at = convert_time(axis[0], axis.unit, unit);
      if (!at)
        fail(ErrorCode::UnsupportedData, member.path,
             "lies along '{}' in '{}'; expected '{}', as {}, a unit that converts to it, or explicit coordinates",
             axis.name, axis.unit, unit, members.front().path.string());
      coordinates.push_back(*at);
    }
    if (std::all_of(coordinates.begin(), coordinates.end(), [&](double c) { return c == coordinates[0]; })) continue;
    found = singles[s];
    for (const Member& member : members)
      if (member.grid.single[s].direction != found.direction) found.direction = AxisDirection::unknown;
    return coordinates;
  }
  return {};
}

/// The source of the members' coordinates.
enum class Says { header, step, caller };

void require_monotone(const std::vector<Member>& members, Says says, SeriesOrder order) {
  const bool descending = members[1].at < members[0].at;
  for (std::size_t i = 0; i < members.size(); ++i) {
    const Member& member = members[i];
    if (!std::isfinite(member.at))
      fail(ErrorCode::InvalidArgument, member.path, "lies at {} along the new axis; expected a finite number",
           member.at);
    if (i == 0 || (descending ? member.at < members[i - 1].at : member.at > members[i - 1].at)) continue;
    if (order == SeriesOrder::by_name && says == Says::caller)
      fail(ErrorCode::InvalidArgument, member.path,
           "lies at {} by the given coordinates, after {} at {} by the order of their names; expected coordinates that "
           "strictly ascend or descend in that order",
           member.at, members[i - 1].path.string(), members[i - 1].at);
    fail(says == Says::header ? ErrorCode::UnsupportedData : ErrorCode::InvalidArgument, member.path,
         "lies at {} along the new axis{}, after {} at {}; expected strictly {} coordinates{}", member.at,
         says == Says::header ? " by its header" : "", members[i - 1].path.string(), members[i - 1].at,
         descending ? "descending" : "ascending", says == Says::header ? ", or files in their order" : "");
  }
}

/// Converts the members' coordinates to the requested unit, and returns its name: for instance days to hours since the
/// same day.
std::string converted(std::vector<Member>& members, const std::string& own, const std::string& asked) {
  if (own == asked) return own;
  const std::string since = split_time_unit(own).since;
  const TimeUnit wanted = split_time_unit(asked);
  const std::string unit = wanted.since.empty() && !since.empty() ? asked + " since " + since : asked;
  if ((!wanted.since.empty() && wanted.since != since) || !convert_time(0, own, unit))
    fail(ErrorCode::InvalidArgument, members.front().path,
         "has coordinates in '{}' by its header, which do not convert to '{}'; expected the header's unit or, for "
         "times, one of ms, s, min, h, d and weeks",
         own, asked);
  for (Member& member : members) member.at = *convert_time(member.at, own, unit);
  return unit;
}

/// Makes the new axis: sets the coordinate of each member, and sorts the members by it if requested.
SingleAxis make_axis(std::vector<Member>& members, const SeriesOptions& options) {
  SingleAxis found;
  const bool by_coordinate = options.order == SeriesOrder::coordinate;
  Says says = options.coordinates.empty() ? Says::step : Says::caller;
  if (says == Says::step) {
    const auto own = options.step ? std::vector<double>() : own_coordinates(members, found);
    if (own.empty() && by_coordinate)
      fail(ErrorCode::UnsupportedData, members.front().path,
           "has no coordinate along a further axis, or all files have the same; expected different coordinates, to "
           "order the files by them");
    if (!own.empty()) says = Says::header;
    for (std::size_t i = 0; i < members.size(); ++i)
      members[i].at = own.empty() ? static_cast<double>(i) * options.step.value_or(1.0) : own[i];
  }
  if (by_coordinate)
    std::stable_sort(members.begin(), members.end(), [](const Member& a, const Member& b) { return a.at < b.at; });
  require_monotone(members, says, options.order);
  if (!options.unit.empty())
    found.axis.unit = found.axis.unit.empty() ? options.unit : converted(members, found.axis.unit, options.unit);
  std::vector<double> coordinates;
  for (const Member& member : members) coordinates.push_back(member.at);
  Axis axis = axis_of(coordinates);
  constexpr std::array<const char*, 5> kNames = {"x", "y", "z", "t", "u"};
  axis.name = found.axis.name.empty() ? kNames.at(members.front().grid.axes.size()) : found.axis.name;
  axis.unit = found.axis.unit;
  return {std::move(axis), found.direction};
}

/// Reads and compares the headers of all files, in their order. Given coordinates stay with their files.
std::vector<Member> read_headers(std::span<const fs::path> files, const SeriesOptions& options,
                                 const MemberReader& read) {
  std::vector<std::size_t> order(files.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (options.order == SeriesOrder::by_name)
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return natural_less(files[a].native(), files[b].native()); });
  std::vector<Member> members;
  for (const std::size_t i : order) {
    const fs::path& path = files[i];
    tick(options.work.progress, 0.0, path);
    RawImage header = read(path, Extent::header, {});
    members.push_back({path, std::move(header.grid), std::move(header.info), header.values.index(),
                       options.coordinates.empty() ? 0.0 : options.coordinates[i]});
    const std::size_t axes = members.back().grid.axes.size();
    if (axes < 2 || axes > 4)
      fail(ErrorCode::UnsupportedData, path, "has {} axes and is one of several files; expected 2 to 4 axes per file",
           axes);
    require_same(members.back(), members.front());
  }
  return members;
}

/// Appends the values of a file.
void append(ValueArray& to, ValueArray&& from, std::size_t expected, const fs::path& path) {
  std::visit(
      [&]<class T>(ValueVector<T>& values) {
        const auto* const added = std::get_if<ValueVector<T>>(&from);
        if (added == nullptr || added->size() != expected)
          fail(ErrorCode::MalformedFile, path, "has changed since its header was read");
        values.insert(values.end(), added->begin(), added->end());
      },
      to);
}

/// The files of a series in its order, with equal grids.
struct Members {
  std::vector<fs::path> paths;
  RawGrid grid;           ///< of the whole series
  ImageInfo info;         ///< of the first file, for the whole series
  std::size_t layer = 1;  ///< number of samples of a file
  std::size_t type = 0;   ///< index of ValueArray
};

/// Whether two coordinates of curved grids may differ only by their numbers.
bool are_alike(const CurvedAxis& a, const CurvedAxis& b) {
  return a.axis == b.axis && a.along == b.along && a.name == b.name && a.unit == b.unit && a.size() == b.size();
}

/// The coordinates of the curved grid of all files: those that differ from file to file are along the last axis of
/// `grid`, too. Takes them out of the members.
std::vector<CurvedAxis> join_curved(std::vector<Member>& members, const RawGrid& grid) {
  std::vector<CurvedAxis> joined = std::move(members.front().info.curved);
  const auto added = static_cast<unsigned>(grid.axes.size()) - 1;
  std::vector<unsigned char> moves(joined.size(), 0);
  for (std::size_t m = 1; m < members.size(); ++m) {
    const std::vector<CurvedAxis>& own = members[m].info.curved;
    if (!std::equal(own.begin(), own.end(), joined.begin(), joined.end(), are_alike))
      fail(ErrorCode::UnsupportedData, members[m].path,
           "has other curved coordinates than {}; expected coordinates of the same names, units and axes in all files",
           members.front().path.string());
    for (std::size_t c = 0; c < joined.size(); ++c)
      if (!(own[c] == joined[c])) moves[c] = 1;
  }
  for (std::size_t c = 0; c < joined.size(); ++c) {
    if (moves[c] == 0) continue;
    const std::size_t size = joined[c].values.size();
    expect_memory(kBytesPerValue * size * members.size());
    joined[c].values.reserve(size * members.size());
    for (std::size_t m = 1; m < members.size(); ++m) {
      std::vector<double> values = std::move(members[m].info.curved[c].values);
      joined[c].values.insert(joined[c].values.end(), values.begin(), values.end());
    }
    joined[c].along |= 1u << added;
    if (!is_longitude_unit(joined[c].unit)) continue;
    // each file has continued its own; now also from file to file
    std::vector<std::size_t> sizes;
    for (std::size_t a = 0; a < grid.axes.size(); ++a)
      if ((joined[c].along >> a & 1u) != 0) sizes.push_back(grid.axes[a].size());
    continue_longitudes(joined[c].values, sizes);
  }
  return joined;
}

/// Throws UnsupportedData for plane grids in x, y or z whose constant coordinate, which is no axis, differs between
/// files, unless it is the new axis.
void require_same_plane(const std::vector<Member>& members, const Axis& added) {
  const std::vector<SingleAxis>& singles = members.front().grid.single;
  for (std::size_t s = 0; s < singles.size(); ++s) {
    const Axis& first = singles[s].axis;
    if (first.name != "x" && first.name != "y" && first.name != "z") continue;
    const auto at = [s](const Member& member) {
      return s < member.grid.single.size() ? member.grid.single[s].axis[0] : std::numeric_limits<double>::quiet_NaN();
    };
    std::size_t other = 0;
    bool is_added = true;
    for (std::size_t m = 0; m < members.size(); ++m) {
      is_added = is_added && at(members[m]) == added[m];
      if (other == 0 && at(members[m]) != first[0]) other = m;
    }
    if (other > 0 && !is_added)
      fail(ErrorCode::UnsupportedData, members[other].path,
           "has the constant coordinate {} = {}; expected {}, as {}, or grids with coordinates in three dimensions, "
           "since plane ones cannot move out of their plane",
           first.name, at(members[other]), first[0], members.front().path.string());
  }
}

Members join(std::vector<Member>&& members, const SeriesOptions& options) {
  auto [last, direction] = make_axis(members, options);
  const Member& first = members.front();
  Members result;
  for (const Axis& axis : first.grid.axes) result.layer *= axis.size();
  result.type = first.type;
  result.grid = with_last_axis(first.grid, std::move(last));
  if (!first.info.curved.empty()) require_same_plane(members, result.grid.axes.back());
  std::vector<CurvedAxis> curved = join_curved(members, result.grid);
  result.info = first.info;
  result.info.curved = std::move(curved);
  result.info.lattice = lattice_in_time(result.info.lattice, first.path);
  if (!result.info.axis_directions.empty()) result.info.axis_directions.push_back(direction);
  for (const Member& member : members) result.paths.push_back(member.path);
  return result;
}

/// Reads the values of `count` files; nullopt as soon as a file has another scaling than `members.info`.
std::optional<ValueArray> read_values(const Members& members, std::size_t begin, std::size_t count,
                                      const Progress& progress, const MemberReader& read) {
  ValueArray values = array_of_type(name_of_type(members.type));
  expect_memory(kBytesPerValue * count * members.layer);
  std::visit([&](auto& all) { all.reserve(count * members.layer); }, values);
  for (std::size_t i = begin; i < begin + count; ++i) {
    Progress of_file;
    if (progress)
      of_file = [&](double share) {
        return progress((static_cast<double>(i - begin) + share) / static_cast<double>(count));
      };
    RawImage image = read(members.paths[i], Extent::whole, of_file);
    if (image.info.scaling != members.info.scaling) return std::nullopt;
    append(values, std::move(image.values), members.layer, members.paths[i]);
    tick(of_file, 1.0, members.paths[i]);
  }
  return values;
}

}  // namespace

LayersOfFiles open_members(std::span<const fs::path> files, const SeriesOptions& options, const MemberReader& read) {
  Members members = join(read_headers(files, options, read), options);
  RawLayers result;
  result.grid = members.grid;
  std::vector<CurvedAxis> curved = std::move(members.info.curved);  // not twice in memory: values do not need it
  members.info.curved.clear();
  result.info = members.info;
  result.info.curved = std::move(curved);
  std::vector<fs::path> paths = members.paths;
  result.read = [members = std::move(members), own = options, read](std::size_t begin, std::size_t count) {
    return read_values(members, begin, count, own.work.progress, read).value();
  };
  return {std::move(result), std::move(paths)};
}

std::optional<ImageOfFiles> read_stored_members(std::span<const fs::path> files, const SeriesOptions& options,
                                                const MemberReader& read) {
  // Headers show whether a file has other integers, except for missing values.
  std::optional<ValueScaling> scaling;
  for (const fs::path& path : files) {
    tick(options.work.progress, 0.0, path);
    const std::optional<ValueScaling> own = read(path, Extent::header, {}).info.scaling;
    if (!own || (scaling && own != scaling)) return std::nullopt;
    scaling = own;
  }
  Members members = join(read_headers(files, options, read), options);
  auto values = read_values(members, 0, members.paths.size(), options.work.progress, read);
  if (!values) return std::nullopt;
  return ImageOfFiles{{std::move(members.grid), std::move(*values), std::move(members.info)}, std::move(members.paths)};
}

}  // namespace tegl::io_detail
