// SPDX-License-Identifier: BSD-3-Clause
//
// Files that appear whole or not at all: written under another name beside the target, and renamed at the end.
#pragma once

#include <filesystem>

namespace tegl {

/// Where a file of this name lies: absolute, and behind symbolic links, also those that lead to no file yet. Two names
/// of one file have one place. A name in a folder that does not exist stays as it is.
std::filesystem::path place_of(const std::filesystem::path& path);

/// A name beside a target, with its extension: claimed on construction by an empty file, removed on destruction unless
/// committed. Symbolic links are followed, also those that lead to no file yet: what they lead to is written, and they
/// stay. A target that is there keeps its permissions, which the new file has from the beginning. Safe to use from
/// several threads, each with its own objects. Errors of all members: WriteFailed, naming the target and the reason.
class PendingPath {
 public:
  /// Claims a name beside the target. Errors also where the target is there and no file, or cannot be overwritten.
  explicit PendingPath(const std::filesystem::path& target);
  ~PendingPath();
  PendingPath(const PendingPath&) = delete;
  PendingPath& operator=(const PendingPath&) = delete;

  /// Where to write; the file exists and is empty.
  [[nodiscard]] const std::filesystem::path& path() const& noexcept { return pending_; }
  /// Deleted: with the temporary the file is gone.
  const std::filesystem::path& path() const&& = delete;
  /// The target as the user named it, for messages.
  [[nodiscard]] const std::filesystem::path& target() const& noexcept { return named_; }
  [[nodiscard]] std::filesystem::path target() const&& { return named_; }  ///< of a temporary: a copy
  /// place_of() the target.
  [[nodiscard]] const std::filesystem::path& place() const& noexcept { return place_; }
  [[nodiscard]] std::filesystem::path place() const&& { return place_; }  ///< of a temporary: a copy
  /// Moves the file, written and closed, to its place.
  void commit();
  /// As commit(), but what was there is kept until destruction, so that roll_back() can restore it. File systems that
  /// cannot exchange two files lose what was there, as with commit().
  void commit_reversibly();
  /// After commit_reversibly(): what was there before, a file or nothing, is there again. No errors: what cannot be
  /// undone stays.
  void roll_back() noexcept;

 private:
  friend void remove_pending_files() noexcept;
  enum class State { pending, placed, exchanged, replaced };
  /// Enters the list of files that remove_pending_files() removes.
  void enlist() noexcept;
  /// Creates the pending file, listed. Returns its descriptor, or -1.
  int create(unsigned mode) noexcept;
  /// Leaves the list.
  void delist() noexcept;

  std::filesystem::path named_;
  std::filesystem::path place_;
  std::filesystem::path pending_;
  State state_ = State::pending;
  // Neighbours in the list; null at its ends, and for files that are not in it.
  PendingPath* before_ = nullptr;
  PendingPath* after_ = nullptr;
};

/// Removes the files that all PendingPaths of this process still hold. For handlers of signals that end the program:
/// async-signal-safe, and to be called once, by a process that ends right after it. Any thread that creates, commits or
/// destroys a PendingPath afterwards waits forever.
void remove_pending_files() noexcept;

}  // namespace tegl
