// SPDX-License-Identifier: BSD-3-Clause
//
// Reads headers of MetaImage files (.mha, and .mhd with a separate data file). MetaIO, the reference library, copies
// keys and values to fixed buffers that longer ones overflow; such files are refused as malformed.
//
// Based on: S. Aylward, "MetaIO: Introduction and Documentation" (ITK wiki).
#include "images/metaimage.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <string>

#include "base/common.hpp"
#include "base/named_path.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

struct MetaType {
  std::string_view keyword;
  const char* name;
};

// MET_LONG is left out: it has 4 bytes in the format's definition, and 8 in files that ITK wrote on 64-bit machines.
constexpr std::array<MetaType, 10> kMetaTypes = {{{"MET_CHAR", "int8"},
                                                  {"MET_UCHAR", "uint8"},
                                                  {"MET_SHORT", "int16"},
                                                  {"MET_USHORT", "uint16"},
                                                  {"MET_INT", "int32"},
                                                  {"MET_UINT", "uint32"},
                                                  {"MET_LONG_LONG", "int64"},
                                                  {"MET_ULONG_LONG", "uint64"},
                                                  {"MET_FLOAT", "float"},
                                                  {"MET_DOUBLE", "double"}}};

class MetaFields {
 public:
  MetaFields(const fs::path& path, std::map<std::string, std::string, std::less<>> values)
      : path_(path), values_(std::move(values)) {}

  [[nodiscard]] bool has(std::string_view name) const { return values_.contains(name); }
  [[nodiscard]] const std::string& text(std::string_view name) const {
    const auto found = values_.find(name);
    if (found == values_.end()) fail(ErrorCode::MalformedFile, path_, "header without the field '{}'", name);
    return found->second;
  }
  /// The first spelling that is present; empty if none is.
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

struct MetaHeader {
  std::vector<std::uint64_t> sizes;
  MetaType type{};
  StoredSamples samples;
};

/// Whether a field is numeric; MetaIO does not store these as text.
bool holds_numbers(std::string_view key) {
  constexpr std::array<std::string_view, 9> kKeys = {"TransformMatrix", "Rotation", "Orientation",
                                                     "Offset",          "Position", "Origin",
                                                     "ElementSpacing",  "DimSize",  "ElementSize"};
  return std::ranges::find(kKeys, key) != kKeys.end();
}

void require_room(std::string_view key, std::string_view value, const fs::path& path) {
  constexpr std::size_t kLongest = 254;
  constexpr std::size_t kLongestNumbers = 4096;  // 10 x 10 numbers
  if (key.size() > kLongest)
    fail(ErrorCode::MalformedFile, path, "header field {} has a name of {} bytes; expected at most {}", shown(key),
         key.size(), kLongest);
  const std::size_t longest = holds_numbers(key) ? kLongestNumbers : kLongest;
  if (value.size() > longest)
    fail(ErrorCode::MalformedFile, path, "header field {} is {}, {} bytes long; expected at most {}", shown(key),
         shown(value), value.size(), longest);
}

/// Parses "Key = value" lines up to ElementDataFile, which by definition is the last one.
MetaFields read_fields(const fs::path& path, std::uint64_t& end) {
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
    const std::string_view value = trim(line.substr(equals + 1));
    require_room(key, value, path);
    if (!values.emplace(key, value).second)
      fail(ErrorCode::MalformedFile, path, "header field '{}' twice; expected it once", key);
  }
  return {path, std::move(values)};
}

std::vector<std::uint64_t> read_meta_sizes(const MetaFields& fields, const fs::path& path) {
  constexpr std::uint64_t kMostAxes = 10;  // the capacity of MetaIO
  const auto dimension = fields.number<std::uint64_t>("NDims", 0);
  if (dimension < 1 || dimension > kMostAxes)
    fail(ErrorCode::MalformedFile, path, "NDims is {}; expected 1 to {}", fields.text("NDims"), kMostAxes);
  std::vector<std::uint64_t> sizes;
  for (const std::string_view word : words(fields.text("DimSize"))) {
    std::uint64_t size = 0;
    constexpr std::uint64_t kLargest = 0x7fffffff;  // MetaIO stores sizes as int
    if (!parse_number(word, size) || size == 0 || size > kLargest)
      fail(ErrorCode::MalformedFile, path, "DimSize with {}; expected 1 to {}", shown(word), kLargest);
    sizes.push_back(size);
  }
  if (sizes.size() != dimension)
    fail(ErrorCode::MalformedFile, path, "DimSize of {} numbers; expected {}, as NDims", sizes.size(), dimension);
  return sizes;
}

MetaType read_meta_type(const MetaFields& fields, const fs::path& path) {
  const std::string& keyword = fields.text("ElementType");
  const auto channels = fields.number<std::uint64_t>("ElementNumberOfChannels", 1);
  if (channels != 1 || keyword.ends_with("_ARRAY"))
    fail(ErrorCode::UnsupportedData, path, "{} channels of type {}; expected one number per sample", channels,
         shown(keyword));
  for (const MetaType& type : kMetaTypes)
    if (type.keyword == keyword) return type;
  if (keyword == "MET_LONG" || keyword == "MET_ULONG")
    fail(ErrorCode::UnsupportedData, path, "ElementType {}, whose size depends on the machine; expected e.g. MET_INT",
         keyword);
  fail(ErrorCode::MalformedFile, path, "ElementType {}; expected one such as MET_UCHAR, MET_SHORT or MET_FLOAT",
       shown(keyword));
}

Encoding read_meta_encoding(const MetaFields& fields, const fs::path& path) {
  const bool compressed = fields.flag("CompressedData", false);
  const bool text = !fields.flag("BinaryData", false);
  if (text && compressed)
    fail(ErrorCode::UnsupportedFormat, path, "compressed text; expected BinaryData = True with CompressedData = True");
  return text ? Encoding::text : compressed ? Encoding::deflate : Encoding::raw;
}

/// Whether samples are not in this machine's byte order.
bool read_byte_order(const MetaFields& fields, const fs::path& path) {
  constexpr bool kBig = std::endian::native == std::endian::big;
  const bool big = fields.flag("BinaryDataByteOrderMSB", fields.flag("ElementByteOrderMSB", kBig));
  if (fields.flag("ElementByteOrderMSB", big) != big)
    fail(ErrorCode::MalformedFile, path, "BinaryDataByteOrderMSB is {}, ElementByteOrderMSB is {}; expected the same",
         fields.text("BinaryDataByteOrderMSB"), fields.text("ElementByteOrderMSB"));
  return big != kBig;
}

/// Offset of the samples in a separate file.
std::uint64_t read_header_size(const MetaFields& fields, const StoredSamples& samples, const fs::path& path) {
  const auto skip = fields.number<std::int64_t>("HeaderSize", 0);
  if (skip < -1) fail(ErrorCode::MalformedFile, path, "HeaderSize is {}; expected -1 or more", skip);
  if (skip >= 0) return static_cast<std::uint64_t>(skip);
  // -1: the samples end at the end of the file.
  if (samples.encoding != Encoding::raw)
    fail(ErrorCode::MalformedFile, path, "HeaderSize is -1 for compressed samples or text; expected 0 or more");
  const std::uint64_t size = size_of_file(samples.path);
  return size - std::min(size, checked_bytes(samples.sizes, bytes_of_type(samples.type), path));
}

void locate_data(const MetaFields& fields, std::uint64_t header_end, bool allow_outside_paths, StoredSamples& samples,
                 const fs::path& path) {
  const std::string& file = fields.text("ElementDataFile");
  const bool local = lower(file) == "local";
  if (file.empty() || file.starts_with("LIST") || file.find('%') != std::string::npos)
    fail(ErrorCode::UnsupportedFormat, path, "ElementDataFile {}; expected LOCAL or the name of one file", shown(file));
  samples.path = local ? path : named_path(path, std::string(file), allow_outside_paths);
  require_readable_file(samples.path);
  samples.offset = local ? header_end : read_header_size(fields, samples, path);
  const auto compressed = fields.number<std::int64_t>("CompressedDataSize", 0);
  if (compressed < 0)
    fail(ErrorCode::MalformedFile, path,
         "CompressedDataSize is {}; expected the bytes of the compressed samples, or 0 if it is not known", compressed);
  if (samples.encoding == Encoding::deflate) samples.compressed_bytes = static_cast<std::uint64_t>(compressed);
}

MetaHeader parse_header(const MetaFields& fields, std::uint64_t header_end, bool allow_outside_paths,
                        const fs::path& path) {
  if (fields.has("ObjectType") && lower(fields.text("ObjectType")) != "image")
    fail(ErrorCode::UnsupportedData, path, "ObjectType is {}; expected Image", shown(fields.text("ObjectType")));
  MetaHeader header;
  header.sizes = read_meta_sizes(fields, path);
  header.type = read_meta_type(fields, path);
  header.samples.type = header.type.name;
  header.samples.sizes = header.sizes;
  header.samples.encoding = read_meta_encoding(fields, path);
  header.samples.swapped = read_byte_order(fields, path);
  locate_data(fields, header_end, allow_outside_paths, header.samples, path);
  return header;
}

/// The matrix has one row per axis: the world direction of a step along it.
RawGrid make_grid(const MetaFields& fields, const MetaHeader& header, const fs::path& path) {
  const std::size_t n = header.sizes.size();
  // directions
  Eigen::MatrixXd affine = Eigen::MatrixXd::Identity(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  Eigen::VectorXd offset = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n));
  const std::string matrix = fields.first_of({"TransformMatrix", "Rotation", "Orientation"});
  if (!matrix.empty()) {
    const auto numbers = fields.numbers("TransformMatrix", matrix, n * n);
    affine = Eigen::Map<const Eigen::MatrixXd>(numbers.data(), affine.rows(), affine.cols());
  }
  // origin
  const std::string origin = fields.first_of({"Offset", "Position", "Origin"});
  if (!origin.empty()) {
    const auto numbers = fields.numbers("Offset", origin, n);
    offset = Eigen::Map<const Eigen::VectorXd>(numbers.data(), offset.size());
  }
  // spacing
  const std::string spacing = fields.first_of({"ElementSpacing", "ElementSize"});
  if (!spacing.empty()) {
    const auto numbers = fields.numbers("ElementSpacing", spacing, n);
    for (std::size_t a = 0; a < n; ++a) affine.col(static_cast<Eigen::Index>(a)) *= numbers[a];
  }
  return affine_grid({header.sizes.begin(), header.sizes.end()}, affine, offset, path);
}

}  // namespace

StoredImage open_metaimage(const fs::path& path, bool allow_outside_paths) {
  std::uint64_t header_end = 0;
  const MetaFields fields = read_fields(path, header_end);
  MetaHeader header = parse_header(fields, header_end, allow_outside_paths, path);
  // grid
  StoredImage image;
  image.grid = make_grid(fields, header, path);
  image.info.format = "MetaImage";
  image.info.stored_type = parse_value_type(header.type.name);
  // frame and units
  const std::string anatomy = fields.first_of({"AnatomicalOrientation"});
  const bool anatomical = !anatomy.empty() && anatomy.find('?') == std::string::npos;
  if (anatomical) image.info.world_frame = "LPS";
  std::string unit = fields.first_of({"DistanceUnits"});
  if (unit == "?") unit.clear();
  if (unit.empty() && anatomical) unit = "mm";
  for (std::size_t a = 0; a < std::min<std::size_t>(3, image.grid.axes.size()); ++a) image.grid.axes[a].unit = unit;
  name_axes(image.grid);
  image.samples = std::move(header.samples);
  return image;
}

}  // namespace tegl::io_detail
