// SPDX-License-Identifier: BSD-3-Clause
//
// Implements the writer of VTU files: XML tags, then the arrays as raw or zlib-compressed bytes.
#include "meshes/vtu_writer.hpp"

#include <bit>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zlib.h>

#include "base/common.hpp"
#include "base/output_file.hpp"
#include "meshes/vtkhdf_names.hpp"

namespace tegl::io_detail {
namespace {

static_assert(std::endian::native == std::endian::little, "values are written as they are in memory");

constexpr std::size_t kBlock = std::size_t{1} << 16;  ///< items between two progress reports

std::uint64_t byte_count(const VtuArray& array) { return array.rows * array.columns * array.bytes; }

/// Calls `put` for all items of an array and reports progress; `done` of `all` bytes were written before.
void put_items(const VtuArray& array, ByteSink& sink, double done, double all, const Progress& progress,
               const std::filesystem::path& path) {
  for (std::size_t i = 0; i < array.items; ++i) {
    if (i % kBlock == 0) tick(progress, (done + static_cast<double>(sink.bytes())) / all, path);
    array.put(sink, i);
  }
  sink.flush();
}

/// An array in the format of vtkZLibDataCompressor: number of blocks, block size, size of a shorter last block, the
/// compressed sizes; then the blocks.
class CompressedArray {
 public:
  void add(const void* bytes, std::size_t count, const std::filesystem::path& path) {
    uLongf size = compressBound(count);
    const std::size_t before = bytes_.size();
    bytes_.resize(before + size);
    constexpr int kLevel = 4;
    if (compress2(bytes_.data() + before, &size, static_cast<const Bytef*>(bytes), count, kLevel) != Z_OK)
      fail(ErrorCode::WriteFailed, path, "compressing {} bytes failed", count);
    bytes_.resize(before + size);
    sizes_.push_back(size);
    last_ = count;
  }
  [[nodiscard]] std::vector<std::uint64_t> head() const {
    std::vector<std::uint64_t> head = {sizes_.size(), ByteSink::kBlock, last_ == ByteSink::kBlock ? 0 : last_};
    head.insert(head.end(), sizes_.begin(), sizes_.end());
    return head;
  }
  [[nodiscard]] std::uint64_t file_bytes() const { return (3 + sizes_.size()) * sizeof(std::uint64_t) + bytes_.size(); }
  void write(OutputFile& file) const {
    const std::vector<std::uint64_t> numbers = head();
    file.write(numbers.data(), numbers.size() * sizeof(std::uint64_t));
    file.write(bytes_.data(), bytes_.size());
  }

 private:
  std::vector<Bytef> bytes_;
  std::vector<std::uint64_t> sizes_;
  std::uint64_t last_ = 0;
};

/// The size of each array in the file, in order.
class FileSizes {
 public:
  explicit FileSizes(std::vector<std::uint64_t> sizes) : sizes_(std::move(sizes)) {}
  std::uint64_t next() { return sizes_.at(at_++); }

 private:
  std::vector<std::uint64_t> sizes_;
  std::size_t at_ = 0;
};

/// The XML tags of arrays; `offset` is increased by their sizes.
std::string array_tags(const std::vector<VtuArray>& arrays, FileSizes& sizes, std::uint64_t& offset) {
  std::string text;
  for (const VtuArray& array : arrays) {
    text += fmt::format(R"(<DataArray type="{}" Name="{}")", array.type, array.name);
    if (array.columns > 1) text += fmt::format(R"( NumberOfComponents="{}")", array.columns);
    text += fmt::format(R"( format="appended" offset="{}"/>)", offset) + "\n";
    offset += sizes.next();
  }
  return text;
}

/// The XML tag of texts: their bytes as numbers, each text followed by 0.
std::string text_tag(const char* name, const std::vector<std::string>& texts) {
  std::string text =
      fmt::format(R"(<DataArray type="String" Name="{}" NumberOfTuples="{}" format="ascii">)", name, texts.size());
  for (const std::string& one : texts) {
    for (const char c : one) text += fmt::format("{} ", static_cast<unsigned>(static_cast<unsigned char>(c)));
    text += "0 ";
  }
  return text + "</DataArray>\n";
}

/// The XML tag of numbers of the field data, in full precision; nothing if there are none.
std::string number_tag(const char* name, const std::vector<double>& numbers) {
  if (numbers.empty()) return {};
  return fmt::format(R"(<DataArray type="Float64" Name="{}" NumberOfTuples="{}" format="ascii">{}</DataArray>)", name,
                     numbers.size(), fmt::join(numbers, " ")) +
         "\n";
}

std::string header(const VtuGrid& grid, FileSizes sizes, Compression compression) {
  std::uint64_t offset = 0;
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\"{}>\n"
      "<UnstructuredGrid>\n<FieldData>\n",
      compression == Compression::none ? "" : " compressor=\"vtkZLibDataCompressor\"");
  text += text_tag("axis_names", grid.axis_names) + text_tag("axis_units", grid.axis_units);
  text += number_tag(kPeriods, grid.periods) + "</FieldData>\n";
  text += fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", grid.points, grid.cells);
  text += grid.normals.empty() ? "<PointData>\n" : fmt::format("<PointData Normals=\"{}\">\n", grid.normals);
  text += array_tags(grid.point_arrays, sizes, offset) + "</PointData>\n<CellData>\n";
  text += array_tags(grid.cell_arrays, sizes, offset) + "</CellData>\n<Points>\n";
  text += array_tags({grid.coordinates}, sizes, offset) + "</Points>\n<Cells>\n";
  text += array_tags(grid.topology, sizes, offset) + "</Cells>\n";
  return text + "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
}

}  // namespace

void write_vtu(const VtuGrid& grid, const PendingPath& pending, const WriteOptions& options) {
  const std::filesystem::path& path = pending.target();
  const Progress& progress = options.work.progress;
  // arrays in the order of the file
  std::vector<const VtuArray*> arrays;
  for (const VtuArray& array : grid.point_arrays) arrays.push_back(&array);
  for (const VtuArray& array : grid.cell_arrays) arrays.push_back(&array);
  arrays.push_back(&grid.coordinates);
  for (const VtuArray& array : grid.topology) arrays.push_back(&array);
  double all = 1.0, done = 0.0;
  for (const VtuArray* const array : arrays) all += static_cast<double>(byte_count(*array));
  const bool is_compressed = options.compression != Compression::none;
  // compress, or compute sizes
  std::vector<CompressedArray> compressed;
  std::vector<std::uint64_t> sizes;
  for (const VtuArray* const array : arrays) {
    if (is_compressed) {
      CompressedArray& own = compressed.emplace_back();
      ByteSink sink([&](const void* bytes, std::size_t count) { own.add(bytes, count, path); });
      put_items(*array, sink, done, all, progress, path);
      done += static_cast<double>(byte_count(*array));
    }
    sizes.push_back(is_compressed ? compressed.back().file_bytes() : sizeof(std::uint64_t) + byte_count(*array));
  }

  // write
  OutputFile file(pending);
  file.write(header(grid, FileSizes(std::move(sizes)), options.compression));
  for (const CompressedArray& array : compressed) array.write(file);
  for (const VtuArray* const array : arrays) {
    if (is_compressed) break;
    const std::uint64_t bytes = byte_count(*array);
    file.write(&bytes, sizeof bytes);
    ByteSink sink([&](const void* from, std::size_t count) { file.write(from, count); });
    put_items(*array, sink, done, all, progress, path);
    done += static_cast<double>(bytes);
  }
  file.write("\n</AppendedData>\n</VTKFile>\n");
  tick(progress, 1.0, path);
  file.close();
}

}  // namespace tegl::io_detail
