// SPDX-License-Identifier: BSD-3-Clause
//
// Lists the crossed edges and, if all vertices are on edges, the simplices of each signature of a shape.
#include <algorithm>
#include <array>

#include "complex/cell_cases.hpp"

namespace tegl::detail {

void CellCases::add_cases() {
  const unsigned signatures = 1u << table_->corner_count;
  is_plain_ = resolved_ == nullptr && built_ == nullptr && table_->max_added == 0;
  cases_.resize(signatures);
  for (unsigned s = 0; s < signatures; ++s) {
    Case& of = cases_[s];
    of.first_edge = static_cast<std::uint32_t>(edges_.size());
    std::array<std::uint8_t, 32> ordinal_of{};
    for (std::uint32_t edges = crossed_edges(*table_, s); edges != 0; edges &= edges - 1) {
      const auto e = static_cast<std::uint8_t>(std::countr_zero(edges));
      ordinal_of[e] = of.crossings++;
      edges_.push_back(e);
    }
    if (table_->edge_count <= std::tuple_size_v<Picks>)
      std::copy_n(edges_.begin() + of.first_edge, of.crossings, picks_.emplace_back().begin());
    of.first_simplex = static_cast<std::uint32_t>(ordinals_[0].size());
    if (!is_plain_) continue;
    const CellContour contour = (*this)[s];
    of.simplices = static_cast<std::uint8_t>(contour.list().simplex_count);
    const std::size_t dim = table_->dim;
    for (unsigned i = 0; i < of.simplices; ++i)
      for (const bool flip : {false, true}) {
        std::vector<std::uint8_t>& list = ordinals_[flip ? 1 : 0];
        for (unsigned k = 0; k < dim; ++k) list.push_back(ordinal_of[contour.vertex(i, k)]);
        if (contour.reverses() != flip) std::swap(list[list.size() - 1], list[list.size() - 2]);
      }
  }
}

}  // namespace tegl::detail
