// SPDX-License-Identifier: BSD-3-Clause
//
// Reads the headers of .npy files, alone or in .npz archives. The header is a Python literal: a dictionary with the
// type, the order and the shape. Arrays of Python objects are refused: only Python can read them, and it may run their
// code.
//
// Based on: NumPy Enhancement Proposal 1, "A Simple File Format for NumPy Arrays"; numpy.lib.format (versions 1 to 3).
#include "images/npy.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include <fmt/ranges.h>

#include "base/common.hpp"
#include "base/inflate.hpp"
#include "base/zip_archive.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kMagic = "\x93NUMPY";

/// The header's dictionary.
struct NpyFields {
  std::string descr;
  bool is_fortran_order = false;
  std::vector<std::uint64_t> shape;
};

/// Parses the dictionary.
class Literal {
 public:
  Literal(std::string_view text, const fs::path& path, std::string_view member)
      : text_(text), path_(path), member_(member) {}

  NpyFields fields() {
    NpyFields result;
    std::array<bool, 3> found{};
    constexpr std::array<std::string_view, 3> kKeys = {"descr", "fortran_order", "shape"};
    expect('{');
    while (!accept('}')) {
      const std::string key = string();
      const auto at = static_cast<std::size_t>(std::ranges::find(kKeys, key) - kKeys.begin());
      if (at == kKeys.size() || found[at])
        fail_here(fmt::format("the key {}; expected descr, fortran_order and shape, once each", shown(key)));
      found[at] = true;
      expect(':');
      if (at == 0) result.descr = type();
      if (at == 1) result.is_fortran_order = boolean();
      if (at == 2) result.shape = numbers();
      if (!accept(',')) {
        expect('}');
        break;
      }
    }
    for (std::size_t i = 0; i < kKeys.size(); ++i)
      if (!found[i]) fail_here(fmt::format("no key {}", kKeys[i]));
    skip_blanks();
    if (at_ != text_.size()) fail_here(shown(text_.substr(at_)) + "; expected the end of the dictionary");
    return result;
  }

 private:
  void skip_blanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n')) ++at_;
  }
  bool accept(char c) {
    skip_blanks();
    if (at_ == text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  void expect(char c) {
    if (!accept(c)) fail_here(fmt::format("{}; expected '{}'", shown(text_.substr(std::min(at_, text_.size()))), c));
  }
  std::string string() {
    const char quote = accept('"') ? '"' : '\'';
    if (quote == '\'') expect('\'');
    const std::size_t end = text_.find(quote, at_);
    if (end == std::string_view::npos) fail_here("a string without an end");
    std::string result(text_.substr(at_, end - at_));
    at_ = end + 1;
    return result;
  }
  std::string type() {
    if (accept('['))
      fail(ErrorCode::UnsupportedData, path_, "{}an array with several fields per sample; expected one number",
           member_);
    return string();
  }
  bool boolean() {
    skip_blanks();
    for (const std::string_view word : {"True", "False"})
      if (text_.substr(at_).starts_with(word)) {
        at_ += word.size();
        return word == "True";
      }
    fail_here(shown(text_.substr(at_)) + "; expected True or False");
  }
  std::vector<std::uint64_t> numbers() {
    constexpr std::size_t kMostAxes = 64;  // of an array in NumPy
    std::vector<std::uint64_t> result;
    expect('(');
    while (!accept(')')) {
      skip_blanks();
      const std::size_t end = std::min(text_.find_first_not_of("0123456789", at_), text_.size());
      std::uint64_t number = 0;
      if (!parse_number(text_.substr(at_, end - at_), number) || result.size() == kMostAxes)
        fail_here(shown(text_.substr(at_)) + " in the shape; expected whole numbers");
      result.push_back(number);
      at_ = end;
      if (at_ < text_.size() && text_[at_] == 'L') ++at_;  // long integers of Python 2
      if (!accept(',')) {
        expect(')');
        break;
      }
    }
    return result;
  }
  [[noreturn]] void fail_here(const std::string& what) const {
    fail(ErrorCode::MalformedFile, path_, "{}header of an array with {}", member_, what);
  }

  std::string_view text_;
  const fs::path& path_;
  std::string_view member_;  ///< "array 'a': ", in an archive
  std::size_t at_ = 0;
};

struct NpyType {
  std::string_view code;  ///< without the byte order
  std::string_view name;  ///< as SampleReader reads it
};

constexpr std::array<NpyType, 12> kNpyTypes = {{{"b1", "uint8"},
                                                {"i1", "int8"},
                                                {"u1", "uint8"},
                                                {"i2", "int16"},
                                                {"u2", "uint16"},
                                                {"i4", "int32"},
                                                {"u4", "uint32"},
                                                {"i8", "int64"},
                                                {"u8", "uint64"},
                                                {"f2", "uint16"},
                                                {"f4", "float"},
                                                {"f8", "double"}}};

/// The number with the bits of an IEEE half.
float of_half(std::uint16_t bits) {
  constexpr int kFractionBits = 10, kBias = 15;
  const int exponent = bits >> kFractionBits & 0x1f;
  const int fraction = bits & 0x3ff;
  float size = 0;
  if (exponent == 0x1f)
    size = fraction == 0 ? std::numeric_limits<float>::infinity() : std::numeric_limits<float>::quiet_NaN();
  else if (exponent == 0)
    size = std::ldexp(static_cast<float>(fraction), 1 - kBias - kFractionBits);
  else
    size = std::ldexp(static_cast<float>(fraction + 0x400), exponent - kBias - kFractionBits);
  return (bits & 0x8000) != 0 ? -size : size;
}

ValueArray of_halves(ValueArray&& stored) {
  const auto& halves = std::get<ValueVector<std::uint16_t>>(stored);
  ValueVector<float> values(halves.size());
  std::transform(halves.begin(), halves.end(), values.begin(), of_half);
  return values;
}

/// Size of the part before the samples, by its first 12 bytes.
std::uint64_t header_bytes(std::span<const unsigned char> start, const fs::path& path, std::string_view member) {
  const std::string_view text(reinterpret_cast<const char*>(start.data()), start.size());
  if (start.size() < 12 || !text.starts_with(kMagic))
    fail(ErrorCode::MalformedFile, path, "{}starts with {}; expected '\\x93NUMPY'", member,
         shown(start.first(std::min<std::size_t>(6, start.size()))));
  const unsigned version = start[6];
  if (version < 1 || version > 3)
    fail(ErrorCode::UnsupportedFormat, path, "{}version {}.{} of NumPy's format; expected 1, 2 or 3", member, version,
         start[7]);
  const std::uint64_t short_size = start[8] | std::uint64_t{start[9]} << 8;
  return version == 1 ? 10 + short_size
                      : 12 + (short_size | std::uint64_t{start[10]} << 16 | std::uint64_t{start[11]} << 24);
}

/// The image of an array with this header; `samples` has the file and the encoding.
StoredImage image_of(std::string_view header, StoredSamples&& samples, const fs::path& path, std::string_view member) {
  const NpyFields fields = Literal(header, path, member).fields();
  // type
  const std::string_view descr = fields.descr;
  const char order = descr.empty() ? '\0' : descr.front();
  const auto type = std::ranges::find(kNpyTypes, descr.substr(std::min<std::size_t>(1, descr.size())), &NpyType::code);
  if (type == kNpyTypes.end() || std::string_view("<>|=").find(order) == std::string_view::npos)
    fail(ErrorCode::UnsupportedData, path,
         "{}an array of type {}; expected integers of 1 to 8 bytes, bool, float16, float32 or float64", member,
         shown(descr));
  StoredImage image;
  const bool is_half = type->code == "f2";
  if (is_half) image.convert = of_halves;
  if (!is_half) image.info.stored_type = parse_value_type(type->name);
  image.info.format = "NumPy";
  samples.type = type->name;
  samples.swapped = (order == '<' || order == '>') && (order == '>') != (std::endian::native == std::endian::big);
  // axes: the last one of an array is x, as for arrays in Python
  if (std::ranges::find(fields.shape, std::uint64_t{0}) != fields.shape.end())
    fail(ErrorCode::UnsupportedData, path, "{}an array of shape ({}), without samples", member,
         fmt::join(fields.shape, ", "));
  const std::vector<std::uint64_t> sizes(fields.shape.rbegin(), fields.shape.rend());
  samples.sizes = fields.is_fortran_order ? fields.shape : sizes;
  image.is_reversed = fields.is_fortran_order && sizes.size() > 1;
  const auto n = static_cast<Eigen::Index>(sizes.size());
  checked_bytes(sizes, sizeof(double), path);
  for (const std::uint64_t size : sizes) image.grid.axes.push_back(Axis::uniform(static_cast<std::size_t>(size)));
  image.grid.linear = Eigen::MatrixXd::Identity(n, n);
  image.grid.offset = Eigen::VectorXd::Zero(n);
  name_axes(image.grid);
  image.samples = std::move(samples);
  return image;
}

/// A header larger than this is not one of numbers.
constexpr std::uint64_t kMostHeader = std::uint64_t{1} << 20;

/// Opens the array whose first bytes `prefix(count)` returns (fewer at its end).
template <class Prefix>
StoredImage open_array(const Prefix& prefix, StoredSamples&& samples, const fs::path& path, std::string_view member) {
  const auto start = prefix(12);
  const std::uint64_t size = header_bytes(start, path, member);
  const std::size_t before = start[6] == 1 ? 10 : 12;
  const auto all = size <= kMostHeader ? prefix(static_cast<std::size_t>(size)) : start;
  if (all.size() < size)
    fail(ErrorCode::MalformedFile, path, "{}a header of {} bytes; expected at most {}, and no more than the file has",
         member, size, kMostHeader);
  (samples.encoding == Encoding::raw ? samples.offset : samples.skip) += size;
  const std::string_view text(reinterpret_cast<const char*>(all.data()) + before, all.size() - before);
  return image_of(text, std::move(samples), path, member);
}

/// The names of the arrays in an archive: its members' names without ".npy".
std::optional<std::string_view> array_name(const ZipMember& member) {
  constexpr std::string_view kSuffix = ".npy";
  std::string_view name = member.name;
  if (!name.ends_with(kSuffix)) return std::nullopt;
  name.remove_suffix(kSuffix.size());
  return name;
}

StoredImage open_member(const fs::path& path, const ZipMember& member) {
  StoredSamples samples;
  samples.path = path;
  samples.offset = member.offset;
  if (member.is_deflated) {
    samples.encoding = Encoding::deflate;
    samples.compressed_bytes = member.compressed_bytes;
    samples.crc = member.crc;
  }
  const auto prefix = [&](std::size_t count) {
    const auto most = static_cast<std::size_t>(std::min<std::uint64_t>(count, member.bytes));
    if (!member.is_deflated) return read_bytes(path, member.offset, most);
    std::vector<unsigned char> bytes(most);
    bytes.resize(InflateStream(path, member.offset, member.compressed_bytes, member.crc).read(bytes));
    return bytes;
  };
  StoredImage image =
      open_array(prefix, std::move(samples), path, fmt::format("array {}: ", shown(*array_name(member))));
  // what the array needs, by its header, must be in the member
  const StoredSamples& array = image.samples;
  const std::uint64_t header = member.is_deflated ? array.skip : array.offset - member.offset;
  const std::uint64_t needed = checked_bytes(array.sizes, bytes_of_type(array.type), path);
  if (needed > member.bytes - header)
    fail(ErrorCode::MalformedFile, path, "array {}: {} bytes of data; expected {} for {} samples of type {}",
         shown(*array_name(member)), member.bytes - header, needed, shape_text(array.sizes), array.type);
  return image;
}

/// The text of an array of one text, such as numpy.array("fcc") (UCS-4) or numpy.bytes_("fcc"): padded by zeros.
std::string text_of(const fs::path& path, const ZipMember& member) {
  constexpr std::uint64_t kMost = 4096;  // a header and a name
  const std::string label = fmt::format("array {}: ", shown(*array_name(member)));
  std::vector<unsigned char> bytes;
  if (member.bytes <= kMost && member.is_deflated) {
    bytes.resize(static_cast<std::size_t>(member.bytes));
    bytes.resize(InflateStream(path, member.offset, member.compressed_bytes, member.crc).read(bytes));
  } else if (member.bytes <= kMost) {
    bytes = read_bytes(path, member.offset, static_cast<std::size_t>(member.bytes));
  }
  const auto fail_text = [&](const std::string& what) {
    fail(ErrorCode::MalformedFile, path, "{}{}; expected one text, the name of a lattice", label, what);
  };
  if (member.bytes > kMost) fail_text(fmt::format("{} bytes", member.bytes));
  if (bytes.size() != member.bytes || bytes.empty())
    fail_text(fmt::format("{} of {} bytes", bytes.size(), member.bytes));
  const std::uint64_t start = header_bytes(bytes, path, label);
  const auto before = static_cast<std::size_t>(bytes[6] == 1 ? 10 : 12);
  if (start > bytes.size() || start < before)
    fail_text(fmt::format("a header of {} bytes in {} bytes", start, bytes.size()));
  const std::string_view header(reinterpret_cast<const char*>(bytes.data()) + before,
                                static_cast<std::size_t>(start) - before);
  const NpyFields fields = Literal(header, path, label).fields();
  const bool is_bytes = fields.descr.starts_with("|S") || fields.descr.starts_with("S");
  if (!fields.shape.empty() || !(is_bytes || fields.descr.starts_with("<U")))
    fail_text(fmt::format("the type {} and the shape ({})", shown(fields.descr), fmt::join(fields.shape, ", ")));
  const std::size_t width = is_bytes ? 1 : 4;
  std::string text;
  for (std::size_t at = static_cast<std::size_t>(start); at + width <= bytes.size(); at += width) {
    const auto* const next = bytes.data() + at;
    if (std::all_of(next, next + width, [](unsigned char byte) { return byte == 0; })) break;
    text += std::all_of(next + 1, next + width, [](unsigned char byte) { return byte == 0; }) ? static_cast<char>(*next)
                                                                                              : '?';
  }
  return text;
}

/// The lattice that an array of the archive names.
std::optional<Lattice> lattice_of(const fs::path& path, const std::vector<ZipMember>& members) {
  for (const ZipMember& member : members)
    if (array_name(member) == kLatticeKey) return lattice_of_text(text_of(path, member), path);
  return std::nullopt;
}

/// Gives the layers of a lattice their regular step: archives have no coordinates.
void set_layer_step(StoredImage& image) {
  if (!image.info.lattice || static_cast<int>(image.grid.axes.size()) != dimension(*image.info.lattice)) return;
  Axis& layers = image.grid.axes.at(image.info.lattice == Lattice::fcc_in_time ? 2 : image.grid.axes.size() - 1);
  Axis regular = Axis::uniform(layers.size(), 0.0, layer_step(*image.info.lattice));
  regular.name = layers.name;
  layers = std::move(regular);
}

bool is_image(const StoredImage& image) {
  const auto longer = std::ranges::count_if(image.grid.axes, [](const Axis& axis) { return axis.size() > 1; });
  return longer >= 2 && image.grid.axes.size() <= 5;
}

/// An array of an archive.
struct NamedImage {
  std::string name;
  StoredImage image;
};

/// The arrays that are readable as images.
std::vector<NamedImage> readable_arrays(const fs::path& path, const std::vector<ZipMember>& members) {
  std::vector<NamedImage> result;
  for (const ZipMember& member : members) {
    const std::optional<std::string_view> name = array_name(member);
    if (!name) continue;
    try {
      StoredImage image = open_member(path, member);
      if (is_image(image)) result.push_back({std::string(*name), std::move(image)});
    } catch (const Error& error) {
      if (error.code() != ErrorCode::UnsupportedData) throw;  // texts and objects beside images are no fault
    }
  }
  return result;
}

std::string names_of(const std::vector<NamedImage>& arrays) {
  std::vector<std::string> names;
  for (const NamedImage& array : arrays)
    names.push_back(fmt::format("{} ({})", array.name, shape_text(array.image.samples.sizes)));
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

StoredImage open_npy(const fs::path& path) {
  StoredSamples samples;
  samples.path = path;
  return open_array([&](std::size_t count) { return read_bytes(path, 0, count); }, std::move(samples), path, "");
}

StoredImage open_npz(const fs::path& path, std::string_view variable) {
  const std::vector<ZipMember> members = list_zip(path);
  std::vector<NamedImage> arrays = readable_arrays(path, members);
  std::vector<std::string> names;
  for (const NamedImage& array : arrays) names.push_back(array.name);
  const auto chosen = [&](StoredImage&& image, std::string_view name) {
    image.info.variable = name;
    image.info.lattice = lattice_of(path, members);
    set_layer_step(image);
    image.info.variables = std::move(names);
    return std::move(image);
  };
  if (!variable.empty())
    for (const ZipMember& member : members)
      if (array_name(member) == variable) return chosen(open_member(path, member), variable);
  if (arrays.empty())
    fail(variable.empty() ? ErrorCode::UnsupportedData : ErrorCode::VariableNotFound, path,
         "{}no array with 2 to 5 axes longer than 1 among {} members",
         variable.empty() ? std::string() : fmt::format("no array '{}'; ", variable), members.size());
  if (!variable.empty())
    fail(ErrorCode::VariableNotFound, path, "no array '{}'; expected one of {}", variable, names_of(arrays));
  if (arrays.size() > 1)
    fail(ErrorCode::VariableNotFound, path, "{} arrays, and none chosen; expected one of {}", arrays.size(),
         names_of(arrays));
  return chosen(std::move(arrays[0].image), arrays[0].name);
}

std::vector<ImageVariable> list_npz(const fs::path& path) {
  std::vector<ImageVariable> result;
  for (const NamedImage& array : readable_arrays(path, list_zip(path))) {
    ImageVariable& variable = result.emplace_back();
    variable.name = array.name;
    for (const Axis& axis : array.image.grid.axes)
      if (axis.size() > 1) {
        variable.sizes.push_back(axis.size());
        variable.axes.push_back(axis.name);
      }
  }
  return result;
}

}  // namespace tegl::io_detail
