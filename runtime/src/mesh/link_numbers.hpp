// SPDX-License-Identifier: BSD-3-Clause
//
// Small numbers for the vertices around a vertex, so that sets of them are words of 64 bits and nothing is sorted.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "tegl/contour.hpp"

namespace tegl::detail {

/// The vertices of a simplex with N vertices except v, in an order such that v followed by them has the simplex's
/// orientation: their own order, with the last two exchanged if v is at an odd place. N >= 3.
template <unsigned N>
class OthersOfSimplex {
 public:
  OthersOfSimplex(const Index* row, Index v) noexcept : row_(row) {
    for (unsigned i = 1; i < N; ++i) at_ += row[i] == v ? i : 0;
  }
  [[nodiscard]] Index operator[](unsigned i) const noexcept {
    const unsigned odd = at_ & 1;
    const unsigned place = i + 3 == N ? i + odd : i + 2 == N ? i - odd : i;
    return row_[place + (place >= at_ ? 1 : 0)];
  }

 private:
  const Index* row_;
  unsigned at_ = 0;  ///< place of v
};

/// Numbers 0, 1, … for the vertices of one link at a time, in the order in which they are met. Use one object per
/// thread; it takes 8 bytes per vertex of the contour.
class LinkNumbers {
 private:
  /// The link in which a vertex was met last, and its number there.
  struct Met {
    Index link_of = std::numeric_limits<Index>::max();
    Index number = 0;
  };

 public:
  static constexpr unsigned kMost = 64;  ///< numbers are below it
  using Set = std::uint64_t;             ///< of numbers

  explicit LinkNumbers(std::size_t vertex_count) : met_(vertex_count) {}

  /// Numbers the vertices of one link. To be a local variable, whose members the compiler keeps in registers.
  class Numbering {
   public:
    Numbering(LinkNumbers& numbers, Index centre)
        : met_(numbers.met_.data()), vertices_(numbers.vertices_.data()), centre_(centre) {}

    /// The number of a vertex, which is new if `size` grows. Without a branch, since new and known vertices alternate
    /// irregularly. `size` must be less than kMost.
    unsigned operator()(Index vertex) noexcept { return of_if(true, vertex, 0); }
    /// The same if `is_wanted`; else `otherwise`, which is kMost at most.
    unsigned of_if(bool is_wanted, Index vertex, unsigned otherwise) noexcept {
      const Met met = met_[vertex];
      const bool is_new = is_wanted & (met.link_of != centre_);
      const Index number = is_new ? count_ : is_wanted ? met.number : otherwise;
      met_[vertex] = is_wanted ? Met{centre_, number} : met;
      vertices_[number] = vertex;
      count_ += is_new ? 1 : 0;
      return number;
    }
    [[nodiscard]] unsigned size() const noexcept { return count_; }

   private:
    Met* met_;
    Index* vertices_;
    Index centre_;
    unsigned count_ = 0;
  };

  /// Keeps what a numbering found.
  void keep(const Numbering& numbering) noexcept { count_ = numbering.size(); }
  [[nodiscard]] unsigned size() const noexcept { return count_; }
  [[nodiscard]] Index vertex(unsigned number) const noexcept { return vertices_[number]; }

  static constexpr Set one(unsigned number) noexcept { return Set{1} << number; }

 private:
  std::vector<Met> met_;  ///< by vertex
  unsigned count_ = 0;
  std::array<Index, kMost + 1> vertices_;  ///< by number
};

}  // namespace tegl::detail
