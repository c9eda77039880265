// SPDX-License-Identifier: BSD-3-Clause
//
// Divided images as complexes in 2D to 4D, with the gradients at their points and their periods.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "complex/image_points.hpp"
#include "complex/point_gradients.hpp"
#include "division/divided_cell.hpp"
#include "image/row_source.hpp"
#include "kernel/extract_normals.hpp"
#include "periodic/periodic_layers.hpp"
#include "periodic/periods.hpp"
#include "tegl/division.hpp"

namespace tegl::detail {

/// A complex with the faces of which its points behind the samples are centres: the axes, and the lowest corner.
template <int N>
struct DividedImage {
  Complex<N> complex;
  std::vector<std::pair<unsigned, Index>> centres;
};

/// Whether any axis is periodic.
template <int N>
[[nodiscard]] bool any_periodic(const AxisPeriods<N>& periods) {
  return std::ranges::any_of(periods, [](double period) { return period != 0.0; });
}

/// Throws the errors of arguments that contours of divided images do not have.
template <int N>
void check_division_arguments(const Grid<N>& grid, Division division, double isovalue, const ExtractOptions& options,
                              const AxisPeriods<N>& periods);

/// The cells of an image, divided. `isovalue`: for `hybrid`. Errors: those of `divided_complex`.
template <Value T, int N>
[[nodiscard]] DividedImage<N> divide_image(const Image<T, N>& image, Division division, double isovalue,
                                           const AxisPeriods<N>& periods);

/// The gradients at the samples of an image. With periodic axes, from a copy with one more sample before and two more
/// behind along these.
template <Value T, int N>
class ImageGradients {
 public:
  using Sample = std::array<std::size_t, N>;

  /// `image` must outlive this object.
  ImageGradients(const Image<T, N>& image, const AxisPeriods<N>& periods) : view_(image) {
    if (!any_periodic<N>(periods)) return;
    wider_.grid = image.grid();
    for (int a = 0; a < N; ++a) {
      if (periods[a] == 0.0) continue;
      before_[a] = 1;
      wider_.grid.axes[a] = wrapped_axis(image.grid().axes[a], periods[a], 1, 2);
    }
    for_each_sample<N>(wider_.grid.sizes(), [&](Sample index) {
      for (int a = 0; a < N; ++a) index[a] = (index[a] + image.size(a) - before_[a]) % image.size(a);
      wider_.values.push_back(image(index));
    });
    view_ = wider_.view();
  }
  ImageGradients(const ImageGradients&) = delete;
  ImageGradients& operator=(const ImageGradients&) = delete;

  [[nodiscard]] const Image<T, N>& view() const noexcept { return view_; }
  [[nodiscard]] const Sample& before() const noexcept { return before_; }

 private:
  OwnedImage<T, N> wider_;
  Image<T, N> view_;
  Sample before_{};
};

/// The complex of a divided image, and what is known beside it.
template <Value T, int N>
class StoredDivision {
 public:
  /// The image must outlive this object; the arguments are checked (check_division_arguments). `isovalue`: for
  /// `hybrid`. Errors: those of `divided_complex`.
  StoredDivision(const Image<T, N>& image, Division division, double isovalue, const ExtractOptions& options,
                 const AxisPeriods<N>& periods)
      : sizes_(image.grid().sizes()),
        samples_(count_samples(image.grid(), "a divided image")),
        made_(divide_image(image, division, isovalue, periods)) {
    if (any_periodic<N>(periods)) around_.periods = world_periods<N>(image.grid(), periods);
    if (options.normals == Normals::none) return;
    gradients_.emplace(image, periods);
    source_.emplace(gradients_->view(), isovalue, options.epsilon);
    at_samples_.emplace(*source_, gradients_->view().grid(), GradientDirection::ascent, options.normals,
                        options.kernel);
    around_.gradient = [this](Index p) { return gradient(p); };
  }
  // around_ refers to other members
  StoredDivision(const StoredDivision&) = delete;
  StoredDivision& operator=(const StoredDivision&) = delete;

  [[nodiscard]] const Complex<N>& complex() const noexcept { return made_.complex; }
  [[nodiscard]] const Surroundings<N>& surroundings() const noexcept { return around_; }
  /// Options for contours of the complex, whose normals are those of the surroundings.
  [[nodiscard]] ExtractOptions options(ExtractOptions asked) const {
    if (asked.normals != Normals::none) asked.normals = Normals::differences;
    return asked;
  }

 private:
  using Sample = std::array<std::size_t, N>;
  using Gradient = std::array<double, N>;

  [[nodiscard]] Gradient at_sample(Sample index) const {
    for (int a = 0; a < N; ++a) index[a] = index[a] % sizes_[a] + gradients_->before()[a];
    return at_samples_->in_world_at(index);
  }
  /// The gradient at a sample; at a centre the mean of the corners'.
  [[nodiscard]] Gradient gradient(Index p) const {
    if (p < samples_) return at_sample(index_of<N>(p, sizes_));
    const auto& [axes, lowest] = made_.centres[p - samples_];
    const Sample first = index_of<N>(lowest, sizes_);
    return mean_gradient<N>({0, axes}, [&](unsigned corner) {
      Sample index = first;
      for (int a = 0; a < N; ++a) index[a] += corner >> a & 1u;
      return at_sample(index);
    });
  }

  Sample sizes_;
  std::size_t samples_;
  DividedImage<N> made_;
  Surroundings<N> around_;
  std::optional<ImageGradients<T, N>> gradients_;
  std::optional<ImageSource<T, N>> source_;
  std::optional<NormalWriter<N, double>> at_samples_;
};

}  // namespace tegl::detail
