// SPDX-License-Identifier: BSD-3-Clause
//
// Collects values that are read and converted block by block. Blocks that fit in the processor's cache cost no fresh
// memory, which takes longer than the conversion.
#pragma once

#include <cstddef>
#include <utility>
#include <variant>

#include "base/value_array.hpp"

namespace tegl::io_detail {

class CollectedValues {
 public:
  /// Number of values per block.
  static constexpr std::size_t kBlock = std::size_t{1} << 18;

  /// `total`: number of values of all blocks. Their memory is reserved, but only used as they arrive.
  explicit CollectedValues(std::size_t total) : total_(total) {}

  /// Appends a block; all blocks have one type.
  void add(ValueArray&& block) {
    std::visit(
        [&]<class T>(ValueVector<T>& values) {
          if (is_first_) {
            ValueVector<T> all;
            all.reserve(total_);
            all_ = std::move(all);
            is_first_ = false;
          }
          auto& all = std::get<ValueVector<T>>(all_);
          all.insert(all.end(), values.begin(), values.end());
        },
        block);
  }
  ValueArray take() { return std::move(all_); }

 private:
  std::size_t total_;
  bool is_first_ = true;
  ValueArray all_;
};

}  // namespace tegl::io_detail
