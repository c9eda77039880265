// SPDX-License-Identifier: BSD-3-Clause
//
// The version of the library, by Semantic Versioning. CMake reads it from here.
#pragma once

#define TEGL_VERSION_MAJOR 0
#define TEGL_VERSION_MINOR 1
#define TEGL_VERSION_PATCH 0

namespace tegl {

inline constexpr int kVersionMajor = TEGL_VERSION_MAJOR;
inline constexpr int kVersionMinor = TEGL_VERSION_MINOR;
inline constexpr int kVersionPatch = TEGL_VERSION_PATCH;

}  // namespace tegl
