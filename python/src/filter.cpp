// SPDX-License-Identifier: BSD-3-Clause
//
// Filters and scale spaces of images, and samples of fields.
#include "tegl/filter.hpp"

#include <fmt/format.h>

#include "binding.hpp"
#include "docs.hpp"
#include "tegl/field.hpp"
#include "tegl/scale_space.hpp"

namespace tegl::python {

namespace {

AxisWeights weights_of(const std::string& kind, double sigma) {
  if (sigma == 0) return {};
  if (kind == "gaussian") return gaussian_weights(sigma);
  return kind == "binomial" ? binomial_weights(sigma) : discrete_gaussian_weights(sigma);
}

/// `numbers`: sigmas or radii by axis, weights of a kernel, or an isovalue. `value`: sigma of the values, or the time
/// of a flow.
template <int N>
Filter filter_of(const Grid<N>& grid, const std::string& kind, const std::vector<double>& numbers,
                 const std::vector<std::size_t>& sizes, double value, bool in_samples) {
  if (kind == "contextual") return ContextualLowPass{numbers.at(0)};
  if (kind == "kernel") return Convolution{sizes, numbers};
  if (kind == "median") return MedianFilter{sizes};
  if (kind == "curvature") {  // numbers: 1 for axes that take part, 0 for others
    std::array<double, N> per_unit = to_array<N>("axes of the flow", numbers);
    if (!in_samples) per_unit = sigmas_in_samples<N>(grid, per_unit);
    CurvatureFlow flow{{}, value};
    for (const double one : per_unit) flow.spacing.push_back(one == 0 ? 0.0 : 1 / one);
    return flow;
  }
  const std::array<double, N> given = to_array<N>("sigma", numbers);
  const std::array<double, N> sigmas = in_samples ? given : sigmas_in_samples<N>(grid, given);
  if (kind == "bilateral") return BilateralFilter{{sigmas.begin(), sigmas.end()}, value};
  SeparableConvolution filter;
  for (const double sigma : sigmas) filter.weights.push_back(weights_of(kind, sigma));
  return filter;
}

FilterOptions options_of(const std::vector<std::string>& borders, bool fill, unsigned threads, Call& call) {
  FilterOptions options{{}, fill, {threads, call.progress()}};
  for (const std::string& border : borders)
    options.borders.push_back(named<FilterBorder>(
        "border", border,
        {{"extended", FilterBorder::extended}, {"cyclic", FilterBorder::cyclic}, {"missing", FilterBorder::missing}}));
  return options;
}

py::array filter_any(const AnyImage& image, const std::string& kind, const std::vector<double>& numbers,
                     const std::vector<std::size_t>& sizes, double value, bool in_samples,
                     const std::vector<std::string>& borders, bool fill, unsigned threads, const py::object& progress) {
  Call call(progress);
  const FilterOptions options = options_of(borders, fill, threads, call);
  return visit_image(image, [&]<class T, int N>(const Image<T, N>& view) -> py::array {
    return owned_samples(call.run(
        [&] { return filter_image(view, filter_of(view.grid(), kind, numbers, sizes, value, in_samples), options); }));
  });
}

/// `factors`: by axis, empty for 1 along each. The last axis of the result is the scale.
py::array scale_space_any(const AnyImage& image, const std::vector<double>& sigmas, const std::vector<double>& factors,
                          bool laplacian, bool in_samples, const std::vector<std::string>& borders, bool fill,
                          unsigned threads, const py::object& progress) {
  Call call(progress);
  return visit_image(image, [&]<class T, int N>(const Image<T, N>& view) -> py::array {
    if constexpr (N <= 4) {
      ScaleSpaceOptions options;
      options.quantity = laplacian ? ScaleQuantity::laplacian : ScaleQuantity::values;
      options.factors = factors;
      options.in_samples = in_samples;
      options.filter = options_of(borders, fill, threads, call);
      return owned_samples(call.run([&] { return ScaleSpaceLayers<T, N>(view, sigmas, options).all(); }));
    } else {
      throw Error(ErrorCode::UnsupportedData, "the scale space of an array of 5 axes; expected 2 to 4");
    }
  });
}

/// `axes`: size, first coordinate and step of each axis.
py::array sample_field_any(const std::string& text, bool is_expression,
                           const std::vector<std::tuple<std::size_t, double, double>>& axes,
                           const std::vector<std::pair<std::string, double>>& parameters, std::uint64_t seed,
                           const std::string& lattice, unsigned threads, const py::object& progress) {
  Call call(progress);
  const auto dim = static_cast<int>(axes.size());
  const Field field = is_expression ? make_expression(text, dim) : make_field(text, dim, parameters, seed);
  std::optional<Lattice> on;
  if (!lattice.empty()) on = named<Lattice>("lattice", lattice, lattices());
  const auto sample = [&]<int N>(std::integral_constant<int, N>) {
    Grid<N> grid;
    for (std::size_t a = 0; a < N; ++a)
      grid.axes[a] = Axis::uniform(std::get<0>(axes[a]), std::get<1>(axes[a]), std::get<2>(axes[a]));
    return owned_samples(call.run([&] { return sample_field(field, grid, on, {threads, call.progress()}); }));
  };
  if (dim == 2) return sample(std::integral_constant<int, 2>());
  if (dim == 3) return sample(std::integral_constant<int, 3>());
  if (dim == 4) return sample(std::integral_constant<int, 4>());
  return sample(std::integral_constant<int, 5>());
}

py::list list_fields() {
  py::list result;
  for (const FieldInfo& field : fields()) {
    py::dict parameters;
    for (const FieldParameter& one : field.parameters) put(parameters, one.name.c_str(), one.value);
    result.append(py::make_tuple(field.name, field.meaning, field.least_dim, field.most_dim, parameters));
  }
  return result;
}

}  // namespace

void bind_filter(py::module_& m) {
  m.def("filter", &filter_any, py::arg("image"), py::arg("kind"), py::arg("numbers"), py::arg("sizes"),
        py::arg("value_sigma"), py::arg("samples"), py::arg("borders"), py::arg("fill"), py::arg("threads"),
        py::arg("progress"), doc::filter_image);
  m.def("scale_space", &scale_space_any, py::arg("image"), py::arg("sigmas"), py::arg("factors"), py::arg("laplacian"),
        py::arg("samples"), py::arg("borders"), py::arg("fill"), py::arg("threads"), py::arg("progress"),
        doc::ScaleSpaceLayers);
  m.def(
      "most_stable_scale",
      [](const std::vector<double>& sigmas, const std::vector<double>& measures) {
        const StableScale found = most_stable_scale(sigmas, measures);
        return std::make_pair(found.sigma, found.change);
      },
      py::arg("sigmas"), py::arg("measures"), doc::most_stable_scale);
  m.def("sample_field", &sample_field_any, py::arg("field"), py::arg("is_expression"), py::arg("axes"),
        py::arg("parameters"), py::arg("seed"), py::arg("lattice"), py::arg("threads"), py::arg("progress"),
        doc::make_field);
  m.def("fields", &list_fields, doc::fields);
}

}  // namespace tegl::python
