// SPDX-License-Identifier: BSD-3-Clause
//
// The one exception type of the generator. The generator links nothing of the runtime, so it has its own;
// each code is also the exit status of the program `gen`.
#pragma once

#include <stdexcept>
#include <string>

namespace tegl::gen {

/// What went wrong. The values are the exit codes of `gen` and stay as they are.
enum class ErrorCode {
  Internal = 1,           ///< an invariant of the generator does not hold: a fault in it, or exhausted memory
  InvalidArgument = 2,    ///< an option or parameter outside of what it may be
  CountMismatch = 3,      ///< two independent counts of one thing disagree
  CertificateFailed = 4,  ///< a filled tile did not pass its certificate
  WriteFailed = 5,        ///< output could not be written
};

/// `what()` says the actual and the expected value.
class Error : public std::runtime_error {
 public:
  /// `message`: the actual and the expected value.
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  [[nodiscard]] ErrorCode code() const noexcept { return code_; }  ///< of which kind

 private:
  ErrorCode code_;
};

}  // namespace tegl::gen
