// SPDX-License-Identifier: BSD-3-Clause
//
// A library for LD_PRELOAD that sends the program SIGINT at a defined point, independently of the machine's speed:
// after all events of TEGL_INTERRUPT_AT ("out_1|frame_5") have occurred in this order. An event is the opening of a
// file whose path contains the text, or such a text on standard error. The call that is the last event continues after
// the signal and after TEGL_STALL seconds, as if the program were in a library without progress. TEGL_SIGNALS sets the
// number of signals.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/types.h>
#include <unistd.h>

#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <mutex>
#include <string>
#include <string_view>

namespace {

int setting(const char* name, int other) {
  const char* const text = std::getenv(name);
  return text == nullptr ? other : std::atoi(text);
}

void interrupt() {
  for (int i = 0; i < setting("TEGL_SIGNALS", 1); ++i) kill(getpid(), SIGINT);
  const std::time_t end = std::time(nullptr) + setting("TEGL_STALL", 0);
  while (std::time(nullptr) < end) usleep(10000);
}

/// The remaining events.
void note(std::string_view event) {
  static std::mutex mutex;
  static std::string left = std::getenv("TEGL_INTERRUPT_AT") == nullptr ? "" : std::getenv("TEGL_INTERRUPT_AT");
  const std::scoped_lock lock(mutex);
  if (left.empty()) return;
  const std::size_t end = left.find('|');
  if (event.find(left.substr(0, end)) == std::string_view::npos) return;
  left = end == std::string::npos ? "" : left.substr(end + 1);
  if (left.empty()) interrupt();
}

/// The replaced function of that name.
template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

mode_t mode_of(int flags, va_list arguments) { return (flags & O_CREAT) != 0 ? va_arg(arguments, mode_t) : 0; }

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  note(path);
  return next<int(const char*, int, ...)>("open")(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  note(path);
  return next<int(const char*, int, ...)>("open64")(path, flags, mode);
}

std::FILE* fopen(const char* path, const char* mode) {
  note(path);
  return next<std::FILE*(const char*, const char*)>("fopen")(path, mode);
}

std::FILE* fopen64(const char* path, const char* mode) {
  note(path);
  return next<std::FILE*(const char*, const char*)>("fopen64")(path, mode);
}

std::size_t fwrite(const void* data, std::size_t size, std::size_t count, std::FILE* stream) {
  if (stream == stderr) note({static_cast<const char*>(data), size * count});
  return next<std::size_t(const void*, std::size_t, std::size_t, std::FILE*)>("fwrite")(data, size, count, stream);
}

}  // extern "C"
