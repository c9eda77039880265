// SPDX-License-Identifier: BSD-3-Clause
//
// gzip and zlib streams through zlib's inflate.
//
// Based on: RFC 1950 and 1952; zlib's manual, inflateInit2.
#include "inflate.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>

#include <zlib.h>

#include "common.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kBlock = std::size_t{1} << 18;

/// A z_stream that tells gzip from zlib by the header, and the input file behind it.
class Inflater {
 public:
  Inflater(const fs::path& path, std::uint64_t offset) : path_(path), input_(kBlock), output_(kBlock) {
    file_.reset(std::fopen(path.c_str(), "rb"));
    if (!file_) fail(ErrorCode::FileNotFound, path, "cannot be opened ({})", std::strerror(errno));
    if (fseeko(file_.get(), static_cast<off_t>(offset), SEEK_SET) != 0)
      fail(ErrorCode::FileNotFound, path, "cannot be read ({})", std::strerror(errno));
    constexpr int kWindowAndDetect = 15 + 32;
    if (inflateInit2(&stream_, kWindowAndDetect) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  void run(const InflateSink& sink) {
    for (bool more = true; more;) {
      if (!step(sink)) return;
      // Another gzip member follows directly; anything else after the end is padding.
      more = refill() && stream_.avail_in >= 2 && stream_.next_in[0] == 0x1f && stream_.next_in[1] == 0x8b;
      if (more && inflateReset(&stream_) != Z_OK) more = false;
    }
  }

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };

  /// Runs one member to its end. False if the sink had enough.
  bool step(const InflateSink& sink) {
    for (int status = Z_OK; status != Z_STREAM_END;) {
      if (!refill())
        fail(ErrorCode::MalformedFile, path_, "compressed data ends early, after {} decompressed bytes", total_);
      stream_.next_out = output_.data();
      stream_.avail_out = static_cast<uInt>(output_.size());
      status = inflate(&stream_, Z_NO_FLUSH);
      if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR)
        fail(ErrorCode::MalformedFile, path_, "compressed data is damaged after {} decompressed bytes ({})", total_,
             stream_.msg != nullptr ? stream_.msg : "not a gzip or zlib stream");
      const std::size_t count = output_.size() - stream_.avail_out;
      total_ += count;
      if (count > 0 && !sink(std::span(output_.data(), count))) return false;
    }
    return true;
  }

  /// Makes sure that there is input; false at the end of the file.
  bool refill() {
    if (stream_.avail_in > 1) return true;
    // A lone byte left is kept in front: the test for a next member looks at two.
    const std::size_t kept = stream_.avail_in;
    if (kept == 1) input_[0] = *stream_.next_in;
    const std::size_t count = std::fread(input_.data() + kept, 1, input_.size() - kept, file_.get());
    if (count == 0 && std::ferror(file_.get()) != 0)
      fail(ErrorCode::FileNotFound, path_, "cannot be read ({})", std::strerror(errno));
    stream_.next_in = input_.data();
    stream_.avail_in = static_cast<uInt>(kept + count);
    return stream_.avail_in > 0;
  }

  fs::path path_;
  std::unique_ptr<std::FILE, CloseFile> file_;
  std::vector<unsigned char> input_;
  std::vector<unsigned char> output_;
  z_stream stream_{};
  std::uint64_t total_ = 0;
};

}  // namespace

void inflate_file(const fs::path& path, std::uint64_t offset, const InflateSink& sink) {
  Inflater(path, offset).run(sink);
}

std::uint64_t inflated_size(const fs::path& path, std::uint64_t offset, const Progress& progress) {
  std::uint64_t total = 0;
  inflate_file(path, offset, [&](std::span<const unsigned char> block) {
    total += block.size();
    tick(progress, 0.0, path);
    return true;
  });
  return total;
}

std::vector<unsigned char> inflate_to_memory(const fs::path& path, const Progress& progress) {
  std::vector<unsigned char> bytes;
  try {
    inflate_file(path, 0, [&](std::span<const unsigned char> block) {
      bytes.insert(bytes.end(), block.begin(), block.end());
      tick(progress, 0.0, path);
      return true;
    });
  } catch (const std::bad_alloc&) {
    fail(ErrorCode::TooLarge, path, "decompresses to more than {} bytes, more than memory holds", bytes.size());
  }
  return bytes;
}

bool is_gzip(const fs::path& path) {
  const auto magic = read_bytes(path, 0, 2);
  return magic.size() == 2 && magic[0] == 0x1f && magic[1] == 0x8b;
}

std::vector<unsigned char> read_prefix(const fs::path& path, std::size_t count) {
  if (!is_gzip(path)) return read_bytes(path, 0, count);
  std::vector<unsigned char> bytes;
  inflate_file(path, 0, [&](std::span<const unsigned char> block) {
    const std::size_t wanted = std::min(block.size(), count - bytes.size());
    bytes.insert(bytes.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(wanted));
    return bytes.size() < count;
  });
  return bytes;
}

}  // namespace tegl::io_detail
