// SPDX-License-Identifier: BSD-3-Clause
//
// Paths of further files that a file names: data beside a header, buffers, external links.
#pragma once

#include <filesystem>
#include <string>

namespace tegl::io_detail {

/// The path of the file `name` that `header` names: relative to the folder of `header`, or absolute.
///
/// Unless `allow_outside`, the file must lie in the folder of `header` or below it, after `..` and symbolic links have
/// been resolved. A file that does not exist is resolved as far as its folders exist.
/// Errors: MalformedFile for a name that no path can be (longer than 4096 bytes, or with a byte 0); UnsupportedData for
/// a file outside of the folder, with the path, the folder and the option in the message; FileNotFound if a folder on
/// the way cannot be read.
std::filesystem::path named_path(const std::filesystem::path& header, const std::string& name, bool allow_outside);

}  // namespace tegl::io_detail
