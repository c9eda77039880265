// SPDX-License-Identifier: BSD-3-Clause
//
// Ambiguous faces of tiles, and how they are resolved: by a fixed rule or from the data.
//
// Based on: M. Liversage, thesis, 1994, sections 6.3, 7.3 and 7.6 (the consistent method; the estimation method, for
// squares and for cubes with two opposite corners; cubes always separate); G. M. Nielson and B. Hamann, "The asymptotic
// decider", 1991; Zhu J., Meng P. and Wang C., "An improved marching cubes algorithm", Journal of Image and Graphics
// 13(7), 2008 (that decider without a test inside cubes).
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>

#include "tegl/tile/choices.hpp"

namespace tegl {

/// How ambiguous faces are resolved. A square with two diagonally opposite high corners is ambiguous: they are either
/// joined or separate. A cube is ambiguous if the contour has several loops on its boundary, which a tunnel may join;
/// higher dimensions are analogous. With every rule, tiles agree in shared faces: the contour is a manifold, open only
/// at the image border and at missing values.
/// - low, high: the consistent method, by table. low separates high corners that meet only across a diagonal, high
///   joins them. Loops in a cube are never joined.
/// - mean: the thesis's estimation method (6.3.5, 7.3.10), extended to all faces. The centre of an ambiguous face is
///   high if the mean of its corners is at or above the isovalue, else low; all parts of the centre's sign are
///   connected in the face. Exact, except if the sum of the corners overflows a double or a corner is infinite: then
///   the rounded sum of the corners divided by 1024 is compared; with infinities of both signs the centre is high.
/// - saddle: the exact topology of the multilinear interpolant in squares and cubes (tegl/saddle.hpp). Faces of higher
///   dimension use the sign of their centre, as `mean` does.
/// - squares: the rule of the thesis's program (6.3.5, 7.6.7, 10.5.3). Squares are resolved as by `mean`; in cubes and
///   larger faces, components of the contour on the boundary stay separate.
/// - decider: the asymptotic decider without an interior test. Squares are resolved as by `saddle`; in cubes and larger
///   faces, components of the contour on the boundary stay separate.
/// - custom: by ExtractOptions::estimator.
///
/// Octahedra and 16-cells, in lattices and meshes, have no ambiguous faces. Two opposite corners that are unlike all
/// others are joined by mean and saddle, if the mean of all corners is on their side; other rules keep them separate.
/// Tori in the boundary of a 16-cell are filled as the same mean requires, or by the rule as in other cells.
///
/// In 2D, squares gives the same bytes as mean, and decider the same as saddle. In 3D, every polygon of squares and
/// decider is a disc, as with low and high. In 4D and 5D, a component on a face's boundary that is not a sphere is
/// filled as if the face's centre were low.
///
/// Unambiguous faces always come from the tables. If few faces are ambiguous, as in smooth images, all rules cost about
/// the same. In noise, rules that use the data read the samples again (docs/ambiguity.md), and `count`, which otherwise
/// reads bits only, takes many times as long as with low.
enum class Ambiguity { low, high, mean, saddle, squares, decider, custom };

namespace detail {
struct FaceSurroundings;
}

/// An ambiguous face of the image's grid, as passed to an estimator. Valid only during the call.
class AmbiguousFace {
 public:
  /// Number of dimensions of the image.
  [[nodiscard]] int image_dim() const noexcept { return image_dim_; }
  [[nodiscard]] int dim() const noexcept { return dim_; }  ///< number of dimensions of the face, at least 2
  /// Bit a: whether the face extends along axis a.
  [[nodiscard]] unsigned axes() const noexcept { return axes_; }
  /// Image index of the face's first corner, by axis. The face extends from there to the next sample along its axes.
  [[nodiscard]] std::span<const std::size_t> base() const& noexcept {
    return {base_.data(), static_cast<std::size_t>(image_dim_)};
  }
  /// Deleted: the span would refer to a temporary.
  std::span<const std::size_t> base() const&& = delete;
  /// Values of the 2^dim corners. Corner v is one step along the face's j-th axis if bit j of v is set.
  [[nodiscard]] std::span<const double> values() const noexcept { return values_; }
  [[nodiscard]] double isovalue() const noexcept { return isovalue_; }  ///< the isovalue of the contour
  /// The value at `base` + `steps`, with steps along each axis of the image. Beyond the image border, the value of the
  /// nearest sample inside. NaN for missing samples. The range of `steps` is limited by Estimator::reach.
  [[nodiscard]] double sample(std::span<const std::ptrdiff_t> steps) const noexcept;

 private:
  friend struct detail::FaceSurroundings;
  AmbiguousFace(std::span<const std::size_t> base, unsigned axes, std::span<const double> values, double isovalue,
                const detail::FaceSurroundings& around);

  int image_dim_, dim_;
  unsigned axes_;
  std::array<std::size_t, 5> base_{};
  std::span<const double> values_;
  double isovalue_;
  const detail::FaceSurroundings* around_;
};

/// A user-defined rule for ambiguous faces, based on their values and the samples around them.
struct Estimator {
  /// Called for ambiguous squares; for cubes whose boundary the contour meets in several loops; and for 4D and 5D faces
  /// that contain an ambiguous face, or whose boundary part of the contour has several components or is not a sphere.
  /// Order, number of calls and calling threads are unspecified; calls are concurrent.
  ///
  /// The result must depend on the face only. A face is passed once by each tile that has it, and again by a counting
  /// pass (4D, missing values). InvalidArgument is thrown if results change so that a row of tiles has another number
  /// of vertices or simplices than was counted, or tiles around a cube get different fillings of it. Changes that are
  /// not detected give tiles that do not match. In neither case is memory outside of the contour written. For a square,
  /// `separate` means `low`. Exceptions end the extraction and reach its caller.
  std::function<tile::Choice(const AmbiguousFace& face)> choose = {};
  /// How many samples beyond the face, along any axis, `choose` may read with AmbiguousFace::sample. Streaming keeps as
  /// many layers as this requires; samples farther away are unavailable.
  std::size_t reach = 0;
};

}  // namespace tegl
