// SPDX-License-Identifier: BSD-3-Clause
//
// How the ambiguous faces of tiles are resolved: the same way everywhere, or from the data.
//
// Based on: M. Liversage, thesis, 1994, sections 6.3 and 7.3 (the consistent method; the estimation method, for squares
// and for cubes with two opposite corners); G. M. Nielson and B. Hamann, "The asymptotic decider", 1991.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>

#include "tegl/facets/facets.hpp"

namespace tegl {

/// A square with two high corners across from each other is ambiguous: are they joined in it, or apart? So is a cube in
/// which the contour has several loops on the boundary (does a tunnel join them?), and so on upwards. However it is
/// resolved, tiles agree in shared faces: the contour is a manifold, open only at the image's border and missing data.
/// - low, high: the consistent method, by table. low keeps high corners apart that meet only across a diagonal, high
///   joins them. Loops in a cube are never joined.
/// - mean: the thesis's estimation method (6.3.5, 7.3.10), extended to all faces. The centre of an ambiguous face is
///   high if the mean of its corners is at or above the isovalue, else low; all parts of its sign are connected in the
///   face. Exact, except if the sum of the corners overflows a double, or one is infinite: then the sum of the corners
///   divided by 1024, rounded, is compared; with infinities of both signs the centre is high.
/// - saddle: as the multilinear interpolant has it, exactly in squares and cubes (tegl/saddle.hpp). In faces of higher
///   dimension, by the sign of their centre as `mean`.
/// - custom: as ExtractOptions::estimator says.
///
/// Faces that are not ambiguous come from the tables in any case. Where few faces are ambiguous, as in smooth images,
/// all of them cost about the same; in noise, mean and saddle look at samples again (docs/ambiguity.md), and `count`,
/// which otherwise looks at bits alone, takes many times as long as with low.
enum class Ambiguity { low, high, mean, saddle, custom };

/// An ambiguous face of the image's grid, as an estimator sees it. Valid during the call only.
class AmbiguousFace {
 public:
  /// Reads sample `index` of `image`, for `sample`.
  using Reader = double (*)(const void* image, const std::ptrdiff_t* index);

  /// Called by extractions. `origin`: the place in the image of sample 0 of what is read; `first`, `end`: the samples
  /// that there are along each axis, counted from there.
  struct Surroundings {
    const void* image = nullptr;             ///< as Reader takes it
    Reader read = nullptr;                   ///< reads one sample
    std::array<std::ptrdiff_t, 5> origin{};  ///< by axis, see above
    std::array<std::ptrdiff_t, 5> first{};   ///< likewise
    std::array<std::ptrdiff_t, 5> end{};     ///< likewise
  };
  /// Called by extractions: a face by its first corner, axes and corners' values. What it refers to must outlive it.
  AmbiguousFace(std::span<const std::size_t> base, unsigned axes, std::span<const double> values, double isovalue,
                const Surroundings& around);
  /// Deleted: the surroundings are not copied.
  AmbiguousFace(std::span<const std::size_t> base, unsigned axes, std::span<const double> values, double isovalue,
                const Surroundings&& around) = delete;

  /// Dimensions of the image, and of the face: 2 or more.
  [[nodiscard]] int image_dim() const noexcept { return image_dim_; }
  [[nodiscard]] int dim() const noexcept { return dim_; }  ///< of the face: 2 or more
  /// Bit a: whether the face extends along axis a.
  [[nodiscard]] unsigned axes() const noexcept { return axes_; }
  /// The index of its first corner in the image, by axis: the face goes from there to the next sample along its axes.
  [[nodiscard]] std::span<const std::size_t> base() const& noexcept {
    return {base_.data(), static_cast<std::size_t>(image_dim_)};
  }
  /// Deleted: the index lies in the face itself.
  std::span<const std::size_t> base() const&& = delete;
  /// At its 2^dim corners; corner v is one step along the j-th of its axes where bit j of v is set.
  [[nodiscard]] std::span<const double> values() const noexcept { return values_; }
  [[nodiscard]] double isovalue() const noexcept { return isovalue_; }  ///< the isovalue of the contour
  /// The value at `base` + `steps`, steps by axis of the image; beyond the image's border that of the nearest sample
  /// inside. NaN where it is missing. How far it may go: Estimator::reach.
  [[nodiscard]] double sample(std::span<const std::ptrdiff_t> steps) const noexcept;

 private:
  int image_dim_, dim_;
  unsigned axes_;
  std::array<std::size_t, 5> base_{};
  std::span<const double> values_;
  double isovalue_;
  const Surroundings* around_;
};

/// A caller's own way to resolve ambiguous faces, from their values and from what is around them.
struct Estimator {
  /// Asked for ambiguous squares, for cubes whose boundary the contour meets in several loops, and for faces of four
  /// and five dimensions where one is ambiguous in them or where what the contour has on their boundary is of several
  /// parts or not a sphere; in what order, how often and by which threads is not defined, and several ask at the same
  /// time. The answer has to depend on the face alone, not on who asks or when: a face is asked for by each tile around
  /// it, and where counts come first (4D, missing values) once more. Where a row of tiles then has another number of
  /// vertices or simplices than was counted, or tiles around a cube another filling of it, the extraction throws
  /// InvalidArgument; answers that change and are not found out give tiles that do not fit together. Nothing is written
  /// outside of the contour in either case. For a square, `separate` is as `low`. What it throws ends the extraction
  /// and reaches the caller.
  std::function<facets::Choice(const AmbiguousFace& face)> choose = {};
  /// How many samples beyond the face `choose` looks at, along any axis, through AmbiguousFace::sample. Layers of
  /// streamed images are kept for so long; beyond them nothing is known there.
  std::size_t reach = 0;
};

}  // namespace tegl
