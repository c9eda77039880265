// SPDX-License-Identifier: BSD-3-Clause
//
// MetaImage files (.mha, and .mhd with the data beside). The header is read here for a check, before anything is
// allocated, that the data are all there, which MetaIO leaves to the user; ITK reads the values.
//
// Based on: S. Aylward, "MetaIO: Introduction and Documentation" (ITK wiki).
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "common.hpp"
#include "inflate.hpp"
#include "itk_values.hpp"
#include "readers.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

struct StoredType {
  std::string_view keyword;
  const char* name;
  unsigned bytes;
};

// MET_LONG is 4 bytes in the format's definition, and 8 in files that ITK wrote on 64-bit machines: ambiguous.
constexpr std::array<StoredType, 10> kTypes = {{{"MET_CHAR", "int8", 1},
                                                {"MET_UCHAR", "uint8", 1},
                                                {"MET_SHORT", "int16", 2},
                                                {"MET_USHORT", "uint16", 2},
                                                {"MET_INT", "int32", 4},
                                                {"MET_UINT", "uint32", 4},
                                                {"MET_LONG_LONG", "int64", 8},
                                                {"MET_ULONG_LONG", "uint64", 8},
                                                {"MET_FLOAT", "float", 4},
                                                {"MET_DOUBLE", "double", 8}}};

class Fields {
 public:
  Fields(const fs::path& path, std::map<std::string, std::string, std::less<>> values)
      : path_(path), values_(std::move(values)) {}

  [[nodiscard]] bool has(std::string_view name) const { return values_.contains(name); }
  [[nodiscard]] const std::string& text(std::string_view name) const {
    const auto found = values_.find(name);
    if (found == values_.end()) fail(ErrorCode::MalformedFile, path_, "header without the field '{}'", name);
    return found->second;
  }
  /// The first of several spellings that is there; empty if none is.
  [[nodiscard]] std::string first_of(std::initializer_list<std::string_view> names) const {
    for (const std::string_view name : names)
      if (has(name)) return text(name);
    return {};
  }
  [[nodiscard]] bool flag(std::string_view name, bool absent) const {
    if (!has(name)) return absent;
    const std::string value = lower(text(name));
    if (value != "true" && value != "false" && value != "1" && value != "0")
      fail(ErrorCode::MalformedFile, path_, "{} is {}; expected True or False", name, shown(text(name)));
    return value == "true" || value == "1";
  }
  [[nodiscard]] std::vector<double> numbers(std::string_view name, const std::string& value, std::size_t count) const {
    std::vector<double> result;
    for (const std::string_view word : words(value)) {
      double number = 0;
      if (!parse_number(word, number) || !std::isfinite(number))
        fail(ErrorCode::MalformedFile, path_, "{} with {}; expected finite numbers", name, shown(word));
      result.push_back(number);
    }
    if (result.size() != count)
      fail(ErrorCode::MalformedFile, path_, "{} of {} numbers; expected {}", name, result.size(), count);
    return result;
  }
  template <class Number>
  [[nodiscard]] Number number(std::string_view name, Number absent) const {
    Number value = absent;
    if (has(name) && !parse_number(text(name), value))
      fail(ErrorCode::MalformedFile, path_, "{} is {}; expected a whole number", name, shown(text(name)));
    return value;
  }

 private:
  fs::path path_;
  std::map<std::string, std::string, std::less<>> values_;
};

struct Header {
  std::vector<std::uint64_t> sizes;
  StoredType type{};
  bool compressed = false;
  bool text = false;
  fs::path data_path;
  std::uint64_t data_offset = 0;
};

/// "Key = value" lines up to and with ElementDataFile, which by definition is the last.
Fields read_fields(const fs::path& path, std::uint64_t& end) {
  constexpr std::size_t kLongestHeader = std::size_t{1} << 20;
  const auto bytes = read_bytes(path, 0, kLongestHeader);
  const std::string_view all(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::map<std::string, std::string, std::less<>> values;
  for (std::size_t at = 0; at < all.size() && !values.contains("ElementDataFile");) {
    const std::size_t newline = all.find('\n', at);
    const std::string_view line = trim(all.substr(at, newline == std::string_view::npos ? newline : newline - at));
    at = newline == std::string_view::npos ? all.size() : newline + 1;
    end = at;
    if (line.empty()) continue;
    const std::size_t equals = line.find('=');
    const std::string_view key = trim(line.substr(0, equals));
    const bool printable = std::all_of(key.begin(), key.end(), [](char c) { return c > 0x20 && c < 0x7f; });
    if (equals == std::string_view::npos || key.empty() || !printable)
      fail(ErrorCode::MalformedFile, path, "header line {}; expected 'Key = value'", shown(line));
    if (!values.emplace(key, trim(line.substr(equals + 1))).second)
      fail(ErrorCode::MalformedFile, path, "header field '{}' twice; expected it once", key);
  }
  return {path, std::move(values)};
}

std::vector<std::uint64_t> read_sizes(const Fields& fields, const fs::path& path) {
  constexpr std::uint64_t kMostAxes = 10;  // what MetaIO has room for
  const auto dimension = fields.number<std::uint64_t>("NDims", 0);
  if (dimension < 1 || dimension > kMostAxes)
    fail(ErrorCode::MalformedFile, path, "NDims is {}; expected 1 to {}", fields.text("NDims"), kMostAxes);
  std::vector<std::uint64_t> sizes;
  for (const std::string_view word : words(fields.text("DimSize"))) {
    std::uint64_t size = 0;
    constexpr std::uint64_t kLargest = 0x7fffffff;  // MetaIO keeps sizes as int
    if (!parse_number(word, size) || size == 0 || size > kLargest)
      fail(ErrorCode::MalformedFile, path, "DimSize with {}; expected 1 to {}", shown(word), kLargest);
    sizes.push_back(size);
  }
  if (sizes.size() != dimension)
    fail(ErrorCode::MalformedFile, path, "DimSize of {} numbers; expected {}, as NDims", sizes.size(), dimension);
  return sizes;
}

StoredType read_type(const Fields& fields, const fs::path& path) {
  const std::string& keyword = fields.text("ElementType");
  const auto channels = fields.number<std::uint64_t>("ElementNumberOfChannels", 1);
  if (channels != 1 || keyword.ends_with("_ARRAY"))
    fail(ErrorCode::UnsupportedData, path, "{} channels of type {}; expected one number per sample", channels, keyword);
  for (const StoredType& type : kTypes)
    if (type.keyword == keyword) return type;
  if (keyword == "MET_LONG" || keyword == "MET_ULONG")
    fail(ErrorCode::UnsupportedData, path, "ElementType {}, whose size depends on the machine; expected e.g. MET_INT",
         keyword);
  fail(ErrorCode::MalformedFile, path, "ElementType {}; expected one such as MET_UCHAR, MET_SHORT or MET_FLOAT",
       shown(keyword));
}

void locate_data(const Fields& fields, std::uint64_t header_end, Header& header, const fs::path& path) {
  const std::string& file = fields.text("ElementDataFile");
  const bool local = lower(file) == "local";
  if (file.empty() || file.starts_with("LIST") || file.find('%') != std::string::npos)
    fail(ErrorCode::UnsupportedFormat, path, "ElementDataFile {}; expected LOCAL or the name of one file", shown(file));
  header.data_path = local ? path : path.parent_path() / file;
  require_readable_file(header.data_path);
  const auto skip = fields.number<std::int64_t>("HeaderSize", 0);
  const std::uint64_t bytes = checked_bytes(header.sizes, header.type.bytes, path);
  const std::uint64_t size = size_of_file(header.data_path);
  if (local)
    header.data_offset = header_end;
  else if (skip == -1)  // the values are the end of the file
    header.data_offset = size - std::min(size, bytes);
  else if (skip < 0)
    fail(ErrorCode::MalformedFile, path, "HeaderSize is {}; expected -1 or more", skip);
  else
    header.data_offset = static_cast<std::uint64_t>(skip);
}

Header parse_header(const Fields& fields, std::uint64_t header_end, const fs::path& path) {
  if (fields.has("ObjectType") && lower(fields.text("ObjectType")) != "image")
    fail(ErrorCode::UnsupportedData, path, "ObjectType is {}; expected Image", shown(fields.text("ObjectType")));
  Header header;
  header.sizes = read_sizes(fields, path);
  header.type = read_type(fields, path);
  header.compressed = fields.flag("CompressedData", false);
  header.text = !fields.flag("BinaryData", false);
  if (header.text && header.compressed)
    fail(ErrorCode::UnsupportedFormat, path, "compressed text; expected BinaryData = True with CompressedData = True");
  locate_data(fields, header_end, header, path);
  return header;
}

/// Number of words from `offset` on: the values of a text file.
std::uint64_t count_words(const fs::path& path, std::uint64_t offset) {
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  std::uint64_t count = 0;
  bool inside = false;
  for (auto bytes = read_bytes(path, offset, kBlock); !bytes.empty(); bytes = read_bytes(path, offset, kBlock)) {
    for (const unsigned char byte : bytes) {
      const bool blank = byte <= 0x20;
      const bool plain =
          (byte >= '0' && byte <= '9') || byte == '.' || byte == '-' || byte == '+' || byte == 'e' || byte == 'E';
      if (!blank && !plain)
        fail(ErrorCode::MalformedFile, path, "byte 0x{:02x} among values as text; expected numbers", byte);
      if (!blank && !inside) ++count;
      inside = !blank;
    }
    offset += bytes.size();
  }
  return count;
}

void check_length(const Header& header, const Progress& progress) {
  const std::uint64_t unit = header.text ? 1 : header.type.bytes;
  const std::uint64_t needed = checked_bytes(header.sizes, unit, header.data_path);
  const std::uint64_t size = size_of_file(header.data_path);
  const std::uint64_t found = header.text         ? count_words(header.data_path, header.data_offset)
                              : header.compressed ? inflated_size(header.data_path, header.data_offset, progress)
                                                  : size - std::min(size, header.data_offset);
  if (found < needed)
    fail(ErrorCode::MalformedFile, header.data_path, "{} {} of data{}; expected {} for {} samples of type {}", found,
         header.text ? "numbers" : "bytes", header.compressed ? " after decompression" : "", needed,
         shape_text(header.sizes), header.type.name);
}

/// The matrix has a row per axis: the direction, in the world, of a step along it.
RawGrid make_grid(const Fields& fields, const Header& header, const fs::path& path) {
  const std::size_t n = header.sizes.size();
  Eigen::MatrixXd affine = Eigen::MatrixXd::Identity(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  Eigen::VectorXd offset = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n));
  const std::string matrix = fields.first_of({"TransformMatrix", "Rotation", "Orientation"});
  if (!matrix.empty()) {
    const auto numbers = fields.numbers("TransformMatrix", matrix, n * n);
    affine = Eigen::Map<const Eigen::MatrixXd>(numbers.data(), affine.rows(), affine.cols());
  }
  const std::string origin = fields.first_of({"Offset", "Position", "Origin"});
  if (!origin.empty()) {
    const auto numbers = fields.numbers("Offset", origin, n);
    offset = Eigen::Map<const Eigen::VectorXd>(numbers.data(), offset.size());
  }
  const std::string spacing = fields.first_of({"ElementSpacing", "ElementSize"});
  if (!spacing.empty()) {
    const auto numbers = fields.numbers("ElementSpacing", spacing, n);
    for (std::size_t a = 0; a < n; ++a) affine.col(static_cast<Eigen::Index>(a)) *= numbers[a];
  }
  return affine_grid({header.sizes.begin(), header.sizes.end()}, affine, offset, path);
}

}  // namespace

RawImage read_metaimage(const fs::path& path, Extent extent, const Progress& progress) {
  std::uint64_t header_end = 0;
  const Fields fields = read_fields(path, header_end);
  const Header header = parse_header(fields, header_end, path);
  if (extent == Extent::whole) check_length(header, progress);
  RawImage image;
  image.grid = make_grid(fields, header, path);
  image.info.format = "MetaImage";
  image.info.stored_type = header.type.name;
  const std::string anatomy = fields.first_of({"AnatomicalOrientation"});
  const bool anatomical = !anatomy.empty() && anatomy.find('?') == std::string::npos;
  if (anatomical) image.info.world_frame = "LPS";
  std::string unit = fields.first_of({"DistanceUnits"});
  if (unit == "?") unit.clear();
  if (unit.empty() && anatomical) unit = "mm";
  for (std::size_t a = 0; a < std::min<std::size_t>(3, image.grid.axes.size()); ++a) image.grid.axes[a].unit = unit;
  name_axes(image.grid);
  image.values = array_of_type(header.type.name);
  if (extent == Extent::whole) read_metaimage_values(path, checked_bytes(header.sizes, 1, path), image.values);
  return image;
}

}  // namespace tegl::io_detail
