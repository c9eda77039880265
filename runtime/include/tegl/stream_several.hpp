// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of several isovalues of an image larger than memory, in one pass over the image.
#pragma once

#include <span>

#include "tegl/stream.hpp"

namespace tegl {

/// One of the contours of extract_streamed_several: isovalue, destination, and size.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
struct StreamedContour {
  double isovalue = 0;                   ///< finite
  ContourSink<N, Real>* sink = nullptr;  ///< receives the contour; not owned
  StreamedSize size = {};                ///< set by the extraction
  ExtractStats stats = {};               ///< set by the extraction
};

/// As extract_streamed for each isovalue: the same vertices, normals and simplices in the same order. Layers are read
/// once. All contours advance together, layer by layer; each is a task of its own for the threads of `options`, whose
/// number does not grow with the number of contours. The reader is called by the calling thread. Sinks are called by
/// any thread, but never concurrently with each other or with the reader. Memory: the layers of extract_streamed once,
/// the rest of its memory for each isovalue. Errors: those of extract_streamed, from the first contour that fails;
/// InvalidArgument for a null sink. The other contours are then incomplete.
template <class Real = float, Value T, int N>
requires DimensionBetween<N, 2, 4>
void extract_streamed_several(LayerReader<T, N>& layers, std::span<StreamedContour<N, Real>> contours,
                              const ExtractOptions& options);

}  // namespace tegl
