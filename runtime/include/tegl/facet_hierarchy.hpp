// SPDX-License-Identifier: BSD-3-Clause
//
// Contours as cell complexes: facets of every dimension with their incidences, without triangulation.
//
// Based on: M. Liversage, thesis, 1994, section 7.7 (the complete representation of a contour).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "tegl/complex.hpp"
#include "tegl/contour.hpp"
#include "tegl/division.hpp"
#include "tegl/extract.hpp"
#include "tegl/image.hpp"
#include "tegl/lattice.hpp"
#include "tegl/periodic.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// The face of the grid that contains a facet, or the cell of a complex.
struct FacetPlace {
  /// The face's lowest sample: i_0 + size_0 (i_1 + size_1 (i_2 + ...)). In a complex, the number of a cell that
  /// has the facet.
  std::uint64_t base;
  std::uint16_t signature;  ///< the face's high corners; bit v is the corner at v >> j & 1 along its j-th axis
  std::uint8_t axes;        ///< bit a: the face extends from its lowest sample to the next one along axis a
  std::uint8_t number;      ///< number of the facet among those in this face
  /// Whether the facet is a cap, added by ExtractOptions::close: the high part of a face of the image border. A cap has
  /// as many dimensions as its face; other facets have one less.
  bool is_cap;
};

/// The contour of an N-dimensional image, N = 2, 3, 4, as a complex of facets. A k-facet is a connected component of
/// the contour in a (k+1)-face of the grid: a point on an edge, a segment in a square, a polygon (usually not planar)
/// in a cube, a polyhedron in a tesseract. Points, segments and polygons are balls; polyhedra are balls or solid tori
/// (see facet_euler).
///
/// With Ambiguity::mean, saddle and custom, a cube's contour may have a tunnel, which is not a ball. Its triangles are
/// the polygons there, and the points and segments between them are 0- and 1-facets inside the cube. Polyhedra may have
/// a boundary of several components. With every rule except low and high, polyhedra may be balls with any number of
/// handles.
///
/// Facets of each dimension are numbered from 0. The order is by layers of the image along its last axis: first the
/// facets in a layer, then those between it and the next layer; within them row by row, for rows along axis 0; in a row
/// by the bits of `axes`, then along the row. Caps come last. Points on edges and in squares have the order of the
/// vertices of `extract` (which has further vertices between them where needed); points in cubes of 4D have another
/// order there.
///
/// Orientation: a k-facet with k < N - 1, followed by a normal towards high, is positive in its face with ascending
/// axes. (N-1)-facets are oriented as the simplices of `extract`, by ExtractOptions::direction. Points have no
/// orientation; segments inside of cubes have only the one from start to end. The incidence number of a facet in the
/// boundary of another is +1 or -1; the boundary of a boundary is zero.
template <int N, Coordinate Real = float>
requires DimensionBetween<N, 2, 4>
struct FacetHierarchy {
  using Vertex = std::array<Real, N>;  ///< a point, N coordinates

  /// Facets of one dimension.
  struct Level {
    Buffer<FacetPlace> places = {};  ///< #F
    Buffer<Index> down_first = {};   ///< #F + 1; empty for points
    Buffer<Index> down = {};         ///< facets of the next lower dimension; those of facet f start at down_first[f]
    Buffer<std::int8_t> down_signs = {};  ///< incidence numbers of `down`
    Buffer<Index> up_first = {};          ///< after connect_up: #F + 1; empty for (N-1)-facets
    Buffer<Index> up = {};                ///< facets of the next higher dimension, ascending
    Buffer<std::int8_t> up_signs = {};    ///< incidence numbers of this facet in `up`
  };

  std::array<Level, N> levels = {};            ///< by dimension k
  Buffer<Vertex> vertices = {};                ///< #0-facets x N world coordinates, row = 0-facet
  Buffer<Vertex> normals = {};                 ///< as vertices, of length 1 or 0, if requested; else empty
  std::array<std::size_t, N> sizes{};          ///< of the image; 0 for a complex
  std::size_t cells = 0;                       ///< of the complex; 0 for an image
  std::array<std::string, N> axis_names = {};  ///< taken from the grid
  std::array<std::string, N> axis_units = {};  ///< taken from the grid
  GradientDirection direction = GradientDirection::descent;  ///< the side that facets face
  std::vector<Period<N>> periods = {};  ///< as Contour::periods: facets across the seam connect points at both ends

  /// Number of facets of dimension k.
  [[nodiscard]] std::size_t count(int k) const noexcept { return levels[k].places.size(); }

  /// The boundary of facet f of dimension k >= 1. Segment: its start and its end. Polygon: its segments in order along
  /// its orientation, each starting at the end of the previous one. Polyhedron: its polygons.
  [[nodiscard]] std::span<const Index> down(int k, std::size_t f) const& noexcept {
    return part(levels[k].down, levels[k].down_first, f);
  }
  /// Deleted: the span would refer to a temporary.
  std::span<const Index> down(int k, std::size_t f) const&& = delete;
  /// Incidence numbers of down(k, f). A segment with -1 is traversed from its end to its start.
  [[nodiscard]] std::span<const std::int8_t> down_signs(int k, std::size_t f) const& noexcept {
    return part(levels[k].down_signs, levels[k].down_first, f);
  }
  /// Deleted: the span would refer to a temporary.
  std::span<const std::int8_t> down_signs(int k, std::size_t f) const&& = delete;
  /// The facets of dimension k + 1 that facet f of dimension k < N - 1 bounds; empty before connect_up.
  [[nodiscard]] std::span<const Index> up(int k, std::size_t f) const& noexcept {
    return part(levels[k].up, levels[k].up_first, f);
  }
  /// Deleted: the span would refer to a temporary.
  std::span<const Index> up(int k, std::size_t f) const&& = delete;
  /// The incidence numbers of f in the boundaries of up(k, f).
  [[nodiscard]] std::span<const std::int8_t> up_signs(int k, std::size_t f) const& noexcept {
    return part(levels[k].up_signs, levels[k].up_first, f);
  }
  /// Deleted: the span would refer to a temporary.
  std::span<const std::int8_t> up_signs(int k, std::size_t f) const&& = delete;

  /// Computes the lists of `up` from those of `down`. O(size). Call it again after changes. One thread. Errors:
  /// Cancelled; then the lists of `up` are undefined.
  void connect_up(const WorkOptions& work = {});

  /// The points of facet f of dimension k, each once. Segment: start, end. Polygon: in order along its orientation.
  /// Polyhedron: ascending.
  [[nodiscard]] std::vector<Index> points_of(int k, std::size_t f) const;

  /// The index of a sample along each axis.
  [[nodiscard]] std::array<std::size_t, N> index_of(std::uint64_t sample) const noexcept {
    std::array<std::size_t, N> index;
    for (int a = 0; a < N; ++a) {
      index[a] = static_cast<std::size_t>(sample % sizes[a]);
      sample /= sizes[a];
    }
    return index;
  }

 private:
  template <class T>
  static std::span<const T> part(const Buffer<T>& all, const Buffer<Index>& first, std::size_t f) noexcept {
    if (first.empty()) return {};
    return {all.data() + first[f], first[f + 1] - first[f]};
  }
};

/// Extracts the contour {value = isovalue} of an image as facets. `options` as for `extract`, except that
/// `triangulation` is ignored. Every triangulation that `extract` makes is a subdivision of the result: same points on
/// edges, same components, same Euler characteristic. A user's estimator is called once for each ambiguous cube and
/// tesseract; for an ambiguous square once, plus once for each ambiguous cube around it.
///
/// Next to missing values, points and segments shared by facets that are not otherwise connected are doubled. (In 4D
/// the boundary of a contour may still touch itself there in a point or along a segment, which `extract` separates by
/// simplices of zero size.)
///
/// With periods that are not all 0, there is one more layer of tiles across each periodic axis, as in
/// `extract_periodic`, and facets on the seam are there once. Then ExtractOptions::close closes the contour at the
/// borders of the other axes. Memory: also a copy of the image. Errors: also those of `extract_periodic`.
///
/// Errors: those of `extract`; TooLarge also for 2^32 incidences of one dimension. O(samples + output), on
/// options.work.threads threads; the result is the same for any number. Memory besides the result, in 4D: 3 bytes per
/// sample, 240 per row along axis 0 and 4 per facet; half of that in 3D, a fifth in 2D; twice as much for closed
/// contours. If ambiguities are resolved from the data, 100 more per row and 2 per face of two dimensions or more.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] FacetHierarchy<N, Real> extract_facets(const Image<T, N>& image, double isovalue,
                                                     const ExtractOptions& options = {},
                                                     const AxisPeriods<N>& periods = {});

/// Extracts the contour {value = isovalue} of a complex of cells as facets: points on edges, segments in polygons,
/// polygons in 3D cells and polyhedra in 4D cells. `options` as for `extract` of a complex, except that `triangulation`
/// is ignored. The compact contour of `extract` subdivides the result: it has the same points, in the same order, and
/// the same components and Euler characteristic. A complex of the cells of a grid has the facets of the image, in
/// another order. (By rules that read the data, a 3D cell with a tunnel has triangles, with points and segments inside
/// the cell.)
///
/// Next to missing values 4D facets are separated as those of images.
///
/// FacetHierarchy::cells is the number of cells. Cells are numbered by type, in the order of the numbers below, and
/// within a type in the order of the input: triangles, quadrilaterals, tetrahedra, wedges, pyramids, hexahedra,
/// octahedra, then polygons or polyhedra; in 4D simplices, prisms over these 3D cells but octahedra, prisms over
/// octahedra, 16-cells, then prisms over polyhedra and polytopes. So the numbers are the input's if all cells have one
/// type. Points are in the order of the contour's vertices, segments in that of their points, (N-1)-facets in that of
/// the cells, and in 4D polygons in that of their first polyhedra, whose boundary gives their direction. Signatures are
/// 0 in polygons, polyhedra, prisms over these, and polytopes; in other cells bit v is corner v of the cell, in
/// hexahedra and quadrilaterals the corner at v >> j & 1 along their j-th axis. Segments go from the point with the
/// smaller number to the other one.
/// FacetPlace::axes is 0, `base` of facets of lower dimensions is the cell of the first facet that they bound, and
/// `number` counts the facets of a cell. Caps are in the faces of cells at the border of the complex; they come last,
/// and `number` counts those of a face. Facets that bound only caps are caps, too.
///
/// Errors: those of `extract`; TooLarge also for 2^32 incidences. O(C + P + S log S) time for S facets; what is not
/// `extract` runs on one thread. The result is the same for any number of threads. Memory besides the result: that of
/// `extract`, the compact contour, and 12 bytes for each side of a polygon; in 4D 40 for each polygon and 8 for each of
/// its sides besides.
template <Coordinate Real = float, int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] FacetHierarchy<N, Real> extract_facets(const Complex<N>& complex, double isovalue,
                                                     const ExtractOptions& options = {});

/// Extracts the contour {value = isovalue} of an image on a lattice as facets: those of lattice_complex(image, lattice)
/// by `extract_facets` of a complex, with the names and units of the image's axes, and normals by gradients on the
/// lattice. `options` as for `extract_lattice`, except that `triangulation` is ignored. Points and normals are those of
/// the compact contour of `extract_lattice` without points inside of polygons, and the components and the Euler
/// characteristic are the same.
///
/// `periods`: of periodic axes, as in `extract_lattice`. Cells across the seam connect the last samples to the first
/// ones, so a lattice whose axes are all periodic is a torus, and its facets are a closed complex
/// (FacetHierarchy::periods). Its cells have the order of `lattice_complex`, with those across the seam at the samples
/// where they begin: by type, then by sample, then for fcc_in_time by interval of time.
///
/// Errors: those of `extract_lattice` and of `extract_facets` of a complex. Time and memory: those of both.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] FacetHierarchy<N, Real> extract_facets(const Image<T, N>& image, Lattice lattice, double isovalue,
                                                     const ExtractOptions& options = {},
                                                     const AxisPeriods<N>& periods = {});

/// Extracts the contour {value = isovalue} of an image whose cells are divided into simplices as facets: those of
/// divided_complex(image, division, isovalue) by `extract_facets` of a complex. So each simplex that the contour passes
/// has one facet: in 3D a triangle or a quadrilateral; cells that `hybrid` does not divide have those of images.
/// `options` and `periods` as for `extract_divided`, except that `triangulation` is ignored: points and normals are
/// those of its compact contour, with the names and units of the image's axes. FacetHierarchy::cells is the number of
/// simplices. Errors: those of `extract_divided` and of `extract_facets` of a complex. Time and memory: those of both.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] FacetHierarchy<N, Real> extract_facets(const Image<T, N>& image, Division division, double isovalue,
                                                     const ExtractOptions& options = {},
                                                     const AxisPeriods<N>& periods = {});

/// Receives the facets of the i-th isovalue.
template <int N, Coordinate Real>
using FacetSink = std::function<void(std::size_t i, FacetHierarchy<N, Real> facets)>;

/// As `extract_facets` for several isovalues, whose facets are passed to `use` one after the other. The cells of the
/// lattice or division, which do not depend on the isovalue (except those of `hybrid`), are made once. Errors: as
/// there, before any is passed for arguments; those of `use`.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 4>
void extract_facets_several(const Image<T, N>& image, Lattice lattice, std::span<const double> isovalues,
                            const std::type_identity_t<FacetSink<N, Real>>& use, const ExtractOptions& options = {},
                            const AxisPeriods<N>& periods = {});
/// As above, for an image whose cells are divided into simplices.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 4>
void extract_facets_several(const Image<T, N>& image, Division division, std::span<const double> isovalues,
                            const std::type_identity_t<FacetSink<N, Real>>& use, const ExtractOptions& options = {},
                            const AxisPeriods<N>& periods = {});

/// The Euler characteristic of facet f of dimension k with its boundary: 1, or 0 for a solid torus. For a polyhedron it
/// is half the Euler characteristic of its boundary: each handle subtracts 1, each boundary component after the first
/// adds 1.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] int facet_euler(const FacetHierarchy<N, Real>& facets, int k, std::size_t f);

/// Counts and faults of a facet hierarchy.
struct FacetReport {
  std::array<std::uint64_t, 4> facets{};  ///< by dimension
  std::int64_t euler = 0;                 ///< sum over all facets of (-1)^k facet_euler
  std::uint64_t components = 0;           ///< connected components, by shared facets
  std::uint64_t tori = 0;                 ///< polyhedra of Euler characteristic 0; with low and high: solid tori
  std::uint64_t below_zero = 0;           ///< polyhedra of Euler characteristic < 0: several handles
  std::uint64_t above_one = 0;            ///< polyhedra of Euler characteristic > 1: with cavities
  std::uint64_t border = 0;               ///< (N-2)-facets in exactly one (N-1)-facet
  std::uint64_t branching = 0;            ///< fault: (N-2)-facets in no or more than two (N-1)-facets
  std::uint64_t conflicts = 0;            ///< fault: (N-2)-facets twice with the same sign
  std::uint64_t open_boundaries = 0;      ///< fault: facets with a non-zero boundary of the boundary
  bool operator==(const FacetReport&) const = default;  ///< member by member
};

/// Checks all facets. O(size). One thread. Errors: Cancelled.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] FacetReport check(const FacetHierarchy<N, Real>& facets, const WorkOptions& work = {});

}  // namespace tegl
