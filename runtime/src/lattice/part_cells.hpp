// SPDX-License-Identifier: BSD-3-Clause
//
// The cells of some layers of an image on a lattice, for streams: a complex of their own, and its facets that are on
// the border of the whole lattice.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "complex/border_facets.hpp"
#include "complex/cell_groups.hpp"
#include "lattice/lattice_cells.hpp"
#include "lattice/periodic_lattice.hpp"

namespace tegl::detail {

/// The layers of a part: [begin, end) with those around its own, [first, last). If the last axis is periodic, layers
/// before 0 and behind the last one are those a period away.
struct PartLayers {
  std::ptrdiff_t begin, first, last, end;
};

/// The number of a layer in [0, count), modulo `count`.
[[nodiscard]] inline std::size_t layer_modulo(std::ptrdiff_t layer, std::size_t count) noexcept {
  const std::ptrdiff_t rest = layer % static_cast<std::ptrdiff_t>(count);
  return static_cast<std::size_t>(rest < 0 ? rest + static_cast<std::ptrdiff_t>(count) : rest);
}

/// The coordinates of the layers [begin, end) of an axis; `period`: 0, or that of the axis, which then continues.
[[nodiscard]] Axis axis_of_layers(const Axis& axis, double period, std::ptrdiff_t begin, std::ptrdiff_t end);

template <int N>
class PartCells {
 public:
  PartCells(const Grid<N>& grid, Lattice lattice, const AxisPeriods<N>& periods);

  struct Layer {
    std::size_t number;     ///< in the image
    std::size_t in_window;  ///< in PartLayers, from `begin` on
  };
  struct Made {
    Complex<N> complex;         ///< without values; its points are the samples of `layers`
    std::vector<Layer> layers;  ///< in ascending order of their numbers, so points are in the order of samples
    BorderFacets border = {};   ///< with `close`: the facets of no other cell of the whole lattice
  };
  /// The cells of the part's own layers, or between its own times and the next ones. Errors: those of
  /// `lattice_complex`, Cancelled.
  [[nodiscard]] Made of(const PartLayers& part, bool close, const WorkOptions& work);

 private:
  struct Range {
    std::ptrdiff_t from, to;
  };

  [[nodiscard]] Range own_cells(const PartLayers& part) const;
  /// All cells that may share a facet with these.
  [[nodiscard]] Range cells_around(const Range& own) const;
  [[nodiscard]] Range clipped(Range range, std::ptrdiff_t end) const;
  [[nodiscard]] std::vector<Layer> layers_of(const Range& points, const Range& own, const PartLayers& part) const;
  /// By point of `longer`: the point of the complex.
  [[nodiscard]] std::vector<Index> numbers_of(const Grid<N>& longer, const Range& points,
                                              const std::vector<Layer>& layers) const;
  [[nodiscard]] std::vector<std::array<double, N>> places_of(const std::vector<Layer>& layers) const;
  void make_layered(const Grid<N>& longer, const Range& points, const Range& own, const Range& around,
                    const WorkOptions* close, Made& made) const;
  void make_in_time(const Grid<N>& longer, const Range& points, const Range& own, const WorkOptions* close, Made& made);

  const Grid<N>& grid_;
  Lattice lattice_;
  AxisPeriods<N> periods_;
  std::ptrdiff_t count_;  ///< of layers
  std::array<std::size_t, 4> margin_{};
  std::optional<Complex<3>> at_a_time_ = {};  ///< fcc_in_time
};

}  // namespace tegl::detail
