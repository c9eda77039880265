// SPDX-License-Identifier: BSD-3-Clause
//
// Writing of text to a pending file: for the program, which puts several files in place together.
#pragma once

#include <string_view>

namespace tegl {

class PendingPath;

/// As write_text of tegl/io/text.hpp; the caller commits the file.
void write_text(std::string_view text, const PendingPath& file);

}  // namespace tegl
