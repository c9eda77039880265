// SPDX-License-Identifier: BSD-3-Clause
//
// Conversion to meshoptimizer's format: 32-bit indices, coordinates in single precision.
#include "simplify/simplify_fast.hpp"

#include <algorithm>

#include "tegl/error.hpp"
#include "tegl/simplify.hpp"

#ifdef TEGL_HAS_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif

namespace tegl {

bool has_fast_simplify() noexcept {
#ifdef TEGL_HAS_MESHOPTIMIZER
  return true;
#else
  return false;
#endif
}

namespace detail {

#ifdef TEGL_HAS_MESHOPTIMIZER

std::vector<std::array<Index, 3>> simplify_fast(std::span<const std::array<Index, 3>> triangles,
                                                std::span<const PointN<3>> points, std::size_t count, double max_error,
                                                bool border_fixed) {
  static_assert(sizeof(Index) == sizeof(unsigned int));
  std::vector<std::array<Index, 3>> result(triangles.size());
  if (triangles.empty()) return result;
  // Translate to the origin, where single precision is finest.
  PointN<3> low = points[0];
  for (const PointN<3>& point : points)
    for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], point[a]);
  std::vector<std::array<float, 3>> positions(points.size());
  for (std::size_t v = 0; v < points.size(); ++v)
    for (int a = 0; a < 3; ++a) positions[v][a] = static_cast<float>(points[v][a] - low[a]);
  const float size = meshopt_simplifyScale(positions[0].data(), positions.size(), sizeof(positions[0]));
  const double relative = size > 0.0f ? max_error / static_cast<double>(size) : 1.0;
  const std::size_t left =
      meshopt_simplify(result[0].data(), triangles[0].data(), 3 * triangles.size(), positions[0].data(),
                       positions.size(), sizeof(positions[0]), 3 * count, static_cast<float>(std::min(relative, 1e6)),
                       border_fixed ? meshopt_SimplifyLockBorder : 0, nullptr);
  result.resize(left / 3);
  return result;
}

#else

std::vector<std::array<Index, 3>> simplify_fast(std::span<const std::array<Index, 3>> /*triangles*/,
                                                std::span<const PointN<3>> /*points*/, std::size_t /*count*/,
                                                double /*max_error*/, bool /*border_fixed*/) {
  throw Error(ErrorCode::InvalidArgument,
              "this build has no meshoptimizer, which the method fast needs; expected quadric, facets or vertices");
}

#endif

}  // namespace detail
}  // namespace tegl
