// SPDX-License-Identifier: BSD-3-Clause
//
// The values of NRRD and MetaImage files through the libraries that ITK reads them with, NrrdIO and MetaIO. Not through
// ITK's ImageIO classes: they refuse a time axis beside three axes of space, and their headers, as Debian ships them,
// any compiler but g++. Geometry comes from the headers (nrrd.cpp, metaimage.cpp).
//
// Neither function is thread-safe: the libraries keep global state, and what MetaIO prints is switched off for the
// whole process during the call.
#pragma once

#include <cstdint>
#include <filesystem>

#include "value_array.hpp"

namespace tegl::io_detail {

/// Fills `values`, of the type that the header says, with the `expected` values of a MetaImage of one number per
/// sample. Errors: MalformedFile if MetaIO cannot read it or sees another number; TooLarge when memory runs out.
void read_metaimage_values(const std::filesystem::path& path, std::uint64_t expected, ValueArray& values);

/// All values of an NRRD, in the order of the file. Errors: as above, and UnsupportedData for values that are blocks.
ValueArray read_nrrd_values(const std::filesystem::path& path, std::uint64_t expected);

}  // namespace tegl::io_detail
