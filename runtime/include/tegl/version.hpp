// SPDX-License-Identifier: BSD-3-Clause
//
// The version of the library, by Semantic Versioning. CMake reads it from here.
#pragma once

/// Incompatible changes.
#define TEGL_VERSION_MAJOR 0
/// Additions; before 1.0, incompatible changes too.
#define TEGL_VERSION_MINOR 1
/// Corrections.
#define TEGL_VERSION_PATCH 0

namespace tegl {

inline constexpr int kVersionMajor = TEGL_VERSION_MAJOR;  ///< TEGL_VERSION_MAJOR
inline constexpr int kVersionMinor = TEGL_VERSION_MINOR;  ///< TEGL_VERSION_MINOR
inline constexpr int kVersionPatch = TEGL_VERSION_PATCH;  ///< TEGL_VERSION_PATCH

}  // namespace tegl
