// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of images larger than memory: layers along the last axis are read one by one, and the contour is written in
// parts. Several isovalues take one pass over the layers.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "tegl/extract.hpp"
#include "tegl/lattice.hpp"
#include "tegl/layers.hpp"
#include "tegl/periodic.hpp"

namespace tegl {

/// Receives a contour in parts, in the order of vertex and simplex numbers. Its exceptions end the extraction and reach
/// the caller.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
class ContourSink {
 public:
  using Vertex = std::array<Real, N>;  ///< a point, N coordinates
  /// N vertex numbers.
  using Simplex = std::array<std::uint64_t, N>;
  ContourSink() = default;
  ContourSink(const ContourSink&) = delete;
  ContourSink& operator=(const ContourSink&) = delete;
  virtual ~ContourSink() = default;

  /// Receives the next vertices. The first vertex has number 0.
  virtual void add_vertices(std::span<const Vertex> vertices) = 0;
  /// If ExtractOptions::normals is not `none`: receives the normals of the vertices just added. By default throws
  /// InvalidArgument.
  virtual void add_normals(std::span<const Vertex> /*normals*/) {
    throw Error(ErrorCode::InvalidArgument, "normals for a sink that takes none; expected one with add_normals");
  }
  /// Receives the next simplices. Their vertices may be added later.
  virtual void add_simplices(std::span<const Simplex> simplices) = 0;
  /// Replaces a vertex number of a simplex that was added before: next to missing values, sheets that touch are
  /// separated.
  virtual void replace_corner(std::uint64_t simplex, int corner, std::uint64_t vertex) = 0;
};

/// As `extract`, for an image read by layers and a contour written in parts: the same vertices, normals and simplices
/// with the same numbers, but numbered by 64 bits. Memory: three layers of samples (four with normals, more if layers
/// are small), the contour between two layers, and the data to separate sheets at missing values or to close the
/// contour at the image border. Errors: those of `extract` except TooLarge, and exceptions of the reader and the sink.
///
/// With periods that are not all 0, as `extract_periodic`: the same simplices in the same order, but vertices are
/// numbered by first appearance, and copies at missing values may be others (in 4D also some simplices of zero size
/// there). contour_periods gives the periods of the contour. If the last axis is periodic, two more layers of samples
/// and the numbers of the vertices in the first layer stay in memory; with normals, the reader's last layer is
/// requested first and stays, too. Errors: also those of `extract_periodic`.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 4> ExtractedSize extract_streamed(LayerReader<T, N>& layers, double isovalue,
                                                                  ContourSink<N, Real>& sink,
                                                                  const ExtractOptions& options = {},
                                                                  const AxisPeriods<N>& periods = {});

/// One of the contours of extract_streamed_several: its isovalue and the sink that receives it.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
struct StreamedContour {
  double isovalue = 0;                   ///< finite
  ContourSink<N, Real>* sink = nullptr;  ///< receives the contour; not owned
};

/// As extract_streamed for each isovalue: the same vertices, normals and simplices in the same order. Returns their
/// sizes, counts and times in the order of `contours`. Layers are read once. All contours advance together, layer by
/// layer; each is a task of its own for the threads of `options`, whose number does not grow with the number of
/// contours. The reader is called by the calling thread. Sinks are called by any thread, but never concurrently with
/// each other or with the reader. Memory: the layers of extract_streamed once, the rest of its memory for each
/// isovalue. Errors: those of extract_streamed, from the first contour that fails; InvalidArgument for a null sink. The
/// other contours are then incomplete.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 4> std::vector<ExtractedSize> extract_streamed_several(
    LayerReader<T, N>& layers, std::type_identity_t<std::span<const StreamedContour<N, Real>>> contours,
    const ExtractOptions& options = {}, const AxisPeriods<N>& periods = {});

/// As `extract_lattice` for each isovalue, for an image on a lattice that is read by layers: the same vertices and
/// simplices, and normals that differ by rounding at most. In 2D and 3D, numbers are the same as well, except with
/// ambiguity resolved from the data on fcc, with missing values, caps or periods. There and in 4D (d4, fcc_in_time),
/// vertices are numbered as they first appear, and simplices are passed part by part. Copies at missing values may be
/// others (in 4D also some simplices of zero size there).
///
/// The reader and the sinks are called by the calling thread. Layers are read once, in ascending order; if the last
/// axis is periodic, the last four are requested first, and stay in memory with the first six. 2D and 3D: parts of 16
/// layers or more are contoured together with up to ten layers around them, so this takes up to 1.6 times as long as
/// the whole image in memory (3 times with normals), and memory holds these layers and their contour. In 4D, with
/// ambiguity from the data on fcc, with caps, with periods, and from the first missing value on, the cells of parts of
/// 2 layers or more are stored, and memory holds them and up to ten layers more, with ExtractOptions::close also the
/// cells of up to six layers around them, and with missing values the simplices beside them. Errors: those of
/// `extract_lattice` except TooLarge of the whole image, and of the reader and the sinks; InvalidArgument for a null
/// sink.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 4> std::vector<ExtractedSize> extract_lattice_streamed_several(
    LayerReader<T, N>& layers, Lattice lattice,
    std::type_identity_t<std::span<const StreamedContour<N, Real>>> contours, const ExtractOptions& options = {},
    const AxisPeriods<N>& periods = {});

/// As extract_lattice_streamed_several, for one isovalue.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 4> ExtractedSize extract_lattice_streamed(LayerReader<T, N>& layers, Lattice lattice,
                                                                          double isovalue, ContourSink<N, Real>& sink,
                                                                          const ExtractOptions& options = {},
                                                                          const AxisPeriods<N>& periods = {}) {
  const StreamedContour<N, Real> contour{isovalue, &sink};
  return extract_lattice_streamed_several<Real>(layers, lattice, std::span(&contour, 1), options, periods).front();
}

/// Contour::periods of the contours of an image on `grid` with periodic axes; empty if there are none.
template <int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] std::vector<Period<N>> contour_periods(const Grid<N>& grid, const AxisPeriods<N>& periods);

}  // namespace tegl
