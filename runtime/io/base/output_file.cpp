// SPDX-License-Identifier: BSD-3-Clause
//
// Files that appear whole or not at all.
#include "base/output_file.hpp"

#include <fcntl.h>
#include <sched.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <system_error>

#include "base/common.hpp"
#include "tegl/io.hpp"

namespace tegl {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void write_failed(const fs::path& path, const char* step, int reason) {
  io_detail::fail(ErrorCode::WriteFailed, path, "cannot be {} ({})", step, std::strerror(reason));
}

/// Exchanges what two names lead to. False where the file system cannot.
bool exchange(const fs::path& a, const fs::path& b) noexcept {
#ifdef RENAME_EXCHANGE
  return renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0;
#else
  return false;
#endif
}

// The list of pending files, as remove_pending_files() needs it in a signal handler, which must not wait for a lock
// that the interrupted thread holds. So whoever changes the list blocks all signals of its thread while it has the
// lock.
std::atomic_flag list_locked = ATOMIC_FLAG_INIT;
PendingPath* first_pending = nullptr;

void lock_list() noexcept {
  while (list_locked.test_and_set(std::memory_order_acquire)) sched_yield();
}

/// How many listed files are being created. The lock is not held meanwhile, and no signal is blocked: a disk or a
/// network may take its time.
std::atomic<int> creations{0};
static_assert(std::atomic<int>::is_always_lock_free);

class LockedList {
 public:
  LockedList() noexcept {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before_);
    lock_list();
  }
  ~LockedList() {
    list_locked.clear(std::memory_order_release);
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  LockedList(const LockedList&) = delete;
  LockedList& operator=(const LockedList&) = delete;

 private:
  sigset_t before_{};
};

}  // namespace

void PendingPath::enlist() noexcept {
  const LockedList lock;
  after_ = first_pending;
  if (after_ != nullptr) after_->before_ = this;
  first_pending = this;
}

int PendingPath::create(unsigned mode) noexcept {
  enlist();  // first, so that no signal finds a file that is not in the list
  creations.fetch_add(1);
  const int file = open(pending_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, mode);
  const int reason = errno;
  creations.fetch_sub(1);
  if (file < 0) delist();
  errno = reason;
  return file;
}

void PendingPath::delist() noexcept {
  const LockedList lock;
  if (first_pending == this) first_pending = after_;
  if (before_ != nullptr) before_->after_ = after_;
  if (after_ != nullptr) after_->before_ = before_;
  before_ = after_ = nullptr;
}

void remove_pending_files() noexcept {
  lock_list();  // for good: nobody changes the list of a process that ends
  const auto remove_all = [] {
    for (const PendingPath* each = first_pending; each != nullptr; each = each->after_) unlink(each->pending_.c_str());
  };
  remove_all();
  if (creations.load() == 0) return;
  // Another thread may create its file after that; a creation that takes longer, or that this handler interrupts, is
  // not waited for.
  constexpr int kMilliseconds = 1000;
  constexpr timespec kMillisecond = {0, 1'000'000};
  for (int i = 0; i < kMilliseconds && creations.load() > 0; ++i) nanosleep(&kMillisecond, nullptr);
  remove_all();
}

fs::path place_of(const fs::path& path) {
  constexpr int kMostLinks = 40;  // as the kernel has it
  std::error_code error;
  fs::path place = path;
  for (int links = 0; links < kMostLinks && fs::is_symlink(place, error); ++links) {
    const fs::path to = fs::read_symlink(place, error);
    if (error) break;
    place = place.parent_path() / to;  // `to` itself if it is absolute
  }
  // Canonical names of whole paths stop at links that lead to no file; those of folders do not.
  const fs::path folder = place.has_parent_path() ? place.parent_path() : fs::path(".");
  const fs::path known = fs::canonical(folder, error);
  return error ? place : known / place.filename();
}

PendingPath::PendingPath(const fs::path& target) : named_(target), place_(place_of(target)) {
  std::error_code error;
  const fs::file_status status = fs::status(place_, error);
  if (fs::exists(status) && !fs::is_regular_file(status))
    io_detail::fail(ErrorCode::WriteFailed, named_, "is {}; expected the name of a file",
                    fs::is_directory(status) ? "a directory" : "not a regular file");
  if (fs::is_symlink(place_, error)) write_failed(named_, "overwritten", ELOOP);
  if (fs::exists(status) && access(place_.c_str(), W_OK) != 0) write_failed(named_, "overwritten", errno);
  // One's own file is to be written, whoever may write to another's that it takes the place of.
  const auto mode = fs::exists(status) ? static_cast<mode_t>(status.permissions() & fs::perms::all) | 0600U : 0666U;
  constexpr int kAttempts = 1000;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    // With the target's extension, by which formats are chosen.
    pending_ = place_.parent_path() /
               fmt::format(".{}-{}.{}", static_cast<long>(getpid()), attempt, place_.filename().string());
    const int file = create(mode);
    if (file >= 0) {
      // The umask has its say on new files alone.
      if (fs::exists(status)) static_cast<void>(fchmod(file, mode));
      close(file);
      return;
    }
    if (errno != EEXIST) write_failed(named_, "created", errno);
  }
  write_failed(named_, "created", EEXIST);
}

PendingPath::~PendingPath() {
  std::error_code ignored;
  if (state_ == State::pending || state_ == State::exchanged) fs::remove(pending_, ignored);
  delist();
}

void PendingPath::commit() {
  std::error_code error;
  fs::rename(pending_, place_, error);
  if (error) write_failed(named_, "put in place", error.value());
  state_ = State::replaced;
}

void PendingPath::commit_reversibly() {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(place_, error);
  const bool is_new = !fs::exists(status);
  if (fs::is_regular_file(status) && exchange(pending_, place_)) {
    state_ = State::exchanged;
    return;
  }
  commit();
  if (is_new) state_ = State::placed;
}

void PendingPath::roll_back() noexcept {
  std::error_code ignored;
  if (state_ == State::exchanged && exchange(pending_, place_)) state_ = State::pending;
  if (state_ != State::placed) return;
  fs::remove(place_, ignored);
  state_ = State::replaced;
}

}  // namespace tegl

namespace tegl::io_detail {

namespace fs = std::filesystem;

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
