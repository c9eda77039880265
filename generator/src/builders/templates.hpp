// SPDX-License-Identifier: BSD-3-Clause
//
// The texts of generator/templates, embedded into the program, their placeholders `@name@`, and the width of lines.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

namespace tegl::gen {

/// The text of generator/templates/NAME.in. Throws Error{Internal} if there is none.
[[nodiscard]] std::string_view template_text(std::string_view name);

/// The name of a placeholder, without its signs, and the text that replaces it.
using Placeholder = std::pair<std::string_view, std::string>;

/// The template with all placeholders replaced. The text of a placeholder that is alone on its line consists of
/// complete lines, or is empty; each line gets the placeholder's indentation, and the placeholder's line disappears.
/// Throws Error{Internal} for a placeholder without text and for a text without placeholder.
[[nodiscard]] std::string filled(std::string_view name, std::initializer_list<Placeholder> texts);

/// The text with lines of at most 120 columns: comments are divided at spaces, lists of numbers behind commas. Lines
/// with other code, with a string, or with a comment behind code stay as they are.
[[nodiscard]] std::string with_short_lines(std::string_view text);

}  // namespace tegl::gen
