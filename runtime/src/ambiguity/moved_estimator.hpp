// SPDX-License-Identifier: BSD-3-Clause
//
// Adapts a caller's estimator to an image whose last axis was exchanged: the estimator receives faces with the original
// order of axes.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "ambiguity/face_surroundings.hpp"

namespace tegl::detail {

/// A face of the image whose `axis` was moved to the end, converted to a face of the original image.
template <int N>
class MovedFace {
 public:
  MovedFace(const AmbiguousFace& face, int axis) : face_(face) {
    for (int b = 0; b < N; ++b) own_[b] = b == N - 1 ? axis : b + (b >= axis ? 1 : 0);
  }
  MovedFace(const MovedFace&) = delete;
  MovedFace& operator=(const MovedFace&) = delete;

  /// Returns the choice of `choose` for the face.
  [[nodiscard]] tile::Choice ask(const std::function<tile::Choice(const AmbiguousFace&)>& choose) const {
    // base and axes in the original order
    std::array<std::size_t, N> base{};
    std::array<unsigned, N> bit{};  // by original axis: bit of a corner's number in the moved face
    unsigned axes = 0;
    for (unsigned b = 0, next = 0; b < N; ++b) {
      base[own_[b]] = face_.base()[b];
      if ((face_.axes() >> b & 1u) == 0) continue;
      axes |= 1u << own_[b];
      bit[own_[b]] = next++;
    }
    // values in the original order of corners
    std::array<double, std::size_t{1} << N> values{};
    for (unsigned corner = 0; corner < face_.values().size(); ++corner) {
      unsigned moved = 0;
      unsigned rest = axes;
      for (unsigned j = 0; rest != 0; rest &= rest - 1, ++j)
        moved |= (corner >> j & 1u) << bit[static_cast<std::size_t>(std::countr_zero(rest))];
      values[corner] = face_.values()[moved];
    }
    // The moved face checks the estimator's reach and the image's border.
    constexpr auto kFar = static_cast<std::ptrdiff_t>(std::uint64_t{1} << 62);
    FaceSurroundings around;
    around.image = this;
    around.read = [](const void* face, const std::ptrdiff_t* index) {
      return static_cast<const MovedFace*>(face)->sample(index);
    };
    around.first.fill(-kFar);
    around.end.fill(kFar);
    return choose(around.face(base, axes, std::span(values).first(face_.values().size()), face_.isovalue()));
  }

 private:
  [[nodiscard]] double sample(const std::ptrdiff_t* index) const noexcept {
    std::array<std::ptrdiff_t, N> steps{};
    for (std::size_t b = 0; b < N; ++b) steps[b] = index[own_[b]] - static_cast<std::ptrdiff_t>(face_.base()[b]);
    return face_.sample(steps);
  }

  const AmbiguousFace& face_;
  std::array<int, N> own_{};  ///< by axis of the moved image: axis of the original image
};

/// Estimator for the image whose `axis` was moved to the end.
template <int N>
Estimator moved_estimator(const Estimator& estimator, int axis) {
  return {[choose = estimator.choose, axis](const AmbiguousFace& face) { return MovedFace<N>(face, axis).ask(choose); },
          estimator.reach};
}

}  // namespace tegl::detail
