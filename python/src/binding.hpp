// SPDX-License-Identifier: BSD-3-Clause
//
// What all parts of the Python module share: contours and images of any dimension and type behind one Python class
// each, calls that let go of the interpreter's lock, and arrays that NumPy sees without copies.
//
// Axes are in the order of the library here: axis 0 first. The Python part of the package turns them around.
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
#include "tegl/error.hpp"
#include "tegl/extract.hpp"
#include "tegl/image.hpp"

namespace tegl::python {

namespace py = pybind11;

/// A contour of any dimension and type: what Python holds as `_tegl.Contour`.
struct AnyContour {
  std::variant<Contour<2, float>, Contour<3, float>, Contour<4, float>, Contour<5, float>, Contour<2, double>,
               Contour<3, double>, Contour<4, double>, Contour<5, double>>
      contour;
  std::optional<double> isovalue;
};

template <int N>
using ViewsOf = std::variant<Image<std::uint8_t, N>, Image<std::int8_t, N>, Image<std::uint16_t, N>,
                             Image<std::int16_t, N>, Image<std::int32_t, N>, Image<float, N>, Image<double, N>>;

/// A view of a NumPy array with its grid, and the array, so that it lives as long: `_tegl.Image`.
struct AnyImage {
  std::variant<ViewsOf<2>, ViewsOf<3>, ViewsOf<4>, ViewsOf<5>> view;
  py::array array;
};

/// A grid of any dimension, without the image: `_tegl.Grid`.
struct AnyGrid {
  std::variant<Grid<2>, Grid<3>, Grid<4>, Grid<5>> grid;
};

/// Calls f(const Image<T, N>&).
template <class F>
decltype(auto) visit_image(const AnyImage& image, F&& f) {
  return std::visit([&](const auto& views) -> decltype(auto) { return std::visit(f, views); }, image.view);
}

/// For operations that there are not in all dimensions.
[[noreturn]] void throw_dimension(const char* operation, int dim, const char* expected);

/// The value that `name` stands for. Throws InvalidArgument, listing what there is.
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

/// A long call: without the interpreter's lock, so that other threads of Python go on; with the caller's progress
/// function, whose exceptions end the call and reach the caller; and with signals looked at now and then, so that
/// Ctrl-C ends it as it ends Python code.
class Call {
 public:
  /// Throws TypeError for what is neither a function nor None.
  explicit Call(py::object progress);

  /// What the library takes. Valid as long as this.
  [[nodiscard]] Progress progress() {
    return [this](double fraction) { return tell(fraction); };
  }

  /// work(), without the lock. What it returns must be no Python object.
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

 private:
  bool tell(double fraction);

  py::object callback_;
  std::mutex mutex_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  double told_ = -1.0;
  std::exception_ptr error_;
};

/// Of the formats' libraries some keep global state (tegl/io.hpp): one file at a time. Take it without the
/// interpreter's lock. Who waits for it is told so by `progress`, 0, and can be cancelled; a thread that has it, which
/// is one whose progress function asks for another file, gets InvalidArgument.
class FileLock {
 public:
  explicit FileLock(const Progress& progress = {});
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;
};

/// A view of memory that `owner` holds, for reading only.
template <class T>
py::array read_only(const T* data, std::vector<py::ssize_t> shape, py::handle owner) {
  py::array result(py::dtype::of<T>(), std::move(shape), data, owner);
  py::detail::array_proxy(result.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return result;
}

/// An array that owns a buffer, which is moved, not copied. `width`: columns; 0: a vector.
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

/// name -> (values, unit) of attributes that `owner` holds.
py::dict attribute_arrays(const std::vector<Attribute>& attributes, py::handle owner);

/// Options of an extraction from Python's arguments: triangulation, ambiguity, direction, close, epsilon, normals (a
/// kind, or "" for none), threads; all of them are required. The call gives progress.
ExtractOptions extract_options(const py::dict& arguments, Call& call);

/// Adds the normals that a contour has from its own shape, if the argument `normals` is "geometric" or "flat"; the
/// latter as the simplex attribute "normal". Throws UnsupportedData for 5D contours.
void add_shape_normals(AnyContour& contour, const std::string& kind, const ExtractOptions& options);

/// Python's floats of the library's arrays.
template <std::size_t N>
std::vector<double> to_list(const std::array<double, N>& values, std::size_t count = N) {
  return {values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count)};
}
/// The other way. Throws InvalidArgument if there are not N of them.
template <int N>
std::array<double, N> to_array(const char* what, const std::vector<double>& values) {
  if (values.size() != N)
    throw Error(ErrorCode::InvalidArgument, std::string(what) + " has " + std::to_string(values.size()) +
                                                " numbers; expected one for each of " + std::to_string(N) + " axes");
  std::array<double, N> result{};
  std::copy(values.begin(), values.end(), result.begin());
  return result;
}

/// Puts `values` behind `name` and no more, as `dict["name"] = values`.
template <class T>
void put(py::dict& dict, const char* name, const T& value) {
  dict[name] = py::cast(value);
}

// The parts of the module.
void bind_contour(py::module_& m);
void bind_extract(py::module_& m);
void bind_operations(py::module_& m);
void bind_elements(py::module_& m);
void bind_track(py::module_& m);
void bind_index(py::module_& m);
void bind_files(py::module_& m);
void bind_marching_cubes(py::module_& m);

}  // namespace tegl::python
