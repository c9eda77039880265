// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers of vertices that the next part of a stream has, too, or the last one if the last axis is periodic.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>

namespace tegl::detail {

/// Between which parts something is.
struct BetweenParts {
  bool before = false;  ///< this part and the one before
  bool behind = false;  ///< this part and the next one
  bool seam = false;    ///< the first part and the last one
};

template <class Key>
class SharedNumbers {
 public:
  /// The number of what an earlier part had.
  [[nodiscard]] std::optional<std::uint64_t> find(const Key& key, const BetweenParts& between) const {
    if (between.before)
      if (const auto found = of_part_before_.find(key); found != of_part_before_.end()) return found->second;
    if (between.seam)
      if (const auto found = of_first_part_.find(key); found != of_first_part_.end()) return found->second;
    return std::nullopt;
  }
  void add(const Key& key, std::uint64_t number, const BetweenParts& between, bool is_first_part) {
    if (between.behind) of_part_.insert_or_assign(of_part_.end(), key, number);
    if (between.seam && is_first_part) of_first_part_.insert_or_assign(of_first_part_.end(), key, number);
  }
  void end_part() {
    of_part_before_ = std::move(of_part_);
    of_part_.clear();
  }

 private:
  std::map<Key, std::uint64_t> of_part_, of_part_before_, of_first_part_;
};

}  // namespace tegl::detail
