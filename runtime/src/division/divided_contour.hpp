// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of images whose cells are all divided alike, without storing the simplices. `extract_divided` uses it in 5D,
// where a cell has up to 1 920 simplices. In 2D to 4D tests compare it with complexes.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "division/missing_corners.hpp"
#include "image/sample_source.hpp"
#include "tegl/division.hpp"
#include "tegl/extract.hpp"

namespace tegl::detail {

/// The samples of a divided image, and what is known beside them.
template <int N>
struct DividedSamples {
  /// With the first coordinate of periodic axes once more at their ends.
  const Grid<N>& grid;
  unsigned periodic = 0;                ///< bit a: axis a is
  std::vector<Period<N>> periods = {};  ///< of the periodic axes, in the world
  /// For normals; null: none. The grid of the gradients' samples begins `before` samples before `grid`.
  const SampleGradients<N>* gradients = nullptr;
  const Grid<N>* gradient_grid = nullptr;
  std::array<std::size_t, N> before = {};
};

/// Extracts the contour of samples. `division`: kuhn or symmetric. `contour`: null to count only. Vertices are ordered
/// by cells; one that several cells share belongs to the last of them that has it. Simplices with a missing point are
/// left out; the contour is made a manifold beside them. Errors: those of extract_divided in 5D.
template <int N, class Real>
ExtractedSize extract_divided_cells(const DividedSamples<N>& samples, ReadSamples<N> read, Division division,
                                    double isovalue, const ExtractOptions& options, Contour<N, Real>* contour);

}  // namespace tegl::detail
