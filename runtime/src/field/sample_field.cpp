// SPDX-License-Identifier: BSD-3-Clause
//
// Samples of fields, row by row in parallel.
#include <fmt/format.h>

#include "base/workers.hpp"
#include "field/field_parts.hpp"

namespace tegl::detail {

void sample_field_layer(const Field& field, const std::vector<const Axis*>& axes, int shifted, std::size_t layer,
                        unsigned threads, float* out) {
  const std::size_t dim = axes.size();
  const std::size_t width = axes[0]->size();
  std::size_t rows = 1;
  for (std::size_t a = 1; a + 1 < dim; ++a) rows *= axes[a]->size();
  Workers<std::vector<double>> workers(threads, [] { return std::vector<double>(); });
  workers.for_range(rows, 1, [&](std::size_t from, std::size_t to, std::vector<double>& values) {
    values.resize(width);
    for (std::size_t r = from; r < to; ++r) {
      std::array<std::size_t, kMostCoordinates> index{};
      index[dim - 1] = layer;
      for (std::size_t a = 1, rest = r; a + 1 < dim; rest /= axes[a]->size(), ++a) index[a] = rest % axes[a]->size();
      const bool moved = shifted >= 0 && index[static_cast<std::size_t>(shifted)] % 2 == 1;
      FieldPoint start{};
      for (std::size_t a = 0; a < dim; ++a) {
        start[a] = (*axes[a])[index[a]];
        if (moved && static_cast<int>(a) < shifted) start[a] += axes[a]->step() / 2;
      }
      if (axes[0]->is_uniform()) {
        field.row(start.data(), axes[0]->step(), width, values.data());
      } else {
        for (std::size_t i = 0; i < width; ++i) {
          start[0] = (*axes[0])[i];
          field.row(start.data(), 0.0, 1, values.data() + i);
        }
      }
      for (std::size_t i = 0; i < width; ++i) out[r * width + i] = static_cast<float>(values[i]);
    }
  });
}

void require_field(const Field& field, int dim, std::optional<Lattice> lattice) {
  if (field.dim() != dim)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("a field in {} dimensions on a grid in {}; expected the same", field.dim(), dim));
  if (lattice && dimension(*lattice) != dim)
    throw Error(ErrorCode::InvalidArgument, fmt::format("the lattice {} in {} dimensions; expected {}",
                                                        name_of(*lattice), dim, dimension(*lattice)));
}

}  // namespace tegl::detail
