// SPDX-License-Identifier: BSD-3-Clause
//
// Orientations of cells.
#include <cmath>

#include <Eigen/LU>

#include "base/workers.hpp"
#include "complex/cell_groups.hpp"

namespace tegl::detail {

namespace {

/// The differences of a shape's reference corners from their mean.
template <int N>
std::vector<std::array<double, N>> centred_corners(const tables::CellTable& table) {
  std::vector<std::array<double, N>> corners(table.corner_count);
  for (std::size_t i = 0; i < N; ++i) {
    double mean = 0;
    for (std::uint32_t v = 0; v < table.corner_count; ++v)
      mean += table.corners[v * N + i] / double(table.corner_count);
    for (std::uint32_t v = 0; v < table.corner_count; ++v) corners[v][i] = table.corners[v * N + i] - mean;
  }
  return corners;
}

/// Whether the best affine map from reference corners to points reverses the orientation.
template <int N>
bool is_inverted(const std::vector<std::array<double, N>>& reference, const Index* corners,
                 const std::vector<std::array<double, N>>& points) {
  Eigen::Matrix<double, N, N> map = Eigen::Matrix<double, N, N>::Zero();
  const std::array<double, N>& origin = points[corners[0]];
  for (std::size_t v = 0; v < reference.size(); ++v)
    for (int i = 0; i < N; ++i)
      for (int k = 0; k < N; ++k) map(i, k) += reference[v][i] * (points[corners[v]][k] - origin[k]);
  // very large and very small cells: the determinant's sign without overflow or underflow
  for (int k = 0; k < N; ++k) {
    const double largest = map.col(k).cwiseAbs().maxCoeff();
    if (largest == 0 || (largest > 0x1p-200 && largest < 0x1p200)) continue;
    const int exponent = std::ilogb(largest);
    for (int i = 0; i < N; ++i) map(i, k) = std::scalbn(map(i, k), -exponent);
  }
  return map.determinant() < 0;
}

}  // namespace

template <int N>
CellSigns find_cell_signs(const CellGroups& cells, const std::vector<std::array<double, N>>& points) {
  CellSigns signs;
  for (const CellGroup& group : cells.groups) {
    const auto reference = centred_corners<N>(table_of(group.shape));
    std::vector<std::uint64_t>& words = signs.emplace_back(block_count(group.size(), 64));
    for_each_item(words.size(), 0, {}, [&](std::size_t w) {
      for (std::size_t c = 64 * w; c < group.size() && c < 64 * (w + 1); ++c)
        words[w] |= std::uint64_t{is_inverted<N>(reference, group.cell(c), points)} << (c & 63u);
    });
  }
  return signs;
}
template CellSigns find_cell_signs<2>(const CellGroups&, const std::vector<std::array<double, 2>>&);
template CellSigns find_cell_signs<3>(const CellGroups&, const std::vector<std::array<double, 3>>&);
template CellSigns find_cell_signs<4>(const CellGroups&, const std::vector<std::array<double, 4>>&);

}  // namespace tegl::detail
