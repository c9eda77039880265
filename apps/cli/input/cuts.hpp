// SPDX-License-Identifier: BSD-3-Clause
//
// The values of --at and --plane, the space that they are asked of, and the output that belongs to each.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "output/result.hpp"
#include "tegl/io.hpp"

namespace tegl::cli {

/// The cuts that the values of --at ask for: "t=7.3", "time=1,2.5", "z=0:10:21" for 21 from 0 to 10. Throws
/// InvalidArgument, quoting the value, for anything else.
std::vector<Cut> parse_cuts(const std::vector<std::string>& at);

/// The cuts that the values of --plane ask for: "1,0,0,0.5=3", a normal and what follows "=" in --at.
std::vector<Cut> parse_planes(const std::vector<std::string>& planes);

/// A number and how it was typed.
struct SpelledNumber {
  double value = 0;
  std::string text;
};

/// "0,0.5,2" and "FIRST:LAST:COUNT" as numbers. Throws InvalidArgument, naming the option.
std::vector<SpelledNumber> parse_spelled_numbers(const std::string& option, std::string_view text);
std::vector<double> parse_numbers(const std::string& option, std::string_view text);

/// A normal or direction, "1,0,0,0.5". Throws InvalidArgument, naming the option, unless it is numbers and not 0.
std::vector<double> parse_normal(const std::string& option, std::string_view text);

/// A coordinate of the space that is cut, and its range in what lies there.
struct CutAxis {
  std::string name;
  double first = 0;
  double last = 0;
};

/// What is cut.
struct CutSpace {
  std::vector<CutAxis> axes;
  const char* of = "";  ///< what the ranges are those of, for messages
  /// #V x axes.size() coordinates of a saved contour, which has to outlive this; none of an image.
  std::span<const double> vertices = {};
};
CutSpace space_of(const AnyImage& image);
CutSpace space_of(const Mesh& mesh);

/// The factors that the values of --scale ask for, one for each axis: "t=10", "x=2,y=3". Throws InvalidArgument.
std::vector<double> parse_scale(const std::vector<std::string>& scale, const CutSpace& space);

/// The values, but for those that mean a vertex's coordinate and miss it by rounding: t = 0.1 of a contour that was
/// made in single precision, where the number nearest to it is another than in double. These are replaced by that
/// coordinate. They are known by all coordinates on the axis being numbers in single precision. `vertices`: #V x dim
/// coordinates.
std::vector<double> meet_vertices(std::vector<double> values, std::span<const double> vertices, std::size_t dim,
                                  std::size_t axis);

/// The cuts with the axes' own names and, in all cases, normals; and levels where values mean vertices. Throws
/// InvalidArgument for axes and normals that the space has not, EmptyResult for a cut outside of the space's extent
/// unless `allow_empty`.
std::vector<Cut> resolve(std::vector<Cut> cuts, const CutSpace& space, bool allow_empty);

/// The error of a cut outside of an axis's range, EmptyResult. `of`: what the range is of.
Error outside_error(const Cut& cut, const CutAxis& axis, std::string_view of);

/// The output of each cut: `pattern` with "{t}" or "{at}", or the axis as it was typed in braces, replaced by the
/// number as it was typed, "{axis}" by that axis, and "{n}" by the cut's place, 1 for the first, with as many digits as
/// the last one has. Throws InvalidArgument if two cuts had the same file.
std::vector<std::string> cut_outputs(const std::string& pattern, const std::vector<Cut>& cuts);

/// The output of each isovalue: `pattern` with "{iso}" replaced by the number as it was typed, and "{n}" by its place
/// as above; if there are several and neither is in it, with _NUMBER before its extension.
std::vector<std::string> isovalue_outputs(const std::string& pattern, const std::vector<SpelledNumber>& isovalues);

}  // namespace tegl::cli
