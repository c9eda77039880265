// SPDX-License-Identifier: BSD-3-Clause
//
// The elements of an XML file, without the text in them: texts stay in the file, and the elements have their places.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "tegl/work.hpp"

namespace tegl::io_detail {

struct XmlElement {
  std::string name;
  std::map<std::string, std::string, std::less<>> attributes;
  std::vector<XmlElement> children;
  std::uint64_t text_begin = 0;  ///< place of the text in the file, in bytes
  std::uint64_t text_end = 0;    ///< equal to the begin if there is no text except blanks

  /// The value of an attribute; empty if it is missing.
  [[nodiscard]] std::string_view attribute(std::string_view key) const;
  /// The first child of this name, or null.
  [[nodiscard]] const XmlElement* child(std::string_view child_name) const;
};

struct XmlFile {
  XmlElement root;
  /// Place of the first byte after the start tag of `last_element`, where reading ended; 0 if there is no such element.
  std::uint64_t end = 0;
};

/// Parses a file up to the first element of the name `last_element`, after which a file need not be XML. Errors:
/// MalformedFile (not well-formed; a document type; text of an element in two places; too many or too deep elements),
/// Cancelled. Memory: that of the elements and their attributes.
XmlFile parse_xml(const std::filesystem::path& path, std::string_view last_element, const Progress& progress);

}  // namespace tegl::io_detail
