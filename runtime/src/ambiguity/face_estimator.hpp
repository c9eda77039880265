// SPDX-License-Identifier: BSD-3-Clause
//
// Decides the ambiguous faces of an image from the data, face by face, for all values of Ambiguity except low and high.
// All tiles at a face get the same decision, as it depends only on the values at the face's corners, in the order of
// the face's own frame (and, for a caller's estimator, on samples within its reach).
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <span>

#include "ambiguity/face_surroundings.hpp"
#include "image/sample_source.hpp"
#include "tegl/extract.hpp"

namespace tegl::detail {

/// Whether the mean of the values is at least the isovalue, exactly. True if there are infinite values of both signs.
bool is_mean_high(std::span<const double> values, double isovalue) noexcept;

/// Whether ambiguities are resolved from the data.
constexpr bool is_estimated(Ambiguity ambiguity) noexcept {
  return ambiguity != Ambiguity::low && ambiguity != Ambiguity::high;
}

/// A rule for ambiguous faces: what decides a square, and whether larger faces are decided at all.
struct FaceRule {
  enum class By { means, saddles, caller };
  By by;
  bool separates;  ///< cubes and larger faces are always `separate`
};
/// For is_estimated(ambiguity).
constexpr FaceRule face_rule(Ambiguity ambiguity) noexcept {
  const bool separates = ambiguity == Ambiguity::squares || ambiguity == Ambiguity::decider;
  if (ambiguity == Ambiguity::mean || ambiguity == Ambiguity::squares) return {FaceRule::By::means, separates};
  if (ambiguity == Ambiguity::saddle || ambiguity == Ambiguity::decider) return {FaceRule::By::saddles, separates};
  return {FaceRule::By::caller, separates};
}

/// Position of the extracted image in a whole image: samples from `first` on along `axis`, all samples along the other
/// axes. (Along the last axis, sources have this information.)
struct PartOfImage {
  int axis = -1;
  std::size_t first = 0;
};

/// Decides faces by the chosen estimator. Thread safe. The source must outlive it.
template <int N>
class FaceEstimator {
 public:
  using Index = std::array<std::size_t, N>;

  FaceEstimator(const CornerValues<N>& source, const Index& sizes, const ExtractOptions& options, PartOfImage part);
  FaceEstimator(const FaceEstimator&) = delete;
  FaceEstimator& operator=(const FaceEstimator&) = delete;

  [[nodiscard]] const CornerValues<N>& source() const noexcept { return source_; }
  /// Triangulation of the contour.
  [[nodiscard]] Triangulation triangulation() const noexcept { return triangulation_; }

  /// Whether the centre of an ambiguous square is high. `values`: at its corners.
  [[nodiscard]] bool is_square_high(const Index& base, unsigned axes, std::span<const double, 4> values) const noexcept;
  /// Whether squares are decided by their saddles, and cubes by decide_cube (tegl/saddle.hpp) unless `separates`.
  [[nodiscard]] bool is_by_saddles() const noexcept { return rule_.by == FaceRule::By::saddles; }
  /// Whether squares are decided by the means of their corners, and larger faces by the means of theirs, unless
  /// `separates`.
  [[nodiscard]] bool is_by_means() const noexcept { return rule_.by == FaceRule::By::means; }
  /// Whether cubes and larger faces are always `separate`.
  [[nodiscard]] bool separates() const noexcept { return rule_.separates; }
  [[nodiscard]] double isovalue() const noexcept { return isovalue_; }
  /// The filling of a face of dimension 3 or more.
  [[nodiscard]] tile::Choice choice(const Index& base, unsigned axes, std::span<const double> values) const noexcept;

  /// Whether a caller's estimator decides. Its answers may change between calls.
  [[nodiscard]] bool is_callers() const noexcept { return rule_.by == FaceRule::By::caller; }
  /// Records that a caller's answers changed, in the row of tiles based at `row`. `rethrow` then throws an error.
  void report_change(const Index& row) const noexcept;

  /// Throws the exception of a caller's estimator, or an error if its answers changed.
  void rethrow() const;

 private:
  [[nodiscard]] tile::Choice ask(const Index& base, unsigned axes, std::span<const double> values) const noexcept;

  void keep_error(std::exception_ptr error) const noexcept;

  const CornerValues<N>& source_;
  FaceRule rule_;
  const Estimator& estimator_;
  Triangulation triangulation_;
  double isovalue_;
  FaceSurroundings around_;
  mutable std::atomic<bool> failed_ = false;
  mutable std::mutex mutex_;
  mutable std::exception_ptr error_;
};

}  // namespace tegl::detail
