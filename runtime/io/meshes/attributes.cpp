// SPDX-License-Identifier: BSD-3-Clause
//
// Implements validation and file names of attributes.
#include "meshes/attributes.hpp"

#include <algorithm>
#include <cmath>

#include "base/common.hpp"

namespace tegl::io_detail {

void check_attributes(std::span<const Attribute> attributes, std::size_t rows, std::string_view what,
                      const std::filesystem::path& path) {
  std::set<std::string_view> names;
  for (const Attribute& attribute : attributes) {
    if (attribute.name.empty() || !names.insert(attribute.name).second)
      fail(ErrorCode::InvalidArgument, path, "attribute of {} with the name '{}'; expected different names, not empty",
           what, attribute.name);
    if (attribute.width < 1 || attribute.values.size() != rows * static_cast<std::size_t>(attribute.width))
      fail(ErrorCode::InvalidArgument, path, "attribute '{}' of {} numbers, {} for each of {} {}; expected {}",
           attribute.name, attribute.values.size(), attribute.width, rows, what,
           attribute.width < 1 ? "a width of 1 or more"
                               : std::to_string(rows * static_cast<std::size_t>(attribute.width)));
  }
}

bool is_color_of_bytes(const Attribute& attribute) {
  return attribute.name == kColorName && attribute.width == 3 &&
         std::all_of(attribute.values.begin(), attribute.values.end(), [](double value) {
           return value >= 0.0 && value <= 1.0 && std::round(255.0 * value) / 255.0 == value;
         });
}

std::string FileNames::make(const std::string& wished) {
  if (taken_.insert(wished).second) return wished;
  // All numbers below `next` are taken, so each of many equal names needs one step.
  std::size_t& next = next_.try_emplace(wished, 2).first->second;
  for (;;)
    if (std::string name = fmt::format("{}_{}", wished, next++); taken_.insert(name).second) return name;
}

std::string as_word(std::string_view text) {
  std::string word(text);
  for (char& c : word) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!plain) c = '_';
  }
  return word.empty() ? "_" : word;
}

}  // namespace tegl::io_detail
