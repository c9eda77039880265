// SPDX-License-Identifier: BSD-3-Clause
//
// Output of the program: results to standard output, everything else to standard error. Colours only on a terminal, and
// not if NO_COLOR (https://no-color.org) or TERM=dumb is set.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace tegl::cli {

/// A text with terminal colour escapes.
struct Styled {
  std::string text;
};

/// Thrown if the reader of standard output has closed it. The shell expects an end by SIGPIPE.
struct BrokenPipe {};

/// One output stream, and what it can display.
class Console {
 public:
  /// Checks once whether the stream is a terminal and colours are wanted. The stream must outlive this object.
  explicit Console(std::FILE* stream);

  [[nodiscard]] bool is_terminal() const noexcept { return terminal_; }
  /// Whether the stream is a terminal that can overwrite its output.
  [[nodiscard]] bool moves_its_cursor() const noexcept { return moves_; }
  /// Current columns of the terminal; otherwise $COLUMNS, or 80.
  [[nodiscard]] int width() const;
  /// Current lines of the terminal; otherwise 24.
  [[nodiscard]] int height() const;

  /// Whether texts are displayed in colours.
  [[nodiscard]] bool has_colours() const noexcept { return colours_; }
  /// The printable text, in bold or red if the stream displays colours.
  [[nodiscard]] std::string bold(std::string_view text) const { return styled("1", text); }
  [[nodiscard]] Styled red(std::string_view text) const { return {styled("31;1", text)}; }
  [[nodiscard]] Styled green(std::string_view text) const { return {styled("32", text)}; }

  /// Writes and flushes the text. Texts from files or the command line must be printable (printable.hpp). Throws
  /// WriteFailed or BrokenPipe if standard output cannot be written.
  void write(std::string_view text) const;

 private:
  [[nodiscard]] std::string styled(std::string_view code, std::string_view text) const;

  std::FILE* stream_;
  bool terminal_;
  bool moves_;
  bool colours_;
};

}  // namespace tegl::cli
