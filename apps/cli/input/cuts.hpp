// SPDX-License-Identifier: BSD-3-Clause
//
// Values of --at and --plane, the space that is cut, and the output file of each cut.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/empty_result.hpp"
#include "output/result.hpp"
#include "tegl/contour.hpp"
#include "tegl/io/images.hpp"
#include "tegl/io/meshes.hpp"
#include "tegl/periodic.hpp"
#include "tegl/slice.hpp"
#include "tegl/vector.hpp"

namespace tegl::cli {

/// Parses the values of --at: "t=7.3", "time=1,2.5", "z=0:10:21" for 21 values from 0 to 10. Throws InvalidArgument,
/// with the value, for other texts.
std::vector<Cut> parse_cuts(const std::vector<std::string>& at);

/// Parses the values of --plane: "1,0,0,0.5=3", a normal and values as in --at.
std::vector<Cut> parse_planes(const std::vector<std::string>& planes);

/// A number and its text on the command line.
struct SpelledNumber {
  double value = 0;
  std::string text;
};

/// Parses "0,0.5,2" and "FIRST:LAST:COUNT". Throws InvalidArgument, with the option.
std::vector<SpelledNumber> parse_spelled_numbers(const std::string& option, std::string_view text);
std::vector<double> parse_numbers(const std::string& option, std::string_view text);

/// The numbers of a list with commas. Throws InvalidArgument, with the option's name, unless all are finite.
std::vector<double> parse_list(const std::string& option, std::string_view text);

/// Parses a normal or direction, "1,0,0,0.5". Throws InvalidArgument, with the option, unless it is a non-zero list of
/// numbers.
std::vector<double> parse_normal(const std::string& option, std::string_view text);

/// A coordinate axis of the cut space, and its range in the data.
struct CutAxis {
  std::string name;
  double first = 0;
  double last = 0;
  double period = 0;      ///< if above 0: every place has a cut, and first to last is one period
  bool is_moved = false;  ///< whether cuts a period apart are not equal, but moved within their hyperplanes
  bool is_longitude = false;  ///< by its unit: places 360 apart are equal
  /// Of a periodic axis: the range of the unrolled contour, for planes that do not cut the wrapped one.
  std::array<double, 2> unrolled = {};
};

/// The sums of the parts of periods along an axis that lead down, and of those that lead up.
template <int N>
std::array<double, 2> parts_of_periods(std::span<const Period<N>> periods, int a) {
  std::array<double, 2> sums = {};
  for (const Period<N>& period : periods) {
    const double part = period.vector[static_cast<std::size_t>(a)];
    sums[part < 0.0 ? 0 : 1] += part;
  }
  return sums;
}

/// Makes an axis periodic, from its first place on, if every place across it has a cut (`cut_period`). Returns how cuts
/// repeat then. The unrolled contour ends where the axis ended, or all periods from its start. N is 2 to 5; axes of 2D
/// contours are not cut.
template <int N>
std::optional<CutPeriod<N>> take_period(CutAxis& axis, std::span<const Period<N>> periods, int a) {
  if constexpr (N >= 3) {
    const std::optional<CutPeriod<N>> cuts = cut_period<N>(periods, unit_vector<N>(a));
    if (!cuts) return cuts;
    const auto [down, up] = parts_of_periods<N>(periods, a);
    axis.unrolled = {std::min(axis.first, axis.last + down), std::max(axis.last, axis.first + up)};
    axis.period = cuts->length;
    axis.last = axis.first + axis.period;
    axis.is_moved = !cuts->is_straight;
    return cuts;
  }
  return std::nullopt;
}

/// The axis of a wrapped contour: periodic if every place has a cut, otherwise with the range of the unrolled contour.
/// `axis`: with the range of the wrapped contour. N is 3 to 5.
template <int N>
CutAxis axis_with_periods(CutAxis axis, int a, const std::vector<Period<N>>& periods);

/// A place on an axis; if it is outside of the axis's range, moved there by periods, unless this moves the cut, or by
/// turns of 360 on an axis of longitudes. Unchanged if no turn leads into the range.
double within_period(const CutAxis& axis, double place);

/// The space that is cut.
struct CutSpace {
  std::vector<CutAxis> axes;
  const char* of = "";  ///< the object that the ranges belong to, for messages
  /// #V x axes.size() coordinates of a saved contour, not owned; empty for an image.
  std::span<const double> vertices = {};
  std::vector<double> periods = {};  ///< period_numbers of a wrapped contour
};
CutSpace space_of(const AnyImage& image);
CutSpace space_of(const AnyImage5d& image);
/// The space of an image on this grid.
template <int N>
CutSpace space_of(const Grid<N>& grid);
CutSpace space_of(const Mesh& mesh);

/// Makes the axes of a space periodic.
template <int N>
void take_periods(CutSpace& space, const std::vector<Period<N>>& periods) {
  for (int a = 0; a < N; ++a) (void)take_period<N>(space.axes[static_cast<std::size_t>(a)], periods, a);
  space.periods = period_numbers(periods);
}

/// Parses the values of --scale, one factor for each axis: "t=10", "x=2,y=3". Throws InvalidArgument.
std::vector<double> parse_scale(const std::vector<std::string>& scale, const CutSpace& space);

/// Replaces values that differ from a vertex's coordinate only by rounding to single precision by that coordinate: t =
/// 0.1 has another nearest number in single precision than in double. Applies only if all coordinates on the axis are
/// numbers in single precision. `vertices`: #V x dim coordinates.
std::vector<double> meet_vertices(std::vector<double> values, std::span<const double> vertices, std::size_t dim,
                                  std::size_t axis);

/// Completes cuts: sets the axes' own names, the normals, and levels for values that mean vertices or are outside of
/// the range of a periodic axis. Throws InvalidArgument for axes and normals that the space does not have, EmptyResult
/// for a cut outside of the space's extent unless `allow_empty`.
std::vector<Cut> resolve(std::vector<Cut> cuts, const CutSpace& space, bool allow_empty);

/// The error of a cut outside of an axis's range. `of`: the object with this range.
EmptyResult outside_error(const Cut& cut, const CutAxis& axis, std::string_view of);

/// The output file of each cut: `pattern` with these replacements. "{t}" or "{at}", or the axis as typed in braces: the
/// number as typed; "{axis}": that axis; "{n}": the cut's position from 1, with equally many digits for all. Throws
/// InvalidArgument if two cuts get the same file.
std::vector<std::string> cut_outputs(const std::string& pattern, const std::vector<Cut>& cuts);

/// The output file of each isovalue: `pattern` with "{iso}" replaced by the number as typed, and "{n}" by its position,
/// as in cut_outputs. If there are several isovalues and no placeholder, _NUMBER is inserted before the extension.
std::vector<std::string> isovalue_outputs(const std::string& pattern, const std::vector<SpelledNumber>& isovalues);

}  // namespace tegl::cli
