// SPDX-License-Identifier: BSD-3-Clause
//
// Reads samples stored as raw bytes, compressed bytes, decimal text, and hexadecimal digits.
#include "base/sample_reader.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <type_traits>

#include "base/common.hpp"
#include "base/inflate.hpp"
#include "base/raw_image.hpp"
#include "base/sample_values.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

template <class T>
std::span<unsigned char> as_bytes(ValueVector<T>& values, std::size_t first) {
  return {reinterpret_cast<unsigned char*>(values.data() + first), (values.size() - first) * sizeof(T)};
}

/// An open file for reads at any offset.
class PlacedFile {
 public:
  explicit PlacedFile(const fs::path& path) : path_(path), descriptor_(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (descriptor_ < 0) fail(ErrorCode::FileNotFound, path, "cannot be opened ({})", std::strerror(errno));
  }
  ~PlacedFile() { close(descriptor_); }
  PlacedFile(const PlacedFile&) = delete;
  PlacedFile& operator=(const PlacedFile&) = delete;

  /// Fills `to` from byte `offset`; returns false if the file ends before.
  bool read(std::uint64_t offset, std::span<unsigned char> to) const {
    while (!to.empty()) {
      const ssize_t count = pread(descriptor_, to.data(), to.size(), static_cast<off_t>(offset));
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) fail(ErrorCode::FileNotFound, path_, "cannot be read ({})", std::strerror(errno));
      if (count == 0) return false;
      to = to.subspan(static_cast<std::size_t>(count));
      offset += static_cast<std::uint64_t>(count);
    }
    return true;
  }

 private:
  fs::path path_;
  int descriptor_;
};

/// Reads the characters and blank-separated words of a file in order.
class TextFile {
 public:
  TextFile(const fs::path& path, std::uint64_t offset) : path_(path), file_(path, std::ios::binary) {
    file_.seekg(static_cast<std::streamoff>(offset));
    if (!file_) fail(ErrorCode::FileNotFound, path, "cannot be opened ({})", std::strerror(errno));
  }

  /// The next non-blank character; nullopt at the end of the file.
  std::optional<char> next_character() {
    for (int c = file_.get(); c != std::char_traits<char>::eof(); c = file_.get())
      if (!is_blank(static_cast<char>(c))) return static_cast<char>(c);
    return std::nullopt;
  }

  /// The next word, without a trailing comma; empty at the end of the file. Valid until the next call.
  std::string_view next_word() {
    constexpr std::size_t kLongest = 1000;  // all decimal digits of any double are fewer
    do {
      word_.clear();
      const std::optional<char> first = next_character();
      if (!first) return {};
      word_ += *first;
      for (int c = file_.get(); c != std::char_traits<char>::eof() && !is_blank(static_cast<char>(c));
           c = file_.get()) {
        word_ += static_cast<char>(c);
        if (word_.size() > kLongest)
          fail(ErrorCode::MalformedFile, path_, "more than {} characters without a blank ({}); expected numbers",
               kLongest, shown(word_));
      }
      if (word_.back() == ',') word_.pop_back();
    } while (word_.empty());
    return word_;
  }

 private:
  static bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

  fs::path path_;
  std::ifstream file_;
  std::string word_;
};

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace

class SampleReader::Source {
 public:
  using Finish = std::function<void(std::size_t first, std::size_t count)>;

  explicit Source(StoredSamples samples) : samples_(std::move(samples)), item_(bytes_of_type(samples_.type)) {
    const std::uint64_t bytes = checked_bytes(samples_.sizes, item_, samples_.path);
    total_ = bytes / item_;
    require_readable_file(samples_.path);
    const std::uint64_t size = size_of_file(samples_.path);
    left_ = size - std::min(size, samples_.offset);
    switch (samples_.encoding) {
      case Encoding::raw:
        if (left_ < bytes) fail_length(left_, "bytes", "", bytes);
        file_.emplace(samples_.path);
        break;
      case Encoding::deflate:
        if (samples_.compressed_bytes > left_)
          fail(ErrorCode::MalformedFile, samples_.path, "{} bytes of compressed data; expected {}", left_,
               samples_.compressed_bytes);
        if (left_ < (samples_.skip + bytes) / kMostInflation)
          fail_length(left_ * kMostInflation, "bytes", " after decompression, at most", samples_.skip + bytes);
        break;
      case Encoding::hex:
        if (left_ < 2 * bytes) fail_length(left_, "bytes", "", 2 * bytes);
        break;
      default:
        break;
    }
  }

  [[nodiscard]] const StoredSamples& samples() const noexcept { return samples_; }

  template <class T>
  void read(std::uint64_t first, std::uint64_t count, ValueVector<T>& values, const Progress& progress,
            const Finish& finish) {
    if (count == 0) return;
    const bool in_order = is_open() && first >= next_;
    if (samples_.encoding != Encoding::raw && !in_order) restart();
    try {
      if (samples_.encoding == Encoding::raw) {
        read_raw(first, count, values, progress, finish);
      } else {
        read_encoded(first, count, values, progress);
        finish(0, values.size());
      }
    } catch (...) {  // the stream position is undefined after an error
      inflater_.reset();
      text_.reset();
      throw;
    }
    next_ = first + count;
    if (next_ == total_) check_end<T>();
  }

 private:
  [[nodiscard]] bool is_open() const { return inflater_.has_value() || text_.has_value(); }

  template <class T>
  void read_encoded(std::uint64_t first, std::uint64_t count, ValueVector<T>& values, const Progress& progress) {
    switch (samples_.encoding) {
      case Encoding::deflate:
        return read_deflated(first, count, values, progress);
      case Encoding::text:
        return read_words(first, count, values, progress);
      default:
        return read_digits(first, count, values, progress);
    }
  }

  void restart() {
    next_ = 0;
    if (samples_.encoding != Encoding::deflate) {
      text_.emplace(samples_.path, samples_.offset);
      return;
    }
    inflater_.emplace(samples_.path, samples_.offset, samples_.compressed_bytes, samples_.crc);
    if (inflater_->skip(samples_.skip) < samples_.skip)
      fail_length(inflater_->position(), "bytes", " after decompression", samples_.skip + total_ * item_);
  }

  void tell(const Progress& progress, std::uint64_t done, std::uint64_t count) const {
    tick(progress, std::min(0.99, static_cast<double>(done) / static_cast<double>(count)), samples_.path);
  }

  template <class T>
  void read_raw(std::uint64_t first, std::uint64_t count, ValueVector<T>& values, const Progress& progress,
                const Finish& finish) {
    values.resize(static_cast<std::size_t>(count));
    constexpr std::size_t kBlock = std::size_t{1} << 19;  // fits in the processor's cache
    const auto to = as_bytes(values, 0);
    for (std::size_t at = 0; at < to.size(); at += kBlock) {
      if (!file_->read(samples_.offset + first * item_ + at, to.subspan(at, std::min(kBlock, to.size() - at))))
        fail(ErrorCode::MalformedFile, samples_.path,
             "{} bytes from byte {} on cannot be read; expected {} values of "
             "type {}",
             to.size(), samples_.offset + first * item_, count, samples_.type);
      const std::size_t size = std::min(kBlock, to.size() - at) / sizeof(T);
      if (samples_.swapped) swap_bytes(std::span(values).subspan(at / sizeof(T), size));
      finish(at / sizeof(T), size);
      tell(progress, at, to.size());
    }
  }

  template <class T>
  void read_deflated(std::uint64_t first, std::uint64_t count, ValueVector<T>& values, const Progress& progress) {
    inflater_->skip((first - next_) * item_);
    grow(values, count, progress, [&](std::size_t before) {
      const auto to = as_bytes(values, before);
      if (inflater_->read(to) < to.size())
        fail_length(inflater_->position(), "bytes", " after decompression", samples_.skip + total_ * item_);
    });
  }

  template <class T>
  void read_words(std::uint64_t first, std::uint64_t count, ValueVector<T>& values, const Progress& progress) {
    const auto next = [&](std::uint64_t number) {
      const std::string_view word = text_->next_word();
      if (word.empty()) fail_length(number, "numbers", "", total_);
      T value{};
      if (!parse_sample(word, value))
        fail(ErrorCode::MalformedFile, samples_.path, "sample {} is {}; expected {}", number, shown(word),
             expected_numbers<T>(samples_.type));
      return value;
    };
    for (std::uint64_t i = next_; i < first; ++i) next(i);
    grow(values, count, progress, [&](std::size_t before) {
      for (std::size_t i = before; i < values.size(); ++i) values[i] = next(first + i);
    });
  }

  template <class T>
  void read_digits(std::uint64_t first, std::uint64_t count, ValueVector<T>& values, const Progress& progress) {
    const auto next = [&](std::uint64_t number) {
      const std::optional<char> c = text_->next_character();
      if (!c) fail_length(number, "hexadecimal digits", "", 2 * total_ * item_);
      const int digit = hex_digit(*c);
      if (digit < 0)
        fail(ErrorCode::MalformedFile, samples_.path, "{} among the samples; expected hexadecimal digits",
             shown(std::string_view(&*c, 1)));
      return digit;
    };
    for (std::uint64_t i = 2 * next_ * item_; i < 2 * first * item_; ++i) next(i);
    grow(values, count, progress, [&](std::size_t before) {
      std::uint64_t number = 2 * (first + before) * item_;
      for (unsigned char& byte : as_bytes(values, before)) {
        const int high = next(number);
        byte = static_cast<unsigned char>(16 * high + next(number + 1));
        number += 2;
      }
    });
  }

  /// Grows `values` to `count` in blocks; `fill(before)` writes the values from index `before` on. A file with fewer
  /// values than its header states costs no more memory than it has values.
  template <class T, class Fill>
  void grow(ValueVector<T>& values, std::uint64_t count, const Progress& progress, const Fill& fill) {
    constexpr std::uint64_t kBlock = std::uint64_t{1} << 16;
    // Reserved pages are only used as values arrive. A sample takes at least two characters, or 1/1032 of its bytes.
    const std::uint64_t possible = samples_.encoding == Encoding::deflate ? count : left_ / 2 + 1;
    values.reserve(static_cast<std::size_t>(std::min(count, possible)));
    while (values.size() < count) {
      const std::size_t before = values.size();
      values.resize(static_cast<std::size_t>(std::min<std::uint64_t>(count, before + kBlock)));
      fill(before);
      if (samples_.swapped && samples_.encoding != Encoding::text) swap_bytes(std::span(values).subspan(before));
      tell(progress, values.size(), count);
    }
  }

  template <class T>
  void check_end() {
    if (samples_.encoding == Encoding::deflate) inflater_->check_end();
    if (samples_.encoding == Encoding::text) {
      if (const std::string_view word = text_->next_word(); !word.empty())
        fail(ErrorCode::MalformedFile, samples_.path, "{} after the last number; expected {} for {} samples of type {}",
             shown(word), total_, shape_text(samples_.sizes), samples_.type);
    }
    if (samples_.encoding == Encoding::hex) {
      if (const std::optional<char> c = text_->next_character())
        fail(ErrorCode::MalformedFile, samples_.path,
             "{} after the last hexadecimal digit; expected {} for {} samples of type {}",
             shown(std::string_view(&*c, 1)), 2 * total_ * item_, shape_text(samples_.sizes), samples_.type);
    }
  }

  [[noreturn]] void fail_length(std::uint64_t found, const char* units, const char* when, std::uint64_t needed) const {
    fail(ErrorCode::MalformedFile, samples_.path, "{} {} of data{}; expected {} for {} samples of type {}", found,
         units, when, needed, shape_text(samples_.sizes), samples_.type);
  }

  StoredSamples samples_;
  std::uint64_t item_;
  std::uint64_t total_ = 0;
  std::uint64_t left_ = 0;  ///< bytes of the file from the offset to its end
  std::uint64_t next_ = 0;  ///< next sample of inflater_ or text_
  std::optional<PlacedFile> file_;
  std::optional<InflateStream> inflater_;
  std::optional<TextFile> text_;
};

std::uint64_t bytes_of_type(std::string_view type) {
  return std::visit([]<class T>(const ValueVector<T>&) -> std::uint64_t { return sizeof(T); }, array_of_type(type));
}

SampleReader::SampleReader(StoredSamples samples) : source_(std::make_unique<Source>(std::move(samples))) {}
SampleReader::~SampleReader() = default;
SampleReader::SampleReader(SampleReader&&) noexcept = default;
SampleReader& SampleReader::operator=(SampleReader&&) noexcept = default;

const StoredSamples& SampleReader::samples() const noexcept { return source_->samples(); }

ValueArray SampleReader::read(std::uint64_t first, std::uint64_t count, const Progress& progress,
                              const OnBlock& on_block) {
  ValueArray result = array_of_type(samples().type);
  const auto finish = [&](std::size_t from, std::size_t size) {
    if (on_block) on_block(result, from, size);
  };
  std::visit([&](auto& values) { source_->read(first, count, values, progress, finish); }, result);
  return result;
}

}  // namespace tegl::io_detail
