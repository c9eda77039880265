// SPDX-License-Identifier: BSD-3-Clause
//
// The report of `tegl info` about index files.
#pragma once

#include <filesystem>
#include <string>

#include "base/console.hpp"

namespace tegl::cli {

/// Whether a file is an index, by its name.
bool is_index_file(const std::filesystem::path& path);

/// The header of an index file, as text or as JSON. Throws MalformedFile, UnsupportedFormat.
std::string index_info(const Console& console, const std::filesystem::path& path, bool json);

}  // namespace tegl::cli
