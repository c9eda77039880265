// SPDX-License-Identifier: BSD-3-Clause
//
// The two ends of a streamed extraction: samples that come by layers, and a contour that goes out by parts. Private:
// tests use it to choose the parts.
#pragma once

#include <algorithm>
#include <unordered_map>
#include <vector>

#include "close.hpp"
#include "extract_kernel.hpp"
#include "pinches.hpp"
#include "tegl/stream.hpp"

namespace tegl::detail {

/// Few slabs at a time: small layers together, large ones one by one.
template <int N>
ExtractPlan streaming_plan(const Grid<N>& grid) {
  constexpr std::size_t kLeastSamples = std::size_t{1} << 16;
  std::size_t layer = 1;
  for (int a = 0; a < N - 1; ++a) layer *= grid.axes[a].size();
  return {.max_vertices = ~std::uint64_t{0},
          .batch = std::max<std::size_t>(1, kLeastSamples / std::max<std::size_t>(1, layer))};
}

/// The layers of a reader that the extraction works on, in a ring.
template <Value T, int N>
class LayerSource final : public SampleSource<N> {
 public:
  using typename SampleSource<N>::Index;

  LayerSource(LayerReader<T, N>& reader, double isovalue, double epsilon)
      : reader_(reader), isovalue_(isovalue), epsilon_(epsilon), threshold_(make_threshold<T>(isovalue)) {
    const auto sizes = reader.grid().sizes();
    for (int a = 0; a < N - 1; ++a) {
      strides_[a] = layer_size_;
      layer_size_ *= sizes[a];
    }
    row_size_ = sizes[0];
  }

  void keep(std::size_t layers) override { ring_.resize(layers); }

  void prepare(std::size_t k) override {
    Buffer<T>& layer = ring_[k % ring_.size()];
    layer.resize(layer_size_);
    reader_.read(k, layer.data());
  }

  [[nodiscard]] std::size_t sample_bytes() const noexcept override { return sizeof(T); }

  bool classify(const Index& start, Word* high, Word* missing) const noexcept override {
    return classify_row(row(start), 1, row_size_, threshold_, high, missing);
  }

  void edge_alphas(const Index& start, int axis, const std::uint32_t* at, std::size_t count,
                   double* out) const noexcept override {
    auto next = start;
    if (axis > 0) ++next[axis];
    detail::edge_alphas(row(start), row(next) + (axis == 0 ? 1 : 0), 1, at, count, isovalue_, epsilon_, out);
  }

  void cell_alphas(const Index& base, unsigned axes, std::uint32_t edges, double* out) const noexcept override {
    auto above = base;
    ++above[N - 1];
    // A cell within the last layer has nothing above.
    const T* const next = (axes >> (N - 1) & 1u) != 0 ? row(above) + base[0] : nullptr;
    std::array<std::ptrdiff_t, N> strides;
    for (int a = 0; a < N; ++a) strides[a] = static_cast<std::ptrdiff_t>(strides_[a]);
    detail::cell_alphas<T, N>({row(base) + base[0], next}, strides, axes, edges, isovalue_, epsilon_, out);
  }

 private:
  const T* row(const Index& start) const noexcept {
    const T* at = ring_[start[N - 1] % ring_.size()].data();
    for (int a = 1; a < N - 1; ++a) at += start[a] * strides_[a];
    return at;
  }

  LayerReader<T, N>& reader_;
  double isovalue_;
  double epsilon_;
  Threshold<T> threshold_;
  std::size_t row_size_ = 0;
  std::size_t layer_size_ = 1;
  std::array<std::size_t, N> strides_{};
  std::vector<Buffer<T>> ring_;
};

/// Hands parts on to a sink, and keeps what may have to be taken apart in the end.
template <int N, class Real>
class StreamOutput final : public ContourOutput<N, Real> {
 public:
  using typename ContourOutput<N, Real>::Vertex;
  using typename ContourOutput<N, Real>::Simplex;
  using typename ContourOutput<N, Real>::Room;

  explicit StreamOutput(ContourSink<N, Real>& sink) : sink_(sink) {}

  Room open(const ContourPart& part) override {
    before_.swap(vertices_);
    before_first_ = first_;
    first_ = part.first_vertex;
    vertices_.resize(part.end_vertex - part.first_vertex);
    simplices_.resize(part.end_simplex - part.first_simplex);
    return {vertices_.data(), simplices_.data()};
  }

  void close(const ContourPart& part, const PinchCandidates<N>& pinches) override {
    wide_.resize(simplices_.size());
    for (std::size_t s = 0; s < simplices_.size(); ++s)
      for (int j = 0; j < N; ++j)
        wide_[s][j] = before_first_ + static_cast<Index>(simplices_[s][j] - static_cast<Index>(before_first_));
    sink_.add_vertices(vertices_);
    sink_.add_simplices(wide_);
    if (pinches.any_missing()) remember(part, pinches.vertices());
    size_ = {part.end_vertex, part.end_simplex};
  }

  void finish(const ContourPart& all, const Caps<N, Real>* caps, const PinchCandidates<N>& pinches) override {
    std::vector<std::uint64_t> candidates = pinches.vertices();
    if (caps != nullptr) add_caps(*caps, all, pinches.any_missing(), candidates);
    if (pinches.any_missing()) separate(candidates);
  }

  [[nodiscard]] const StreamedSize& size() const noexcept { return size_; }

 private:
  using WideSimplex = typename ContourSink<N, Real>::Simplex;

  [[nodiscard]] const Vertex& vertex(std::uint64_t v) const {
    return v >= first_ ? vertices_[v - first_] : before_[v - before_first_];
  }

  void remember(std::uint64_t number, const WideSimplex& simplex) {
    kept_.push_back(simplex);
    kept_numbers_.push_back(number);
  }

  /// Keeps the part's simplices around candidates, with their vertices.
  void remember(const ContourPart& part, const std::vector<std::uint64_t>& candidates) {
    const auto from = std::lower_bound(candidates.begin(), candidates.end(), before_first_);
    const auto is_candidate = [&](std::uint64_t v) { return std::binary_search(from, candidates.end(), v); };
    for (std::size_t s = 0; s < wide_.size(); ++s) {
      if (std::none_of(wide_[s].begin(), wide_[s].end(), is_candidate)) continue;
      remember(part.first_simplex + s, wide_[s]);
      for (const std::uint64_t v : wide_[s]) places_.try_emplace(v, vertex(v));
    }
  }

  void add_caps(const Caps<N, Real>& caps, const ContourPart& all, bool any_missing,
                std::vector<std::uint64_t>& candidates) {
    wide_.assign(caps.simplices().begin(), caps.simplices().end());
    for (WideSimplex& simplex : wide_)
      for (std::uint64_t& v : simplex) v = caps.number(v, all.end_vertex);
    sink_.add_vertices(caps.vertices());
    sink_.add_simplices(wide_);
    size_.vertices += caps.vertices().size();
    size_.simplices += wide_.size();
    if (!any_missing) return;
    for (std::size_t i = 0; i < caps.vertices().size(); ++i) {
      candidates.push_back(all.end_vertex + i);
      places_.emplace(all.end_vertex + i, caps.vertices()[i]);
    }
    for (std::size_t s = 0; s < wide_.size(); ++s) remember(all.end_simplex + s, wide_[s]);
  }

  /// What is kept, with its vertices numbered anew in the same order, is taken apart as if it were the contour.
  void separate(const std::vector<std::uint64_t>& candidates);

  ContourSink<N, Real>& sink_;
  StreamedSize size_;
  std::uint64_t first_ = 0, before_first_ = 0;
  Buffer<Vertex> vertices_, before_;  ///< of the last part, and of the one before
  Buffer<Simplex> simplices_;
  std::vector<WideSimplex> wide_;
  std::vector<WideSimplex> kept_;
  std::vector<std::uint64_t> kept_numbers_;
  std::unordered_map<std::uint64_t, Vertex> places_;
};

}  // namespace tegl::detail
