// SPDX-License-Identifier: BSD-3-Clause
//
// Indexes of active tiles for Python: built once for an image, which they keep, and queried for many isovalues.
#include <fmt/format.h>

#include "binding.hpp"
#include "docs.hpp"
#include "tegl/active_tiles.hpp"
#include "tegl/io/active_tiles.hpp"
#include "tegl/pick.hpp"

namespace tegl::python {

namespace {

/// An index with its image, of any dimension and type: `_tegl.Index`.
class AnyIndex {
 public:
  AnyIndex() = default;
  AnyIndex(const AnyIndex&) = delete;
  AnyIndex& operator=(const AnyIndex&) = delete;
  virtual ~AnyIndex() = default;

  [[nodiscard]] virtual AnyContour contour(double level, bool is_double, const ExtractOptions& options) const = 0;
  [[nodiscard]] virtual std::vector<TileNumber> find(double level) const = 0;
  [[nodiscard]] virtual std::string method() const = 0;
  [[nodiscard]] virtual std::size_t memory() const = 0;
  virtual void save(const std::string& path) const = 0;
};

template <class T, int N>
class IndexOf final : public AnyIndex {
 public:
  IndexOf(Image<T, N> image, std::unique_ptr<ActiveTiles<N>> tiles)
      : image_(std::move(image)), tiles_(std::move(tiles)) {}

  [[nodiscard]] AnyContour contour(double level, bool is_double, const ExtractOptions& options) const override {
    if (is_double) return {extract<double>(image_, level, *tiles_, options), level};
    return {extract<float>(image_, level, *tiles_, options), level};
  }
  [[nodiscard]] std::vector<TileNumber> find(double level) const override { return tiles_->find(level); }
  [[nodiscard]] std::string method() const override { return std::string(active_method_name(tiles_->method())); }
  [[nodiscard]] std::size_t memory() const override { return tiles_->memory_bytes(); }
  void save(const std::string& path) const override { write_active_tiles(*tiles_, path); }

 private:
  Image<T, N> image_;
  std::unique_ptr<ActiveTiles<N>> tiles_;
};

/// Wraps the index made by make(image). Throws UnsupportedData for 5D images, for which there is no extraction by
/// index.
template <class Make>
std::unique_ptr<AnyIndex> index_of(const AnyImage& image, const Make& make) {
  return visit_image(image, [&]<class T, int N>(const Image<T, N>& view) -> std::unique_ptr<AnyIndex> {
    if constexpr (N <= 4)
      return std::make_unique<IndexOf<T, N>>(view, make(view));
    else
      throw Error(ErrorCode::UnsupportedData, fmt::format("an index of a {}D image; expected 2 to 4 dimensions", N));
  });
}

std::vector<std::pair<const char*, ActiveMethod>> method_names() {
  std::vector<std::pair<const char*, ActiveMethod>> result;
  for (const ActiveMethod method : active_methods()) result.emplace_back(active_method_name(method).data(), method);
  return result;
}

std::unique_ptr<AnyIndex> build(const AnyImage& image, const std::string& method, unsigned threads,
                                const py::object& progress) {
  Call call(progress);
  ActiveTilesOptions options;
  options.work.threads = threads;
  options.work.progress = call.progress();
  const auto chosen = named<ActiveMethod>("method", method, method_names());
  return call.run(
      [&] { return index_of(image, [&](const auto& view) { return build_active_tiles(view, chosen, options); }); });
}

std::unique_ptr<AnyIndex> load(const std::string& path, const AnyImage& image, unsigned threads,
                               const py::object& progress) {
  Call call(progress);
  ActiveTilesOptions options;
  options.work.threads = threads;
  options.work.progress = call.progress();
  return call.run([&] {
    const FileLock lock(options.work.progress);
    return index_of(image, [&](const auto& view) { return read_active_tiles(path, view, options); });
  });
}

std::unique_ptr<AnyContour> contour_of_index(const AnyIndex& index, double level, bool is_double,
                                             const py::dict& arguments, const py::object& progress) {
  Call call(progress);
  const ExtractOptions options = extract_options(arguments, call);
  const auto normals = py::cast<std::string>(arguments["normals"]);
  return call.run([&] {
    auto result = std::make_unique<AnyContour>(index.contour(level, is_double, options));
    add_shape_normals(*result, normals, options);
    return result;
  });
}

py::array find(const AnyIndex& index, double level) {
  std::vector<TileNumber> tiles;
  {
    const py::gil_scoped_release release;
    tiles = index.find(level);
  }
  return py::array_t<TileNumber>(static_cast<py::ssize_t>(tiles.size()), tiles.data());
}

void save(const AnyIndex& index, const std::string& path) {
  const py::gil_scoped_release release;
  const FileLock lock;
  index.save(path);
}

template <class Real, class T, int N>
py::tuple picked(const Image<T, N>& image, double level, const std::type_identity_t<std::array<double, N>>& point,
                 const ExtractOptions& options, const std::string& normals, Call& call) {
  PickReport<N> report;
  auto contour = call.run([&] {
    auto found = extract_component<Real>(image, level, point, options);
    report = found.report;
    auto result = std::make_unique<AnyContour>();
    *result = {std::move(found.contour), level};
    add_shape_normals(*result, normals, options);
    return result;
  });
  py::dict result;
  put(result, "found", report.found);
  put(result, "tile", std::vector<std::size_t>(report.at.begin(), report.at.end()));
  put(result, "distance", report.distance);
  put(result, "tiles", report.tiles);
  put(result, "components", report.components);
  return py::make_tuple(std::move(contour), result);
}

py::tuple pick(const AnyImage& image, double level, const std::vector<double>& point, bool is_double,
               const py::dict& arguments, const py::object& progress) {
  Call call(progress);
  const ExtractOptions options = extract_options(arguments, call);
  const auto normals = py::cast<std::string>(arguments["normals"]);
  return visit_image(image, [&]<class T, int N>(const Image<T, N>& view) {
    const auto at = to_array<N>("the point", point);
    return is_double ? picked<double>(view, level, at, options, normals, call)
                     : picked<float>(view, level, at, options, normals, call);
  });
}

}  // namespace

void bind_index(py::module_& m) {
  py::class_<AnyIndex>(m, "Index", doc::ActiveTiles)
      .def_property_readonly("method", &AnyIndex::method)
      .def_property_readonly("memory", &AnyIndex::memory, "Memory of the index in bytes, without the image.")
      .def("contour", &contour_of_index, py::arg("level"), py::arg("double"), py::arg("options"), py::arg("progress"))
      .def("find", &find, py::arg("level"), "The numbers of the active tiles, ascending.")
      .def("save", &save, py::arg("path"), doc::write_active_tiles);
  // The index refers to the image's array, so it keeps the image alive.
  m.def("build_index", &build, py::keep_alive<0, 1>(), py::arg("image"), py::arg("method"), py::arg("threads"),
        py::arg("progress"), doc::build_active_tiles);
  m.def("load_index", &load, py::keep_alive<0, 2>(), py::arg("path"), py::arg("image"), py::arg("threads"),
        py::arg("progress"), doc::read_active_tiles);
  m.def("extract_component", &pick, py::arg("image"), py::arg("level"), py::arg("point"), py::arg("double"),
        py::arg("options"), py::arg("progress"), doc::extract_component);
}

}  // namespace tegl::python
