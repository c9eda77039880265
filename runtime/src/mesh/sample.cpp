// SPDX-License-Identifier: BSD-3-Clause
//
// Multilinear interpolation of images at the vertices of contours; see tegl/sample.hpp.
#include "tegl/sample.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "base/periods.hpp"
#include "base/workers.hpp"
#include "image/locate.hpp"
#include "image/row_source.hpp"
#include "mesh/simplex_geometry.hpp"

namespace tegl {

namespace {

/// The interpolated value at a place of a cell; NaN if missing samples have more than kSlack of the weight.
template <int N>
double value_at(const detail::CornerValues<N>& samples, const detail::CellPlace<N>& place) noexcept {
  double sum = 0.0;
  double present = 0.0;
  for (unsigned corner = 0; corner < 1u << N; ++corner) {
    double weight = 1.0;
    std::array<std::size_t, N> index = place.base;
    for (int a = 0; a < N; ++a) {
      const bool ahead = (corner >> a & 1u) != 0;
      weight *= ahead ? place.share[a] : 1.0 - place.share[a];
      index[a] += ahead ? 1 : 0;
    }
    // This also skips the index beyond the end of an axis with one sample.
    if (weight == 0.0) continue;
    const auto value = samples.value(index);
    if (std::isnan(value)) continue;
    present += weight;
    sum += weight * value;
  }
  if (present < 1.0 - detail::kSlack) return std::numeric_limits<double>::quiet_NaN();
  // Weights add up to 1 up to rounding: do not divide by that.
  return present < 1.0 - 1e-12 ? sum / present : sum;
}

/// Interpolates at all vertices. Compiled once for all value types.
template <int N>
void interpolate(const detail::CornerValues<N>& samples, const Grid<N>& grid, const detail::SimplexView<N>& contour,
                 const WorkOptions& work, Buffer<double>& values) {
  const detail::GridLocator<N> locator(grid);
  detail::for_each_item(contour.vertex_count(), work.threads, work.progress, [&](std::size_t v) {
    const std::array<double, N> point = contour.point(static_cast<Index>(v));
    detail::CellPlace<N> place;
    values[v] = locator.find(point, place) ? value_at(samples, place) : std::numeric_limits<double>::quiet_NaN();
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
