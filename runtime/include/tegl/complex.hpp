// SPDX-License-Identifier: BSD-3-Clause
//
// Complexes of cells (meshes with a value at each point), and their contours. Cells may be mixed: triangles and
// quadrilaterals and other polygons; tetrahedra, wedges, pyramids, hexahedra and other polyhedra; 4-simplices, the
// prisms that 3D cells are over an interval of time, and other 4D polytopes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/extract.hpp"
#include "tegl/image.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// The types of cells. Up to 3D the values are the numbers of VTK (and of .vtu files), and corners have VTK's order. A
/// 4D prism has the corners of its 3D cell at the earlier time, then the same at the later time. Corners may have
/// either orientation.
enum class CellType : std::uint8_t {
  triangle = 5,             ///< 3 corners
  polygon = 7,              ///< up to 64 corners, around the border (CellLists)
  pixel = 8,                ///< 4 corners, coordinate 0 fastest
  quadrilateral = 9,        ///< 4 corners, around the border
  tetrahedron = 10,         ///< 4 corners
  voxel = 11,               ///< 8 corners, coordinate 0 fastest
  hexahedron = 12,          ///< 8 corners: the bottom quadrilateral around its border, then the top one
  wedge = 13,               ///< 6 corners: two triangles
  pyramid = 14,             ///< 5 corners: the base around its border, then the apex
  polyhedron = 42,          ///< up to 64 corners, given by its faces (CellLists)
  simplex4 = 100,           ///< 4D: 5 corners
  octahedron = 101,         ///< 3D: 6 corners, three pairs of opposite ones (not in VTK)
  cell16 = 102,             ///< 4D: the 16-cell; 8 corners, four pairs of opposite ones
  polytope = 103,           ///< 4D: up to 64 corners, given by its facets (CellLists)
  tetrahedron_prism = 110,  ///< 4D: 8 corners
  voxel_prism = 111,        ///< 4D: 16 corners
  hexahedron_prism = 112,   ///< 4D: 16 corners
  wedge_prism = 113,        ///< 4D: 12 corners
  pyramid_prism = 114,      ///< 4D: 10 corners
  octahedron_prism = 115,   ///< 4D: 12 corners
};

/// The name of a type, such as "tetrahedron"; "unknown" for another number.
[[nodiscard]] std::string_view name_of(CellType type) noexcept;
/// Number of corners of a type. Errors: InvalidArgument for another number, and for polygons, polyhedra and polytopes.
[[nodiscard]] std::size_t corner_count(CellType type);
/// Dimension of a type: 2, 3 or 4. Errors: InvalidArgument for another number.
[[nodiscard]] int dimension(CellType type);

namespace detail {
struct BorderFacet;
struct CellGroups;
struct ComplexEdges;
struct ComplexAccess;
using CellSigns = std::vector<std::vector<std::uint64_t>>;
}  // namespace detail

/// Cells of several types, polygons, polyhedra and 4D polytopes among them. `ends` and the like ascend; the last is the
/// size of the list that they refer to.
///
/// A polyhedron is given by its faces, each with its corners around it in either direction. Its faces must form a
/// closed sphere, and two faces must have nothing, a corner or an edge in common, as in a convex polyhedron. They need
/// not be plane. A polyhedron with the faces of a tetrahedron, a pyramid, a wedge, a hexahedron or an octahedron is
/// such a cell, and a polygon of three or four corners a triangle or a quadrilateral.
///
/// A 4D polytope is given by its facets, and a facet as a polyhedron is, by its faces. The faces of a polytope are
/// listed twice, once in each of the two facets that have it. Its facets must be as in a convex polytope: a
/// closed 3-sphere, and two facets have nothing, a corner, an edge or a face in common. (Homology spheres pass, too.)
/// A polytope with the facets of a 4-simplex, a 16-cell or a prism over a cell with a type is such a cell.
/// Compact contours are manifolds if no two cells have several facets in common.
struct CellLists {
  std::vector<CellType> types = {};                 ///< #C
  std::vector<Index> corners = {};                  ///< of all cells; polyhedra and polytopes may have none here
  std::vector<std::uint64_t> ends = {};             ///< #C: the end of each cell in `corners`
  std::vector<Index> face_corners = {};             ///< the corners of all faces of polyhedra or of facets
  std::vector<std::uint64_t> face_ends = {};        ///< by face: its end in `face_corners`
  std::vector<std::uint64_t> face_lists_ends = {};  ///< 3D: #C, or empty: the end of each cell's faces in `face_ends`
  std::vector<std::uint64_t> facet_ends = {};       ///< 4D: by facet of polytopes: the end of its faces in `face_ends`
  /// 4D: #C, or empty: the end of each cell's facets in `facet_ends`.
  std::vector<std::uint64_t> facet_lists_ends = {};
};

/// A complex of cells in N = 2, 3 or 4 dimensions with one value at each point. Owns its data; copies share the cells
/// and the edges, which do not change.
///
/// Cells must meet as the faces of a mesh do: the intersection of two cells is empty or a whole face of both (a corner,
/// an edge, a polygon, in 4D also a 3D cell). This is not checked. The contour of such a complex is closed away from
/// the border and from missing values, for any mixture of types.
///
/// The constructors, set_points and in_time compute the cells' orientations on all threads of the machine.
template <int N>
requires DimensionBetween<N, 2, 4>
class Complex {
 public:
  using Point = std::array<double, N>;  ///< N coordinates

  /// Cells of one type. `points`: #P x N; `corners`: #C x (corners of the type), row = cell, numbers of points. Values
  /// are missing until set_values is called. Errors: InvalidArgument (a type of another dimension; `corners` of a wrong
  /// size; a number that is not below #P; a corner that a cell repeats; a coordinate that is not finite, or above
  /// 2^1018 = 2.8e306 in absolute value), TooLarge (2^32 points or more, 2^32 cells or more). Messages name the cell,
  /// counted from 0.
  Complex(std::vector<Point> points, CellType type, std::span<const Index> corners);
  /// Cells of several types. `types`: one per cell; `corners`: the corners of all cells, one cell after the other.
  /// Errors: as the other constructor.
  Complex(std::vector<Point> points, std::span<const CellType> types, std::span<const Index> corners);

  /// Cells of several types, with polygons (N = 2), polyhedra (N = 3) and polytopes (N = 4). Errors: as the other
  /// constructors; InvalidArgument also for lists whose ends do not ascend, and for polygons, polyhedra and polytopes
  /// that CellLists excludes. Polytopes with the same lists, up to the numbers of the points, are usually checked once.
  Complex(std::vector<Point> points, const CellLists& cells);

  [[nodiscard]] const std::vector<Point>& points() const noexcept { return points_; }   ///< #P x N
  [[nodiscard]] const std::vector<double>& values() const noexcept { return values_; }  ///< #P, NaN: missing
  [[nodiscard]] std::size_t cell_count() const noexcept;                                ///< number of cells

  /// Sets the value of every point; NaN means missing: cells with a missing corner have no contour. Any of the seven
  /// value types of images; kept as double. Errors: InvalidArgument for another number of values.
  template <Value T>
  void set_values(std::span<const T> values) {
    check_count(values.size(), "values");
    values_.assign(values.begin(), values.end());
  }
  /// Sets the values from a vector.
  template <Value T>
  void set_values(const std::vector<T>& values) {
    set_values(std::span<const T>(values));
  }
  /// Sets the values from a vector of doubles, which is moved.
  void set_values(std::vector<double> values) {
    check_count(values.size(), "values");
    values_ = std::move(values);
  }
  /// Moves the points; cells and edges stay. A complex made by in_time loses its layers if a last coordinate changes:
  /// vertices may then be at a time of the layers as well. Errors: InvalidArgument for another number of points and for
  /// a coordinate that is not finite or above 2^1018 in absolute value.
  void set_points(std::vector<Point> points);

  /// Finds and keeps the edges of all cells, sorted, and the numbers of each cell's edges. Later extractions then
  /// number vertices by counting bits and do not sort: worth it for several isovalues, or for values at several times.
  /// The contours do not change. O(C) time. Memory: 4 bytes for each edge of each cell and 8 per edge of the complex;
  /// for each 64 cells 8 bytes, and 8 for each of the words of 32 consecutive points that have their corners: a few
  /// words if neighbouring points have near numbers, but up to 64 bytes per hexahedron if the numbers are shuffled.
  /// Until it returns, 8 more for each edge of each cell. Errors: TooLarge (2^32 edges or more), Cancelled.
  void find_edges(const WorkOptions& work = {});
  /// Number of edges of the complex, or 0 before find_edges.
  [[nodiscard]] std::size_t edge_count() const noexcept;
  /// Finds and keeps the border: the facets of one cell only, where ExtractOptions::close makes caps. Otherwise each
  /// extraction with caps finds them again. O(F) time for the facets of all cells; 24 bytes for each (40 in 4D) until
  /// it returns, then 12 for each facet on the border. Errors: Cancelled.
  void find_border(const WorkOptions& work = {});

 private:
  friend struct detail::ComplexAccess;
  void check_count(std::size_t count, const char* what) const;

  std::vector<Point> points_;
  std::vector<double> values_;
  std::shared_ptr<const detail::CellGroups> cells_;
  std::shared_ptr<const detail::ComplexEdges> edges_;
  std::shared_ptr<const std::vector<detail::BorderFacet>> border_;
  std::shared_ptr<const detail::CellSigns> signs_;  ///< orientations of the cells
  double largest_coordinate_ = 0;                   ///< absolute value
  bool is_layered_ = false;                         ///< made by in_time, and the last coordinates are its times
};

/// The complex that a complex sweeps over time, for its contour in space and time: every cell x every interval between
/// two times is a prism. Point p at time k is point k * #P + p, with its time as the last coordinate. `times`: T
/// ascending values; `values`: T x #P, row = time, NaN: missing; `points`: T x #P, row = time, if the points move, or
/// empty. A cut of the contour at a time of `times` is the contour of the complex at that time (in the same
/// triangulation), if no value is missing; at every other time, too, it is closed away from the border. N = 2 or 3.
/// Polygons of up to 32 corners have prisms (InvalidArgument for others), and all polyhedra. Errors: InvalidArgument
/// (fewer than 2 times; times not finite or not ascending; a wrong number of values or points; a coordinate that is not
/// finite, or above 2^1018 in absolute value), TooLarge (2^32 points or prisms or more). O(T (P + C)) time and memory.
template <int N>
requires DimensionBetween<N, 2, 3>
[[nodiscard]] Complex<N + 1> in_time(const Complex<N>& complex, std::span<const double> times,
                                     std::span<const double> values,
                                     std::span<const std::array<double, N>> points = {});

/// As `extract` of a complex, with counts and times. `tiles` are cells.
template <Coordinate Real = float, int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Extraction<N, Real> extract_with_stats(const Complex<N>& complex, double isovalue,
                                                     const ExtractOptions& options = {});

/// Extracts the contour {value = isovalue} of a complex. It separates points with values >= isovalue (high) from the
/// others. Vertices are on edges, ordered by the edges' ends, then in cells. Along an edge values are linear, from the
/// end with the smaller number.
///
/// The contour is an oriented manifold if the union of the cells is a manifold (with or without border). It has a
/// boundary only at the border of the complex and at missing values. It is the contour of an image if the cells are
/// those of its grid (compact: the same simplices, in 4D if points are numbered along the axes; also 3D barycentric,
/// with barycentres at the mean of a polygon's points). A cell's orientation is the sign of the best affine map from
/// its reference corners. A flat cell (its volume is at most 1e-9 of that of a box with edges as long) has the
/// orientation of the others of its shape, if these all have their corners in the same order, as in Delaunay
/// triangulations. Cells that are folded, and other flat ones, may have the wrong orientation, and then the contour's
/// orientation has conflicts there.
///
/// Options: all, except as follows. Neighbouring cells of any types agree in their common faces, with every rule.
/// - triangulation: the diagonals of compact 4D contours in faces between cells depend on the numbers of the points.
/// - ambiguity: all but custom. With rules that read the data, hexahedra are resolved as the cubes of an image; in
///   wedges, pyramids and polyhedra every polygon is a disc; faces of five corners or more are decided by their mean.
///   (The interpolant of a wedge has no tunnels; so in wedges `saddle` is exact.) Octahedra and 16-cells have no
///   ambiguous faces; mean and saddle decide their insides (tegl/ambiguity.hpp). The 3D facets of 4D cells are resolved
///   in the same way, by their own values. Hexahedra over time are resolved as the tesseracts of an image. In other 4D
///   cells spheres of the boundary are filled one by one.
/// - close: caps are the high part of the complex's border, the facets of one cell only. Without missing values, the
///   contour is then closed if the border is a manifold. Facets of cells with missing corners have no caps.
/// - normals: differences. The gradient at a point belongs to the linear function that best fits the differences to
///   the points at the other ends of its edges, by least squares weighted by the inverse squares of the distances. At
///   the points of a grid it is the mean of forward and backward difference quotients, as for images. Normals are
///   interpolated linearly along edges; vertices that cells add have the mean of normals.
/// The result does not depend on the number of threads. Errors: InvalidIsovalue; InvalidArgument (epsilon, other
/// options; a point beyond the range of Real, which is named); TooLarge (2^32 vertices or more); Cancelled.
/// O(C + P + S) time for S simplices and P points. Memory beside the contour:
/// - 2 bits per point, 8 to 16 bytes per active cell, 4 to 8 per cell with a missing corner, 8 per crossed edge, 4 for
///   each crossed edge of each active cell;
/// - before find_edges: 8 bytes per point, and while the edges are sorted 8 for each crossed edge of each active cell;
/// - after find_edges: 16 for each 64 edges of the complex while edges are numbered;
/// - 4D: 32 to 64 bytes per barycentre in a common 3D face and 4 for each cell that has it; while they are sorted, 80
///   more for each cell that has it;
/// - close: what find_border takes, unless it was called, and 40 to 72 bytes per simplex of the caps;
/// - normals: 8 N bytes and N (N + 3) / 2 numbers of 8 bytes per end of a crossed edge, and before find_edges 16 for
///   each edge of each cell at these ends.
/// Thread-safe for several extractions from one complex.
template <Coordinate Real = float, int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Contour<N, Real> extract(const Complex<N>& complex, double isovalue, const ExtractOptions& options = {}) {
  return extract_with_stats<Real>(complex, isovalue, options).contour;
}

/// Counts the vertices and simplices that `extract` would make, exactly. Time and errors: those of `extract`, which
/// writes the contour besides.
template <int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] ContourSize count(const Complex<N>& complex, double isovalue, const ExtractOptions& options = {});

/// As `extract`, but writes to the caller's memory and returns the contour's size. `room` must hold at least that many
/// rows; `count` returns the size. Vertices, normals and simplices equal those of `extract` byte by byte, except for
/// the width of the numbers. If the contour touches itself beside missing values, it is made in memory of its own and
/// copied. Errors: those of `extract`; InvalidArgument if `room` is too small, before anything is written.
template <int N, Coordinate Real, VertexNumber I>
requires DimensionBetween<N, 2, 4> ExtractedSize extract_into(const Complex<N>& complex, double isovalue,
                                                              const ContourRoom<N, Real, I>& room,
                                                              const ExtractOptions& options = {});

/// Interpolates other numbers at the points of a complex to the vertices of its contour, as an attribute: a temperature
/// surface with the pressure. `numbers`: #P x width, row = point of the complex (of one made by in_time, #T x #P x
/// width); NaN: missing. The weights are those of the contour's coordinates, so that numbers which are linear in the
/// coordinates give the same function of the vertices. The result has a row for each vertex of `extract` with the same
/// isovalue and options; it is NaN where a number is missing at a point that the vertex depends on. Errors: those of
/// `extract`; InvalidArgument if the size of `numbers` is not a multiple of the number of points. Time: that of
/// `extract`, for N numbers per point at a time.
template <int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Attribute interpolate_points(const Complex<N>& complex, double isovalue, std::span<const double> numbers,
                                           std::string name, std::string unit = {}, const ExtractOptions& options = {});

}  // namespace tegl
