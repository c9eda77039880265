// SPDX-License-Identifier: BSD-3-Clause
//
// Work in a child process that deliberately crashes, loops, exhausts memory or sends invalid data: the parent gets an
// error that names the file and keeps nothing of the child.
#include "process/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <thread>

#include "base/reading_process.hpp"
#include "io_support.hpp"

namespace tegl::test {
namespace {

using io_detail::BadPackage;
using io_detail::ChildLimits;
using io_detail::ChildProcess;
using io_detail::Package;
using io_detail::Packer;
using io_detail::ParentLink;
using io_detail::Unpacker;
using Clock = std::chrono::steady_clock;

const fs::path kFile = "/no/such/file.nc";

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

[[noreturn]] void loop() {
  for (std::atomic<unsigned> i = 0;;) ++i;
}

/// The error that results from `work` in a child.
Error error_of_child(const ChildProcess::Work& work, const ChildLimits& limits = {}) {
  return error_of([&] {
    ChildProcess child(kFile, work, limits);
    child.receive({});
  });
}

void expect_damaged(const Error& error, const std::string& reason) {
  EXPECT_EQ(error.code(), ErrorCode::MalformedFile);
  EXPECT_THAT(error.what(), testing::HasSubstr(kFile.string() + ": is damaged: reading it " + reason));
}

bool has_children() { return waitpid(-1, nullptr, WNOHANG) >= 0; }

TEST(ChildProcess, SendsNumbersTextsAndArraysOfAllSizes) {
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{3}, std::size_t{20000}, std::size_t{1} << 18, std::size_t{3} << 18}) {
    io_detail::ValueVector<double> values(size);
    Buffer<double> buffer(size);
    for (std::size_t i = 0; i < size; ++i) values[i] = buffer[i] = 0.5 + static_cast<double>(i);
    ChildProcess child(kFile, [&](const ParentLink& parent) {
      const io_detail::ValueVector<double> own = values;  // in the memory of the child
      const Buffer<double> own_buffer = buffer;
      Packer packer;
      packer.number(std::uint16_t{7});
      packer.text("text");
      packer.array(own);
      packer.array(own_buffer);
      packer.array(values);  // in the memory of the parent: copied
      parent.send(packer);
    });
    Package package = child.receive({});
    child.end();
    Unpacker unpacker(package);
    EXPECT_EQ(unpacker.number<std::uint16_t>(), 7);
    EXPECT_EQ(unpacker.text(), "text");
    io_detail::ValueVector<double> received;
    unpacker.array(received);
    EXPECT_EQ(received, values);
    Buffer<double> received_buffer;
    unpacker.array(received_buffer);
    EXPECT_EQ(received_buffer, buffer);
    unpacker.array(received);
    EXPECT_EQ(received, values);
    EXPECT_NO_THROW(unpacker.require_end());
    received.push_back(1);  // reallocates in other memory
    received_buffer.push_back(1);
    EXPECT_EQ(received.back() + received_buffer.back(), 2);
  }
}

TEST(ChildProcess, LargeArraysAreNotCopied) {
  constexpr std::size_t kCount = std::size_t{1} << 23;  // 64 MiB
  ChildProcess child(kFile,
                     [](const ParentLink& parent) {
                       const io_detail::ValueVector<double> values(kCount, 1.5);
                       Packer packer;
                       packer.array(values);
                       parent.send(packer);
                     },
                     {std::uint64_t{1} << 30});
  Package package = child.receive({});
  child.end();
  ASSERT_EQ(package.blocks.size(), 1U);
  const void* const block = package.blocks[0].data();
  Unpacker unpacker(package);
  io_detail::ValueVector<double> values;
  unpacker.array(values);
  EXPECT_EQ(static_cast<const void*>(values.data()), static_cast<const unsigned char*>(block) + detail::kValuesOffset);
  EXPECT_EQ(values.back(), 1.5);
}

TEST(ChildProcess, PassesErrorsOn) {
  const std::string long_text(100000, 'x');
  const Error error = error_of_child([&](const ParentLink&) { throw Error(ErrorCode::InvalidGrid, long_text); });
  EXPECT_EQ(error.code(), ErrorCode::InvalidGrid);
  EXPECT_EQ(error.what(), long_text);
  expect_damaged(error_of_child([](const ParentLink&) { throw 1; }), "ended without a result");
  EXPECT_EQ(error_of_child([](const ParentLink&) { throw std::runtime_error("x"); }).code(), ErrorCode::MalformedFile);
}

TEST(ChildProcess, CrashesAreDamagedFiles) {
  expect_damaged(error_of_child([](const ParentLink&) { std::raise(SIGSEGV); }),
                 "ended by signal 11 (Segmentation fault)");
  expect_damaged(error_of_child([](const ParentLink&) { std::abort(); }), "ended by signal 6 (Aborted)");
  expect_damaged(error_of_child([](const ParentLink&) { _exit(0); }), "ended without a result");
  const Error error = error_of_child([](const ParentLink&) {
    io_detail::now_reading("/of/a/series.dcm");
    std::raise(SIGBUS);
  });
  EXPECT_THAT(error.what(), testing::StartsWith("/of/a/series.dcm: is damaged"));
}

TEST(ChildProcess, LoopsEnd) {
  const auto start = Clock::now();
  expect_damaged(error_of_child([](const ParentLink&) { loop(); }, {.seconds = 0.3}),
                 "took more than 0.3 s of processor time without progress");
  EXPECT_LT(seconds_since(start), 20);  // allows for a busy machine
}

TEST(ChildProcess, WaitingAndProgressAreNoLoop) {
  ChildProcess child(kFile,
                     [](const ParentLink& parent) {
                       std::this_thread::sleep_for(std::chrono::milliseconds(500));
                       const Progress progress = parent.progress();
                       const clock_t begin = clock();
                       for (double share = 0; clock() - begin < CLOCKS_PER_SEC; share += 1e-9)
                         progress(std::min(1.0, share));
                       parent.send({});
                     },
                     {.seconds = 0.4});
  std::size_t calls = 0;
  EXPECT_NO_THROW(child.receive([&](double share) {
    EXPECT_GE(share, 0);
    EXPECT_LE(share, 1);
    return ++calls > 0;
  }));
  EXPECT_GT(calls, 5U);
}

TEST(ChildProcess, MemoryIsLimited) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers take memory of their own";
#endif
  const auto take = [](const ParentLink& parent) {
    std::vector<std::vector<char>> blocks;
    for (int i = 0; i < 400; ++i) blocks.emplace_back(std::size_t{1} << 20, 'x');
    parent.send({});
  };
  expect_damaged(error_of_child(take), "needed more than 64 MiB of memory");
  const auto take_large = [](const ParentLink& parent) {
    const io_detail::ValueVector<double> values(std::size_t{1} << 26);
    parent.send({});
  };
  expect_damaged(error_of_child(take_large), "needed more than 64 MiB of memory");
  ChildProcess child(kFile, [&](const ParentLink& parent) {
    io_detail::expect_memory(std::uint64_t{1} << 29);
    take(parent);
  });
  EXPECT_NO_THROW(child.receive({}));
}

TEST(ChildProcess, KilledFromOutsideIsDamaged) {
  ChildProcess child(kFile, [](const ParentLink&) { loop(); });
  std::thread killer([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    kill(child.pid(), SIGKILL);
  });
  expect_damaged(error_of([&] { child.receive({}); }), "ended by signal 9 (Killed)");
  killer.join();
}

TEST(ChildProcess, CancellingEndsIt) {
  pid_t pid = -1;
  const Error error = error_of([&] {
    ChildProcess child(kFile, [](const ParentLink&) { loop(); });
    pid = child.pid();
    int calls = 0;
    child.receive([&](double) { return ++calls < 3; });
  });
  EXPECT_EQ(error.code(), ErrorCode::Cancelled);
  EXPECT_THAT(error.what(), testing::HasSubstr(kFile.string()));
  EXPECT_EQ(kill(pid, 0), -1);
  EXPECT_EQ(errno, ESRCH);
}

/// Sends the bytes to all open descriptors of the child; the connection is among them.
void send_to_all(const std::string& bytes) {
  for (int descriptor = 3; descriptor < 200; ++descriptor) send(descriptor, bytes.data(), bytes.size(), MSG_NOSIGNAL);
}

TEST(ChildProcess, NonsenseIsNotBelieved) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 50; ++round) {
    std::string bytes(1 + random() % 300, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    if (round % 2 == 0 && bytes.size() > 16) bytes.replace(0, 6, std::string("TEGL\x01\x00", 6));
    if (round % 2 == 0 && bytes.size() > 16)
      bytes.replace(6, 2, std::string(1, static_cast<char>(round / 2 % 9)) + '\0');
    if (round % 2 == 0 && bytes.size() > 16) bytes.replace(8, 8, std::string(8, '\0'));
    const Error error = error_of([&] {
      ChildProcess child(kFile, [&](const ParentLink&) { send_to_all(bytes); });
      Package package = child.receive({});
      throw Error(ErrorCode::MalformedFile, "random bytes as a result: for the reader of the package");
    });
    EXPECT_NE(error.code(), ErrorCode::Cancelled) << round;
  }
  EXPECT_FALSE(has_children());
}

TEST(ChildProcess, PackagesOfRandomBytesAreRefused) {
  std::mt19937_64 random(2);
  std::size_t refused = 0;
  for (int round = 0; round < 20000; ++round) {
    Package package;
    package.small.resize(random() % 64);
    for (unsigned char& byte : package.small) byte = static_cast<unsigned char>(random() % 5 == 0 ? random() : 0);
    try {
      Unpacker unpacker(package);
      unpacker.text();
      io_detail::ValueVector<float> values;
      unpacker.array(values);
      Buffer<double> buffer;
      unpacker.array(buffer);
      unpacker.require_end();
    } catch (const BadPackage&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 15000U);
}

TEST(ChildProcess, HasNothingOfItsParentsButFilesThatAreRead) {
  std::array<int, 2> pipe_ends{};
  ASSERT_EQ(pipe(pipe_ends.data()), 0);
  std::signal(SIGUSR1, [](int) { std::printf("handler\n"); });
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  std::printf("buffered ");
  ChildProcess child(kFile, [](const ParentLink& parent) {
    std::printf("printed by the child\n");
    std::fflush(stdout);
    std::fprintf(stderr, "printed by the child\n");
    struct sigaction action {};
    sigaction(SIGUSR1, nullptr, &action);
    rlimit core{1, 1};
    getrlimit(RLIMIT_CORE, &core);
    std::raise(SIGINT);
    std::raise(SIGTERM);
    Packer packer;
    packer.number(action.sa_handler == SIG_DFL);
    packer.number(core.rlim_cur == 0 && prctl(PR_GET_DUMPABLE) == 0);
    parent.send(packer);
    loop();
  });
  Package package = child.receive({});
  close(pipe_ends[1]);
  pollfd end{pipe_ends[0], POLLIN, 0};
  EXPECT_EQ(poll(&end, 1, 5000), 1) << "the child keeps the pipe open";
  close(pipe_ends[0]);
  Unpacker unpacker(package);
  EXPECT_TRUE(unpacker.number<bool>()) << "a handler of the parent";
  EXPECT_TRUE(unpacker.number<bool>()) << "a core file";
  std::signal(SIGUSR1, SIG_DFL);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "buffered ");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(ChildProcess, EndsWithItsParent) {
  ASSERT_EQ(prctl(PR_SET_CHILD_SUBREAPER, 1), 0);
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  const pid_t middle = fork();
  if (middle == 0) {
    ChildProcess child(kFile, [](const ParentLink&) { loop(); });
    const pid_t pid = child.pid();
    (void)!write(ends[1], &pid, sizeof(pid));
    for (;;) pause();
  }
  pid_t orphan = -1;
  ASSERT_EQ(read(ends[0], &orphan, sizeof(orphan)), static_cast<ssize_t>(sizeof(orphan)));
  kill(middle, SIGKILL);
  waitpid(middle, nullptr, 0);
  const auto start = Clock::now();
  pid_t ended = 0;
  while (ended == 0 && seconds_since(start) < 60) {
    ended = waitpid(orphan, nullptr, WNOHANG);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_EQ(ended, orphan);
  prctl(PR_SET_CHILD_SUBREAPER, 0);
  for (const int end : ends) close(end);
}

TEST(ChildProcess, LeavesNeitherZombiesNorDescriptors) {
  const std::size_t before = open_descriptors();
  for (int i = 0; i < 300; ++i) {
    ChildProcess child(kFile, [&](const ParentLink& parent) {
      if (i % 3 == 0) std::raise(SIGSEGV);
      if (i % 3 == 1) throw Error(ErrorCode::InvalidGrid, "");
      parent.send({});
    });
    if (i % 3 == 2)
      child.receive({});
    else
      EXPECT_THROW(child.receive({}), Error);
  }
  EXPECT_EQ(open_descriptors(), before);
  EXPECT_FALSE(has_children());
}

TEST(ChildProcess, StartsWhileOtherThreadsAllocateAndThrow) {
  std::atomic<bool> done = false;
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&] {
      while (!done) {
        try {
          const std::vector<std::string> texts(100, std::string(50, 'x'));
          std::ifstream file("/proc/self/stat");
          throw Error(ErrorCode::InvalidGrid, texts[1]);
        } catch (const Error&) {
        }
      }
    });
  for (int i = 0; i < 100; ++i) {
    ChildProcess child(kFile, [](const ParentLink& parent) {
      try {
        std::ifstream file("/proc/self/stat");
        const std::vector<std::string> texts(1000, std::string(100, 'y'));
        throw Error(ErrorCode::InvalidGrid, texts[1]);
      } catch (const Error&) {
      }
      parent.send({});
    });
    EXPECT_NO_THROW(child.receive({}));
  }
  done = true;
  for (std::thread& thread : threads) thread.join();
}

}  // namespace
}  // namespace tegl::test
