// SPDX-License-Identifier: BSD-3-Clause
//
// Decides the ambiguous faces of an image from the data, face by face: what the estimators of Ambiguity::mean, saddle
// and custom say. Tiles around a face ask for it one after the other and get the same answer, as it depends on the
// face's own corners, in the order of the face's own frame, and nothing else.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <span>

#include "image/extract_source.hpp"
#include "tegl/extract.hpp"

namespace tegl::detail {

/// Whether the mean of values is at or above the isovalue, exactly; of infinite ones of both signs it is.
bool is_mean_high(std::span<const double> values, double isovalue) noexcept;

/// Whether the data decide.
constexpr bool is_estimated(Ambiguity ambiguity) noexcept {
  return ambiguity != Ambiguity::low && ambiguity != Ambiguity::high;
}

/// For messages.
const char* name_of(Ambiguity ambiguity) noexcept;

/// What an image is a part of: the samples from `first` on along `axis`, all along the others. (Along the last axis
/// sources know it by themselves.)
struct PartOfImage {
  int axis = -1;
  std::size_t first = 0;
};

/// Thread safe. The source must outlive it.
template <int N>
class FaceEstimator {
 public:
  using Index = std::array<std::size_t, N>;

  FaceEstimator(const SampleSource<N>& source, const Index& sizes, const ExtractOptions& options, PartOfImage part);
  FaceEstimator(const FaceEstimator&) = delete;
  FaceEstimator& operator=(const FaceEstimator&) = delete;

  [[nodiscard]] const SampleSource<N>& source() const noexcept { return source_; }
  /// Of the contour that it is asked for, by the number that tables have for it.
  [[nodiscard]] int triangulation() const noexcept { return triangulation_; }

  /// The centre of the ambiguous square along `axes` based at `base`, with these values at its corners.
  [[nodiscard]] bool is_square_high(const Index& base, unsigned axes, std::span<const double, 4> values) const noexcept;
  /// Whether cubes are to be decided by decide_cube (tegl/saddle.hpp), squares and all, at once.
  [[nodiscard]] bool is_by_cubes() const noexcept { return ambiguity_ == Ambiguity::saddle; }
  /// Whether faces are decided by their means.
  [[nodiscard]] bool is_by_means() const noexcept { return ambiguity_ == Ambiguity::mean; }
  [[nodiscard]] double isovalue() const noexcept { return isovalue_; }
  /// The filling of a face of three or more dimensions.
  [[nodiscard]] facets::Choice choice(const Index& base, unsigned axes, std::span<const double> values) const noexcept;

  /// Whether a caller decides, whose answers may differ from one time to the next.
  [[nodiscard]] bool is_callers() const noexcept { return ambiguity_ == Ambiguity::custom; }
  /// Notes that they did, in the row of tiles based at `row`: ends the extraction as what the caller throws does.
  void report_change(const Index& row) const noexcept;

  /// Throws what a caller's estimator threw, if it did, or that its answers changed.
  void rethrow() const;

 private:
  [[nodiscard]] facets::Choice ask(const Index& base, unsigned axes, std::span<const double> values) const noexcept;

  void keep_error(std::exception_ptr error) const noexcept;

  const SampleSource<N>& source_;
  Ambiguity ambiguity_;
  const Estimator& estimator_;
  int triangulation_;
  double isovalue_;
  AmbiguousFace::Surroundings around_;
  mutable std::atomic<bool> failed_ = false;
  mutable std::mutex mutex_;
  mutable std::exception_ptr error_;
};

}  // namespace tegl::detail
