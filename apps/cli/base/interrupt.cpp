// SPDX-License-Identifier: BSD-3-Clause
//
// Implements the handling of signals that end the program.
#include "base/interrupt.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <ctime>
#include <utility>

#include "io/base/pending_path.hpp"
#include "tegl/error.hpp"

namespace tegl::cli {

namespace {

constexpr std::array kEndingSignals = {SIGINT, SIGTERM, SIGHUP, SIGPIPE};
constexpr int kTimeIsUp = SIGALRM;
constexpr long kGraceNanoseconds = 250'000'000;
constexpr long kRetryNanoseconds = 10'000'000;

// A signal handler can only access static storage. Lock-free atomics are safe in it and in any thread.
std::atomic<int> first_signal{0};
std::atomic<int> undivided_steps{0};
static_assert(std::atomic<int>::is_always_lock_free);

// Set before the handlers are installed, and constant while they are.
std::string farewell_text;
pid_t owner = 0;
timer_t timer{};
bool has_timer = false;
std::array<struct sigaction, kEndingSignals.size()> former_actions{};
struct sigaction former_alarm {};

/// Async-signal-safe.
void set_timer(long nanoseconds) noexcept {
  if (!has_timer) return;
  itimerspec when{};
  when.it_value.tv_nsec = nanoseconds;
  timer_settime(timer, 0, &when, nullptr);
}

/// Async-signal-safe.
[[noreturn]] void end_at_once() noexcept {
  remove_pending_files();
  static_cast<void>(!write(STDERR_FILENO, farewell_text.data(), farewell_text.size()));
  end_by_signal(first_signal.load());
}

extern "C" void on_signal(int signal, siginfo_t* info, void* /*context*/) {
  const int own_errno = errno;
  if (getpid() != owner) end_by_signal(signal);  // in a child process, which has its own outputs
  // For a failed write, the sender of SIGPIPE is this process itself.
  const bool of_own_write = signal == SIGPIPE && info->si_pid == owner;
  int none = 0;
  if (!of_own_write) {
    if (signal != kTimeIsUp && first_signal.compare_exchange_strong(none, signal))
      set_timer(kGraceNanoseconds);
    else if (undivided_steps.load() > 0)
      set_timer(kRetryNanoseconds);
    else if (first_signal.load() != 0)
      end_at_once();
  }
  errno = own_errno;
}

void handle(int signal, struct sigaction* former) {
  struct sigaction action {};
  action.sa_sigaction = on_signal;
  sigfillset(&action.sa_mask);
  action.sa_flags = static_cast<int>(SA_SIGINFO | SA_RESTART);
  sigaction(signal, &action, former);
}

}  // namespace

InterruptHandler::InterruptHandler(std::string farewell) {
  farewell_text = std::move(farewell);
  owner = getpid();
  first_signal.store(0);
  handle(kTimeIsUp, &former_alarm);
  sigevent event{};
  event.sigev_notify = SIGEV_SIGNAL;
  event.sigev_signo = kTimeIsUp;
  has_timer = timer_create(CLOCK_MONOTONIC, &event, &timer) == 0;
  for (std::size_t i = 0; i < kEndingSignals.size(); ++i) {
    handle(kEndingSignals[i], &former_actions[i]);
    if (kEndingSignals[i] == SIGHUP && former_actions[i].sa_handler == SIG_IGN)
      sigaction(SIGHUP, &former_actions[i], nullptr);
  }
}

InterruptHandler::~InterruptHandler() {
  for (std::size_t i = 0; i < kEndingSignals.size(); ++i) sigaction(kEndingSignals[i], &former_actions[i], nullptr);
  if (has_timer) timer_delete(timer);
  has_timer = false;
  sigaction(kTimeIsUp, &former_alarm, nullptr);
}

int InterruptHandler::signal() noexcept { return first_signal.load(); }

void InterruptHandler::throw_if_requested() {
  if (requested()) throw Error(ErrorCode::Cancelled, "cancelled; nothing was written");
}

InterruptHandler::Undivided::Undivided() noexcept { undivided_steps.fetch_add(1); }
InterruptHandler::Undivided::~Undivided() { undivided_steps.fetch_sub(1); }

void end_by_signal(int signal) noexcept {
  struct sigaction action {};
  action.sa_handler = SIG_DFL;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
  sigset_t only;
  sigemptyset(&only);
  sigaddset(&only, signal);
  // to the process and not a thread: a handler may run in any thread
  kill(getpid(), signal);
  pthread_sigmask(SIG_UNBLOCK, &only, nullptr);
  constexpr int kBase = 128;
  _exit(kBase + signal);
}

void occupy_closed_streams() noexcept {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) == -1 && errno == EBADF)
      // open() returns the lowest free descriptor: this one. Standard output is read-only, so writes to it still fail.
      static_cast<void>(open("/dev/null", stream == STDOUT_FILENO ? O_RDONLY : O_WRONLY));
}

}  // namespace tegl::cli
