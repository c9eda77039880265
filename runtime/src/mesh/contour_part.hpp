// SPDX-License-Identifier: BSD-3-Clause
//
// Copies a part of a contour with its normals and attributes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "base/progress.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// Copies the rows with these numbers.
template <class Row>
void gather(const Buffer<Row>& from, std::span<const Index> items, Buffer<Row>& to, CountedProgress& copied) {
  to.resize(items.size());
  in_parts(items.size(), {}, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) to[i] = from[items[i]];
    copied.add(end - first);
  });
}

/// Appends the attributes of the items with these numbers.
inline void gather_attributes(const std::vector<Attribute>& from, std::span<const Index> items,
                              std::vector<Attribute>& to, CountedProgress& copied) {
  for (const Attribute& attribute : from) {
    Attribute& copy = to.emplace_back(Attribute{attribute.name, attribute.unit, attribute.width, {}});
    const auto width = static_cast<std::size_t>(attribute.width);
    copy.values.resize(items.size() * width);
    in_parts(items.size(), {}, [&](std::size_t first, std::size_t end) {
      for (std::size_t i = first; i < end; ++i)
        std::copy_n(attribute.values.data() + items[i] * width, width, copy.values.data() + i * width);
      copied.add(end - first);
    });
  }
}

/// The part of a contour with these vertices and simplices. `number`: by vertex of the contour, its new number.
template <int N, class Real>
Contour<N, Real> part_of_contour(const Contour<N, Real>& contour, std::span<const Index> vertices,
                                 std::span<const Index> simplices, const Buffer<Index>& number,
                                 CountedProgress& copied) {
  Contour<N, Real> part;
  part.axis_names = contour.axis_names;
  part.axis_units = contour.axis_units;
  part.direction = contour.direction;
  part.periods = contour.periods;
  gather(contour.vertices, vertices, part.vertices, copied);
  if (!contour.normals.empty()) gather(contour.normals, vertices, part.normals, copied);
  gather(contour.simplices, simplices, part.simplices, copied);
  for (auto& simplex : part.simplices)
    for (Index& v : simplex) v = number[v];
  gather_attributes(contour.vertex_attributes, vertices, part.vertex_attributes, copied);
  gather_attributes(contour.simplex_attributes, simplices, part.simplex_attributes, copied);
  return part;
}

}  // namespace tegl::detail
