// SPDX-License-Identifier: BSD-3-Clause
//
// Progress reports of operations with several passes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "base/function_ref.hpp"
#include "tegl/error.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// Reports `fraction` to `progress`. Throws Cancelled with `message` if it returns false.
inline void tell(const Progress& progress, double fraction,
                 const char* message = "cancelled by the progress callback") {
  if (progress && !progress(fraction)) throw Error(ErrorCode::Cancelled, message);
}

/// Progress of a pass that covers `first` to `last` of the whole. `progress` must outlive the result.
inline Progress part_of(const Progress& progress, double first, double last) {
  if (!progress) return {};
  return [&progress, first, last](double fraction) {
    return progress(fraction < 1.0 ? first + (last - first) * fraction : last);
  };
}

/// Progress of work in portions of any size. Reports after every `every` items.
class CountedProgress {
 public:
  /// `count`: number of all items. `progress` must outlive this object.
  CountedProgress(const Progress& progress, std::uint64_t count, std::uint64_t every = std::uint64_t{1} << 16)
      : progress_(progress), count_(count), every_(every) {}

  /// Adds finished items. Throws Cancelled if requested.
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

/// Calls work(from, to) in order for parts of 0 … count - 1 of `size` items each (the last may be smaller), on the
/// calling thread. Reports progress before each part and at the end.
inline void in_parts(std::size_t count, const Progress& progress,
                     FunctionRef<void(std::size_t from, std::size_t to)> work,
                     std::size_t size = std::size_t{1} << 16) {
  for (std::size_t first = 0; first < count; first += size) {
    tell(progress, static_cast<double>(first) / static_cast<double>(count));
    work(first, std::min(count, first + size));
  }
  tell(progress, 1.0);
}

}  // namespace tegl::detail
