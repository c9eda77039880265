// SPDX-License-Identifier: BSD-3-Clause
//
// Output of streamed contours of lattices: passes parts to a sink, and separates sheets that touch beside missing
// values at the end.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "kernel/contour_output.hpp"
#include "kernel/split_nonmanifold.hpp"
#include "tegl/stream.hpp"

namespace tegl::detail {

template <int N, class Real>
class PartOutput {
 public:
  using Vertex = typename Contour<N, Real>::Vertex;
  using Simplex = typename Contour<N, Real>::Simplex;

  PartOutput(ContourSink<N, Real>& sink, bool with_normals, std::vector<Period<N>> periods)
      : sink_(sink), with_normals_(with_normals) {
    near_.periods = std::move(periods);
  }

  /// Passes the next vertices.
  void add(std::span<const Vertex> vertices, std::span<const Vertex> normals) {
    sink_.add_vertices(vertices);
    if (with_normals_) sink_.add_normals(normals);
    size_.vertices += vertices.size();
  }
  /// Passes simplices of `part`; `numbers`: those in the whole contour, by vertex of the part. `touching`, empty or by
  /// vertex of the part: whether the contour may touch itself there, the same in all parts that have the vertex.
  void add(const Contour<N, Real>& part, std::span<const Simplex> simplices, std::span<const std::uint64_t> numbers,
           const std::vector<bool>& touching) {
    wide_.resize(simplices.size());
    for (std::size_t s = 0; s < simplices.size(); ++s) {
      for (int j = 0; j < N; ++j) wide_[s][j] = numbers[simplices[s][j]];
      if (!touching.empty() && std::ranges::any_of(simplices[s], [&](Index v) { return touching[v]; }))
        keep(part, simplices[s], size_.simplices + s, numbers, touching);
    }
    pass_simplices();
  }
  /// Call after the last part. Copies of vertices, and simplices between them, are passed behind all others.
  void separate_sheets();

  [[nodiscard]] const ContourSize& size() const noexcept { return size_; }

 private:
  void keep(const Contour<N, Real>& part, const Simplex& simplex, std::uint64_t number,
            std::span<const std::uint64_t> numbers, const std::vector<bool>& touching) {
    Simplex& kept = near_.simplices.emplace_back();
    for (int j = 0; j < N; ++j) {
      const Index v = simplex[j];
      const auto [at, is_new] = places_.try_emplace(numbers[v], static_cast<Index>(near_.vertices.size()));
      kept[j] = at->second;
      if (!is_new) continue;
      near_.vertices.push_back(part.vertices[v]);
      if (with_normals_) near_.normals.push_back(part.normals[v]);
      vertex_numbers_.push_back(numbers[v]);
      if (touching[v]) touching_.push_back(at->second);
    }
    simplex_numbers_.push_back(number);
  }
  void pass_simplices() {
    sink_.add_simplices(wide_);
    size_.simplices += wide_.size();
  }

  ContourSink<N, Real>& sink_;
  bool with_normals_;
  ContourSize size_;
  std::vector<typename ContourSink<N, Real>::Simplex> wide_;
  Contour<N, Real> near_;  ///< the simplices at which the contour may touch itself
  std::vector<std::uint64_t> vertex_numbers_, simplex_numbers_;  ///< of `near_` in the whole contour
  std::map<std::uint64_t, Index> places_;                        ///< in `near_`, by number in the whole contour
  std::vector<Index> touching_;                                  ///< vertices of `near_`
};

template <int N, class Real>
void PartOutput<N, Real>::separate_sheets() {
  if (touching_.empty()) return;
  const std::vector<Simplex> before(near_.simplices.begin(), near_.simplices.end());
  std::sort(touching_.begin(), touching_.end());
  split_nonmanifold<N, Real>(near_, touching_, kMaxVertices);
  for (std::size_t v = vertex_numbers_.size(); v < near_.vertices.size(); ++v)
    vertex_numbers_.push_back(size_.vertices + (v - places_.size()));
  for (std::size_t s = 0; s < before.size(); ++s)
    for (int j = 0; j < N; ++j)
      if (const Index v = near_.simplices[s][j]; v != before[s][j])
        sink_.replace_corner(simplex_numbers_[s], j, vertex_numbers_[v]);
  wide_.clear();
  for (std::size_t s = before.size(); s < near_.simplices.size(); ++s) {
    auto& simplex = wide_.emplace_back();
    for (int j = 0; j < N; ++j) simplex[j] = vertex_numbers_[near_.simplices[s][j]];
  }
  add(std::span(near_.vertices).subspan(places_.size()),
      std::span(near_.normals).subspan(with_normals_ ? places_.size() : 0));
  pass_simplices();
}

}  // namespace tegl::detail
