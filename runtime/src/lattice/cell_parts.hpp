// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of a lattice's cells part by part, for streams: the cells of some layers are a complex of their own.
// Vertices that another part has, too, are known by their keys: the ends of their edge, the vertices of their polygon,
// or their sample.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "complex/contour_numbers.hpp"
#include "complex/image_points.hpp"
#include "complex/point_gradients.hpp"
#include "image/row_source.hpp"
#include "lattice/lattice_gradients.hpp"
#include "lattice/part_cells.hpp"
#include "lattice/part_output.hpp"
#include "lattice/shared_numbers.hpp"

namespace tegl::detail {

/// The samples of a window that are at most two indices along each axis from a missing one: all corners of cells with
/// a missing corner. Empty if none is missing. Bit a of `periodic`: axis a is.
template <Value T, int N>
std::vector<bool> near_missing(const Image<T, N>& window, unsigned periodic) {
  const auto sizes = window.grid().sizes();
  std::vector<bool> near;
  for_each_sample<N>(sizes, [&](const auto& index) {
    const auto value = static_cast<double>(window(index));
    near.push_back(value != value);
  });
  if (std::find(near.begin(), near.end(), true) == near.end()) return {};
  std::size_t stride = 1;
  for (int a = 0; a < N; ++a) {
    const std::size_t size = sizes[a];
    const std::vector<bool> before = near;
    for (std::size_t i = 0; i < before.size(); ++i) {
      if (!before[i]) continue;
      const std::size_t at = i / stride % size;
      for (std::ptrdiff_t step = -2; step <= 2; ++step) {
        const std::ptrdiff_t to = static_cast<std::ptrdiff_t>(at) + step;
        const bool is_inside = to >= 0 && to < static_cast<std::ptrdiff_t>(size);
        if (is_inside || (periodic >> a & 1u) != 0) near[i - at * stride + layer_modulo(to, size) * stride] = true;
      }
    }
    stride *= size;
  }
  return near;
}

/// Passes the contour of the cells of one part after the other.
template <class Real, int N>
class CellParts {
 public:
  using Ends = std::array<std::uint64_t, 2>;  ///< numbers of samples
  using Output = PartOutput<N, Real>;

  /// `grid`: of the whole image. The arguments must outlive this object.
  CellParts(const Grid<N>& grid, double isovalue, Lattice lattice, const AxisPeriods<N>& periods,
            std::vector<Period<N>> contour_periods, Output& output)
      : grid_(grid),
        isovalue_(isovalue),
        lattice_(lattice),
        periods_(periods),
        contour_periods_(std::move(contour_periods)),
        output_(output),
        cells_(grid, lattice, periods),
        count_(grid.axes[N - 1].size()) {
    for (int a = 0; a + 1 < N; ++a) layer_size_ *= grid.axes[a].size();
  }

  /// Number of the vertex on an edge that the contour passed before the first part has.
  void know(const Ends& ends, std::uint64_t number) { edges_.add(ends, number, {.behind = true}, false); }
  void end_known() { edges_.end_part(); }

  /// `window`: the layers [part.begin, part.end). Errors: those of `lattice_complex` and `extract`, and of the sink.
  template <Value T>
  void add(const Image<T, N>& window, const PartLayers& part, const ExtractOptions& options, ExtractStats& stats) {
    const bool is_ring = periods_[N - 1] != 0.0;
    if (lattice_ == Lattice::fcc_in_time && !is_ring && part.first + 1 == part.end) return;  // no interval is left
    auto made = cells_.of(part, options.close, {options.work.threads});
    made.complex.set_values(values_in(window, made.layers));
    Grid<N> at_start = window.grid();  // even if the image's is
    if (const Axis& axis = grid_.axes[N - 1]; axis.is_uniform())
      at_start.axes[N - 1] = Axis::uniform(window.size(N - 1), axis[0], axis.step());
    const Image<T, N> around_part(window.data(), at_start, window.strides());
    const ImageSource<T, N> source(around_part, isovalue_, options.epsilon);
    const unsigned periodic = periodic_axes<N>(periods_) & ~(1u << (N - 1));
    std::optional<LatticeGradients<N>> gradients;
    Surroundings<N> around;
    VertexKeys keys;
    around.keys = &keys;
    around.periods = contour_periods_;
    if (options.close) around.border = &made.border;
    if (options.normals != Normals::none) {
      AxisPeriods<N> across = periods_;  // the window's layers do not repeat themselves
      across[N - 1] = 0.0;
      gradients.emplace(source, at_start, lattice_, options.direction, across);
      around.gradient = [&, sizes = window.grid().sizes()](Index p) {
        return gradients->at(index_of<N>(in_window(made.layers, p), sizes));
      };
    }
    const auto [contour, more] = extract_in<Real>(made.complex, isovalue_, options, around);
    number(contour, keys, made.layers, part);
    pass(contour, keys, made.layers, near_missing(window, periodic));
    add_to(stats, more);
  }

 private:
  using Layers = std::vector<typename PartCells<N>::Layer>;
  using Polygon = std::array<std::uint64_t, 12>;  ///< numbers of vertices, ascending; unused ones are kNone
  static constexpr std::uint64_t kNone = ~std::uint64_t{0};

  /// The places of a point in the window and in the image.
  [[nodiscard]] std::size_t in_window(const Layers& layers, Index p) const {
    return layers[p / layer_size_].in_window * layer_size_ + p % layer_size_;
  }
  [[nodiscard]] std::uint64_t in_image(const Layers& layers, Index p) const {
    return std::uint64_t{layers[p / layer_size_].number} * layer_size_ + p % layer_size_;
  }
  template <Value T>
  [[nodiscard]] std::vector<double> values_in(const Image<T, N>& window, const Layers& layers) const {
    std::vector<double> values;
    for (const auto& layer : layers) {
      const T* const from = window.data() + layer.in_window * layer_size_;
      for (std::size_t i = 0; i < layer_size_; ++i) values.push_back(static_cast<double>(from[i]));
    }
    return values;
  }

  /// Whether cells on both sides of a layer, those from it on and those before, may have a sample.
  [[nodiscard]] bool is_at(std::uint64_t sample, std::ptrdiff_t layer) const {
    const bool is_in_time = lattice_ == Lattice::fcc_in_time;  // prisms end at their own time
    const std::size_t first = layer_modulo(layer - (is_in_time ? 0 : 1), count_);
    const std::size_t behind = (sample / layer_size_ + count_ - first) % count_;
    return behind < (is_in_time ? 1u : 3u);
  }
  [[nodiscard]] BetweenParts between(std::uint64_t sample, const PartLayers& part) const {
    return {is_at(sample, part.first), is_at(sample, part.last), periods_[N - 1] != 0.0 && is_at(sample, 0)};
  }
  static BetweenParts both(const BetweenParts& a, const BetweenParts& b) {
    return {a.before && b.before, a.behind && b.behind, a.seam && b.seam};
  }

  /// Numbers the vertices of a part; those that no part had before are gathered.
  void number(const Contour<N, Real>& contour, const VertexKeys& keys, const Layers& layers, const PartLayers& part) {
    const bool is_first = part.first == 0;
    numbers_.assign(contour.vertices.size(), kNone);
    std::vector<BetweenParts> where;
    for (std::size_t v = 0; v < keys.edges.size(); ++v) {
      const Ends ends = {in_image(layers, keys.edges[v][0]), in_image(layers, keys.edges[v][1])};
      where.push_back(both(between(ends[0], part), between(ends[1], part)));
      number_one(contour, v, ends, where[v], is_first, edges_);
    }
    for (std::size_t i = 0; i < keys.polygons.size(); ++i) {
      const PolygonKey& key = keys.polygons[i];
      if (key.back() == kInCube || key.back() == kInFacet) continue;  // in one cell each, at the border
      Polygon polygon;
      polygon.fill(kNone);
      BetweenParts all{true, true, true};
      for (std::size_t k = 0; k < key.size() && key[k] != kNoPoint; ++k) {
        polygon[k] = numbers_[key[k]];
        all = both(all, where[key[k]]);
      }
      std::sort(polygon.begin(), polygon.end());
      number_one(contour, keys.edges.size() + i, polygon, all, is_first, polygons_);
    }
    for (std::size_t i = 0; i < keys.corners.size(); ++i) {
      const std::uint64_t sample = in_image(layers, keys.corners[i]);
      number_one(contour, keys.before_caps + i, sample, between(sample, part), is_first, corners_);
    }
    for (std::size_t v = 0; v < numbers_.size(); ++v)
      if (numbers_[v] == kNone) numbers_[v] = next(contour, v);
    edges_.end_part();
    polygons_.end_part();
    corners_.end_part();
  }
  template <class Key>
  void number_one(const Contour<N, Real>& contour, std::size_t v, const Key& key, const BetweenParts& where,
                  bool is_first_part, SharedNumbers<Key>& known) {
    const auto found = known.find(key, where);
    numbers_[v] = found ? *found : next(contour, v);
    known.add(key, numbers_[v], where, is_first_part);
  }
  /// The number of a new vertex.
  std::uint64_t next(const Contour<N, Real>& part, std::size_t v) {
    vertices_.push_back(part.vertices[v]);
    if (!part.normals.empty()) normals_.push_back(part.normals[v]);
    return output_.size().vertices + vertices_.size() - 1;
  }

  /// `near`: samples of the window near to missing ones, or empty.
  void pass(const Contour<N, Real>& contour, const VertexKeys& keys, const Layers& layers,
            const std::vector<bool>& near) {
    output_.add(vertices_, normals_);
    vertices_.clear();
    normals_.clear();
    std::vector<bool> touching;
    if (!near.empty()) {
      touching.resize(contour.vertices.size());
      for (std::size_t v = 0; v < keys.edges.size(); ++v) touching[v] = near[in_window(layers, keys.edges[v][0])];
      for (std::size_t i = 0; i < keys.corners.size(); ++i)
        touching[keys.before_caps + i] = near[in_window(layers, keys.corners[i])];
    }
    output_.add(contour, contour.simplices, numbers_, touching);
  }
  static void add_to(ExtractStats& stats, const ExtractStats& more) {
    stats.tiles += more.tiles;
    stats.active_tiles += more.active_tiles;
    stats.classify_seconds += more.classify_seconds;
    stats.find_seconds += more.find_seconds;
    stats.generate_seconds += more.generate_seconds;
    stats.close_seconds += more.close_seconds;
  }

  const Grid<N>& grid_;
  double isovalue_;
  Lattice lattice_;
  AxisPeriods<N> periods_;
  std::vector<Period<N>> contour_periods_;
  Output& output_;
  PartCells<N> cells_;
  std::size_t count_, layer_size_ = 1;
  SharedNumbers<Ends> edges_;
  SharedNumbers<Polygon> polygons_;
  SharedNumbers<std::uint64_t> corners_;
  std::vector<std::uint64_t> numbers_;  ///< by vertex of the part
  std::vector<std::array<Real, N>> vertices_, normals_;
};

}  // namespace tegl::detail
