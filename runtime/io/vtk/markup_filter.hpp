// SPDX-License-Identifier: BSD-3-Clause
//
// Takes comments, processing instructions and the ends of CDATA sections out of the text of an XML element.
#pragma once

#include <string>
#include <string_view>

namespace tegl::io_detail {

/// For the text of an element without other elements in it, character by character. The text is well-formed: XmlFile
/// is made of the same file.
class MarkupFilter {
 public:
  /// Whether a character is, or may be, of such markup. Others are text.
  [[nodiscard]] bool concerns(char c) const { return c == '<' || !open_.empty() || (in_cdata_ && c == ']'); }

  /// Takes a character that it concerns; returns the text that is known with it, until the next call.
  std::string_view text_of(char c) {
    open_ += c;
    if (open_[0] == ']') return end_of_cdata();
    if (open_ == kCdata) {
      in_cdata_ = true;
      open_.clear();
    } else if (ends("<!--", "-->") || ends("<?", "?>")) {
      open_.clear();
    } else if (open_.size() > kLongest) {
      open_.erase(kKept, open_.size() - 2 * kKept);  // its begin and its end are of interest
    }
    return {};
  }

 private:
  static constexpr std::string_view kCdata = "<![CDATA[";
  static constexpr std::size_t kKept = 9, kLongest = 64;

  [[nodiscard]] bool ends(std::string_view begin, std::string_view end) const {
    return open_.starts_with(begin) && open_.size() >= begin.size() + end.size() && open_.ends_with(end);
  }

  std::string_view end_of_cdata() {
    if (open_ == "]" || open_ == "]]") return {};
    in_cdata_ = in_cdata_ && open_ != "]]>";
    text_.clear();
    if (in_cdata_) text_ = open_;
    open_.clear();
    return text_;
  }

  std::string open_;  ///< the part of markup that is known
  std::string text_;
  bool in_cdata_ = false;
};

}  // namespace tegl::io_detail
