// SPDX-License-Identifier: BSD-3-Clause
//
// Divides the cells of a grid into simplices.
#include "tegl/division.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <numeric>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "complex/image_points.hpp"
#include "tegl/error.hpp"

namespace tegl {
namespace {

constexpr CellType kSimplex[] = {CellType::triangle, CellType::tetrahedron, CellType::simplex4};

constexpr std::pair<Division, const char*> kNames[] = {{Division::kuhn, "kuhn"},
                                                       {Division::alternating, "alternating"},
                                                       {Division::symmetric, "symmetric"},
                                                       {Division::hybrid, "hybrid"}};

/// Collects the cells of a divided image, and the centres of faces.
template <int N>
class Divider {
 public:
  using Sample = std::array<std::size_t, N>;
  static constexpr unsigned kAll = (1u << N) - 1;

  Divider(const Grid<N>& grid, std::vector<double> values)
      : grid_(grid), sizes_(grid.sizes()), values_(std::move(values)) {
    for (int a = 1; a < N; ++a) strides_[a] = strides_[a - 1] * sizes_[a - 1];
    points_.reserve(values_.size());
    detail::for_each_sample<N>(sizes_, [&](const Sample& index) { points_.push_back(place(index, 0)); });
  }

  /// Calls work(lowest corner) for all cells.
  template <class Work>
  void for_cells(const Work& work) const {
    Sample cells = sizes_;
    for (std::size_t& size : cells) --size;
    detail::for_each_sample<N>(cells, work);
  }

  [[nodiscard]] Complex<N> complex() && {
    Complex<N> result = types_.empty() ? Complex<N>(std::move(points_), kSimplex[N - 2], corners_)
                                       : Complex<N>(std::move(points_), types_, corners_);
    result.set_values(std::move(values_));
    return result;
  }

  /// Kuhn's simplices: for each order of the axes, the path along them.
  void add_paths(const Sample& at) {
    std::array<int, N> order;
    std::iota(order.begin(), order.end(), 0);
    do {
      std::array<Index, N + 1> simplex{corner(at, 0)};
      unsigned mask = 0;
      for (int j = 0; j < N; ++j) simplex[j + 1] = corner(at, mask |= 1u << order[j]);
      add(simplex);
    } while (std::next_permutation(order.begin(), order.end()));
  }

  /// The corners of one parity and their simplices; in the middle, in 3D, the simplex of the other corners.
  void add_alternating(const Sample& at) {
    const auto odd = static_cast<unsigned>(std::accumulate(at.begin(), at.end(), std::size_t{0}) % 2);
    std::vector<Index> middle;
    for (unsigned v = 0; v <= kAll; ++v) {
      if (static_cast<unsigned>(std::popcount(v)) % 2 == odd) {
        if (N == 3) middle.push_back(corner(at, v));
        continue;
      }
      std::array<Index, N + 1> simplex{corner(at, v)};
      for (int a = 0; a < N; ++a) simplex[a + 1] = corner(at, v ^ 1u << a);
      add(simplex);
    }
    if (N == 3) append(middle);
  }

  /// The simplices of the face along `axes` at `base`, as a cone from its centre, with `apexes` of larger faces.
  void add_cones(const Sample& base, unsigned axes, std::vector<Index>& apexes) {
    if (std::popcount(axes) == 1) {
      apexes.push_back(corner(base, 0));
      apexes.push_back(corner(base, axes));
      append(apexes);
      apexes.resize(apexes.size() - 2);
      return;
    }
    apexes.push_back(centre(base, axes));
    for_facets(base, axes, [&](const Sample& facet, unsigned along) { add_cones(facet, along, apexes); });
    apexes.pop_back();
  }

  /// The cell whole or, if it is ambiguous, as a cone from its centre over whole faces and cones of ambiguous ones.
  void add_hybrid(const Sample& at, double isovalue) {
    const unsigned high = signature(at, kAll, isovalue);
    if (!is_ambiguous(high, N)) {
      append_cell(N == 2 ? CellType::pixel : CellType::voxel, at, kAll, nullptr);
      return;
    }
    const Index apex = centre(at, kAll);
    for_facets(at, kAll, [&](const Sample& facet, unsigned along) {
      std::vector<Index> apexes{apex};
      if (N == 2 || is_ambiguous(signature(facet, along, isovalue), N - 1)) {
        types_.resize(types_.size() + (N == 2 ? 1 : 4), kSimplex[N - 2]);
        add_cones(facet, along, apexes);
      } else {
        append_cell(CellType::pyramid, facet, along, &apex);
      }
    });
  }

 private:
  [[nodiscard]] std::array<double, N> place(const Sample& index, unsigned axes) const {
    std::array<double, N> x;
    for (int a = 0; a < N; ++a) {
      x[a] = grid_.axes[a][index[a]];
      if ((axes >> a & 1u) != 0) x[a] = 0.5 * (x[a] + grid_.axes[a][index[a] + 1]);
    }
    return detail::place_in_world<N>(grid_, x);
  }
  [[nodiscard]] Index corner(const Sample& at, unsigned axes) const {
    std::size_t number = 0;
    for (int a = 0; a < N; ++a) number += (at[a] + (axes >> a & 1u)) * strides_[a];
    return static_cast<Index>(number);
  }
  template <class Work>
  static void for_facets(const Sample& base, unsigned axes, const Work& work) {
    for (int a = 0; a < N; ++a) {
      if ((axes >> a & 1u) == 0) continue;
      Sample facet = base;
      work(facet, axes & ~(1u << a));
      ++facet[a];
      work(facet, axes & ~(1u << a));
    }
  }
  /// The corners of a face, as masks of axes, ascending.
  static std::vector<unsigned> masks_of(unsigned axes) {
    std::vector<unsigned> masks;
    for (unsigned v = 0; v <= axes; ++v)
      if ((v & ~axes) == 0) masks.push_back(v);
    return masks;
  }
  [[nodiscard]] unsigned signature(const Sample& base, unsigned axes, double isovalue) const {
    unsigned result = 0;
    const std::vector<unsigned> masks = masks_of(axes);
    for (std::size_t v = 0; v < masks.size(); ++v)
      result |= (values_[corner(base, masks[v])] >= isovalue ? 1u : 0u) << v;
    return result;
  }
  /// Whether the high or the low corners of a face are not connected along its edges.
  static bool is_ambiguous(unsigned high, int dim) {
    const unsigned all = (1u << (1u << dim)) - 1;
    const auto is_connected = [&](unsigned corners) {
      unsigned reached = corners & (~corners + 1);
      for (unsigned before = 0; reached != before;) {
        before = reached;
        for (int v = 0; v < 1 << dim; ++v)
          for (int a = 0; a < dim && (before >> v & 1u) != 0; ++a) reached |= 1u << (v ^ 1 << a) & corners;
      }
      return reached == corners;
    };
    return !is_connected(high) || !is_connected(all & ~high);
  }

  /// The centre of a face. Its value is the mean of the corners.
  Index centre(const Sample& base, unsigned axes) {
    const auto [found, is_new] = centres_[axes].try_emplace(corner(base, 0), static_cast<Index>(points_.size()));
    if (!is_new) return found->second;
    if (points_.size() >= std::numeric_limits<Index>::max())
      throw Error(ErrorCode::TooLarge, "2^32 points of a divided image or more; expected fewer");
    points_.push_back(place(base, axes));
    double sum = 0.0;
    const std::vector<unsigned> masks = masks_of(axes);
    for (const unsigned mask : masks) sum += values_[corner(base, mask)] / static_cast<double>(masks.size());
    values_.push_back(sum);
    return found->second;
  }

  void add(const std::array<Index, N + 1>& simplex) { append(simplex); }
  void append(std::span<const Index> corners) {
    corners_.insert(corners_.end(), corners.begin(), corners.end());
    if (corners_.size() / (N + 1) >= std::numeric_limits<Index>::max())
      throw Error(ErrorCode::TooLarge, "2^32 cells of a divided image or more; expected fewer");
  }
  void append_cell(CellType type, const Sample& base, unsigned axes, const Index* apex) {
    types_.push_back(type);
    std::vector<Index> corners;
    for (const unsigned mask : masks_of(axes)) corners.push_back(corner(base, mask));
    if (apex != nullptr) {
      std::swap(corners[2], corners[3]);  // around the base
      corners.push_back(*apex);
    }
    append(corners);
  }

  const Grid<N>& grid_;
  Sample sizes_, strides_{1};
  std::vector<std::array<double, N>> points_;
  std::vector<double> values_;
  std::vector<CellType> types_;  ///< empty: all cells are simplices
  std::vector<Index> corners_;
  std::array<std::unordered_map<Index, Index>, kAll + 1> centres_;  ///< by axes and lowest corner
};

template <int N>
Complex<N> divided(const Grid<N>& grid, std::vector<double> values, Division division, double isovalue) {
  Divider<N> divider(grid, std::move(values));
  std::vector<Index> apexes;
  divider.for_cells([&](const std::array<std::size_t, N>& at) {
    switch (division) {
      case Division::kuhn:
        return divider.add_paths(at);
      case Division::alternating:
        return divider.add_alternating(at);
      case Division::symmetric:
        return divider.add_cones(at, Divider<N>::kAll, apexes);
      case Division::hybrid:
        return divider.add_hybrid(at, isovalue);
    }
  });
  return std::move(divider).complex();
}

}  // namespace

std::string_view name_of(Division division) noexcept {
  const auto* const found =
      std::find_if(std::begin(kNames), std::end(kNames), [&](const auto& each) { return each.first == division; });
  return found == std::end(kNames) ? "unknown" : found->second;
}

template <Value T, int N>
requires DimensionBetween<N, 2, 4> Complex<N> divided_complex(const Image<T, N>& image, Division division,
                                                              double isovalue) {
  if (N == 4 && (division == Division::alternating || division == Division::hybrid))
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("division {} of a 4D image; expected kuhn or symmetric", name_of(division)));
  (void)detail::count_samples(image.grid(), "a divided image");
  return divided(image.grid(), detail::values_of(image), division, isovalue);
}

#define TEGL_INSTANTIATE(T)                                                        \
  template Complex<2> divided_complex<T, 2>(const Image<T, 2>&, Division, double); \
  template Complex<3> divided_complex<T, 3>(const Image<T, 3>&, Division, double); \
  template Complex<4> divided_complex<T, 4>(const Image<T, 4>&, Division, double);
#include "base/instantiate.hpp"

}  // namespace tegl
