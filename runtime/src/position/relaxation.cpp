// SPDX-License-Identifier: BSD-3-Clause
//
// Relaxed positions: lines fitted to digital straight segments, then a smoothing that keeps lines and, to first order,
// curvature.
#include "position/relaxation.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "base/progress.hpp"
#include "base/workers.hpp"
#include "position/chords.hpp"
#include "position/curve_lines.hpp"

namespace tegl::detail {

namespace {

/// Factors of the smoothing: the second one takes back what the first one does to long waves.
constexpr float kTowards = 0.62f, kAway = -0.74f;

/// The range of positions.
struct Limits {
  float low, high;
  [[nodiscard]] float clamped(float place) const noexcept { return std::clamp(place, low, high); }
};

/// Fits lines to the curves of the net in the planes along two axes.
template <int N>
class PlaneCurves {
 public:
  using Net = ContourNet<N>;
  using Number = typename Net::Number;
  using Side = typename Net::Side;

  /// `weight`: of all fits in these planes. `fits`: by curve and point, the sum of weighted positions and their weight;
  /// must be 0.
  PlaneCurves(const Net& net, const std::array<int, 2>& axes, float weight, float* fits)
      : net_(net), axes_(axes), weight_(weight), fits_(fits) {}

  void fit_all() {
    if (weight_ == 0) return;
    const CriticalEdges<N>& edges = net_.edges();
    // open curves from their ends, then closed ones
    for (const bool closed : {false, true})
      for (int j = 0; j < 2; ++j) {
        const int c = Net::curve_of(axes_[j], axes_[1 - j]);
        for (Number p = edges.first(axes_[j]); p < edges.first(axes_[j] + 1); ++p) {
          if (weight_at(p, c) != 0) continue;
          if (closed)
            follow(p, j, 1, true);
          else if (net_.link(p, c, 0).side() == Side::none)
            follow(p, j, 1, false);
          else if (net_.link(p, c, 1).side() == Side::none)
            follow(p, j, 0, false);
        }
      }
  }

 private:
  [[nodiscard]] float weight_at(Number p, int c) const noexcept { return fits_[2 * net_.place(p, c) + 1]; }

  /// Lists a curve from a point on an edge along axes_[j], leaving it on `side`, and fits it.
  void follow(Number start, int j, int side, bool closed) {
    const std::array<std::size_t, 2> curves = {net_.place(0, Net::curve_of(axes_[0], axes_[1])),
                                               net_.place(0, Net::curve_of(axes_[1], axes_[0]))};
    fits_of_.clear();
    lines_.clear();
    // Without branches that depend on the shape of the curve, which are hard to predict.
    auto of_axis = static_cast<unsigned>(j), to = static_cast<unsigned>(side);
    Number p = start;
    do {
      const std::size_t at = curves[of_axis] + p;
      fits_of_.push_back(at);
      __builtin_prefetch(fits_ + 2 * at, 1);
      // The next cache lines are for a curve in the next plane, whose following waits for one link after the other.
      __builtin_prefetch(net_.link_bits() + 2 * at + 16);
      __builtin_prefetch(fits_ + 2 * at + 16, 1);
      // The curve crosses the edge along the other axis.
      lines_.push_back(static_cast<GridStep>(2 - 2 * to + 1 - of_axis));
      const auto link = net_.link(at, to);
      if (link.side() == Side::none) break;
      p = link.point();
      // A square with the edge at its lower end lies above that edge, and is left on the other side.
      const auto beside = static_cast<unsigned>(link.side());
      of_axis ^= (beside + 1) >> 1;
      to = beside == 0 ? to : beside - 1;
    } while (!closed || p != start);
    lines_.fit(closed, weight_);
    for (std::size_t i = 0; i < fits_of_.size(); ++i) {
      const LineFit fit = lines_[i];
      fits_[2 * fits_of_[i]] = fit.sum;
      fits_[2 * fits_of_[i] + 1] = fit.weight;
    }
  }

  const Net& net_;
  std::array<int, 2> axes_;
  float weight_;
  float* fits_;
  std::vector<std::size_t> fits_of_;  ///< by step: place of its fit
  CurveLines lines_;
};

/// Positions from fits: their mean, each weighted by its precision; the middle if there are none.
template <int N>
void take_fits(const float* fits, const Limits& limits, unsigned threads, Buffer<float>& places) {
  constexpr std::size_t kCurves = ContourNet<N>::kCurves;
  for_each_part(places.size(), threads, {}, [&](std::size_t from, std::size_t end) {
    for (std::size_t p = from; p < end; ++p) {
      float sum = 0, weight = 0;
      for (std::size_t c = 0; c < kCurves; ++c) {
        sum += fits[2 * (c * places.size() + p)];
        weight += fits[2 * (c * places.size() + p) + 1];
      }
      places[p] = weight > 0 ? limits.clamped(sum / weight) : 0.5f;
    }
  });
}

/// Moves all points towards the chords of their curves, or away from them if `factor` is negative.
template <int N>
void smooth(const ContourNet<N>& net, const float* places, float factor, const Limits& limits, float last_axis_weight,
            const WorkOptions& work, float* next) {
  const CriticalEdges<N>& edges = net.edges();
  for_each_part(net.size(), work.threads, work.progress, [&](std::size_t from, std::size_t end) {
    for (int axis = 0; axis < N; ++axis) {
      std::array<float, ContourNet<N>::kCurves> weights;
      for (int c = 0; c < ContourNet<N>::kCurves; ++c)
        weights[c] = axis == N - 1 || ContourNet<N>::other_axis(axis, c) == N - 1 ? last_axis_weight : 1.0f;
      const std::size_t first = std::max<std::size_t>(from, edges.first(axis));
      const std::size_t last = std::min<std::size_t>(end, edges.first(axis + 1));
      const ChordMoves moves{net.link_bits(), net.size(), ContourNet<N>::kCurves, weights.data(), factor,
                             limits.low,      limits.high};
      if (first < last) move_to_chords(moves, places, first, last, next);
    }
  });
}

}  // namespace

template <int N>
Buffer<float> relaxed_positions(const ContourNet<N>& net, const RelaxationOptions& options) {
  constexpr double kFitShare = 0.5;
  const Limits limits{static_cast<float>(options.margin), static_cast<float>(1.0 - options.margin)};
  const auto last_axis_weight = static_cast<float>(options.last_axis_weight);
  const unsigned threads = options.work.threads;
  Buffer<float> places(net.size());
  Buffer<float> fits(2 * std::size_t{net.size()} * ContourNet<N>::kCurves);
  // lines, by planes in parallel
  std::fill(fits.begin(), fits.end(), 0.0f);
  std::vector<std::array<int, 2>> planes;
  for (int a = 0; a < N; ++a)
    for (int b = a + 1; b < N; ++b) planes.push_back({a, b});
  for_each_item(planes.size(), threads, part_of(options.work.progress, 0.0, kFitShare), [&](std::size_t i) {
    const float weight = planes[i][1] == N - 1 ? last_axis_weight : 1.0f;
    PlaneCurves<N>(net, planes[i], weight, fits.data()).fit_all();
  });
  take_fits<N>(fits.data(), limits, threads, places);
  // smoothing, in two passes a round: from `places` to the memory of the fits, and back
  const int passes = 2 * options.rounds;
  float* from = places.data();
  float* to = fits.data();
  for (int pass = 0; pass < passes; ++pass) {
    const auto share = [&](int i) { return kFitShare + (1.0 - kFitShare) * i / passes; };
    smooth(net, from, pass % 2 == 0 ? kTowards : kAway, limits, last_axis_weight,
           {threads, part_of(options.work.progress, share(pass), share(pass + 1))}, to);
    std::swap(from, to);
  }
  return places;
}

template Buffer<float> relaxed_positions<2>(const ContourNet<2>&, const RelaxationOptions&);
template Buffer<float> relaxed_positions<3>(const ContourNet<3>&, const RelaxationOptions&);
template Buffer<float> relaxed_positions<4>(const ContourNet<4>&, const RelaxationOptions&);
template Buffer<float> relaxed_positions<5>(const ContourNet<5>&, const RelaxationOptions&);

}  // namespace tegl::detail
