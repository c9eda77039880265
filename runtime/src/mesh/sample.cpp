// SPDX-License-Identifier: BSD-3-Clause
//
// Multilinear interpolation of images at the vertices of contours; see tegl/sample.hpp.
#include "tegl/sample.hpp"

#include <algorithm>
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

  using Corners = std::array<double, std::size_t{1} << N>;

  /// Reads the samples at the corners of the cell.
  void read(const detail::CellPlace<N>& place, Corners& values) const noexcept {
    samples_.corner_values(place.base, axes_, values.data());
  }
  /// The value at the place. NaN if missing samples have more than kSlack of the weight.
  [[nodiscard]] double value_at(const detail::CellPlace<N>& place, const Corners& values) const noexcept {
    double sum = 0.0;
    if (axes_ == (1u << N) - 1) {
      sum = sum_of_all(place, values, std::make_index_sequence<std::size_t{1} << N>());
    } else {
      const Corners weights = weights_at(place);
      for (std::size_t i = 0; i < corners_; ++i) sum += weights[i] * values[i];
    }
    // Missing samples and infinite ones of weight 0 make NaN, too.
    return std::isnan(sum) ? of_present(place, values) : sum;
  }

 private:
  /// The sum over the corners of a cell along all axes, with the operations of `weights_at`; unrolled.
  template <std::size_t... C>
  [[nodiscard]] static double sum_of_all(const detail::CellPlace<N>& place, const Corners& values,
                                         std::index_sequence<C...>) noexcept {
    std::array<std::array<double, 2>, N> factors;
    for (int a = 0; a < N; ++a) factors[a] = {1.0 - place.share[a], place.share[a]};
    const auto weight = [&factors]<std::size_t... A>(std::size_t corner, std::index_sequence<A...>) {
      return (... * factors[A][corner >> A & 1u]);
    };
    double sum = 0.0;
    ((sum += weight(C, std::make_index_sequence<N>()) * values[C]), ...);
    return sum;
  }

  [[nodiscard]] Corners weights_at(const detail::CellPlace<N>& place) const noexcept {
    Corners weights;
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
    return weights;
  }

  [[nodiscard, gnu::noinline]] double of_present(const detail::CellPlace<N>& place,
                                                 const Corners& values) const noexcept {
    const Corners weights = weights_at(place);
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
  const CellInterpolation<N> interpolation(samples, grid);
  // A few vertices at a time, so that the processor waits for the samples of several.
  constexpr std::size_t kFew = 64;
  detail::for_each_part(contour.vertex_count(), work.threads, work.progress, [&](std::size_t first, std::size_t end) {
    std::array<detail::CellPlace<N>, kFew> places;
    std::array<bool, kFew> are_inside;
    std::array<typename CellInterpolation<N>::Corners, kFew> corners;
    for (std::size_t from = first; from < end; from += kFew) {
      const std::size_t count = std::min(kFew, end - from);
      for (std::size_t i = 0; i < count; ++i)
        are_inside[i] = locator.find(contour.point(static_cast<Index>(from + i)), places[i]);
      for (std::size_t i = 0; i < count; ++i)
        if (are_inside[i]) interpolation.read(places[i], corners[i]);
      for (std::size_t i = 0; i < count; ++i)
        values[from + i] =
            are_inside[i] ? interpolation.value_at(places[i], corners[i]) : std::numeric_limits<double>::quiet_NaN();
    }
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
