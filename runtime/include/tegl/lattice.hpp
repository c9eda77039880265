// SPDX-License-Identifier: BSD-3-Clause
//
// Images whose samples are on a staggered lattice: triangular, face-centred cubic, body-centred cubic, D4. They need
// fewer samples than cubic grids for the same accuracy, and have fewer ambiguous cells or none.
#pragma once

#include <cstdint>
#include <string_view>

#include "tegl/complex.hpp"
#include "tegl/image.hpp"

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
/// Dimension of its images.
[[nodiscard]] int dimension(Lattice lattice) noexcept;
/// The step between layers, in steps along the other axes, for which the lattice has all its symmetries: sqrt(3) / 2
/// (triangular), sqrt(2) / 2 (fcc), 1 / 2 (bcc, d4). Other steps give a stretched lattice.
[[nodiscard]] double layer_step(Lattice lattice) noexcept;

/// As `extract_lattice`, with counts and times.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Extraction<N, Real> extract_lattice_with_stats(const Image<T, N>& image, Lattice lattice, double isovalue,
                                                             const ExtractOptions& options = {});

/// Extracts the contour of an image on a lattice. Cells that would need samples outside of the image are left out, so
/// its sides are uneven; at the first and last layer, octahedra are cut to pyramids. In 2D and 3D without missing
/// values, rows of samples are classified 64 at a time, and the cells are not stored; otherwise the contour is that of
/// `lattice_complex`. Both have the same vertices and simplices, in another order.
///
/// Normals (Normals::differences) come from gradients by least squares on a sample and its neighbours on the lattice,
/// interpolated along edges; they are exact for linear functions. Errors: those of `lattice_complex`; InvalidArgument
/// for options that complexes do not have: close, ambiguity resolved from the data, Normals::sobel. The result does not
/// depend on the number of threads. O(P) time; in 2D and 3D about 1.3 bytes per sample of fcc.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Contour<N, Real> extract_lattice(const Image<T, N>& image, Lattice lattice, double isovalue,
                                               const ExtractOptions& options = {}) {
  return extract_lattice_with_stats<Real>(image, lattice, isovalue, options).contour;
}

/// The cells between the samples of an image on a lattice, with their values; points are numbered as samples,
/// axis 0 fastest. `extract` of it is the contour of the image. Cells that would need samples outside of the image are
/// left out, so its sides are uneven; at the first and last layer, octahedra are cut to pyramids. Errors:
/// InvalidArgument (a lattice of another dimension, uneven steps along a shifted axis, fewer than 2 layers), TooLarge
/// (2^32 samples or cells or more). O(P) time; about 100 bytes per sample of fcc, 130 of bcc, 110 of d4.
template <Value T, int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Complex<N> lattice_complex(const Image<T, N>& image, Lattice lattice);

}  // namespace tegl
