// SPDX-License-Identifier: BSD-3-Clause
//
// Writing of text files. Link with tegl::io.
#pragma once

#include <filesystem>
#include <string_view>

namespace tegl {

/// Writes text unchanged: tables and graphs. The file appears complete or not at all. Errors: WriteFailed.
void write_text(std::string_view text, const std::filesystem::path& path);

}  // namespace tegl
