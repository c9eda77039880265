// SPDX-License-Identifier: BSD-3-Clause
//
// The values of an image file through an ITK ImageIO. Geometry comes from the headers (nifti.cpp, nrrd.cpp,
// metaimage.cpp), as ITK narrows it to orthonormal directions and six digits. Nothing of Eigen is included here: ITK
// brings its own, older one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "value_array.hpp"

namespace tegl::io_detail {

enum class ItkFormat { Nifti, Nrrd, MetaImage };

struct ItkValues {
  ValueArray values;
  std::size_t components = 1;  ///< per pixel, running fastest
};

/// Reads all values; `expected` is the number of numbers that the header promises (samples times components).
/// Errors: MalformedFile with ITK's reason, or where ITK sees another size; UnsupportedData for value types that
/// ITK cannot deliver as numbers. Nothing is printed and no ITK exception leaves. Not thread-safe: ITK's and the
/// format libraries' own output is switched off for the whole process during the call.
ItkValues read_itk_values(ItkFormat format, const std::filesystem::path& path, std::uint64_t expected);

}  // namespace tegl::io_detail
