// SPDX-License-Identifier: BSD-3-Clause
//
// Connected components by parallel union-find over the simplices, their measures, and extraction of components.
//
// Based on: Zhu Jingwei, Meng Peisheng, Wang Cheng, An Improved Marching Cubes Algorithm, 2008, section 3.2. Their
// single-threaded seed fill gives the same labels, counted from 1.
#include "tegl/components.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/atomic_minimum.hpp"
#include "base/disjoint_sets.hpp"
#include "base/nearest_item.hpp"
#include "base/nearest_repetition.hpp"
#include "base/periods.hpp"
#include "base/workers.hpp"
#include "mesh/contour_part.hpp"
#include "mesh/incidence_data.hpp"
#include "mesh/measure_pieces.hpp"

namespace tegl {
namespace {

using detail::kBlock;

/// Number of rows that `part_of_contour` copies for this number of vertices and simplices.
template <int N, class Real>
std::uint64_t rows_to_copy(const Contour<N, Real>& contour, std::uint64_t vertices, std::uint64_t simplices) {
  return vertices * (1 + (contour.normals.empty() ? 0 : 1) + contour.vertex_attributes.size()) +
         simplices * (1 + contour.simplex_attributes.size());
}

/// Vertex numbers of simplices, for any dimension.
struct SimplexRows {
  std::span<const Index> numbers;  ///< #S x width, row = simplex
  std::size_t width;
  std::size_t vertices;  ///< number of vertices of the contour

  [[nodiscard]] std::size_t size() const noexcept { return numbers.size() / width; }
  [[nodiscard]] std::span<const Index> operator[](std::size_t s) const noexcept {
    return numbers.subspan(s * width, width);
  }
};

template <int N, class Real>
SimplexRows rows_of(const Contour<N, Real>& contour) noexcept {
  return {detail::SimplexView<N>(contour).rows(), N, contour.vertices.size()};
}

/// Sets a flag that other threads may set, too. Most are set already: then nothing is written, which would take the
/// cache line from the others.
void mark_shared(std::uint8_t& flag) noexcept {
  const std::atomic_ref<std::uint8_t> shared(flag);
  if (shared.load(std::memory_order_relaxed) == 0) shared.store(1, std::memory_order_relaxed);
}

/// Throws InvalidArgument unless the labels fit the contour: one per vertex and simplex, each below the count, each
/// used by a simplex, equal for a simplex and its vertices, and none for vertices in no simplex.
void require_labels(const SimplexRows& contour, const ComponentLabels& labels, const WorkOptions& work = {}) {
  detail::require_vertex_numbers(contour.numbers, contour.width, contour.vertices);
  const auto fail = [](const std::string& message) { throw Error(ErrorCode::InvalidArgument, message); };
  const auto require_count = [&](std::size_t found, std::size_t expected, const char* what) {
    if (found != expected)
      fail(fmt::format("labels for {} {}; expected {}, as many as the contour has", found, what, expected));
  };
  // counts
  require_count(labels.vertices.size(), contour.vertices, "vertices");
  require_count(labels.simplices.size(), contour.size(), "simplices");
  if (labels.count > contour.size())
    fail(fmt::format("{} components of {} simplices; expected the labels of this contour", labels.count,
                     contour.size()));
  // simplices and their vertices; then the first fault
  Buffer<std::uint8_t> is_in_simplex(contour.vertices), has_simplex(labels.count);
  std::fill(is_in_simplex.begin(), is_in_simplex.end(), std::uint8_t{0});
  std::fill(has_simplex.begin(), has_simplex.end(), std::uint8_t{0});
  std::atomic<std::size_t> first_fault = contour.size();
  detail::for_each_part(contour.size(), work.threads, work.progress, [&](std::size_t from, std::size_t to) {
    // copies, because the compiler must assume that writing a byte changes anything that it cannot see
    const SimplexRows rows = contour;
    const Index* const of_vertices = labels.vertices.data();
    const Index* const of_simplices = labels.simplices.data();
    std::uint8_t* const vertex_flags = is_in_simplex.data();
    std::uint8_t* const label_flags = has_simplex.data();
    const Index count = labels.count;
    Index last = kNoComponent;  // of the labels that have a simplex
    for (std::size_t s = from; s < to; ++s) {
      const Index label = of_simplices[s];
      bool is_sound = label < count;
      if (is_sound && label != last) mark_shared(label_flags[label]);
      last = label;
      for (std::size_t i = 0; is_sound && i < rows.width; ++i) {
        const Index v = rows.numbers[s * rows.width + i];
        mark_shared(vertex_flags[v]);
        is_sound = of_vertices[v] == label;
      }
      if (!is_sound) detail::lower_to(first_fault, s);
    }
  });
  if (const std::size_t s = first_fault; s < contour.size()) {
    const Index label = labels.simplices[s];
    if (label >= labels.count)
      fail(fmt::format("simplex {} has the label {}; expected less than {}, the number of components", s, label,
                       labels.count));
    for (const Index v : contour[s])
      if (labels.vertices[v] != label)
        fail(fmt::format("simplex {} has the label {}, and its vertex {} the label {}; expected the same", s, label, v,
                         labels.vertices[v]));
  }
  // vertices in no simplex, components without simplices
  for (std::size_t v = 0; v < is_in_simplex.size(); ++v)
    if (is_in_simplex[v] == 0 && labels.vertices[v] != kNoComponent)
      fail(fmt::format("vertex {} in no simplex has the label {}; expected none", v, labels.vertices[v]));
  if (const auto empty = std::find(has_simplex.begin(), has_simplex.end(), 0); empty != has_simplex.end())
    fail(fmt::format("component {} of {} has no simplex; expected the labels of this contour",
                     empty - has_simplex.begin(), labels.count));
}

/// Numbers the sets in the order of their roots, which are their smallest vertices. Vertices without `used` get
/// kNoComponent.
Index number_sets(detail::SharedDisjointSets& sets, const Buffer<std::uint8_t>& used, unsigned threads,
                  const Progress& progress, Buffer<Index>& labels) {
  labels.resize(used.size());
  detail::for_each_block(used.size(), kBlock, threads, progress, [&](std::size_t, std::size_t from, std::size_t to) {
    for (std::size_t v = from; v < to; ++v) labels[v] = used[v] != 0 ? sets.find(static_cast<Index>(v)) : kNoComponent;
  });
  Index count = 0;
  for (std::size_t v = 0; v < labels.size(); ++v) {  // a root comes before all others of its set
    if (labels[v] == kNoComponent) continue;
    labels[v] = labels[v] == v ? count++ : labels[labels[v]];
  }
  return count;
}

ComponentLabels label_rows(const SimplexRows& contour, const WorkOptions& work) {
  detail::require_vertex_numbers(contour.numbers, contour.width, contour.vertices);
  const std::size_t vertices = contour.vertices;
  const std::size_t simplices = contour.size();
  // merge the vertices of each simplex
  detail::SharedDisjointSets sets(vertices);
  Buffer<std::uint8_t> used(vertices);
  std::fill(used.begin(), used.end(), std::uint8_t{0});
  detail::for_each_block(simplices, kBlock, work.threads, detail::part_of(work.progress, 0.0, 0.7),
                         [&](std::size_t, std::size_t from, std::size_t to) {
                           for (std::size_t s = from; s < to; ++s)
                             for (const Index v : contour[s]) {
                               sets.join(contour[s][0], v);
                               mark_shared(used[v]);
                             }
                         });
  // number the sets, then label the simplices
  ComponentLabels labels;
  labels.count = number_sets(sets, used, work.threads, detail::part_of(work.progress, 0.7, 0.9), labels.vertices);
  labels.simplices.resize(simplices);
  detail::for_each_block(simplices, kBlock, work.threads, detail::part_of(work.progress, 0.9, 1.0),
                         [&](std::size_t, std::size_t from, std::size_t to) {
                           for (std::size_t s = from; s < to; ++s) labels.simplices[s] = labels.vertices[contour[s][0]];
                         });
  return labels;
}

/// `check_coordinates()` throws InvalidArgument unless they are finite. `incidence`: null if it is not known.
template <int N>
std::vector<Component<N>> measure_components(const detail::SimplexView<N>& contour, GradientDirection direction,
                                             const ComponentLabels& labels, const detail::IncidenceData<N>* incidence,
                                             const WorkOptions& work, detail::FunctionRef<void()> check_coordinates) {
  require_labels({contour.rows(), N, contour.vertex_count()}, labels,
                 {work.threads, detail::part_of(work.progress, 0.0, 0.05)});
  check_coordinates();
  // count faces by label
  const std::span<const Index> rows = contour.rows();
  std::vector<detail::FaceCounts> faces;
  if (incidence != nullptr) {
    faces = detail::count_faces<N>(*incidence, labels.vertices, labels.count);
  } else {
    const detail::Stars stars =
        detail::make_stars<N>(rows, contour.vertex_count(), work.threads, detail::part_of(work.progress, 0.05, 0.1));
    faces = detail::count_faces<N>(rows, stars, labels.vertices, labels.count, true, work.threads,
                                   detail::part_of(work.progress, 0.1, 0.8),
                                   [](std::size_t, const auto&) { /* counted */ });
  }
  // sums by label
  const std::vector<detail::PieceMeasures<N>> pieces = detail::measure_pieces<N>(
      contour, labels.vertices, labels.simplices, labels.count, work.threads, detail::part_of(work.progress, 0.8, 1.0));
  std::vector<Component<N>> result(labels.count);
  for (Index label = 0; label < labels.count; ++label) {
    const detail::PieceMeasures<N>& piece = pieces[label];
    Component<N>& component = result[label];
    component.label = label;
    component.vertices = piece.vertices;
    component.simplices = piece.simplices;
    component.size = piece.size;
    component.content = detail::content_of(piece, faces[label], direction);
    component.centroid = piece.centroid;
    component.lowest = piece.lowest;
    component.highest = piece.highest;
    component.euler = faces[label].euler;
    component.boundary_simplices = faces[label].boundary;
  }
  return result;
}

/// The vertices or simplices whose component is kept, ascending. `of`: their labels.
Buffer<Index> kept_items(const Buffer<Index>& of, const std::vector<bool>& keep, const Progress& progress) {
  Buffer<Index> items;
  detail::in_parts(of.size(), progress, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i)
      if (of[i] != kNoComponent && keep[of[i]]) items.push_back(static_cast<Index>(i));
  });
  return items;
}

/// Sets the attribute "component".
void add_labels(const Buffer<Index>& of, std::vector<Attribute>& attributes) {
  std::erase_if(attributes, [](const Attribute& attribute) { return attribute.name == "component"; });
  Attribute& attribute = attributes.emplace_back(Attribute{"component", "", 1, {}});
  attribute.values.resize(of.size());
  for (std::size_t i = 0; i < of.size(); ++i)
    attribute.values[i] = of[i] == kNoComponent ? -1.0 : static_cast<double>(of[i]);
}

}  // namespace

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5> ComponentLabels label_components(const Contour<N, Real>& contour,
                                                                    const WorkOptions& work) {
  return label_rows(rows_of(contour), work);
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5> std::vector<Component<N>> components(const Contour<N, Real>& contour,
                                                                        const ComponentLabels& labels,
                                                                        const WorkOptions& work) {
  return measure_components<N>(detail::SimplexView<N>(contour), contour.direction, labels, nullptr, work,
                               [&] { detail::require_finite(contour); });
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5> std::vector<Component<N>> components(const Contour<N, Real>& contour,
                                                                        const ComponentLabels& labels,
                                                                        const Incidence<N>& incidence,
                                                                        const WorkOptions& work) {
  const detail::SimplexView<N> view(contour);
  detail::require_incidence<N>(incidence.data(), view.rows(), view.vertex_count());
  return measure_components<N>(view, contour.direction, labels, &incidence.data(), work,
                               [&] { detail::require_finite(contour); });
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5> std::vector<Contour<N, Real>> split_components(const Contour<N, Real>& contour,
                                                                                  const ComponentLabels& labels,
                                                                                  const WorkOptions& work) {
  using detail::part_of;
  const Progress& progress = work.progress;
  require_labels(rows_of(contour), labels, {work.threads, part_of(progress, 0.0, 0.2)});
  detail::require_attributes(contour);
  const detail::Groups vertices = detail::group_by(labels.vertices, labels.count, part_of(progress, 0.2, 0.3));
  const detail::Groups simplices = detail::group_by(labels.simplices, labels.count, part_of(progress, 0.3, 0.5));
  const Progress copying = part_of(progress, 0.5, 1.0);
  detail::CountedProgress copied(copying, rows_to_copy(contour, vertices.members.size(), simplices.members.size()));
  Buffer<Index> number(contour.vertices.size());
  std::vector<Contour<N, Real>> parts;
  for (Index label = 0; label < labels.count; ++label) {
    const std::span<const Index> members = vertices.of(label);
    for (std::size_t i = 0; i < members.size(); ++i) number[members[i]] = static_cast<Index>(i);
    parts.push_back(detail::part_of_contour(contour, members, simplices.of(label), number, copied));
  }
  detail::tell(progress, 1.0);
  return parts;
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5> Contour<N, Real> select_components(const Contour<N, Real>& contour,
                                                                      const ComponentLabels& labels,
                                                                      const std::vector<bool>& keep,
                                                                      const WorkOptions& work) {
  using detail::part_of;
  const Progress& progress = work.progress;
  require_labels(rows_of(contour), labels, {work.threads, part_of(progress, 0.0, 0.2)});
  detail::require_attributes(contour);
  if (keep.size() != labels.count)
    throw Error(ErrorCode::InvalidArgument, fmt::format("{} choices of components; expected {}, one for each component",
                                                        keep.size(), labels.count));
  // list the kept vertices and simplices
  const Buffer<Index> vertices = kept_items(labels.vertices, keep, part_of(progress, 0.2, 0.3));
  const Buffer<Index> simplices = kept_items(labels.simplices, keep, part_of(progress, 0.3, 0.5));
  const Progress copying = part_of(progress, 0.5, 1.0);
  detail::CountedProgress copied(copying, rows_to_copy(contour, vertices.size(), simplices.size()));
  Buffer<Index> number(contour.vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) number[vertices[i]] = static_cast<Index>(i);
  auto part = detail::part_of_contour(contour, std::span<const Index>(vertices), std::span<const Index>(simplices),
                                      number, copied);
  detail::tell(progress, 1.0);
  return part;
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5> NearestComponent
nearest_component(const Contour<N, Real>& contour, const ComponentLabels& labels,
                  const std::type_identity_t<std::array<double, N>>& point,
                  const std::type_identity_t<std::array<double, N>>& steps, const WorkOptions& work) {
  for (int a = 0; a < N; ++a)
    if (!std::isfinite(point[a]) || !(steps[a] > 0.0) || std::isinf(steps[a]))
      throw Error(
          ErrorCode::InvalidArgument,
          fmt::format("the component nearest to ({}), with steps of ({}); expected finite coordinates, and steps "
                      "above 0",
                      fmt::join(point, ", "), fmt::join(steps, ", ")));
  require_labels(rows_of(contour), labels, {work.threads, detail::part_of(work.progress, 0.0, 0.5)});
  const Progress searching = detail::part_of(work.progress, 0.5, 1.0);
  const detail::NearestRepetition<N> repetitions(contour.periods, steps);
  const detail::NearestItem nearest = detail::nearest_item(contour.vertices.size(), searching, [&](std::size_t v) {
    if (labels.vertices[v] == kNoComponent) return std::numeric_limits<double>::infinity();
    return repetitions.square(point, detail::widened_point<N>(contour.vertices[v]));
  });
  if (nearest.item != detail::NearestItem::kNone) return {labels.vertices[nearest.item], std::sqrt(nearest.square)};
  // no square is finite: the first labelled vertex
  const auto first =
      std::find_if(labels.vertices.begin(), labels.vertices.end(), [](Index label) { return label != kNoComponent; });
  if (first == labels.vertices.end()) return {};
  return {*first, std::numeric_limits<double>::infinity()};
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5> Contour<N, Real> add_component_attribute(Contour<N, Real> contour,
                                                                            const ComponentLabels& labels) {
  require_labels(rows_of(contour), labels);
  detail::require_attributes(contour);
  add_labels(labels.vertices, contour.vertex_attributes);
  add_labels(labels.simplices, contour.simplex_attributes);
  return contour;
}

#define TEGL_INSTANTIATE_CONTOURS_TO_5(N, Real)                                                                       \
  template ComponentLabels label_components(const Contour<N, Real>&, const WorkOptions&);                             \
  template std::vector<Component<N>> components(const Contour<N, Real>&, const ComponentLabels&, const WorkOptions&); \
  template std::vector<Component<N>> components(const Contour<N, Real>&, const ComponentLabels&, const Incidence<N>&, \
                                                const WorkOptions&);                                                  \
  template std::vector<Contour<N, Real>> split_components(const Contour<N, Real>&, const ComponentLabels&,            \
                                                          const WorkOptions&);                                        \
  template Contour<N, Real> select_components(const Contour<N, Real>&, const ComponentLabels&,                        \
                                              const std::vector<bool>&, const WorkOptions&);                          \
  template NearestComponent nearest_component(const Contour<N, Real>&, const ComponentLabels&,                        \
                                              const std::array<double, N>&, const std::array<double, N>&,             \
                                              const WorkOptions&);                                                    \
  template Contour<N, Real> add_component_attribute(Contour<N, Real>, const ComponentLabels&);
#include "base/instantiate.hpp"

}  // namespace tegl
