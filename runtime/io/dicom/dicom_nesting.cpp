// SPDX-License-Identifier: BSD-3-Clause
//
// Scans the elements of a DICOM file with an explicit stack of open levels. Without a dictionary the scan does not know
// all types: an element that may be a sequence counts as one if its value begins with an item.
//
// Based on: NEMA PS3.5 (DICOM Data Structures and Encoding), sections 6.2.2 and 7.1 to 7.5; PS3.10, section 7.1.
#include "dicom/dicom_nesting.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <zlib.h>

#include "base/common.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kWindow = std::size_t{1} << 16;
constexpr std::size_t kLongestHeader = 16;  // of an element: tag, type, length, and the tag of an item after it

/// FileBytes of a file from an offset, plain or inflated. Requested positions must not decrease.
class FileBytes {
 public:
  FileBytes(const fs::path& path, std::uint64_t offset, bool deflated) : file_(std::fopen(path.c_str(), "rb")) {
    if (!file_) return;
    file_at_ = offset;
    if (!deflated) return;
    inflater_.reset(new z_stream{});
    if (inflateInit2(inflater_.get(), -MAX_WBITS) != Z_OK) throw std::bad_alloc();
  }

  /// Up to `count` bytes at a position; fewer at the end.
  std::span<const unsigned char> at(std::uint64_t position, std::size_t count) {
    if (position + count > start_ + window_.size()) fill(position);
    if (position < start_ || position - start_ >= window_.size()) return {};
    const auto from = static_cast<std::size_t>(position - start_);
    return std::span<const unsigned char>(window_).subspan(from, std::min(count, window_.size() - from));
  }

 private:
  struct Close {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
    void operator()(z_stream* stream) const noexcept {
      inflateEnd(stream);
      delete stream;
    }
  };

  /// Moves the start of the window to a position.
  void fill(std::uint64_t position) {
    if (!file_) return;
    if (!inflater_) {
      window_.resize(kWindow);
      start_ = position;
      window_.resize(read(file_at_ + position, window_));
      return;
    }
    // Discards bytes before the position, in the window and after it.
    while (start_ + window_.size() < position + kLongestHeader) {
      const std::uint64_t keep = std::min<std::uint64_t>(position - start_, window_.size());
      window_.erase(window_.begin(), window_.begin() + static_cast<std::ptrdiff_t>(keep));
      start_ += keep;
      if (!inflate_more()) return;
    }
  }

  std::size_t read(std::uint64_t offset, std::span<unsigned char> to) {
    if (fseeko(file_.get(), static_cast<off_t>(offset), SEEK_SET) != 0) return 0;
    return std::fread(to.data(), 1, to.size(), file_.get());
  }

  /// Appends a block of inflated bytes to the window; false at the end.
  bool inflate_more() {
    if (inflater_->avail_in == 0) {
      inflater_->avail_in = static_cast<uInt>(read(file_at_, input_));
      inflater_->next_in = input_.data();
      file_at_ += inflater_->avail_in;
    }
    const std::size_t before = window_.size();
    window_.resize(before + kWindow);
    inflater_->next_out = window_.data() + before;
    inflater_->avail_out = static_cast<uInt>(kWindow);
    const int status = inflate(inflater_.get(), Z_NO_FLUSH);
    window_.resize(before + kWindow - inflater_->avail_out);
    return window_.size() > before || (status == Z_OK && inflater_->avail_in > 0);
  }

  std::unique_ptr<std::FILE, Close> file_;
  std::unique_ptr<z_stream, Close> inflater_;
  std::array<unsigned char, kWindow> input_{};
  std::vector<unsigned char> window_;
  std::uint64_t start_ = 0;    ///< position of the window's first byte
  std::uint64_t file_at_ = 0;  ///< file offset of position 0, or of the next bytes to inflate
};

struct ElementEncoding {
  bool is_explicit;
  bool is_big_endian;
};

std::uint32_t number(std::span<const unsigned char> bytes, bool big_endian) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) value = value << 8 | bytes[big_endian ? i : bytes.size() - 1 - i];
  return value;
}

constexpr std::uint32_t kUndefined = 0xffffffff;
constexpr std::uint32_t kItem = 0xfffee000;
constexpr std::uint32_t kItemEnd = 0xfffee00d;
constexpr std::uint32_t kSequenceEnd = 0xfffee0dd;
constexpr std::uint32_t kPixels = 0x7fe00000;  // group of pixel data; its items are fragments of a compressed stream

/// The header of an element, of an item, or of an end mark.
struct Header {
  std::uint32_t tag = 0;
  std::uint32_t length = 0;
  std::size_t bytes = 8;
  bool may_be_sequence = false;  ///< it is one if its value begins with an item
  bool is_unknown = false;       ///< type UN: as a sequence, its value is implicit and little endian
};

class Scan {
 public:
  Scan(FileBytes& bytes, std::uint64_t start, ElementEncoding encoding)
      : bytes_(bytes), position_(start), encoding_(encoding) {}

  /// Whether sequences are nested deeper than the limit.
  bool is_too_deep() {
    for (;;) {
      while (!levels_.empty() && levels_.back().end && position_ >= *levels_.back().end) levels_.pop_back();
      const std::optional<Header> header = read_header();
      if (!header) return false;
      step(*header);
      const auto sequences = std::count_if(levels_.begin(), levels_.end(), [](const Level& l) { return !l.is_item; });
      if (sequences > kDeepestSequence || levels_.size() > std::size_t{3} * kDeepestSequence) return true;
    }
  }

 private:
  struct Level {
    std::optional<std::uint64_t> end;  ///< nullopt: ended by a mark
    bool is_item = false;
    bool is_pixels = false;
    ElementEncoding encoding;
  };

  [[nodiscard]] ElementEncoding encoding() const { return levels_.empty() ? encoding_ : levels_.back().encoding; }

  std::optional<Header> read_header() {
    const ElementEncoding e = encoding();
    const auto bytes = bytes_.at(position_, kLongestHeader);
    if (bytes.size() < 8) return std::nullopt;
    Header header;
    header.tag = number(bytes.first(2), e.is_big_endian) << 16 | number(bytes.subspan(2, 2), e.is_big_endian);
    const bool is_mark = header.tag >> 16 == kItem >> 16;
    if (!e.is_explicit || is_mark) {
      header.length = number(bytes.subspan(4, 4), e.is_big_endian);
      header.may_be_sequence = !is_mark;
    } else {
      read_typed(bytes, e, header);
    }
    if (header.may_be_sequence) {
      const auto value = bytes_.at(position_ + header.bytes, 4);
      header.may_be_sequence = value.size() == 4 && (number(value.first(2), e.is_big_endian) == kItem >> 16 ||
                                                     number(value.first(2), false) == kItem >> 16);
    }
    return header;
  }

  static void read_typed(std::span<const unsigned char> bytes, ElementEncoding e, Header& header) {
    const std::string_view type(reinterpret_cast<const char*>(bytes.data()) + 4, 2);
    constexpr std::string_view kShort = "AE AS AT CS DA DS DT FD FL IS LO LT PN SH SL SS ST TM UI UL US";
    const auto is_capital = [](char c) { return c >= 'A' && c <= 'Z'; };
    // Unknown types have long lengths; invalid types have short ones.
    const bool is_short = kShort.find(type) != std::string_view::npos || !is_capital(type[0]) || !is_capital(type[1]);
    header.is_unknown = type == "UN";
    header.may_be_sequence = type == "SQ" || type == "UN";
    if (is_short) {
      header.length = number(bytes.subspan(6, 2), e.is_big_endian);
    } else if (bytes.size() >= 12) {
      header.bytes = 12;
      header.length = number(bytes.subspan(8, 4), e.is_big_endian);
    }
  }

  void step(const Header& header) {
    const std::uint64_t value = position_ + header.bytes;
    const std::optional<std::uint64_t> end =
        header.length == kUndefined ? std::nullopt : std::optional(value + header.length);
    position_ = value;
    if (header.tag == kItemEnd || header.tag == kSequenceEnd) return close(header.tag == kItemEnd);
    const bool in_pixels = !levels_.empty() && levels_.back().is_pixels;
    if (header.tag == kItem && !in_pixels) return levels_.push_back({end, true, false, encoding()});
    if (header.tag != kItem && (!end || header.may_be_sequence)) {
      const bool is_pixels = (header.tag & 0xffff0000) == kPixels;
      return levels_.push_back({end, false, is_pixels, header.is_unknown ? ElementEncoding{false, false} : encoding()});
    }
    position_ = end.value_or(value);
  }

  /// Closes the innermost item or sequence that is ended by a mark, and all levels in it.
  void close(bool item) {
    for (std::size_t i = levels_.size(); i > 0 && !levels_[i - 1].end; --i) {
      if (levels_[i - 1].is_item != item) continue;
      levels_.resize(i - 1);
      return;
    }
  }

  FileBytes& bytes_;
  std::uint64_t position_;
  ElementEncoding encoding_;
  std::vector<Level> levels_;
};

/// The file meta information: elements of group 2, always explicit and little endian.
struct Meta {
  std::uint64_t start = 0;
  std::vector<std::uint64_t> data_sets;  ///< possible starts of the data set: end of group 2, or as stated
  bool is_deflated = false;
};

Meta read_meta(FileBytes& bytes) {
  Meta meta;
  const auto mark = bytes.at(128, 4);
  if (mark.size() == 4 && std::memcmp(mark.data(), "DICM", 4) == 0) meta.start = 132;
  meta.data_sets.push_back(meta.start);
  std::uint64_t position = meta.start;
  constexpr std::size_t kMostPromises = 3;
  for (;;) {
    const auto header = bytes.at(position, kLongestHeader);
    if (header.size() < 12 || number(header.first(2), false) != 2) break;
    const bool is_long = std::memcmp(header.data() + 4, "OB", 2) == 0 || std::memcmp(header.data() + 4, "UN", 2) == 0 ||
                         std::memcmp(header.data() + 4, "SQ", 2) == 0;
    const std::uint32_t length = is_long ? number(header.subspan(8, 4), false) : number(header.subspan(6, 2), false);
    const std::uint32_t element = number(header.subspan(2, 2), false);
    const std::uint64_t value = position + (is_long ? 12 : 8);
    // Valid files have one group length.
    if (element == 0 && length == 4 && meta.data_sets.size() < kMostPromises)
      meta.data_sets.push_back(value + 4 + number(header.subspan(8, 4), false));
    constexpr std::uint32_t kLongestUid = 64;
    if (element == 0x10 && length <= kLongestUid) {
      const auto text = bytes.at(value, length);
      const std::string uid(text.begin(), text.end());
      meta.is_deflated = uid.starts_with("1.2.840.10008.1.2.1.99") || uid.starts_with("1.2.840.10008.1.2.4.95");
    }
    position = value + length;
  }
  meta.data_sets.push_back(position);
  std::sort(meta.data_sets.begin(), meta.data_sets.end());
  meta.data_sets.erase(std::unique(meta.data_sets.begin(), meta.data_sets.end()), meta.data_sets.end());
  return meta;
}

}  // namespace

std::optional<Error> nesting_fault(const fs::path& path) {
  FileBytes head(path, 0, false);
  const Meta meta = read_meta(head);
  constexpr std::array<ElementEncoding, 3> kEncodings = {{{true, false}, {false, false}, {true, true}}};
  for (const std::uint64_t start : meta.data_sets)
    for (const ElementEncoding encoding : kEncodings)
      for (const bool deflated : {false, true}) {
        if (deflated && (!meta.is_deflated || start == meta.start)) continue;
        FileBytes bytes(path, start, deflated);
        if (Scan(bytes, 0, encoding).is_too_deep())
          return Error(ErrorCode::MalformedFile, fmt::format("{}: sequences nested deeper than {}; expected at most {}",
                                                             path.string(), kDeepestSequence, kDeepestSequence));
      }
  return {};
}

}  // namespace tegl::io_detail
