// SPDX-License-Identifier: BSD-3-Clause
//
// One explicit step of the curvature flow: with first and second differences V_a, V_ab of the 3^N neighbours,
// |grad V| div(grad V / |grad V|) = sum_ab (delta_ab - V_a V_b / |grad V|^2) V_ab.
//
// Based on: S. Osher and J. A. Sethian, Fronts propagating with curvature-dependent speed, 1988; L. Alvarez, P.-L.
// Lions and J.-M. Morel, Image selective smoothing and edge detection by nonlinear diffusion II, 1992.
#include <algorithm>
#include <array>
#include <cmath>

#include "filter/window_operation.hpp"

namespace tegl::detail {

namespace {

template <class Real>
class CurvatureStep final : public WindowOperation<Real> {
 public:
  CurvatureStep(const FilterShape& shape, const CurvatureFlow& flow) : duration_(flow.time), radius_(shape.radii[0]) {
    std::size_t rows = 1;
    for (std::size_t a = 0; a < shape.axes(); ++a) {
      if (shape.radii[a] == 0) continue;
      step_[axes_] = a == 0 ? 0 : rows;
      is_first_[axes_] = a == 0;
      spacing_[axes_++] = flow.spacing[a];
      if (a > 0) rows *= 3;
    }
    middle_ = rows / 2;
  }

  void apply(const WindowRows<Real>& window, Real* out) const override {
    for (std::size_t x = 0; x < window.width; ++x) out[x] = stepped(window.rows, x + radius_);
  }

 private:
  static constexpr std::size_t kMostAxes = 5;

  [[nodiscard]] Real stepped(const Real* const* rows, std::size_t x) const {
    const Real here = rows[middle_][x];
    if (here != here) return here;
    // the sample i steps along axis a and j along axis b
    const auto at = [&](std::size_t a, int i, std::size_t b, int j) {
      std::ptrdiff_t row = static_cast<std::ptrdiff_t>(middle_), place = static_cast<std::ptrdiff_t>(x);
      (is_first_[a] ? place : row) += is_first_[a] ? i : i * static_cast<std::ptrdiff_t>(step_[a]);
      (is_first_[b] ? place : row) += is_first_[b] ? j : j * static_cast<std::ptrdiff_t>(step_[b]);
      const Real value = rows[row][place];
      return static_cast<double>(value != value ? here : value);
    };
    const auto middle = static_cast<double>(here);
    std::array<double, kMostAxes> slope{};
    double square = 0, laplacian = 0, along = 0, least = middle, most = middle;
    for (std::size_t a = 0; a < axes_; ++a) {
      const double before = at(a, -1, a, 0), after = at(a, 1, a, 0);
      least = std::min({least, before, after});
      most = std::max({most, before, after});
      slope[a] = (after - before) / (2 * spacing_[a]);
      const double second = (after - 2 * middle + before) / (spacing_[a] * spacing_[a]);
      square += slope[a] * slope[a];
      laplacian += second;
      along += slope[a] * slope[a] * second;
    }
    for (std::size_t a = 0; a < axes_; ++a)
      for (std::size_t b = a + 1; b < axes_; ++b) {
        const double pp = at(a, 1, b, 1), pm = at(a, 1, b, -1), mp = at(a, -1, b, 1), mm = at(a, -1, b, -1);
        least = std::min({least, pp, pm, mp, mm});
        most = std::max({most, pp, pm, mp, mm});
        along += 2 * slope[a] * slope[b] * (pp - pm - mp + mm) / (4 * spacing_[a] * spacing_[b]);
      }
    const auto n = static_cast<double>(axes_);
    const double rate = square > 0 ? laplacian - along / square : laplacian * (n - 1) / n;
    return static_cast<Real>(std::clamp(middle + duration_ * rate, least, most));
  }

  double duration_;
  std::size_t radius_;  ///< along axis 0
  std::size_t axes_ = 0;
  std::size_t middle_ = 0;
  std::array<double, kMostAxes> spacing_{};    ///< by axis that takes part
  std::array<std::size_t, kMostAxes> step_{};  ///< rows from one sample to the next
  std::array<bool, kMostAxes> is_first_{};     ///< whether it is axis 0, along the rows
};

}  // namespace

template <class Real>
std::unique_ptr<WindowOperation<Real>> make_operation(const FilterShape& shape, const CurvatureFlow& filter) {
  return std::make_unique<CurvatureStep<Real>>(shape, filter);
}
template std::unique_ptr<WindowOperation<float>> make_operation<float>(const FilterShape&, const CurvatureFlow&);
template std::unique_ptr<WindowOperation<double>> make_operation<double>(const FilterShape&, const CurvatureFlow&);

}  // namespace tegl::detail
