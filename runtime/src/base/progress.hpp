// SPDX-License-Identifier: BSD-3-Clause
//
// Progress of operations that have several passes after each other.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "tegl/error.hpp"

namespace tegl::detail {

/// Tells `progress`; throws Cancelled, with this message, where it says stop.
inline void tell(const Progress& progress, double fraction,
                 const char* message = "cancelled by the progress callback") {
  if (progress && !progress(fraction)) throw Error(ErrorCode::Cancelled, message);
}

/// The progress of a pass that takes the whole from `first` to `last`. The whole's must outlive it.
inline Progress part_of(const Progress& progress, double first, double last) {
  if (!progress) return {};
  return [&progress, first, last](double fraction) {
    return progress(fraction < 1.0 ? first + (last - first) * fraction : last);
  };
}

/// The progress of work that comes in pieces of any size: told whenever `every` items more are done.
class CountedProgress {
 public:
  /// `count`: of all items. `progress` must outlive this.
  CountedProgress(const Progress& progress, std::uint64_t count, std::uint64_t every = std::uint64_t{1} << 16)
      : progress_(progress), count_(count), every_(every) {}

  /// So many more are done. Throws Cancelled, as `tell` does.
  void add(std::uint64_t items) {
    done_ += items;
    if (done_ < next_) return;
    next_ = done_ + every_;
    tell(progress_, std::min(1.0, static_cast<double>(done_) / static_cast<double>(count_)));
  }

 private:
  const Progress& progress_;
  std::uint64_t count_;
  std::uint64_t every_;
  std::uint64_t done_ = 0;
  std::uint64_t next_ = 0;
};

/// Calls work(from, to) for one part of 0 … count - 1 after the other, each of `size` (the last one may be smaller), by
/// the caller's thread; `progress` is told before each, and of the end.
template <class Work>
void in_parts(std::size_t count, const Progress& progress, const Work& work, std::size_t size = std::size_t{1} << 16) {
  for (std::size_t first = 0; first < count; first += size) {
    tell(progress, static_cast<double>(first) / static_cast<double>(count));
    work(first, std::min(count, first + size));
  }
  tell(progress, 1.0);
}

}  // namespace tegl::detail
