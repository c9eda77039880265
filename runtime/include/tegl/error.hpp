// SPDX-License-Identifier: BSD-3-Clause
//
// Error codes and the exception type of the library.
#pragma once

#include <stdexcept>
#include <string>

namespace tegl {

/// Kinds of errors.
enum class ErrorCode {
  InvalidArgument,    ///< an option or parameter is out of its range
  InvalidGrid,        ///< sizes, strides or axes that do not form a grid
  InvalidIsovalue,    ///< NaN or infinite
  FileNotFound,       ///< the file does not exist or is not readable
  MalformedFile,      ///< the file is damaged or contradicts itself
  UnsupportedFormat,  ///< a format or extension that is not supported
  UnsupportedData,    ///< a valid file whose content (dimension, value type) is not supported
  VariableNotFound,   ///< the file has several variables (or DICOM series), none of this name
  WriteFailed,        ///< the output could not be written; nothing is left behind
  TooLarge,           ///< a size beyond a limit, such as more vertices than the index type can number
  Cancelled,          ///< the progress callback returned false
};

/// The name of a code as in the enumeration, for messages and JSON.
[[nodiscard]] const char* error_name(ErrorCode code) noexcept;

/// The exception type of the library. `what()` contains the actual and the expected value. If memory runs out,
/// std::bad_alloc is thrown instead; the library stays usable and leaves no partial file.
class Error : public std::runtime_error {
 public:
  /// `message`: the actual and the expected value, and the name of the file or option.
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  [[nodiscard]] ErrorCode code() const noexcept { return code_; }  ///< the kind of error

 private:
  ErrorCode code_;
};

}  // namespace tegl
