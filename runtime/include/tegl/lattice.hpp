// SPDX-License-Identifier: BSD-3-Clause
//
// Images whose samples are on a staggered lattice: triangular, face-centred cubic, body-centred cubic, D4. They need
// fewer samples than cubic grids for the same accuracy, and have fewer ambiguous cells or none.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "tegl/complex.hpp"
#include "tegl/image.hpp"
#include "tegl/periodic.hpp"

namespace tegl {

/// Lattices. Samples are an array as always, but the odd layers of the last axis (of the last but one for fcc_in_time)
/// are shifted by half a step along the axes before it.
enum class Lattice : std::uint8_t {
  triangular,   ///< 2D: triangles
  fcc,          ///< 3D, face-centred cubic: octahedra and tetrahedra
  bcc,          ///< 3D, body-centred cubic: tetrahedra
  d4,           ///< 4D: 16-cells
  fcc_in_time,  ///< 4D: fcc x time, the last axis: prisms of octahedra and tetrahedra
};

/// The name of a lattice, such as "fcc".
[[nodiscard]] std::string_view name_of(Lattice lattice) noexcept;
/// The lattice with this name, or none.
[[nodiscard]] std::optional<Lattice> parse_lattice(std::string_view name) noexcept;
/// Dimension of its images.
[[nodiscard]] int dimension(Lattice lattice) noexcept;
/// The step between layers, in steps along the other axes, for which the lattice has all its symmetries: sqrt(3) / 2
/// (triangular), sqrt(2) / 2 (fcc), 1 / 2 (bcc, d4). Other steps give a stretched lattice.
[[nodiscard]] double layer_step(Lattice lattice) noexcept;
/// The minimum number of layers: 3 for d4, whose cells extend over three layers, else 2.
[[nodiscard]] std::size_t least_layers(Lattice lattice) noexcept;

/// As `extract_lattice`, with counts and times.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Extraction<N, Real> extract_lattice_with_stats(const Image<T, N>& image, Lattice lattice, double isovalue,
                                                             const ExtractOptions& options = {},
                                                             const AxisPeriods<N>& periods = {});

/// Extracts the contour of an image on a lattice. Cells that would need samples outside of the image are left out, so
/// its sides are uneven; at the first and last layer, octahedra are cut to pyramids. Without missing values, caps and
/// periods, rows of samples are classified 64 at a time, and the cells are not stored; otherwise, and in 4D for rules
/// by the data and barycentric contours, the cells of `lattice_complex` are contoured. Both ways give the same vertices
/// and simplices, in another order.
///
/// ExtractOptions::close closes the contour at the uneven sides; caps are the high part of the border of
/// `lattice_complex`.
///
/// `periods`: of periodic axes (tegl/periodic.hpp; 0: not periodic). Cells across the seam connect the last samples to
/// the first ones, and the contour is wrapped (Contour::periods). The layers need an even number, at least 6, as the
/// odd ones are shifted; other periodic axes at least 3 samples.
///
/// ExtractOptions::ambiguity: on triangular and bcc there is no ambiguity. On fcc, fixed rules differ only in pyramids
/// at the first and last layer; rules by the data resolve their bases, and cells are stored. In fcc_in_time,
/// they resolve quadrilaterals between two times. `mean` and `saddle` decide the insides of octahedra and 16-cells
/// (tegl/ambiguity.hpp).
///
/// Normals (Normals::differences) come from gradients by least squares on a sample and its neighbours on the lattice,
/// interpolated along edges; they are exact for linear functions. Errors: those of `lattice_complex` and, for options,
/// of `extract` of complexes; InvalidArgument for other normals, periods that are not the number of samples x the step,
/// and cells of half a period or more (two steps across layers). The result does not depend on the number of threads.
/// O(P) time. Memory: for each row of samples along axis 0 about 40 bytes, and for every 64 samples begun 44
/// (triangular), 80 (fcc), 92 (bcc, fcc_in_time) or 152 (d4); so 1.3 bytes per sample of fcc in long rows, 4.8 of d4 in
/// rows of 40. Rows far from the contour need less. With normals: 8 N bytes for each sample beside it. In 4D the
/// contours of cells take up to about 2 MB (d4) or 10 MB (fcc_in_time). If cells are stored: twice the memory of
/// `lattice_complex`.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Contour<N, Real> extract_lattice(const Image<T, N>& image, Lattice lattice, double isovalue,
                                               const ExtractOptions& options = {}, const AxisPeriods<N>& periods = {}) {
  return extract_lattice_with_stats<Real>(image, lattice, isovalue, options, periods).contour;
}

/// Interpolates other numbers at the samples of an image on a lattice to the vertices of its contour, as an attribute.
/// `numbers`: #P x width, row = sample, axis 0 fastest; NaN: missing. The result has a row for each vertex of
/// `extract_lattice` with the same arguments; it is NaN where a number is missing at a sample that the vertex depends
/// on. Weights are those of the coordinates, as in `interpolate_points`. Errors: those of `extract_lattice`;
/// InvalidArgument if the size of `numbers` is not a multiple of the number of samples. Time: that of
/// `extract_lattice`, for N numbers per sample at a time.
template <Value T, int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Attribute interpolate_lattice(const Image<T, N>& image, Lattice lattice, double isovalue,
                                            std::span<const double> numbers, std::string name, std::string unit = {},
                                            const ExtractOptions& options = {}, const AxisPeriods<N>& periods = {});

/// The cells between the samples of an image on a lattice, with their values; points are numbered as samples,
/// axis 0 fastest. `extract` of it is the contour of the image. Cells that would need samples outside of the image are
/// left out, so its sides are uneven; at the first and last layer, octahedra are cut to pyramids. Errors:
/// InvalidArgument (a lattice of another dimension, uneven steps along a shifted axis, fewer than
/// `least_layers`), TooLarge (2^32 samples or cells or more). O(P) time; about 100 bytes per sample of fcc, 130 of bcc,
/// 110 of d4.
template <Value T, int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Complex<N> lattice_complex(const Image<T, N>& image, Lattice lattice);

}  // namespace tegl
