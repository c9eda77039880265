// SPDX-License-Identifier: BSD-3-Clause
//
// Implements the operations on boxes: convolution, median, bilateral filter, contextual low-pass filter.
#include "filter/window_operation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "filter/weighted_lines.hpp"

namespace tegl::detail {

namespace {

/// A sample of the box: its row, and its place relative to the start of the row.
struct BoxPlace {
  std::size_t row;
  std::size_t shift;
};

/// The places of the box, axis 0 fastest.
std::vector<BoxPlace> places_of(const FilterShape& shape) {
  std::size_t rows = 1;
  for (std::size_t a = 1; a < shape.axes(); ++a) rows *= 2 * shape.radii[a] + 1;
  std::vector<BoxPlace> places;
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t i = 0; i < 2 * shape.radii[0] + 1; ++i) places.push_back({r, i});
  return places;
}

/// Offset of a place along an axis, from -radius to radius.
std::ptrdiff_t offset_along(const FilterShape& shape, const BoxPlace& place, std::size_t axis) {
  if (axis == 0) return static_cast<std::ptrdiff_t>(place.shift) - static_cast<std::ptrdiff_t>(shape.radii[0]);
  std::size_t rest = place.row;
  for (std::size_t a = 1; a < axis; ++a) rest /= 2 * shape.radii[a] + 1;
  return static_cast<std::ptrdiff_t>(rest % (2 * shape.radii[axis] + 1)) -
         static_cast<std::ptrdiff_t>(shape.radii[axis]);
}

template <class Real>
class KernelOperation final : public WindowOperation<Real> {
 public:
  KernelOperation(const FilterShape& shape, const Convolution& filter) {
    const std::vector<BoxPlace> places = places_of(shape);
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (filter.weights[i] == 0) continue;
      places_.push_back(places[i]);
      weights_.push_back(static_cast<Real>(filter.weights[i]));
      normalised_ = normalised_ && filter.weights[i] > 0;
      sum_ += filter.weights[i];
    }
    if (!places_.empty()) return;
    places_.push_back(places[places.size() / 2]);
    weights_.push_back(0);
    normalised_ = false;
  }

  void apply(const WindowRows<Real>& window, Real* out) const override {
    std::vector<const Real*>& lines = window.own->lines;
    lines.resize(places_.size());
    for (std::size_t i = 0; i < places_.size(); ++i) lines[i] = window.rows[places_[i].row] + places_[i].shift;
    if (!window.may_miss || !normalised_)
      return weighted_lines(lines.data(), weights_.data(), weights_.size(), window.width, out);
    for (std::size_t x = 0; x < window.width; ++x) {
      Real sum = 0;
      Real present = 0;
      for (std::size_t i = 0; i < lines.size(); ++i) {
        const Real value = lines[i][x];
        if (value != value) continue;
        sum += weights_[i] * value;
        present += weights_[i];
      }
      out[x] = present > 0 ? sum / present * static_cast<Real>(sum_) : std::numeric_limits<Real>::quiet_NaN();
    }
  }

 private:
  std::vector<BoxPlace> places_;
  std::vector<Real> weights_;
  double sum_ = 0;
  bool normalised_ = true;
};

template <class Real>
class MedianOperation final : public WindowOperation<Real> {
 public:
  explicit MedianOperation(const FilterShape& shape)
      : rows_(places_of(shape).size() / (2 * shape.radii[0] + 1)), length_(2 * shape.radii[0] + 1) {}

  void apply(const WindowRows<Real>& window, Real* out) const override {
    std::vector<Real>& box = window.own->first;
    box.resize(rows_ * length_);
    for (std::size_t x = 0; x < window.width; ++x) {
      Real* end = box.data();
      for (std::size_t r = 0; r < rows_; ++r) end = std::copy_n(window.rows[r] + x, length_, end);
      if (window.may_miss) end = std::remove_if(box.data(), end, [](Real value) { return value != value; });
      out[x] = median(box.data(), end);
    }
  }

 private:
  static Real median(Real* begin, Real* end) {
    const std::ptrdiff_t count = end - begin;
    if (count == 0) return std::numeric_limits<Real>::quiet_NaN();
    Real* const middle = begin + count / 2;
    std::nth_element(begin, middle, end);
    if (count % 2 == 1) return *middle;
    const Real below = *std::max_element(begin, middle);
    return below + (*middle - below) / 2;
  }

  std::size_t rows_;
  std::size_t length_;
};

/// exp(-x^2 / 2) from a table with linear interpolation; 0 beyond kMost.
class GaussianTable {
 public:
  GaussianTable() {
    for (std::size_t i = 0; i < values_.size(); ++i) {
      const double x = kMost * static_cast<double>(i) / kSteps;
      values_[i] = i < kSteps ? std::exp(-0.5 * x * x) : 0.0;
    }
  }
  [[nodiscard]] double operator()(double x) const noexcept {
    const double at = std::abs(x) * (kSteps / kMost);
    if (!(at < kSteps)) return 0;
    const auto below = static_cast<std::size_t>(at);
    return values_[below] + (at - static_cast<double>(below)) * (values_[below + 1] - values_[below]);
  }

 private:
  static constexpr double kMost = 4;
  static constexpr std::size_t kSteps = 8192;
  std::array<double, kSteps + 2> values_{};
};

template <class Real>
class BilateralOperation final : public WindowOperation<Real> {
 public:
  BilateralOperation(const FilterShape& shape, const BilateralFilter& filter)
      : per_sigma_(1 / filter.value_sigma), middle_{0, shape.radii[0]} {
    const std::vector<BoxPlace> places = places_of(shape);
    middle_ = places[places.size() / 2];
    for (const BoxPlace& place : places) {
      double square = 0;
      for (std::size_t a = 0; a < shape.axes(); ++a) {
        if (filter.sigmas[a] == 0) continue;
        const double distance = static_cast<double>(offset_along(shape, place, a)) / filter.sigmas[a];
        square += distance * distance;
      }
      if (square > kFarthest * kFarthest) continue;
      places_.push_back(place);
      weights_.push_back(std::exp(-square / 2));
    }
  }

  /// Samples farther than this many sigma have no weight.
  static constexpr double kFarthest = 2.5;

  void apply(const WindowRows<Real>& window, Real* out) const override {
    const Real* const middle = window.rows[middle_.row] + middle_.shift;
    for (std::size_t x = 0; x < window.width; ++x) {
      const auto here = static_cast<double>(middle[x]);
      double sum = 0;
      double present = 0;
      for (std::size_t i = 0; i < places_.size(); ++i) {
        const auto value = static_cast<double>(window.rows[places_[i].row][places_[i].shift + x]);
        if (value != value) continue;
        // a missing sample has no value to compare with: the distance alone counts
        const double weight = here != here ? weights_[i] : weights_[i] * table_((value - here) * per_sigma_);
        sum += weight * (value - (here != here ? 0 : here));
        present += weight;
      }
      const double mean = sum / present;  // relative to this sample: exact if all are equal
      out[x] = static_cast<Real>(here != here ? mean : here + mean);
    }
  }

 private:
  GaussianTable table_;
  double per_sigma_;
  BoxPlace middle_;
  std::vector<BoxPlace> places_;
  std::vector<double> weights_;
};

/// The number of samples from the middle of a line of the context to its end.
constexpr std::ptrdiff_t kContext = 2;

template <class Real>
class ContextOperation final : public WindowOperation<Real> {
 public:
  ContextOperation(const FilterShape& shape, const ContextualLowPass& filter) : places_(places_of(shape)) {
    for (const BoxPlace& place : places_) weights_.push_back(static_cast<Real>(weight_of(shape, place)));
    std::size_t stride = 1;
    for (std::size_t a = 0; a < shape.axes(); ++a, stride *= 2 * kContext + 1)
      for (std::size_t i = 0; i < places_.size(); ++i)
        if (weights_[i] != 0 && offset_along(shape, places_[i], a) == 0) lines_.push_back({i, stride});
    // the least value of this type that is high, and the greatest that is low
    high_ = static_cast<Real>(filter.isovalue);
    constexpr Real kInfinity = std::numeric_limits<Real>::infinity();
    if (static_cast<double>(high_) < filter.isovalue) high_ = std::nextafter(high_, kInfinity);
    low_ = std::nextafter(high_, -kInfinity);
  }

  void apply(const WindowRows<Real>& window, Real* out) const override {
    std::vector<Real>& box = window.own->first;
    box.resize(places_.size());
    const std::size_t middle = places_.size() / 2;
    for (std::size_t x = 0; x < window.width; ++x) {
      bool missing = false;
      for (std::size_t i = 0; i < places_.size(); ++i) {
        box[i] = window.rows[places_[i].row][places_[i].shift + x];
        missing |= box[i] != box[i];
      }
      out[x] = box[middle];
      if (missing || !is_plain(box)) continue;
      Real mean = 0;
      for (std::size_t i = 0; i < box.size(); ++i) mean += weights_[i] * box[i];
      out[x] = box[middle] >= high_ ? std::max(mean, high_) : std::min(mean, low_);
    }
  }

 private:
  /// A line of the box along an axis: the number of its middle, and the step.
  struct Line {
    std::size_t middle;
    std::size_t stride;
  };

  /// Weight of the binomial mean; 0 outside of the 3^N samples.
  static double weight_of(const FilterShape& shape, const BoxPlace& place) {
    double weight = 1;
    for (std::size_t a = 0; a < shape.axes(); ++a) {
      const std::ptrdiff_t offset = std::abs(offset_along(shape, place, a));
      weight *= offset == 0 ? 0.5 : offset == 1 ? 0.25 : 0;
    }
    return weight;
  }

  /// Whether the contour passes through the 3^N samples, and crosses no line of the context twice.
  [[nodiscard]] bool is_plain(const std::vector<Real>& box) const {
    bool crosses = false;
    for (const Line& line : lines_) {
      const Real* at = &box[line.middle - kContext * line.stride];
      int crossings = 0;
      for (std::ptrdiff_t i = 0; i < 2 * kContext; ++i, at += line.stride) {
        if ((at[0] >= high_) == (at[line.stride] >= high_)) continue;
        if (++crossings > 1) return false;
        crosses = crosses || i == kContext - 1 || i == kContext;
      }
    }
    return crosses;
  }

  std::vector<BoxPlace> places_;
  std::vector<Line> lines_;
  std::vector<Real> weights_;
  Real high_ = 0;
  Real low_ = 0;
};

}  // namespace

template <class Real>
std::unique_ptr<WindowOperation<Real>> make_operation(const FilterShape& shape, const Convolution& filter) {
  return std::make_unique<KernelOperation<Real>>(shape, filter);
}
template <class Real>
std::unique_ptr<WindowOperation<Real>> make_operation(const FilterShape& shape, const MedianFilter& /*filter*/) {
  return std::make_unique<MedianOperation<Real>>(shape);
}
template <class Real>
std::unique_ptr<WindowOperation<Real>> make_operation(const FilterShape& shape, const BilateralFilter& filter) {
  return std::make_unique<BilateralOperation<Real>>(shape, filter);
}
template <class Real>
std::unique_ptr<WindowOperation<Real>> make_operation(const FilterShape& shape, const ContextualLowPass& filter) {
  return std::make_unique<ContextOperation<Real>>(shape, filter);
}

#define TEGL_INSTANTIATE_OPERATION(Kind)                                                                   \
  template std::unique_ptr<WindowOperation<float>> make_operation<float>(const FilterShape&, const Kind&); \
  template std::unique_ptr<WindowOperation<double>> make_operation<double>(const FilterShape&, const Kind&);
TEGL_INSTANTIATE_OPERATION(Convolution)
TEGL_INSTANTIATE_OPERATION(MedianFilter)
TEGL_INSTANTIATE_OPERATION(BilateralFilter)
TEGL_INSTANTIATE_OPERATION(ContextualLowPass)
#undef TEGL_INSTANTIATE_OPERATION

}  // namespace tegl::detail
