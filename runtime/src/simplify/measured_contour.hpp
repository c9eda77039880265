// SPDX-License-Identifier: BSD-3-Clause
//
// A contour that is compared with several others, one after the other: prepared once for measurements of distances, by
// another thread if there is time.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "base/progress.hpp"
#include "base/task_aside.hpp"
#include "simplify/deviation_target.hpp"
#include "simplify/scaled_simplices.hpp"
#include "tegl/contour.hpp"
#include "tegl/deviation.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

template <int N>
class MeasuredContour {
 public:
  /// The contour must outlive it.
  MeasuredContour(const Contour<N, double>& contour, const std::array<double, N>& scale, unsigned threads)
      : contour_(contour), scale_(scale), threads_(threads) {}
  /// If nobody has waited for the preparation, it is cancelled.
  ~MeasuredContour() { is_wanted_ = false; }
  MeasuredContour(const MeasuredContour&) = delete;
  MeasuredContour& operator=(const MeasuredContour&) = delete;

  /// The neighbours of the contour's simplices, if they are known: call it before `begin`.
  void set_neighbours(std::shared_ptr<const FacetNeighbours<N>> neighbours) { neighbours_ = std::move(neighbours); }

  /// With several threads, another one begins with the preparation. It comes on top of the threads of parallel loops
  /// that run meanwhile. A single thread prepares the contour in `measure`, when the memory of its earlier work is
  /// free.
  void begin() {
    if (threads_ == 1 || preparation_) return;
    preparation_.emplace([this] {
      const Progress until_unwanted = [this](double) { return is_wanted_.load(); };
      simplices_.emplace(contour_, scale_);
      make_target(1, until_unwanted);
    });
    preparation_->begin();
  }

  /// Whether all measurements together took more than about ten seconds, or half a millisecond per simplex. Counted by
  /// comparisons, so that it does not depend on the machine and the number of threads.
  [[nodiscard]] bool took_long() const {
    constexpr std::uint64_t kMany = 60'000'000, kManyOfSimplex = 2'000;
    return comparisons_ > std::max(kMany, kManyOfSimplex * contour_.simplices.size());
  }

  /// Only to_other.of_to and from_other.of_from are filled: bounds by simplex of the other contour.
  struct Deviations {
    Deviation to_other, from_other;
  };
  /// Distances in both directions. `enough`: as in DeviationOptions; 0 means the largest known distance to the other
  /// contour for those from it. Neither contour may be empty.
  Deviations measure(const Contour<N, double>& other, double enough, const WorkOptions& work) {
    if (preparation_) preparation_->finish();
    if (!simplices_) simplices_.emplace(contour_, scale_);
    const ScaledSimplices<N> simplices(other, scale_);
    Deviations result;
    {
      const DeviationTarget<N> target(simplices, work.threads, part_of(work.progress, 0.0, 0.05));
      result.to_other = deviation_to(*simplices_, target, enough, {.of_from = false, .comparisons = &comparisons_},
                                     {work.threads, part_of(work.progress, 0.05, 0.5)});
    }
    if (!target_)  // when the memory of the other target is free
      make_target(work.threads, part_of(work.progress, 0.5, 0.55));
    result.from_other =
        deviation_to(simplices, *target_, enough > 0.0 ? enough : result.to_other.least,
                     {.of_to = false, .comparisons = &comparisons_}, {work.threads, part_of(work.progress, 0.55, 1.0)});
    return result;
  }

 private:
  void make_target(unsigned threads, const Progress& progress) {
    if (!neighbours_) {
      target_.emplace(*simplices_, threads, progress);
      return;
    }
    FacetNeighbours<N> neighbours(*neighbours_, simplices_->order.simplices, threads, part_of(progress, 0.0, 0.5));
    neighbours_.reset();
    target_.emplace(*simplices_, std::move(neighbours), threads, part_of(progress, 0.5, 1.0));
  }

  const Contour<N, double>& contour_;
  std::array<double, N> scale_;
  unsigned threads_;
  std::shared_ptr<const FacetNeighbours<N>> neighbours_;  ///< in the order of the contour, until they are used
  std::optional<ScaledSimplices<N>> simplices_;
  std::optional<DeviationTarget<N>> target_;
  std::atomic<bool> is_wanted_ = true;
  std::uint64_t comparisons_ = 0;
  std::optional<TaskAside> preparation_;  ///< the last member: it waits for the thread that uses the others
};

}  // namespace tegl::detail
