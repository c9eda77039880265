// SPDX-License-Identifier: BSD-3-Clause
//
// Reads and writes index files of active tiles.
#include "tegl/io/active_tiles.hpp"

#include <cstdio>
#include <string>

#include "base/common.hpp"
#include "base/output_file.hpp"
#include "base/pending_path.hpp"

namespace tegl {

namespace fs = std::filesystem;

namespace {

class FileSink final : public ByteSink {
 public:
  explicit FileSink(const PendingPath& pending) : file_(pending) {}
  void write(const void* data, std::size_t bytes) override { file_.write(data, bytes); }
  void close() { file_.close(); }

 private:
  io_detail::OutputFile file_;
};

class FileSource final : public ByteSource {
 public:
  explicit FileSource(const fs::path& path) {
    io_detail::require_readable_file(path);
    file_.reset(std::fopen(path.c_str(), "rb"));
    if (!file_) io_detail::fail(ErrorCode::FileNotFound, path, "cannot be opened");
  }
  std::size_t read(void* data, std::size_t bytes) override { return std::fread(data, 1, bytes, file_.get()); }

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, CloseFile> file_;
};

/// Calls `work(source)` and adds the file's name to its errors.
template <class Work>
auto with_file(const fs::path& path, const Work& work) {
  FileSource source(path);
  try {
    return work(source);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::Cancelled) throw;
    throw Error(error.code(), path.string() + ": " + error.what());
  }
}

}  // namespace

template <int N>
requires DimensionBetween<N, 2, 5>
void write_active_tiles(const ActiveTiles<N>& active, const fs::path& path, const WorkOptions& work) {
  write_complete_file(path, [&](const PendingPath& file) {
    FileSink sink(file);
    active.save(sink, work);
    sink.close();
  });
}

template <Value T, int N>
requires DimensionBetween<N, 2, 5> std::unique_ptr<ActiveTiles<N>> read_active_tiles(const fs::path& path,
                                                                                     const Image<T, N>& image,
                                                                                     const WorkOptions& work) {
  return with_file(path, [&](ByteSource& source) { return load_active_tiles(source, image, work); });
}

ActiveTilesHead read_active_tiles_head(const fs::path& path) {
  return with_file(path, [](ByteSource& source) { return read_active_tiles_head(source); });
}

ActiveTilesHead check_active_tiles(const fs::path& path) {
  return with_file(path, [](ByteSource& source) { return check_active_tiles(source); });
}

#define TEGL_INSTANTIATE_ONE(T, N)                                                                      \
  template std::unique_ptr<ActiveTiles<N>> read_active_tiles<T, N>(const fs::path&, const Image<T, N>&, \
                                                                   const WorkOptions&);
#define TEGL_INSTANTIATE(N)                                                                        \
  template void write_active_tiles<N>(const ActiveTiles<N>&, const fs::path&, const WorkOptions&); \
  TEGL_INSTANTIATE_ONE(std::uint8_t, N)                                                            \
  TEGL_INSTANTIATE_ONE(std::int8_t, N)                                                             \
  TEGL_INSTANTIATE_ONE(std::uint16_t, N)                                                           \
  TEGL_INSTANTIATE_ONE(std::int16_t, N)                                                            \
  TEGL_INSTANTIATE_ONE(std::int32_t, N)                                                            \
  TEGL_INSTANTIATE_ONE(float, N)                                                                   \
  TEGL_INSTANTIATE_ONE(double, N)
TEGL_INSTANTIATE(2)
TEGL_INSTANTIATE(3)
TEGL_INSTANTIATE(4)
TEGL_INSTANTIATE(5)
#undef TEGL_INSTANTIATE
#undef TEGL_INSTANTIATE_ONE

}  // namespace tegl
