// SPDX-License-Identifier: BSD-3-Clause
//
// Errors and progress, the same for every part of the library.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

namespace tegl {

/// What went wrong, of which kind.
enum class ErrorCode {
  InvalidArgument,    ///< an option or parameter outside of what it may be
  InvalidGrid,        ///< sizes, strides or axes that make no grid
  InvalidIsovalue,    ///< NaN or infinite
  EmptyResult,        ///< nothing at this isovalue or cut (raised by programs, not by `extract`)
  FileNotFound,       ///< no such file, or not readable
  MalformedFile,      ///< the file is damaged or contradicts itself
  UnsupportedFormat,  ///< a format, or an extension, that nothing here reads or writes
  UnsupportedData,    ///< a sound file whose content (dimension, value type) does not fit
  VariableNotFound,   ///< a file with several variables (or DICOM series), and none by that name
  WriteFailed,        ///< the output could not be written; nothing is left behind
  TooLarge,           ///< more vertices than the index type can number
  Cancelled,          ///< the progress callback said stop
};

/// The name of a code as in the enumeration, for messages and JSON.
const char* error_name(ErrorCode code) noexcept;

/// The one exception type of the library. `what()` says the actual and the expected value. Where memory runs out,
/// std::bad_alloc passes through it: nothing is lost then, and no half-written file is left.
class Error : public std::runtime_error {
 public:
  /// `message`: the actual and the expected value, and the file or option by name.
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  [[nodiscard]] ErrorCode code() const noexcept { return code_; }  ///< of which kind

 private:
  ErrorCode code_;
};

/// Called with a fraction in [0, 1] now and then by every long operation; returning false stops it,
/// and the operation throws `Error{Cancelled}`.
using Progress = std::function<bool(double fraction)>;

/// What every long operation on contours takes.
struct WorkOptions {
  unsigned threads = 0;    ///< how many work; 0: all that the machine has. The result is the same, byte by byte.
  Progress progress = {};  ///< called now and then
};

}  // namespace tegl
