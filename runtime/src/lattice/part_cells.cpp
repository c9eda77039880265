// SPDX-License-Identifier: BSD-3-Clause
//
// As in periodic_lattice.cpp, periodic axes are longer by a margin whose samples become those that they repeat. The
// points of a part keep the order of the image's samples, on which triangulations and rounding depend.
#include "lattice/part_cells.hpp"

#include <algorithm>
#include <map>
#include <span>
#include <utility>

#include "lattice/lattice_grid.hpp"
#include "lattice/lattice_in_time.hpp"
#include "periodic/periodic_layers.hpp"

namespace tegl::detail {

namespace {

/// Cells extend over three layers at most behind the one before theirs: two with a common facet are this close.
constexpr std::ptrdiff_t kNear = 3;

/// Numbers of cells by shape.
using Counts = std::map<tables::CellShape, std::size_t>;

/// The facets of `own`, whose cells come after `before` cells of the same shape in `all`.
BorderFacets border_of_part(const CellGroups& all, std::size_t points, const CellGroups& own, Counts before,
                            const WorkOptions& work) {
  BorderFacets border;
  for (const BorderFacet& facet : find_border(points, all, work)) {
    const tables::CellShape shape = all.groups[facet.group].shape;
    const auto group =
        std::find_if(own.groups.begin(), own.groups.end(), [&](const CellGroup& each) { return each.shape == shape; });
    if (group == own.groups.end() || facet.cell < before[shape] || facet.cell - before[shape] >= group->size())
      continue;
    border.push_back({static_cast<std::uint32_t>(group - own.groups.begin()),
                      static_cast<Index>(facet.cell - before[shape]), facet.facet});
  }
  return border;
}

void append(const LatticeCells& cells, LatticeCells& to) {
  to.types.insert(to.types.end(), cells.types.begin(), cells.types.end());
  to.corners.insert(to.corners.end(), cells.corners.begin(), cells.corners.end());
}

}  // namespace

Axis axis_of_layers(const Axis& axis, double period, std::ptrdiff_t begin, std::ptrdiff_t end) {
  const auto count = static_cast<std::size_t>(end - begin);
  if (period == 0.0) return axis.part(static_cast<std::size_t>(begin), count);
  const double turn = axis.is_descending() ? -period : period;
  std::vector<double> coordinates;
  for (std::ptrdiff_t k = begin; k < end; ++k) {
    const std::size_t layer = layer_modulo(k, axis.size());
    const std::ptrdiff_t turns = (k - static_cast<std::ptrdiff_t>(layer)) / static_cast<std::ptrdiff_t>(axis.size());
    coordinates.push_back(axis[layer] + static_cast<double>(turns) * turn);
  }
  return Axis::rectilinear(std::move(coordinates));
}

template <int N>
PartCells<N>::PartCells(const Grid<N>& grid, Lattice lattice, const AxisPeriods<N>& periods)
    : grid_(grid), lattice_(lattice), periods_(periods), count_(static_cast<std::ptrdiff_t>(grid.axes[N - 1].size())) {
  for (int a = 0; a + 1 < N; ++a)
    if (periods[a] != 0.0) margin_[a] = kLatticeMargin;
}

template <int N>
typename PartCells<N>::Range PartCells<N>::clipped(Range range, std::ptrdiff_t end) const {
  if (periods_[N - 1] != 0.0) return range;
  return {std::max<std::ptrdiff_t>(range.from, 0), std::min(range.to, end)};
}

template <int N>
typename PartCells<N>::Range PartCells<N>::own_cells(const PartLayers& part) const {
  return clipped({part.first, part.last}, lattice_ == Lattice::fcc_in_time ? count_ - 1 : count_);
}

template <int N>
typename PartCells<N>::Range PartCells<N>::cells_around(const Range& own) const {
  const bool is_in_time = lattice_ == Lattice::fcc_in_time;
  const std::ptrdiff_t near = is_in_time ? 1 : kNear;
  const Range around = clipped({own.from - near, own.to + near}, is_in_time ? count_ - 1 : count_);
  if (around.to - around.from <= count_) return around;
  const std::ptrdiff_t from = own.from - std::min(near, count_ - (own.to - own.from));
  return {from, from + count_};  // all, once
}

template <int N>
std::vector<typename PartCells<N>::Layer> PartCells<N>::layers_of(const Range& points, const Range& own,
                                                                  const PartLayers& part) const {
  std::map<std::size_t, std::size_t> windows;  // of the layers near to the own ones, if there are several
  const auto add = [&](std::ptrdiff_t k) {
    windows.try_emplace(layer_modulo(k, static_cast<std::size_t>(count_)), static_cast<std::size_t>(k - part.begin));
  };
  for (std::ptrdiff_t k = std::max(points.from, own.from - 1); k < std::min(points.to, own.to + 2); ++k) add(k);
  for (std::ptrdiff_t k = points.from; k < points.to; ++k) add(k);
  std::vector<Layer> layers;
  for (const auto& [number, in_window] : windows) layers.push_back({number, in_window});
  return layers;
}

template <int N>
std::vector<Index> PartCells<N>::numbers_of(const Grid<N>& longer, const Range& points,
                                            const std::vector<Layer>& layers) const {
  const auto sizes = grid_.sizes();
  std::vector<Index> numbers;
  for_each_sample<N>(longer.sizes(), [&](const std::array<std::size_t, N>& index) {
    const std::size_t layer =
        layer_modulo(points.from + static_cast<std::ptrdiff_t>(index[N - 1]), static_cast<std::size_t>(count_));
    const auto found = std::lower_bound(layers.begin(), layers.end(), layer,
                                        [](const Layer& each, std::size_t number) { return each.number < number; });
    auto at = static_cast<std::size_t>(found - layers.begin());
    for (int a = N - 2; a >= 0; --a) at = at * sizes[a] + (index[a] + sizes[a] - margin_[a]) % sizes[a];
    numbers.push_back(static_cast<Index>(at));
  });
  return numbers;
}

template <int N>
std::vector<std::array<double, N>> PartCells<N>::places_of(const std::vector<Layer>& layers) const {
  auto sizes = grid_.sizes();
  sizes[N - 1] = layers.size();
  std::vector<std::array<double, N>> places;
  for_each_sample<N>(sizes, [&](std::array<std::size_t, N> index) {
    index[N - 1] = layers[index[N - 1]].number;
    places.push_back(lattice_place<N>(grid_, index, layer_axis(lattice_)));
  });
  return places;
}

template <int N>
typename PartCells<N>::Made PartCells<N>::of(const PartLayers& part, bool close, const WorkOptions& work) {
  const Range own = own_cells(part), around = close ? cells_around(own) : own;
  Range points{around.from, around.to + 1};
  if (lattice_ != Lattice::fcc_in_time) {
    points = clipped({around.from - 1, around.to + 2}, count_);
    points.from -= points.from & 1;  // so that odd layers are the image's
  }
  Grid<N> longer = grid_;
  for (int a = 0; a + 1 < N; ++a)
    if (margin_[a] != 0) longer.axes[a] = wrapped_axis(grid_.axes[a], periods_[a], kLatticeMargin, kLatticeMargin);
  longer.axes[N - 1] = axis_of_layers(grid_.axes[N - 1], periods_[N - 1], points.from, points.to);
  (void)count_samples(longer, "a part of a lattice");
  Made made{Complex<N>({}, std::span<const CellType>(), {}), layers_of(points, own, part)};
  const WorkOptions* const to_close = close ? &work : nullptr;
  if (lattice_ == Lattice::fcc_in_time)
    make_in_time(longer, points, own, to_close, made);
  else
    make_layered(longer, points, own, around, to_close, made);
  return made;
}

template <int N>
void PartCells<N>::make_layered(const Grid<N>& longer, const Range& points, const Range& own, const Range& around,
                                const WorkOptions* close, Made& made) const {
  const auto cells_of = [&](std::ptrdiff_t from, std::ptrdiff_t to) {
    return cells_of_lattice(lattice_, four_sizes(longer), margin_,
                            {static_cast<std::size_t>(from - points.from), static_cast<std::size_t>(to - points.from)});
  };
  const LatticeCells cells = cells_of(own.from, own.to);
  made.complex = Complex<N>(points_of(longer, N - 1), cells.types, cells.corners);
  std::vector<Index> numbers;
  if (periodic_axes<N>(periods_) != 0) {
    numbers = numbers_of(longer, points, made.layers);
    made.complex = ComplexAccess::identified<N>(made.complex, places_of(made.layers), {}, numbers);
  }
  if (close == nullptr) return;
  LatticeCells all = cells_of(around.from, own.from);
  Counts before;
  for (const CellType type : all.types) ++before[find_kind(type)->shape];
  append(cells, all);
  append(cells_of(own.to, around.to), all);
  if (!numbers.empty())
    for (Index& corner : all.corners) corner = numbers[corner];
  const std::size_t count = made.complex.points().size();
  made.border = border_of_part(group_cells(N, count, all.types, all.corners), count, ComplexAccess::cells(made.complex),
                               std::move(before), *close);
}

template <int N>
void PartCells<N>::make_in_time(const Grid<N>& longer, const Range& points, const Range& own, const WorkOptions* close,
                                Made& made) {
  if constexpr (N == 4) {
    if (!at_a_time_) at_a_time_ = fcc_at_a_time(longer, margin_);
    const std::size_t at_a_time = at_a_time_->points().size();
    const auto prisms = [&](std::ptrdiff_t from, std::ptrdiff_t to) {
      Grid<N> times = longer;
      times.axes[N - 1] = axis_of_layers(grid_.axes[N - 1], periods_[N - 1], from, to + 1);
      const std::vector<double> no_values(at_a_time * times.axes[N - 1].size());
      return fcc_over_times(*at_a_time_, times, no_values);
    };
    made.complex = prisms(own.from, own.to);
    const bool is_periodic = periodic_axes<N>(periods_) != 0;
    if (!is_periodic && close == nullptr) return;
    const std::size_t skipped = static_cast<std::size_t>(own.from - points.from) * at_a_time;
    const std::vector<Index> numbers = numbers_of(longer, points, made.layers);
    const Complex<N> all = prisms(points.from, points.to - 1);
    const auto of_own = std::span(numbers).subspan(skipped, made.complex.points().size());
    made.complex =
        ComplexAccess::identified<N>(made.complex, is_periodic ? places_of(made.layers) : all.points(), {}, of_own);
    // As in memory, layers do not stay apart if the last axis is periodic.
    if (periods_[N - 1] != 0.0) made.complex = ComplexAccess::at_places<N>(made.complex, made.complex.points());
    if (close == nullptr) return;
    const std::size_t intervals_before = static_cast<std::size_t>(own.from - points.from);
    Counts before;
    for (const CellGroup& group : ComplexAccess::cells(*at_a_time_).groups)
      before[prism_of(group.shape)] = intervals_before * group.size();
    const Complex<N> identified = ComplexAccess::identified<N>(all, made.complex.points(), {}, numbers);
    made.border = border_of_part(ComplexAccess::cells(identified), made.complex.points().size(),
                                 ComplexAccess::cells(made.complex), std::move(before), *close);
  }
}

template class PartCells<2>;
template class PartCells<3>;
template class PartCells<4>;

}  // namespace tegl::detail
