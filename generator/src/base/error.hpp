// SPDX-License-Identifier: BSD-3-Clause
//
// The exception type of the generator. The generator does not link the runtime, so it has its own. Each code is also an
// exit status of the program `gen`.
#pragma once

#include <stdexcept>
#include <string>

namespace tegl::gen {

/// Kind of error. The values are exit codes of `gen` and must not change.
enum class ErrorCode {
  Internal = 1,           ///< an invariant of the generator does not hold: a fault in it, or exhausted memory
  InvalidArgument = 2,    ///< an option or parameter outside its valid range
  CountMismatch = 3,      ///< two independent counts of the same quantity disagree
  CertificateFailed = 4,  ///< a filled tile did not pass its certificate
  WriteFailed = 5,        ///< output could not be written
};

/// An error with its code. `what()` contains the actual and the expected value.
class Error : public std::runtime_error {
 public:
  /// `message`: the actual and the expected value.
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  [[nodiscard]] ErrorCode code() const noexcept { return code_; }  ///< the kind of error

 private:
  ErrorCode code_;
};

}  // namespace tegl::gen
