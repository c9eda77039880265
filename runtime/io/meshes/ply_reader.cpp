// SPDX-License-Identifier: BSD-3-Clause
//
// Reads PLY in all three encodings, with any elements and properties; elements other than vertices, faces and edges are
// skipped. Every count is checked against the remaining bytes before it is used.
//
// Based on: G. Turk, "The PLY Polygon File Format", 1994.
#include "meshes/ply_reader.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "base/common.hpp"
#include "base/mesh_data.hpp"
#include "meshes/attributes.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

enum class Encoding { Ascii, LittleEndian, BigEndian };
enum class Scalar { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float, Double };

constexpr std::array<std::size_t, 8> kScalarBytes = {1, 1, 2, 2, 4, 4, 4, 8};

struct Property {
  std::string name;
  Scalar type{};
  std::optional<Scalar> count_type;  ///< for lists
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;

  [[nodiscard]] std::size_t index_of(std::string_view property) const {
    const auto found =
        std::find_if(properties.begin(), properties.end(), [&](const Property& p) { return p.name == property; });
    return static_cast<std::size_t>(found - properties.begin());
  }
};

/// One item of an element: one number per scalar property, and the numbers of one list.
struct Item {
  std::vector<double> scalars;
  std::vector<double> list;
};

std::optional<Scalar> scalar_of(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kNames = {{{"char", "int8"},
                                                                                    {"uchar", "uint8"},
                                                                                    {"short", "int16"},
                                                                                    {"ushort", "uint16"},
                                                                                    {"int", "int32"},
                                                                                    {"uint", "uint32"},
                                                                                    {"float", "float32"},
                                                                                    {"double", "float64"}}};
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (name == kNames[i].first || name == kNames[i].second) return static_cast<Scalar>(i);
  return std::nullopt;
}

/// Name and unit of an attribute from the writer's comments, by its first property.
struct AttributeText {
  std::string name;
  std::string unit;
  std::size_t width = 1;
};
using AttributeTexts = std::map<std::string, AttributeText>;

/// The attributes among the scalar properties of an element: those described by comments, and any other property by its
/// own name.
class AttributeColumns {
 public:
  /// `free`: properties without another meaning.
  AttributeColumns(const Element& element, const std::vector<bool>& free, const AttributeTexts& texts) {
    FileNames names({});
    const auto is_free = [&](std::size_t p) { return free[p] && !element.properties[p].count_type; };
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      if (!is_free(p)) continue;
      const auto found = texts.find(element.properties[p].name);
      AttributeText text = found == texts.end() ? AttributeText{} : found->second;
      if (text.name.empty()) text.name = element.properties[p].name;
      std::size_t width = 0;
      while (width < text.width && p + width < element.properties.size() && is_free(p + width)) ++width;
      columns_.push_back(p);
      attributes_.push_back({names.make(text.name), text.unit, static_cast<int>(width), {}});
      const bool is_color = text.name == kColorName && width == 3 && element.properties[p].type == Scalar::Uint8;
      units_.push_back(is_color ? 255.0 : 1.0);
      attributes_.back().values.reserve(static_cast<std::size_t>(element.count) * width);
      p += width - 1;
    }
  }
  void add(const Item& item) {
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const auto first = item.scalars.begin() + static_cast<std::ptrdiff_t>(columns_[i]);
      for (int c = 0; c < attributes_[i].width; ++c) attributes_[i].values.push_back(first[c] / units_[i]);
    }
  }
  std::vector<Attribute> take() { return std::move(attributes_); }
  /// Size of the numbers of one item in bytes.
  [[nodiscard]] std::uint64_t bytes() const {
    std::uint64_t numbers = 0;
    for (const Attribute& attribute : attributes_) numbers += static_cast<std::uint64_t>(attribute.width);
    return numbers * sizeof(double);
  }

 private:
  std::vector<std::size_t> columns_;  ///< first column of each attribute
  std::vector<Attribute> attributes_;
  std::vector<double> units_;  ///< file value that stands for 1
};

class PlyReader {
 public:
  PlyReader(const fs::path& path, ReadProgress& progress)
      : path_(path), progress_(progress), bytes_(read_bytes(path, 0, static_cast<std::size_t>(size_of_file(path)))) {}

  Mesh run() {
    read_header();
    const bool faces = declares("face");
    if (!declares("vertex") || (!faces && !declares("edge")))
      fail(ErrorCode::UnsupportedData, path_, "PLY without elements 'vertex' and 'face' or 'edge'; expected a mesh");
    mesh_.dim = faces ? 2 : 1;
    mesh_.space_dim = 3;
    for (const Element& element : elements_) read_element(element);
    if (planar_) flatten(mesh_, path_);
    mesh_.axis_names.resize(static_cast<std::size_t>(mesh_.space_dim));
    mesh_.axis_units.resize(static_cast<std::size_t>(mesh_.space_dim));
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] bool declares(std::string_view name) const {
    return std::any_of(elements_.begin(), elements_.end(), [&](const Element& e) { return e.name == name; });
  }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }

  std::string_view header_line() {
    const auto begin = bytes_.begin() + static_cast<std::ptrdiff_t>(at_);
    const auto end = std::find(begin, bytes_.end(), '\n');
    if (end == bytes_.end()) fail(ErrorCode::MalformedFile, path_, "PLY header without 'end_header'");
    const auto* text = reinterpret_cast<const char*>(bytes_.data()) + at_;
    const auto length = static_cast<std::size_t>(end - begin);
    at_ += length + 1;
    return trim(std::string_view(text, length));
  }

  void read_header() {
    if (!std::string_view(reinterpret_cast<const char*>(bytes_.data()), bytes_.size()).starts_with("ply"))
      fail(ErrorCode::MalformedFile, path_, "starts with {}; expected 'ply'",
           shown(std::span(bytes_).first(std::min<std::size_t>(4, bytes_.size()))));
    header_line();
    bool has_format = false;
    for (std::string_view line = header_line(); line != "end_header"; line = header_line()) {
      const auto parts = words(line);
      if (parts.empty() || parts[0] == "obj_info") continue;
      if (parts[0] == "comment") {
        read_comment(line, parts);
      } else if (parts[0] == "format" && parts.size() == 3) {
        read_format(parts[1]);
        has_format = true;
      } else if (parts[0] == "element" && parts.size() == 3) {
        read_element_line(line, parts);
      } else if (parts[0] == "property" && !elements_.empty()) {
        read_property(line, parts);
      } else {
        bad_line(line);
      }
    }
    if (!has_format) fail(ErrorCode::MalformedFile, path_, "PLY header without a format line");
  }

  void read_element_line(std::string_view line, const std::vector<std::string_view>& parts) {
    Element element{std::string(parts[1]), 0, {}};
    if (!parse_number(parts[2], element.count)) bad_line(line);
    if (!element_names_.insert(element.name).second)
      fail(ErrorCode::MalformedFile, path_, "two elements {}; expected each name once", shown(element.name));
    elements_.push_back(std::move(element));
    property_names_.clear();
  }

  [[noreturn]] void bad_line(std::string_view line) const {
    fail(ErrorCode::MalformedFile, path_, "PLY header line {}; expected format, comment, element or property",
         shown(line));
  }

  /// Parses the writer's comments "comment tegl space_dim 2", "comment tegl axis 0 name lon".
  void read_comment(std::string_view line, const std::vector<std::string_view>& parts) {
    if (parts.size() < 4 || parts[1] != "tegl") return;
    if (parts[2] == "vertex" || parts[2] == "simplex") read_attribute_comment(line, parts);
    if (parts[2] == "space_dim") planar_ = parts[3] == "2";
    double isovalue = 0.0;
    if (parts[2] == "isovalue" && parse_number(parts[3], isovalue) && std::isfinite(isovalue))
      mesh_.isovalue = isovalue;
    std::uint64_t axis = 0;
    if (parts.size() < 6 || parts[2] != "axis" || !parse_number(parts[3], axis) || axis > 2) return;
    auto& texts = parts[4] == "unit" ? mesh_.axis_units : mesh_.axis_names;
    texts.resize(3);
    texts[static_cast<std::size_t>(axis)] = line.substr(static_cast<std::size_t>(parts[5].data() - line.data()));
  }

  /// Parses "comment tegl vertex attribute u_0 3 u", "comment tegl vertex unit u_0 m s-1".
  void read_attribute_comment(std::string_view line, const std::vector<std::string_view>& parts) {
    auto& described = parts[2] == "vertex" ? of_vertices_ : of_simplices_;
    std::uint64_t width = 0;
    const bool is_unit = parts[3] == "unit";
    const std::size_t text = is_unit ? 5 : 6;
    if (parts.size() <= text || (!is_unit && (parts[3] != "attribute" || !parse_number(parts[5], width)))) return;
    AttributeText& it = described[std::string(parts[4])];
    (is_unit ? it.unit : it.name) = line.substr(static_cast<std::size_t>(parts[text].data() - line.data()));
    if (!is_unit) it.width = std::max<std::size_t>(1, static_cast<std::size_t>(width));
  }

  void read_format(std::string_view name) {
    if (name == "ascii")
      encoding_ = Encoding::Ascii;
    else if (name == "binary_little_endian")
      encoding_ = Encoding::LittleEndian;
    else if (name == "binary_big_endian")
      encoding_ = Encoding::BigEndian;
    else
      fail(ErrorCode::MalformedFile, path_, "PLY format {}; expected ascii, binary_little_endian or binary_big_endian",
           shown(name));
  }

  void read_property(std::string_view line, const std::vector<std::string_view>& parts) {
    const bool list = parts.size() == 5 && parts[1] == "list";
    if (!list && parts.size() != 3) bad_line(line);
    Property property{std::string(parts.back()), {}, std::nullopt};
    const auto type = scalar_of(parts[parts.size() - 2]);
    if (list) property.count_type = scalar_of(parts[2]);
    if (!type || (list && !property.count_type)) bad_line(line);
    property.type = *type;
    if (!property_names_.insert(property.name).second)
      fail(ErrorCode::MalformedFile, path_, "two properties {} of element {}; expected each name once",
           shown(property.name), shown(elements_.back().name));
    elements_.back().properties.push_back(std::move(property));
  }

  double number(Scalar type) { return encoding_ == Encoding::Ascii ? text_number() : binary_number(type); }

  double text_number() {
    const auto is_blank = [](unsigned char c) { return c <= 0x20; };
    const auto begin = std::find_if_not(bytes_.begin() + static_cast<std::ptrdiff_t>(at_), bytes_.end(), is_blank);
    const auto end = std::find_if(begin, bytes_.end(), is_blank);
    if (begin == bytes_.end()) fail(ErrorCode::MalformedFile, path_, "PLY ends at byte {}; expected numbers", at_);
    const std::string_view word(reinterpret_cast<const char*>(&*begin), static_cast<std::size_t>(end - begin));
    double value = 0;
    if (!parse_number(word, value)) fail(ErrorCode::MalformedFile, path_, "{}; expected a number", shown(word));
    at_ = static_cast<std::size_t>(end - bytes_.begin());
    return value;
  }

  template <class T>
  double load() {
    std::array<unsigned char, sizeof(T)> raw;
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(at_), sizeof(T), raw.begin());
    if (encoding_ == Encoding::BigEndian) std::reverse(raw.begin(), raw.end());
    at_ += sizeof(T);
    return static_cast<double>(std::bit_cast<T>(raw));
  }

  double binary_number(Scalar type) {
    if (left() < kScalarBytes[static_cast<std::size_t>(type)])
      fail(ErrorCode::MalformedFile, path_, "PLY ends at byte {}; expected more values", bytes_.size());
    switch (type) {
      case Scalar::Int8:
        return load<std::int8_t>();
      case Scalar::Uint8:
        return load<std::uint8_t>();
      case Scalar::Int16:
        return load<std::int16_t>();
      case Scalar::Uint16:
        return load<std::uint16_t>();
      case Scalar::Int32:
        return load<std::int32_t>();
      case Scalar::Uint32:
        return load<std::uint32_t>();
      case Scalar::Float:
        return load<float>();
      default:
        return load<double>();
    }
  }

  /// Minimum size of an item in bytes; in text a digit and a blank per number.
  [[nodiscard]] std::uint64_t least_bytes(const Element& element) const {
    std::uint64_t bytes = 0;
    for (const Property& property : element.properties)
      bytes += encoding_ == Encoding::Ascii
                   ? 2
                   : kScalarBytes[static_cast<std::size_t>(property.count_type.value_or(property.type))];
    return bytes;
  }

  void read_item(const Element& element, std::size_t list_property, Item& item) {
    const std::size_t start = at_;
    item.scalars.resize(element.properties.size());
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const Property& property = element.properties[p];
      if (!property.count_type) {
        item.scalars[p] = number(property.type);
        continue;
      }
      const double count = number(*property.count_type);
      const double most = static_cast<double>(left());  // a number takes at least a byte
      if (!(count >= 0 && count <= most) || count != std::floor(count))
        fail(ErrorCode::MalformedFile, path_, "list of {} numbers with {} bytes left", count, left());
      if (p == list_property) item.list.clear();
      for (auto i = static_cast<std::size_t>(count); i > 0; --i) {
        const double value = number(property.type);
        if (p == list_property) item.list.push_back(value);
      }
    }
    progress_.add(at_ - start);
  }

  void read_element(const Element& element) {
    const std::uint64_t least = least_bytes(element);
    if (least == 0) return;  // items without properties take no bytes
    if (element.count > (left() + 1) / least)
      fail(ErrorCode::MalformedFile, path_,
           "{} items of element '{}' take {} bytes each; expected them in the {} bytes left", element.count,
           element.name, least, left());
    if (element.name == "vertex")
      read_vertices(element);
    else if (element.name == "face" || (element.name == "edge" && mesh_.dim == 1))
      read_simplices(element);
    else
      pass_over(element);
  }

  void pass_over(const Element& element) {
    Item item;
    for (std::uint64_t i = 0; i < element.count; ++i) read_item(element, element.properties.size(), item);
  }

  void read_vertices(const Element& element) {
    const auto columns = columns_of(element, {"x", "y", "z"});
    if (!columns) fail(ErrorCode::MalformedFile, path_, "PLY vertices without x, y and z");
    const auto normal_columns = columns_of(element, {"nx", "ny", "nz"});
    mesh_.coordinates.resize(3 * static_cast<std::size_t>(element.count));
    if (normal_columns) mesh_.normals.resize(mesh_.coordinates.size());
    std::vector<bool> others(element.properties.size(), true);
    for (const std::size_t column : *columns) others[column] = false;
    for (std::size_t a = 0; a < 3 && normal_columns; ++a) others[(*normal_columns)[a]] = false;
    AttributeColumns attributes(element, others, of_vertices_);
    Item item;
    for (std::size_t v = 0; v < element.count; ++v) {
      read_item(element, element.properties.size(), item);
      for (std::size_t a = 0; a < 3; ++a) mesh_.coordinates[3 * v + a] = item.scalars[(*columns)[a]];
      for (std::size_t a = 0; a < 3 && normal_columns; ++a)
        mesh_.normals[3 * v + a] = item.scalars[(*normal_columns)[a]];
      attributes.add(item);
    }
    mesh_.vertex_attributes = attributes.take();
  }

  /// The columns of three properties by name; nullopt unless all exist.
  using Columns = std::array<std::size_t, 3>;
  static std::optional<Columns> columns_of(const Element& element, const std::array<const char*, 3>& names) {
    Columns columns;
    for (std::size_t a = 0; a < 3; ++a) {
      columns[a] = element.index_of(names[a]);
      if (columns[a] >= element.properties.size() || element.properties[columns[a]].count_type) return std::nullopt;
    }
    return columns;
  }

  Index vertex_number(double value) const {
    if (!(value >= 0 && value <= std::numeric_limits<Index>::max()) || value != std::floor(value))
      fail(ErrorCode::MalformedFile, path_, "vertex number {}; expected 0 or more", value);
    return static_cast<Index>(value);
  }

  /// Reads faces, triangulated as fans from their first vertex, or edges.
  void read_simplices(const Element& element) {
    const bool face = element.name == "face";
    // columns
    std::size_t list = element.index_of("vertex_indices");
    if (list >= element.properties.size()) list = element.index_of("vertex_index");
    const std::size_t first = element.index_of("vertex1");
    const std::size_t second = element.index_of("vertex2");
    const std::size_t count = element.properties.size();
    if (face ? list >= count || !element.properties[list].count_type : first >= count || second >= count)
      fail(ErrorCode::MalformedFile, path_, "PLY element '{}' without {}", element.name,
           face ? "a list vertex_indices" : "vertex1 and vertex2");
    std::vector<bool> others(count, true);
    if (!face) others[first] = others[second] = false;
    AttributeColumns attributes(element, others, of_simplices_);
    Item item;
    // A face has at least three numbers: the reserved memory is limited by the remaining bytes.
    const std::uint64_t simplices = face ? std::min<std::uint64_t>(element.count, left() / 3) : element.count;
    mesh_.simplices.reserve(static_cast<std::size_t>(simplices) * (face ? 3 : 2));
    CopyLimit limit(path_, bytes_.size());
    const std::uint64_t copied = attributes.bytes();
    // read and triangulate
    for (std::uint64_t i = 0; i < element.count; ++i) {
      read_item(element, list, item);
      if (!face) item.list = {item.scalars[first], item.scalars[second]};
      if (face && item.list.size() < 3)
        fail(ErrorCode::MalformedFile, path_, "face {} of {} vertices; expected 3 or more", i, item.list.size());
      if (item.list.size() > 3) limit.add(item.list.size() - 3, copied, "attributes of the triangles of polygons");
      for (std::size_t corner = face ? 2 : 1; corner < item.list.size(); ++corner) {
        mesh_.simplices.push_back(vertex_number(item.list[0]));
        if (face) mesh_.simplices.push_back(vertex_number(item.list[corner - 1]));
        mesh_.simplices.push_back(vertex_number(item.list[corner]));
        attributes.add(item);
      }
    }
    mesh_.simplex_attributes = attributes.take();
  }

  fs::path path_;
  ReadProgress& progress_;
  std::vector<unsigned char> bytes_;
  std::size_t at_ = 0;
  Encoding encoding_ = Encoding::Ascii;
  std::vector<Element> elements_;
  std::set<std::string> element_names_;
  std::set<std::string> property_names_;  ///< of the current element
  AttributeTexts of_vertices_, of_simplices_;
  Mesh mesh_;
  bool planar_ = false;
};

}  // namespace

Mesh read_ply(const fs::path& path, ReadProgress& progress) { return PlyReader(path, progress).run(); }

}  // namespace tegl::io_detail
