// SPDX-License-Identifier: BSD-3-Clause
#include "division/cell_crossings.hpp"

#include <algorithm>
#include <bit>

#include <Eigen/Dense>

namespace tegl::detail {
namespace {

CellPoint cell_point(FacePoint face, int dim) {
  CellPoint point{face, {}, 0, 0};
  for (int a = 0; a < dim; ++a) {
    const unsigned axis = 1u << a;
    const bool is_upper = (face.low & axis) != 0;
    point.doubled[a] = (face.axes & axis) != 0 ? 1 : is_upper ? 2 : 0;
    if ((face.axes & axis) != 0) continue;
    point.sides |= std::uint64_t{1} << (is_upper ? 8 + a : a);
    if (is_upper) point.upper |= axis;
  }
  return point;
}

bool is_before(const std::array<std::uint8_t, 5>& first, const std::array<std::uint8_t, 5>& second) {
  return std::lexicographical_compare(first.rbegin(), first.rend(), second.rbegin(), second.rend());
}

/// Whether the simplex of points in this order is positive.
template <int N>
bool is_positive(const std::vector<CellPoint>& points, const std::array<std::uint8_t, N + 1>& simplex) {
  Eigen::Matrix<double, N, N> frame;
  for (int j = 0; j < N; ++j)
    for (int a = 0; a < N; ++a) frame(a, j) = points[simplex[j + 1]].doubled[a] - points[simplex[0]].doubled[a];
  return frame.determinant() > 0;
}

}  // namespace

template <int N>
CellCrossings<N>::CellCrossings(Division division) {
  const DividedCell<N> cell(division);
  add_points(cell);
  add_simplices(cell);
  add_sides();
  find_next();
}

template <int N>
void CellCrossings<N>::add_points(const DividedCell<N>& cell) {
  for (const FacePoint& face : cell.points) points_.push_back(cell_point(face, N));
  std::sort(points_.begin(), points_.end(),
            [](const CellPoint& first, const CellPoint& second) { return is_before(first.doubled, second.doubled); });
  edge_of_.assign(points_.size() * points_.size(), 0);
}

template <int N>
std::size_t CellCrossings<N>::point_at(const std::array<std::uint8_t, 5>& doubled) const {
  const auto found =
      std::lower_bound(points_.begin(), points_.end(), doubled,
                       [](const CellPoint& point, const auto& at) { return is_before(point.doubled, at); });
  return static_cast<std::size_t>(found - points_.begin());
}

template <int N>
std::uint16_t CellCrossings<N>::edge_between(std::uint8_t first, std::uint8_t second) {
  std::uint16_t& number = edge_of_[first * points_.size() + second];
  if (number == 0) {
    edges_.push_back({first, second});
    number = static_cast<std::uint16_t>(edges_.size());
  }
  return static_cast<std::uint16_t>(number - 1);
}

template <int N>
void CellCrossings<N>::add_simplices(const DividedCell<N>& cell) {
  for (const auto& numbers : cell.simplices) {
    Simplex& simplex = simplices_.emplace_back();
    for (int j = 0; j <= N; ++j)
      simplex.points[j] = static_cast<std::uint8_t>(point_at(cell_point(cell.points[numbers[j]], N).doubled));
    std::sort(simplex.points.begin(), simplex.points.end());
    for (const std::uint8_t p : simplex.points)
      if (points_[p].face.axes == 0) simplex.corners |= std::uint32_t{1} << points_[p].face.low;
    simplex.is_positive = is_positive<N>(points_, simplex.points);
    for (int i = 0; i <= N; ++i)
      for (int j = i + 1; j <= N; ++j)
        simplex.crossings[edge_number<N>(i, j)] = edge_between(simplex.points[i], simplex.points[j]);
  }
}

template <int N>
void CellCrossings<N>::add_sides() {
  for (int side = 0; side < 2 * N; ++side) {
    const std::uint64_t bit = std::uint64_t{1} << (side < N ? side : 8 + side - N);
    Side& result = sides_.emplace_back(Side{bit, {}});
    for (const Simplex& simplex : simplices_) {
      const auto is_inside = [&](std::uint8_t p) { return (points_[p].sides & bit) == 0; };
      if (std::count_if(simplex.points.begin(), simplex.points.end(), is_inside) != 1) continue;
      const auto inside = std::find_if(simplex.points.begin(), simplex.points.end(), is_inside);
      const auto omitted = static_cast<int>(inside - simplex.points.begin());
      Simplex& cone = result.cones.emplace_back(simplex);
      // The apex is on the other side of the border, and moves to the first place.
      std::rotate(cone.points.begin(), cone.points.begin() + omitted, cone.points.begin() + omitted + 1);
      cone.is_positive = simplex.is_positive != (omitted % 2 == 0);
      for (int j = 1; j <= N; ++j) {
        cone.crossings[edge_number<N>(0, j)] = static_cast<std::uint16_t>(edges_.size() + cone.points[j]);
        for (int i = 1; i < j; ++i) cone.crossings[edge_number<N>(i, j)] = edge_between(cone.points[i], cone.points[j]);
      }
    }
  }
}

template <int N>
void CellCrossings<N>::find_next() {
  simplices_at_.resize(edges());
  for (std::size_t s = 0; s < simplices_.size(); ++s)
    for (const std::uint16_t edge : simplices_[s].crossings)
      simplices_at_[edge].push_back(static_cast<std::uint16_t>(s));
  in_next_.assign(count() << N, 0);
  const auto in_next_cell = [&](std::uint8_t p, unsigned along) {
    std::array<std::uint8_t, 5> doubled = points_[p].doubled;
    for (int a = 0; a < N; ++a)
      if ((along >> a & 1u) != 0) doubled[a] = 0;
    return static_cast<std::uint8_t>(point_at(doubled));
  };
  const auto in_first_cell = [&](std::uint8_t p, unsigned behind) {
    std::array<std::uint8_t, 5> doubled = points_[p].doubled;
    for (int a = 0; a < N; ++a)
      if ((behind >> a & 1u) != 0) doubled[a] = 2;
    return static_cast<std::uint8_t>(point_at(doubled));
  };
  for (std::size_t c = 0; c < count(); ++c) {
    const bool is_edge = c < edges();
    const std::uint8_t first = is_edge ? edges_[c][0] : static_cast<std::uint8_t>(c - edges());
    const std::uint8_t second = is_edge ? edges_[c][1] : first;
    upper_.push_back(static_cast<std::uint8_t>(points_[first].upper & points_[second].upper));
    unsigned behind = 0;
    for (int a = 0; a < N; ++a)
      behind |= unsigned{points_[first].doubled[a] == 0 && points_[second].doubled[a] == 0} << a;
    fixed_.push_back(static_cast<std::uint8_t>(upper_.back() | behind));
    const std::uint8_t from = in_first_cell(first, behind);
    in_first_.push_back(is_edge ? edge_between(from, in_first_cell(second, behind))
                                : static_cast<std::uint16_t>(edges() + from));
    for (unsigned along = 0; along < 1u << N; ++along) {
      if ((along & ~unsigned{upper_.back()}) != 0) continue;
      const std::uint8_t start = in_next_cell(first, along);
      in_next_[(c << N) + along] =
          is_edge ? edge_between(start, in_next_cell(second, along)) : static_cast<std::uint16_t>(edges() + start);
    }
  }
}

template class CellCrossings<2>;
template class CellCrossings<3>;
template class CellCrossings<4>;
template class CellCrossings<5>;

}  // namespace tegl::detail
