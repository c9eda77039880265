// SPDX-License-Identifier: BSD-3-Clause
//
// Texts of files, names and command lines as they may be shown: control characters in them could move a terminal's
// cursor, change its settings or make a text look like another one.
#pragma once

#include <string>
#include <string_view>

namespace tegl::cli {

/// The text with escapes in place of what is not to be shown as it is: \xHH for C0 control characters, DEL and bytes
/// that are no UTF-8; \uHHHH for C1 control characters, line and paragraph separators, and characters that change the
/// direction of the text. Without any of these the text is unchanged.
std::string printable(std::string_view text);

/// The same for JSON that is valid already: DEL and the characters that `printable` writes as \uHHHH, which JSON
/// allows, as such escapes. Reads back as the same strings.
std::string printable_json(std::string_view json);

}  // namespace tegl::cli
