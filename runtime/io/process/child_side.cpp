// SPDX-License-Identifier: BSD-3-Clause
//
// The child's side: isolation from the parent, limits, and messages.
#include "process/child_side.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>

#include "base/common.hpp"
#include "base/reading_process.hpp"
#include "process/child_memory.hpp"

namespace tegl::io_detail {

namespace {

/// State of this process if it is a child; global, because readers report to it without knowing about it.
struct ChildSide {
  int socket;
  ChildMemory memory;
  std::string file;  ///< the file being read
};
ChildSide* child_side = nullptr;

volatile pid_t parent_process = 0;

/// A computing child ends here if its parent is gone; a waiting one is ended by the closed connection.
void end_if_orphaned(int) {
  if (getppid() != parent_process) _exit(EXIT_FAILURE);
}

/// Resets the parent's signal handlers. The parent handles Ctrl-C and termination requests, and ends the child.
void reset_signals() {
  struct sigaction action {};
  action.sa_handler = SIG_DFL;
  for (int number = 1; number < NSIG; ++number) sigaction(number, &action, nullptr);
  action.sa_handler = SIG_IGN;
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ}) sigaction(number, &action, nullptr);
  action.sa_handler = end_if_orphaned;
  action.sa_flags = SA_RESTART;
  sigaction(SIGPROF, &action, nullptr);
  constexpr timeval kEverySecond = {1, 0};  // processor time
  const itimerval timer = {kEverySecond, kEverySecond};
  setitimer(ITIMER_PROF, &timer, nullptr);
}

void unblock_signals() {
  sigset_t none;
  sigemptyset(&none);
  pthread_sigmask(SIG_SETMASK, &none, nullptr);
}

/// Inherited connections, pipes and writable files would stay open while the child lives, so they are closed. Read-only
/// files may belong to a library that uses them here too, so they are kept.
bool is_kept(int descriptor, int socket) {
  if (descriptor == socket) return true;
  struct stat status {};
  return fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) &&
         (fcntl(descriptor, F_GETFL) & O_ACCMODE) == O_RDONLY;
}

void close_inherited(int socket) {
  DIR* const folder = opendir("/proc/self/fd");
  if (folder == nullptr) return;
  while (const dirent* const entry = readdir(folder)) {
    char* end = nullptr;
    const long number = std::strtol(entry->d_name, &end, 10);
    const auto descriptor = static_cast<int>(number);
    if (end == entry->d_name || descriptor <= STDERR_FILENO || descriptor == dirfd(folder)) continue;
    if (!is_kept(descriptor, socket)) close(descriptor);
  }
  closedir(folder);
}

void silence() {
  const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream)
    if (nothing < 0 || (nothing != stream && dup2(nothing, stream) < 0)) close(stream);
  if (nothing > STDERR_FILENO) close(nothing);
}

void forbid_core_files() {
  const rlimit none = {0, 0};
  setrlimit(RLIMIT_CORE, &none);
  prctl(PR_SET_DUMPABLE, 0);  // also prevents dumps to a pipe
}

/// Removes the file size limit: the system applies it to shared memory too, and the child writes no files.
void allow_large_blocks() {
  rlimit limit{};
  if (getrlimit(RLIMIT_FSIZE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_FSIZE, &limit);
}

/// Sends a message; ends the process if the parent is gone.
void send_message(int socket, MessageKind kind, std::span<const unsigned char> bytes, int descriptor = -1,
                  std::uint64_t in_file = 0) {
  MessageHead head;
  head.kind = kind;
  head.in_file = in_file;
  std::array<iovec, 2> parts = {iovec{&head, sizeof(head)},
                                iovec{const_cast<unsigned char*>(bytes.data()), bytes.size()}};
  msghdr header{};
  header.msg_iov = parts.data();
  header.msg_iovlen = parts.size();
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
  if (descriptor >= 0) {
    header.msg_control = control.data();
    header.msg_controllen = control.size();
    cmsghdr* const first = CMSG_FIRSTHDR(&header);
    first->cmsg_level = SOL_SOCKET;
    first->cmsg_type = SCM_RIGHTS;
    first->cmsg_len = CMSG_LEN(sizeof(int));
    std::memcpy(CMSG_DATA(first), &descriptor, sizeof(int));
  }
  ssize_t sent = 0;
  do sent = sendmsg(socket, &header, MSG_NOSIGNAL);
  while (sent < 0 && errno == EINTR);
  if (sent < 0) _exit(EXIT_FAILURE);
}

/// A copy of bytes in a memory file, in whole pages.
class FileCopy {
 public:
  FileCopy(const void* bytes, std::size_t count, std::size_t size)
      : size_(size), descriptor_(create_memory_file(size, begin_)) {
    if (descriptor_ < 0 && errno == EFBIG)
      fail(ErrorCode::TooLarge, child_side->file,
           "{} bytes cannot be passed on by the child process that reads it: the system's limit of file sizes (ulimit "
           "-f) includes shared memory; expected a larger limit, or reading in the same process (separate_process = "
           "false, --in-process)",
           size);
    if (descriptor_ < 0) throw std::bad_alloc();
    std::memcpy(begin_, bytes, count);
  }
  ~FileCopy() {
    munmap(begin_, size_);
    close(descriptor_);
  }
  FileCopy(const FileCopy&) = delete;
  FileCopy& operator=(const FileCopy&) = delete;
  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }

 private:
  void* begin_ = nullptr;
  std::size_t size_;
  int descriptor_;
};

void send_package(int socket, MessageKind kind, const Packer& packer) {
  for (const Packer::Block& block : packer.blocks()) {
    const int descriptor = child_side->memory.descriptor(block.begin);
    if (descriptor >= 0)
      send_message(socket, MessageKind::block, {}, descriptor);
    else
      send_message(socket, MessageKind::block, {}, FileCopy(block.begin, block.used, block.bytes).descriptor());
  }
  const auto bytes = packer.bytes();
  if (bytes.size() <= kMostInline) return send_message(socket, kind, bytes);
  const FileCopy copy(bytes.data(), bytes.size(), bytes.size());
  send_message(socket, kind, {}, copy.descriptor(), bytes.size());
}

template <class Number>
void send_number(MessageKind kind, Number number) {
  Packer packer;
  packer.number(number);
  send_message(child_side->socket, kind, packer.bytes());
}

/// Raises the limits of this child as its readers report their needs.
class LimitsOfChild final : public ReadingLimits {
 public:
  void file(const std::filesystem::path& path) override {
    constexpr std::uint64_t kTimesItsSize = 4;  // libraries keep parts of a file, and tables of its contents
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    const std::uint64_t known = error ? 0 : size;
    child_side->memory.allow(kTimesItsSize * known);
    child_side->file = path.string();
    Packer packer;
    packer.text(path.native());
    if (packer.bytes().size() <= kMostInline) send_message(child_side->socket, MessageKind::file, packer.bytes());
    constexpr double kSlowest = 16 * 1024 * 1024;  // bytes per second, for a library that reads a file's tables
    send_number(MessageKind::grant, static_cast<double>(known) / kSlowest);
  }

  void memory(std::uint64_t bytes) override { child_side->memory.allow(bytes); }

  void objects(std::uint64_t count) override {
    // netCDF-C 4.9 takes 65 to 85 kB and up to 1.5 ms per variable, compressed or not, or group.
    constexpr std::uint64_t kBytes = std::uint64_t{1} << 17;
    constexpr double kSeconds = 0.005;
    child_side->memory.allow(kBytes * count);
    send_number(MessageKind::grant, kSeconds * static_cast<double>(count));
  }

  void step(std::uint64_t bytes) override {
    constexpr std::uint64_t kSmall = std::uint64_t{1} << 25;  // negligible, and would be many messages
    if (bytes < kSmall) return;
    constexpr double kSlowest = 64 * 1024 * 1024;  // bytes per second, for the slowest decompression
    send_number(MessageKind::grant, static_cast<double>(bytes) / kSlowest);
  }
};

void send_out_of_memory() {
  if (child_side == nullptr) _exit(EXIT_FAILURE);
  const auto by_limit = static_cast<std::uint8_t>(child_side->memory.is_limiting());
  const std::uint64_t limit = child_side->memory.allowed();
  constexpr std::uint64_t kForTheMessage = std::uint64_t{1} << 20;
  child_side->memory.allow(kForTheMessage);
  Packer packer;
  packer.number(by_limit);
  packer.number(limit);
  send_message(child_side->socket, MessageKind::out_of_memory, packer.bytes());
}

void send_failure(const Error& error) {
  if (child_side == nullptr) _exit(EXIT_FAILURE);
  constexpr std::uint64_t kForTheMessage = std::uint64_t{1} << 20;
  child_side->memory.allow(kForTheMessage);
  Packer packer;
  packer.number(static_cast<std::uint64_t>(error.code()));
  packer.text(error.what());
  send_package(child_side->socket, MessageKind::failure, packer);
}

}  // namespace

Progress ParentLink::progress() const {
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kEvery(20);
  return [last = Clock::time_point()](double fraction) mutable {
    const auto now = Clock::now();
    if (fraction < 1.0 && now - last < kEvery) return true;  // the end is always reported
    last = now;
    send_number(MessageKind::progress, fraction);
    return true;
  };
}

void ParentLink::send(const Packer& packer) const { send_package(socket_, MessageKind::result, packer); }

std::optional<LayerRequest> ParentLink::receive() const {
  LayerRequest request;
  ssize_t size = 0;
  do size = recv(socket_, &request, sizeof(request), 0);
  while (size < 0 && errno == EINTR);
  if (size != static_cast<ssize_t>(sizeof(request))) return std::nullopt;
  return request;
}

void run_child_side(int socket, pid_t parent, const ChildLimits& limits, const ChildWork& work) noexcept {
  // isolate this process from the parent
  parent_process = parent;
  reset_signals();
  forbid_core_files();
  allow_large_blocks();
  // work
  try {
    close_inherited(socket);
    silence();
    static ChildSide side{socket, ChildMemory(limits.memory), {}};
    child_side = &side;
    static LimitsOfChild reading_limits;
    set_reading_limits(&reading_limits);
    detail::exchange_block_source(&side.memory);
    unblock_signals();
    work(ParentLink(socket));
  } catch (const Error& error) {
    send_failure(error);
  } catch (const std::bad_alloc&) {
    send_out_of_memory();
  } catch (const std::exception& error) {
    send_failure(Error(ErrorCode::MalformedFile, fmt::format("{}: {}", child_side->file, error.what())));
  } catch (...) {
    _exit(EXIT_FAILURE);
  }
  _exit(EXIT_SUCCESS);
}

}  // namespace tegl::io_detail
