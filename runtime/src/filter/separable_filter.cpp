// SPDX-License-Identifier: BSD-3-Clause
//
// Separable convolution: passes along the axes of a layer when it enters the ring, and a pass along the last axis from
// the ring. Where samples are missing, the weights of the present samples are summed by the same passes over a mask.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "filter/layer_filter.hpp"
#include "filter/weighted_lines.hpp"

namespace tegl::detail {

namespace {

/// Samples of a block of lines, and lines of an item: their sum over all weights stays in a processor's cache.
constexpr std::size_t kBlock = 2048;
constexpr std::size_t kLines = 32;

/// A layer of the ring.
template <class Real>
struct RingLayer {
  std::vector<Real> values;
  std::vector<Real> present;          ///< sum of the weights of the present samples; empty: none is missing
  std::vector<std::uint8_t> missing;  ///< whether the image itself is missing there; empty: nowhere
};

/// A layer that passes through the axes within it: from `from`, by way of `other`, to `to`.
template <class Real>
struct LayerJob {
  Real* from;
  Real* other;
  Real* to;
};

template <class Real>
class SeparableFilter final : public LayerFilter<Real> {
 public:
  using Base = LayerFilter<Real>;
  using Load = typename Base::Load;
  using Scratch = typename Base::Scratch;

  SeparableFilter(FilterShape shape, const SeparableConvolution& filter);

 private:
  void take(std::ptrdiff_t from, std::ptrdiff_t to, Load load, bool parallel) override;
  void put(std::size_t first, std::size_t count, Real* out) override;

  /// Sets missing values to 0, and notes them. Returns whether there are any.
  bool separate_missing(Real* values, RingLayer<Real>& layer, std::vector<Real>& mask) const;
  void run_passes(const std::vector<LayerJob<Real>>& jobs);
  void pass_along_rows(const std::vector<LayerJob<Real>>& jobs, std::size_t pass);
  void pass_across_rows(const std::vector<LayerJob<Real>>& jobs, std::size_t axis, std::size_t pass);
  [[nodiscard]] std::pair<const Real*, Real*> ends(const LayerJob<Real>& job, std::size_t pass) const noexcept;
  /// Whether values are divided by the sum of the weights of the samples that are present.
  [[nodiscard]] bool needs_sums_of_weights(std::size_t layer) const noexcept;
  void put_block(std::size_t layer, std::size_t at, std::size_t width, bool masked, Scratch& scratch, Real* out);
  /// The sums of weights in a layer in which nothing is missing.
  const std::vector<Real>& whole();

  using Base::for_items;
  using Base::in_ring;
  using Base::place;
  using Base::shape;

  /// Weights along an axis that are not 0: a sample without weight counts as little if it is NaN or infinite.
  struct Taps {
    std::vector<Real> weights;
    std::vector<std::size_t> places;  ///< from 0 to twice the radius
  };
  static Taps taps_of(const AxisWeights& along);

  std::vector<Taps> taps_;           ///< by axis
  std::vector<std::size_t> within_;  ///< axes within a layer that are filtered
  bool normalised_ = true;           ///< all weights are at least 0
  double gain_ = 1;                  ///< sum of all weights
  std::vector<RingLayer<Real>> ring_;
  std::vector<std::vector<Real>> from_, other_, masks_, mask_other_;
  std::vector<Real> whole_;
  std::vector<Real> outside_;  ///< a line beyond a border of missing samples
};

template <class Real>
SeparableFilter<Real>::SeparableFilter(FilterShape given, const SeparableConvolution& filter)
    : Base(std::move(given)), ring_(Base::ring_size()) {
  for (std::size_t a = 0; a < shape().axes(); ++a) {
    const AxisWeights& along = filter.weights[a];
    taps_.push_back(taps_of(along));
    double sum = 0;
    for (const double weight : along) {
      normalised_ = normalised_ && weight >= 0;
      sum += weight;
    }
    if (!along.empty()) gain_ *= sum;
    const bool changes = along.size() > 1 || (along.size() == 1 && along[0] != 1.0);
    if (changes && a < shape().last()) within_.push_back(a);
  }
  normalised_ = normalised_ && gain_ > 0;
  outside_.assign(kBlock, normalised_ ? Real{0} : std::numeric_limits<Real>::quiet_NaN());
}

template <class Real>
typename SeparableFilter<Real>::Taps SeparableFilter<Real>::taps_of(const AxisWeights& along) {
  if (along.empty()) return {{Real{1}}, {0}};
  Taps taps;
  for (std::size_t t = 0; t < along.size(); ++t) {
    if (along[t] == 0) continue;
    taps.weights.push_back(static_cast<Real>(along[t]));
    taps.places.push_back(t);
  }
  if (taps.weights.empty()) return {{Real{0}}, {along.size() / 2}};
  return taps;
}

template <class Real>
bool SeparableFilter<Real>::separate_missing(Real* values, RingLayer<Real>& layer, std::vector<Real>& mask) const {
  const std::size_t size = shape().layer_size();
  layer.missing.clear();
  bool any = false;
  for (std::size_t i = 0; i < size; ++i) any |= values[i] != values[i];
  if (!any) return false;
  layer.missing.resize(size);
  if (!normalised_) {
    for (std::size_t i = 0; i < size; ++i) layer.missing[i] = values[i] != values[i];
    return false;
  }
  mask.resize(size);
  for (std::size_t i = 0; i < size; ++i) {
    layer.missing[i] = values[i] != values[i];
    mask[i] = layer.missing[i] != 0 ? Real{0} : Real{1};
    if (layer.missing[i] != 0) values[i] = 0;
  }
  return true;
}

template <class Real>
void SeparableFilter<Real>::take(std::ptrdiff_t from, std::ptrdiff_t to, Load load, bool parallel) {
  const std::size_t size = shape().layer_size();
  const std::size_t step = Base::batch() + 1;  // the first window has more layers than a batch
  for (std::ptrdiff_t next = from; next < to; next += static_cast<std::ptrdiff_t>(step)) {
    const auto count = std::min(step, static_cast<std::size_t>(to - next));
    const auto number = [&](std::ptrdiff_t layer) { return static_cast<std::size_t>(layer - next); };
    for (auto* const buffers : {&from_, &other_, &masks_, &mask_other_})
      if (buffers->size() < count) buffers->resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      from_[i].resize(size);
      if (within_.size() > 1) other_[i].resize(size);
      ring_[place(next + static_cast<std::ptrdiff_t>(i))].values.resize(size);
    }
    Base::load_all(next, next + static_cast<std::ptrdiff_t>(count), load, parallel,
                   [&](std::ptrdiff_t layer) { return from_[number(layer)].data(); });
    std::vector<LayerJob<Real>> jobs;
    for (std::size_t i = 0; i < count; ++i) {
      RingLayer<Real>& layer = ring_[place(next + static_cast<std::ptrdiff_t>(i))];
      const bool masked = separate_missing(from_[i].data(), layer, masks_[i]);
      jobs.push_back({from_[i].data(), other_[i].data(), layer.values.data()});
      layer.present.resize(masked ? size : 0);
      if (!masked) continue;
      mask_other_[i].resize(size);
      jobs.push_back({masks_[i].data(), mask_other_[i].data(), layer.present.data()});
    }
    run_passes(jobs);
  }
}

template <class Real>
std::pair<const Real*, Real*> SeparableFilter<Real>::ends(const LayerJob<Real>& job, std::size_t pass) const noexcept {
  const Real* const source = pass % 2 == 0 ? job.from : job.other;
  Real* const target = pass + 1 == within_.size() ? job.to : pass % 2 == 0 ? job.other : job.from;
  return {source, target};
}

template <class Real>
void SeparableFilter<Real>::run_passes(const std::vector<LayerJob<Real>>& jobs) {
  if (within_.empty())
    return for_items(jobs.size(), 1,
                     [&](std::size_t i, Scratch&) { std::copy_n(jobs[i].from, shape().layer_size(), jobs[i].to); });
  for (std::size_t pass = 0; pass < within_.size(); ++pass) {
    if (within_[pass] == 0)
      pass_along_rows(jobs, pass);
    else
      pass_across_rows(jobs, within_[pass], pass);
  }
}

template <class Real>
void SeparableFilter<Real>::pass_along_rows(const std::vector<LayerJob<Real>>& jobs, std::size_t pass) {
  const std::size_t width = shape().sizes[0];
  const std::size_t rows = shape().layer_size() / width;
  const Taps& taps = taps_[0];
  const auto radius = static_cast<std::ptrdiff_t>(shape().radii[0]);
  for_items(jobs.size() * rows, 8, [&](std::size_t item, Scratch& scratch) {
    const auto [source, target] = ends(jobs[item / rows], pass);
    const Real* const row = source + (item % rows) * width;
    std::vector<Real>& padded = scratch.first;
    padded.resize(width + 2 * shape().radii[0]);
    for (std::ptrdiff_t i = 0; i < radius; ++i) {
      const auto outside = [&](std::ptrdiff_t at) {
        const std::ptrdiff_t index = source_index(at, width, shape().borders[0]);
        return index >= 0 ? row[index] : outside_[0];
      };
      padded[static_cast<std::size_t>(i)] = outside(i - radius);
      padded[static_cast<std::size_t>(i + radius) + width] = outside(i + static_cast<std::ptrdiff_t>(width));
    }
    std::copy_n(row, width, padded.begin() + radius);
    scratch.lines.clear();
    for (const std::size_t t : taps.places) scratch.lines.push_back(padded.data() + t);
    weighted_lines(scratch.lines.data(), taps.weights.data(), scratch.lines.size(), width,
                   target + (item % rows) * width);
  });
}

template <class Real>
void SeparableFilter<Real>::pass_across_rows(const std::vector<LayerJob<Real>>& jobs, std::size_t axis,
                                             std::size_t pass) {
  std::size_t inner = 1;
  for (std::size_t a = 0; a < axis; ++a) inner *= shape().sizes[a];
  const std::size_t lines = shape().sizes[axis];
  const std::size_t outer = shape().layer_size() / (inner * lines);
  const std::size_t blocks = block_count(inner, kBlock);
  const std::size_t groups = block_count(lines, kLines);
  const Taps& taps = taps_[axis];
  const auto radius = static_cast<std::ptrdiff_t>(shape().radii[axis]);
  for_items(jobs.size() * outer * blocks * groups, 1, [&](std::size_t item, Scratch& scratch) {
    const std::size_t group = item % groups;
    const std::size_t block = item / groups % blocks;
    const std::size_t start = (item / (groups * blocks) % outer) * inner * lines + block * kBlock;
    const auto [source, target] = ends(jobs[item / (groups * blocks * outer)], pass);
    const std::size_t width = std::min(kBlock, inner - block * kBlock);
    for (std::size_t j = group * kLines; j < std::min(lines, (group + 1) * kLines); ++j) {
      scratch.lines.clear();
      for (const std::size_t t : taps.places) {
        const std::ptrdiff_t at =
            source_index(static_cast<std::ptrdiff_t>(j + t) - radius, lines, shape().borders[axis]);
        scratch.lines.push_back(at < 0 ? outside_.data() : source + start + static_cast<std::size_t>(at) * inner);
      }
      weighted_lines(scratch.lines.data(), taps.weights.data(), scratch.lines.size(), width,
                     target + start + j * inner);
    }
  });
}

template <class Real>
const std::vector<Real>& SeparableFilter<Real>::whole() {
  if (!whole_.empty()) return whole_;
  const std::size_t size = shape().layer_size();
  std::vector<Real> ones(size, Real{1});
  std::vector<Real> other(size);
  whole_.resize(size);
  run_passes({{ones.data(), other.data(), whole_.data()}});
  return whole_;
}

template <class Real>
bool SeparableFilter<Real>::needs_sums_of_weights(std::size_t layer) const noexcept {
  if (!normalised_) return false;
  if (shape().misses_border()) return true;
  const auto radius = static_cast<std::ptrdiff_t>(shape().radii.back());
  for (std::ptrdiff_t k = -radius; k <= radius; ++k) {
    std::size_t at = 0;
    if (in_ring(static_cast<std::ptrdiff_t>(layer) + k, at) && !ring_[at].present.empty()) return true;
  }
  return false;
}

template <class Real>
void SeparableFilter<Real>::put(std::size_t first, std::size_t count, Real* out) {
  const std::size_t size = shape().layer_size();
  // for each layer by itself, so that its samples do not depend on the others of the batch
  std::vector<std::uint8_t> masked(count);
  for (std::size_t k = 0; k < count; ++k) {
    masked[k] = needs_sums_of_weights(first + k) ? 1 : 0;
    if (masked[k] != 0) whole();
  }
  // sums along the last axis
  for_items(block_count(size, kBlock), 1, [&](std::size_t block, Scratch& scratch) {
    const std::size_t at = block * kBlock;
    const std::size_t width = std::min(kBlock, size - at);
    for (std::size_t k = 0; k < count; ++k)
      put_block(first + k, at, width, masked[k] != 0, scratch, out + k * size + at);
  });
}

template <class Real>
void SeparableFilter<Real>::put_block(std::size_t layer, std::size_t at, std::size_t width, bool masked,
                                      Scratch& scratch, Real* out) {
  const std::vector<Real>& weights = taps_.back().weights;
  const auto radius = static_cast<std::ptrdiff_t>(shape().radii.back());
  scratch.lines.resize(weights.size());
  scratch.more_lines.resize(weights.size());
  for (std::size_t t = 0; t < weights.size(); ++t) {
    std::size_t slot = 0;
    if (!in_ring(static_cast<std::ptrdiff_t>(layer + taps_.back().places[t]) - radius, slot)) {
      scratch.lines[t] = scratch.more_lines[t] = outside_.data();
      continue;
    }
    const RingLayer<Real>& from = ring_[slot];
    scratch.lines[t] = from.values.data() + at;
    if (masked) scratch.more_lines[t] = (from.present.empty() ? whole_ : from.present).data() + at;
  }
  weighted_lines(scratch.lines.data(), weights.data(), weights.size(), width, out);
  constexpr Real kNaN = std::numeric_limits<Real>::quiet_NaN();
  if (masked) {
    scratch.second.resize(width);
    weighted_lines(scratch.more_lines.data(), weights.data(), weights.size(), width, scratch.second.data());
    const Real gain = static_cast<Real>(gain_);
    // Sums of fewer weights than this are only rounding errors of the values.
    const Real least = std::numeric_limits<Real>::epsilon() * gain;
    for (std::size_t i = 0; i < width; ++i)
      out[i] = scratch.second[i] > least ? out[i] / scratch.second[i] * gain : kNaN;
  }
  const std::vector<std::uint8_t>& missing = ring_[place(static_cast<std::ptrdiff_t>(layer))].missing;
  if (shape().fill_missing || missing.empty()) return;
  for (std::size_t i = 0; i < width; ++i)
    if (missing[at + i] != 0) out[i] = kNaN;
}

}  // namespace

template <class Real>
std::unique_ptr<LayerFilter<Real>> make_separable_filter(FilterShape shape, const SeparableConvolution& filter) {
  return std::make_unique<SeparableFilter<Real>>(std::move(shape), filter);
}
template std::unique_ptr<LayerFilter<float>> make_separable_filter<float>(FilterShape, const SeparableConvolution&);
template std::unique_ptr<LayerFilter<double>> make_separable_filter<double>(FilterShape, const SeparableConvolution&);

}  // namespace tegl::detail
