// SPDX-License-Identifier: BSD-3-Clause
//
// Files that appear whole or not at all.
#include "output_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "common.hpp"
#include "tegl/io.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void write_failed(const fs::path& path, const char* step, int reason) {
  fail(ErrorCode::WriteFailed, path, "cannot be {} ({})", step, std::strerror(reason));
}

/// Links are followed, so that they are written through and not replaced.
fs::path behind_links(const fs::path& path) {
  std::error_code error;
  fs::path resolved = fs::is_symlink(path, error) ? fs::weakly_canonical(path, error) : path;
  return error ? path : resolved;
}

}  // namespace

PendingPath::PendingPath(const fs::path& target) : named_(target), target_(behind_links(target)) {
  std::error_code error;
  const fs::file_status status = fs::status(target_, error);
  if (fs::exists(status) && !fs::is_regular_file(status))
    fail(ErrorCode::WriteFailed, named_, "is {}; expected the name of a file",
         fs::is_directory(status) ? "a directory" : "not a regular file");
  if (fs::exists(status) && access(target_.c_str(), W_OK) != 0) write_failed(named_, "overwritten", errno);
  constexpr int kAttempts = 1000;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    pending_ = target_.parent_path() /
               fmt::format(".{}.{}-{}.part", target_.filename().string(), static_cast<long>(getpid()), attempt);
    const int file = open(pending_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (file >= 0) {
      close(file);
      return;
    }
    if (errno != EEXIST) write_failed(named_, "created", errno);
  }
  write_failed(named_, "created", EEXIST);
}

PendingPath::~PendingPath() {
  std::error_code ignored;
  if (!done_) fs::remove(pending_, ignored);
}

void PendingPath::commit() {
  std::error_code error;
  fs::rename(pending_, target_, error);
  if (error) write_failed(named_, "put in place", error.value());
  done_ = true;
}

OutputFile::OutputFile(const fs::path& target) : pending_(target), buffer_(std::size_t{1} << 20) {
  file_.reset(std::fopen(pending_.path().c_str(), "wb"));
  if (!file_) write_failed(target, "created", errno);
  std::setvbuf(file_.get(), buffer_.data(), _IOFBF, buffer_.size());
}

void OutputFile::write(const void* data, std::size_t bytes) {
  if (bytes > 0 && std::fwrite(data, 1, bytes, file_.get()) != bytes) write_failed(target(), "written", errno);
}

void OutputFile::commit() {
  // Full disks and quotas may show only now.
  if (std::fclose(file_.release()) != 0) write_failed(target(), "written", errno);
  pending_.commit();
}

}  // namespace tegl::io_detail

void tegl::write_text(std::string_view text, const std::filesystem::path& path) {
  io_detail::OutputFile file(path);
  file.write(text);
  file.commit();
}
