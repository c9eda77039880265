// SPDX-License-Identifier: BSD-3-Clause
//
// The estimators (see face_estimator.hpp).
//
// Based on: J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast robust geometric predicates", 1997
// (expansions), for means close to the isovalue.
#include "ambiguity/face_estimator.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "ambiguity/saddle.hpp"
#include "base/workers.hpp"
#include "tegl/error.hpp"

namespace tegl {

AmbiguousFace::AmbiguousFace(std::span<const std::size_t> base, unsigned axes, std::span<const double> values,
                             double isovalue, const detail::FaceSurroundings& around)
    : image_dim_(static_cast<int>(base.size())),
      dim_(std::popcount(axes)),
      axes_(axes),
      values_(values),
      isovalue_(isovalue),
      around_(&around) {
  for (std::size_t a = 0; a < base.size(); ++a) base_[a] = base[a] + static_cast<std::size_t>(around.origin[a]);
}

double AmbiguousFace::sample(std::span<const std::ptrdiff_t> steps) const noexcept {
  std::array<std::ptrdiff_t, 5> index{};
  for (int a = 0; a < image_dim_; ++a) {
    const std::ptrdiff_t step = static_cast<std::size_t>(a) < steps.size() ? steps[static_cast<std::size_t>(a)] : 0;
    index[a] = std::clamp(static_cast<std::ptrdiff_t>(base_[a]) - around_->origin[a] + step, around_->first[a],
                          around_->end[a] - 1);
  }
  return around_->read(around_->image, index.data());
}

namespace detail {
namespace {

/// x + y as a rounded sum and its exact rounding error (Knuth).
struct TwoSum {
  double sum, rest;
  TwoSum(double x, double y) noexcept : sum(x + y) {
    const double y_part = sum - x;
    rest = (x - (sum - y_part)) + (y - y_part);
  }
};

/// The exact sum of at most 33 numbers, as an expansion: non-overlapping parts of increasing magnitude.
class ExactSum {
 public:
  void add(double x) noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
      const TwoSum two(x, parts_[i]);
      parts_[i] = two.rest;
      x = two.sum;
    }
    parts_[count_++] = x;
  }
  [[nodiscard]] bool is_negative() const noexcept {
    for (std::size_t i = count_; i-- > 0;)
      if (parts_[i] != 0.0) return parts_[i] < 0.0;
    return false;
  }

 private:
  std::array<double, 33> parts_{};
  std::size_t count_ = 0;
};

/// is_mean_high if the sum overflows or a value is infinite.
bool is_large_mean_high(std::span<const double> values, double isovalue) noexcept {
  constexpr double kSmaller = 0x1p-10;
  double sum = 0.0;
  for (const double value : values) sum += value * kSmaller;
  return !(sum < static_cast<double>(values.size()) * (isovalue * kSmaller));
}

}  // namespace

namespace {

/// is_mean_high if rounding could decide; correct for all values.
[[gnu::noinline, gnu::cold]] bool is_near_mean_high(std::span<const double> values, double isovalue) noexcept {
  const double limit = static_cast<double>(values.size()) * isovalue;
  double sum = 0.0;
  double rests = 0.0;
  for (const double value : values) {
    const TwoSum two(sum, value);
    sum = two.sum;
    rests += std::abs(two.rest);
  }
  if (!std::isfinite(sum) || !std::isfinite(limit)) return is_large_mean_high(values, isovalue);
  if (rests == 0.0 || std::abs(sum - limit) > 2 * rests) return sum >= limit;
  ExactSum exact;
  for (const double value : values) exact.add(value);
  exact.add(-limit);
  return !exact.is_negative();
}

/// is_mean_high for `Count` values. Count is a power of two, so the limit is exact.
template <std::size_t Count>
bool is_mean_high_of(const double* values, double isovalue) noexcept {
  const double limit = static_cast<double>(Count) * isovalue;
  std::array<double, Count> sums;
  std::array<double, Count> sizes;
  for (std::size_t i = 0; i < Count; ++i) {
    sums[i] = values[i];
    sizes[i] = std::abs(values[i]);
  }
  // Summed pairwise, so that additions are independent.
  [&]<std::size_t... Level>(std::index_sequence<Level...>) {
    const auto halve = [&](std::size_t half) {
      for (std::size_t i = 0; i < half; ++i) {
        sums[i] += sums[i + half];
        sizes[i] += sizes[i + half];
      }
    };
    (halve(Count >> (Level + 1)), ...);
  }
  (std::make_index_sequence<std::countr_zero(Count)>());
  const double size = sizes[0] + std::abs(limit);
  // A bound of all rounding errors. The test is false if anything is not finite.
  if (std::abs(sums[0] - limit) > 0x1p-46 * size && size < 0x1p1000) return sums[0] > limit;
  return is_near_mean_high({values, Count}, isovalue);
}

}  // namespace

bool is_mean_high(std::span<const double> values, double isovalue) noexcept {
  if (values.size() == 4) return is_mean_high_of<4>(values.data(), isovalue);
  if (values.size() == 8) return is_mean_high_of<8>(values.data(), isovalue);
  if (values.size() == 16) return is_mean_high_of<16>(values.data(), isovalue);
  if (values.size() == 32) return is_mean_high_of<32>(values.data(), isovalue);
  return is_near_mean_high(values, isovalue);
}

template <int N>
FaceEstimator<N>::FaceEstimator(const CornerValues<N>& source, const Index& sizes, const ExtractOptions& options,
                                PartOfImage part)
    : source_(source),
      rule_(face_rule(options.ambiguity)),
      estimator_(options.estimator),
      triangulation_(options.triangulation),
      isovalue_(source.isovalue()) {
  around_.image = &source;
  around_.read = [](const void* image, const std::ptrdiff_t* index) {
    Index at;
    for (int a = 0; a < N; ++a) at[a] = static_cast<std::size_t>(index[a]);
    return static_cast<const CornerValues<N>*>(image)->value(at);
  };
  for (int a = 0; a < N; ++a) around_.end[a] = static_cast<std::ptrdiff_t>(sizes[a]);
  if (part.axis >= 0) around_.origin[part.axis] = static_cast<std::ptrdiff_t>(part.first);
  around_.origin[N - 1] += static_cast<std::ptrdiff_t>(source.first_layer());
  around_.first[N - 1] = -static_cast<std::ptrdiff_t>(source.first_layer());
  around_.end[N - 1] = std::max(around_.end[N - 1], static_cast<std::ptrdiff_t>(source.layers_from_first()));
}

template <int N>
bool FaceEstimator<N>::is_square_high(const Index& base, unsigned axes,
                                      std::span<const double, 4> values) const noexcept {
  if (is_by_means()) return is_mean_high(values, isovalue_);
  if (is_by_saddles()) return tegl::square_is_high<double>(values, isovalue_);
  return ask(base, axes, values) == tile::Choice::high;
}

template <int N>
tile::Choice FaceEstimator<N>::choice(const Index& base, unsigned axes, std::span<const double> values) const noexcept {
  if (is_callers()) return ask(base, axes, values);
  if (separates()) return tile::Choice::separate;
  if (is_by_saddles() && values.size() == 8) return tegl::cube_choice<double>(values.first<8>(), isovalue_);
  return is_mean_high(values, isovalue_) ? tile::Choice::high : tile::Choice::low;
}

template <int N>
tile::Choice FaceEstimator<N>::ask(const Index& base, unsigned axes, std::span<const double> values) const noexcept {
  if (failed_.load(std::memory_order_relaxed)) return tile::Choice::separate;
  // Limited to the caller's reach: streamed images may have no other samples in memory.
  FaceSurroundings near = around_;
  const auto reach = static_cast<std::ptrdiff_t>(std::min<std::size_t>(estimator_.reach, 1u << 30));
  for (unsigned a = 0; a < N; ++a) {
    const auto at = static_cast<std::ptrdiff_t>(base[a]);
    near.first[a] = std::max(near.first[a], at - reach);
    near.end[a] = std::min(near.end[a], at + static_cast<std::ptrdiff_t>(axes >> a & 1u) + reach + 1);
  }
  try {
    const AmbiguousFace face = near.face(base, axes, values, isovalue_);
    const tile::Choice choice = call_apart([&] { return estimator_.choose(face); });
    return choice <= tile::Choice::high ? choice : tile::Choice::separate;
  } catch (...) {
    keep_error(std::current_exception());
  }
  return tile::Choice::separate;
}

template <int N>
void FaceEstimator<N>::keep_error(std::exception_ptr error) const noexcept {
  const std::lock_guard lock(mutex_);
  if (!error_) error_ = std::move(error);
  failed_ = true;
}

template <int N>
void FaceEstimator<N>::report_change(const Index& row) const noexcept {
  if (failed_) return;  // later answers are not the caller's
  try {
    std::string place;
    for (int a = 0; a < N; ++a)
      place += fmt::format("{}{}", a == 0 ? "" : ", ", static_cast<std::ptrdiff_t>(row[a]) + around_.origin[a]);
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("the estimator gave different results for the same face, in the row of tiles from sample "
                            "({}) on; expected results that depend only on the face",
                            place));
  } catch (...) {
    keep_error(std::current_exception());
  }
}

template <int N>
void FaceEstimator<N>::rethrow() const {
  if (!failed_) return;
  const std::lock_guard lock(mutex_);
  std::rethrow_exception(error_);
}

template class FaceEstimator<2>;
template class FaceEstimator<3>;
template class FaceEstimator<4>;
template class FaceEstimator<5>;

}  // namespace detail
}  // namespace tegl
