// SPDX-License-Identifier: BSD-3-Clause
//
// Measures of the components of a cut, summed over simplices: size, enclosed content, centroid and bounding box.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Dense>

#include "mesh/simplex_geometry.hpp"
#include "tegl/track.hpp"

namespace tegl::detail {

/// Sums of the contributions of simplices to a sample.
struct PartSums {
  bool open = false;
  bool has_near = false;         ///< of a wrapped contour: whether `near` is set
  std::array<double, 4> near{};  ///< a corner next to which the others are moved
  double directed = 0;           ///< of a wrapped contour: as PieceSums::directed
  double measure = 0;
  double content = 0;
  std::array<double, 4> moment{};
  std::array<double, 4> lower{kFar, kFar, kFar, kFar};
  std::array<double, 4> upper{-kFar, -kFar, -kFar, -kFar};

  static constexpr double kFar = std::numeric_limits<double>::infinity();

  /// `dim`: number of coordinates. `origin`: the point that the sums are relative to.
  [[nodiscard]] TrackSample to_sample(double time, int dim, const std::array<double, 4>& origin) const {
    TrackSample sample;
    sample.time = time;
    sample.measure = measure;
    if (!open && std::abs(directed) <= 1e-6 * measure) sample.content = content;
    for (int a = 0; a < dim; ++a) {
      // The centroid of a component of zero size is the middle of its box.
      const double middle = measure > 0 ? moment[a] / measure : 0.5 * (lower[a] + upper[a]);
      sample.centroid[a] = origin[a] + middle;
      sample.lower[a] = origin[a] + lower[a];
      sample.upper[a] = origin[a] + upper[a];
    }
    return sample;
  }
};

/// The cut of a simplex at a time above its first `low` vertices (sorted by time) and not above the others.
template <int N>
class CutCell {
 public:
  static constexpr int D = N - 1;  ///< dimension of the space of the cut
  using Place = Eigen::Matrix<double, D, 1>;
  using Corner = PointOf<N>;

  /// `corners`: the vertices sorted by time, relative to the origin.
  CutCell(const std::array<Corner, N>& corners, int low, double time) {
    const auto point = [&](int a, int b) {
      const double share = (time - corners[a][D]) / (corners[b][D] - corners[a][D]);
      for (int i = 0; i < D; ++i) points_[count_][i] = corners[a][i] + share * (corners[b][i] - corners[a][i]);
      ++count_;
    };
    low_ = low;
    for (int a = 0; a < low; ++a)
      for (int b = 0; b < N - low; ++b)
        point(a, a % 2 == 0 || N == 5 ? low + b : N - 1 - b);  // N = 4: cyclic order of a quadrilateral
  }

  /// `normal`: normal of the simplex towards the low side, of any length. `across`: of a wrapped contour, as in
  /// PieceSums; null for others.
  void add_to(PartSums& sums, const Corner& normal, const PointOf<D>* across) const {
    const Eigen::Map<const Place> outward(normal.data());  // its components within the cut
    const auto [size, centre] = size_and_centre();
    sums.measure += size;
    for (int a = 0; a < D; ++a) {
      sums.moment[a] += size * centre[a];
      for (int i = 0; i < count_; ++i) {
        sums.lower[a] = std::min(sums.lower[a], points_[i][a]);
        sums.upper[a] = std::max(sums.upper[a], points_[i][a]);
      }
    }
    const double length = outward.norm();
    if (length > 0 && across != nullptr) {
      const Eigen::Map<const Place> unit(across->data());
      const double directed = size * outward.dot(unit) / length;
      sums.directed += directed;
      sums.content += directed * centre.dot(unit);
    } else if (length > 0) {
      sums.content += size * outward.dot(points_[0]) / (length * D);
    }
  }

 private:
  [[nodiscard]] std::pair<double, Place> size_and_centre() const {
    if constexpr (D == 1) return {1.0, points_[0]};
    if constexpr (D == 2) return {(points_[1] - points_[0]).norm(), 0.5 * (points_[0] + points_[1])};
    if constexpr (D == 3) {
      double size = 0;
      Place moment = Place::Zero();
      for (int i = 2; i < count_; ++i) {
        const double area = 0.5 * (points_[i - 1] - points_[0]).cross(points_[i] - points_[0]).norm();
        size += area;
        moment += area / 3.0 * (points_[0] + points_[i - 1] + points_[i]);
      }
      return {size, size > 0 ? Place(moment / size) : points_[0]};
    }
    if constexpr (D == 4) {
      double size = 0;
      Place moment = Place::Zero();
      const auto add = [&](int i, int j, int k, int l) {
        Eigen::Matrix<double, 4, 3> edges;
        edges << points_[j] - points_[i], points_[k] - points_[i], points_[l] - points_[i];
        const double volume = std::sqrt(std::max(0.0, (edges.transpose() * edges).determinant())) / 6.0;
        size += volume;
        moment += volume / 4.0 * (points_[i] + points_[j] + points_[k] + points_[l]);
      };
      if (count_ == 4) {
        add(0, 1, 2, 3);
      } else if (low_ == 2) {  // a prism between the triangles 0, 1, 2 and 3, 4, 5
        add(0, 1, 2, 5);
        add(0, 1, 4, 5);
        add(0, 3, 4, 5);
      } else {  // a prism between the triangles 0, 2, 4 and 1, 3, 5
        add(0, 2, 4, 5);
        add(0, 2, 3, 5);
        add(0, 1, 3, 5);
      }
      return {size, size > 0 ? Place(moment / size) : points_[0]};
    }
  }

  std::array<Place, D == 4 ? 6 : 4> points_;
  int count_ = 0;
  int low_ = 0;
};

}  // namespace tegl::detail
