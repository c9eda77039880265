// SPDX-License-Identifier: BSD-3-Clause
//
// Writes glTF 2.0: .glb, and .gltf as a single file with the buffer as base64. Coordinates are float, the only type of
// the format. Axis names and the data to read the mesh back are in asset.extras. Without normals viewers shade faces
// flat, as the specification requires. Vertex attributes of up to four numbers become _NAME attributes, with names and
// units in the mesh's extras; other attributes are not supported by the format.
//
// Based on: Khronos, "glTF 2.0 Specification" (ISO/IEC 12113:2022), sections 3.6, 3.7 and 4.4.
#include "meshes/gltf_writer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "base/common.hpp"
#include "base/mesh_data.hpp"
#include "base/output_file.hpp"
#include "meshes/attributes.hpp"

namespace tegl::io_detail {

namespace {

using OrderedJson = nlohmann::ordered_json;

struct Positions {
  std::vector<std::array<float, 3>> values;
  std::vector<std::array<float, 3>> normals;  ///< one per vertex, or none
  std::array<float, 3> low{};
  std::array<float, 3> high{};
};

Positions positions(const MeshView& mesh, const std::filesystem::path& path) {
  Positions result;
  result.low.fill(std::numeric_limits<float>::infinity());
  result.high.fill(-std::numeric_limits<float>::infinity());
  result.values.resize(vertex_count(mesh));
  for (std::size_t v = 0; v < result.values.size(); ++v) {
    result.values[v] = float_position(mesh, v, path);
    for (std::size_t a = 0; a < 3; ++a) {
      result.low[a] = std::min(result.low[a], result.values[v][a]);
      result.high[a] = std::max(result.high[a], result.values[v][a]);
    }
  }
  return result;
}

/// Converts normals; glTF requires length 1, so normals of length 0 become (0, 0, 1).
std::vector<std::array<float, 3>> normals(const MeshView& mesh) {
  std::vector<std::array<float, 3>> result(mesh.normals.size() / static_cast<std::size_t>(mesh.space_dim));
  for (std::size_t v = 0; v < result.size(); ++v) {
    const auto row = normal(mesh, v);
    for (std::size_t a = 0; a < 3; ++a) result[v][a] = static_cast<float>(row[a]);
    if (row == std::array<double, 3>{}) result[v][2] = 1.0F;
  }
  return result;
}

/// A vertex attribute in a form that glTF supports, as float.
struct GltfAttribute {
  std::string semantic;
  const Attribute* attribute;
  std::vector<float> values;
};

bool is_color(const Attribute& attribute) {
  return attribute.name == kColorName && attribute.width == 3 &&
         std::all_of(attribute.values.begin(), attribute.values.end(),
                     [](double value) { return value >= 0.0 && value <= 1.0; });
}

/// Converts colours from sRGB to linear (IEC 61966-2-1), as glTF requires for vertices (section 3.7.2.1).
std::vector<float> linear(const Attribute& attribute) {
  std::vector<float> result;
  for (const double value : attribute.values)
    result.push_back(static_cast<float>(value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4)));
  return result;
}

/// Selects attributes of up to four numbers. Names start with an underscore (section 3.7.2.1) and are in capitals.
std::vector<GltfAttribute> gltf_attributes(const MeshView& mesh, const std::filesystem::path& path) {
  std::vector<GltfAttribute> result;
  FileNames names({});
  for (const Attribute& attribute : mesh.vertex_attributes) {
    constexpr int kMostNumbers = 4;
    if (attribute.width > kMostNumbers) continue;
    std::string word = as_word(attribute.name);
    for (char& c : word)
      if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    if (is_color(attribute)) result.push_back({"COLOR_0", &attribute, linear(attribute)});
    GltfAttribute& added = result.emplace_back(GltfAttribute{names.make("_" + word), &attribute, {}});
    added.values.reserve(attribute.values.size());
    for (const double value : attribute.values) {
      if (!(std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max())))
        fail(ErrorCode::UnsupportedData, path, "vertex {} has {} as '{}'; expected a value in the range of float",
             added.values.size() / static_cast<std::size_t>(attribute.width), value, attribute.name);
      added.values.push_back(static_cast<float>(value));
    }
  }
  return result;
}

/// The contents of the buffer, in their order.
struct Content {
  const MeshView& mesh;
  Positions points;
  std::vector<GltfAttribute> attributes;
};

OrderedJson asset(const MeshView& mesh) {
  OrderedJson extras = {{"dim", mesh.dim}, {"space_dim", mesh.space_dim}};
  extras["axis_names"] = mesh.axis_names;
  extras["axis_units"] = mesh.axis_units;
  if (mesh.isovalue) extras["isovalue"] = *mesh.isovalue;
  return {{"version", "2.0"}, {"generator", "tegl"}, {"extras", {{"tegl", extras}}}};
}

/// Arrays of numbers in the buffer, one after the other: each is a view of the buffer and an accessor.
class BufferArrays {
 public:
  static constexpr int kFloat = 5126;
  static constexpr int kUint32 = 5125;
  static constexpr int kVertexBuffer = 34962;
  static constexpr int kIndexBuffer = 34963;

  /// Appends an array of `count` items. Returns the number of its accessor. `limits`: "min" and "max", or empty.
  std::size_t add(int component, std::size_t count, const char* type, std::size_t bytes, int target,
                  const OrderedJson& limits = OrderedJson::object()) {
    OrderedJson accessor = {
        {"bufferView", views_.size()}, {"componentType", component}, {"count", count}, {"type", type}};
    accessor.update(limits);
    accessors_.push_back(std::move(accessor));
    views_.push_back({{"buffer", 0}, {"byteOffset", bytes_}, {"byteLength", bytes}, {"target", target}});
    bytes_ += bytes;
    return accessors_.size() - 1;
  }
  void write(OrderedJson& json) const {
    json["accessors"] = accessors_;
    json["bufferViews"] = views_;
  }

 private:
  OrderedJson accessors_ = OrderedJson::array();
  OrderedJson views_ = OrderedJson::array();
  std::size_t bytes_ = 0;
};

/// Adds vertices, simplices and normals; `primitive` refers to their accessors.
void add_geometry(const Content& content, BufferArrays& arrays, OrderedJson& primitive) {
  const auto& [mesh, points, attributes] = content;
  constexpr int kLines = 1;
  constexpr int kTriangles = 4;
  const std::size_t bytes = points.values.size() * sizeof(points.values[0]);
  const std::size_t positions = arrays.add(BufferArrays::kFloat, points.values.size(), "VEC3", bytes,
                                           BufferArrays::kVertexBuffer, {{"min", points.low}, {"max", points.high}});
  const std::size_t indices = arrays.add(BufferArrays::kUint32, mesh.simplices.size(), "SCALAR",
                                         mesh.simplices.size() * sizeof(Index), BufferArrays::kIndexBuffer);
  primitive = {{"attributes", {{"POSITION", positions}}},
               {"indices", indices},
               {"material", 0},
               {"mode", mesh.dim == 1 ? kLines : kTriangles}};
  if (!points.normals.empty())
    primitive["attributes"]["NORMAL"] =
        arrays.add(BufferArrays::kFloat, points.normals.size(), "VEC3", bytes, BufferArrays::kVertexBuffer);
}

/// Adds the vertex attributes. Returns their names and units.
OrderedJson add_attributes(const Content& content, BufferArrays& arrays, OrderedJson& primitive) {
  OrderedJson texts;
  for (const GltfAttribute& added : content.attributes) {
    constexpr std::array<const char*, 4> kTypes = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    primitive["attributes"][added.semantic] =
        arrays.add(BufferArrays::kFloat, content.points.values.size(),
                   kTypes[static_cast<std::size_t>(added.attribute->width) - 1], added.values.size() * sizeof(float),
                   BufferArrays::kVertexBuffer);
    if (!added.semantic.starts_with('_')) continue;  // COLOR_0 repeats an attribute that has its own name too
    texts.push_back({{"semantic", added.semantic}, {"name", added.attribute->name}, {"unit", added.attribute->unit}});
  }
  return texts;
}

/// The JSON document. glTF allows no empty accessor, so an empty mesh is a scene without nodes.
OrderedJson document(const Content& content, std::size_t buffer_bytes) {
  OrderedJson json = {{"asset", asset(content.mesh)}, {"scene", 0}};
  if (content.points.values.empty() || content.mesh.simplices.empty()) {
    json["scenes"] = OrderedJson::array({OrderedJson{{"name", "empty contour"}}});
    return json;
  }
  BufferArrays arrays;
  OrderedJson primitive;
  add_geometry(content, arrays, primitive);
  const OrderedJson attributes = add_attributes(content, arrays, primitive);
  OrderedJson mesh = {{"name", "contour"}, {"primitives", OrderedJson::array({primitive})}};
  if (!attributes.empty()) mesh["extras"]["tegl"]["attributes"] = attributes;
  // scene, node, mesh, material, buffer
  json["scenes"] = OrderedJson::array({OrderedJson{{"nodes", {0}}}});
  json["nodes"] = OrderedJson::array({OrderedJson{{"mesh", 0}, {"name", "contour"}}});
  json["meshes"] = OrderedJson::array({mesh});
  json["materials"] = OrderedJson::array({OrderedJson{{"name", "contour"}, {"doubleSided", true}}});
  arrays.write(json);
  json["buffers"] = OrderedJson::array({OrderedJson{{"byteLength", buffer_bytes}}});
  return json;
}

/// base64 in pieces of a multiple of 3 bytes, so the parts of the buffer can be encoded one after the other.
std::string base64(std::span<const unsigned char> bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t j = 0; j < 3; ++j) group = group << 8 | (j < count ? bytes[i + j] : 0U);
    for (std::size_t j = 0; j < 4; ++j) text += j <= count ? kDigits[group >> (18 - 6 * j) & 63] : '=';
  }
  return text;
}

template <class Range>
std::span<const unsigned char> as_raw(const Range& range) {
  return {reinterpret_cast<const unsigned char*>(range.data()), range.size() * sizeof(range[0])};
}

/// The parts of the buffer, in their order.
std::vector<std::span<const unsigned char>> buffer_parts(const Content& content) {
  std::vector<std::span<const unsigned char>> parts = {as_raw(content.points.values), as_raw(content.mesh.simplices),
                                                       as_raw(content.points.normals)};
  for (const GltfAttribute& added : content.attributes) parts.push_back(as_raw(added.values));
  return parts;
}

std::size_t buffer_size(const Content& content) {
  std::size_t bytes = 0;
  for (const auto part : buffer_parts(content)) bytes += part.size();
  return bytes;
}

std::string dumped(const OrderedJson& json) { return json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace); }

void write_text(const Content& content, OrderedJson json, OutputFile& file) {
  if (json.contains("buffers")) {
    std::vector<unsigned char> buffer;
    for (const auto part : buffer_parts(content)) buffer.insert(buffer.end(), part.begin(), part.end());
    json["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(buffer);
  }
  file.write(dumped(json));
}

void write_binary(const Content& content, const OrderedJson& json, OutputFile& file) {
  constexpr std::uint32_t kMagic = 0x46546C67;      // "glTF"
  constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
  constexpr std::uint32_t kBinChunk = 0x004E4942;   // "BIN"
  std::string text = dumped(json);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const bool has_buffer = json.contains("buffers");
  const std::uint64_t buffer_bytes = has_buffer ? buffer_size(content) : 0;
  const std::uint64_t total = 12 + 8 + text.size() + (has_buffer ? 8 + buffer_bytes : 0);
  if (total > std::numeric_limits<std::uint32_t>::max())
    fail(ErrorCode::TooLarge, file.target(), "{} bytes as .glb; expected at most 2^32 - 1 (write .ply or .vtkhdf)",
         total);
  const auto word = [&](std::uint64_t value) {
    const auto bits = static_cast<std::uint32_t>(value);
    file.write(&bits, sizeof(bits));
  };
  constexpr std::uint32_t kVersion = 2;
  for (const std::uint64_t value :
       {std::uint64_t{kMagic}, std::uint64_t{kVersion}, total, std::uint64_t{text.size()}, std::uint64_t{kJsonChunk}})
    word(value);
  file.write(text);
  if (!has_buffer) return;
  word(buffer_bytes);
  word(kBinChunk);
  for (const auto part : buffer_parts(content)) file.write_range(part);
}

}  // namespace

void write_gltf(const MeshView& mesh, const PendingPath& pending, const Progress& progress) {
  const std::filesystem::path& path = pending.target();
  OutputFile file(pending);
  Content content{mesh, positions(mesh, path), gltf_attributes(mesh, path)};
  content.points.normals = normals(mesh);
  tick(progress, 0.5, path);
  const OrderedJson json = document(content, buffer_size(content));
  if (lower_name(path).ends_with(".glb"))
    write_binary(content, json, file);
  else
    write_text(content, json, file);
  tick(progress, 1.0, path);
  file.close();
}

}  // namespace tegl::io_detail
