// SPDX-License-Identifier: BSD-3-Clause
//
// The layers that a cut across an axis reads, for callers that read an image layer by layer.
#include "extract/layers_of_cut.hpp"

namespace tegl {

template <Coordinate Real, int N>
requires DimensionBetween<N, 3, 5> LayerRange layers_of_cut(const Grid<N>& grid, int axis, double at,
                                                            const ExtractOptions& options) {
  detail::require_cut_axis<N>(axis);
  return detail::with_neighbours(detail::layers_around<N, Real>(grid, axis, at), grid.axes[axis].size(), options);
}

template LayerRange layers_of_cut<float>(const Grid<3>&, int, double, const ExtractOptions&);
template LayerRange layers_of_cut<double>(const Grid<3>&, int, double, const ExtractOptions&);
template LayerRange layers_of_cut<float>(const Grid<4>&, int, double, const ExtractOptions&);
template LayerRange layers_of_cut<double>(const Grid<4>&, int, double, const ExtractOptions&);
template LayerRange layers_of_cut<float>(const Grid<5>&, int, double, const ExtractOptions&);
template LayerRange layers_of_cut<double>(const Grid<5>&, int, double, const ExtractOptions&);

}  // namespace tegl
