// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of several isovalues of an image that is larger than memory, in one pass over it.
#pragma once

#include <span>

#include "tegl/stream.hpp"

namespace tegl {

/// One of the contours of extract_streamed_several: its isovalue, where it goes, and how large it became.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
struct StreamedContour {
  double isovalue = 0;                   ///< finite
  ContourSink<N, Real>* sink = nullptr;  ///< where the contour goes; not owned
  StreamedSize size = {};                ///< set by the extraction
  ExtractStats stats = {};               ///< likewise
};

/// What extract_streamed gives for each isovalue, each with the same vertices, normals and simplices in the same order;
/// the layers are read once. All contours are at the same layers, each a task of its own for the threads of `options`,
/// which are no more however many contours there are. The reader is called by the thread of the caller; sinks by others
/// as well, but never two of them, nor one and the reader, at the same time. Memory: the layers of extract_streamed
/// once, and the rest of it for each isovalue. Errors: those of extract_streamed, of the first contour that had any;
/// InvalidArgument for a sink that is null. The contours of the others are then unfinished.
template <class Real = float, Value T, int N>
requires DimensionBetween<N, 2, 4>
void extract_streamed_several(LayerReader<T, N>& layers, std::span<StreamedContour<N, Real>> contours,
                              const ExtractOptions& options);

}  // namespace tegl
