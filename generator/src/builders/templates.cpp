// SPDX-License-Identifier: BSD-3-Clause
//
// Replacement of placeholders in templates, and division of long lines.
#include "builders/templates.hpp"

#include <algorithm>
#include <vector>

#include "base/error.hpp"

namespace tegl::gen {

namespace {

bool is_name(char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; }

/// The placeholder that begins at the sign `@` at `at`, without its signs; empty if there is none.
std::string_view placeholder_at(std::string_view text, std::size_t at) {
  std::size_t end = at + 1;
  while (end < text.size() && is_name(text[end])) ++end;
  if (end == at + 1 || end == text.size() || text[end] != '@') return {};
  return text.substr(at + 1, end - at - 1);
}

/// Appends whole lines, each behind `indentation`; empty lines get none.
void append_lines(std::string& result, std::string_view lines, std::string_view indentation) {
  for (std::size_t first = 0; first < lines.size();) {
    const std::size_t end = std::min(lines.find('\n', first), lines.size() - 1) + 1;
    if (lines[first] != '\n') result += indentation;
    result += lines.substr(first, end - first);
    first = end;
  }
}

constexpr std::size_t kColumns = 120;

/// Where a line may be divided: the number of characters that stay in it, without a space at the end; 0 if nowhere.
std::size_t place_to_divide(std::string_view line, bool is_comment, std::size_t indentation) {
  if (is_comment) {
    const std::size_t space = line.rfind(' ', kColumns);
    return space == std::string_view::npos || space <= indentation + 3 ? 0 : space;
  }
  const std::size_t comma = line.rfind(',', kColumns - 1);
  return comma == std::string_view::npos || comma <= indentation ? 0 : comma + 1;
}

}  // namespace

std::string with_short_lines(std::string_view text) {
  std::string result;
  for (std::size_t first = 0; first < text.size();) {
    const std::size_t end = std::min(text.find('\n', first), text.size());
    std::string line(text.substr(first, end - first));
    first = end + 1;
    const std::size_t indentation = std::min(line.find_first_not_of(' '), line.size());
    const bool is_comment = line.compare(indentation, 2, "//") == 0;
    const bool is_list = line.find_first_of("\";") > kColumns && line.find("//") == std::string::npos;
    while (line.size() > kColumns && (is_comment || is_list)) {
      const std::size_t at = place_to_divide(line, is_comment, indentation);
      if (at == 0) break;
      const std::size_t rest = std::min(line.find_first_not_of(' ', at), line.size());
      const std::string again =
          is_comment ? line.substr(0, line.find_first_of(' ', indentation) + 1) : std::string(indentation, ' ');
      result += line.substr(0, at) + "\n";
      line = again + line.substr(rest);
    }
    result += line + "\n";
  }
  return result;
}

std::string filled(std::string_view name, std::initializer_list<Placeholder> texts) {
  const std::string_view text = template_text(name);
  std::vector<std::string_view> used;
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::string_view found = text[at] == '@' ? placeholder_at(text, at) : std::string_view{};
    if (found.empty()) {
      result += text[at++];
      continue;
    }
    const auto* const with = std::find_if(texts.begin(), texts.end(), [&](const auto& t) { return t.first == found; });
    if (with == texts.end())
      throw Error(ErrorCode::Internal, std::string(name) + ": no text for the placeholder " + std::string(found));
    used.push_back(found);
    const std::size_t end = at + found.size() + 2;
    const std::size_t line = result.rfind('\n') == std::string::npos ? 0 : result.rfind('\n') + 1;
    const std::string indentation = result.substr(line);
    const bool alone =
        indentation.find_first_not_of(' ') == std::string::npos && end < text.size() && text[end] == '\n';
    if (alone) {
      result.resize(line);
      append_lines(result, with->second, indentation);
      at = end + 1;
    } else {
      result += with->second;
      at = end;
    }
  }
  for (const auto& [placeholder, with] : texts)
    if (std::find(used.begin(), used.end(), placeholder) == used.end())
      throw Error(ErrorCode::Internal, std::string(name) + ": no placeholder " + std::string(placeholder));
  return result;
}

}  // namespace tegl::gen
