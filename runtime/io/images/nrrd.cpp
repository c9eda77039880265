// SPDX-License-Identifier: BSD-3-Clause
//
// Reads headers of NRRD images, with attached data or a separate data file.
//
// Based on: G. Kindlmann, "Definition of NRRD File Format" (Teem), versions NRRD0001 to NRRD0005.
#include "images/nrrd.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include "base/common.hpp"
#include "base/named_path.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

using NrrdFields = std::map<std::string, std::string, std::less<>>;

struct Text {
  NrrdFields fields;
  std::uint64_t end = 0;        ///< first byte after the header
  bool has_blank_line = false;  ///< before attached data
};

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kLongestHeader = std::size_t{1} << 20;

/// Field names of the definition, without blanks, as some are spelled with and without.
constexpr std::array<std::string_view, 31> kFieldNames = {
    "content",         "number",           "type",        "blocksize", "dimension",   "space",      "spacedimension",
    "sizes",           "spacings",         "thicknesses", "axismins",  "axismaxs",    "centers",    "centerings",
    "kinds",           "labels",           "units",       "min",       "max",         "oldmin",     "oldmax",
    "endian",          "encoding",         "lineskip",    "byteskip",  "sampleunits", "spaceunits", "spaceorigin",
    "spacedirections", "measurementframe", "datafile"};

std::string without_blanks(std::string_view text) {
  std::string result = lower(text);
  std::erase(result, ' ');
  return result;
}

/// Parses one "field: description" line into `fields`; skips comments, and key/value pairs except kLatticeKey.
void parse_line(std::string_view line, NrrdFields& fields, const fs::path& path) {
  if (line.starts_with('#')) return;
  if (const std::size_t assign = line.find(":="); assign != std::string_view::npos) {
    if (line.substr(0, assign) != kLatticeKey) return;
    if (!fields.emplace(kLatticeKey, trim(line.substr(assign + 2))).second)
      fail(ErrorCode::MalformedFile, path, "key '{}' twice; expected it once", kLatticeKey);
    return;
  }
  const std::size_t colon = line.find(": ");
  const std::string name = without_blanks(line.substr(0, colon));
  const bool known = std::find(kFieldNames.begin(), kFieldNames.end(), name) != kFieldNames.end();
  if (colon == std::string_view::npos || !known)
    fail(ErrorCode::MalformedFile, path, "header line {}; expected 'field: value', 'key:=value' or a comment",
         shown(line));
  if (!fields.emplace(name, trim(line.substr(colon + 2))).second)
    fail(ErrorCode::MalformedFile, path, "header field '{}' twice; expected it once", name);
}

Text read_header_text(const fs::path& path) {
  const auto bytes = read_bytes(path, 0, kLongestHeader);
  const std::string_view all(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (!all.starts_with("NRRD000") || all.size() < 9 || all[7] < '1' || all[7] > '5')
    fail(ErrorCode::MalformedFile, path, "starts with {}; expected 'NRRD0001' to 'NRRD0005'", shown(all.substr(0, 8)));
  Text text;
  for (std::size_t at = all.find('\n'); at != std::string_view::npos;) {
    const std::size_t begin = at + 1;
    at = all.find('\n', begin);
    std::string_view line = all.substr(begin, at == std::string_view::npos ? at : at - begin);
    if (line.ends_with('\r')) line.remove_suffix(1);
    text.end = at == std::string_view::npos ? all.size() : at + 1;
    if (line.empty()) {
      text.has_blank_line = at != std::string_view::npos;
      break;
    }
    parse_line(line, text.fields, path);
  }
  return text;
}

const std::string& required(const NrrdFields& fields, std::string_view name, const fs::path& path) {
  const auto found = fields.find(name);
  if (found == fields.end()) fail(ErrorCode::MalformedFile, path, "header without the field '{}'", name);
  return found->second;
}

std::string optional_field(const NrrdFields& fields, std::string_view name) {
  const auto found = fields.find(name);
  return found == fields.end() ? std::string() : found->second;
}

std::vector<std::uint64_t> read_nrrd_sizes(const NrrdFields& fields, const fs::path& path) {
  std::uint64_t dimension = 0;
  const std::string& text = required(fields, "dimension", path);
  constexpr std::uint64_t kMostAxes = 16;
  if (!parse_number(text, dimension) || dimension < 1 || dimension > kMostAxes)
    fail(ErrorCode::MalformedFile, path, "dimension {}; expected 1 to {}", shown(text), kMostAxes);
  std::vector<std::uint64_t> sizes;
  const std::string& list = required(fields, "sizes", path);
  for (const std::string_view word : words(list)) {
    std::uint64_t size = 0;
    if (!parse_number(word, size) || size == 0)
      fail(ErrorCode::MalformedFile, path, "size {}; expected a whole number of at least 1", shown(word));
    sizes.push_back(size);
  }
  if (sizes.size() != dimension)
    fail(ErrorCode::MalformedFile, path, "{} sizes ({}); expected {}, as the dimension", sizes.size(), shown(list),
         dimension);
  return sizes;
}

struct NrrdType {
  const char* name;
  unsigned bytes;
};

NrrdType read_nrrd_type(const NrrdFields& fields, const fs::path& path) {
  const std::string& text = required(fields, "type", path);
  const std::string name = without_blanks(text);
  static constexpr std::array<std::pair<NrrdType, std::string_view>, 10> kTypes = {{
      {{"int8", 1}, " signedchar int8 int8_t "},
      {{"uint8", 1}, " uchar unsignedchar uint8 uint8_t "},
      {{"int16", 2}, " short shortint signedshort signedshortint int16 int16_t "},
      {{"uint16", 2}, " ushort unsignedshort unsignedshortint uint16 uint16_t "},
      {{"int32", 4}, " int signedint int32 int32_t "},
      {{"uint32", 4}, " uint unsignedint uint32 uint32_t "},
      {{"int64", 8}, " longlong longlongint signedlonglong signedlonglongint int64 int64_t "},
      {{"uint64", 8}, " ulonglong unsignedlonglong unsignedlonglongint uint64 uint64_t "},
      {{"float", 4}, " float "},
      {{"double", 8}, " double "},
  }};
  for (const auto& [type, names] : kTypes)
    if (names.find(" " + name + " ") != std::string_view::npos) return type;
  if (name == "block") fail(ErrorCode::UnsupportedData, path, "values of type 'block'; expected numbers");
  fail(ErrorCode::MalformedFile, path, "type {}; expected a type such as 'uint8', 'short' or 'float'", shown(text));
}

/// A field with one number per axis; NaN for entries "nan", and for all axes if the field is absent.
std::vector<double> per_axis(const NrrdFields& fields, std::string_view name, std::size_t axes, const fs::path& path) {
  std::vector<double> values;
  const std::string text = optional_field(fields, name);
  if (text.empty()) return std::vector<double>(axes, kNaN);
  for (const std::string_view word : words(text)) {
    double value = kNaN;
    if (!parse_number(word, value))
      fail(ErrorCode::MalformedFile, path, "{} with {}; expected numbers", name, shown(word));
    if (std::isinf(value))
      fail(ErrorCode::MalformedFile, path, "{} with {}; expected finite numbers, or nan if not known", name,
           shown(word));
    values.push_back(value);
  }
  if (values.size() != axes)
    fail(ErrorCode::MalformedFile, path, "{} {}; expected one for each of the {} axes", values.size(), name, axes);
  return values;
}

/// A field with one word per axis; empty if the field is absent.
std::vector<std::string> words_per_axis(const NrrdFields& fields, std::string_view name, std::size_t axes,
                                        const fs::path& path) {
  std::vector<std::string> result;
  const std::string text = optional_field(fields, name);
  for (const std::string_view word : words(text)) result.push_back(lower(word));
  if (result.empty()) result.resize(axes);
  if (result.size() != axes)
    fail(ErrorCode::MalformedFile, path, "{} {}; expected one for each of the {} axes", result.size(), name, axes);
  return result;
}

/// A field of `count` quoted strings; empty strings if the field is absent.
std::vector<std::string> quoted_strings(const NrrdFields& fields, std::string_view name, std::size_t count,
                                        const fs::path& path) {
  constexpr std::size_t kLongest = 1024;  // bytes of a string
  const std::string text = optional_field(fields, name);
  if (text.empty()) return std::vector<std::string>(count);
  std::vector<std::string> result;
  bool inside = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') {
      inside = !inside;
      if (inside) result.emplace_back();
    } else if (inside) {
      if (text[i] == '\\' && i + 1 < text.size()) ++i;
      result.back() += text[i];
      if (result.back().size() > kLongest)
        fail(ErrorCode::MalformedFile, path, "string {} of {} is longer than {} bytes ({}); expected at most these",
             result.size() - 1, name, kLongest, shown(result.back()));
    } else if (text[i] != ' ' && text[i] != '\t') {
      fail(ErrorCode::MalformedFile, path, "{} with {}; expected strings in quotation marks", name,
           shown(std::string_view(text).substr(i)));
    }
  }
  if (inside)
    fail(ErrorCode::MalformedFile, path, "string {} of {} has no closing quotation mark ({}); expected one",
         result.size() - 1, name, shown(result.back()));
  if (result.size() != count)
    fail(ErrorCode::MalformedFile, path, "{} strings in {}; expected {}", result.size(), name, count);
  return result;
}

/// Parses vectors such as "(1,0,0) (0,1,0) none"; nullopt for "none".
std::vector<std::optional<Eigen::VectorXd>> vectors(std::string_view text, std::size_t length, const fs::path& path) {
  std::vector<std::optional<Eigen::VectorXd>> result;
  while (!(text = trim(text)).empty()) {
    if (text.starts_with("none")) {
      result.emplace_back();
      text.remove_prefix(4);
      continue;
    }
    const std::size_t end = text.find(')');
    if (!text.starts_with('(') || end == std::string_view::npos)
      fail(ErrorCode::MalformedFile, path, "vector {}; expected '(x,y,...)' or 'none'", shown(text));
    std::string inner(text.substr(1, end - 1));
    std::replace(inner.begin(), inner.end(), ',', ' ');
    const auto parts = words(inner);
    Eigen::VectorXd vector(static_cast<Eigen::Index>(parts.size()));
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (!parse_number(parts[i], vector[static_cast<Eigen::Index>(i)]))
        fail(ErrorCode::MalformedFile, path, "vector {}; expected numbers", shown(inner));
    if (parts.size() != length)
      fail(ErrorCode::MalformedFile, path, "vector {} of {} numbers; expected {}, as the space has dimensions",
           shown(inner), parts.size(), length);
    result.emplace_back(std::move(vector));
    text.remove_prefix(end + 1);
  }
  return result;
}

/// The space of the direction vectors; dimension 0 if the header has none.
struct Space {
  std::size_t dimension = 0;
  bool anatomical = false;
  bool flip_x = false;  ///< convert to LPS by changing the sign of x
  bool flip_y = false;
};

Space read_space(const NrrdFields& fields, const fs::path& path) {
  const std::string name = lower(optional_field(fields, "space"));
  const std::string dimension = optional_field(fields, "spacedimension");
  if (name.empty() && dimension.empty()) return {};
  if (!name.empty() && !dimension.empty())
    fail(ErrorCode::MalformedFile, path, "both 'space' and 'space dimension'; expected one of them");
  Space space;
  if (name.empty()) {
    std::uint64_t value = 0;
    if (!parse_number(dimension, value) || value < 1 || value > 8)
      fail(ErrorCode::MalformedFile, path, "space dimension {}; expected 1 to 8", shown(dimension));
    space.dimension = static_cast<std::size_t>(value);
    return space;
  }
  const bool time = name.ends_with("-time") || name == "rast" || name == "last" || name == "lpst";
  space.dimension = time ? 4 : 3;
  const auto is = [&](std::string_view words, std::string_view letters) {
    return name.starts_with(words) || name == letters || name == std::string(letters) + "t";
  };
  space.flip_x = is("right-anterior-superior", "ras");
  space.flip_y = space.flip_x || is("left-anterior-superior", "las");
  space.anatomical = space.flip_y || is("left-posterior-superior", "lps");
  const bool other =
      name.starts_with("scanner-xyz") || name.starts_with("3d-right-handed") || name.starts_with("3d-left-handed");
  if (!space.anatomical && !other)
    fail(ErrorCode::MalformedFile, path, "space {}; expected one of the definition, such as 'left-posterior-superior'",
         shown(name));
  return space;
}

struct NrrdHeader {
  std::vector<std::uint64_t> sizes;
  NrrdType type{};
  std::optional<std::size_t> list_axis;  ///< axis of a list of images, read as time
  std::vector<bool> kept;                ///< by file axis: whether it is an axis of the image
  StoredSamples samples;
};

/// Classifies the axes: axes of the image, at most one list of images, and axes of components of a value.
void read_kinds(const NrrdFields& fields, NrrdHeader& header, const fs::path& path) {
  const auto kinds = words_per_axis(fields, "kinds", header.sizes.size(), path);
  for (std::size_t a = 0; a < kinds.size(); ++a) {
    const std::string& kind = kinds[a];
    const bool domain =
        kind.empty() || kind == "???" || kind == "none" || kind == "domain" || kind == "space" || kind == "time";
    const bool single = header.sizes[a] == 1;
    const bool list = kind == "list" && !single && !header.list_axis;
    if (!domain && !single && !list)
      fail(ErrorCode::UnsupportedData, path, "axis {} of kind {} with {} samples; expected one number per sample", a,
           shown(kind), header.sizes[a]);
    if (list) header.list_axis = a;
    header.kept.push_back(domain);
  }
}

/// The offset after `lines` more lines.
std::uint64_t after_lines(const fs::path& path, std::uint64_t offset, std::uint64_t lines) {
  while (lines > 0) {
    const auto bytes = read_bytes(path, offset, kLongestHeader);
    if (bytes.empty())
      fail(ErrorCode::MalformedFile, path, "{} more lines to skip at byte {}; expected them in the file", lines,
           offset);
    std::size_t used = 0;
    for (; lines > 0 && used < bytes.size(); ++used)
      if (bytes[used] == '\n') --lines;
    offset += used;
  }
  return offset;
}

Encoding read_nrrd_encoding(const NrrdFields& fields, const fs::path& path) {
  const std::string name = lower(required(fields, "encoding", path));
  if (name == "raw") return Encoding::raw;
  if (name == "gz" || name == "gzip") return Encoding::deflate;
  if (name == "txt" || name == "text" || name == "ascii") return Encoding::text;
  if (name == "hex") return Encoding::hex;
  fail(ErrorCode::UnsupportedFormat, path, "encoding {}; expected raw, gzip, ascii or hex", shown(name));
}

/// Whether samples are not in this machine's byte order.
bool read_byte_order(const NrrdFields& fields, const NrrdHeader& header, const fs::path& path) {
  if (header.type.bytes == 1 || header.samples.encoding == Encoding::text) return false;
  const std::string& order = required(fields, "endian", path);
  if (lower(order) != "little" && lower(order) != "big")
    fail(ErrorCode::MalformedFile, path, "endian {}; expected 'little' or 'big'", shown(order));
  return (lower(order) == "big") != (std::endian::native == std::endian::big);
}

/// Sets the offset of the samples, after the lines and bytes to skip.
void skip_to_samples(const NrrdFields& fields, StoredSamples& samples, const fs::path& path) {
  std::uint64_t lines = 0;
  std::int64_t bytes = 0;
  const std::string line_skip = optional_field(fields, "lineskip");
  const std::string byte_skip = optional_field(fields, "byteskip");
  constexpr std::uint64_t kMostLines = 1000;
  if (!line_skip.empty() && (!parse_number(line_skip, lines) || lines > kMostLines))
    fail(ErrorCode::MalformedFile, path, "line skip {}; expected 0 to {}", shown(line_skip), kMostLines);
  if (!byte_skip.empty() && (!parse_number(byte_skip, bytes) || bytes < -1))
    fail(ErrorCode::MalformedFile, path, "byte skip {}; expected -1 or more", shown(byte_skip));
  samples.offset = after_lines(samples.path, samples.offset, lines);
  if (bytes == -1) {  // -1: the samples end at the end of the file
    if (samples.encoding != Encoding::raw)
      fail(ErrorCode::MalformedFile, path, "byte skip -1 with encoding {}; expected it with raw only",
           shown(required(fields, "encoding", path)));
    const std::uint64_t size = size_of_file(samples.path);
    const std::uint64_t needed = checked_bytes(samples.sizes, bytes_of_type(samples.type), path);
    samples.offset = std::max(samples.offset, size - std::min(size, needed));
  } else if (samples.encoding == Encoding::deflate) {  // skips decompressed bytes
    samples.skip = static_cast<std::uint64_t>(bytes);
  } else {
    samples.offset += static_cast<std::uint64_t>(bytes);
  }
}

void locate_data(const Text& text, NrrdHeader& header, bool allow_outside_paths, const fs::path& path) {
  StoredSamples& samples = header.samples;
  samples.type = header.type.name;
  samples.sizes = header.sizes;
  samples.encoding = read_nrrd_encoding(text.fields, path);
  samples.swapped = read_byte_order(text.fields, header, path);
  const std::string file = optional_field(text.fields, "datafile");
  if (file.empty() && !text.has_blank_line)
    fail(ErrorCode::MalformedFile, path, "neither a 'data file' nor data after the header (no blank line)");
  if (file.starts_with("LIST") || file.find('%') != std::string::npos)
    fail(ErrorCode::UnsupportedFormat, path, "data in several files ({}); expected one data file", shown(file));
  samples.path = file.empty() ? path : named_path(path, std::string(file), allow_outside_paths);
  samples.offset = file.empty() ? text.end : 0;
  require_readable_file(samples.path);
  skip_to_samples(text.fields, samples, path);
}

NrrdHeader parse_header(const Text& text, bool allow_outside_paths, const fs::path& path) {
  NrrdHeader header;
  header.sizes = read_nrrd_sizes(text.fields, path);
  header.type = read_nrrd_type(text.fields, path);
  checked_bytes(header.sizes, header.type.bytes, path);
  read_kinds(text.fields, header, path);
  locate_data(text, header, allow_outside_paths, path);
  return header;
}

/// The centering of each axis of the file, "cell" or "node"; empty: not given.
std::vector<std::string> centerings_of(const NrrdFields& fields, std::size_t axes, const fs::path& path) {
  return words_per_axis(fields, fields.contains("centers") ? "centers" : "centerings", axes, path);
}

/// Whether the samples of all axes of an image are at the centres of cells.
bool are_cells(const NrrdFields& fields, const NrrdHeader& header, const fs::path& path) {
  const auto centers = centerings_of(fields, header.sizes.size(), path);
  for (std::size_t a = 0; a < centers.size(); ++a)
    if (header.sizes[a] > 1 && (!header.list_axis || *header.list_axis != a) && centers[a] != "cell") return false;
  return true;
}

/// Steps and origins of axes without directions: from spacings, else from the range of the axis.
void scalar_geometry(const NrrdFields& fields, NrrdHeader& header, std::vector<double>& steps,
                     std::vector<double>& origins, const fs::path& path) {
  const std::size_t n = header.sizes.size();
  steps = per_axis(fields, "spacings", n, path);
  origins = per_axis(fields, "axismins", n, path);
  const auto ends = per_axis(fields, "axismaxs", n, path);
  const auto centers = centerings_of(fields, n, path);
  for (std::size_t a = 0; a < n; ++a) {
    const bool cell = centers[a] == "cell";
    const double intervals = static_cast<double>(header.sizes[a]) - (cell ? 0.0 : 1.0);
    if (!std::isfinite(steps[a])) steps[a] = (ends[a] - origins[a]) / intervals;
    if (!std::isfinite(steps[a]) || steps[a] == 0.0) steps[a] = 1.0;
    origins[a] = std::isfinite(origins[a]) ? origins[a] + (cell ? 0.5 * steps[a] : 0.0) : 0.0;
  }
}

/// Fills the affine from the space directions of the axes. If fewer axes have directions than the space has dimensions,
/// the image is a plane or line in it, and its axes get lengths only. Returns whether directions were used, so the grid
/// is in the frame of the space.
bool spatial_geometry(const NrrdFields& fields, const Space& space, const std::vector<bool>& kept,
                      Eigen::MatrixXd& affine, Eigen::VectorXd& offset, const fs::path& path) {
  const auto directions = vectors(required(fields, "spacedirections", path), space.dimension, path);
  const auto origins = vectors(optional_field(fields, "spaceorigin"), space.dimension, path);
  if (directions.size() != kept.size())
    fail(ErrorCode::MalformedFile, path, "{} space directions; expected one for each of the {} axes", directions.size(),
         kept.size());
  std::vector<Eigen::Index> columns;
  std::vector<Eigen::VectorXd> spatial;
  Eigen::Index column = 0;
  for (std::size_t a = 0; a < kept.size(); ++a) {
    if (kept[a] && directions[a]) {
      columns.push_back(column);
      spatial.push_back(*directions[a]);
    }
    if (kept[a]) ++column;
  }
  if (columns.size() > space.dimension)
    fail(ErrorCode::MalformedFile, path, "{} space directions; expected at most {}, as the space has dimensions",
         columns.size(), space.dimension);
  const bool full = columns.size() == space.dimension;
  Eigen::VectorXd origin = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(space.dimension));
  if (!origins.empty() && origins[0] && origins[0]->allFinite()) origin = *origins[0];
  const auto flip = [&](Eigen::VectorXd& v) {
    if (space.flip_x) v[0] = -v[0];
    if (space.flip_y) v[1] = -v[1];
  };
  flip(origin);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    flip(spatial[i]);
    if (!full) affine(columns[i], columns[i]) = spatial[i].norm();
    for (std::size_t r = 0; full && r < columns.size(); ++r)
      affine(columns[r], columns[i]) = spatial[i][static_cast<Eigen::Index>(r)];
    offset[columns[i]] = full ? origin[static_cast<Eigen::Index>(i)] : 0.0;
  }
  return full;
}

/// Sets names and units of the image's axes.
void label_axes(const NrrdFields& fields, const NrrdHeader& header, const Space& space, RawGrid& grid,
                const fs::path& path) {
  const auto labels = quoted_strings(fields, "labels", header.sizes.size(), path);
  const auto units = quoted_strings(fields, "units", header.sizes.size(), path);
  const auto space_units = quoted_strings(fields, "spaceunits", space.dimension, path);
  const auto directions =
      vectors(space.dimension > 0 ? required(fields, "spacedirections", path) : "", space.dimension, path);
  std::size_t axis = 0;
  std::size_t row = 0;
  for (std::size_t a = 0; a < header.sizes.size(); ++a) {
    if (!header.kept[a]) continue;
    Axis& target = grid.axes[axis++];
    target.name = labels[a];
    target.unit = units[a];
    if (a >= directions.size() || !directions[a] || row >= space.dimension) continue;
    if (target.unit.empty()) target.unit = space_units[row];
    // All programs that write anatomical spaces use millimetres.
    if (target.unit.empty() && space.anatomical && row < 3) target.unit = "mm";
    ++row;
  }
  if (header.list_axis) {
    grid.axes.back().name = labels[*header.list_axis].empty() ? "t" : labels[*header.list_axis];
    grid.axes.back().unit = units[*header.list_axis];
  }
}

/// Validates fields that do not affect samples or coordinates.
void require_sound_rest(const NrrdFields& fields, const NrrdHeader& header, const Space& space, const fs::path& path) {
  per_axis(fields, "thicknesses", header.sizes.size(), path);
  for (const char* name : {"min", "max", "oldmin", "oldmax"}) {
    double value = 0;
    const std::string text = optional_field(fields, name);
    if (!text.empty() && !parse_number(text, value))
      fail(ErrorCode::MalformedFile, path, "{} {}; expected a number", name, shown(text));
  }
  const std::string frame = optional_field(fields, "measurementframe");
  if (frame.empty()) return;
  if (const auto count = vectors(frame, space.dimension, path).size(); count != space.dimension)
    fail(ErrorCode::MalformedFile, path, "measurement frame of {} vectors; expected {}, as the space has dimensions",
         count, space.dimension);
}

RawGrid make_grid(const NrrdFields& fields, NrrdHeader& header, std::string& frame, const fs::path& path) {
  // geometry without directions
  std::vector<double> steps;
  std::vector<double> origins;
  scalar_geometry(fields, header, steps, origins, path);
  // order of the axes
  std::vector<std::size_t> order;  // file axes in the order of the image's axes
  for (std::size_t a = 0; a < header.kept.size(); ++a)
    if (header.kept[a]) order.push_back(a);
  if (header.list_axis) order.push_back(*header.list_axis);
  const auto n = static_cast<Eigen::Index>(order.size());
  Eigen::MatrixXd affine = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd offset(n);
  std::vector<std::size_t> sizes;
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t a = order[static_cast<std::size_t>(i)];
    sizes.push_back(static_cast<std::size_t>(header.sizes[a]));
    affine(i, i) = steps[a];
    offset[i] = origins[a];
  }
  // directions
  const Space space = read_space(fields, path);
  if (space.dimension > 0 && spatial_geometry(fields, space, header.kept, affine, offset, path) && space.anatomical)
    frame = "LPS";
  RawGrid grid = affine_grid(sizes, affine, offset, path);
  // names, units, other fields
  label_axes(fields, header, space, grid, path);
  name_axes(grid);
  require_sound_rest(fields, header, space, path);
  return grid;
}

}  // namespace

StoredImage open_nrrd(const fs::path& path, bool allow_outside_paths) {
  const Text text = read_header_text(path);
  NrrdHeader header = parse_header(text, allow_outside_paths, path);
  StoredImage image;
  image.grid = make_grid(text.fields, header, image.info.world_frame, path);
  image.info.format = "NRRD";
  image.info.samples_are_cells = are_cells(text.fields, header, path);
  image.info.lattice = lattice_of_text(optional_field(text.fields, kLatticeKey), path);
  image.info.stored_type = parse_value_type(header.type.name);
  image.info.value_unit = optional_field(text.fields, "sampleunits");
  std::erase(image.info.value_unit, '"');
  image.info.value_name = optional_field(text.fields, "content");
  image.samples = std::move(header.samples);
  const auto is_long = [](std::uint64_t size) { return size > 1; };
  if (header.list_axis && std::any_of(header.sizes.begin() + static_cast<std::ptrdiff_t>(*header.list_axis) + 1,
                                      header.sizes.end(), is_long))
    image.list_axis = header.list_axis;
  return image;
}

}  // namespace tegl::io_detail
