// SPDX-License-Identifier: BSD-3-Clause
//
// Reads the header and the arrays of VTK's XML files. Arrays are text, bytes or base64, in the element or appended
// after all elements. Bytes follow their number, or are compressed in blocks, which follow the blocks' sizes.
#include "vtk/vtk_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include <zlib.h>

#include "base/common.hpp"
#include "base/inflate.hpp"
#include "base/raw_image.hpp"
#include "base/sample_reader.hpp"
#include "base/sample_values.hpp"
#include "vtk/encoded_bytes.hpp"
#include "vtk/markup_filter.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 10> kTypes = {{{"UInt8", "uint8"},
                                                                                   {"Int8", "int8"},
                                                                                   {"UInt16", "uint16"},
                                                                                   {"Int16", "int16"},
                                                                                   {"UInt32", "uint32"},
                                                                                   {"Int32", "int32"},
                                                                                   {"UInt64", "uint64"},
                                                                                   {"Int64", "int64"},
                                                                                   {"Float32", "float"},
                                                                                   {"Float64", "double"}}};

/// "array 'p'", for messages. Long names of VTK's own arrays are shown as a whole.
std::string named(const VtkArray& array) {
  for (const std::string_view known : {"face_connectivity", "polyhedron_to_faces", "polyhedron_offsets"})
    if (array.name == known) return fmt::format("array '{}'", known);
  return fmt::format("array {}", shown(array.name));
}

/// The place after the '_' with which appended data starts.
std::uint64_t appended_begin(const fs::path& path, std::uint64_t after_tag) {
  constexpr std::size_t kMostBlanks = 4096;
  const auto bytes = read_bytes(path, after_tag, kMostBlanks);
  const auto first = std::find_if(bytes.begin(), bytes.end(), [](unsigned char c) { return c > ' '; });
  if (first == bytes.end() || *first != '_')
    fail(ErrorCode::MalformedFile, path, "appended data starts with {}; expected '_'",
         first == bytes.end() ? "blanks" : shown(std::span(&*first, 1)));
  return after_tag + static_cast<std::uint64_t>(first - bytes.begin()) + 1;
}

/// A choice of two values of an attribute; throws for another one.
bool is_second(const XmlElement& element, std::string_view key, std::string_view first, std::string_view second,
               const fs::path& path) {
  const std::string_view value = element.attribute(key);
  if (value != first && value != second)
    fail(ErrorCode::MalformedFile, path, "<{}> has {}={}; expected {} or {}", element.name, key, shown(value), first,
         second);
  return value == second;
}

}  // namespace

struct VtkFile::Place {
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
  bool is_text = false;
  bool is_base64 = false;
};

VtkFile::VtkFile(const fs::path& path, const Progress& progress) : path_(path), file_size_(size_of_file(path)) {
  xml_ = parse_xml(path, "AppendedData", progress);
  const XmlElement& root = xml_.root;
  if (root.name != "VTKFile")
    fail(ErrorCode::MalformedFile, path, "an XML file of <{}>; expected <VTKFile>", shown(root.name));
  type_ = std::string(root.attribute("type"));
  // byte order, width of headers, compressor
  constexpr bool kBig = std::endian::native == std::endian::big;
  if (root.attributes.contains("byte_order"))
    swapped_ = is_second(root, "byte_order", "LittleEndian", "BigEndian", path) != kBig;
  if (root.attributes.contains("header_type"))
    header_bytes_ = is_second(root, "header_type", "UInt32", "UInt64", path) ? 8 : 4;
  const std::string_view compressor = root.attribute("compressor");
  compressed_ = compressor == "vtkZLibDataCompressor";
  if (!compressor.empty() && !compressed_)
    fail(ErrorCode::UnsupportedFormat, path, "compressed by {}; expected vtkZLibDataCompressor, or no compression",
         shown(compressor == "vtkLZ4DataCompressor"    ? "LZ4"
               : compressor == "vtkLZMADataCompressor" ? "LZMA"
                                                       : compressor));
  // data
  constexpr std::array<std::string_view, 5> kParallel = {"PImageData", "PRectilinearGrid", "PStructuredGrid",
                                                         "PUnstructuredGrid", "PPolyData"};
  const bool is_parallel = std::find(kParallel.begin(), kParallel.end(), type_) != kParallel.end();
  if (is_parallel || type_.starts_with("vtk"))
    fail(ErrorCode::UnsupportedFormat, path,
         "holds {}, which names other files with the data; expected a file with data, such as one of the pieces",
         is_parallel ? fmt::format("'{}'", type_) : shown(type_));
  data_ = root.child(type_);
  if (data_ == nullptr)
    fail(ErrorCode::MalformedFile, path, "<VTKFile> of type {} without an element of this name", shown(type_));
  if (const XmlElement* const appended = root.child("AppendedData"); appended != nullptr) {
    appended_base64_ = is_second(*appended, "encoding", "raw", "base64", path);
    appended_ = appended_begin(path, xml_.end);
  }
}

std::string VtkFile::remark_on_extension() const {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kExtensions = {
      {{".vti", "ImageData"}, {".vtr", "RectilinearGrid"}, {".vts", "StructuredGrid"}, {".vtu", "UnstructuredGrid"}}};
  const std::string name = lower_name(path_);
  const auto own = std::find_if(kExtensions.begin(), kExtensions.end(),
                                [&](const auto& extension) { return name.ends_with(extension.first); });
  const auto of_type = std::find_if(kExtensions.begin(), kExtensions.end(),
                                    [&](const auto& extension) { return extension.second == type_; });
  if (own == kExtensions.end() || of_type == kExtensions.end() || own == of_type) return {};
  return fmt::format("{} holds {}, whose extension is {}; {} is for {}", path_.string(), type_, of_type->first,
                     own->first, own->second);
}

std::vector<const XmlElement*> VtkFile::pieces() const {
  std::vector<const XmlElement*> found;
  for (const XmlElement& child : data_->children)
    if (child.name == "Piece") found.push_back(&child);
  if (found.empty()) fail(ErrorCode::MalformedFile, path_, "<{}> without a <Piece>; expected at least one", type_);
  return found;
}

std::vector<VtkArray> VtkFile::arrays(const XmlElement* parent) const {
  std::vector<VtkArray> found;
  if (parent == nullptr) return found;
  for (const XmlElement& element : parent->children) {
    if (element.name != "DataArray") continue;
    const std::string_view type = element.attribute("type");
    if (type == "String" || type == "Bit") continue;
    VtkArray array{std::string(element.attribute("Name")), {}, 1, &element};
    for (const auto& [name, own] : kTypes)
      if (name == type) array.type = own;
    if (array.type.empty())
      fail(ErrorCode::MalformedFile, path_, "{} has the type {}; expected Int8 to UInt64, Float32 or Float64",
           named(array), shown(type));
    if (element.attributes.contains("NumberOfComponents"))
      array.components = std::max<std::uint64_t>(1, whole_number(element, "NumberOfComponents"));
    found.push_back(std::move(array));
  }
  return found;
}

VtkArray VtkFile::array(const XmlElement& piece, std::string_view parent, std::string_view name) const {
  std::vector<VtkArray> all = arrays(piece.child(parent));
  for (VtkArray& array : all)
    if (array.name == name || (name.empty() && all.size() == 1)) return std::move(array);
  fail(ErrorCode::MalformedFile, path_, "a piece with {} arrays in <{}>{}; expected {}", all.size(), parent,
       name.empty() ? "" : fmt::format(", none named '{}'", name), name.empty() ? "one" : fmt::format("'{}'", name));
}

VtkFile::Place VtkFile::place_of(const VtkArray& array) const {
  const XmlElement& element = *array.element;
  const std::string_view format = element.attribute("format");
  if (format == "ascii" || format == "binary" || format.empty())
    return {element.text_begin, element.text_end, format != "binary", format == "binary"};
  if (format != "appended")
    fail(ErrorCode::MalformedFile, path_, "{} has the format {}; expected ascii, binary or appended", named(array),
         shown(format));
  const std::uint64_t offset = whole_number(element, "offset");
  if (appended_ == 0) fail(ErrorCode::MalformedFile, path_, "{} is appended; expected <AppendedData>", named(array));
  if (offset >= file_size_ - appended_)
    fail(ErrorCode::MalformedFile, path_, "{} has the offset {}, behind the end of the file; expected less than {}",
         named(array), offset, file_size_ - appended_);
  return {appended_ + offset, file_size_, false, appended_base64_};
}

std::uint64_t VtkFile::header_number(EncodedBytes& bytes, const VtkArray& array, const char* what) const {
  std::array<unsigned char, 8> read{};
  const auto part = std::span(read).first(static_cast<std::size_t>(header_bytes_));
  if (bytes.read(part) < part.size()) fail(ErrorCode::MalformedFile, path_, "{} ends before {}", named(array), what);
  if (swapped_) std::reverse(part.begin(), part.end());
  if (header_bytes_ == 8) return std::bit_cast<std::uint64_t>(read);
  std::uint32_t number = 0;
  std::memcpy(&number, read.data(), sizeof(number));
  return number;
}

std::uint64_t VtkFile::inflate_blocks(EncodedBytes& bytes, const VtkArray& array, std::optional<std::uint64_t> count,
                                      std::uint64_t item, std::vector<unsigned char>& to,
                                      const Progress& progress) const {
  // sizes
  const std::uint64_t blocks = header_number(bytes, array, "the number of its blocks");
  const std::uint64_t size = header_number(bytes, array, "the size of its blocks");
  const std::uint64_t last = header_number(bytes, array, "the size of its last block");
  if (blocks > bytes.at_most() / header_bytes_ || last > size || (blocks > 0 && size == 0))
    fail(ErrorCode::MalformedFile, path_, "{} has {} compressed blocks of {} bytes, the last of {}, in {} bytes",
         named(array), blocks, size, last, bytes.at_most());
  std::vector<std::uint64_t> stored;
  std::uint64_t sum = 0;
  for (std::uint64_t b = 0; b < blocks; ++b) {
    stored.push_back(header_number(bytes, array, "the sizes of its blocks"));
    if (stored.back() > bytes.at_most() || (sum += stored.back()) > bytes.at_most())
      fail(ErrorCode::MalformedFile, path_, "{} has compressed blocks of {} bytes or more; the file has {}",
           named(array), std::max(sum, stored.back()), bytes.at_most());
  }
  checked_bytes(std::array{blocks, size}, 1, path_);
  if (blocks > 1 && size > (sum + 1) * kMostInflation)
    fail(ErrorCode::MalformedFile, path_, "{} has blocks of {} bytes, compressed to {}; expected at most {}",
         named(array), size, sum, (sum + 1) * kMostInflation);
  const std::uint64_t total = blocks == 0 ? 0 : (blocks - 1) * size + (last > 0 ? last : size);
  if (total % item != 0 || (count && total != *count * item) || total > (sum + 1) * kMostInflation)
    fail(ErrorCode::MalformedFile, path_, "{} has {} bytes, compressed to {}; expected {}", named(array), total, sum,
         count ? fmt::format("{}", *count * item) : fmt::format("a multiple of {}", item));
  // blocks
  std::vector<unsigned char> compressed;
  for (std::uint64_t b = 0; b < blocks; ++b) {
    compressed.resize(static_cast<std::size_t>(stored[b]));
    if (bytes.read(compressed) < compressed.size())
      fail(ErrorCode::MalformedFile, path_, "{} ends within compressed block {} of {}", named(array), b, blocks);
    const std::uint64_t expected = b + 1 == blocks && last > 0 ? last : size;
    const std::size_t before = to.size();
    to.resize(before + static_cast<std::size_t>(expected));
    uLongf found = expected;
    const int status = uncompress(to.data() + before, &found, compressed.data(), compressed.size());
    if (status != Z_OK || found != expected)
      fail(ErrorCode::MalformedFile, path_, "{}: compressed block {} of {} is damaged; expected {} bytes in it",
           named(array), b, blocks, expected);
    tick(progress, static_cast<double>(b) / static_cast<double>(blocks), path_);
  }
  return sum;
}

void VtkFile::require_end(EncodedBytes& bytes, const VtkArray& array, std::uint64_t length) const {
  std::array<unsigned char, 4096> block{};
  std::uint64_t more = 0;
  for (std::size_t found = bytes.read(block); found > 0; found = bytes.read(block)) more += found;
  if (more == 0) return;
  fail(ErrorCode::MalformedFile, path_, "{} has {} bytes by its header, and {} in base64; expected equal numbers{}",
       named(array), length, length + more,
       header_bytes_ == 4 ? ", or header_type=\"UInt64\" in <VTKFile> for headers of 8 bytes" : "");
}

template <class T>
void VtkFile::read_bytes_of(const VtkArray& array, std::optional<std::uint64_t> count, ValueVector<T>& to,
                            const Progress& progress) const {
  const Place place = place_of(array);
  EncodedBytes bytes(path_, place.begin, place.end, place.is_base64);
  std::vector<unsigned char> read;
  const bool is_alone = place.is_base64 && place.end == array.element->text_end;  // no other array follows
  if (compressed_) {
    const std::uint64_t stored = inflate_blocks(bytes, array, count, sizeof(T), read, progress);
    if (is_alone) require_end(bytes, array, stored);
    to.resize(read.size() / sizeof(T));
    if (!read.empty()) std::memcpy(to.data(), read.data(), read.size());
  } else {
    const std::uint64_t size = header_number(bytes, array, "the number of its bytes");
    if (size > bytes.at_most() || size % sizeof(T) != 0 || (count && size != *count * sizeof(T)))
      fail(ErrorCode::MalformedFile, path_, "{} has {} bytes; expected {}, and the file has {}", named(array), size,
           count ? fmt::format("{}", *count * sizeof(T)) : fmt::format("a multiple of {}", sizeof(T)), bytes.at_most());
    to.resize(static_cast<std::size_t>(size / sizeof(T)));
    const std::span<unsigned char> all(reinterpret_cast<unsigned char*>(to.data()), static_cast<std::size_t>(size));
    constexpr std::size_t kBlock = std::size_t{1} << 20;
    for (std::size_t at = 0; at < all.size(); at += kBlock) {
      const auto part = all.subspan(at, std::min(kBlock, all.size() - at));
      if (bytes.read(part) < part.size())
        fail(ErrorCode::MalformedFile, path_, "{} ends before its {} bytes", named(array), size);
      tick(progress, static_cast<double>(at) / static_cast<double>(all.size()), path_);
    }
    if (is_alone) require_end(bytes, array, size);
  }
  if (swapped_) swap_bytes(std::span<T>(to));
}

template <class T>
void VtkFile::read_text(const VtkArray& array, std::optional<std::uint64_t> count, ValueVector<T>& to,
                        const Progress& progress) const {
  const Place place = place_of(array);
  EncodedBytes bytes(path_, place.begin, place.end, false);
  // Each number but the last takes two characters or more.
  if (count) to.reserve(static_cast<std::size_t>(std::min(*count, bytes.at_most() / 2 + 1)));
  std::array<unsigned char, 4096> block{};
  std::string word;
  MarkupFilter markup;
  const auto end_word = [&] {
    if (word.empty()) return;
    T value{};
    if (!parse_sample(std::string_view(word), value))
      fail(ErrorCode::MalformedFile, path_, "number {} of {} is {}; expected {}", to.size(), named(array), shown(word),
           expected_numbers<T>(array.type));
    to.push_back(value);
    word.clear();
  };
  constexpr std::size_t kLongest = 1000;
  const auto add = [&](char c) {
    if (c == ' ' || (c >= '\t' && c <= '\r'))
      end_word();
    else if (word.size() < kLongest)
      word += c;
    else
      fail(ErrorCode::MalformedFile, path_, "number {} of {} has more than {} characters: {}...; expected {}",
           to.size(), named(array), kLongest, shown(word), expected_numbers<T>(array.type));
  };
  const std::uint64_t all = bytes.at_most();
  for (std::size_t found = bytes.read(block); found > 0; found = bytes.read(block)) {
    tick(progress, 1.0 - static_cast<double>(bytes.at_most()) / static_cast<double>(all), path_);
    for (const unsigned char c : std::span(block).first(found))
      if (markup.concerns(static_cast<char>(c)))
        for (const char text : markup.text_of(static_cast<char>(c))) add(text);
      else
        add(static_cast<char>(c));
  }
  end_word();
  if (count && to.size() != *count)
    fail(ErrorCode::MalformedFile, path_, "{} has {} numbers; expected {}", named(array), to.size(), *count);
}

ValueArray VtkFile::read(const VtkArray& array, std::optional<std::uint64_t> count, const Progress& progress) const {
  if (count) checked_bytes(std::array{*count}, sizeof(double), path_);
  ValueArray values = array_of_type(array.type);
  if (count && *count == 0) return values;
  const bool is_text = place_of(array).is_text;
  try {
    std::visit(
        [&](auto& to) { is_text ? read_text(array, count, to, progress) : read_bytes_of(array, count, to, progress); },
        values);
  } catch (const std::bad_alloc&) {
    fail(ErrorCode::TooLarge, path_, "{} does not fit into memory", named(array));
  }
  return values;
}

std::vector<double> VtkFile::read_doubles(const VtkArray& array, std::uint64_t count) const {
  const ValueArray values = read(array, count);
  return std::visit([](const auto& all) { return std::vector<double>(all.begin(), all.end()); }, values);
}

std::vector<std::int64_t> VtkFile::read_integers(const VtkArray& array, std::optional<std::uint64_t> count) const {
  const ValueArray values = read(array, count);
  return std::visit(
      [&]<class T>(const ValueVector<T>& all) {
        if constexpr (std::is_floating_point_v<T>)
          fail(ErrorCode::MalformedFile, path_, "{} has the type {}; expected whole numbers", named(array), array.type);
        std::vector<std::int64_t> result(all.size());
        std::transform(all.begin(), all.end(), result.begin(), [](T x) { return static_cast<std::int64_t>(x); });
        return result;
      },
      values);
}

std::optional<std::uint64_t> VtkFile::place_of_raw(const VtkArray& array, std::uint64_t count) const {
  const Place place = place_of(array);
  if (place.is_text || place.is_base64 || compressed_) return std::nullopt;
  EncodedBytes bytes(path_, place.begin, place.end, false);
  const std::uint64_t size = header_number(bytes, array, "the number of its bytes");
  const std::uint64_t expected = checked_bytes(std::array{count}, bytes_of_type(array.type), path_);
  if (size != expected || size > bytes.at_most())
    fail(ErrorCode::MalformedFile, path_, "{} has {} bytes; expected {}, and the file has {}", named(array), size,
         expected, bytes.at_most());
  return place.begin + header_bytes_;
}

std::optional<double> VtkFile::time() const {
  for (const VtkArray& array : arrays(data_->child("FieldData")))
    if (array.name == "TimeValue") {
      const double value = read_doubles(array, 1).front();
      if (!std::isfinite(value))
        fail(ErrorCode::MalformedFile, path_, "{} is {}; expected a finite number", named(array), value);
      return value;
    }
  return std::nullopt;
}

std::vector<double> VtkFile::numbers(const XmlElement& element, std::string_view key, std::size_t count,
                                     std::vector<double> missing) const {
  if (!element.attributes.contains(key)) return missing;
  std::vector<double> result;
  for (const std::string_view word : words(element.attribute(key))) {
    double number = 0;
    if (!parse_number(word, number) || !std::isfinite(number))
      fail(ErrorCode::MalformedFile, path_, "<{}> has {} with {}; expected finite numbers", element.name, key,
           shown(word));
    result.push_back(number);
  }
  if (result.size() != count)
    fail(ErrorCode::MalformedFile, path_, "<{}> has {} of {} numbers; expected {}", element.name, key, result.size(),
         count);
  return result;
}

std::uint64_t VtkFile::whole_number(const XmlElement& element, std::string_view key) const {
  std::uint64_t number = 0;
  const std::string_view text = trim(element.attribute(key));
  if (!parse_number(text, number))
    fail(ErrorCode::MalformedFile, path_, "<{}> has {}={}; expected a whole number of at least 0", element.name, key,
         shown(text));
  return number;
}

}  // namespace tegl::io_detail
