// SPDX-License-Identifier: BSD-3-Clause
//
// Multilinear interpolation of images at the vertices of contours; see tegl/sample.hpp.
#include "tegl/sample.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "base/periods.hpp"
#include "base/workers.hpp"
#include "image/locate.hpp"
#include "image/row_source.hpp"
#include "mesh/simplex_geometry.hpp"

namespace tegl {

namespace {

/// Interpolates between the corners of a cell.
template <int N>
class CellInterpolation {
 public:
  CellInterpolation(const detail::CornerValues<N>& samples, const Grid<N>& grid) : samples_(samples) {
    for (int a = 0; a < N; ++a) axes_ |= grid.axes[a].size() > 1 ? 1u << a : 0u;
    corners_ = std::size_t{1} << std::popcount(axes_);
  }

  /// NaN if missing samples have more than kSlack of the weight.
  [[nodiscard]] double operator()(const detail::CellPlace<N>& place) const noexcept {
    Corners values;
    Corners weights;
    samples_.corner_values(place.base, axes_, values.data());
    weights[0] = 1.0;
    std::size_t count = 1;
    for (int a = 0; a < N; ++a) {
      if ((axes_ >> a & 1u) == 0) continue;
      for (std::size_t i = 0; i < count; ++i) {
        weights[i + count] = weights[i] * place.share[a];
        weights[i] *= 1.0 - place.share[a];
      }
      count *= 2;
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < corners_; ++i) sum += weights[i] * values[i];
    // Missing samples and infinite ones of weight 0 make NaN, too.
    return std::isnan(sum) ? of_present(values, weights) : sum;
  }

 private:
  using Corners = std::array<double, std::size_t{1} << N>;

  [[nodiscard]] double of_present(const Corners& values, const Corners& weights) const noexcept {
    double sum = 0.0;
    double present = 0.0;
    for (std::size_t i = 0; i < corners_; ++i) {
      if (weights[i] == 0.0 || std::isnan(values[i])) continue;
      present += weights[i];
      sum += weights[i] * values[i];
    }
    if (present < 1.0 - detail::kSlack) return std::numeric_limits<double>::quiet_NaN();
    // Weights add up to 1 up to rounding: do not divide by that.
    return present < 1.0 - 1e-12 ? sum / present : sum;
  }

  const detail::CornerValues<N>& samples_;
  unsigned axes_ = 0;  ///< with more than one sample
  std::size_t corners_ = 1;
};

/// Interpolates at all vertices. Compiled once for all value types.
template <int N>
void interpolate(const detail::CornerValues<N>& samples, const Grid<N>& grid, const detail::SimplexView<N>& contour,
                 const WorkOptions& work, Buffer<double>& values) {
  const detail::GridLocator<N> locator(grid);
  const CellInterpolation<N> value_at(samples, grid);
  detail::for_each_item(contour.vertex_count(), work.threads, work.progress, [&](std::size_t v) {
    const std::array<double, N> point = contour.point(static_cast<Index>(v));
    detail::CellPlace<N> place;
    values[v] = locator.find(point, place) ? value_at(place) : std::numeric_limits<double>::quiet_NaN();
  });
}

}  // namespace

template <Value T, int N, Coordinate Real>
requires DimensionBetween<N, 2, 5> Attribute sample(const Image<T, N>& image, const Contour<N, Real>& contour,
                                                    std::string name, std::string unit, const WorkOptions& work) {
  detail::require_unwrapped(contour, "sample");
  Attribute attribute{std::move(name), std::move(unit), 1, {}};
  attribute.values.resize(contour.vertices.size());
  interpolate(detail::ImageSource<T, N>(image, 0.0, 0.0), image.grid(), detail::SimplexView<N>(contour), work,
              attribute.values);
  return attribute;
}

#define TEGL_INSTANTIATE_DIMENSIONS(T, N)                                                            \
  template Attribute sample(const Image<T, N>&, const Contour<N, float>&, std::string, std::string,  \
                            const WorkOptions&);                                                     \
  template Attribute sample(const Image<T, N>&, const Contour<N, double>&, std::string, std::string, \
                            const WorkOptions&);
#include "base/instantiate.hpp"

}  // namespace tegl
