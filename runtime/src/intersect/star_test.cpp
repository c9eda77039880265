// SPDX-License-Identifier: BSD-3-Clause
//
// The three conditions of star_test.hpp, with bounds of rounding errors.
#include "intersect/star_test.hpp"

#include <algorithm>
#include <cmath>

namespace tegl::detail {

template <int N>
StarTest<N>::StarTest(const SimplexPlanes<N>& simplices) : simplices_(simplices), balance_(kMostLink * kMostLink) {}

/// Numbers the vertices of the link and lists its simplices. The link simplex of corner i of a simplex has the other
/// corners in their order, the last two swapped if i is odd.
template <int N>
bool StarTest<N>::number_link(Index v, std::span<const Index> star) {
  link_.clear();
  link_rows_.clear();
  for (const Index s : star) {
    const auto& simplex = simplices_.simplex(s);
    int corner = 0;
    while (simplex[corner] != v) ++corner;
    std::array<std::uint8_t, N - 1> row;
    for (int i = 0, next = 0; i < N; ++i) {
      if (i == corner) continue;
      std::size_t number = 0;
      while (number < link_.size() && link_[number] != simplex[i]) ++number;
      if (number == link_.size()) {
        if (number == kMostLink) return false;
        link_.push_back(simplex[i]);
      }
      row[next++] = static_cast<std::uint8_t>(number);
    }
    if constexpr (N > 2)
      if (corner % 2 != 0) std::swap(row[N - 2], row[N - 3]);
    link_rows_.push_back(row);
  }
  return true;
}

/// Condition 1. The faces of an oriented edge (p, q) are q - p; those of a triangle its three oriented edges.
template <int N>
bool StarTest<N>::is_closed() {
  const auto visit_faces = [&](const auto& visit) {
    for (const auto& row : link_rows_) {
      if constexpr (N == 3) {
        visit(row[0], -1);
        visit(row[1], 1);
      } else if constexpr (N == 4) {
        for (std::size_t i = 0; i < 3; ++i) {
          const std::size_t p = row[i], q = row[(i + 1) % 3];
          visit(std::min(p, q) * kMostLink + std::max(p, q), p < q ? 1 : -1);
        }
      }
    }
  };
  std::size_t unbalanced = 0;
  visit_faces([&](std::size_t entry, int sign) {
    std::int16_t& balance = balance_[entry];
    unbalanced -= balance != 0 ? 1 : 0;
    balance = static_cast<std::int16_t>(balance + sign);
    unbalanced += balance != 0 ? 1 : 0;
  });
  if (unbalanced != 0) visit_faces([&](std::size_t entry, int) { balance_[entry] = 0; });
  return unbalanced == 0;
}

template <int N>
bool StarTest<N>::is_direction(std::span<const Index> star) const {
  return std::all_of(star.begin(), star.end(),
                     [&](Index s) { return simplices_.plane(s).side_of_vector(direction_) > 0; });
}

/// Condition 2: a direction whose scalar products with all normals are positive. Starts with their mean and adds the
/// normal of a simplex that is not on this side until there is none (F. Rosenblatt's perceptron).
template <int N>
bool StarTest<N>::find_direction(std::span<const Index> star) {
  PointN<N> sum{};
  const auto add = [&](Index s) {
    const PointN<N>& normal = simplices_.plane(s).normal;
    const double length = norm(normal);
    if (!(length > 0.0 && std::isfinite(length))) return false;
    for (int a = 0; a < N; ++a) sum[a] += normal[a] / length;
    return true;
  };
  for (const Index s : star)
    if (!add(s)) return false;
  constexpr int kMostRounds = 12;
  for (int round = 0; round < kMostRounds; ++round) {
    const double largest = largest_of<N>(sum);
    if (!(largest > 0.0)) return false;
    for (int a = 0; a < N; ++a) direction_[a] = sum[a] / largest;
    if (is_direction(star)) return true;
    for (const Index s : star)
      if (dot(simplices_.plane(s).normal, sum) <= 0.0) add(s);
  }
  return false;
}

/// Projects the link along the direction, without the axis on which the direction is longest. With size the largest
/// component of the difference of two vertices, a component of the projection has an error of at most 6 u size.
template <int N>
void StarTest<N>::project_link(Index v) {
  int axis = 0;
  for (int a = 1; a < N; ++a)
    if (std::abs(direction_[a]) > std::abs(direction_[axis])) axis = a;
  projected_.resize(link_.size());
  sizes_.resize(link_.size());
  for (std::size_t i = 0; i < link_.size(); ++i) {
    const PointN<N> d = minus(simplices_.point(link_[i]), simplices_.point(v));
    const double height = d[axis] * direction_[axis];
    std::size_t next = 0;
    for (int a = 0; a < N; ++a)
      if (a != axis) projected_[i][next++] = d[a] - direction_[a] * height;
    sizes_[i] = largest_of<N>(d);
  }
}

/// The sign of the determinant of projected vectors; 0: unknown. `sizes`: the product of their sizes. All entries are
/// at most 2 sizes. For N = 4 there are 6 products of 3 entries with errors of 8 u from arithmetic and 3 * 6 u / 2 from
/// the entries, of at most 8 sizes: 6 * 8 * 17 = 816 u; for N = 3: 2 * 4 * (4 + 6) = 80 u.
template <int N>
int StarTest<N>::sign_of(const std::array<const Projected*, N - 1>& columns, double sizes) const {
  constexpr double kFactor = N == 4 ? 1024.0 : 128.0;
  double determinant = 0.0;
  if constexpr (N == 3) {
    const Projected &p = *columns[0], &q = *columns[1];
    determinant = p[0] * q[1] - p[1] * q[0];
  } else if constexpr (N == 4) {
    const Projected &p = *columns[0], &q = *columns[1], &r = *columns[2];
    determinant =
        p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2]) + p[2] * (q[0] * r[1] - q[1] * r[0]);
  }
  return sign_beyond(determinant, kFactor * kRounding * sizes + kUnderflow);
}

/// Condition 3, for a direction within the first cone: each other cone has a side that it lies beyond.
template <int N>
bool StarTest<N>::is_covered_once() {
  std::array<const Projected*, N - 1> columns;
  const auto load = [&](const std::array<std::uint8_t, N - 1>& row) {
    double sizes = 1.0;
    for (std::size_t i = 0; i + 1 < N; ++i) {
      columns[i] = &projected_[row[i]];
      sizes *= sizes_[row[i]];
    }
    return sizes;
  };
  const auto& first = link_rows_[0];
  const int orientation = sign_of(columns, load(first));
  if (orientation == 0) return false;
  Projected inner{};
  double inner_size = 0.0;
  for (const std::uint8_t i : first)
    for (std::size_t a = 0; a + 1 < N; ++a) inner[a] += projected_[i][a] / sizes_[i];
  for (const double x : inner) inner_size = std::max(inner_size, std::abs(x));
  for (std::size_t k = 1; k < link_rows_.size(); ++k) {
    const auto& row = link_rows_[k];
    const double sizes = load(row);
    bool is_beyond = false;
    for (std::size_t i = 0; i + 1 < N && !is_beyond; ++i) {
      const Projected* const replaced = columns[i];
      columns[i] = &inner;
      is_beyond = sign_of(columns, sizes / sizes_[row[i]] * inner_size) == -orientation;
      columns[i] = replaced;
    }
    if (!is_beyond) return false;
  }
  return true;
}

template <int N>
bool StarTest<N>::is_embedded(Index v, std::span<const Index> star) {
  if (N == 2 || star.size() < N || star.size() > 2 * kMostLink || !simplices_.is_filtered()) return false;
  if (!find_direction(star) || !number_link(v, star) || !is_closed()) return false;
  project_link(v);
  return is_covered_once();
}

template class StarTest<2>;
template class StarTest<3>;
template class StarTest<4>;

}  // namespace tegl::detail
