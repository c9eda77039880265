// SPDX-License-Identifier: BSD-3-Clause
//
// Implements escapes for text that must not control the terminal.
//
// Based on: The Unicode Standard, version 15, sections 3.9 (well-formed UTF-8, table 3-7) and 23.2 (bidirectional
// ordering controls).
#include "base/printable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace tegl::cli {

namespace {

/// A character of a text, or an invalid byte.
struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 1;
  bool is_valid = true;
};

/// The first character of a non-empty text.
Character first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i])); };
  const std::uint32_t lead = byte(0);
  if (lead < 0x80) return {lead, 1, true};
  const std::size_t count = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  const Character invalid{lead, 1, false};
  if (lead < 0xc2 || lead > 0xf4 || text.size() < count) return invalid;
  std::uint32_t code = lead & (0xffU >> (count + 1));
  for (std::size_t i = 1; i < count; ++i) {
    if ((byte(i) & 0xc0U) != 0x80U) return invalid;
    code = code << 6 | (byte(i) & 0x3fU);
  }
  constexpr std::array<std::uint32_t, 5> kLeast = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xd800 && code <= 0xdfff;
  if (code < kLeast.at(count) || code > 0x10ffff || is_surrogate) return invalid;
  return {code, count, true};
}

bool is_control(std::uint32_t code) { return code < 0x20 || (code >= 0x7f && code < 0xa0); }

/// Whether a character has no glyph and changes the layout of others.
bool changes_layout(std::uint32_t code) {
  constexpr std::array<std::pair<std::uint32_t, std::uint32_t>, 5> kRanges = {
      {{0x61c, 0x61c}, {0x200e, 0x200f}, {0x2028, 0x2029}, {0x202a, 0x202e}, {0x2066, 0x2069}}};
  return std::any_of(kRanges.begin(), kRanges.end(),
                     [&](const auto& range) { return code >= range.first && code <= range.second; });
}

template <class Escape>
std::string replaced(std::string_view text, const Escape& escape) {
  std::string result;
  while (!text.empty()) {
    const Character character = first_character(text);
    const std::string escaped = escape(character);
    result += escaped.empty() ? std::string(text.substr(0, character.bytes)) : escaped;
    text.remove_prefix(character.bytes);
  }
  return result;
}

}  // namespace

std::string printable(std::string_view text) {
  return replaced(text, [](const Character& character) {
    if (!character.is_valid || (is_control(character.code) && character.code < 0x80))
      return fmt::format("\\x{:02x}", character.code);
    const bool is_shown = !is_control(character.code) && !changes_layout(character.code);
    return is_shown ? std::string() : fmt::format("\\u{:04x}", character.code);
  });
}

std::string printable_json(std::string_view json) {
  return replaced(json, [](const Character& character) {
    const bool is_escaped =
        character.is_valid && character.code >= 0x7f && (is_control(character.code) || changes_layout(character.code));
    return is_escaped ? fmt::format("\\u{:04x}", character.code) : std::string();
  });
}

}  // namespace tegl::cli
