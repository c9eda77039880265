// SPDX-License-Identifier: BSD-3-Clause
//
// Paths of files that another file names: data files of a header, buffers, external links.
#pragma once

#include <filesystem>
#include <string>

namespace tegl::io_detail {

/// The path of the file `name` in the file `header`: relative to the folder of `header`, or absolute.
///
/// Unless `allow_outside`, the file must lie in the folder of `header` or below, after resolution of `..` and symbolic
/// links. A missing file is resolved as far as its folders exist. Errors: MalformedFile for an invalid name (longer
/// than 4096 bytes, or with a zero byte); UnsupportedData for a file outside of the folder, with path, folder and
/// option in the message; FileNotFound if a folder on the path cannot be read.
std::filesystem::path named_path(const std::filesystem::path& header, const std::string& name, bool allow_outside);

}  // namespace tegl::io_detail
