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
#include "position/straight_segment.hpp"

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
  /// By point and curve: a sum of weighted positions, and its weight.
  struct Fit {
    float sum = 0, weight = 0;
  };

  /// `weight`: of all fits in these planes.
  PlaneCurves(const Net& net, const std::array<int, 2>& axes, float weight, Fit* fits)
      : net_(net), axes_(axes), weight_(weight), fits_(fits) {}

  void fit_all() {
    if (weight_ == 0) return;
    const CriticalEdges<N>& edges = net_.edges();
    // open curves from their ends, then closed ones
    for (const bool closed : {false, true})
      for (int j = 0; j < 2; ++j)
        for (Number p = edges.first(axes_[j]); p < edges.first(axes_[j] + 1); ++p) {
          const int c = Net::curve_of(axes_[j], axes_[1 - j]);
          if (fit(p, c).weight != 0) continue;
          if (closed)
            follow(p, j, 1, true);
          else if (net_.link(p, c, 0).side() == Side::none)
            follow(p, j, 1, false);
          else if (net_.link(p, c, 1).side() == Side::none)
            follow(p, j, 0, false);
        }
  }

 private:
  [[nodiscard]] Fit& fit(Number p, int c) noexcept {
    return fits_[std::size_t{p} * Net::kCurves + static_cast<std::size_t>(c)];
  }

  /// Lists a curve from a point on an edge along axes_[j], leaving it on `side`, and fits it.
  void follow(Number start, int j, int side, bool closed) {
    fits_of_.clear();
    steps_.clear();
    Number p = start;
    do {
      const int c = Net::curve_of(axes_[j], axes_[1 - j]);
      fits_of_.push_back(&fit(p, c));
      // the curve crosses the edge along the other axis
      steps_.push_back(j == 0 ? (side == 1 ? GridStep::up : GridStep::down)
                              : (side == 1 ? GridStep::right : GridStep::left));
      const auto link = net_.link(p, c, side);
      if (link.side() == Side::none) break;
      p = link.point();
      if (link.side() != Side::across) {
        // The square lies above an edge at the lower end, and is left on the other side.
        j = 1 - j;
        side = link.side() == Side::lower ? 0 : 1;
      }
    } while (!closed || p != start);
    fit_curve(closed);
  }

  void fit_curve(bool closed) {
    const std::size_t count = steps_.size();
    const auto step = [&](std::size_t i) { return steps_[i < count ? i : i - count]; };
    for (std::size_t first = 0; first < count;) {
      StraightSegment segment;
      std::size_t end = first;
      while (segment.size() < count && (closed || end < count) && segment.add(step(end))) ++end;
      typename StraightSegment::Offsets offsets(segment);
      const float weight = weight_ * static_cast<float>(segment.precision());
      for (std::size_t i = first; i < end; ++i) {
        Fit& fit = *fits_of_[i < count ? i : i - count];
        fit.sum += weight * static_cast<float>(0.5 + offsets.next(step(i)));
        fit.weight += weight;
      }
      if (!closed && end == count) break;
      first += std::max<std::size_t>(1, segment.size() / 3);
    }
  }

  const Net& net_;
  std::array<int, 2> axes_;
  float weight_;
  Fit* fits_;
  std::vector<Fit*> fits_of_;
  std::vector<GridStep> steps_;
};

/// Positions from fits: their mean, each weighted by its precision; the middle if there are none.
template <int N>
void take_fits(const std::vector<typename PlaneCurves<N>::Fit>& fits, const Limits& limits, unsigned threads,
               Buffer<float>& places) {
  constexpr std::size_t kCurves = ContourNet<N>::kCurves;
  for_each_part(places.size(), threads, {}, [&](std::size_t from, std::size_t end) {
    for (std::size_t p = from; p < end; ++p) {
      float sum = 0, weight = 0;
      for (std::size_t c = 0; c < kCurves; ++c) {
        sum += fits[p * kCurves + c].sum;
        weight += fits[p * kCurves + c].weight;
      }
      places[p] = weight > 0 ? limits.clamped(sum / weight) : 0.5f;
    }
  });
}

/// The distance of a point from the chord between its neighbours in a curve, along the point's edge. 0 if a neighbour
/// is absent; then `weight` becomes 0.
template <int N>
[[gnu::always_inline]] inline float above_chord(const ContourNet<N>& net, const float* places, std::size_t p, int c,
                                                float& weight) noexcept {
  using Side = typename ContourNet<N>::Side;
  std::array<float, 2> u{}, v{};  // position along the edge, and distance across it
  for (int side = 0; side < 2; ++side) {
    const auto link = net.link(static_cast<std::uint32_t>(p), c, side);
    if (link.side() == Side::none) {
      weight = 0;
      return 0;
    }
    const float other = places[link.point()];
    const bool across = link.side() == Side::across;
    u[side] = across ? other : static_cast<float>(link.side() == Side::upper);
    v[side] = across ? 1.0f : side == 1 ? other : 1.0f - other;
  }
  return places[p] - (u[0] * v[1] + u[1] * v[0]) / (v[0] + v[1]);
}

/// Moves all points towards the chords of their curves, or away from them if `factor` is negative.
template <int N>
void smooth(const ContourNet<N>& net, const Buffer<float>& places, float factor, const Limits& limits,
            float last_axis_weight, const WorkOptions& work, Buffer<float>& next) {
  const CriticalEdges<N>& edges = net.edges();
  for_each_part(net.size(), work.threads, work.progress, [&](std::size_t from, std::size_t end) {
    for (int axis = 0; axis < N; ++axis) {
      std::array<float, ContourNet<N>::kCurves> weights;
      for (int c = 0; c < ContourNet<N>::kCurves; ++c)
        weights[c] = axis == N - 1 || ContourNet<N>::other_axis(axis, c) == N - 1 ? last_axis_weight : 1.0f;
      const std::size_t last = std::min<std::size_t>(end, edges.first(axis + 1));
      for (std::size_t p = std::max<std::size_t>(from, edges.first(axis)); p < last; ++p) {
        float sum = 0, all = 0;
        for (int c = 0; c < ContourNet<N>::kCurves; ++c) {
          float weight = weights[c];
          sum += above_chord(net, places.data(), p, c, weight) * weight;
          all += weight;
        }
        next[p] = all > 0 ? limits.clamped(places[p] - factor * sum / all) : places[p];
      }
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
  // lines, by planes in parallel
  {
    std::vector<typename PlaneCurves<N>::Fit> fits(std::size_t{net.size()} * ContourNet<N>::kCurves);
    std::vector<std::array<int, 2>> planes;
    for (int a = 0; a < N; ++a)
      for (int b = a + 1; b < N; ++b) planes.push_back({a, b});
    for_each_item(planes.size(), threads, part_of(options.work.progress, 0.0, kFitShare), [&](std::size_t i) {
      const float weight = planes[i][1] == N - 1 ? last_axis_weight : 1.0f;
      PlaneCurves<N>(net, planes[i], weight, fits.data()).fit_all();
    });
    take_fits<N>(fits, limits, threads, places);
  }
  // smoothing
  Buffer<float> next(net.size());
  const int passes = 2 * options.rounds;
  for (int pass = 0; pass < passes; ++pass) {
    const auto share = [&](int i) { return kFitShare + (1.0 - kFitShare) * i / passes; };
    smooth(net, places, pass % 2 == 0 ? kTowards : kAway, limits, last_axis_weight,
           {threads, part_of(options.work.progress, share(pass), share(pass + 1))}, next);
    std::swap(places, next);
  }
  return places;
}

template Buffer<float> relaxed_positions<2>(const ContourNet<2>&, const RelaxationOptions&);
template Buffer<float> relaxed_positions<3>(const ContourNet<3>&, const RelaxationOptions&);
template Buffer<float> relaxed_positions<4>(const ContourNet<4>&, const RelaxationOptions&);
template Buffer<float> relaxed_positions<5>(const ContourNet<5>&, const RelaxationOptions&);

}  // namespace tegl::detail
