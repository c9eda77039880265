// SPDX-License-Identifier: BSD-3-Clause
//
// Arrays of NumPy: .npy, and .npz with several of them.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "images/stored_image.hpp"

namespace tegl::io_detail {

/// Reads the header of an .npy file.
StoredImage open_npy(const std::filesystem::path& path);

/// Reads the header of an array in an .npz file. `variable`: its name; may be empty if there is one array. Errors:
/// VariableNotFound, which lists the arrays.
StoredImage open_npz(const std::filesystem::path& path, std::string_view variable);

/// The arrays of an .npz file that are readable as images.
std::vector<ImageVariable> list_npz(const std::filesystem::path& path);

}  // namespace tegl::io_detail
