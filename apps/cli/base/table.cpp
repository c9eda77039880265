// SPDX-License-Identifier: BSD-3-Clause
//
// Formats tables as aligned columns and CSV.
#include "base/table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/printable.hpp"

namespace tegl::cli {

namespace {

/// Number of characters of a UTF-8 text.
std::size_t characters(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0u) != 0x80u; }));
}

std::string csv_cell(const std::string& cell) {
  if (cell.find_first_of(",\"\r\n") == std::string::npos) return cell;
  std::string quoted = "\"";
  for (const char c : cell) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

}  // namespace

std::string exact_number(double value) { return fmt::format("{}", value); }

std::string Table::to_text(std::size_t most) const {
  std::vector<std::vector<std::string>> lines = {headings};
  for (std::size_t r = 0; r < std::min(most, rows.size()); ++r) lines.push_back(rows[r]);
  std::vector<std::size_t> widths(headings.size(), 0);
  for (auto& cells : lines)
    for (std::size_t c = 0; c < widths.size(); ++c) {
      cells[c] = printable(cells[c]);
      widths[c] = std::max(widths[c], characters(cells[c]));
    }
  std::string text;
  for (const auto& cells : lines) {
    for (std::size_t c = 0; c < widths.size(); ++c)
      text += std::string(2 + widths[c] - characters(cells[c]), ' ') + cells[c];
    text += '\n';
  }
  return text;
}

std::string Table::to_csv() const {
  std::string text;
  const auto add = [&](const std::vector<std::string>& cells) {
    for (std::size_t c = 0; c < cells.size(); ++c) text += (c == 0 ? "" : ",") + csv_cell(cells[c]);
    text += '\n';
  };
  add(headings);
  for (const auto& row : rows) add(row);
  return text;
}

}  // namespace tegl::cli
