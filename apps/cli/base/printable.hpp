// SPDX-License-Identifier: BSD-3-Clause
//
// Escapes control characters in texts of files, names and command lines: they could move a terminal's cursor, change
// its settings, or disguise a text.
#pragma once

#include <string>
#include <string_view>

namespace tegl::cli {

/// Escapes characters that must not be displayed directly: \xHH for C0 control characters, DEL and invalid UTF-8;
/// \uHHHH for C1 control characters, line and paragraph separators, and characters that change the text direction.
/// Other text is unchanged.
std::string printable(std::string_view text);

/// As `printable` for valid JSON: escapes DEL and the characters that `printable` writes as \uHHHH, in the form that
/// JSON allows. Parses to the same strings.
std::string printable_json(std::string_view json);

}  // namespace tegl::cli
