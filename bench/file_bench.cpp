// SPDX-License-Identifier: BSD-3-Clause
//
// Rates of reading images and writing meshes, beside the rates of the system for the same bytes.
//
//   file_bench [--runs N] [--samples N] [--write FOLDER]... [IMAGE[=DATA]...]
//
// `--write`: writes the contour of a gyroid of N^3 samples to FOLDER in each binary format, and then the bytes of each
// file by plain calls of write(2). IMAGE: read by read_image, and then by plain reads of the whole file into fresh
// memory or, if it is gzipped, by `gzip -dc`; DATA: the file with the bytes, if that is another one. One thread; CPU
// times (user and system, of child processes too), the minimum of `--runs`. Bytes are the bytes of the file, or of the
// decompressed samples.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "arguments.hpp"
#include "fields.hpp"
#include "image_file.hpp"
#include "tegl/extract.hpp"
#include "tegl/io.hpp"
#include "timing.hpp"
#include "usage.hpp"

namespace tegl::bench {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  int runs = 5;
  std::size_t samples = 256;
  std::vector<fs::path> folders;
  std::vector<std::string> images;
};

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// CPU seconds of this process and of its children that have ended: some files are read by a child process.
double used_seconds() {
  double all = 0.0;
  for (const auto who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    getrusage(who, &usage);
    all += seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
  }
  return all;
}

/// The minimum CPU seconds over several runs.
template <class Work>
double least_used(int runs, const Work& work) {
  return least_seconds_by(used_seconds, work, runs);
}

[[noreturn]] void fail(ErrorCode code, const fs::path& path, const char* step) {
  throw Error(code, fmt::format("{}: cannot be {} ({})", path.string(), step, std::strerror(errno)));
}

constexpr std::size_t kBlock = std::size_t{1} << 20;

std::vector<char> bytes_of(const fs::path& path) {
  std::vector<char> bytes(static_cast<std::size_t>(fs::file_size(path)));
  std::ifstream file(path, std::ios::binary);
  if (!file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) fail(ErrorCode::FileNotFound, path, "read");
  return bytes;
}

void write_plainly(const std::vector<char>& bytes, const fs::path& path) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) fail(ErrorCode::WriteFailed, path, "created");
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t count = write(file, bytes.data() + at, std::min(kBlock, bytes.size() - at));
    if (count < 0) fail(ErrorCode::WriteFailed, path, "written");
    at += static_cast<std::size_t>(count);
  }
  if (close(file) != 0) fail(ErrorCode::WriteFailed, path, "written");
}

void read_plainly(const fs::path& path) {
  const auto size = static_cast<std::size_t>(fs::file_size(path));
  const std::unique_ptr<char[]> bytes(new char[size]);
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) fail(ErrorCode::FileNotFound, path, "opened");
  for (std::size_t at = 0; at < size;) {
    const ssize_t count = read(file, bytes.get() + at, std::min(kBlock, size - at));
    if (count <= 0) fail(ErrorCode::FileNotFound, path, "read");
    at += static_cast<std::size_t>(count);
  }
  close(file);
}

void decompress_plainly(const fs::path& path) {
  const pid_t child = fork();
  if (child < 0) fail(ErrorCode::FileNotFound, path, "decompressed");
  if (child == 0) {
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    execlp("gzip", "gzip", "-dc", path.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (status != 0) throw Error(ErrorCode::MalformedFile, path.string() + ": gzip -dc failed");
}

void print_row(const std::string& name, double bytes, double seconds, double plain) {
  fmt::print("| {} | {:.0f} | {:.3f} | {:.2f} | {:.2f} | {:.0f} % |\n", name, 1e-6 * bytes, seconds,
             1e-9 * bytes / seconds, 1e-9 * bytes / plain, 100.0 * plain / seconds);
  std::fflush(stdout);
}

constexpr const char* kHeader = "| {} | MB | CPU s | GB/s | plain, GB/s | of it |\n|---|---|---|---|---|---|\n";

template <class Real>
void measure_writers(const Contour<3, Real>& contour, const char* real, const fs::path& folder, int runs) {
  for (const char* const extension : {".ply", ".stl", ".vtkhdf"}) {
    const fs::path path = folder / (std::string("tegl_file_bench") + extension);
    const double seconds = least_used(runs, [&] {
      fs::remove(path);
      write_mesh(contour, path);
    });
    const std::vector<char> bytes = bytes_of(path);
    const double plain = least_used(runs, [&] {
      fs::remove(path);
      write_plainly(bytes, path);
    });
    fs::remove(path);
    print_row(fmt::format("`{}`, {}", extension, real), static_cast<double>(bytes.size()), seconds, plain);
  }
}

void measure_writers(const Arguments& arguments) {
  const auto image = make_field<3>("gyroid", arguments.samples);
  ExtractOptions options;
  options.work.threads = 1;
  const auto single = extract<float>(image.view(), 0.0, options);
  const auto full = extract<double>(image.view(), 0.0, options);
  for (const fs::path& folder : arguments.folders) {
    fmt::print("\n{} vertices, {} triangles, to {}\n\n", full.vertices.size(), full.simplices.size(), folder.string());
    fmt::print(fmt::runtime(kHeader), "written");
    measure_writers(full, "double", folder, arguments.runs);
    measure_writers(single, "float", folder, arguments.runs);
  }
}

bool is_gzipped(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return file.get() == 0x1f && file.get() == 0x8b;
}

/// `argument`: IMAGE or IMAGE=DATA.
void measure_reader(const std::string& argument, int runs) {
  const std::size_t mark = argument.find('=');
  const std::string name = argument.substr(0, mark);
  const std::string data = mark == std::string::npos ? name : argument.substr(mark + 1);
  double samples = 0.0;
  const double seconds = least_used(runs, [&] {
    with_image_of_file(name, [&](const std::string&, const auto& image) {
      samples = static_cast<double>(image.values.size() * sizeof(image.values[0]));
    });
  });
  const bool gzipped = is_gzipped(data);
  const double plain = least_used(runs, [&] { gzipped ? decompress_plainly(data) : read_plainly(data); });
  print_row(fs::path(name).filename().string(), gzipped ? samples : static_cast<double>(fs::file_size(data)), seconds,
            plain);
}

constexpr const char* kUsage = "file_bench [--runs N] [--samples N] [--write FOLDER]... [IMAGE[=DATA]...]";

int run(int argc, char** argv) {
  if (tells_usage(argc, argv, kUsage)) return 0;
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const bool more = i + 1 < argc;
    if (argument == "--runs" && more)
      arguments.runs = whole_number(argument, argv[++i], 1, 1000000);
    else if (argument == "--samples" && more)
      arguments.samples = whole_number<std::size_t>(argument, argv[++i], 2, 1024);
    else if (argument == "--write" && more)
      arguments.folders.emplace_back(argv[++i]);
    else if (argument.rfind("--", 0) == 0)
      throw Error(ErrorCode::InvalidArgument, fmt::format("'{}'; expected {}", argument, kUsage));
    else
      arguments.images.push_back(argument);
  }
  if (arguments.images.empty() && arguments.folders.empty()) {
    fmt::print(stderr, "usage: {}\n", kUsage);
    return 2;
  }
  if (!arguments.folders.empty()) measure_writers(arguments);
  if (!arguments.images.empty()) fmt::print(fmt::runtime(std::string("\n") + kHeader), "read");
  for (const std::string& name : arguments.images) measure_reader(name, arguments.runs);
  return 0;
}

}  // namespace
}  // namespace tegl::bench

int main(int argc, char** argv) { return tegl::bench::run_program("file_bench", argc, argv, tegl::bench::run); }
