// SPDX-License-Identifier: BSD-3-Clause
//
// Attributes of meshes in files: what they must be, and names that a format allows.
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

/// Throws InvalidArgument unless all have different names that are not empty, and `rows` rows of their width. `what`
/// names the rows in the message.
void check_attributes(std::span<const Attribute> attributes, std::size_t rows, std::string_view what,
                      const std::filesystem::path& path);

/// How many rows an attribute has.
inline std::size_t row_count(const Attribute& attribute) {
  return attribute.values.size() / static_cast<std::size_t>(attribute.width);
}

/// The name of an attribute of three numbers between 0 and 1, red, green and blue (sRGB), that viewers show.
inline constexpr std::string_view kColorName = "color";
/// Whether that is one, and of bytes, 255 for 1.
bool is_color_of_bytes(const Attribute& attribute);

/// Names that are different from each other and from what was reserved.
class FileNames {
 public:
  explicit FileNames(std::set<std::string> reserved) : taken_(std::move(reserved)) {}
  /// The wished name, or if that is taken one with a number after it.
  std::string make(const std::string& wished);

 private:
  std::set<std::string> taken_;
  std::map<std::string, std::size_t> next_;  ///< by wished name: the first number that may be free
};

/// The text with everything but letters, digits and underscores of ASCII as an underscore; "_" for the empty one.
std::string as_word(std::string_view text);

}  // namespace tegl::io_detail
