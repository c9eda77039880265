// SPDX-License-Identifier: BSD-3-Clause
//
// The class of complexes: construction, values, points, edges.
#include "tegl/complex.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/progress.hpp"
#include "complex/border_facets.hpp"
#include "complex/complex_caps.hpp"
#include "complex/complex_edges.hpp"
#include "complex/image_points.hpp"
#include "tegl/error.hpp"

namespace tegl {

namespace detail {
namespace {

/// Beyond this, sums of a cell's points could overflow.
constexpr double kLargestCoordinate = 0x1p1018;

/// Checks points and returns the largest absolute value of a coordinate.
template <int N>
double check_points(const std::vector<std::array<double, N>>& points) {
  if (points.size() > std::numeric_limits<Index>::max())
    throw Error(ErrorCode::TooLarge,
                fmt::format("{} points; expected at most {}", points.size(), std::numeric_limits<Index>::max()));
  double largest = 0;
  for (std::size_t p = 0; p < points.size(); ++p)
    for (const double x : points[p]) {
      if (!std::isfinite(x))
        throw Error(ErrorCode::InvalidArgument,
                    fmt::format("point {}: ({}); expected finite coordinates", p, fmt::join(points[p], ", ")));
      if (std::abs(x) > kLargestCoordinate)
        throw Error(ErrorCode::InvalidArgument,
                    fmt::format("point {}: ({}); expected coordinates from -{} to {}", p, fmt::join(points[p], ", "),
                                kLargestCoordinate, kLargestCoordinate));
      largest = std::max(largest, std::abs(x));
    }
  return largest;
}

std::vector<double> missing_values(std::size_t count) {
  return std::vector<double>(count, std::numeric_limits<double>::quiet_NaN());
}

}  // namespace

template <int N>
Complex<N> ComplexAccess::layered(std::vector<std::array<double, N>> points, CellGroups cells) {
  Complex<N> complex(std::move(points), std::span<const CellType>(), {});
  complex.cells_ = std::make_shared<const CellGroups>(std::move(cells));
  complex.signs_ = std::make_shared<const CellSigns>(find_cell_signs<N>(*complex.cells_, complex.points_));
  complex.is_layered_ = true;
  return complex;
}

template <int N>
Complex<N> ComplexAccess::oriented(std::vector<std::array<double, N>> points, CellType type,
                                   std::span<const Index> corners) {
  Complex<N> complex(std::move(points), type, corners);
  // All cells get the sign of the majority: only cells that are flat up to rounding differ from it.
  CellSigns signs = *complex.signs_;
  std::size_t inverted = 0;
  for (const std::vector<std::uint64_t>& words : signs)
    for (const std::uint64_t word : words) inverted += static_cast<std::size_t>(std::popcount(word));
  const std::uint64_t all = 2 * inverted > complex.cell_count() ? ~std::uint64_t{0} : 0;
  for (std::vector<std::uint64_t>& words : signs) std::fill(words.begin(), words.end(), all);
  complex.signs_ = std::make_shared<const CellSigns>(std::move(signs));
  return complex;
}

template <int N>
Complex<N> ComplexAccess::at_places(const Complex<N>& complex, std::vector<std::array<double, N>> places) {
  Complex<N> moved = complex;
  moved.points_ = std::move(places);
  moved.largest_coordinate_ = 0;
  moved.is_layered_ = false;
  return moved;
}

template <int N>
Complex<N> ComplexAccess::identified(const Complex<N>& complex, std::vector<std::array<double, N>> points,
                                     std::vector<double> values, std::span<const Index> number) {
  Complex<N> result(std::move(points), std::span<const CellType>(), {});
  CellGroups cells = *complex.cells_;
  for (CellGroup& group : cells.groups)
    for (Index& corner : group.corners) corner = number[corner];
  cells.polytopes.renumber(number);
  result.cells_ = std::make_shared<const CellGroups>(std::move(cells));
  result.signs_ = complex.signs_;
  result.values_ = std::move(values);
  // layers stay apart unless the last axis is periodic
  result.is_layered_ = complex.is_layered_;
  for (std::size_t p = 0; p < number.size() && result.is_layered_; ++p)
    result.is_layered_ = complex.points_[p][N - 1] == result.points_[number[p]][N - 1];
  return result;
}

template Complex<2> ComplexAccess::identified<2>(const Complex<2>&, std::vector<std::array<double, 2>>,
                                                 std::vector<double>, std::span<const Index>);
template Complex<3> ComplexAccess::identified<3>(const Complex<3>&, std::vector<std::array<double, 3>>,
                                                 std::vector<double>, std::span<const Index>);
template Complex<4> ComplexAccess::identified<4>(const Complex<4>&, std::vector<std::array<double, 4>>,
                                                 std::vector<double>, std::span<const Index>);

template Complex<2> ComplexAccess::at_places<2>(const Complex<2>&, std::vector<std::array<double, 2>>);
template Complex<3> ComplexAccess::at_places<3>(const Complex<3>&, std::vector<std::array<double, 3>>);
template Complex<4> ComplexAccess::at_places<4>(const Complex<4>&, std::vector<std::array<double, 4>>);

template Complex<2> ComplexAccess::oriented<2>(std::vector<std::array<double, 2>>, CellType, std::span<const Index>);
template Complex<3> ComplexAccess::oriented<3>(std::vector<std::array<double, 3>>, CellType, std::span<const Index>);
template Complex<4> ComplexAccess::oriented<4>(std::vector<std::array<double, 4>>, CellType, std::span<const Index>);

template Complex<3> ComplexAccess::layered<3>(std::vector<std::array<double, 3>>, CellGroups);
template Complex<4> ComplexAccess::layered<4>(std::vector<std::array<double, 4>>, CellGroups);

}  // namespace detail

template <int N>
requires DimensionBetween<N, 2, 4> Complex<N>::Complex(std::vector<Point> points, CellType type,
                                                       std::span<const Index> corners)
    : points_(std::move(points)), values_(detail::missing_values(points_.size())) {
  largest_coordinate_ = detail::check_points<N>(points_);
  cells_ = std::make_shared<const detail::CellGroups>(detail::group_cells(N, points_.size(), type, corners));
  signs_ = std::make_shared<const detail::CellSigns>(detail::find_cell_signs<N>(*cells_, points_));
}

template <int N>
requires DimensionBetween<N, 2, 4> Complex<N>::Complex(std::vector<Point> points, std::span<const CellType> types,
                                                       std::span<const Index> corners)
    : points_(std::move(points)), values_(detail::missing_values(points_.size())) {
  largest_coordinate_ = detail::check_points<N>(points_);
  cells_ = std::make_shared<const detail::CellGroups>(detail::group_cells(N, points_.size(), types, corners));
  signs_ = std::make_shared<const detail::CellSigns>(detail::find_cell_signs<N>(*cells_, points_));
}

template <int N>
requires DimensionBetween<N, 2, 4> Complex<N>::Complex(std::vector<Point> points, const CellLists& cells)
    : points_(std::move(points)), values_(detail::missing_values(points_.size())) {
  largest_coordinate_ = detail::check_points<N>(points_);
  cells_ = std::make_shared<const detail::CellGroups>(detail::group_cells(N, points_.size(), cells));
  signs_ = std::make_shared<const detail::CellSigns>(detail::find_cell_signs<N>(*cells_, points_));
}

template <int N>
requires DimensionBetween<N, 2, 4> std::size_t Complex<N>::cell_count()
const noexcept { return cells_->cell_count; }

template <int N>
requires DimensionBetween<N, 2, 4>
void Complex<N>::check_count(std::size_t count, const char* what) const {
  if (count != points_.size())
    throw Error(ErrorCode::InvalidArgument, fmt::format("{} {}; expected one for each of the {} points of the complex",
                                                        count, what, points_.size()));
}

template <int N>
requires DimensionBetween<N, 2, 4>
void Complex<N>::set_points(std::vector<Point> points) {
  check_count(points.size(), "points");
  const double largest = detail::check_points<N>(points);
  is_layered_ = is_layered_ && std::equal(points.begin(), points.end(), points_.begin(),
                                          [](const Point& a, const Point& b) { return a[N - 1] == b[N - 1]; });
  largest_coordinate_ = largest;
  points_ = std::move(points);
  signs_ = std::make_shared<const detail::CellSigns>(detail::find_cell_signs<N>(*cells_, points_));
}

template <int N>
requires DimensionBetween<N, 2, 4>
void Complex<N>::find_edges(const WorkOptions& work) {
  if (edges_ == nullptr)
    edges_ = std::make_shared<const detail::ComplexEdges>(detail::find_complex_edges(points_.size(), *cells_, work));
}

template <int N>
requires DimensionBetween<N, 2, 4>
void Complex<N>::find_border(const WorkOptions& work) {
  if (border_ == nullptr)
    border_ = std::make_shared<const detail::BorderFacets>(detail::find_border(points_.size(), *cells_, work));
}

template <int N>
requires DimensionBetween<N, 2, 4> std::size_t Complex<N>::edge_count()
const noexcept { return edges_ == nullptr ? 0 : edges_->ends.size(); }

template <int N>
requires DimensionBetween<N, 2, 4> ContourSize count(const Complex<N>& complex, double isovalue,
                                                     const ExtractOptions& options) {
  detail::check_complex_options(isovalue, options);
  ExtractStats stats;
  const Progress& progress = options.work.progress;
  const auto is_missing = [](double value) { return std::isnan(value); };
  const bool may_extract =
      progress != nullptr && std::any_of(complex.values().begin(), complex.values().end(), is_missing);
  const detail::CellGroups& cells = detail::ComplexAccess::cells(complex);
  const Progress counting = detail::part_of(progress, 0.0, may_extract ? 0.5 : 1.0);
  const detail::ContourNumbers numbers(cells, detail::ComplexAccess::edges(complex), complex.values(), isovalue,
                                       options, detail::part_of(counting, 0.0, options.close ? 0.5 : 1.0), stats);
  // vertices where the contour touches itself at missing values are doubled
  if ((options.close && numbers.any_missing()) || !numbers.vertices_at_missing(cells).empty()) {
    ExtractOptions second_half = options;
    second_half.work.progress = detail::part_of(progress, 0.5, 1.0);
    const auto contour = extract<double>(complex, isovalue, second_half);
    return {contour.vertices.size(), contour.simplices.size()};
  }
  ContourSize size = numbers.size();
  if (const auto caps =
          detail::find_caps<N>(complex, numbers, nullptr, isovalue, options, detail::part_of(counting, 0.5, 1.0))) {
    size.vertices += caps->vertex_count();
    size.simplices += caps->simplices().size();
  }
  detail::tell(progress, 1.0);  // without shared points, the numbers end below it
  return size;
}

template <int N>
requires DimensionBetween<N, 2, 4> Attribute interpolate_points(const Complex<N>& complex, double isovalue,
                                                                std::span<const double> numbers, std::string name,
                                                                std::string unit, const ExtractOptions& options) {
  ExtractOptions of_numbers = options;
  of_numbers.normals = Normals::none;
  return detail::interpolate_as_places<N>(
      complex.points().size(), numbers, {std::move(name), std::move(unit), 1, {}},
      [&](std::vector<std::array<double, N>> places) {
        return extract<double>(detail::ComplexAccess::at_places<N>(complex, std::move(places)), isovalue, of_numbers);
      });
}

#define TEGL_INSTANTIATE_COMPLEXES(N)                                                                       \
  template ContourSize count<N>(const Complex<N>&, double, const ExtractOptions&);                          \
  template Attribute interpolate_points<N>(const Complex<N>&, double, std::span<const double>, std::string, \
                                           std::string, const ExtractOptions&);
TEGL_INSTANTIATE_COMPLEXES(2)
TEGL_INSTANTIATE_COMPLEXES(3)
TEGL_INSTANTIATE_COMPLEXES(4)
#undef TEGL_INSTANTIATE_COMPLEXES

template class Complex<2>;
template class Complex<3>;
template class Complex<4>;

}  // namespace tegl
