// SPDX-License-Identifier: BSD-3-Clause
//
// Implements output to terminals and other streams.
#include "base/console.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "base/numbers.hpp"
#include "base/printable.hpp"
#include "tegl/error.hpp"

namespace tegl::cli {

namespace {

std::string_view environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string_view() : std::string_view(value);
}

}  // namespace

Console::Console(std::FILE* stream)
    : stream_(stream),
      terminal_(isatty(fileno(stream)) == 1),
      moves_(terminal_ && !environment("TERM").empty() && environment("TERM") != "dumb"),
      colours_(terminal_ && environment("NO_COLOR").empty() && environment("TERM") != "dumb") {}

int Console::width() const {
  winsize size{};
  if (terminal_ && ioctl(fileno(stream_), TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  constexpr double kMost = 1000;
  const auto columns = parse_number(environment("COLUMNS"));
  return columns && *columns >= 1 && *columns <= kMost ? static_cast<int>(*columns) : 80;
}

int Console::height() const {
  constexpr int kUsual = 24;
  winsize size{};
  return terminal_ && ioctl(fileno(stream_), TIOCGWINSZ, &size) == 0 && size.ws_row > 0 ? size.ws_row : kUsual;
}

void Console::write(std::string_view text) const {
  const bool written = std::fwrite(text.data(), 1, text.size(), stream_) == text.size() && std::fflush(stream_) == 0;
  if (written || stream_ != stdout) return;
  if (errno == EPIPE) throw BrokenPipe();
  throw Error(ErrorCode::WriteFailed, fmt::format("standard output cannot be written ({})", std::strerror(errno)));
}

std::string Console::styled(std::string_view code, std::string_view text) const {
  const std::string shown = printable(text);
  return colours_ ? fmt::format("\x1b[{}m{}\x1b[0m", code, shown) : shown;
}

}  // namespace tegl::cli
