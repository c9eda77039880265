// SPDX-License-Identifier: BSD-3-Clause
//
// The samples around an ambiguous face, and the faces that extractions pass to a caller's estimator.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "tegl/ambiguity.hpp"

namespace tegl::detail {

/// Samples that a face can read. `origin` is the image index of local sample 0; `first` and `end` bound the available
/// samples along each axis, in local indices.
struct FaceSurroundings {
  /// Reads the sample of `image` at `index`.
  using Reader = double (*)(const void* image, const std::ptrdiff_t* index);

  const void* image = nullptr;             ///< passed to Reader
  Reader read = nullptr;                   ///< reads one sample
  std::array<std::ptrdiff_t, 5> origin{};  ///< by axis: image index of local sample 0
  std::array<std::ptrdiff_t, 5> first{};   ///< by axis: first available sample, in local indices
  std::array<std::ptrdiff_t, 5> end{};     ///< by axis: end of the available samples, in local indices

  /// A face by its first corner, its axes and the values of its corners. These values and the surroundings are not
  /// copied and must outlive the face.
  [[nodiscard]] AmbiguousFace face(std::span<const std::size_t> base, unsigned axes, std::span<const double> values,
                                   double isovalue) const& {
    return {base, axes, values, isovalue, *this};
  }
  AmbiguousFace face(std::span<const std::size_t> base, unsigned axes, std::span<const double> values,
                     double isovalue) const&& = delete;
};

}  // namespace tegl::detail
