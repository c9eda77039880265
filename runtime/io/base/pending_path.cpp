// SPDX-License-Identifier: BSD-3-Clause
//
// Implements PendingPath: files that appear complete or not at all.
#include "base/pending_path.hpp"

#include <fcntl.h>
#include <sched.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <system_error>

#include "base/common.hpp"

namespace tegl {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void write_failed(const fs::path& path, const char* step, int reason) {
  io_detail::fail(ErrorCode::WriteFailed, path, "cannot be {} ({})", step, std::strerror(reason));
}

/// Atomically exchanges two files. Returns false if the file system does not support it.
bool exchange(const fs::path& a, const fs::path& b) noexcept {
#ifdef RENAME_EXCHANGE
  return renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0;
#else
  return false;
#endif
}

// The list of pending files. remove_pending_files() reads it in a signal handler, which must not wait for a lock that
// the interrupted thread holds. So a thread that changes the list blocks all its signals while it holds the lock.
std::atomic_flag list_locked = ATOMIC_FLAG_INIT;
PendingPath* first_pending = nullptr;

void lock_list() noexcept {
  while (list_locked.test_and_set(std::memory_order_acquire)) sched_yield();
}

/// Number of listed files being created. During creation no lock is held and no signal is blocked, because a disk or
/// network may be slow.
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
  enlist();  // first, so a signal handler finds every file in the list
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
  lock_list();  // never unlocked: the process ends, and no other thread may change the list
  const auto remove_all = [] {
    for (const PendingPath* each = first_pending; each != nullptr; each = each->after_) unlink(each->pending_.c_str());
  };
  remove_all();
  if (creations.load() == 0) return;
  // Another thread may create its file after this pass, so wait up to a second for running creations. Slower ones, and
  // one that this handler interrupted, are not awaited longer.
  constexpr int kMilliseconds = 1000;
  constexpr timespec kMillisecond = {0, 1'000'000};
  for (int i = 0; i < kMilliseconds && creations.load() > 0; ++i) nanosleep(&kMillisecond, nullptr);
  remove_all();
}

fs::path place_of(const fs::path& path) {
  constexpr int kMostLinks = 40;  // the limit of Linux
  std::error_code error;
  fs::path place = path;
  for (int links = 0; links < kMostLinks && fs::is_symlink(place, error); ++links) {
    const fs::path to = fs::read_symlink(place, error);
    if (error) break;
    place = place.parent_path() / to;  // `to` itself if it is absolute
  }
  // fs::canonical of a whole path fails at links to missing files; of the folder it does not.
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
  // The owner can always write the new file, even if the target's permissions do not allow it.
  const auto mode = fs::exists(status) ? static_cast<mode_t>(status.permissions() & fs::perms::all) | 0600U : 0666U;
  constexpr int kAttempts = 1000;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    // Keeps the target's extension, which selects the format.
    pending_ = place_.parent_path() /
               fmt::format(".{}-{}.{}", static_cast<long>(getpid()), attempt, place_.filename().string());
    const int file = create(mode);
    if (file >= 0) {
      // The umask applies to new targets only.
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
