// SPDX-License-Identifier: BSD-3-Clause
//
// Names of error codes.
#include "tegl/error.hpp"

namespace tegl {

std::string_view name_of(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::InvalidArgument:
      return "InvalidArgument";
    case ErrorCode::InvalidGrid:
      return "InvalidGrid";
    case ErrorCode::InvalidIsovalue:
      return "InvalidIsovalue";
    case ErrorCode::FileNotFound:
      return "FileNotFound";
    case ErrorCode::MalformedFile:
      return "MalformedFile";
    case ErrorCode::UnsupportedFormat:
      return "UnsupportedFormat";
    case ErrorCode::UnsupportedData:
      return "UnsupportedData";
    case ErrorCode::VariableNotFound:
      return "VariableNotFound";
    case ErrorCode::WriteFailed:
      return "WriteFailed";
    case ErrorCode::TooLarge:
      return "TooLarge";
    case ErrorCode::Cancelled:
      return "Cancelled";
  }
  return "Unknown";
}

}  // namespace tegl
