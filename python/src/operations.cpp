// SPDX-License-Identifier: BSD-3-Clause
//
// Operations on contours: slices, checks, components, measures, simplification.
#include <fmt/format.h>

#include "binding.hpp"
#include "docs.hpp"
#include "incidence.hpp"
#include "tegl/check.hpp"
#include "tegl/components.hpp"
#include "tegl/hyperplane.hpp"
#include "tegl/intersections.hpp"
#include "tegl/measure.hpp"
#include "tegl/merge.hpp"
#include "tegl/sample.hpp"
#include "tegl/simplify.hpp"
#include "tegl/slice.hpp"

namespace tegl::python {

namespace {

using Numbers = std::vector<double>;

std::vector<AnyContour> cuts(const AnyContour& contour, const Numbers& normal, const Numbers& offsets, unsigned threads,
                             const py::object& progress) {
  Call call(progress);
  const WorkOptions options{threads, call.progress()};
  return call.run([&] {
    return std::visit(
        [&]<int N, class Real>(const Contour<N, Real>& c) -> std::vector<AnyContour> {
          if constexpr (N >= 3) {
            const auto direction = to_array<N>("the normal", normal);
            std::vector<Hyperplane<N>> hyperplanes;
            for (const double offset : offsets) hyperplanes.push_back({direction, offset});
            std::vector<AnyContour> result;
            for (auto& cut : slice_stack(c, hyperplanes, options)) result.push_back({std::move(cut), contour.isovalue});
            return result;
          } else {
            throw_dimension("a slice", N, "3 to 5 dimensions");
          }
        },
        contour.contour);
  });
}

/// The origin and the axes, in rows, of the frame of cuts with this normal.
py::tuple frame_of_cut(const AnyContour& contour, const Numbers& normal, double offset) {
  return std::visit(
      [&]<int N, class Real>(const Contour<N, Real>&) -> py::tuple {
        const HyperplaneFrame<N> frame = frame_of(Hyperplane<N>{to_array<N>("the normal", normal), offset});
        std::vector<Numbers> axes;
        for (const Vector<N>& axis : frame.axes) axes.emplace_back(axis.begin(), axis.end());
        return py::make_tuple(Numbers(frame.origin.begin(), frame.origin.end()), axes);
      },
      contour.contour);
}

py::dict check_any(const AnyContour& contour, const AnyIncidence* incidence, unsigned threads,
                   const py::object& progress) {
  Call call(progress);
  const WorkOptions work{threads, call.progress()};
  const MeshReport report = call.run([&] {
    return visit_with(contour, incidence,
                      [&](const auto& c, const auto&... shared) { return check(c, shared..., work); });
  });
  py::dict result;
  put(result, "dim", report.dim);
  put(result, "vertices", report.vertices);
  put(result, "unused_vertices", report.unused_vertices);
  put(result, "simplices", report.simplices);
  put(result, "components", report.components);
  put(result, "euler", report.euler);
  put(result, "boundary_simplices", report.boundary_simplices);
  put(result, "nonmanifold_simplices", report.nonmanifold_simplices);
  put(result, "bad_links", report.bad_links);
  put(result, "orientation_conflicts", report.orientation_conflicts);
  put(result, "degenerate_simplices", report.degenerate_simplices);
  put(result, "nonfinite_vertices", report.nonfinite_vertices);
  return result;
}

/// #P x width numbers, row = pair.
template <class Number, std::size_t kWidth, class Pair, class RowOf>
py::array_t<Number> rows_of(const std::vector<Pair>& pairs, const RowOf& row_of) {
  py::array_t<Number> result({static_cast<py::ssize_t>(pairs.size()), static_cast<py::ssize_t>(kWidth)});
  auto rows = result.template mutable_unchecked<2>();
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::array<Number, kWidth> row = row_of(pairs[i]);
    for (std::size_t k = 0; k < kWidth; ++k) rows(static_cast<py::ssize_t>(i), static_cast<py::ssize_t>(k)) = row[k];
  }
  return result;
}

template <int N>
py::dict to_dict(const Intersections<N>& found) {
  using Pair = IntersectingPair<N>;
  py::dict result;
  put(result, "simplices", found.simplices);
  put(result, "flat", found.flat);
  put(result, "count", found.pair_count);
  put(result, "intersecting", found.intersecting);
  result["pairs"] = rows_of<Index, 2>(found.pairs, [](const Pair& pair) {
    return std::array{pair.first, pair.second};
  });
  result["places"] = rows_of<double, N>(found.pairs, [](const Pair& pair) { return pair.place; });
  result["depths"] = rows_of<double, 1>(found.pairs, [](const Pair& pair) {
                       return std::array{pair.depth};
                     }).reshape(std::vector<py::ssize_t>{static_cast<py::ssize_t>(found.pairs.size())});
  put(result, "tiles", found.tiles);
  put(result, "tiles_hit", found.tiles_hit);
  return result;
}

/// `tile`, `origin`: none, or a number for each axis. `most_listed`: none for all.
py::dict intersections_any(const AnyContour& contour, const std::optional<Numbers>& tile, const Numbers& origin,
                           std::optional<std::uint64_t> most_listed, unsigned threads, const py::object& progress) {
  Call call(progress);
  return std::visit(
      [&]<int N, class Real>(const Contour<N, Real>& c) -> py::dict {
        if constexpr (N <= 4) {
          IntersectionOptions<N> options;
          if (most_listed) options.most_listed = *most_listed;
          if (tile) options.tiles = IntersectionTiles<N>{to_array<N>("tile", *tile), to_array<N>("origin", origin)};
          options.work = {threads, call.progress()};
          return to_dict(call.run([&] { return find_intersections(c, options); }));
        } else {
          throw_dimension("intersections", N, "2 to 4 dimensions");
        }
      },
      contour.contour);
}

py::dict measure_any(const AnyContour& contour, const AnyIncidence* incidence, unsigned threads,
                     const py::object& progress) {
  Call call(progress);
  const WorkOptions options{threads, call.progress()};
  return visit_with(contour, incidence, [&](const auto& c, const auto&... shared) {
    const auto measures = call.run([&] { return measure(c, shared..., options); });
    py::dict result;
    put(result, "size", measures.size);
    put(result, "content", measures.content);
    put(result, "centroid", to_list(measures.centroid));
    put(result, "lowest", to_list(measures.lowest));
    put(result, "highest", to_list(measures.highest));
    put(result, "boundary_simplices", measures.boundary_simplices);
    put(result, "open_simplices", measures.open_simplices);
    return result;
  });
}

/// (size, content) of each slice; content is NaN if undefined.
std::pair<Numbers, Numbers> measure_cuts_any(const AnyContour& contour, const Numbers& at, unsigned threads,
                                             const py::object& progress) {
  Call call(progress);
  const WorkOptions options{threads, call.progress()};
  return call.run([&] {
    return std::visit(
        [&]<int N, class Real>(const Contour<N, Real>& c) -> std::pair<Numbers, Numbers> {
          if constexpr (N >= 3) {
            std::pair<Numbers, Numbers> result;
            for (const CutMeasures& cut : measure_cuts(c, at, options)) {
              result.first.push_back(cut.size);
              result.second.push_back(cut.content.value_or(std::numeric_limits<double>::quiet_NaN()));
            }
            return result;
          } else {
            throw_dimension("measures of slices", N, "3 to 5 dimensions");
          }
        },
        contour.contour);
  });
}

std::unique_ptr<ComponentLabels> label_any(const AnyContour& contour, unsigned threads, const py::object& progress) {
  Call call(progress);
  const WorkOptions options{threads, call.progress()};
  return call.run([&] {
    return std::visit([&](const auto& c) { return std::make_unique<ComponentLabels>(label_components(c, options)); },
                      contour.contour);
  });
}

template <int N>
py::dict to_dict(const Component<N>& component) {
  py::dict result;
  put(result, "label", component.label);
  put(result, "vertices", component.vertices);
  put(result, "simplices", component.simplices);
  put(result, "size", component.size);
  put(result, "content", component.content);
  put(result, "centroid", to_list(component.centroid));
  put(result, "lowest", to_list(component.lowest));
  put(result, "highest", to_list(component.highest));
  put(result, "euler", component.euler);
  put(result, "boundary_simplices", component.boundary_simplices);
  return result;
}

py::list components_any(const AnyContour& contour, const ComponentLabels& labels, const AnyIncidence* incidence,
                        unsigned threads, const py::object& progress) {
  Call call(progress);
  const WorkOptions options{threads, call.progress()};
  return visit_with(contour, incidence, [&](const auto& c, const auto&... shared) {
    const auto found = call.run([&] { return components(c, labels, shared..., options); });
    py::list result;
    for (const auto& component : found) result.append(to_dict(component));
    return result;
  });
}

std::vector<AnyContour> split_any(const AnyContour& contour, const ComponentLabels& labels,
                                  const py::object& progress) {
  Call call(progress);
  const WorkOptions work{.progress = call.progress()};
  return call.run([&] {
    return std::visit(
        [&](const auto& c) {
          std::vector<AnyContour> result;
          for (auto& part : split_components(c, labels, work)) result.push_back({std::move(part), contour.isovalue});
          return result;
        },
        contour.contour);
  });
}

std::unique_ptr<AnyContour> select_any(const AnyContour& contour, const ComponentLabels& labels,
                                       const std::vector<bool>& keep, const py::object& progress) {
  Call call(progress);
  const WorkOptions work{.progress = call.progress()};
  return call.run([&] {
    return std::visit(
        [&](const auto& c) {
          return std::unique_ptr<AnyContour>(
              new AnyContour{select_components(c, labels, keep, work), contour.isovalue});
        },
        contour.contour);
  });
}

py::object nearest_any(const AnyContour& contour, const ComponentLabels& labels, const std::vector<double>& point,
                       const std::vector<double>& steps, const py::object& progress) {
  Call call(progress);
  const WorkOptions work{.progress = call.progress()};
  const NearestComponent nearest = call.run([&] {
    return std::visit(
        [&]<int N, class Real>(const Contour<N, Real>& c) {
          return nearest_component(c, labels, to_array<N>("point", point), to_array<N>("steps", steps), work);
        },
        contour.contour);
  });
  if (nearest.label == kNoComponent) return py::none();
  return py::make_tuple(nearest.label, nearest.distance);
}

template <int N>
SimplifyOptions<N> simplify_options(const py::dict& arguments, Call& call) {
  SimplifyOptions<N> result;
  result.method = named<SimplifyMethod>("method", py::cast<std::string>(arguments["method"]),
                                        {{"quadric", SimplifyMethod::quadric},
                                         {"facets", SimplifyMethod::facets},
                                         {"vertices", SimplifyMethod::vertices},
                                         {"fast", SimplifyMethod::fast}});
  result.border = named<SimplifyBorder>("border", py::cast<std::string>(arguments["border"]),
                                        {{"fixed", SimplifyBorder::fixed}, {"within", SimplifyBorder::within}});
  result.count = py::cast<std::optional<std::uint64_t>>(arguments["count"]);
  result.ratio = py::cast<std::optional<double>>(arguments["ratio"]);
  result.max_error = py::cast<std::optional<double>>(arguments["max_error"]);
  if (!arguments["max_curvature"].is_none()) result.max_curvature = py::cast<double>(arguments["max_curvature"]);
  if (!arguments["scale"].is_none()) result.scale = to_array<N>("scale", py::cast<Numbers>(arguments["scale"]));
  result.measure = py::cast<bool>(arguments["measure"]);
  result.allow_nonmanifold = py::cast<bool>(arguments["allow_nonmanifold"]);
  result.keep_embedded = py::cast<bool>(arguments["keep_embedded"]);
  result.work = {py::cast<unsigned>(arguments["threads"]), call.progress()};
  return result;
}

const char* name_of(SimplifyEnd end) {
  constexpr std::array kNames = {"count", "error", "shape", "rounds"};
  return kNames.at(static_cast<std::size_t>(end));
}

py::dict to_dict(const SimplifyStats& stats) {
  py::dict result;
  put(result, "simplices_before", stats.simplices_before);
  put(result, "simplices_after", stats.simplices_after);
  put(result, "vertices_before", stats.vertices_before);
  put(result, "vertices_after", stats.vertices_after);
  put(result, "error_of_original", stats.error_of_original);
  put(result, "error_of_result", stats.error_of_result);
  put(result, "end", name_of(stats.end));
  put(result, "rounds", stats.rounds);
  return result;
}

py::tuple simplify_any(const AnyContour& contour, const py::dict& arguments, const py::object& progress) {
  Call call(progress);
  return std::visit(
      [&]<int N, class Real>(const Contour<N, Real>& c) -> py::tuple {
        if constexpr (N <= 4) {
          const SimplifyOptions<N> options = simplify_options<N>(arguments, call);
          Simplification<N, Real> result = call.run([&] { return simplify(c, options); });
          auto simplified = std::make_unique<AnyContour>(AnyContour{std::move(result.contour), contour.isovalue});
          return py::make_tuple(std::move(simplified), to_dict(result.stats));
        } else {
          throw_dimension("simplification", N, "2 to 4 dimensions");
        }
      },
      contour.contour);
}

template <int N>
py::dict to_dict(const MergeReport<N>& report) {
  py::dict result;
  put(result, "vertices_before", report.counts.before.vertices);
  put(result, "simplices_before", report.counts.before.simplices);
  put(result, "merged_vertices", report.counts.merged_vertices);
  put(result, "collapsed_simplices", report.counts.collapsed_simplices);
  put(result, "flat_simplices", report.counts.flat_simplices);
  put(result, "kept_flat_simplices", report.counts.kept_flat_simplices);
  put(result, "divided_simplices", report.counts.divided_simplices);
  put(result, "turned_simplices", report.counts.turned_simplices);
  put(result, "euler_before", report.counts.euler_before);
  put(result, "euler_after", report.counts.euler_after);
  put(result, "components_before", report.counts.components_before);
  put(result, "components_after", report.counts.components_after);
  put(result, "vanished_components", report.counts.vanished_components);
  put(result, "vanished", report.vanished);
  put(result, "shrunk_places", report.counts.shrunk_places);
  put(result, "shrunk", report.shrunk);
  put(result, "pinched_vertices", report.counts.pinched_vertices);
  put(result, "vertices", report.vertices);
  put(result, "pinched_faces", report.counts.pinched_faces);
  put(result, "faces", report.faces);
  return result;
}

py::tuple merge_any(const AnyContour& contour, double tolerance, std::size_t most_listed, unsigned threads,
                    const py::object& progress) {
  Call call(progress);
  const MergeOptions options{tolerance, most_listed, {threads, call.progress()}};
  return std::visit(
      [&](const auto& c) -> py::tuple {
        auto result = call.run([&] { return merge_vertices(c, options); });
        auto merged = std::make_unique<AnyContour>(AnyContour{std::move(result.contour), contour.isovalue});
        return py::make_tuple(std::move(merged), to_dict(result.report));
      },
      contour.contour);
}

Numbers automatic_scale_any(const AnyContour& contour) {
  return std::visit(
      []<int N, class Real>(const Contour<N, Real>& c) -> Numbers {
        if constexpr (N <= 4)
          return to_list(automatic_scale(c));
        else
          throw_dimension("a scale", N, "2 to 4 dimensions");
      },
      contour.contour);
}

/// Adds an image's values at the vertices as an attribute. Arrays of other attributes held by Python stay valid.
void sample_any(AnyContour& contour, const AnyImage& image, const std::string& name, const std::string& unit,
                unsigned threads, const py::object& progress) {
  Call call(progress);
  const WorkOptions options{threads, call.progress()};
  std::visit(
      [&]<int N, class Real>(Contour<N, Real>& c) {
        const auto* views = std::get_if<ViewsOf<N>>(&image.view);
        if (views == nullptr)
          throw Error(ErrorCode::InvalidArgument,
                      fmt::format("the image has {} axes; expected {}, as the contour", image.view.index() + 2, N));
        for (const Attribute& attribute : c.vertex_attributes)
          if (attribute.name == name)
            throw Error(ErrorCode::InvalidArgument, fmt::format("the contour already has an attribute '{}'", name));
        Attribute made = call.run(
            [&] { return std::visit([&](const auto& view) { return sample(view, c, name, unit, options); }, *views); });
        c.vertex_attributes.push_back(std::move(made));
      },
      contour.contour);
}

}  // namespace

void bind_operations(py::module_& m) {
  m.def("slice_stack", &cuts, py::arg("contour"), py::arg("normal"), py::arg("offsets"), py::arg("threads"),
        py::arg("progress"), doc::slice_stack);
  m.def("frame_of", &frame_of_cut, py::arg("contour"), py::arg("normal"), py::arg("offset"), doc::frame_of);
  m.def("check", &check_any, py::arg("contour"), py::arg("incidence"), py::arg("threads"), py::arg("progress"),
        doc::check_2);
  m.def("find_intersections", &intersections_any, py::arg("contour"), py::arg("tile"), py::arg("origin"),
        py::arg("most_listed"), py::arg("threads"), py::arg("progress"), doc::find_intersections);
  m.def("measure", &measure_any, py::arg("contour"), py::arg("incidence"), py::arg("threads"), py::arg("progress"),
        doc::measure);
  m.def("measure_cuts", &measure_cuts_any, py::arg("contour"), py::arg("at"), py::arg("threads"), py::arg("progress"),
        doc::measure_cuts);
  py::class_<ComponentLabels>(m, "ComponentLabels", doc::ComponentLabels)
      .def_readonly("count", &ComponentLabels::count)
      .def_property_readonly("vertices",
                             [](const py::object& self) {
                               const auto& labels = py::cast<const ComponentLabels&>(self);
                               return read_only(labels.vertices.data(),
                                                {static_cast<py::ssize_t>(labels.vertices.size())}, self);
                             })
      .def_property_readonly("simplices", [](const py::object& self) {
        const auto& labels = py::cast<const ComponentLabels&>(self);
        return read_only(labels.simplices.data(), {static_cast<py::ssize_t>(labels.simplices.size())}, self);
      });
  m.def("label_components", &label_any, py::arg("contour"), py::arg("threads"), py::arg("progress"),
        doc::label_components);
  m.def("components", &components_any, py::arg("contour"), py::arg("labels"), py::arg("incidence"), py::arg("threads"),
        py::arg("progress"), doc::components);
  m.def("split_components", &split_any, py::arg("contour"), py::arg("labels"), py::arg("progress"),
        doc::split_components);
  m.def("select_components", &select_any, py::arg("contour"), py::arg("labels"), py::arg("keep"), py::arg("progress"),
        doc::select_components);
  m.def("nearest_component", &nearest_any, py::arg("contour"), py::arg("labels"), py::arg("point"), py::arg("steps"),
        py::arg("progress"), doc::nearest_component);
  m.def("simplify", &simplify_any, py::arg("contour"), py::arg("options"), py::arg("progress"), doc::simplify);
  m.def("merge_vertices", &merge_any, py::arg("contour"), py::arg("tolerance"), py::arg("most_listed"),
        py::arg("threads"), py::arg("progress"), doc::merge_vertices);
  m.def("automatic_scale", &automatic_scale_any, py::arg("contour"), doc::automatic_scale);
  m.def("sample", &sample_any, py::arg("contour"), py::arg("image"), py::arg("name"), py::arg("unit"),
        py::arg("threads"), py::arg("progress"), doc::sample);
  m.def("has_fast_simplify", &has_fast_simplify, "Whether the method 'fast' is available.");
}

}  // namespace tegl::python
