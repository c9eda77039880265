// SPDX-License-Identifier: BSD-3-Clause
//
// Implements OutputFile: buffered output.
#include "base/output_file.hpp"

#include <cerrno>
#include <cstring>

#include "base/common.hpp"

namespace tegl::io_detail {

namespace {

[[noreturn]] void write_failed(const std::filesystem::path& target, const char* step) {
  fail(ErrorCode::WriteFailed, target, "cannot be {} ({})", step, std::strerror(errno));
}

}  // namespace

OutputFile::OutputFile(const PendingPath& pending) : target_(pending.target()), buffer_(std::size_t{1} << 20) {
  file_.reset(std::fopen(pending.path().c_str(), "wb"));
  if (!file_) write_failed(target_, "created");
  std::setvbuf(file_.get(), buffer_.data(), _IOFBF, buffer_.size());
}

void OutputFile::write(const void* data, std::size_t bytes) {
  if (bytes > 0 && std::fwrite(data, 1, bytes, file_.get()) != bytes) write_failed(target_, "written");
}

void OutputFile::close() {
  // Full disks and quotas may only be reported here.
  if (std::fclose(file_.release()) != 0) write_failed(target_, "written");
}

}  // namespace tegl::io_detail
