// SPDX-License-Identifier: BSD-3-Clause
//
// Input and output of a streamed extraction: samples read layer by layer, and a contour written part by part. Private:
// tests use it to choose the parts.
#pragma once

#include <algorithm>
#include <span>
#include <unordered_map>
#include <vector>

#include "image/row_source.hpp"
#include "kernel/border_caps.hpp"
#include "kernel/extract_kernel.hpp"
#include "kernel/split_nonmanifold.hpp"
#include "tegl/stream.hpp"

namespace tegl::detail {

/// Batches of few slabs: small layers are grouped, large ones are processed one by one.
template <int N>
ExtractPlan streaming_plan(const Grid<N>& grid) {
  constexpr std::size_t kLeastSamples = std::size_t{1} << 16;
  std::size_t layer = 1;
  for (int a = 0; a < N - 1; ++a) layer *= grid.axes[a].size();
  return {.max_vertices = ~std::uint64_t{0},
          .batch = std::max<std::size_t>(1, kLeastSamples / std::max<std::size_t>(1, layer))};
}

/// Ring buffer of a reader's current layers, for one extraction or several that advance by the same batches.
template <Value T, int N>
class LayerRing {
 public:
  explicit LayerRing(LayerReader<T, N>& reader) : reader_(reader) {
    for (int a = 0; a < N - 1; ++a) layer_size_ *= reader.grid().axes[a].size();
  }

  [[nodiscard]] const Grid<N>& grid() const noexcept { return reader_.grid(); }
  /// Call before the first layer is read.
  void keep(std::size_t layers) { ring_.resize(std::max(ring_.size(), layers)); }
  /// Reads layer k, the next one, unless another extraction already did.
  void prepare(std::size_t k) {
    if (k < read_) return;
    Buffer<T>& layer = ring_[k % ring_.size()];
    layer.resize(layer_size_);
    reader_.read(k, layer.data());
    read_ = k + 1;
  }
  [[nodiscard]] const T* layer(std::size_t k) const noexcept { return ring_[k % ring_.size()].data(); }

 private:
  LayerReader<T, N>& reader_;
  std::size_t layer_size_ = 1;
  std::size_t read_ = 0;  ///< number of layers read
  std::vector<Buffer<T>> ring_;
};

/// Sample source for the layers of a ring, with an isovalue.
template <Value T, int N>
class LayerSource final : public RowSource<T, N> {
 public:
  LayerSource(LayerRing<T, N>& ring, double isovalue, double epsilon)
      : RowSource<T, N>(strides_of(ring.grid()), ring.grid().axes[0].size(), isovalue, epsilon, ring.grid().axes[N - 1],
                        0, false),
        ring_(ring) {}

  void keep(std::size_t layers) override { ring_.keep(layers); }
  void prepare(std::size_t k) override { ring_.prepare(k); }

 private:
  [[nodiscard]] const T* layer(std::size_t k) const noexcept override { return ring_.layer(k); }
  static typename RowSource<T, N>::Strides strides_of(const Grid<N>& grid) {
    typename RowSource<T, N>::Strides strides{};
    std::ptrdiff_t stride = 1;
    for (int a = 0; a < N - 1; ++a) {
      strides[a] = stride;
      stride *= static_cast<std::ptrdiff_t>(grid.axes[a].size());
    }
    return strides;
  }

  LayerRing<T, N>& ring_;
};

/// Passes parts to a sink. Keeps the simplices around candidates for splitting at the end. Vertices are passed with the
/// kernel's numbers; a subclass may pass fewer of them.
template <int N, class Real>
class StreamOutput : public ContourOutput<N, Real> {
 public:
  using typename ContourOutput<N, Real>::Vertex;
  using typename ContourOutput<N, Real>::Simplex;
  using typename ContourOutput<N, Real>::Room;

  StreamOutput(ContourSink<N, Real>& sink, bool with_normals) : sink_(sink), with_normals_(with_normals) {}

  Room open(const ContourPart& part) override {
    before_.swap(vertices_);
    before_normals_.swap(normals_);
    before_first_ = first_;
    first_ = part.first_vertex;
    kernel_before_ = kernel_first_;
    kernel_first_ = part.first_vertex;
    vertices_.resize(part.end_vertex - part.first_vertex);
    if (with_normals_) normals_.resize(vertices_.size());
    simplices_.resize(part.end_simplex - part.first_simplex);
    return {vertices_.data(), simplices_.data(), with_normals_ ? normals_.data() : nullptr};
  }

  void close(const ContourPart& part, const NonmanifoldCandidates& nonmanifold) override {
    wide_.resize(simplices_.size());
    for (std::size_t s = 0; s < simplices_.size(); ++s)
      for (int j = 0; j < N; ++j)
        wide_[s][j] = kernel_before_ + static_cast<Index>(simplices_[s][j] - static_cast<Index>(kernel_before_));
    renumber(part);
    add_vertices(vertices_, normals_);
    sink_.add_simplices(wide_);
    keep_simplices(part, nonmanifold);
    size_ = {first_ + vertices_.size(), part.end_simplex};
  }

  void finish(const ContourPart& all, const Caps<N, Real>* caps, const NonmanifoldCandidates& nonmanifold) override {
    std::vector<std::uint64_t> candidates = nonmanifold.vertices();
    if (caps != nullptr) {
      wide_.assign(caps->simplices().begin(), caps->simplices().end());
      for (WideSimplex& simplex : wide_)
        for (std::uint64_t& v : simplex) v = caps->number(v, all.end_vertex);
      add_caps(caps->vertices(), caps->normals(), nonmanifold.any_missing(), candidates);
    }
    if (nonmanifold.any_missing()) separate(candidates);
  }

  [[nodiscard]] const ContourSize& size() const noexcept { return size_; }

 protected:
  using WideSimplex = typename ContourSink<N, Real>::Simplex;

  /// A vertex with its normal, if normals are requested.
  struct Place {
    Vertex vertex{};
    Vertex normal{};
  };

  /// May remove vertices of the part from vertices_ and normals_. Then changes the numbers in wide_ and `first_` to
  /// those of the vertices that are passed.
  virtual void renumber(const ContourPart& /*part*/) {}
  /// Remembers the part's simplices that are needed at the end.
  virtual void keep_simplices(const ContourPart& part, const NonmanifoldCandidates& nonmanifold) {
    if (!nonmanifold.any_missing()) return;
    const std::vector<std::uint64_t>& all = nonmanifold.vertices();
    const auto from = std::lower_bound(all.begin(), all.end(), before_first_);
    remember_around(part, std::span(from, all.end()));
  }

  /// Keeps the part's simplices around candidates, with their vertices.
  void remember_around(const ContourPart& part, std::span<const std::uint64_t> candidates) {
    const auto is_candidate = [&](std::uint64_t v) {
      return std::binary_search(candidates.begin(), candidates.end(), v);
    };
    for (std::size_t s = 0; s < wide_.size(); ++s) {
      if (std::none_of(wide_[s].begin(), wide_[s].end(), is_candidate)) continue;
      remember(part.first_simplex + s, wide_[s]);
      remember_places(wide_[s]);
    }
  }
  void remember(std::uint64_t number, const WideSimplex& simplex) {
    kept_.push_back(simplex);
    kept_numbers_.push_back(number);
  }
  /// Remembers the vertices of a simplex of the current part, unless they are remembered.
  void remember_places(const WideSimplex& simplex) {
    for (const std::uint64_t v : simplex)
      if (const auto [at, is_new] = places_.try_emplace(v); is_new) at->second = place(v);
  }

  /// Passes the vertices of caps and their simplices, which are in wide_.
  void add_caps(std::span<const Vertex> vertices, std::span<const Vertex> normals, bool any_missing,
                std::vector<std::uint64_t>& candidates) {
    const ContourSize before = size_;
    add_vertices(vertices, normals);
    sink_.add_simplices(wide_);
    size_.vertices += vertices.size();
    size_.simplices += wide_.size();
    if (!any_missing) return;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      candidates.push_back(before.vertices + i);
      places_.emplace(before.vertices + i, Place{vertices[i], with_normals_ ? normals[i] : Vertex{}});
    }
    for (std::size_t s = 0; s < wide_.size(); ++s) remember(before.simplices + s, wide_[s]);
  }

  /// Splits the kept simplices as if they were the contour, after renumbering their vertices in the same order.
  void separate(const std::vector<std::uint64_t>& candidates);

  std::uint64_t first_ = 0, before_first_ = 0;          ///< numbers of the first vertices of vertices_ and before_
  std::uint64_t kernel_first_ = 0, kernel_before_ = 0;  ///< the kernel's numbers of the first vertices of the parts
  Buffer<Vertex> vertices_, before_;                    ///< of the current part and of the previous one
  Buffer<Vertex> normals_, before_normals_;
  std::vector<WideSimplex> wide_;
  std::vector<Period<N>> periods_;  ///< of the contour

 private:
  [[nodiscard]] Place place(std::uint64_t v) const {
    const bool last = v >= first_;
    const std::uint64_t i = v - (last ? first_ : before_first_);
    Place result{last ? vertices_[i] : before_[i], {}};
    if (with_normals_) result.normal = last ? normals_[i] : before_normals_[i];
    return result;
  }

  void add_vertices(std::span<const Vertex> vertices, std::span<const Vertex> normals) {
    sink_.add_vertices(vertices);
    if (with_normals_) sink_.add_normals(normals);
  }

  ContourSink<N, Real>& sink_;
  bool with_normals_;
  ContourSize size_;
  Buffer<Simplex> simplices_;
  std::vector<WideSimplex> kept_;
  std::vector<std::uint64_t> kept_numbers_;
  std::unordered_map<std::uint64_t, Place> places_;
};

}  // namespace tegl::detail
