// SPDX-License-Identifier: BSD-3-Clause
//
// Reads triangles and lines of glTF 2.0 files: all meshes of the scene, transformed by their nodes. Materials, skins,
// animation and compressed buffers are not read.
//
// A small file can describe a large result: deeply nested JSON, several buffers of the same bytes, primitives with many
// instances. So nesting is limited before the text is parsed, buffers are views of one copy, and the mesh is counted
// before it is made.
//
// Based on: Khronos, "glTF 2.0 Specification" (ISO/IEC 12113:2022), sections 3.5 to 3.7 and 4.4.
#include "meshes/gltf_reader.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <deque>
#include <limits>
#include <map>
#include <optional>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "base/common.hpp"
#include "base/mesh_data.hpp"
#include "base/named_path.hpp"
#include "meshes/attributes.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::json;
using Bytes = std::vector<unsigned char>;

constexpr int kDeepest = 64;          ///< maximum depth of the node tree
constexpr std::size_t kNested = 256;  ///< maximum nesting of JSON arrays and objects; extras hold anything

/// Whether brackets and braces outside of strings are nested deeper than `kNested`.
bool is_nested_too_deeply(std::span<const unsigned char> text) {
  std::size_t depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const unsigned char c = text[i];
    if (in_string && c == '\\')
      ++i;
    else if (c == '"')
      in_string = !in_string;
    else if (!in_string && (c == '[' || c == '{') && ++depth > kNested)
      return true;
    else if (!in_string && (c == ']' || c == '}') && depth > 0)
      --depth;
  }
  return false;
}

std::uint32_t word_at(std::span<const unsigned char> bytes, std::size_t offset) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + offset, sizeof(value));
  return value;
}

std::optional<Bytes> decoded_base64(std::string_view text) {
  Bytes bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t group = 0;
  int bits = 0;
  while (text.ends_with('=')) text.remove_suffix(1);
  for (const char c : text) {
    const int digit = c >= 'A' && c <= 'Z'   ? c - 'A'
                      : c >= 'a' && c <= 'z' ? c - 'a' + 26
                      : c >= '0' && c <= '9' ? c - '0' + 52
                      : c == '+'             ? 62
                      : c == '/'             ? 63
                                             : -1;
    if (digit < 0) return std::nullopt;
    group = group << 6 | static_cast<std::uint32_t>(digit);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<unsigned char>(group >> bits));
  }
  return bytes;
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/// Decodes the escapes of a URI, such as %20; other percent signs stay.
std::string percent_decoded(std::string_view uri) {
  std::string result;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const int high = uri[i] == '%' && i + 2 < uri.size() ? hex_digit(uri[i + 1]) : -1;
    const int low = high >= 0 ? hex_digit(uri[i + 2]) : -1;
    result += low >= 0 ? static_cast<char>(high << 4 | low) : uri[i];
    if (low >= 0) i += 2;
  }
  return result;
}

/// The scheme of a URI, "http" for "http://x": letters, digits and "+-." before a colon (RFC 3986, section 3.1); empty
/// without one.
std::string_view scheme_of(std::string_view uri) {
  const std::size_t colon = uri.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789+-.");
  return colon != std::string_view::npos && uri[colon] == ':' ? uri.substr(0, colon) : std::string_view();
}

/// The data of an accessor, checked to lie within its buffer.
struct View {
  std::span<const unsigned char> bytes;
  std::size_t stride = 0;
  std::size_t count = 0;
  int component = 0;
};

class GltfReader {
 public:
  GltfReader(const fs::path& path, ReadProgress& progress, bool allow_outside_paths)
      : path_(path), progress_(progress), allow_outside_paths_(allow_outside_paths) {}

  Mesh run() {
    read_container();
    read_buffers();
    mesh_.space_dim = 3;
    mesh_.dim = 0;
    count_scene();
    read_scene();
    // If a primitive has no normals, all normals are dropped.
    if (mesh_.normals.size() != mesh_.coordinates.size()) mesh_.normals.clear();
    take_attributes();
    read_extras();
    if (mesh_.dim == 0) mesh_.dim = 2;
    return std::move(mesh_);
  }

 private:
  template <class... Args>
  [[noreturn]] void malformed(fmt::format_string<Args...> format, Args&&... args) const {
    fail(ErrorCode::MalformedFile, path_, format, std::forward<Args>(args)...);
  }

  void read_container() {
    file_ = read_bytes(path_, 0, static_cast<std::size_t>(size_of_file(path_)));
    const std::span<const unsigned char> all = file_;
    std::span<const unsigned char> text = all;
    if (all.size() >= 4 && std::memcmp(all.data(), "glTF", 4) == 0) {
      if (all.size() < 20 || word_at(all, 4) != 2) malformed("not glTF 2.0: expected version 2 after 'glTF'");
      const std::size_t json_bytes = word_at(all, 12);
      if (json_bytes > all.size() - 20) malformed("JSON of {} bytes in a file of {}", json_bytes, all.size());
      text = text.subspan(20, json_bytes);
      const std::size_t next = 20 + json_bytes;
      if (all.size() - next >= 8) {
        const std::size_t count = word_at(all, next);
        if (count > all.size() - next - 8)
          malformed("binary part of {} bytes; expected at most {}", count, all.size() - next - 8);
        binary_ = all.subspan(next + 8, count);
      }
    }
    if (is_nested_too_deeply(text)) malformed("JSON nested more than {} deep; expected at most {}", kNested, kNested);
    json_ = Json::parse(text.begin(), text.end(), nullptr, false);
    if (json_.is_discarded() || !json_.is_object()) malformed("not glTF: expected a JSON object");
    if (text_at(member(json_, "asset"), "version").substr(0, 2) != "2.")
      malformed("not glTF 2.0: asset.version is missing or different");
    require_no_extensions();
  }

  void require_no_extensions() const {
    const Json& extensions = member(json_, "extensionsRequired");
    if (extensions.is_null() || (extensions.is_array() && extensions.empty())) return;
    if (!extensions.is_array()) malformed("'extensionsRequired' is not a list; expected names");
    constexpr std::size_t kShown = 8;
    std::string names;
    for (std::size_t i = 0; i < std::min(kShown, extensions.size()); ++i) {
      constexpr std::size_t kLongest = 64;
      if (!extensions[i].is_string()) malformed("'extensionsRequired' has an item that is not text; expected names");
      names += (i == 0 ? "'" : ", '") + extensions[i].get_ref<const std::string&>().substr(0, kLongest) + "'";
    }
    fail(ErrorCode::UnsupportedData, path_, "needs {} extensions ({}{}); expected none", extensions.size(), names,
         extensions.size() > kShown ? ", ..." : "");
  }

  /// A member of an object; null if there is none.
  static const Json& member(const Json& object, const char* name) {
    static const Json kNull;
    if (!object.is_object()) return kNull;
    const auto found = object.find(name);
    return found == object.end() ? kNull : *found;
  }
  static std::string text_at(const Json& object, const char* name) {
    const Json& value = member(object, name);
    return value.is_string() ? value.get<std::string>() : std::string();
  }
  /// A non-negative integer; `absent` if there is no such member.
  [[nodiscard]] std::size_t number_at(const Json& object, const char* name, std::optional<std::size_t> absent) const {
    const Json& value = member(object, name);
    if (value.is_null() && absent) return *absent;
    if (!value.is_number_unsigned()) malformed("'{}' is missing or not a whole number", name);
    return value.get<std::size_t>();
  }
  [[nodiscard]] const Json& element(const char* array, std::size_t index) const {
    const Json& list = member(json_, array);
    if (!list.is_array() || index >= list.size()) malformed("{} number {} does not exist", array, index);
    return list[index];
  }

  void read_buffers() {
    const Json& list = member(json_, "buffers");
    all_bytes_ = file_.size();
    for (std::size_t i = 0; list.is_array() && i < list.size(); ++i) {
      const Json& uri = member(list[i], "uri");
      const std::size_t length = number_at(list[i], "byteLength", std::nullopt);
      const bool is_binary = !uri.is_string() || uri.get_ref<const std::string&>().empty();
      buffers_.push_back(is_binary ? binary_ : buffer_of(uri.get_ref<const std::string&>()));
      if (buffers_.back().size() < length)
        malformed("buffer {} of {} bytes; expected {}", i, buffers_.back().size(), length);
    }
  }

  /// The bytes of a data URI or a file. A file is read once for all buffers that name it.
  [[nodiscard]] std::span<const unsigned char> buffer_of(const std::string& uri) {
    const std::string_view scheme = scheme_of(uri);
    if (scheme.empty()) {
      const fs::path file = named_path(path_, percent_decoded(uri), allow_outside_paths_);
      require_readable_file(file);
      const auto [found, is_new] = files_.try_emplace(fs::canonical(file));
      if (is_new) {
        found->second = read_bytes(file, 0, static_cast<std::size_t>(size_of_file(file)));
        all_bytes_ += found->second.size();
      }
      return found->second;
    }
    if (lower(scheme) != "data")
      fail(ErrorCode::UnsupportedData, path_, "buffer at the URI {}; expected a relative path or a data URI",
           shown(uri));
    constexpr std::string_view kMark = ";base64,";
    const std::size_t mark = uri.find(kMark);
    auto bytes =
        mark == std::string::npos ? std::nullopt : decoded_base64(std::string_view(uri).substr(mark + kMark.size()));
    if (!bytes) malformed("data URI that is not base64");
    return decoded_.emplace_back(std::move(*bytes));
  }

  [[nodiscard]] View view_of(std::size_t accessor_index, std::size_t components) const {
    const Json& accessor = element("accessors", accessor_index);
    if (accessor.contains("sparse")) fail(ErrorCode::UnsupportedData, path_, "sparse accessor; expected a dense one");
    const Json& buffer_view = element("bufferViews", number_at(accessor, "bufferView", std::nullopt));
    const std::size_t buffer = number_at(buffer_view, "buffer", std::nullopt);
    if (buffer >= buffers_.size()) malformed("buffers number {} does not exist", buffer);
    View view;
    view.component = static_cast<int>(number_at(accessor, "componentType", std::nullopt) & 0xffff);
    const std::size_t component_bytes = view.component == 5121 ? 1 : view.component == 5123 ? 2 : 4;
    const std::size_t item = components * component_bytes;
    view.count = number_at(accessor, "count", std::nullopt);
    view.stride = number_at(buffer_view, "byteStride", item);
    const std::size_t offset = number_at(buffer_view, "byteOffset", 0);
    const std::size_t length = number_at(buffer_view, "byteLength", std::nullopt);
    const std::size_t start = number_at(accessor, "byteOffset", 0);
    const std::size_t whole = buffers_[buffer].size();
    if (offset > whole || length > whole - offset)
      malformed("bufferView of {} bytes at {} in {}", length, offset, whole);
    const bool fits = view.count == 0 || (start <= length && item <= length - start && view.stride >= item &&
                                          (view.count - 1) <= (length - start - item) / view.stride);
    if (!fits)
      malformed("accessor {} of {} items does not fit its bufferView of {} bytes", accessor_index, view.count, length);
    view.bytes = buffers_[buffer].subspan(offset + std::min(start, length));
    return view;
  }

  /// Calls `use` with each mesh of the scene and its transformation.
  template <class Use>
  void for_each_mesh(const Use& use) {
    const Json& scenes = member(json_, "scenes");
    if (!scenes.is_array() || scenes.empty()) malformed("no scene; expected one");
    const Json& scene = element("scenes", number_at(json_, "scene", 0));
    const Json& nodes = member(scene, "nodes");
    visited_ = 0;
    for (std::size_t i = 0; nodes.is_array() && i < nodes.size(); ++i)
      visit_node(index_in(nodes, i), Eigen::Affine3d::Identity(), 0, use);
  }

  void read_scene() {
    for_each_mesh(
        [&](std::size_t mesh, const Eigen::Affine3d& place) { read_primitives(element("meshes", mesh), place); });
  }

  /// Size of a mesh's contribution to the result.
  struct MeshSize {
    std::uint64_t primitives = 0;
    std::uint64_t vertices = 0;
    std::uint64_t corners = 0;
    std::uint64_t bytes = 0;  ///< memory of all, with attributes and a time allowance per primitive
  };

  /// Counts the vertices and simplices of all instances, before any are made.
  void count_scene() {
    std::map<std::size_t, MeshSize> sizes;
    MeshSize all;
    CopyLimit limit(path_, all_bytes_);
    for_each_mesh([&](std::size_t mesh, const Eigen::Affine3d&) {
      const auto [found, is_new] = sizes.try_emplace(mesh);
      if (is_new) found->second = size_of(element("meshes", mesh));
      add_to(all.primitives, found->second.primitives);
      add_to(all.vertices, found->second.vertices);
      add_to(all.corners, found->second.corners);
      add_to(all.bytes, found->second.bytes);
    });
    limit.add(1, all.bytes,
              fmt::format("{} primitives with {} vertices and {} corners, counted in each place of their mesh,",
                          all.primitives, all.vertices, all.corners));
    if (all.vertices > std::numeric_limits<Index>::max())
      fail(ErrorCode::TooLarge, path_, "{} vertices; expected less than 2^32", all.vertices);
    mesh_.coordinates.reserve(static_cast<std::size_t>(3 * all.vertices));
    mesh_.simplices.reserve(static_cast<std::size_t>(all.corners));
  }

  /// Saturating a += b.
  static void add_to(std::uint64_t& a, std::uint64_t b) {
    if (__builtin_add_overflow(a, b, &a)) a = std::numeric_limits<std::uint64_t>::max();
  }

  [[nodiscard]] MeshSize size_of(const Json& mesh) const {
    constexpr std::uint64_t kPrimitiveBytes = 1024;  // allowance for the time of a primitive, even an empty one
    MeshSize size;
    const Json& primitives = member(mesh, "primitives");
    for (std::size_t i = 0; primitives.is_array() && i < primitives.size(); ++i) {
      const Json& attributes = member(primitives[i], "attributes");
      const std::uint64_t vertices = view_of(number_at(attributes, "POSITION", std::nullopt), 3).count;
      const bool indexed = primitives[i].contains("indices");
      const std::uint64_t corners =
          indexed ? view_of(number_at(primitives[i], "indices", std::nullopt), 1).count : vertices;
      std::uint64_t numbers = 3;
      for (const auto& [semantic, accessor] : attributes.items())
        numbers += semantic.starts_with('_') ? 4 : semantic == "NORMAL" ? 3 : 0;
      // A buffer has at least a byte for each vertex and corner, so products do not exceed 64 bits.
      ++size.primitives;
      add_to(size.vertices, vertices);
      add_to(size.corners, corners);
      add_to(size.bytes, kPrimitiveBytes + vertices * numbers * sizeof(double) + corners * sizeof(Index));
    }
    return size;
  }

  [[nodiscard]] std::size_t index_in(const Json& list, std::size_t i) const {
    if (!list[i].is_number_unsigned()) malformed("list of nodes with other items; expected whole numbers");
    return list[i].get<std::size_t>();
  }

  template <std::size_t Count>
  [[nodiscard]] std::optional<std::array<double, Count>> numbers_at(const Json& object, const char* name) const {
    const Json& list = member(object, name);
    if (list.is_null()) return std::nullopt;
    std::array<double, Count> result;
    if (!list.is_array() || list.size() != Count) malformed("'{}' of a node; expected {} numbers", name, Count);
    for (std::size_t i = 0; i < Count; ++i) {
      if (!list[i].is_number()) malformed("'{}' of a node; expected {} numbers", name, Count);
      result[i] = list[i].get<double>();
    }
    return result;
  }

  [[nodiscard]] Eigen::Affine3d placement(const Json& node) const {
    Eigen::Affine3d result = Eigen::Affine3d::Identity();
    if (const auto matrix = numbers_at<16>(node, "matrix")) {
      result.matrix() = Eigen::Map<const Eigen::Matrix4d>(matrix->data());
      return result;
    }
    if (const auto t = numbers_at<3>(node, "translation")) result.translate(Eigen::Vector3d(t->data()));
    if (const auto q = numbers_at<4>(node, "rotation"))
      result.rotate(Eigen::Quaterniond((*q)[3], (*q)[0], (*q)[1], (*q)[2]));
    if (const auto s = numbers_at<3>(node, "scale")) result.scale(Eigen::Vector3d(s->data()));
    return result;
  }

  template <class Use>
  void visit_node(std::size_t index, const Eigen::Affine3d& parent, int depth, const Use& use) {
    // The specification requires a forest. A cycle would never end, and shared nodes would multiply.
    const std::size_t nodes = member(json_, "nodes").size();
    if (depth > kDeepest || ++visited_ > nodes) malformed("nodes that do not form a tree, or deeper than {}", kDeepest);
    const Json& node = element("nodes", index);
    const Eigen::Affine3d here = parent * placement(node);
    if (node.contains("mesh")) use(number_at(node, "mesh", std::nullopt), here);
    const Json& children = member(node, "children");
    for (std::size_t i = 0; children.is_array() && i < children.size(); ++i)
      visit_node(index_in(children, i), here, depth + 1, use);
  }

  void read_primitives(const Json& mesh, const Eigen::Affine3d& place) {
    const Json& primitives = member(mesh, "primitives");
    for (std::size_t i = 0; primitives.is_array() && i < primitives.size(); ++i) {
      constexpr std::size_t kLines = 1;
      constexpr std::size_t kTriangles = 4;
      const std::size_t mode = number_at(primitives[i], "mode", kTriangles);
      const int dim = mode == kLines ? 1 : 2;
      if (mode != kLines && mode != kTriangles)
        fail(ErrorCode::UnsupportedData, path_, "primitive of mode {}; expected 1 (lines) or 4 (triangles)", mode);
      if (mesh_.dim != 0 && mesh_.dim != dim)
        fail(ErrorCode::UnsupportedData, path_, "both lines and triangles; expected one of them");
      mesh_.dim = dim;
      read_primitive(primitives[i], place);
    }
  }

  void read_primitive(const Json& primitive, const Eigen::Affine3d& place) {
    const auto first = static_cast<std::size_t>(mesh_.coordinates.size() / 3);
    // vertices
    const Json& attributes = member(primitive, "attributes");
    const View points =
        vectors(attributes, "POSITION", mesh_.coordinates, [&](const Eigen::Vector3d& point) -> Eigen::Vector3d {
          return place.matrix().isIdentity(0.0) ? point : place * point;  // 0 times inf is nan
        });
    if (attributes.contains("NORMAL")) read_normals(attributes, place, points.count);
    read_attributes(attributes, points.count);
    // simplices
    const std::size_t corners = static_cast<std::size_t>(mesh_.dim) + 1;
    const bool indexed = primitive.contains("indices");
    View indices;
    if (indexed) indices = view_of(number_at(primitive, "indices", std::nullopt), 1);
    const std::size_t count = indexed ? indices.count : points.count;
    if (count % corners != 0) malformed("{} vertex numbers; expected a multiple of {}", count, corners);
    if (first + points.count > std::numeric_limits<Index>::max())
      fail(ErrorCode::TooLarge, path_, "{} vertices; expected less than 2^32", first + points.count);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t vertex = indexed ? index_value(indices, i) : i;
      if (vertex >= points.count) malformed("vertex number {}; expected less than {}", vertex, points.count);
      mesh_.simplices.push_back(static_cast<Index>(first + vertex));
      progress_.add_rows(i, sizeof(Index));
    }
  }

  /// Appends the vectors of an attribute, each transformed by `map`.
  template <class Map>
  View vectors(const Json& attributes, const char* name, MeshArray<double>& to, const Map& map) const {
    const View view = view_of(number_at(attributes, name, std::nullopt), 3);
    constexpr int kFloat = 5126;
    if (view.component != kFloat) malformed("{} of component type {}; expected {}", name, view.component, kFloat);
    for (std::size_t v = 0; v < view.count; ++v) {
      std::array<float, 3> raw;
      std::memcpy(raw.data(), view.bytes.data() + v * view.stride, sizeof(raw));
      const Eigen::Vector3d mapped = map(Eigen::Vector3d(raw[0], raw[1], raw[2]));
      to.insert(to.end(), mapped.begin(), mapped.end());
      progress_.add_rows(v, sizeof(raw));
    }
    return view;
  }

  void read_normals(const Json& attributes, const Eigen::Affine3d& place, std::size_t points) {
    const Eigen::Matrix3d linear = place.linear();
    // The cofactor matrix is the inverse transpose up to a factor, and exists for singular matrices too.
    Eigen::Matrix3d cofactors;
    for (int a = 0; a < 3; ++a) cofactors.col(a) = linear.col((a + 1) % 3).cross(linear.col((a + 2) % 3));
    if (linear.determinant() < 0) cofactors = -cofactors;
    const View view =
        vectors(attributes, "NORMAL", mesh_.normals, [&](const Eigen::Vector3d& normal) -> Eigen::Vector3d {
          return linear.isIdentity(0.0) ? normal : (cofactors * normal).stableNormalized();
        });
    if (view.count != points) malformed("{} normals of {} positions", view.count, points);
  }

  /// Reads application-specific attributes of floats, whose names start with an underscore (section 3.7.2.1).
  void read_attributes(const Json& attributes, std::size_t points) {
    constexpr std::size_t kFloat = 5126;
    constexpr std::array<std::string_view, 4> kTypes = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    for (const auto& [semantic, accessor] : attributes.items()) {
      if (!semantic.starts_with('_')) continue;
      const std::size_t index = number_at(attributes, semantic.c_str(), std::nullopt);
      const Json& description = element("accessors", index);
      const auto type = std::ranges::find(kTypes, text_at(description, "type"));
      if (type == kTypes.end() || number_at(description, "componentType", std::nullopt) != kFloat) continue;
      const auto width = static_cast<std::size_t>(type - kTypes.begin()) + 1;
      const View view = view_of(index, width);
      if (view.count != points) malformed("{} values of {} for {} positions", view.count, semantic, points);
      const auto [known, is_new] = semantics_.try_emplace(semantic, attributes_.size());
      const std::size_t place = known->second;
      if (is_new) attributes_.push_back({semantic.substr(1), "", static_cast<int>(width), {}});
      if (attributes_[place].width != static_cast<int>(width)) continue;
      for (std::size_t v = 0; v < view.count; ++v) {
        std::array<float, 4> raw;
        std::memcpy(raw.data(), view.bytes.data() + v * view.stride, width * sizeof(float));
        attributes_[place].values.insert(attributes_[place].values.end(), raw.begin(),
                                         raw.begin() + static_cast<std::ptrdiff_t>(width));
        progress_.add_rows(v, width * sizeof(float));
      }
    }
  }

  /// Keeps the attributes that all primitives have; names, units and order are from the extras of the first mesh.
  void take_attributes() {
    const auto is_whole = [&](const Attribute& attribute) {
      return attribute.values.size() == mesh_.coordinates.size() / 3 * static_cast<std::size_t>(attribute.width);
    };
    // attributes of the writer, in its order
    FileNames names({});
    std::vector<bool> taken(attributes_.size(), false);
    const Json& meshes = member(json_, "meshes");
    const Json& first = meshes.is_array() && !meshes.empty() ? meshes[0] : meshes;
    for (const Json& text : member(member(member(first, "extras"), "tegl"), "attributes")) {
      const auto found = semantics_.find(text_at(text, "semantic"));
      if (found == semantics_.end() || taken[found->second] || !is_whole(attributes_[found->second])) continue;
      taken[found->second] = true;
      mesh_.vertex_attributes.push_back(std::move(attributes_[found->second]));
      Attribute& attribute = mesh_.vertex_attributes.back();
      if (const std::string name = text_at(text, "name"); !name.empty()) attribute.name = name;
      attribute.name = names.make(attribute.name);
      attribute.unit = text_at(text, "unit");
    }
    // other attributes
    for (std::size_t i = 0; i < attributes_.size(); ++i) {
      if (taken[i] || !is_whole(attributes_[i])) continue;
      attributes_[i].name = names.make(attributes_[i].name.empty() ? "_" : attributes_[i].name);
      mesh_.vertex_attributes.push_back(std::move(attributes_[i]));
    }
  }

  [[nodiscard]] std::size_t index_value(const View& view, std::size_t i) const {
    const unsigned char* at = view.bytes.data() + i * view.stride;
    switch (view.component) {
      case 5121:
        return *at;
      case 5123:
        return static_cast<std::size_t>(at[0] | at[1] << 8);
      case 5125:
        return word_at(view.bytes, i * view.stride);
      default:
        malformed("indices of component type {}; expected 5121, 5123 or 5125", view.component);
    }
  }

  /// Reads the extras of the writer: whether the mesh is planar, names and units.
  void read_extras() {
    const Json& extras = member(member(member(json_, "asset"), "extras"), "tegl");
    if (!extras.is_object()) return;
    const auto texts = [&](const char* name) {
      std::vector<std::string> result;
      for (const Json& value : member(extras, name))
        result.push_back(value.is_string() ? value.get<std::string>() : "");
      return result;
    };
    mesh_.axis_names = texts("axis_names");
    mesh_.axis_units = texts("axis_units");
    if (const Json& isovalue = member(extras, "isovalue"); isovalue.is_number())
      mesh_.isovalue = isovalue.get<double>();
    const Json& dim = member(extras, "dim");
    if (mesh_.dim == 0 && dim.is_number_integer()) mesh_.dim = dim.get<int>() == 1 ? 1 : 2;
    const Json& space_dim = member(extras, "space_dim");
    if (space_dim.is_number_integer() && space_dim.get<int>() == 2) flatten(mesh_, path_);
    for (auto* const axis_texts : {&mesh_.axis_names, &mesh_.axis_units})
      if (!axis_texts->empty()) axis_texts->resize(static_cast<std::size_t>(mesh_.space_dim));
  }

  fs::path path_;
  ReadProgress& progress_;
  bool allow_outside_paths_;
  Json json_;
  Bytes file_;
  std::map<fs::path, Bytes> files_;                      ///< other files, by path
  std::deque<Bytes> decoded_;                            ///< decoded data URIs
  std::span<const unsigned char> binary_;                ///< view into file_
  std::vector<std::span<const unsigned char>> buffers_;  ///< views into file_, files_ and decoded_
  std::uint64_t all_bytes_ = 0;                          ///< size of file_ and files_
  std::size_t visited_ = 0;
  std::vector<Attribute> attributes_;             ///< of all primitives so far, named as in the file
  std::map<std::string, std::size_t> semantics_;  ///< index of each, by its name with the underscore
  Mesh mesh_;
};

}  // namespace

Mesh read_gltf(const fs::path& path, ReadProgress& progress, bool allow_outside_paths) {
  return GltfReader(path, progress, allow_outside_paths).run();
}

}  // namespace tegl::io_detail
