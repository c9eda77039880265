// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of images whose samples are cells: small squares, cubes or tesseracts around the samples' coordinates, not
// points. The contour runs between cells of high and of low value.
//
// Based on: M. Liversage, thesis, 1994, 5.3.5 (n-topology) and section 9.2.
#pragma once

#include <vector>

#include "tegl/contour.hpp"
#include "tegl/extract.hpp"
#include "tegl/image.hpp"
#include "tegl/positions.hpp"

namespace tegl {

/// Coordinates of the faces between the cells of an axis, one more than cells: midway between the samples, and half a
/// step outside of the first and of the last one. A single sample of a rectilinear axis has a cell of width 1.
[[nodiscard]] std::vector<double> cell_faces(const Axis& axis);

/// The coordinates of the faces between cells, by axis, one more than cells. An axis beyond the end of the list, or
/// with an empty list, has the faces of `cell_faces`.
using CellFaces = std::vector<std::vector<double>>;

/// As `extract_cells`, with counts and times.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Extraction<N, Real> extract_cells_with_stats(const Image<T, N>& image, double isovalue,
                                                           const PositionOptions& positions = {},
                                                           const ExtractOptions& options = {},
                                                           const CellFaces& faces = {});

/// Extracts the contour between the cells at or above the isovalue (high) and the others. Everything outside of the
/// image is low, and so are missing values. So the contour is always closed, at the outer faces of the cells.
///
/// With `Positions::linear`, the contour consists of the faces between high and low cells: its content is the sum of
/// the high cells' contents. Its vertices are the centres of the faces, of their edges, and so on. Cells that only
/// share an edge or a vertex are separated (Ambiguity::low) or joined (high) as `extract` separates or joins samples;
/// then several vertices lie at the same place, and the contour is an oriented manifold. In 4D, if a corner's contour
/// is a solid torus, the contour of the image is made of doubled cells instead: it has the same faces, and also
/// simplices of zero size. With `relaxed` and `gravitation`, the contour equals `extract_placed` for the cells'
/// centres: vertices lie on the edges between the centres of high and low cells, or beside them.
///
/// `faces`: for cells of uneven sizes, which do not follow from their centres; files give them in
/// ImageInfo::cell_faces. Errors: InvalidArgument unless each sample lies between the faces of its cell.
///
/// `options`: `ambiguity` low or high; `direction` and `work`; with `relaxed` and `gravitation` also `triangulation`
/// and `epsilon`. `close` is ignored. Errors: as `extract`; UnsupportedData for other rules of positions,
/// other rules for ambiguities, and normals from the image. Memory besides the contour: one byte per sample, and for
/// `linear` the facets (tegl/facet_hierarchy.hpp). Thread-safe; the result does not depend on the number of threads.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Contour<N, Real> extract_cells(const Image<T, N>& image, double isovalue,
                                             const PositionOptions& positions = {}, const ExtractOptions& options = {},
                                             const CellFaces& faces = {}) {
  return extract_cells_with_stats<Real>(image, isovalue, positions, options, faces).contour;
}

}  // namespace tegl
