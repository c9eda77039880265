// SPDX-License-Identifier: BSD-3-Clause
//
// Where the program writes: results to standard output, everything else to standard error. Colours only
// on a terminal, and not where NO_COLOR (https://no-color.org) or TERM=dumb asks for none.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace tegl::cli {

/// A text with the escapes of a terminal's colours.
struct Styled {
  std::string text;
};

/// Whoever read from standard output reads no more. The shell expects an end by SIGPIPE.
struct BrokenPipe {};

/// One stream of the program and what can be shown on it.
class Console {
 public:
  /// Looks at the stream once: is it a terminal, are colours wanted. The stream must outlive this.
  explicit Console(std::FILE* stream);

  [[nodiscard]] bool is_terminal() const noexcept { return terminal_; }
  /// Whether it is a terminal where what was written can be written over.
  [[nodiscard]] bool moves_its_cursor() const noexcept { return moves_; }
  /// Columns of the terminal now; elsewhere $COLUMNS, or 80.
  [[nodiscard]] int width() const;
  /// Lines of the terminal now; 24 elsewhere.
  [[nodiscard]] int height() const;

  /// Whether texts are shown in colours.
  [[nodiscard]] bool has_colours() const noexcept { return colours_; }
  /// The text, made printable, in bold, or in red, if the stream shows colours.
  [[nodiscard]] std::string bold(std::string_view text) const { return styled("1", text); }
  [[nodiscard]] Styled red(std::string_view text) const { return {styled("31;1", text)}; }
  [[nodiscard]] Styled green(std::string_view text) const { return {styled("32", text)}; }

  /// Writes the text at once. What comes from files or the command line has to be printable (printable.hpp). Throws
  /// WriteFailed, or BrokenPipe, if standard output cannot be written.
  void write(std::string_view text) const;

 private:
  [[nodiscard]] std::string styled(std::string_view code, std::string_view text) const;

  std::FILE* stream_;
  bool terminal_;
  bool moves_;
  bool colours_;
};

}  // namespace tegl::cli
