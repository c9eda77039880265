// SPDX-License-Identifier: BSD-3-Clause
//
// Helpers for all parts of the Python module: contours and images of any dimension and type behind one Python class
// each, calls that release the interpreter lock (GIL), and NumPy arrays without copies.
//
// Axes are in the library's order here: axis 0 first. The Python part of the package reverses them.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <chrono>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/division.hpp"
#include "tegl/error.hpp"
#include "tegl/extract.hpp"
#include "tegl/image.hpp"
#include "tegl/lattice.hpp"
#include "tegl/work.hpp"

namespace tegl::python {

namespace py = pybind11;

/// A contour of any dimension and type; `_tegl.Contour` in Python.
struct AnyContour {
  std::variant<Contour<2, float>, Contour<3, float>, Contour<4, float>, Contour<5, float>, Contour<2, double>,
               Contour<3, double>, Contour<4, double>, Contour<5, double>>
      contour;
  std::optional<double> isovalue;
};

template <int N>
using ViewsOf = std::variant<Image<std::uint8_t, N>, Image<std::int8_t, N>, Image<std::uint16_t, N>,
                             Image<std::int16_t, N>, Image<std::int32_t, N>, Image<float, N>, Image<double, N>>;

/// A view of a NumPy array with its grid, and the array, which is kept alive: `_tegl.Image`.
struct AnyImage {
  std::variant<ViewsOf<2>, ViewsOf<3>, ViewsOf<4>, ViewsOf<5>> view;
  py::array array;
};

/// A grid of any dimension, without image: `_tegl.Grid`.
struct AnyGrid {
  std::variant<Grid<2>, Grid<3>, Grid<4>, Grid<5>> grid;
};

/// Calls f(const Image<T, N>&).
template <class F>
decltype(auto) visit_image(const AnyImage& image, F&& f) {
  return std::visit([&](const auto& views) -> decltype(auto) { return std::visit(f, views); }, image.view);
}

/// Throws UnsupportedData for an operation that does not exist in dimension `dim`.
[[noreturn]] void throw_dimension(const char* operation, int dim, const char* expected);

/// Returns the value with the given name. Throws InvalidArgument, with a list of valid names.
template <class Value>
Value named(const char* option, const std::string& name, const std::vector<std::pair<const char*, Value>>& values) {
  std::string expected;
  for (const auto& [known, value] : values) {
    if (name == known) return value;
    expected += (expected.empty() ? "'" : ", '") + std::string(known) + "'";
  }
  throw Error(ErrorCode::InvalidArgument, std::string(option) + " is '" + name + "'; expected one of " + expected);
}

/// The names of GradientDirection.
inline std::vector<std::pair<const char*, GradientDirection>> gradient_directions() {
  return {{"descent", GradientDirection::descent}, {"ascent", GradientDirection::ascent}};
}

/// The divisions by their names.
inline std::vector<std::pair<const char*, Division>> divisions() {
  return {{"kuhn", Division::kuhn},
          {"alternating", Division::alternating},
          {"symmetric", Division::symmetric},
          {"hybrid", Division::hybrid}};
}

/// The names of lattices.
inline std::vector<std::pair<const char*, Lattice>> lattices() {
  return {{"triangular", Lattice::triangular},
          {"fcc", Lattice::fcc},
          {"bcc", Lattice::bcc},
          {"d4", Lattice::d4},
          {"fcc_in_time", Lattice::fcc_in_time}};
}

/// A long call without the GIL, so that other Python threads continue. Calls the caller's progress function, whose
/// exceptions end the call and are rethrown to the caller. Checks signals periodically, so that Ctrl-C interrupts it as
/// it interrupts Python code.
class Call {
 public:
  /// Throws TypeError if `progress` is neither a callable nor None.
  explicit Call(py::object progress);

  /// The progress callback for the library. Valid as long as this object.
  [[nodiscard]] Progress progress() {
    return [this](double fraction) { return tell(fraction); };
  }

  /// Calls work() without the GIL. Its result must not be a Python object.
  template <class Work>
  auto run(Work&& work) {
    try {
      const py::gil_scoped_release release;
      return work();
    } catch (...) {
      if (error_) std::rethrow_exception(error_);
      throw;
    }
  }

  /// Calls use() with the GIL, from within run(), by the thread that called it. An exception ends run(), which passes
  /// it on.
  template <class Use>
  void with_python(const Use& use) {
    const py::gil_scoped_acquire acquire;
    try {
      use();
      return;
    } catch (...) {
      error_ = std::current_exception();
    }
    throw Error(ErrorCode::Cancelled, "a function of the caller raised an exception");
  }

 private:
  bool tell(double fraction);

  py::object callback_;
  std::mutex mutex_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  double told_ = -1.0;
  std::exception_ptr error_;
};

/// Serialises file access, because some file format libraries have global state (tegl/io.hpp). Acquire it without the
/// GIL. While it waits, it calls `progress` with 0, so that the wait can be cancelled. Throws InvalidArgument if the
/// thread already holds the lock, which happens if a progress function of a file call accesses another file.
class FileLock {
 public:
  explicit FileLock(const Progress& progress = {});
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;
};

/// A read-only view of memory that `owner` holds.
template <class T>
py::array read_only(const T* data, std::vector<py::ssize_t> shape, py::handle owner) {
  py::array result(py::dtype::of<T>(), std::move(shape), data, owner);
  py::detail::array_proxy(result.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return result;
}

/// An array that owns a buffer; the buffer is moved, not copied.
template <class T>
py::array owned(Buffer<T>&& buffer) {
  auto kept = std::make_unique<Buffer<T>>(std::move(buffer));
  const py::capsule owner(kept.get(), [](void* memory) { delete static_cast<Buffer<T>*>(memory); });
  const Buffer<T>& held = *kept.release();
  return py::array(py::dtype::of<T>(), {static_cast<py::ssize_t>(held.size())}, held.data(), owner);
}
template <class T, std::size_t Width>
py::array owned(Buffer<std::array<T, Width>>&& buffer) {
  auto kept = std::make_unique<Buffer<std::array<T, Width>>>(std::move(buffer));
  const py::capsule owner(kept.get(), [](void* memory) { delete static_cast<Buffer<std::array<T, Width>>*>(memory); });
  const auto& held = *kept.release();
  return py::array(py::dtype::of<T>(), {static_cast<py::ssize_t>(held.size()), static_cast<py::ssize_t>(Width)},
                   held.empty() ? nullptr : held.data()->data(), owner);
}

/// An array that takes over the samples of an image, in the library's order of axes: axis 0 fastest.
template <class T, int N>
py::array owned_samples(OwnedImage<T, N>&& image) {
  auto kept = std::make_unique<Values<T>>(std::move(image.values));
  const py::capsule owner(kept.get(), [](void* memory) { delete static_cast<Values<T>*>(memory); });
  const Values<T>& values = *kept.release();
  std::vector<py::ssize_t> shape;
  std::vector<py::ssize_t> strides;
  py::ssize_t stride = sizeof(T);
  for (const Axis& axis : image.grid.axes) {
    shape.push_back(static_cast<py::ssize_t>(axis.size()));
    strides.push_back(stride);
    stride *= shape.back();
  }
  return py::array(py::dtype::of<T>(), shape, strides, values.data(), owner);
}

/// A dict name -> (values, unit) of attributes that `owner` holds.
py::dict attribute_arrays(const std::vector<Attribute>& attributes, py::handle owner);

/// Converts Python's arguments to extraction options: triangulation, ambiguity, direction, close, epsilon, normals (a
/// kind, or "" for none), threads. All are required. Progress goes to the call.
ExtractOptions extract_options(const py::dict& arguments, Call& call);

/// Adds normals computed from the contour's shape if `kind` is "geometric" or "flat"; the latter as the simplex
/// attribute "normal". Throws UnsupportedData for 5D contours.
void add_shape_normals(AnyContour& contour, const std::string& kind, const ExtractOptions& options);

/// Converts an array to a list of Python floats.
template <std::size_t N>
std::vector<double> to_list(const std::array<double, N>& values, std::size_t count = N) {
  return {values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count)};
}
/// Converts a list to an array. Throws InvalidArgument unless it has N numbers.
template <int N>
std::array<double, N> to_array(const char* what, const std::vector<double>& values) {
  if (values.size() != N)
    throw Error(ErrorCode::InvalidArgument, std::string(what) + " has " + std::to_string(values.size()) +
                                                " numbers; expected one for each of " + std::to_string(N) + " axes");
  std::array<double, N> result{};
  std::copy(values.begin(), values.end(), result.begin());
  return result;
}

/// dict[name] = value.
template <class T>
void put(py::dict& dict, const char* name, const T& value) {
  dict[name] = py::cast(value);
}

// The parts of the module.
void bind_contour(py::module_& m);
void bind_extract(py::module_& m);
void bind_incidence(py::module_& m);
void bind_operations(py::module_& m);
void bind_elements(py::module_& m);
void bind_track(py::module_& m);
void bind_index(py::module_& m);
void bind_files(py::module_& m);
void bind_filter(py::module_& m);
void bind_marching_cubes(py::module_& m);
void bind_mesh(py::module_& m);
void bind_facets(py::module_& m);

}  // namespace tegl::python
