// SPDX-License-Identifier: BSD-3-Clause
//
// The Python module tegl._tegl: its parts, and the translation of the library's errors to Python exceptions.
#include <fmt/format.h>

#include <chrono>
#include <mutex>

#include "binding.hpp"
#include "docs.hpp"
#include "tegl/normals.hpp"

namespace tegl::python {

void throw_dimension(const char* operation, int dim, const char* expected) {
  throw Error(ErrorCode::UnsupportedData, fmt::format("{} of a {}D contour; expected {}", operation, dim, expected));
}

Call::Call(py::object progress) : callback_(std::move(progress)) {
  if (!callback_ || callback_.is_none() || PyCallable_Check(callback_.ptr()) != 0) return;
  throw py::type_error(fmt::format("progress is {}; expected a function that takes a fraction, or None",
                                   std::string(py::repr(callback_))));
}

namespace {

/// True if a progress function returned False, either Python's or NumPy's, which comparisons of NumPy numbers return.
bool is_false(const py::object& returned) {
  if (py::isinstance<py::bool_>(returned)) return !returned.cast<bool>();
  if (returned.is_none() || !py::hasattr(returned, "dtype")) return false;
  return py::dtype::from_args(returned.attr("dtype")).kind() == 'b' && !py::bool_(returned);
}

}  // namespace

bool Call::tell(double fraction) {
  // Rate limited: each call waits for the GIL.
  const std::scoped_lock only_one(mutex_);
  const auto now = std::chrono::steady_clock::now();
  if (error_) return false;
  const bool is_news = callback_ && fraction >= 1.0 && told_ < 1.0;
  if (!is_news && now - last_ < std::chrono::milliseconds(20)) return true;
  last_ = now;
  const py::gil_scoped_acquire acquire;
  try {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!callback_ || callback_.is_none()) return true;
    told_ = fraction;
    return !is_false(callback_(fraction));
  } catch (...) {
    error_ = std::current_exception();
    return false;
  }
}

namespace {

std::timed_mutex& file_mutex() {
  static std::timed_mutex mutex;
  return mutex;
}
thread_local bool has_files = false;

}  // namespace

FileLock::FileLock(const Progress& progress) {
  if (has_files)
    throw Error(ErrorCode::InvalidArgument,
                "a progress function reads or writes another file while its call reads or writes a file; expected it "
                "to wait until that call is done");
  while (!file_mutex().try_lock_for(std::chrono::milliseconds(50)))
    if (progress && !progress(0.0))
      throw Error(ErrorCode::Cancelled, "cancelled while another file is read or written");
  has_files = true;
}
FileLock::~FileLock() {
  has_files = false;
  file_mutex().unlock();
}

ExtractOptions extract_options(const py::dict& arguments, Call& call) {
  const auto text = [&](const char* name) { return py::cast<std::string>(arguments[name]); };
  ExtractOptions result;
  result.triangulation =
      named<Triangulation>("triangulation", text("triangulation"),
                           {{"compact", Triangulation::compact}, {"barycentric", Triangulation::barycentric}});
  result.ambiguity = named<Ambiguity>("ambiguity", text("ambiguity"),
                                      {{"low", Ambiguity::low},
                                       {"high", Ambiguity::high},
                                       {"mean", Ambiguity::mean},
                                       {"saddle", Ambiguity::saddle},
                                       {"squares", Ambiguity::squares},
                                       {"decider", Ambiguity::decider}});
  result.direction = named<GradientDirection>("direction", text("direction"), gradient_directions());
  const std::string normals = text("normals");
  // geometric and flat normals are computed later
  for (const Normals kind : kNormals)
    if (name_of(kind) == normals) result.normals = kind;
  result.kernel.weights = py::cast<std::vector<double>>(arguments["kernel"]);
  result.close = py::cast<bool>(arguments["close"]);
  result.epsilon = py::cast<double>(arguments["epsilon"]);
  result.work.threads = py::cast<unsigned>(arguments["threads"]);
  result.work.progress = call.progress();
  return result;
}

namespace {

/// The Python exception that corresponds to an error code.
PyObject* exception_of(ErrorCode code, PyObject* cancelled) {
  switch (code) {
    case ErrorCode::FileNotFound:
      return PyExc_FileNotFoundError;
    case ErrorCode::WriteFailed:
      return PyExc_OSError;
    case ErrorCode::TooLarge:
      return PyExc_OverflowError;
    case ErrorCode::Cancelled:
      return cancelled;
    default:
      return PyExc_ValueError;
  }
}

}  // namespace

}  // namespace tegl::python

PYBIND11_MODULE(_tegl, m) {
  using namespace tegl::python;
  m.doc() = "The compiled part of tegl. Axes are in the library's order here: use the package tegl.";
  // NOLINTNEXTLINE(cppcoreguidelines-owning-memory): the module keeps it as long as the interpreter lives.
  static PyObject* const cancelled = PyErr_NewExceptionWithDoc(
      "tegl.Cancelled", "A progress function returned False, which cancelled the call.", PyExc_RuntimeError, nullptr);
  m.add_object("Cancelled", py::reinterpret_borrow<py::object>(cancelled));
  py::register_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const tegl::Error& error) {
      PyErr_SetString(exception_of(error.code(), cancelled), error.what());
    }
  });
  m.attr("__version__") = TEGL_VERSION;
  py::dict docs;
  for (const auto& [name, text] : doc::kAll) docs[name] = text;
  m.attr("docs") = docs;
  bind_contour(m);
  bind_extract(m);
  bind_incidence(m);
  bind_operations(m);
  bind_elements(m);
  bind_track(m);
  bind_index(m);
  bind_files(m);
  bind_filter(m);
  bind_marching_cubes(m);
  bind_mesh(m);
  bind_facets(m);
}
