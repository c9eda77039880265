// SPDX-License-Identifier: BSD-3-Clause
//
// Attributes of meshes in files: validation, and names that file formats allow.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "tegl/contour.hpp"

namespace tegl::io_detail {

/// Throws InvalidArgument unless all names are different and not empty, and each attribute has `rows` rows of its
/// width. `what` is the name of the rows in the message.
void check_attributes(std::span<const Attribute> attributes, std::size_t rows, std::string_view what,
                      const std::filesystem::path& path);

/// Number of rows of an attribute.
inline std::size_t row_count(const Attribute& attribute) {
  return attribute.values.size() / static_cast<std::size_t>(attribute.width);
}

/// The name of colour attributes: red, green and blue in [0, 1] (sRGB), which viewers display.
inline constexpr std::string_view kColorName = "color";
/// Whether an attribute is a colour and its numbers are multiples of 1/255.
bool is_color_of_bytes(const Attribute& attribute);

/// Makes file names of attributes that differ from each other and from reserved names.
class FileNames {
 public:
  explicit FileNames(std::set<std::string> reserved) : taken_(std::move(reserved)) {}
  /// Returns the wished name, with a number appended if it is taken.
  std::string make(const std::string& wished);

 private:
  std::set<std::string> taken_;
  std::map<std::string, std::size_t> next_;  ///< by wished name: the next number to try
};

/// Replaces all characters except ASCII letters, digits and underscores by underscores; returns "_" for an empty text.
std::string as_word(std::string_view text);

}  // namespace tegl::io_detail
