// SPDX-License-Identifier: BSD-3-Clause
//
// Parses --at, --plane and --scale, matches cuts with the axes of their space, and names output files.
#include "input/cuts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include "base/numbers.hpp"
#include "tegl/periodic.hpp"
#include "tegl/slice.hpp"

namespace tegl::cli {

namespace {

/// Splits "NAME=VALUES".
std::pair<std::string, std::string_view> halves(std::string_view option, const std::string& argument,
                                                std::string_view expected) {
  const std::size_t equals = argument.find('=');
  if (equals == std::string::npos || equals == 0)
    throw Error(ErrorCode::InvalidArgument, fmt::format("{} is '{}'; expected {}", option, argument, expected));
  return {argument.substr(0, equals), std::string_view(argument).substr(equals + 1)};
}

/// `count` numbers from `first` to `last`; both ends are exact. Numbers between that are intended to have few digits,
/// such as 0.3 or 5, are rounded to them: an error in the last bit would put the cut on another side of samples that
/// equal the isovalue.
std::vector<double> even_numbers(double first, double last, std::size_t count) {
  const double rounding = 4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(first), std::abs(last));
  std::vector<double> numbers = {first};
  for (std::size_t i = 1; i + 1 < count; ++i) {
    const double along = static_cast<double>(i) / static_cast<double>(count - 1);
    const double value = first * (1 - along) + last * along;  // first - last could overflow
    const double meant = std::abs(value) <= rounding ? 0.0 : *parse_number(fmt::format("{:.12g}", value));
    numbers.push_back(std::abs(meant - value) <= rounding ? meant : value);
  }
  numbers.push_back(last);
  return numbers;
}

/// Evenly spaced numbers with their texts: as number() formats them, or with more digits so that the error is at most a
/// thousandth of the step, as files are named after them.
std::vector<SpelledNumber> spell_apart(const std::vector<double>& range) {
  const double most = std::abs(range[1] - range[0]) / 1000;
  const auto is_near = [&](const SpelledNumber& spelled) {
    return std::abs(*parse_number(spelled.text) - spelled.value) <= most;
  };
  std::vector<SpelledNumber> result;
  for (const double value : range) result.push_back({value, number(value)});
  for (int digits = 7; digits <= std::numeric_limits<double>::max_digits10; ++digits) {
    if (std::all_of(result.begin(), result.end(), is_near)) break;
    for (SpelledNumber& spelled : result) spelled.text = fmt::format("{:.{}g}", spelled.value, digits);
  }
  return result;
}

/// Parses "1,2.5" and "FIRST:LAST:COUNT": each number and its text.
std::vector<SpelledNumber> numbers_of(const std::string& option, std::string_view values) {
  std::vector<SpelledNumber> result;
  for (const std::string_view text : split(values, ',')) {
    const auto ends = split(text, ':');
    if (ends.size() == 1) {
      result.push_back({parse_finite(option, text), std::string(text)});
      continue;
    }
    constexpr double kMost = 100000;
    const double count = ends.size() == 3 ? parse_finite(option, ends[2]) : 0.0;
    if (!(count >= 2 && count <= kMost) || count != std::floor(count))
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("{} has '{}'; expected FIRST:LAST:COUNT with a COUNT of 2 to {}, as in 0:10:21", option,
                              text, kMost));
    const std::vector<double> range =
        even_numbers(parse_finite(option, ends[0]), parse_finite(option, ends[1]), static_cast<std::size_t>(count));
    for (SpelledNumber& spelled : spell_apart(range)) result.push_back(std::move(spelled));
  }
  return result;
}

/// Replaces a placeholder; returns true if there was one.
bool replace_all(std::string& output, const std::string& placeholder, const std::string& text) {
  bool any = false;
  for (auto at = output.find(placeholder); at != std::string::npos; at = output.find(placeholder, at)) {
    output.replace(at, placeholder.size(), text);
    at += text.size();
    any = true;
  }
  return any;
}

/// Replaces "{n}" by the position in the list, from 1, with as many digits for all, so that names sort. Returns true if
/// there was one.
bool replace_place(std::string& output, std::size_t place, std::size_t count) {
  return replace_all(output, "{n}", fmt::format("{:0{}}", place, std::to_string(count).size()));
}

/// A normal as text, such as "x + 2 t".
std::string formula(const std::vector<double>& normal, const CutSpace& space) {
  std::string text;
  for (std::size_t a = 0; a < normal.size(); ++a) {
    if (normal[a] == 0.0) continue;
    const double size = std::abs(normal[a]);
    text += text.empty() ? (normal[a] < 0 ? "-" : "") : (normal[a] < 0 ? " - " : " + ");
    text += size == 1.0 ? space.axes[a].name : fmt::format("{} {}", number(size), space.axes[a].name);
  }
  return text;
}

/// The range of values along a normal that does not have all offsets: from the lowest to the highest corner of the
/// space's box. Such a cut across a period is one of the unrolled contour.
CutAxis range_of(const Cut& cut, const CutSpace& space) {
  CutAxis range{cut.axis, 0.0, 0.0};
  for (std::size_t a = 0; a < space.axes.size(); ++a) {
    if (cut.normal[a] == 0.0) continue;
    const CutAxis& axis = space.axes[a];
    const auto [first, last] = axis.period > 0.0 ? axis.unrolled : std::array{axis.first, axis.last};
    const auto [low, high] = std::minmax({cut.normal[a] * first, cut.normal[a] * last});
    range.first += low;
    range.last += high;
  }
  return range;
}

std::vector<std::string> labels_of(const CutSpace& space) {
  std::vector<std::string> labels;
  for (const CutAxis& axis : space.axes) labels.push_back(axis.name);
  return labels;
}

/// Sets Cut::level of cuts across axes of a saved contour that are meant to pass through its vertices.
void find_levels(std::vector<Cut>& cuts, const CutSpace& space) {
  for (std::size_t axis = 0; axis < space.axes.size(); ++axis) {
    const auto is_across = [&](const Cut& cut) { return cut.across && static_cast<std::size_t>(*cut.across) == axis; };
    std::vector<double> values;
    for (const Cut& cut : cuts)
      if (is_across(cut)) values.push_back(within_period(space.axes[axis], cut.value));
    if (values.empty()) continue;
    const std::vector<double> level = meet_vertices(values, space.vertices, space.axes.size(), axis);
    std::size_t next = 0;
    for (Cut& cut : cuts)
      if (is_across(cut)) cut.level = level[next++];
  }
}

/// Calls f with the periods of a wrapped contour, if there are any, in a space of 3 to 5 dimensions: contours in the
/// plane are not cut. `numbers`: of `period_numbers`.
template <class F>
void visit_wrapped(const std::vector<double>& numbers, std::size_t dimension, const F& f) {
  if (numbers.empty()) return;
  if (dimension == 3) f(periods_of_numbers<3>(numbers));
  if (dimension == 4) f(periods_of_numbers<4>(numbers));
  if (dimension == 5) f(periods_of_numbers<5>(numbers));
}

/// Whether all hyperplanes with this normal cut a wrapped contour, whatever their offsets.
bool has_all_offsets(const CutSpace& space, const std::vector<double>& normal) {
  bool has_all = false;
  visit_wrapped(space.periods, space.axes.size(), [&]<int N>(const std::vector<Period<N>>& periods) {
    Vector<N> components;
    std::copy_n(normal.begin(), N, components.begin());
    has_all = cut_period<N>(periods, components).has_value();
  });
  return has_all;
}

void wrap_axes(const std::vector<double>& numbers, CutSpace& space) {
  visit_wrapped(numbers, space.axes.size(), [&]<int N>(const std::vector<Period<N>>& periods) {
    for (int a = 0; a < N; ++a) {
      CutAxis& axis = space.axes[static_cast<std::size_t>(a)];
      axis = axis_with_periods(std::move(axis), a, periods);
    }
    space.periods = numbers;
  });
}

std::string axis_names(const CutSpace& space) { return fmt::format("{}", fmt::join(labels_of(space), ", ")); }

}  // namespace

template <int N>
CutAxis axis_with_periods(CutAxis axis, int a, const std::vector<Period<N>>& periods) {
  const auto [down, up] = parts_of_periods<N>(periods, a);
  const std::array<double, 2> unrolled = {axis.first + down, axis.last + up};  // `unroll` moves simplices there
  if (const std::optional<CutPeriod<N>> cuts = take_period<N>(axis, periods, a)) {
    axis.first = cuts->first;
    axis.last = cuts->first + cuts->length;
    axis.unrolled = unrolled;
  } else {
    axis.first = unrolled[0];
    axis.last = unrolled[1];
  }
  return axis;
}

template CutAxis axis_with_periods(CutAxis, int, const std::vector<Period<3>>&);
template CutAxis axis_with_periods(CutAxis, int, const std::vector<Period<4>>&);
template CutAxis axis_with_periods(CutAxis, int, const std::vector<Period<5>>&);

double within_period(const CutAxis& axis, double place) {
  if (place >= axis.first && place <= axis.last) return place;
  if (axis.period > 0.0) return axis.is_moved ? place : place_in_period(place, axis.first, axis.period);
  const double turned = axis.is_longitude ? place_in_period(place, axis.first, 360.0) : place;
  return turned <= axis.last ? turned : place;
}

std::vector<SpelledNumber> parse_spelled_numbers(const std::string& option, std::string_view text) {
  return numbers_of(option, text);
}

std::vector<double> parse_numbers(const std::string& option, std::string_view text) {
  std::vector<double> numbers;
  for (const auto& [value, spelled] : numbers_of(option, text)) numbers.push_back(value);
  return numbers;
}

std::vector<Cut> parse_cuts(const std::vector<std::string>& at) {
  std::vector<Cut> cuts;
  for (const std::string& argument : at) {
    const auto [axis, values] = halves("--at", argument, "an axis and a number, as in t=7.3");
    if (values.find('=') != std::string_view::npos)
      throw Error(ErrorCode::InvalidArgument, fmt::format("--at {} has several axes; expected one axis per --at: --at "
                                                          "{}=2,3 for two places, --at {}=2 --at y=3 for two axes",
                                                          argument, axis, axis));
    for (const auto& [value, text] : numbers_of(fmt::format("--at {}", argument), values))
      cuts.push_back({axis, value, text, {}, {}, {}, {}, false});
  }
  return cuts;
}

std::vector<double> parse_list(const std::string& option, std::string_view text) {
  std::vector<double> numbers;
  for (const std::string_view part : split(text, ','))
    numbers.push_back(parse_finite(option, part, "numbers, one for each axis"));
  return numbers;
}

std::vector<double> parse_normal(const std::string& option, std::string_view text) {
  std::vector<double> normal = parse_list(option, text);
  if (std::all_of(normal.begin(), normal.end(), [](double x) { return x == 0.0; }))
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{} is '{}'; expected numbers that are not all 0", option, text));
  return normal;
}

std::vector<Cut> parse_planes(const std::vector<std::string>& planes) {
  std::vector<Cut> cuts;
  for (const std::string& argument : planes) {
    const auto [numbers, values] = halves("--plane", argument, "a normal and an offset, as in 1,0,0,0.5=3");
    const std::vector<double> normal = parse_normal(fmt::format("--plane {}", argument), numbers);
    for (const auto& [value, text] : numbers_of(fmt::format("--plane {}", argument), values))
      cuts.push_back({numbers, value, text, normal, {}, {}, {}, false});
  }
  return cuts;
}

template <int N>
CutSpace space_of(const Grid<N>& grid) {
  CutSpace space{{}, "image", {}};
  for (int a = 0; a < N; ++a) {
    CutAxis& world = space.axes.emplace_back();
    world = {axis_label(grid.axes[a].name, static_cast<std::size_t>(a)), grid.offset[a], grid.offset[a]};
    for (int b = 0; b < N; ++b) {
      const Axis& axis = grid.axes[b];
      const auto [low, high] = std::minmax({grid.linear[a][b] * axis[0], grid.linear[a][b] * axis[axis.size() - 1]});
      world.first += low;
      world.last += high;
    }
    world.is_longitude = is_longitude_unit(grid.axes[a].unit);
  }
  return space;
}

template CutSpace space_of(const Grid<2>&);
template CutSpace space_of(const Grid<3>&);
template CutSpace space_of(const Grid<4>&);
template CutSpace space_of(const Grid<5>&);

CutSpace space_of(const AnyImage& image) {
  const auto of_owned = [](const auto& owned) { return space_of(owned.grid); };
  return std::visit([&](const auto& typed) { return std::visit(of_owned, typed); }, image);
}

CutSpace space_of(const AnyImage5d& image) {
  return std::visit([](const auto& owned) { return space_of(owned.grid); }, image);
}

CutSpace space_of(const Mesh& mesh) {
  CutSpace space{{}, "saved contour", mesh.coordinates};
  const auto n = static_cast<std::size_t>(mesh.space_dim);
  for (std::size_t a = 0; a < n; ++a) {
    CutAxis& axis = space.axes.emplace_back();
    axis = {axis_label(a < mesh.axis_names.size() ? mesh.axis_names[a] : "", a),
            std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (std::size_t i = a; i < mesh.coordinates.size(); i += n) {
      axis.first = std::min(axis.first, mesh.coordinates[i]);
      axis.last = std::max(axis.last, mesh.coordinates[i]);
    }
    axis.is_longitude = a < mesh.axis_units.size() && is_longitude_unit(mesh.axis_units[a]);
  }
  wrap_axes(mesh.periods, space);
  return space;
}

std::vector<double> parse_scale(const std::vector<std::string>& scale, const CutSpace& space) {
  std::vector<double> factors(space.axes.size(), 1.0);
  std::vector<bool> is_given(space.axes.size(), false);
  for (const std::string& argument : scale)
    for (const std::string_view part : split(argument, ',')) {
      const std::string text(part);
      const auto [name, value] = halves("--scale", text, "an axis and a factor, as in t=10");
      const std::size_t axis = axis_called(name, labels_of(space));
      if (axis == space.axes.size())
        throw Error(ErrorCode::InvalidArgument,
                    fmt::format("--scale {} names no axis; expected one of {}", text, axis_names(space)));
      if (is_given[axis])
        throw Error(ErrorCode::InvalidArgument,
                    fmt::format("--scale has the axis {} twice; expected it once", space.axes[axis].name));
      is_given[axis] = true;
      factors[axis] = parse_finite(fmt::format("--scale {}", text), value);
      if (!(factors[axis] > 0.0))
        throw Error(ErrorCode::InvalidArgument, fmt::format("--scale {}; expected a factor above 0", text));
    }
  return factors;
}

std::vector<double> meet_vertices(std::vector<double> values, std::span<const double> vertices, std::size_t dim,
                                  std::size_t axis) {
  const auto in_single = [](double x) { return static_cast<double>(static_cast<float>(x)); };
  struct Rounded {
    double to;
    std::size_t value;
    bool is_met;
  };
  std::vector<Rounded> rounded;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (const double to = in_single(values[i]); to != values[i]) rounded.push_back({to, i, false});
  if (rounded.empty()) return values;
  std::sort(rounded.begin(), rounded.end(), [](const Rounded& a, const Rounded& b) { return a.to < b.to; });
  for (std::size_t i = axis; i < vertices.size(); i += dim) {
    if (in_single(vertices[i]) != vertices[i]) return values;
    auto met = std::lower_bound(rounded.begin(), rounded.end(), vertices[i],
                                [](const Rounded& a, double x) { return a.to < x; });
    for (; met != rounded.end() && met->to == vertices[i]; ++met) met->is_met = true;
  }
  for (const Rounded& one : rounded)
    if (one.is_met) values[one.value] = one.to;
  return values;
}

EmptyResult outside_error(const Cut& cut, const CutAxis& axis, std::string_view of) {
  const auto texts = numbers_apart({axis.first, axis.last, cut.level.value_or(cut.value)});
  return EmptyResult(fmt::format(
      "the slice at {} = {} lies outside of the {}; expected {} <= {} <= {} (--allow-empty: an empty slice)", cut.axis,
      cut.text, of, texts[0], axis.name, texts[1]));
}

std::vector<Cut> resolve(std::vector<Cut> cuts, const CutSpace& space, bool allow_empty) {
  for (Cut& cut : cuts) {
    if (!cut.normal.empty()) {
      if (cut.normal.size() != space.axes.size())
        throw Error(ErrorCode::InvalidArgument,
                    fmt::format("--plane {}={} has a normal of {} numbers; expected {}, one for each of {}", cut.axis,
                                cut.text, cut.normal.size(), space.axes.size(), axis_names(space)));
      cut.axis = formula(cut.normal, space);
      continue;
    }
    const std::size_t a = axis_called(cut.axis, labels_of(space));
    if (a == space.axes.size())
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("--at {}={} names no axis; expected one of {}", cut.axis, cut.text, axis_names(space)));
    cut.across = static_cast<int>(a);
    cut.axis = space.axes[a].name;
    if (space.axes[a].is_longitude && !(space.axes[a].period > 0.0))
      cut.value = within_period(space.axes[a], cut.value);
    cut.normal.assign(space.axes.size(), 0.0);
    cut.normal[a] = 1.0;
  }
  find_levels(cuts, space);
  for (Cut& cut : cuts) {
    if (has_all_offsets(space, cut.normal)) continue;
    const CutAxis axis = range_of(cut, space);
    const double level = cut.level.value_or(cut.value);
    cut.is_outside = !(level >= axis.first && level <= axis.last);
    if (cut.is_outside && !allow_empty) throw outside_error(cut, axis, space.of);
  }
  return cuts;
}

std::vector<std::string> cut_outputs(const std::string& pattern, const std::vector<Cut>& cuts) {
  std::vector<std::string> outputs;
  for (const Cut& cut : cuts) {
    std::string output = pattern;
    for (const std::string& placeholder : {std::string("{t}"), std::string("{at}"), "{" + cut.axis + "}"})
      replace_all(output, placeholder, cut.text);
    replace_all(output, "{axis}", cut.axis);
    replace_place(output, outputs.size() + 1, cuts.size());
    if (std::find(outputs.begin(), outputs.end(), output) != outputs.end()) {
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("--output is '{}' for two slices; expected {{t}} or {{n}} in it (and {{axis}} if there "
                              "are several axes), and each slice once",
                              output));
    }
    outputs.push_back(output);
  }
  return outputs;
}

std::vector<std::string> isovalue_outputs(const std::string& pattern, const std::vector<SpelledNumber>& isovalues) {
  std::vector<std::string> outputs;
  for (const SpelledNumber& isovalue : isovalues) {
    std::string output = pattern;
    const bool is_numbered = replace_place(output, outputs.size() + 1, isovalues.size());
    if (!replace_all(output, "{iso}", isovalue.text) && !is_numbered && isovalues.size() > 1) {
      std::filesystem::path name(pattern);
      const std::string extension = name.extension().string();
      name.replace_filename(name.stem().string() + "_" + isovalue.text + extension);
      output = name.string();
    }
    outputs.push_back(std::move(output));
  }
  return outputs;
}

}  // namespace tegl::cli
