// SPDX-License-Identifier: BSD-3-Clause
//
// Parses XML by Expat, block by block.
#include "vtk/xml_file.hpp"

#include <memory>
#include <new>
#include <optional>
#include <utility>

#include <expat.h>

#include "base/common.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostElements = 200'000;
constexpr std::size_t kDeepest = 64;
constexpr std::size_t kXmlBlock = std::size_t{1} << 18;
/// Expat scans an incomplete tag again with each block.
constexpr std::uint64_t kLongestTag = std::uint64_t{1} << 22;

struct FreeParser {
  void operator()(XML_ParserStruct* parser) const noexcept { XML_ParserFree(parser); }
};

/// Builds the elements. Expat's callbacks must not throw, so a fault is kept and stops the parser.
class XmlBuilder {
 public:
  XmlBuilder(const fs::path& path, std::string_view last_element)
      : path_(path), last_(last_element), parser_(XML_ParserCreate(nullptr)) {
    if (!parser_) throw std::bad_alloc();
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(
        parser_.get(), [](void* self, const char* name, const char** attributes) { of(self).start(name, attributes); },
        [](void* self, const char*) { of(self).end(); });
    XML_SetCharacterDataHandler(parser_.get(), [](void* self, const char* text, int length) {
      of(self).text({text, std::size_t(length)});
    });
    // Documents of VTK have none. Entities, which documents could define to expand to any size, are refused with it.
    XML_SetStartDoctypeDeclHandler(parser_.get(), [](void* self, const char*, const char*, const char*, int) {
      of(self).stop("has a document type (<!DOCTYPE>); expected none");
    });
  }

  /// Returns false if the rest of the file is not needed.
  bool parse(std::span<const unsigned char> block, bool is_last) {
    const XML_Status status = XML_Parse(parser_.get(), reinterpret_cast<const char*>(block.data()),
                                        static_cast<int>(block.size()), is_last ? 1 : 0);
    if (fault_) fail(ErrorCode::MalformedFile, path_, "{}", *fault_);
    if (file_.end > 0) return false;
    fed_ += block.size();
    if (fed_ > last_event_ + kLongestTag)
      fail(ErrorCode::MalformedFile, path_, "a tag or comment of more than {} bytes, from byte {} on", kLongestTag,
           last_event_);
    if (status == XML_STATUS_OK) return true;
    if (XML_GetErrorCode(parser_.get()) == XML_ERROR_NO_MEMORY) throw std::bad_alloc();
    fail(ErrorCode::MalformedFile, path_, "line {}, column {}: {}; expected XML",
         XML_GetCurrentLineNumber(parser_.get()), XML_GetCurrentColumnNumber(parser_.get()),
         XML_ErrorString(XML_GetErrorCode(parser_.get())));
  }

  XmlFile take() { return std::move(file_); }

 private:
  static XmlBuilder& of(void* self) { return *static_cast<XmlBuilder*>(self); }

  void stop(std::string fault) {
    if (!fault_) fault_ = std::move(fault);
    XML_StopParser(parser_.get(), XML_FALSE);
  }

  std::uint64_t place() { return last_event_ = static_cast<std::uint64_t>(XML_GetCurrentByteIndex(parser_.get())); }

  /// Ends the text before a tag.
  void end_text() {
    if (has_text_ && !open_.empty()) {
      XmlElement& element = *open_.back();
      if (element.text_end > 0) return stop(fmt::format("<{}> has text in two places; expected one", element.name));
      element.text_begin = text_begin_;
      element.text_end = place();
    }
    has_text_ = false;
    text_begin_ = place() + static_cast<std::uint64_t>(XML_GetCurrentByteCount(parser_.get()));
  }

  void start(const char* name, const char** attributes) {
    end_text();
    if (++elements_ > kMostElements) return stop(fmt::format("more than {} elements", kMostElements));
    if (open_.size() >= kDeepest) return stop(fmt::format("elements nested more than {} deep", kDeepest));
    XmlElement& element = open_.empty() ? file_.root : open_.back()->children.emplace_back();
    element.name = name;
    for (; *attributes != nullptr; attributes += 2) element.attributes.emplace(attributes[0], attributes[1]);
    open_.push_back(&element);
    if (last_ != name) return;
    file_.end = text_begin_;
    XML_StopParser(parser_.get(), XML_FALSE);
  }

  void end() {
    end_text();
    if (!open_.empty()) open_.pop_back();
  }

  void text(std::string_view part) {
    place();
    has_text_ = has_text_ || !trim(part).empty();
  }

  fs::path path_;
  std::string last_;
  std::unique_ptr<XML_ParserStruct, FreeParser> parser_;
  XmlFile file_;
  std::vector<XmlElement*> open_;  ///< an element's siblings are not added before it is closed, so it stays in place
  std::optional<std::string> fault_;
  std::size_t elements_ = 0;
  std::uint64_t fed_ = 0;         ///< bytes that the parser has
  std::uint64_t last_event_ = 0;  ///< place of the last tag or text
  std::uint64_t text_begin_ = 0;
  bool has_text_ = false;
};

}  // namespace

std::string_view XmlElement::attribute(std::string_view key) const {
  const auto found = attributes.find(key);
  return found == attributes.end() ? std::string_view() : std::string_view(found->second);
}

const XmlElement* XmlElement::child(std::string_view child_name) const {
  for (const XmlElement& element : children)
    if (element.name == child_name) return &element;
  return nullptr;
}

XmlFile parse_xml(const fs::path& path, std::string_view last_element, const Progress& progress) {
  XmlBuilder builder(path, last_element);
  const std::uint64_t size = size_of_file(path);
  for (std::uint64_t at = 0; at < size; at += kXmlBlock) {
    const auto block = read_bytes(path, at, kXmlBlock);
    if (at == 0 && block.size() > 1 && block[0] == 0x1f && block[1] == 0x8b)
      fail(ErrorCode::UnsupportedFormat, path, "compressed by gzip; expected XML: decompress the file (gunzip)");
    if (!builder.parse(block, at + kXmlBlock >= size)) break;
    tick(progress, 0.0, path);
  }
  return builder.take();
}

}  // namespace tegl::io_detail
