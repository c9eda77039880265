// SPDX-License-Identifier: BSD-3-Clause
//
// Measures the nesting of sequences in a DICOM file without recursion. DCMTK recurses for each level, and a file of
// some hundred kilobytes can have enough levels to overflow the stack.
#pragma once

#include <filesystem>
#include <optional>

#include "tegl/error.hpp"

namespace tegl::io_detail {

/// Maximum nesting depth of sequences that are read.
inline constexpr int kDeepestSequence = 64;

/// MalformedFile if sequences are nested deeper than `kDeepestSequence`, else nullopt, also for files that are not
/// DICOM. One pass over tags and lengths for each encoding that DCMTK may assume; values are skipped.
std::optional<Error> nesting_fault(const std::filesystem::path& path);

}  // namespace tegl::io_detail
