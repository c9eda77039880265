// SPDX-License-Identifier: BSD-3-Clause
//
// Implements OutputFile: buffered output.
#include "base/output_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "base/common.hpp"

namespace tegl::io_detail {

namespace {

/// Smaller pieces are collected; larger ones are written from where they are, without a copy.
constexpr std::size_t kBuffer = std::size_t{1} << 17;

[[noreturn]] void write_failed(const std::filesystem::path& target, const char* step) {
  fail(ErrorCode::WriteFailed, target, "cannot be {} ({})", step, std::strerror(errno));
}

}  // namespace

OutputFile::OutputFile(const PendingPath& pending) : target_(pending.target()) {
  buffer_.reserve(kBuffer);
  descriptor_ = ::open(pending.path().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) write_failed(target_, "created");
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::write(const void* data, std::size_t bytes) {
  const auto* const from = static_cast<const char*>(data);
  if (bytes > kBuffer - buffer_.size()) flush();
  if (bytes >= kBuffer)
    write_through(from, bytes);
  else
    buffer_.insert(buffer_.end(), from, from + bytes);
}

void OutputFile::flush() {
  write_through(buffer_.data(), buffer_.size());
  buffer_.clear();
}

void OutputFile::write_through(const char* from, std::size_t bytes) {
  while (bytes > 0) {
    constexpr std::size_t kMost = std::size_t{1} << 30;  // some systems refuse more at a time
    const ssize_t count = ::write(descriptor_, from, std::min(bytes, kMost));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) write_failed(target_, "written");
    from += count;
    bytes -= static_cast<std::size_t>(count);
  }
}

void OutputFile::close() {
  flush();
  // Full disks and quotas may only be reported here.
  if (::close(std::exchange(descriptor_, -1)) != 0) write_failed(target_, "written");
}

}  // namespace tegl::io_detail
