// SPDX-License-Identifier: BSD-3-Clause
//
// Scrubber: an interval tree of the heights of simplices, for many cuts by parallel hyperplanes.
//
// Places. Heights above the lowest one are rounded to float. The bits of a nonnegative float, read as an integer, have
// the same order: this integer is the place. Rounding preserves order (not strictly), so a simplex that touches a
// hyperplane has the place of the hyperplane in its range of places. The few other simplices with that place are
// excluded by their vertices.
//
// Nodes. The tree is the binary tree over all 2^32 places; only nodes with simplices are stored. A range of places [a,
// b] belongs to the node that separates a from b: the common leading bits of a and b, then 1, then zeros. This number m
// satisfies a < m <= b and identifies the node; its lowest 1 bit determines the depth. A range of one place a belongs
// to the node with m = a. So all ranges at a node contain m, and those that contain a place p < m are those with a <=
// p: a prefix of the node's list sorted by a. The same holds for b if p >= m. The ranges that contain p belong to the
// at most 33 nodes on the path of the bits of p.
#include "tegl/scrubber.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/periods.hpp"
#include "base/progress.hpp"
#include "base/radix_sort.hpp"
#include "base/workers.hpp"
#include "cut/closed_cut.hpp"
#include "mesh/validate.hpp"

namespace tegl {
namespace {

constexpr unsigned kPlaceBits = 32;

/// The node of the places from a to b.
std::uint32_t middle_of(std::uint32_t a, std::uint32_t b) noexcept {
  if (a == b) return a;
  const unsigned bit = static_cast<unsigned>(std::bit_width(a ^ b)) - 1;
  return b >> bit << bit;
}

/// A simplex and its range of places.
struct Range {
  std::uint32_t least;
  std::uint32_t most;
  Index simplex;
};

/// Sorts by node; within a node by the lower ends, ascending, or by the upper ends, descending (`by_upper`). Stable
/// radix sorts: by one end, then by node.
void sort_by_node(std::vector<Range>& ranges, bool by_upper, unsigned threads) {
  detail::sort_by_bits(
      ranges, kPlaceBits, [=](const Range& range) { return by_upper ? ~range.most : range.least; }, threads);
  detail::sort_by_bits(
      ranges, kPlaceBits, [](const Range& range) { return middle_of(range.least, range.most); }, threads);
}

/// Sorts numbers below `count`.
void sort_numbers(std::vector<Index>& numbers, std::size_t count) {
  detail::sort_by_bits(numbers, static_cast<unsigned>(std::bit_width(count)), [](Index number) { return number; });
}

constexpr const char* kCancelledScrubber = "building a scrubber was cancelled";

/// The lowest and the highest vertex. Throws InvalidArgument if a height is not finite.
template <int N, class Real>
std::pair<double, double> height_range(const Contour<N, Real>& contour, const detail::HyperplaneFamily<N>& family) {
  double highest = -std::numeric_limits<double>::infinity();
  double lowest = -highest;
  for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
    const double height = family.height(contour.vertices[v]);
    if (!std::isfinite(height))
      throw Error(ErrorCode::InvalidArgument, fmt::format("vertex {} at height {}; expected a finite one", v, height));
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
  }
  return {lowest, highest};
}

/// The range of places of each simplex. `place_of`: the place of a vertex.
template <int N, class Real, class PlaceOf>
std::vector<Range> place_ranges(const Contour<N, Real>& contour, unsigned threads, const PlaceOf& place_of) {
  struct Nothing {};
  detail::Workers<Nothing> workers(threads, [] { return Nothing(); });
  constexpr std::size_t kGrain = std::size_t{1} << 14;
  std::vector<Range> ranges(contour.simplices.size());
  workers.for_range(ranges.size(), kGrain, [&](std::size_t from, std::size_t to, Nothing&) {
    for (std::size_t s = from; s < to; ++s) {
      std::uint32_t least = ~std::uint32_t{0};
      std::uint32_t most = 0;
      for (const Index v : contour.simplices[s]) {
        const std::uint32_t here = place_of(v);
        least = std::min(least, here);
        most = std::max(most, here);
      }
      ranges[s] = {least, most, static_cast<Index>(s)};
    }
  });
  return ranges;
}

}  // namespace

template <int N, Coordinate Real>
requires DimensionBetween<N, 3, 5> Scrubber<N, Real>::Scrubber(const Contour<N, Real>& contour,
                                                               const Hyperplane<N>& hyperplane, const WorkOptions& work)
    : contour_(&contour), normal_(hyperplane.normal) {
  const detail::HyperplaneFamily<N> family(normal_);
  (void)family.template level<Real>(hyperplane.offset);  // throws if it is not finite
  detail::require_unwrapped(contour, "Scrubber");
  detail::require_sound(contour);
  detail::tell(work.progress, 0.0, kCancelledScrubber);
  if (contour.simplices.empty()) {
    nodes_.push_back({0, 0});
    return;
  }
  const auto [lowest, highest] = height_range(contour, family);
  lowest_ = lowest;
  range_ = {lowest * family.unit(), highest * family.unit()};
  std::vector<Range> ranges =
      place_ranges(contour, work.threads, [&](Index v) { return place(family.height(contour.vertices[v])); });
  const auto gather = [&](std::vector<Entry>& entries, double fraction, bool by_upper) {
    detail::tell(work.progress, fraction, kCancelledScrubber);
    sort_by_node(ranges, by_upper, work.threads);
    entries.resize(ranges.size());
    detail::for_each_item(entries.size(), work.threads, {}, [&](std::size_t i) {
      entries[i] = {by_upper ? ranges[i].most : ranges[i].least, ranges[i].simplex};
    });
  };
  gather(by_least_, 0.1, false);
  gather(by_most_, 0.5, true);
  // nodes: runs of equal middle
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const std::uint32_t middle = middle_of(ranges[i].least, ranges[i].most);
    if (nodes_.empty() || nodes_.back().middle != middle) nodes_.push_back({middle, i});
  }
  nodes_.push_back({0, ranges.size()});
  nodes_.shrink_to_fit();
  detail::tell(work.progress, 1.0, kCancelledScrubber);
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 3, 5> std::uint32_t Scrubber<N, Real>::place(double height)
const noexcept { return std::bit_cast<std::uint32_t>(static_cast<float>(std::max(0.0, height - lowest_))); }

/// Appends the simplices of a node whose ranges contain the place `at`.
template <int N, Coordinate Real>
requires DimensionBetween<N, 3, 5>
void Scrubber<N, Real>::visit(std::uint32_t middle, std::uint32_t at, std::vector<Index>& found) const {
  const auto node = std::lower_bound(nodes_.begin(), nodes_.end() - 1, middle,
                                     [](const Node& n, std::uint32_t m) { return n.middle < m; });
  if (node == nodes_.end() - 1 || node->middle != middle) return;
  const auto first = static_cast<std::ptrdiff_t>(node->first);
  const auto end = static_cast<std::ptrdiff_t>((node + 1)->first);
  const bool below = at < middle;
  const std::vector<Entry>& entries = below ? by_least_ : by_most_;
  for (std::ptrdiff_t i = first; i < end; ++i) {
    const Entry& entry = entries[static_cast<std::size_t>(i)];
    if (below ? entry.end > at : entry.end < at) return;
    found.push_back(entry.simplex);
  }
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 3, 5> std::vector<Index> Scrubber<N, Real>::touching(double offset)
const {
  const detail::HyperplaneFamily<N> family(normal_);
  const double level = family.template level<Real>(offset);
  std::vector<Index> found;
  if (contour_->simplices.empty() || level < lowest_) return found;
  const std::uint32_t at = place(level);
  for (unsigned bit = kPlaceBits; bit-- > 0;) {
    const std::uint32_t middle = at >> bit >> 1 << 1 << bit | std::uint32_t{1} << bit;
    visit(middle, at, found);
  }
  visit(0, at, found);
  std::erase_if(found, [&](Index s) {
    bool reaches_down = false;
    bool reaches_up = false;
    for (const Index v : contour_->simplices[s]) {
      const double height = family.height(contour_->vertices[v]);
      reaches_down = reaches_down || height <= level;
      reaches_up = reaches_up || height >= level;
    }
    return !reaches_down || !reaches_up;
  });
  sort_numbers(found, contour_->simplices.size());
  return found;
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 3, 5> Contour<N - 1, Real> Scrubber<N, Real>::cut(double offset)
const {
  const detail::HyperplaneFamily<N> family(normal_);
  return detail::cut_simplices(*contour_, family, family.template level<Real>(offset), touching(offset));
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 3, 5> std::size_t Scrubber<N, Real>::memory()
const noexcept {
  return nodes_.capacity() * sizeof(Node) + (by_least_.capacity() + by_most_.capacity()) * sizeof(Entry);
}

template class Scrubber<3, float>;
template class Scrubber<3, double>;
template class Scrubber<4, float>;
template class Scrubber<4, double>;
template class Scrubber<5, float>;
template class Scrubber<5, double>;

}  // namespace tegl
