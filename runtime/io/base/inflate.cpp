// SPDX-License-Identifier: BSD-3-Clause
//
// Decompression of gzip, zlib and deflate streams, by zlib's inflate.
//
// Based on: RFC 1950 to 1952; zlib's manual, inflateInit2.
#include "base/inflate.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <limits>
#include <new>

#include <zlib.h>

#include "base/common.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kBlock = std::size_t{1} << 18;

}  // namespace

/// A z_stream, and its input file. It detects gzip or zlib by the header; raw deflate has none.
class InflateStream::Inflater {
 public:
  Inflater(const fs::path& path, std::uint64_t offset, std::uint64_t length, std::optional<std::uint32_t> crc)
      : path_(path),
        input_(kBlock),
        left_(length > 0 ? length : std::numeric_limits<std::uint64_t>::max()),
        expected_crc_(crc) {
    file_.reset(std::fopen(path.c_str(), "rb"));
    if (!file_) fail(ErrorCode::FileNotFound, path, "cannot be opened ({})", std::strerror(errno));
    if (fseeko(file_.get(), static_cast<off_t>(offset), SEEK_SET) != 0)
      fail(ErrorCode::FileNotFound, path, "cannot be read ({})", std::strerror(errno));
    constexpr int kWindowAndDetect = 15 + 32, kWindowOfRaw = -15;
    if (inflateInit2(&stream_, crc ? kWindowOfRaw : kWindowAndDetect) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  std::size_t read(std::span<unsigned char> to) {
    std::size_t done = 0;
    while (done < to.size() && !ended_) done += step(to.subspan(done));
    position_ += done;
    return done;
  }

  [[nodiscard]] std::uint64_t position() const noexcept { return position_; }

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };

  /// Calls inflate once; returns the number of bytes written.
  std::size_t step(std::span<unsigned char> to) {
    const std::uint64_t sofar = position_;
    if (!refill())
      fail(ErrorCode::MalformedFile, path_, "compressed data ends early, after {} decompressed bytes", sofar);
    constexpr std::size_t kMost = std::size_t{1} << 30;
    const std::size_t room = std::min(to.size(), kMost);
    stream_.next_out = to.data();
    stream_.avail_out = static_cast<uInt>(room);
    const int status = inflate(&stream_, Z_NO_FLUSH);
    if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR)
      fail(ErrorCode::MalformedFile, path_, "compressed data is damaged after {} decompressed bytes ({})", sofar,
           stream_.msg != nullptr ? stream_.msg : "not a gzip or zlib stream");
    const std::size_t written = room - stream_.avail_out;
    if (expected_crc_) crc_ = static_cast<std::uint32_t>(crc32_z(crc_, to.data(), written));
    if (status == Z_STREAM_END && expected_crc_) {
      ended_ = true;
      if (crc_ != *expected_crc_)
        fail(ErrorCode::MalformedFile, path_, "compressed data is damaged: its CRC-32 is {:08x}; expected {:08x}", crc_,
             *expected_crc_);
    } else if (status == Z_STREAM_END) {
      // If another gzip member follows directly, decompression continues; other bytes after the end are padding.
      ended_ = !refill() || stream_.avail_in < 2 || stream_.next_in[0] != 0x1f || stream_.next_in[1] != 0x8b ||
               inflateReset(&stream_) != Z_OK;
    }
    return written;
  }

  /// Ensures that there is input; false at the end of the file.
  bool refill() {
    if (stream_.avail_in > 1) return true;
    // A single remaining byte is kept in front, because the test for a next member reads two.
    const std::size_t kept = stream_.avail_in;
    if (kept == 1) input_[0] = *stream_.next_in;
    const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(input_.size() - kept, left_));
    const std::size_t count = std::fread(input_.data() + kept, 1, wanted, file_.get());
    if (count == 0 && std::ferror(file_.get()) != 0)
      fail(ErrorCode::FileNotFound, path_, "cannot be read ({})", std::strerror(errno));
    left_ -= count;
    stream_.next_in = input_.data();
    stream_.avail_in = static_cast<uInt>(kept + count);
    return stream_.avail_in > 0;
  }

  fs::path path_;
  std::unique_ptr<std::FILE, CloseFile> file_;
  std::vector<unsigned char> input_;
  z_stream stream_{};
  std::uint64_t left_;  ///< bytes of the compressed stream that are not read yet
  std::uint64_t position_ = 0;
  std::optional<std::uint32_t> expected_crc_;  ///< of raw deflate
  std::uint32_t crc_ = 0;                      ///< of raw deflate, up to the position
  bool ended_ = false;
};

InflateStream::InflateStream(const fs::path& path, std::uint64_t offset, std::uint64_t length,
                             std::optional<std::uint32_t> crc)
    : inflater_(std::make_unique<Inflater>(path, offset, length, crc)) {}
InflateStream::~InflateStream() = default;
InflateStream::InflateStream(InflateStream&&) noexcept = default;
InflateStream& InflateStream::operator=(InflateStream&&) noexcept = default;

std::size_t InflateStream::read(std::span<unsigned char> to) { return inflater_->read(to); }
std::uint64_t InflateStream::position() const noexcept { return inflater_->position(); }

std::uint64_t InflateStream::skip(std::uint64_t count) {
  std::vector<unsigned char> block(static_cast<std::size_t>(std::min<std::uint64_t>(count, kBlock)));
  std::uint64_t done = 0;
  while (done < count) {
    const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(count - done, block.size()));
    const std::size_t found = read(std::span(block).first(wanted));
    done += found;
    if (found < wanted) break;
  }
  return done;
}

void InflateStream::check_end() {
  constexpr std::uint64_t kMostBeyond = std::uint64_t{1} << 20;
  skip(kMostBeyond);
}

std::vector<unsigned char> inflate_to_memory(const fs::path& path, const BytesNeeded& needed,
                                             const Progress& progress) {
  InflateStream stream(path, 0);
  std::vector<unsigned char> bytes;
  const auto grow_to = [&](std::uint64_t size) {
    while (bytes.size() < size) {
      const std::size_t before = bytes.size();
      const std::size_t count = std::min<std::size_t>(kBlock, static_cast<std::size_t>(size) - before);
      bytes.resize(before + count);
      bytes.resize(before + stream.read(std::span(bytes).subspan(before)));
      tick(progress, 0.0, path);
      if (bytes.size() < before + count) return false;
    }
    return true;
  };
  // header: most headers are some kilobytes
  try {
    std::uint64_t wanted = 0;
    for (std::size_t size = std::size_t{1} << 16; wanted == 0; size *= 4) {
      if (!grow_to(size)) return bytes;
      wanted = needed(bytes);
    }
    // Reserved pages are only used as bytes arrive, so a false size in a header costs no memory.
    bytes.reserve(static_cast<std::size_t>(wanted) + kInflateSpare);
    if (!grow_to(wanted)) return bytes;
    bytes.resize(static_cast<std::size_t>(wanted));
    stream.check_end();
  } catch (const std::bad_alloc&) {
    fail(ErrorCode::TooLarge, path, "decompresses to more than {} bytes, which exceeds the memory", bytes.size());
  }
  return bytes;
}

bool is_gzip(const fs::path& path) {
  const auto magic = read_bytes(path, 0, 2);
  return magic.size() == 2 && magic[0] == 0x1f && magic[1] == 0x8b;
}

std::vector<unsigned char> read_prefix(const fs::path& path, std::size_t count) {
  if (!is_gzip(path)) return read_bytes(path, 0, count);
  std::vector<unsigned char> bytes(count);
  bytes.resize(InflateStream(path, 0).read(bytes));
  return bytes;
}

}  // namespace tegl::io_detail
