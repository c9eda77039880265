// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of a lattice's cells part by part, for streams: the cells of some layers are a complex of their own.
// Vertices of the complex before are known by their keys, the ends of their edge or the vertices of their polygon.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "complex/cell_groups.hpp"
#include "complex/contour_numbers.hpp"
#include "complex/image_points.hpp"
#include "complex/point_gradients.hpp"
#include "image/row_source.hpp"
#include "lattice/lattice_cells.hpp"
#include "lattice/lattice_gradients.hpp"
#include "lattice/lattice_grid.hpp"
#include "lattice/lattice_in_time.hpp"
#include "tegl/stream.hpp"

namespace tegl::detail {

/// The layers of a part: [begin, end) with those around its own, [first, last).
struct PartLayers {
  std::size_t begin, first, last, end;
};

/// Passes the contour of the cells of one part after the other to a sink.
template <class Real, int N>
class CellParts {
 public:
  CellParts(const StreamedContour<N, Real>& contour, Lattice lattice) : contour_(contour), lattice_(lattice) {}

  /// `image`: the layers [part.begin, part.end) of the image on `grid`. Errors: those of `lattice_complex` and
  /// `extract`, and of the sink. Calls `refuse_missing`, which throws, if a value is missing.
  template <Value T, class RefuseMissing>
  void add(const Image<T, N>& image, const Grid<N>& grid, const PartLayers& part, const ExtractOptions& options,
           const RefuseMissing& refuse_missing) {
    if (lattice_ == Lattice::fcc_in_time && part.first + 1 == part.end) return;  // no interval is left
    const auto [complex, first_point] = cells_of(image, part);
    if (std::any_of(complex.values().begin(), complex.values().end(), [](double value) { return std::isnan(value); }))
      refuse_missing();
    Grid<N> at_start = image.grid();  // weights of gradients as for the whole image
    if (grid.axes[N - 1].is_uniform()) at_start.axes[N - 1] = grid.axes[N - 1].part(0, image.size(N - 1));
    const Image<T, N> around_part(image.data(), at_start, image.strides());
    const ImageSource<T, N> source(around_part, contour_.isovalue, options.epsilon);
    std::optional<LatticeGradients<N>> gradients;
    Surroundings<N> around;
    VertexKeys keys;
    around.keys = &keys;
    if (options.normals != Normals::none) {
      gradients.emplace(source, at_start, lattice_, options.direction);
      const std::size_t skipped = first_point - part.begin * layer_size(image.grid());
      around.gradient = [&gradients, skipped, sizes = image.grid().sizes()](Index p) {
        std::size_t at = p + skipped;
        std::array<std::size_t, N> index;
        for (int a = 0; a < N; at /= sizes[a], ++a) index[a] = at % sizes[a];
        return gradients->at(index);
      };
    }
    const auto made = extract_in<Real>(complex, contour_.isovalue, options, around);
    pass(made.contour, keys, first_point, part, layer_size(image.grid()), options.normals != Normals::none);
    add_stats(made.stats);
  }
  [[nodiscard]] const ContourSize& size() const noexcept { return size_; }
  [[nodiscard]] const ExtractStats& stats() const noexcept { return stats_; }

 private:
  using Ends = std::array<std::uint64_t, 2>;      ///< numbers of samples
  using Polygon = std::array<std::uint64_t, 12>;  ///< numbers of vertices, ascending; unused ones are kNone
  static constexpr std::uint64_t kNone = ~std::uint64_t{0};

  static std::size_t layer_size(const Grid<N>& grid) noexcept {
    std::size_t size = 1;
    for (int a = 0; a + 1 < N; ++a) size *= grid.axes[a].size();
    return size;
  }

  /// The cells of a part, and the number of its first point in the whole image.
  template <Value T>
  std::pair<Complex<N>, std::size_t> cells_of(const Image<T, N>& image, const PartLayers& part) {
    const bool is_in_time = lattice_ == Lattice::fcc_in_time;
    // prisms are between their time and the next one, other cells between the layers before and behind theirs
    const std::size_t from = is_in_time ? part.first : part.first - std::min<std::size_t>(part.first, 2);
    const std::size_t to = std::min(part.last + 1, part.end), skipped = from - part.begin;
    Grid<N> grid = image.grid();
    grid.axes[N - 1] = image.grid().axes[N - 1].part(skipped, to - from);
    const Image<T, N> of_part(image.data() + static_cast<std::ptrdiff_t>(skipped) * image.strides()[N - 1], grid,
                              image.strides());
    const std::size_t first_point = from * layer_size(grid);
    if constexpr (N == 4)
      if (is_in_time) {
        if (!at_a_time_) at_a_time_ = fcc_at_a_time(grid);
        return {fcc_over_times(*at_a_time_, grid, values_of(of_part)), first_point};
      }
    const LatticeCells cells = cells_of_lattice(lattice_, four_sizes(grid), {}, {part.first - from, part.last - from});
    Complex<N> complex(points_of(grid, N - 1), cells.types, cells.corners);
    complex.set_values(values_of(of_part));
    return {std::move(complex), first_point};
  }

  /// Passes the vertices that no part had before, and the simplices.
  void pass(const Contour<N, Real>& part, const VertexKeys& keys, std::size_t first_point, const PartLayers& layers,
            std::size_t layer, bool normals) {
    numbers_.assign(part.vertices.size(), kNone);
    // Cells have corners in the layer before theirs, except prisms.
    const std::uint64_t known_to = (layers.first + 1) * layer;
    const std::uint64_t kept_from = (lattice_ == Lattice::fcc_in_time ? layers.last : layers.last - 1) * layer;
    std::map<Ends, std::uint64_t> edges;
    std::map<Polygon, std::uint64_t> polygons;
    for (std::size_t v = 0; v < keys.edges.size(); ++v) {
      const Ends ends = {keys.edges[v][0] + first_point, keys.edges[v][1] + first_point};
      if (ends[1] < known_to)
        if (const auto found = edges_.find(ends); found != edges_.end()) numbers_[v] = found->second;
      if (numbers_[v] == kNone) numbers_[v] = next(part, v);
      if (ends[0] >= kept_from) edges.emplace_hint(edges.end(), ends, numbers_[v]);
    }
    const std::uint64_t first_shared = keys.edges.size();
    for (std::size_t i = 0; i < keys.polygons.size(); ++i) {
      const std::size_t v = first_shared + i;
      const PolygonKey& key = keys.polygons[i];
      if (key.back() == kInCube || key.back() == kInFacet) continue;  // in one cell each, at the border
      Polygon polygon;
      polygon.fill(kNone);
      bool may_be_known = true, is_kept = true;
      for (std::size_t k = 0; k < key.size() && key[k] != kNoPoint; ++k) {
        polygon[k] = numbers_[key[k]];
        may_be_known = may_be_known && keys.edges[key[k]][1] + first_point < known_to;
        is_kept = is_kept && keys.edges[key[k]][0] + first_point >= kept_from;
      }
      std::sort(polygon.begin(), polygon.end());
      if (may_be_known)
        if (const auto found = polygons_.find(polygon); found != polygons_.end()) numbers_[v] = found->second;
      if (numbers_[v] == kNone) numbers_[v] = next(part, v);
      if (is_kept) polygons.emplace(polygon, numbers_[v]);
    }
    for (std::size_t v = first_shared; v < part.vertices.size(); ++v)
      if (numbers_[v] == kNone) numbers_[v] = next(part, v);
    edges_ = std::move(edges);
    polygons_ = std::move(polygons);
    send(part, normals);
  }
  /// The number of a new vertex.
  std::uint64_t next(const Contour<N, Real>& part, std::size_t v) {
    vertices_.push_back(part.vertices[v]);
    if (!part.normals.empty()) normals_.push_back(part.normals[v]);
    return size_.vertices++;
  }
  void send(const Contour<N, Real>& part, bool normals) {
    contour_.sink->add_vertices(vertices_);
    if (normals) contour_.sink->add_normals(normals_);
    vertices_.clear();
    normals_.clear();
    simplices_.clear();
    for (const auto& simplex : part.simplices) {
      auto& wide = simplices_.emplace_back();
      for (int j = 0; j < N; ++j) wide[j] = numbers_[simplex[j]];
    }
    contour_.sink->add_simplices(simplices_);
    size_.simplices += simplices_.size();
  }
  void add_stats(const ExtractStats& stats) {
    stats_.tiles += stats.tiles;
    stats_.active_tiles += stats.active_tiles;
    stats_.classify_seconds += stats.classify_seconds;
    stats_.find_seconds += stats.find_seconds;
    stats_.generate_seconds += stats.generate_seconds;
  }

  StreamedContour<N, Real> contour_;
  Lattice lattice_;
  std::optional<Complex<3>> at_a_time_;  ///< fcc_in_time
  // those that later parts may have
  std::map<Ends, std::uint64_t> edges_;
  std::map<Polygon, std::uint64_t> polygons_;
  std::vector<std::uint64_t> numbers_;  ///< by vertex of the part
  std::vector<std::array<Real, N>> vertices_, normals_;
  std::vector<typename ContourSink<N, Real>::Simplex> simplices_;
  ContourSize size_;
  ExtractStats stats_;
};

}  // namespace tegl::detail
