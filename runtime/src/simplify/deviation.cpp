// SPDX-License-Identifier: BSD-3-Clause
//
// Bound of the distance of every point of one contour from another contour, simplex by simplex: from the heights
// of the simplices of the other contour that cover the simplex, or from the distances of its corners to one simplex.
// Simplices are subdivided if the bound is too loose.
#include "tegl/deviation.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "base/periods.hpp"
#include "base/workers.hpp"
#include "mesh/measure_pieces.hpp"
#include "mesh/simplex_shapes.hpp"
#include "mesh/validate.hpp"
#include "simplify/boundary_faces.hpp"
#include "simplify/box_tree.hpp"
#include "simplify/deviation_target.hpp"
#include "simplify/facet_neighbours.hpp"
#include "simplify/flat_simplices.hpp"
#include "simplify/prism_cover.hpp"
#include "simplify/prism_walk.hpp"
#include "simplify/scaled_simplices.hpp"
#include "simplify/simplex_walk.hpp"
#include "simplify/vertex_distances.hpp"

namespace tegl {
namespace detail {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Accepted ratio of a bound to a distance that is attained; the second one is for refinement.
constexpr double kLooseness = 1.25;
constexpr double kRefinedLooseness = 1.05;
/// A bound below this fraction of the longest edge is accepted; with a given bound that is enough, also one below this
/// fraction of the largest known distance.
constexpr double kEdgeShare = 0.02;
constexpr double kLeastShare = 0.5;
/// Near simplices are searched within kSlack times the distance of the corners plus kReachShare times the longest
/// edge, then within kWider times that.
constexpr double kSlack = 1.5;
constexpr double kReachShare = 0.05;
constexpr double kWider = 4.0;
/// At distances beyond this multiple of the longest edge, bounds from distances are close enough.
constexpr double kFarAway = 2.0;
/// Relative width of the rim that is excluded if a simplex is decided without it, in longest edges. Much more than
/// rounding errors.
constexpr double kRim = 1e-11;
/// Relative width of a wider rim, and its largest fraction of the bound that is enough.
constexpr double kWideRim = 1e-6;
constexpr double kRimShare = 0.02;
/// In longest edges: much more than the narrow rim.
constexpr double kBeyond = 1e-9;
/// Flatter simplices use the normal of the nearest simplex of the other contour.
constexpr double kFlat = 1e-2;
/// Simplices with edges up to this multiple of the bound that is enough are bounded by distances of corners first, in
/// at most so many parts.
template <int N>
constexpr double kCoarse = N == 4 ? 12.0 : 6.0;
template <int N>
constexpr std::size_t kFewParts = N == 4 ? 128 : 48;
/// Maximum number of parts of a simplex. Refinement of the largest bounds: kMostRefined simplices, one more per
/// kRefinedShare simplices, and their maximum number of parts.
constexpr std::size_t kMostParts = 24;
constexpr std::size_t kMostRefined = 64;
constexpr std::size_t kRefinedShare = 4000;
constexpr std::size_t kRefinedParts = 400;
/// Maximum number of simplices that are sampled for a first estimate of the distances; edges longer than this multiple
/// of their mean longest edge are sampled at their middles.
constexpr std::size_t kMostSamples = std::size_t{1} << 16;
constexpr double kLong = 1.25;
constexpr std::size_t kGrain = 256;

void raise(double& value, double candidate) {
  std::atomic_ref<double> shared(value);
  double old = shared.load(std::memory_order_relaxed);
  while (candidate > old && !shared.compare_exchange_weak(old, candidate, std::memory_order_relaxed)) {
  }
}

/// What the measurements of several threads find besides bounds.
struct Totals {
  /// A simplex of `to`, and the distance of a part of a flat simplex of `from` that it is matched with.
  struct Match {
    double distance;
    Index from, to;
  };
  std::mutex mutex = {};
  std::uint64_t comparisons = 0;  ///< as in DeviationValues
  std::vector<Match> of_flat = {};

  void add(std::uint64_t more, const std::vector<Match>& matches) {
    const std::lock_guard lock(mutex);
    comparisons += more;
    of_flat.insert(of_flat.end(), matches.begin(), matches.end());
  }
};

/// Shared input of all measurements.
template <int N>
struct DeviationInput {
  const ScaledSimplices<N>& from;
  const ScaledSimplices<N>& to;
  const BoxTree<N>& tree;
  const BoundaryFaces<N>& open;
  const SimplexGradients<N>& gradients;  ///< of `to`
  const FacetNeighbours<N>& neighbours;  ///< of `to`
  const std::vector<NearPoint>& near;    ///< by vertex of `from`: a point of `to`, the nearest one if it matters
  double enough;                         ///< bounds below it are not refined
  std::vector<double>& of_to;            ///< empty if it is not returned
  Totals& totals;

  void raise_bound(Index simplex, double bound) const {
    if (!of_to.empty()) raise(of_to[simplex], bound);
  }
};

/// Measures simplices one by one. Use one per thread.
template <int N>
class SimplexDeviation {
 public:
  static constexpr int D = N - 1;

  explicit SimplexDeviation(const DeviationInput<N>& measure)
      : m_(measure),
        walk_(measure.to.corners, measure.neighbours),
        few_(measure.gradients, measure.neighbours, &measure.tree) {}
  ~SimplexDeviation() { m_.totals.add(comparisons_, of_flat_); }
  SimplexDeviation(const SimplexDeviation&) = delete;
  SimplexDeviation& operator=(const SimplexDeviation&) = delete;

  /// Upper bound of the distance of all points of simplex s. Raises `least` to the largest attained distance.
  double bound(Index s, double& least) {
    looseness_ = kLooseness;
    load_size(s);
    const double few = bound_by_corners();
    if (few < kInfinity) return few;
    load_frame(s);
    const double enough = std::max(m_.enough, kEdgeShare * edge_);
    const double walked = bound_by_walk(s, enough);
    if (walked < kInfinity) return walked;
    const double result = in_parts(enough, kMostParts, least);
    if (!m_.of_to.empty()) raise_matches(s);
    return result;
  }

  /// A closer bound, refined until it is at most `enough` or kRefinedParts parts are reached.
  double refined_bound(Index s, double enough) {
    load_size(s);
    load_frame(s);
    looseness_ = kRefinedLooseness;
    double least = 0.0;
    return in_parts(enough, kRefinedParts, least);
  }

 private:
  /// A simplex of `to` in the frame.
  struct NearSimplex {
    Index simplex;
    CornersN<N> at;
    double low, high;  ///< range of the last coordinate
  };
  /// The part of a near simplex inside a prism, as a range of heights.
  struct HeightRange {
    double low, high;
    Index near;
    bool open;
  };
  struct Part {
    double bound = kInfinity;
    CornersN<N> corners;              ///< in the frame
    std::vector<std::uint32_t> near;  ///< numbers in near_ of all simplices near the part
    std::vector<std::pair<Index, double>> matches;
    std::uint32_t farthest = 0;  ///< number in near_ of the match with the largest distance
    Index next = 0;              ///< a nearest simplex of `to`
    bool operator<(const Part& other) const { return bound < other.bound; }
  };

  /// Bounds the distance by those of the corners, for simplices that are not much larger than the distances that need
  /// no closer bound.
  double bound_by_corners() {
    const double rim = kRim * edge_;  // more than rounding errors
    const double limit = m_.enough - rim;
    if (!(edge_ <= kCoarse<N> * limit && nearest_ <= limit)) return kInfinity;
    const double result = few_.bound(part_, limit, kFewParts<N>) + rim;
    if (result < kInfinity)
      for (const NearPoint& match : few_.matches()) m_.raise_bound(match.simplex, match.distance + rim);
    return result;
  }

  /// Bounds the distance by the simplices of `to` that are connected with the ones nearest to the corners. Most
  /// simplices need no search for all simplices near them.
  double bound_by_walk(Index s, double enough) {
    std::array<Index, N> starts;
    for (int i = 0; i < N; ++i) starts[i] = m_.near[m_.from.simplices[s][i]].simplex;
    const double rim = kRim * edge_;
    const double rough = std::max(m_.enough, looseness_ * nearest_) - rim;
    const double limit = std::max(enough, looseness_ * nearest_) - rim;
    double result = walk_.bound(frame_, without_rim(whole_, kRim), edge_, starts, rough, limit) + rim;
    if (result <= 2.0 * rim)  // identical contours: without the rim the bound is exact up to rounding
      result = walk_.bound(frame_, whole_, edge_, starts, 0.0, 2.0 * rim);
    if (result < kInfinity) walk_.visit_matches([&](Index t, double distance) { m_.raise_bound(t, distance + rim); });
    return result;
  }

  /// Raises the bounds of the simplices that the parts are matched with; of flat simplices later, when their neighbours
  /// have bounds.
  void raise_matches(Index s) {
    const bool is_flat = FlatSimplices<N>::is_flat(m_.from.corners[s]);
    for (const Part& part : parts_)
      for (const auto& [t, distance] : part.matches) {
        if (is_flat)
          of_flat_.push_back({distance, s, t});
        else
          m_.raise_bound(t, distance);
      }
  }

  void load_size(Index s) {
    part_.corners = m_.from.corners[s];
    part_.vertices = m_.from.simplices[s];
    edge_ = std::sqrt(square_of_longest_edge<N>(part_.corners));
    nearest_ = 0.0;
    for (int i = 0; i < N; ++i) {
      const NearPoint& near = m_.near[part_.vertices[i]];
      part_.set_near(i, near);
      nearest_ = std::max(nearest_, near.distance);
    }
  }

  void load_frame(Index s) {
    const CornersN<N> corners = m_.from.corners[s];
    PointN<N> normal = normal_of<N>(corners);
    double length = norm(normal);
    if (!(shape_of_simplex<N>(corners, length) > kFlat)) {
      const PointN<N> next = normal_of<N>(m_.to.corners[m_.tree.nearest(middle_of<N>(corners)).simplex]);
      if (norm(next) > 0.0) {
        normal = next;
        length = norm(next);
      }
    }
    if (!(length > 0.0)) {
      normal = {};
      normal[0] = length = 1.0;
    }
    for (double& x : normal) x /= length;
    frame_ = Frame<N>(normal, corners[0]);
    for (int i = 0; i < N; ++i) whole_[i] = frame_.to_frame(corners[i]);
  }

  /// Whether the bound needs no refinement.
  [[nodiscard]] bool is_enough(const Part& part, double enough) const {
    return part.bound <= std::max(enough, looseness_ * nearest_);
  }

  /// Maximum bound over the parts, which remain in parts_.
  double in_parts(double enough, std::size_t most, double& least) {
    parts_.clear();
    Part whole;
    whole.corners = whole_;
    // the whole simplex, with a narrow and a wide reach
    for (const double wider : {1.0, kWider}) {
      gather_near(wider * (kSlack * nearest_ + kReachShare * edge_));
      whole.near.resize(near_.size());
      std::iota(whole.near.begin(), whole.near.end(), 0u);
      if (nearest_ > kFarAway * edge_) break;
      measure(whole, enough);
      if (is_enough(whole, enough) || whole.bound <= reach_) break;
    }
    if (!(whole.bound < kInfinity)) measure_by_distances(whole);
    parts_.push_back(std::move(whole));
    // bisect the part with the largest bound
    while (!is_enough(parts_.front(), enough) && parts_.size() < most) {
      std::pop_heap(parts_.begin(), parts_.end());
      const Part worst = std::move(parts_.back());
      parts_.pop_back();
      for (const CornersN<N>& half : halves(worst.corners)) {
        Part part = worst;  // keeps the bound of the whole until a closer one is found
        part.corners = half;
        measure(part, enough);
        parts_.push_back(std::move(part));
        std::push_heap(parts_.begin(), parts_.end());
      }
    }
    least = std::max(least, nearest_);
    return parts_.front().bound;
  }

  /// Collects the simplices within `reach` of the whole simplex along the normal.
  void gather_near(double reach) {
    reach_ = reach;
    near_.clear();
    const Prism<N> prism(whole_, edge_);
    Box<N> box;
    const auto add = [&](PointN<N> x) {
      const double level = x[D];
      for (const double away : {-reach, reach}) {
        x[D] = level + away;
        box.add(frame_.to_space(x));
      }
    };
    // box in space; of a thin simplex, of its whole box in the frame
    for (const PointN<N>& corner : whole_) add(corner);
    if (prism.thin()) {
      Box<N> whole;
      for (const PointN<N>& corner : whole_) whole.add(corner);
      for (unsigned k = 0; k < 1u << N; ++k) {
        PointN<N> x;
        for (int a = 0; a < N; ++a) x[a] = (k >> a & 1u) != 0 ? whole.high[a] : whole.low[a];
        add(x);
      }
    }
    Box<N> around;  // in the frame
    for (const PointN<N>& corner : whole_) around.add(corner);
    around.low[D] -= reach;
    around.high[D] += reach;
    // box test in the frame
    const double rounding = 10.0 * prism.rounding();
    m_.tree.visit_near(box, rounding, [&](Index t) {
      NearSimplex near;
      near.simplex = t;
      Box<N> of_near;
      const CornersN<N> corners = m_.to.corners[t];
      for (int i = 0; i < N; ++i) {
        near.at[i] = frame_.to_frame(corners[i]);
        of_near.add(near.at[i]);
      }
      near.low = of_near.low[D];
      near.high = of_near.high[D];
      if (of_near.meets(around, rounding)) near_.push_back(near);
    });
  }

  /// Bounds a part by the nearest group of height ranges that covers it, or by distances. Simplices that are not near
  /// the part are removed from its list.
  void measure(Part& part, double enough) {
    const Prism<N> prism(part.corners, edge_);
    // First without cutting: enough if each whole simplex is near enough.
    gather_ranges(prism, part, false);
    take_best_cover(prism, part, 0.0);
    if (is_enough(part, m_.enough)) return;
    // If height ranges did not bound the whole simplex, they will hardly bound its parts. Distances are cheaper, and
    // smaller for parts.
    if (!parts_.empty()) measure_by_distances(part);
    if (!parts_.empty() && is_enough(part, enough)) return;
    // Borders and walls that begin at the edge of the part do not lie above the part without a rim. A wider rim: the
    // edge may have moved by more than rounding errors, and still by much less than the bound that is enough.
    bool found = cover_without_rim(part, kRim);
    const double wide = std::min(kWideRim, kRimShare * std::max({enough, m_.enough, looseness_ * nearest_}) / edge_);
    if (wide > kRim && !is_enough(part, enough)) found = cover_without_rim(part, wide) || found;
    if (part.bound <= 2.0 * kRim * edge_) {  // identical contours: without the rim the bound is exact up to rounding
      gather_ranges(prism, part, true);
      take_best_cover(prism, part, 0.0);
    }
    if (found && !is_enough(part, enough) && !prism.thin()) probe(prism, part);
    if (parts_.empty() && !is_enough(part, enough)) measure_by_distances(part);
  }

  /// Takes the best cover of the part without a rim of this relative width. Every point of the rim is within
  /// rim * edge_ of the rest. Returns false if none improves the bound.
  bool cover_without_rim(Part& part, double rim) {
    const Prism<N> prism(without_rim(part.corners, rim), edge_);
    gather_ranges(prism, part, true);
    return take_best_cover(prism, part, rim * edge_);
  }

  static CornersN<N> without_rim(CornersN<N> corners, double rim) {
    const PointN<N> middle = middle_of<N>(corners);
    for (PointN<N>& corner : corners) corner = between(corner, middle, rim);
    return corners;
  }

  /// Collects the height ranges of the near simplices over the part: with `cut`, of their parts inside the prism; else
  /// estimated from their corners and hyperplanes.
  void gather_ranges(const Prism<N>& prism, Part& part, bool cut) {
    ranges_.clear();
    // Simplices farther away than the known bound, by more than rounding, cannot improve it.
    double lowest = kInfinity, highest = -kInfinity;
    for (const PointN<N>& corner : part.corners) {
      lowest = std::min(lowest, corner[D]);
      highest = std::max(highest, corner[D]);
    }
    const double limit = part.bound + kBeyond * edge_;
    lowest -= limit;
    highest += limit;
    // height range of each near simplex
    comparisons_ += part.near.size();
    std::size_t kept = 0;
    for (const std::uint32_t number : part.near) {
      const NearSimplex& near = near_[number];
      if (near.low > highest || near.high < lowest) continue;
      if (!clipped_.load(near.at, prism)) continue;
      const unsigned open = m_.open.of(near.simplex);
      if ((cut || open != 0) && !clipped_.clip(prism)) continue;
      auto [low, high] = clipped_.heights(prism);
      part.near[kept++] = number;
      if (!cut) {
        const auto [least, largest] = heights_of_plane<N>(near.at, part.corners, prism);
        low = std::max(low, least);
        high = std::min(high, largest);
        if (low > high) continue;
      }
      ranges_.push_back({low, high, number, open != 0 && (clipped_.facets() & open) != 0});
    }
    part.near.resize(kept);
    std::sort(ranges_.begin(), ranges_.end(), [](const HeightRange& a, const HeightRange& b) {
      return a.low != b.low ? a.low < b.low : a.near < b.near;
    });
  }

  /// Groups overlapping ranges and takes the nearest group that certainly covers the part. Returns
  /// false if none improves the bound.
  bool take_best_cover(const Prism<N>& prism, Part& part, double rim) {
    const double apart = prism.rounding() + 1e-15 * reach_;
    const double reach = reach_ - std::max(-prism.low(), prism.high());
    bool found = false;
    for (std::size_t i = 0, j = 0; i < ranges_.size(); i = j) {
      double high = ranges_[i].high;
      bool open = false;
      for (; j < ranges_.size() && ranges_[j].low <= high + apart; ++j) {
        high = std::max(high, ranges_[j].high);
        open = open || ranges_[j].open;
      }
      const double low = ranges_[i].low;
      if (!(low > -reach && high < reach)) continue;
      const double bound = std::max(high - prism.low(), prism.high() - low) + rim;
      if (!(bound < part.bound)) continue;
      const auto corners_of = [&](std::size_t k) -> const CornersN<N>& { return near_[ranges_[i + k].near].at; };
      if (open || !covers_a_point<N>(j - i, corners_of, part.corners)) continue;
      found = true;
      part.bound = bound;
      part.matches.clear();
      for (std::size_t k = i; k < j; ++k) {
        const double far = std::max(ranges_[k].high - prism.low(), prism.high() - ranges_[k].low) + rim;
        part.matches.emplace_back(near_[ranges_[k].near].simplex, far);
        if (far == bound) part.farthest = ranges_[k].near;
      }
    }
    return found;
  }

  /// Raises nearest_ to the distance of the point of the part below or above the farthest corner of its ranges.
  void probe(const Prism<N>& prism, Part& part) {
    if (!clipped_.load(near_[part.farthest].at, prism) || !clipped_.clip(prism)) return;
    const PointN<N> below = prism.at_level(clipped_.farthest(prism));
    nearest_ = std::max(nearest_, m_.tree.nearest(frame_.to_space(below), near_[part.farthest].simplex).distance);
  }

  /// Two bounds: the distance from one simplex is convex, so its maximum is at a corner; and distances are 1-Lipschitz.
  /// Takes the smaller one.
  void measure_by_distances(Part& part) {
    CornersN<N> corners;
    for (int i = 0; i < N; ++i) corners[i] = frame_.to_space(part.corners[i]);
    const PointN<N> middle = middle_of<N>(corners);
    const auto [distance, t] = m_.tree.nearest(middle, part.next);
    part.next = t;
    nearest_ = std::max(nearest_, distance);
    double radius = 0.0, farthest = 0.0;
    for (const PointN<N>& corner : corners) {
      radius = std::max(radius, norm(minus(corner, middle)));
      farthest = std::max(farthest, distance_to_simplex<N>(corner, m_.to.corners[t], N));
    }
    const double bound = std::min(distance + radius, farthest);
    if (!(bound < part.bound)) return;
    part.bound = bound;
    part.matches.assign(1, {t, bound});
  }

  /// Bisects a simplex at the middle of its longest edge.
  static std::array<CornersN<N>, 2> halves(const CornersN<N>& part) {
    const auto [first, second] = ends_of_longest_edge<N>(part);
    std::array<CornersN<N>, 2> result = {part, part};
    result[0][second] = result[1][first] = between(part[first], part[second], 0.5);
    return result;
  }

  const DeviationInput<N>& m_;
  // Current simplex.
  typename SimplexWalk<N>::Part part_{CornersN<N>{}, {}, {}, {}};
  double edge_ = 0.0;
  double looseness_ = kLooseness;
  double nearest_ = 0.0;  ///< largest known distance of one of its points
  Frame<N> frame_ = Frame<N>({1.0}, {});
  CornersN<N> whole_;
  double reach_ = 0.0;
  std::vector<NearSimplex> near_;
  std::vector<Part> parts_;
  std::uint64_t comparisons_ = 0;
  std::vector<Totals::Match> of_flat_;
  // Current part.
  std::vector<HeightRange> ranges_;
  ClippedSimplex<N> clipped_;
  PrismWalk<N> walk_;
  SimplexWalk<N> few_;
};

template <int N>
void require_scale(const std::array<double, N>& scale) {
  for (const double s : scale)
    if (!(s > 0.0 && std::isfinite(s)))
      throw Error(ErrorCode::InvalidArgument, fmt::format("a scale is {}; expected a positive number", s));
}

/// Refines the simplices with the largest bounds: a few of them determine the bound of the whole contour.
template <int N>
void refine_largest(const DeviationInput<N>& measure, Deviation& result, unsigned threads, const Progress& progress) {
  const FlatSimplices<N> flat(measure.from, measure.enough, result.of_from, threads, part_of(progress, 0.0, 0.3));
  flat.lower(result.of_from);
  std::vector<std::size_t> order(result.of_from.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::size_t most = std::min(order.size() - 1, kMostRefined + order.size() / kRefinedShare);
  const auto larger = [&](std::size_t a, std::size_t b) {
    return result.of_from[a] != result.of_from[b] ? result.of_from[a] > result.of_from[b] : a < b;
  };
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(most), order.end(), larger);
  // A bound needs no refinement below the largest bound of the other simplices.
  const double enough = std::max(result.least, order.size() > 1 ? result.of_from[order[most]] : 0.0);
  for_each_block(
      std::max<std::size_t>(most, 1), 1, threads, part_of(progress, 0.3, 1.0),
      [&] { return SimplexDeviation<N>(measure); },
      [&](std::size_t, std::size_t first, std::size_t end, SimplexDeviation<N>& one) {
        for (std::size_t i = first; i < end; ++i) {
          double& bound = result.of_from[order[i]];
          if (bound > enough) bound = std::min(bound, one.refined_bound(static_cast<Index>(order[i]), enough));
        }
      });
  flat.lower(result.of_from);
  // matches of flat simplices, whose bounds may be lower now
  for (const auto& [distance, s, t] : measure.totals.of_flat)
    result.of_to[t] = std::max(result.of_to[t], std::min(distance, result.of_from[s]));
  result.bound = *std::max_element(result.of_from.begin(), result.of_from.end());
  for (double& bound : result.of_to) bound = std::min(bound, result.bound);
}

/// The largest distance of sample points: centroids, and the middles of long edges. At least `least`.
template <int N>
double largest_of_samples(const ScaledSimplices<N>& from, const BoxTree<N>& tree, const SimplexWalk<N>& walk,
                          const std::vector<NearPoint>& near, double least, unsigned threads,
                          const Progress& progress) {
  const std::size_t step = 1 + from.simplices.size() / kMostSamples;
  const std::size_t count = from.simplices.size() / step;
  double sum = 0.0;
  for (std::size_t k = 0; k < count; ++k) sum += longest_edge<N>(from.corners[k * step]);
  const double mean = sum / static_cast<double>(std::max<std::size_t>(1, count));
  double largest = least;
  for_each_block(count, kGrain, threads, progress, [&](std::size_t, std::size_t first, std::size_t end) {
    double farthest = least;
    const auto sample = [&](const PointN<N>& p, Index guess) {
      const NearPoint found = walk.approach_nearly(p, guess);
      if (found.distance > farthest) farthest = std::max(farthest, tree.nearest(p, found.simplex).distance);
    };
    for (std::size_t k = first; k < end; ++k) {
      const CornersN<N> corners = from.corners[k * step];
      const auto start = [&](int i) { return near[from.simplices[k * step][i]].simplex; };
      sample(middle_of<N>(corners), start(0));
      for (int i = 0; i < N; ++i)
        for (int j = 0; j < i; ++j)
          if (norm(minus(corners[i], corners[j])) > kLong * mean)
            sample(between(corners[i], corners[j], 0.5), start(i));
    }
    raise(largest, farthest);
  });
  return largest;
}

/// Blocks of kGrain simplices are measured in rounds: every 64th one first, then those half way between the earlier
/// ones. The last round has half of all blocks. Small contours have fewer rounds, so that all threads have work.
constexpr int kMostMeasuredRounds = 7;
constexpr std::size_t kLeastBlocks = 32;

/// By the size of the contour alone: bounds do not depend on the number of threads.
int measured_rounds(std::size_t simplices) {
  int rounds = 1;
  while (rounds < kMostMeasuredRounds && block_count(simplices, kGrain) >> rounds >= kLeastBlocks) ++rounds;
  return rounds;
}

/// Measures the simplices of one round of `rounds`, and raises result.least to the largest attained distance.
template <int N>
void measure_round(const DeviationInput<N>& measure, int round, int rounds, unsigned threads, const Progress& progress,
                   Deviation& result) {
  const std::size_t most = std::size_t{1} << (rounds - 1);
  const std::size_t size = measure.from.simplices.size(), blocks = block_count(size, kGrain);
  const std::size_t begin = round == 0 ? 0 : most >> round, apart = round == 0 ? most : 2 * begin;
  if (begin >= blocks) return;
  for_each_block((blocks - begin + apart - 1) / apart, 1, threads, progress,
                 [&] { return SimplexDeviation<N>(measure); },
                 [&](std::size_t number, std::size_t, std::size_t, SimplexDeviation<N>& one) {
                   const std::size_t first = (begin + number * apart) * kGrain, end = std::min(size, first + kGrain);
                   double reached = 0.0;
                   for (std::size_t s = first; s < end; ++s)
                     result.of_from[s] = one.bound(static_cast<Index>(s), reached);
                   raise(result.least, reached);
                 });
}

template <int N>
void measure_all(const ScaledSimplices<N>& from, const DeviationTarget<N>& target, double enough, unsigned threads,
                 const Progress& progress, std::uint64_t* comparisons, Deviation& result) {
  const auto& [to, neighbours, open, tree, gradients] = target;
  // distances of vertices: exactly where they are needed
  const SimplexWalk<N> walk(gradients, neighbours);
  VertexDistances<N> vertices(from.simplices, from.points, tree, walk, threads);
  vertices.approach(part_of(progress, 0.0, 0.05));
  result.least = vertices.find_largest(part_of(progress, 0.05, 0.08));
  result.least =
      largest_of_samples(from, tree, walk, vertices.near(), result.least, threads, part_of(progress, 0.08, 0.12));
  const auto sufficient = [&] { return enough > 0.0 ? std::max(enough, kLeastShare * result.least) : result.least; };
  vertices.search_above(sufficient() / kLooseness, part_of(progress, 0.12, 0.15));
  Totals totals;
  DeviationInput<N> measure{from,         to,           tree,  open, gradients, neighbours, vertices.near(),
                            sufficient(), result.of_to, totals};
  const Progress whole = part_of(progress, 0.15, 0.9);
  // The first rounds are small samples. They find larger distances, so that later ones need fewer close bounds.
  double done = 0.0;
  const int rounds = measured_rounds(from.simplices.size());
  for (int round = 0; round < rounds; ++round) {
    const double end = std::ldexp(1.0, round + 1 - rounds);
    measure.enough = sufficient();
    measure_round(measure, round, rounds, threads, part_of(whole, done, end), result);
    done = end;
  }
  refine_largest(measure, result, threads, part_of(progress, 0.9, 1.0));
  if (comparisons != nullptr) *comparisons += totals.comparisons;
}

}  // namespace

template <int N>
Deviation deviation_to(const ScaledSimplices<N>& from, const DeviationTarget<N>& to, double enough,
                       const DeviationValues& values, const WorkOptions& work) {
  Deviation result;
  result.of_from.assign(from.simplices.size(), 0.0);
  if (values.of_to) result.of_to.assign(to.contour.simplices.size(), 0.0);
  measure_all(from, to, enough, work.threads, work.progress, values.comparisons, result);
  result.of_from = values.of_from ? from.in_order_of_contour(result.of_from) : std::vector<double>();
  if (values.of_to) result.of_to = to.contour.in_order_of_contour(result.of_to);
  return result;
}

template Deviation deviation_to(const ScaledSimplices<2>&, const DeviationTarget<2>&, double, const DeviationValues&,
                                const WorkOptions&);
template Deviation deviation_to(const ScaledSimplices<3>&, const DeviationTarget<3>&, double, const DeviationValues&,
                                const WorkOptions&);
template Deviation deviation_to(const ScaledSimplices<4>&, const DeviationTarget<4>&, double, const DeviationValues&,
                                const WorkOptions&);

}  // namespace detail

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4> Deviation deviation(const Contour<N, Real>& from, const Contour<N, Real>& to,
                                                       const DeviationOptions<N>& options) {
  using namespace detail;
  detail::require_unwrapped(from, "deviation");
  detail::require_unwrapped(to, "deviation");
  require_scale<N>(options.scale);
  if (!(options.enough >= 0.0))
    throw Error(ErrorCode::InvalidArgument, fmt::format("enough is {}; expected 0 or more", options.enough));
  for (const auto* contour : {&from, &to}) {
    require_vertices(*contour);
    require_finite(*contour);
  }
  if (from.simplices.empty() || to.simplices.empty()) {
    const double far = from.simplices.empty() ? 0.0 : kInfinity;
    return {far, far, std::vector<double>(from.simplices.size(), far), std::vector<double>(to.simplices.size(), 0.0)};
  }
  const ScaledSimplices<N> scaled_from(from, options.scale), scaled_to(to, options.scale);
  const DeviationTarget<N> target(scaled_to, options.work.threads, part_of(options.work.progress, 0.0, 0.1));
  return deviation_to(scaled_from, target, options.enough, {},
                      {options.work.threads, part_of(options.work.progress, 0.1, 1.0)});
}

#define TEGL_INSTANTIATE_CONTOURS(N, Real) \
  template Deviation deviation(const Contour<N, Real>&, const Contour<N, Real>&, const DeviationOptions<N>&);
#include "base/instantiate.hpp"

}  // namespace tegl
