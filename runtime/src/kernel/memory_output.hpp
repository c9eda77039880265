// SPDX-License-Identifier: BSD-3-Clause
//
// Output of an extraction to a contour in memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <new>
#include <type_traits>
#include <vector>

#include "kernel/border_caps.hpp"
#include "kernel/contour_output.hpp"
#include "kernel/split_nonmanifold.hpp"

namespace tegl::detail {

/// Sets the names and units of the axes and the direction of a contour.
template <int N, class Real>
void describe(const Grid<N>& grid, const ExtractOptions& options, Contour<N, Real>& contour) {
  for (int a = 0; a < N; ++a) {
    contour.axis_names[a] = grid.axes[a].name;
    contour.axis_units[a] = grid.axes[a].unit;
  }
  contour.direction = options.direction;
}

/// Output to a contour in memory.
template <int N, class Real>
class MemoryOutput : public ContourOutput<N, Real> {
 public:
  using typename ContourOutput<N, Real>::Vertex;
  using typename ContourOutput<N, Real>::Simplex;
  using typename ContourOutput<N, Real>::Room;
  MemoryOutput(Contour<N, Real>& contour, bool normals, std::uint64_t max_vertices)
      : contour_(contour), normals_(normals), max_vertices_(max_vertices) {}

  /// Reserves address space for the largest possible contour; memory is taken when it is written to. If address space
  /// does not suffice for all outputs and for other needs (kElse), outputs grow by reallocation instead.
  void expect(double vertices, double simplices) override {
    constexpr double kMostBytes = 0x1p40;
    constexpr std::size_t kElse = std::size_t{1} << 26;
    const auto reserve = [](auto& output, double most) {
      const auto size = static_cast<double>(sizeof(output[0]));
      output.reserve(static_cast<std::size_t>(std::min(most, kMostBytes / size)));
    };
    const auto give_back = [](auto& output) { std::remove_reference_t<decltype(output)>().swap(output); };
    try {
      reserve(contour_.vertices, vertices);
      reserve(contour_.simplices, simplices);
      if (normals_) reserve(contour_.normals, vertices);
      Buffer<unsigned char>().reserve(kElse);
    } catch (const std::bad_alloc&) {
      give_back(contour_.vertices);
      give_back(contour_.simplices);
      give_back(contour_.normals);
    }
  }

  Room open(const ContourPart& part) override {
    ahead_.clear();
    resize(contour_.vertices, part.end_vertex, part);
    resize(contour_.simplices, part.end_simplex, part);
    if (normals_) resize(contour_.normals, part.end_vertex, part);
    return {contour_.vertices.data() + part.first_vertex, contour_.simplices.data() + part.first_simplex,
            normals_ ? contour_.normals.data() + part.first_vertex : nullptr};
  }

  [[nodiscard]] std::size_t pieces_ahead() const noexcept override { return ahead_.size(); }
  void touch_ahead(std::size_t piece) noexcept override { *static_cast<volatile unsigned char*>(ahead_[piece]) = 0; }

  void finish(const ContourPart& all, const Caps<N, Real>* caps, const NonmanifoldCandidates& nonmanifold) override {
    if (caps != nullptr) add_caps(*caps, all.end_vertex);
    if (!nonmanifold.any_missing()) return;
    std::vector<Index> candidates(nonmanifold.vertices().begin(), nonmanifold.vertices().end());
    for (std::uint64_t v = all.end_vertex; v < contour_.vertices.size(); ++v)
      candidates.push_back(static_cast<Index>(v));
    split_nonmanifold(contour_, candidates, max_vertices_);
  }

 protected:
  [[nodiscard]] Contour<N, Real>& contour() const noexcept { return contour_; }
  [[nodiscard]] std::uint64_t max_vertices() const noexcept { return max_vertices_; }
  void add_caps(const Caps<N, Real>& caps, std::uint64_t first) {
    check_vertex_count(first + caps.vertices().size(), max_vertices_);
    contour_.vertices.insert(contour_.vertices.end(), caps.vertices().begin(), caps.vertices().end());
    contour_.normals.insert(contour_.normals.end(), caps.normals().begin(), caps.normals().end());
    contour_.simplices.reserve(contour_.simplices.size() + caps.simplices().size());
    for (const auto& simplex : caps.simplices()) {
      Simplex& narrow = contour_.simplices.emplace_back();
      for (int j = 0; j < N; ++j) narrow[j] = static_cast<Index>(caps.number(simplex[j], first));
    }
  }

 private:
  template <class Items>
  void resize(Items& output, std::uint64_t size, const ContourPart& part) {
    const std::uint64_t last = size - output.size();
    resize_output(output, size, part.done);
    look_ahead(output, last, part.done);
  }

  /// Records the huge pages after the current end: as much as the last part took, within the estimated total size.
  template <class Items>
  void look_ahead(Items& output, std::uint64_t last, double done) {
    constexpr std::size_t kItem = sizeof(output[0]);
    if (output.capacity() * kItem < kLargeBlock) return;
    const auto rest = static_cast<std::uint64_t>(static_cast<double>(output.size()) * (1.0 - done) / done);
    const std::size_t more = std::min<std::uint64_t>({last, rest, output.capacity() - output.size()});
    // Large blocks start on a page boundary.
    auto* const block = reinterpret_cast<unsigned char*>(output.data());
    const std::size_t first = (output.size() * kItem + kLargeBlock - 1) / kLargeBlock * kLargeBlock;
    for (std::size_t at = first; at < (output.size() + more) * kItem; at += kLargeBlock) ahead_.push_back(block + at);
  }

  Contour<N, Real>& contour_;
  bool normals_;
  std::uint64_t max_vertices_;
  std::vector<void*> ahead_;
};

}  // namespace tegl::detail
