// SPDX-License-Identifier: BSD-3-Clause
//
// How deeply sequences of a DICOM file are nested, found without recursion: DCMTK calls itself for each level, and a
// file of some hundred kilobytes has enough levels to overflow the stack.
#pragma once

#include <filesystem>
#include <optional>

#include "tegl/error.hpp"

namespace tegl::io_detail {

/// Sequences in each other that are read.
inline constexpr int kDeepestSequence = 64;

/// MalformedFile if sequences are nested deeper than `kDeepestSequence`; else nothing, also for a file that is not
/// DICOM. One pass over tags and lengths for each encoding that DCMTK may take the file for; values are skipped.
std::optional<Error> nesting_fault(const std::filesystem::path& path);

}  // namespace tegl::io_detail
