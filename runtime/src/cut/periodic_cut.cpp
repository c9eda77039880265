// SPDX-License-Identifier: BSD-3-Clause
#include "cut/periodic_cut.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/atomic_minimum.hpp"
#include "base/periods.hpp"
#include "base/workers.hpp"

namespace tegl::detail {
namespace {

template <int N, class Real>
class Mover {
 public:
  Mover(const Contour<N, Real>& contour, const HyperplaneFamily<N>& family, const CrossedPeriods<N>& crossed,
        std::span<const double> levels, const WorkOptions& work)
      : contour_(contour), family_(family), crossed_(crossed), levels_(levels), work_(work) {
    for (std::size_t p = 0; p < contour.periods.size(); ++p)
      if (crossed.times[p] != 0.0) counted_.push_back({contour.periods[p], crossed.times[p]});
    shares_.resize(contour.vertices.size() * counted_.size());
  }

  Contour<N, Real> run() {
    require_near();
    find_shares();
    find_simplices();
    number_vertices();
    Contour<N, Real> result = moved();
    result.periods = crossed_.within;
    return result;
  }

 private:
  using Vertex = typename Contour<N, Real>::Vertex;
  using Key = std::uint64_t;  ///< a vertex and how many periods it moves, in this order
  struct Found {
    Index simplex;
    std::array<Key, N> corners;
  };

  static constexpr std::int64_t kZero = std::int64_t{1} << 31;  ///< the lower half of the key of a vertex that stays
  static constexpr double kLongest = 128;  ///< periods that a simplex reaches over, to bound the work for it
  static constexpr std::size_t kBlock = std::size_t{1} << 14;  ///< simplices of a part of the work

  static Key key_of(Index vertex, std::int64_t times) { return Key{vertex} << 32 | static_cast<Key>(times + kZero); }
  static Index vertex_of(Key key) { return static_cast<Index>(key >> 32); }
  static double times_of(Key key) { return static_cast<double>(static_cast<std::int64_t>(key & 0xffffffffu) - kZero); }
  /// A vertex that is moved.
  [[nodiscard]] Vertex moved_vertex(Index v, double times) const {
    Vertex x = contour_.vertices[v];
    if (times == 0.0) return x;
    for (int a = 0; a < N; ++a) x[a] = static_cast<Real>(static_cast<double>(x[a]) + times * crossed_.across.vector[a]);
    return x;
  }

  /// The height of a vertex that is moved.
  [[nodiscard]] double height_at(Index v, double times) const {
    if (times == 0.0) return family_.height(contour_.vertices[v]);
    if (!family_.is_across_axis()) return family_.height(moved_vertex(v, times));
    const int a = family_.dropped_axis();
    const double x = static_cast<double>(contour_.vertices[v][a]) + times * crossed_.across.vector[a];
    return family_.sign() * static_cast<double>(static_cast<Real>(x));
  }

  /// Throws InvalidArgument if vertices are so far from the period that moves would have no keys.
  void require_near() const {
    const auto is_far = [&](std::size_t v) {
      return !is_near_period(crossed_, family_.height(contour_.vertices[v]));
    };
    std::atomic<bool> are_near = true;
    for_each_item(contour_.vertices.size(), work_.threads, {}, [&](std::size_t v) {
      if (is_far(v)) are_near = false;
    });
    if (are_near) return;
    for (std::size_t v = 0; v < contour_.vertices.size(); ++v)
      if (is_far(v))
        fail_far(family_, crossed_, contour_.axis_names, fmt::format("vertex {}", v),
                 family_.height(contour_.vertices[v]));
  }

  /// By the dual vectors, as those of `unroll`: heights also differ by the steps of axes that are not periodic.
  void find_shares() {
    const std::size_t count = counted_.size();
    for_each_item(contour_.vertices.size(), work_.threads, {}, [&](std::size_t v) {
      const std::array<double, N> x = widened_point<N>(contour_.vertices[v]);
      for (std::size_t i = 0; i < count; ++i) shares_[v * count + i] = share_of(counted_[i].period, x);
    });
  }

  void find_simplices() {
    const std::size_t count = contour_.simplices.size();
    std::vector<std::vector<Found>> parts(block_count(count, kBlock));
    std::atomic<bool> are_short = true;
    std::atomic<std::size_t> too_long{count};
    for_each_block(count, kBlock, work_.threads, work_.progress,
                   [&](std::size_t block, std::size_t from, std::size_t to) {
                     for (std::size_t s = from; s < to; ++s) {
                       const Fit fit = find_moves(s, parts[block]);
                       if (fit == Fit::too_long) lower_to(too_long, s);
                       if (fit == Fit::half_of_sum) are_short = false;
                     }
                   });
    if (too_long < count)
      throw Error(
          ErrorCode::InvalidArgument,
          fmt::format("slice of a wrapped contour across a period, with simplex {} over more than {} periods of the "
                      "slices; expected shorter ones, or an unrolled contour",
                      too_long.load(), kLongest));
    if (!are_short)
      throw Error(
          ErrorCode::InvalidArgument,
          "slice of a wrapped contour along a sum of its periods, with simplices of half of it or more; expected "
          "shorter ones, or an unrolled contour");
    for (const std::vector<Found>& part : parts) found_.insert(found_.end(), part.begin(), part.end());
  }

  /// How many times the period across is between the places of two vertices next to each other.
  [[nodiscard]] double times_apart(Index from, Index v) const {
    double times = 0.0;
    const std::size_t count = counted_.size();
    for (std::size_t i = 0; i < count; ++i)
      times += counted_[i].times * std::round(shares_[from * count + i] - shares_[v * count + i]);
    return times;
  }

  /// Whether the corners of a simplex differ by less than half of each period of the result.
  [[nodiscard]] bool is_short(std::size_t s) const {
    const auto& simplex = contour_.simplices[s];
    std::array<std::array<double, N>, N> corners;
    for (int j = 0; j < N; ++j) {
      corners[j] = widened_point<N>(contour_.vertices[simplex[j]]);
      move_near<N>(contour_.periods, corners[0], corners[j]);
    }
    for (const Period<N>& period : crossed_.within) {
      double least = std::numeric_limits<double>::infinity(), most = -least;
      for (const auto& corner : corners) {
        const double share = share_of(period, corner);
        least = std::min(least, share);
        most = std::max(most, share);
      }
      if (!(most - least < 0.5)) return false;
    }
    return true;
  }

  enum class Fit : unsigned char { fits, too_long, half_of_sum };

  /// Appends the simplex once for each multiple of the period by which it touches a level. Returns whether it fits, or
  /// is over more than kLongest periods, or over half of a sum of periods.
  [[nodiscard]] Fit find_moves(std::size_t s, std::vector<Found>& found) const {
    const auto& simplex = contour_.simplices[s];
    std::array<double, N> apart;  // by corner: the periods to the place next to corner 0
    const auto range_at = [&](double times) {
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (int j = 0; j < N; ++j) {
        const double height = height_at(simplex[j], times + apart[j]);
        low = std::min(low, height);
        high = std::max(high, height);
      }
      return std::pair(low, high);
    };
    for (int j = 0; j < N; ++j) apart[j] = times_apart(simplex[0], simplex[j]);
    const auto [lowest, highest] = range_at(0.0);
    const double along = crossed_.height;
    if (!(highest - lowest <= kLongest * std::abs(along))) return Fit::too_long;
    const auto [from, to] = std::minmax({(levels_.front() - highest) / along, (levels_.front() - lowest) / along,
                                         (levels_.back() - highest) / along, (levels_.back() - lowest) / along});
    // a bit more at both ends, as moved coordinates are rounded: one period if the hyperplanes are oblique
    const double largest =
        std::max({std::abs(lowest), std::abs(highest), std::abs(levels_.front()), std::abs(levels_.back())});
    constexpr double kCoordinates = 16 * static_cast<double>(std::numeric_limits<Real>::epsilon());
    const double more = family_.is_across_axis() ? kCoordinates * largest / std::abs(along) : 1.0;
    const std::size_t before = found.size();
    for (double times = std::ceil(from - more), last = std::floor(to + more); times <= last; ++times) {
      const auto [low, high] = range_at(times);
      const auto level = std::lower_bound(levels_.begin(), levels_.end(), low);
      if (level == levels_.end() || *level > high) continue;
      Found& one = found.emplace_back(Found{static_cast<Index>(s), {}});
      for (int j = 0; j < N; ++j) one.corners[j] = key_of(simplex[j], static_cast<std::int64_t>(times + apart[j]));
    }
    return !crossed_.is_other || found.size() == before || is_short(s) ? Fit::fits : Fit::half_of_sum;
  }

  void number_vertices() {
    keys_.reserve(found_.size() * N);
    for (const Found& one : found_) keys_.insert(keys_.end(), one.corners.begin(), one.corners.end());
    std::sort(keys_.begin(), keys_.end());
    keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
    constexpr std::size_t kMost = std::numeric_limits<Index>::max();
    if (keys_.size() > kMost || found_.size() > kMost)
      throw Error(ErrorCode::TooLarge,
                  fmt::format("{} simplices beside slices across a period; expected at most {}", found_.size(), kMost));
  }

  [[nodiscard]] Contour<N, Real> moved() const {
    Contour<N, Real> result;
    result.axis_names = contour_.axis_names;
    result.axis_units = contour_.axis_units;
    result.direction = contour_.direction;
    result.vertices.resize(keys_.size());
    result.simplices.resize(found_.size());
    for_each_item(keys_.size(), work_.threads, {},
                  [&](std::size_t i) { result.vertices[i] = moved_vertex(vertex_of(keys_[i]), times_of(keys_[i])); });
    for_each_item(found_.size(), work_.threads, {}, [&](std::size_t i) {
      for (int j = 0; j < N; ++j)
        result.simplices[i][j] =
            static_cast<Index>(std::lower_bound(keys_.begin(), keys_.end(), found_[i].corners[j]) - keys_.begin());
    });
    if (!contour_.normals.empty())
      for (const Key key : keys_) result.normals.push_back(contour_.normals[vertex_of(key)]);
    const auto rows = [](const std::vector<Attribute>& attributes, const auto& items, const auto& row_of) {
      std::vector<Attribute> copies;
      for (const Attribute& attribute : attributes) {
        Attribute& copy = copies.emplace_back(Attribute{attribute.name, attribute.unit, attribute.width, {}});
        const auto width = static_cast<std::size_t>(attribute.width);
        for (const auto& item : items) {
          const double* const row = attribute.values.data() + row_of(item) * width;
          copy.values.insert(copy.values.end(), row, row + width);
        }
      }
      return copies;
    };
    result.vertex_attributes = rows(contour_.vertex_attributes, keys_, [](Key key) { return vertex_of(key); });
    result.simplex_attributes =
        rows(contour_.simplex_attributes, found_, [](const Found& one) { return std::size_t{one.simplex}; });
    return result;
  }

  /// A period of the contour that the hyperplanes cross.
  struct Counted {
    Period<N> period;
    double times;  ///< how many times `crossed_.across` is in it
  };

  const Contour<N, Real>& contour_;
  const HyperplaneFamily<N>& family_;
  const CrossedPeriods<N>& crossed_;
  const std::span<const double> levels_;
  const WorkOptions& work_;
  std::vector<Counted> counted_;
  Buffer<double> shares_;  ///< of each vertex, by counted_
  std::vector<Found> found_;
  std::vector<Key> keys_;  ///< of the vertices of the result, ascending
};

}  // namespace

template <int N, class Real>
void move_within(Contour<N - 1, Real>& cut, const HyperplaneFamily<N>& family, const CrossedPeriods<N>& crossed,
                 double times, unsigned threads) {
  if (times == 0.0) return;
  // by whole and partial periods of the cut, so that rounding of the vector does not grow with the distance
  const std::array<double, N - 1> along = family.within(crossed.across.vector);
  std::array<double, N - 1> way{};
  for (const Period<N - 1>& period : cut.periods)
    add_times(period, std::remainder(times * share_of(period, along), 1.0), way);
  for_each_item(cut.vertices.size(), threads, {}, [&](std::size_t v) {
    std::array<double, N - 1> x = widened_point<N - 1>(cut.vertices[v]);
    for (int a = 0; a < N - 1; ++a) x[a] += way[a];
    move_inside<N - 1, Real>(cut.periods, x);
    for (int a = 0; a < N - 1; ++a) cut.vertices[v][a] = static_cast<Real>(x[a]);
  });
}

template <int N, class Real>
Contour<N, Real> moved_to_levels(const Contour<N, Real>& contour, const HyperplaneFamily<N>& family,
                                 const CrossedPeriods<N>& crossed, std::span<const double> levels,
                                 const WorkOptions& work) {
  return Mover<N, Real>(contour, family, crossed, levels, work).run();
}

#define TEGL_INSTANTIATE_MOVED(N, Real)                                                          \
  template void move_within(Contour<N - 1, Real>&, const HyperplaneFamily<N>&,                   \
                            const CrossedPeriods<N>&, double, unsigned);                         \
  template Contour<N, Real> moved_to_levels(const Contour<N, Real>&, const HyperplaneFamily<N>&, \
                                            const CrossedPeriods<N>&, std::span<const double>, const WorkOptions&);
TEGL_INSTANTIATE_MOVED(3, float)
TEGL_INSTANTIATE_MOVED(3, double)
TEGL_INSTANTIATE_MOVED(4, float)
TEGL_INSTANTIATE_MOVED(4, double)
TEGL_INSTANTIATE_MOVED(5, float)
TEGL_INSTANTIATE_MOVED(5, double)
#undef TEGL_INSTANTIATE_MOVED

}  // namespace tegl::detail
