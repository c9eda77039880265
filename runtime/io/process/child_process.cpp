// SPDX-License-Identifier: BSD-3-Clause
//
// The parent's side: starts a child, receives its messages within its limits, and reports its end. The child's side is
// in child_side.cpp.
#include "process/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <new>

#include "base/common.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

/// Creates both ends of a connection that preserves message boundaries; neither is a standard stream.
std::array<int, 2> connect_pair() {
  std::array<int, 2> ends = {-1, -1};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) return {-1, -1};
  for (int& end : ends) {
    if (end > STDERR_FILENO) continue;
    const int moved = fcntl(end, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    close(end);
    end = moved;
  }
  return ends;
}

/// Blocks signals during the fork, so that no handler of the parent runs in the child.
class BlockedSignals {
 public:
  BlockedSignals() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~BlockedSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  BlockedSignals(const BlockedSignals&) = delete;
  BlockedSignals& operator=(const BlockedSignals&) = delete;

 private:
  sigset_t before_{};
};

/// Hint for valid files that exceed the limits.
constexpr const char* kWithoutLimits = " (--in-process, or separate_process = false, reads without limits)";

/// Processor time of a process so far; 0 if unknown.
double seconds_used(pid_t process) {
  clockid_t clock = 0;
  timespec time{};
  if (clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &time) != 0) return 0;
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

/// A message, and its descriptor if it has one.
struct ChildProcess::Message {
  MessageKind kind = MessageKind::closed;
  Package package;
  int descriptor = -1;
};

ChildProcess::ChildProcess(fs::path path, const Work& work, const ChildLimits& limits)
    : path_(std::move(path)), limits_(limits), owner_(getpid()) {
  const std::array<int, 2> ends = connect_pair();
  socket_ = ends[0];
  int reason = errno;
  if (ends[0] >= 0 && ends[1] >= 0) {
    const BlockedSignals blocked;
    pid_ = fork();
    if (pid_ == 0) run_child_side(ends[1], owner_, limits_, work);
    reason = errno;
  }
  if (ends[1] >= 0) close(ends[1]);
  if (pid_ > 0) return;
  if (socket_ >= 0) close(socket_);
  fail(ErrorCode::FileNotFound, path_, "cannot be read, as no process can be started for it ({})",
       std::strerror(reason));
}

ChildProcess::~ChildProcess() { end(); }

void ChildProcess::end() noexcept {
  const bool is_owner = getpid() == owner_;  // false in a fork of the owner
  if (is_owner && pid_ > 0) {
    kill(pid_, SIGKILL);
    int status = 0;
    pid_t ended = 0;
    do ended = waitpid(pid_, &status, 0);
    while (ended < 0 && errno == EINTR);
    if (ended == pid_) status_ = status;
    pid_ = -1;
  }
  if (socket_ >= 0) close(socket_);
  socket_ = -1;
}

void ChildProcess::fail_damaged(const std::string& reason) {
  end();
  fail(ErrorCode::MalformedFile, path_, "is damaged: reading it {}", reason);
}

void ChildProcess::fail_died() {
  end();  // has no effect on a process that has already ended
  if (status_ && WIFSIGNALED(*status_)) {
    const int number = WTERMSIG(*status_);
    const char* const name = sigdescr_np(number);
    fail_damaged(fmt::format("ended by signal {} ({})", number, name == nullptr ? "unknown" : name));
  }
  fail_damaged("ended without a result");
}

void ChildProcess::rethrow(const Message& message) {
  Package package = {
      std::vector<unsigned char>(message.package.bytes().begin(), message.package.bytes().end()), {}, {}};
  Unpacker unpacker(package);
  if (message.kind == MessageKind::out_of_memory) {
    const bool is_limit = unpacker.number<std::uint8_t>() != 0;
    const auto bytes = unpacker.number<std::uint64_t>();
    if (is_limit) fail_damaged(fmt::format("needed more than {} MiB of memory{}", bytes >> 20, kWithoutLimits));
    end();
    throw std::bad_alloc();
  }
  const std::size_t code = unpacker.count(static_cast<std::size_t>(ErrorCode::Cancelled));
  const std::string text = unpacker.text();
  end();
  throw Error(static_cast<ErrorCode>(code), text);
}

/// Receives and validates a message; `closed` if the child has ended.
ChildProcess::Message ChildProcess::next_message() {
  Message message;
  MessageHead head;
  message.package.small.resize(kMostInline);
  std::array<iovec, 2> parts = {iovec{&head, sizeof(head)}, iovec{message.package.small.data(), kMostInline}};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
  msghdr header{};
  // receive
  header.msg_iov = parts.data();
  header.msg_iovlen = parts.size();
  header.msg_control = control.data();
  header.msg_controllen = CMSG_LEN(sizeof(int));  // one descriptor
  ssize_t size = 0;
  do size = recvmsg(socket_, &header, MSG_CMSG_CLOEXEC);
  while (size < 0 && errno == EINTR);
  if (size < 0) return message;
  if (const cmsghdr* const first = CMSG_FIRSTHDR(&header); first != nullptr && first->cmsg_level == SOL_SOCKET &&
                                                           first->cmsg_type == SCM_RIGHTS &&
                                                           first->cmsg_len == CMSG_LEN(sizeof(int)))
    std::memcpy(&message.descriptor, CMSG_DATA(first), sizeof(int));
  if (size == 0 && message.descriptor < 0) return message;
  // validate
  const auto bytes = static_cast<std::size_t>(size);
  const bool is_whole = bytes >= sizeof(head) && (header.msg_flags & (MSG_TRUNC | MSG_CTRUNC)) == 0;
  const bool is_known = is_whole && head.magic == kMessageMagic && head.version == kMessageVersion &&
                        head.kind > MessageKind::closed && head.kind <= MessageKind::out_of_memory;
  const bool has_file = head.in_file != 0 || head.kind == MessageKind::block;
  const bool may_have_file = head.kind >= MessageKind::block;
  if (!is_known || has_file != (message.descriptor >= 0) || (has_file && !may_have_file)) {
    if (message.descriptor >= 0) close(message.descriptor);
    throw BadPackage();
  }
  message.kind = head.kind;
  message.package.small.resize(bytes - sizeof(head));
  return message;
}

/// Maps a sealed memory file; the seal guarantees that its pages exist. A private mapping shares its pages until they
/// are written to, so a later fork of this process has its own values.
void ChildProcess::take_block(int descriptor, std::vector<Mapping>& blocks, bool shared) {
  struct stat status {};
  const int seals = fcntl(descriptor, F_GET_SEALS);
  const bool is_sound =
      seals >= 0 && (seals & F_SEAL_SHRINK) != 0 && fstat(descriptor, &status) == 0 && status.st_size > 0;
  const auto bytes = static_cast<std::size_t>(status.st_size);
  const bool is_known = is_sound && shared && shared_file_ == status.st_ino && shared_block_.bytes() == bytes;
  void* begin = MAP_FAILED;
  if (is_sound && !is_known)
    begin = mmap(nullptr, bytes, shared ? PROT_READ : PROT_READ | PROT_WRITE, shared ? MAP_SHARED : MAP_PRIVATE,
                 descriptor, 0);
  close(descriptor);
  if (!is_sound) throw BadPackage();
  if (!is_known && begin == MAP_FAILED) throw std::bad_alloc();
  if (!shared) {
    blocks.emplace_back(begin, bytes);
    return;
  }
  if (!is_known) {
    shared_block_ = Mapping(begin, bytes);
    shared_file_ = status.st_ino;
  }
}

void ChildProcess::require_time(double fraction, const Progress& progress) {
  tick(progress, fraction, path_);
  const double used = seconds_used(pid_);
  const auto now = std::chrono::steady_clock::now();
  if (used > used_last_) {
    used_last_ = used;
    standing_since_ = now;
  }
  constexpr std::chrono::seconds kLongestWait(120);  // allows for a slow disk or network
  if (now - standing_since_ > kLongestWait)
    fail_damaged(fmt::format("waited for more than {} s without progress{}", kLongestWait.count(), kWithoutLimits));
  if (used - used_before_ <= limits_.seconds + granted_) return;
  fail_damaged(fmt::format("took more than {:.3g} s of processor time without progress{}", limits_.seconds + granted_,
                           kWithoutLimits));
}

/// State of wait().
struct ChildProcess::Waiting {
  bool shared;                  ///< blocks are lent
  std::vector<Mapping> blocks;  ///< received so far
  double fraction = 0;          ///< of the child's work
};

/// A sign of progress: the limits of time start anew.
void ChildProcess::note_progress() noexcept {
  used_before_ = used_last_ = seconds_used(pid_);
  standing_since_ = std::chrono::steady_clock::now();
  granted_ = 0;
}

/// Handles a message before the result.
void ChildProcess::take_message(Message& message, Waiting& waiting, const Progress& progress) {
  constexpr double kMostSeconds = 3600;
  const auto unpacked = [&](auto use) {
    Unpacker unpacker(message.package);
    use(unpacker);
    unpacker.require_end();
  };
  switch (message.kind) {
    case MessageKind::progress:
      note_progress();
      unpacked([&](Unpacker& u) { waiting.fraction = u.number<double>(); });
      if (!(waiting.fraction >= 0 && waiting.fraction <= 1)) throw BadPackage();
      return tick(progress, waiting.fraction, path_);
    case MessageKind::file:
      note_progress();
      return unpacked([&](Unpacker& u) { path_ = u.text(); });
    case MessageKind::grant:
      unpacked([&](Unpacker& u) { granted_ += u.number<double>(); });
      if (!(granted_ >= 0)) throw BadPackage();
      granted_ = std::min(granted_, kMostSeconds);
      return;
    case MessageKind::block:
      return take_block(std::exchange(message.descriptor, -1), waiting.blocks, waiting.shared);
    default:
      fail_died();
  }
}

Package ChildProcess::wait(const Progress& progress, bool shared) {
  constexpr int kMilliseconds = 50;
  if (getpid() != owner_ || pid_ <= 0)
    fail(ErrorCode::FileNotFound, path_,
         "cannot be read further: it was opened by another process, or reading failed before");
  Waiting waiting{shared, {}};
  note_progress();
  tick(progress, waiting.fraction, path_);
  // handle messages until the result
  for (;;) {
    pollfd ready{socket_, POLLIN, 0};
    if (poll(&ready, 1, kMilliseconds) <= 0) {
      require_time(waiting.fraction, progress);
      continue;
    }
    Message message = next_message();
    if (message.kind <= MessageKind::block) {
      take_message(message, waiting, progress);
      continue;
    }
    // the result, or an error
    if (message.descriptor >= 0) {
      std::vector<Mapping> file;
      take_block(std::exchange(message.descriptor, -1), file, false);
      message.package.large = std::move(file.front());
    }
    if (message.kind != MessageKind::result) rethrow(message);
    message.package.blocks = std::move(waiting.blocks);
    return std::move(message.package);
  }
}

Package ChildProcess::receive(const Progress& progress, Blocks blocks) {
  try {
    return wait(progress, blocks == Blocks::lent);
  } catch (const BadPackage&) {
    fail_contradiction();
  } catch (...) {
    end();
    throw;
  }
}

void ChildProcess::fail_contradiction() { fail_damaged("gave an inconsistent result"); }

void ChildProcess::request(const LayerRequest& request) {
  if (getpid() != owner_ || pid_ <= 0) return;  // receive() throws in this case
  send(socket_, &request, sizeof(request), MSG_NOSIGNAL);
}

}  // namespace tegl::io_detail
