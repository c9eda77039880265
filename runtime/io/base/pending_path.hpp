// SPDX-License-Identifier: BSD-3-Clause
//
// Output files that appear complete or not at all: written to a temporary name beside the target, then renamed. Also
// for the program, which puts several files in place together.
#pragma once

#include <filesystem>

namespace tegl {

/// The absolute path of a file, with symbolic links resolved, including links to files that do not exist yet. All names
/// of one file give the same path. A name in a folder that does not exist is returned unchanged.
std::filesystem::path place_of(const std::filesystem::path& path);

/// A temporary file beside a target, with the target's extension: created empty by the constructor, removed by the
/// destructor unless committed. Symbolic links are followed, including links to files that do not exist yet: the file
/// that they refer to is written, and the links stay. The new file has the permissions of an existing target from the
/// beginning. Thread-safe if each thread has its own objects. Errors of all members: WriteFailed, with the target and
/// the reason.
class PendingPath {
 public:
  /// Creates the temporary file. Also fails if the target exists and is not a file, or cannot be overwritten.
  explicit PendingPath(const std::filesystem::path& target);
  ~PendingPath();
  PendingPath(const PendingPath&) = delete;
  PendingPath& operator=(const PendingPath&) = delete;

  /// The temporary file, to be written to; it exists and is empty at first.
  [[nodiscard]] const std::filesystem::path& path() const& noexcept { return pending_; }
  /// Deleted: a temporary object removes its file.
  const std::filesystem::path& path() const&& = delete;
  /// The target as the caller named it, for messages.
  [[nodiscard]] const std::filesystem::path& target() const& noexcept { return named_; }
  [[nodiscard]] std::filesystem::path target() const&& { return named_; }  ///< a copy, for temporaries
  /// The target's place_of().
  [[nodiscard]] const std::filesystem::path& place() const& noexcept { return place_; }
  [[nodiscard]] std::filesystem::path place() const&& { return place_; }  ///< a copy, for temporaries
  /// Renames the temporary file, written and closed, to the target.
  void commit();
  /// As commit(), but keeps the previous target until destruction, so that roll_back() can restore it. File systems
  /// that cannot exchange two files lose the previous target, as with commit().
  void commit_reversibly();
  /// After commit_reversibly(): restores the previous state, a file or none. No errors: changes that cannot be undone
  /// stay.
  void roll_back() noexcept;

 private:
  friend void remove_pending_files() noexcept;
  enum class State { pending, placed, exchanged, replaced };
  /// Adds this object to the list for remove_pending_files().
  void enlist() noexcept;
  /// Creates the temporary file and adds this object to the list. Returns its descriptor, or -1.
  int create(unsigned mode) noexcept;
  /// Removes this object from the list.
  void delist() noexcept;

  std::filesystem::path named_;
  std::filesystem::path place_;
  std::filesystem::path pending_;
  State state_ = State::pending;
  // Neighbours in the list; null at its ends and for objects outside of it.
  PendingPath* before_ = nullptr;
  PendingPath* after_ = nullptr;
};

/// Removes the temporary files of all PendingPaths of this process. For handlers of fatal signals: async-signal-safe.
/// Call it once, right before the process ends: any thread that creates, commits or destroys a PendingPath afterwards
/// waits forever.
void remove_pending_files() noexcept;

/// Calls write(pending) with the temporary file of a target, and puts the file in place.
template <class Write>
void write_complete_file(const std::filesystem::path& target, const Write& write) {
  PendingPath pending(target);
  write(pending);
  pending.commit();
}

}  // namespace tegl
