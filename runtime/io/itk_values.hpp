// SPDX-License-Identifier: BSD-3-Clause
//
// The values of NRRD and MetaImage files through ITK. Geometry comes from the headers (nrrd.cpp, metaimage.cpp), as
// ITK narrows it to orthonormal directions. Nothing of Eigen is included here: ITK brings its own, older one.
//
// Neither function is thread-safe: the libraries keep global state, and their own output is switched off for the
// whole process during the call. Nothing is printed, and no ITK exception leaves.
#pragma once

#include <cstdint>
#include <filesystem>

#include "value_array.hpp"

namespace tegl::io_detail {

/// All values of a MetaImage, of one number per sample. `expected`: how many the header promises.
/// Errors: MalformedFile with ITK's reason, or where ITK sees another number; TooLarge when memory runs out.
ValueArray read_metaimage_values(const std::filesystem::path& path, std::uint64_t expected);

/// All values of an NRRD, in the order of the file. Through ITK's NrrdIO library and not its ImageIO class, which
/// refuses files with time beside a three-dimensional space. Errors as above.
ValueArray read_nrrd_values(const std::filesystem::path& path, std::uint64_t expected);

}  // namespace tegl::io_detail
