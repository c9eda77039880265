// SPDX-License-Identifier: BSD-3-Clause
//
// Packs the results of readers, and reads layers through a child process.
#include "process/separate_reading.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "base/common.hpp"
#include "base/inflate.hpp"
#include "base/mesh_data.hpp"
#include "base/reading_process.hpp"
#include "dicom/dicom.hpp"
#include "dicom/dicom_file.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostItems = std::size_t{1} << 32;  ///< of a list; the size of its bytes is a stricter limit

template <class Item, class Put>
void put_list(Packer& packer, const std::vector<Item>& items, const Put& put) {
  packer.number(static_cast<std::uint64_t>(items.size()));
  for (const Item& item : items) put(item);
}

/// Each item takes at least a byte, so a list is not longer than the package.
template <class Item, class Get>
void get_list(Unpacker& unpacker, std::vector<Item>& items, const Get& get) {
  const std::size_t count = unpacker.count(kMostItems);
  items.clear();
  for (std::size_t i = 0; i < count; ++i) items.push_back(get());
}

void put_texts(Packer& packer, const std::vector<std::string>& texts) {
  put_list(packer, texts, [&](const std::string& text) { packer.text(text); });
}

void get_texts(Unpacker& unpacker, std::vector<std::string>& texts) {
  get_list(unpacker, texts, [&] { return unpacker.text(); });
}

void put_paths(Packer& packer, const std::vector<fs::path>& paths) {
  put_list(packer, paths, [&](const fs::path& path) { packer.text(path.native()); });
}

std::vector<fs::path> get_paths(Unpacker& unpacker) {
  std::vector<fs::path> paths;
  get_list(unpacker, paths, [&] { return fs::path(unpacker.text()); });
  return paths;
}

void put_direction(Packer& packer, AxisDirection direction) { packer.number(static_cast<std::uint64_t>(direction)); }

AxisDirection get_direction(Unpacker& unpacker) {
  return static_cast<AxisDirection>(unpacker.count(static_cast<std::size_t>(AxisDirection::down)));
}

void put_axis(Packer& packer, const Axis& axis) {
  packer.text(axis.name);
  packer.text(axis.unit);
  packer.number(static_cast<std::uint8_t>(axis.is_uniform()));
  packer.number(static_cast<std::uint64_t>(axis.size()));
  if (axis.is_uniform()) {
    packer.number(axis.origin());
    packer.number(axis.step());
  } else {
    for (std::size_t i = 0; i < axis.size(); ++i) packer.number(axis[i]);
  }
}

Axis get_axis(Unpacker& unpacker) {
  std::string name = unpacker.text();
  std::string unit = unpacker.text();
  const bool is_uniform = unpacker.number<std::uint8_t>() != 0;
  const std::size_t size = unpacker.count(std::size_t{1} << 60);
  Axis axis;
  try {
    if (is_uniform) {
      const auto origin = unpacker.number<double>();
      axis = Axis::uniform(size, origin, unpacker.number<double>());
    } else {
      std::vector<double> coordinates;
      for (std::size_t i = 0; i < size; ++i) coordinates.push_back(unpacker.number<double>());
      axis = Axis::rectilinear(std::move(coordinates));
    }
  } catch (const Error&) {
    throw BadPackage();
  }
  axis.name = std::move(name);
  axis.unit = std::move(unit);
  return axis;
}

void put_grid(Packer& packer, const RawGrid& grid) {
  put_list(packer, grid.axes, [&](const Axis& axis) { put_axis(packer, axis); });
  for (const double number : grid.linear.reshaped()) packer.number(number);
  for (const double number : grid.offset) packer.number(number);
  put_list(packer, grid.single, [&](const SingleAxis& single) {
    put_axis(packer, single.axis);
    put_direction(packer, single.direction);
  });
}

RawGrid get_grid(Unpacker& unpacker) {
  constexpr std::size_t kMostAxes = 64;
  RawGrid grid;
  get_list(unpacker, grid.axes, [&] { return get_axis(unpacker); });
  if (grid.axes.size() > kMostAxes) throw BadPackage();
  const auto n = static_cast<Eigen::Index>(grid.axes.size());
  grid.linear.resize(n, n);
  grid.offset.resize(n);
  for (double& number : grid.linear.reshaped()) number = unpacker.number<double>();
  for (double& number : grid.offset) number = unpacker.number<double>();
  get_list(unpacker, grid.single, [&] {
    SingleAxis single{get_axis(unpacker)};
    single.direction = get_direction(unpacker);
    return single;
  });
  return grid;
}

void put_info(Packer& packer, const ImageInfo& info) {
  for (const auto* text : {&info.format, &info.variable, &info.value_unit, &info.value_name, &info.world_frame})
    packer.text(*text);
  packer.text(info.stored_type ? name_of(*info.stored_type) : "");
  put_texts(packer, info.variables);
  put_list(packer, info.axis_directions, [&](AxisDirection direction) { put_direction(packer, direction); });
  put_list(packer, info.curved, [&](const CurvedAxis& curved) {
    packer.number(static_cast<std::uint64_t>(curved.axis));
    packer.number(static_cast<std::uint64_t>(curved.along));
    packer.number(static_cast<std::uint64_t>(curved.size()));
    for (std::size_t i = 0; i < curved.size(); ++i) packer.number(curved[i]);
    packer.text(curved.name);
    packer.text(curved.unit);
  });
  packer.number(static_cast<std::uint64_t>(info.samples_are_cells));
  packer.text(info.lattice ? name_of(*info.lattice) : "");
  put_list(packer, info.cell_faces, [&](const std::vector<double>& faces) {
    put_list(packer, faces, [&](double value) { packer.number(value); });
  });
  packer.number(static_cast<std::uint64_t>(info.scaling.has_value()));
  if (info.scaling) packer.number(*info.scaling);
  put_texts(packer, info.remarks);
}

ImageInfo get_info(Unpacker& unpacker) {
  ImageInfo info;
  for (auto* text : {&info.format, &info.variable, &info.value_unit, &info.value_name, &info.world_frame})
    *text = unpacker.text();
  info.stored_type = parse_value_type(unpacker.text());
  get_texts(unpacker, info.variables);
  get_list(unpacker, info.axis_directions, [&] { return get_direction(unpacker); });
  get_list(unpacker, info.curved, [&] {
    CurvedAxis curved;
    curved.axis = static_cast<int>(unpacker.number<std::uint64_t>());
    curved.along = static_cast<unsigned>(unpacker.number<std::uint64_t>());
    get_list(unpacker, curved.values, [&] { return unpacker.number<double>(); });
    curved.name = unpacker.text();
    curved.unit = unpacker.text();
    return curved;
  });
  info.samples_are_cells = unpacker.number<std::uint64_t>() != 0;
  info.lattice = parse_lattice(unpacker.text());
  get_list(unpacker, info.cell_faces, [&] {
    std::vector<double> faces;
    get_list(unpacker, faces, [&] { return unpacker.number<double>(); });
    return faces;
  });
  if (unpacker.number<std::uint64_t>() != 0) info.scaling = unpacker.number<ValueScaling>();
  get_texts(unpacker, info.remarks);
  return info;
}

void put_values(Packer& packer, const ValueArray& values) {
  packer.number(static_cast<std::uint64_t>(values.index()));
  std::visit([&](const auto& array) { packer.array(array); }, values);
}

/// An empty array of the type with this number.
ValueArray array_of_number(std::size_t type) {
  ValueArray array;
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (void)((I == type && (array = ValueArray(std::in_place_index<I>), true)) || ...);
  }
  (std::make_index_sequence<std::variant_size_v<ValueArray>>());
  return array;
}

ValueArray get_type(Unpacker& unpacker) { return array_of_number(unpacker.count(std::variant_size_v<ValueArray> - 1)); }

ValueArray get_values(Unpacker& unpacker) {
  ValueArray values = get_type(unpacker);
  std::visit([&](auto& array) { unpacker.array(array); }, values);
  return values;
}

std::uint64_t sample_count(const RawGrid& grid, const fs::path& path) {
  std::vector<std::uint64_t> sizes;
  for (const Axis& axis : grid.axes) sizes.push_back(axis.size());
  return checked_bytes(sizes, 1, path);
}

void put_attributes(Packer& packer, const std::vector<Attribute>& attributes) {
  put_list(packer, attributes, [&](const Attribute& attribute) {
    packer.text(attribute.name);
    packer.text(attribute.unit);
    packer.number(static_cast<std::uint64_t>(attribute.width));
    packer.array(attribute.values);
  });
}

std::vector<Attribute> get_attributes(Unpacker& unpacker, std::size_t rows) {
  constexpr std::size_t kWidest = std::size_t{1} << 20;
  std::vector<Attribute> attributes;
  get_list(unpacker, attributes, [&] {
    Attribute attribute;
    attribute.name = unpacker.text();
    attribute.unit = unpacker.text();
    attribute.width = static_cast<int>(unpacker.count(kWidest));
    unpacker.array(attribute.values);
    if (attribute.values.size() != rows * static_cast<std::size_t>(attribute.width)) throw BadPackage();
    return attribute;
  });
  return attributes;
}

/// The mesh must live until the package is sent.
void put_mesh(Packer& packer, Mesh& mesh) {
  packer.number(static_cast<std::uint64_t>(mesh.dim));
  packer.number(static_cast<std::uint64_t>(mesh.space_dim));
  packer.array(mesh.coordinates.numbers());
  packer.array(mesh.normals.numbers());
  packer.array(mesh.simplices.numbers());
  put_texts(packer, mesh.axis_names);
  put_texts(packer, mesh.axis_units);
  put_attributes(packer, mesh.vertex_attributes);
  put_attributes(packer, mesh.simplex_attributes);
  packer.number(static_cast<std::uint8_t>(mesh.isovalue.has_value()));
  packer.number(mesh.isovalue.value_or(0.0));
  packer.number(static_cast<std::uint64_t>(mesh.periods.size()));
  for (const double x : mesh.periods) packer.number(x);
}

Mesh get_mesh(Unpacker& unpacker) {
  Mesh mesh;
  mesh.dim = static_cast<int>(unpacker.count(4));
  mesh.space_dim = static_cast<int>(unpacker.count(5));
  if (mesh.dim < 1 || mesh.space_dim < 2) throw BadPackage();
  const auto get = [&]<class T>(MeshArray<T>& to) {
    Buffer<T> numbers;
    unpacker.array(numbers);
    to = std::move(numbers);
  };
  get(mesh.coordinates);
  get(mesh.normals);
  get(mesh.simplices);
  if (mesh.coordinates.size() % static_cast<std::size_t>(mesh.space_dim) != 0 ||
      (!mesh.normals.empty() && mesh.normals.size() != mesh.coordinates.size()) ||
      mesh.simplices.size() % (static_cast<std::size_t>(mesh.dim) + 1) != 0)
    throw BadPackage();
  get_texts(unpacker, mesh.axis_names);
  get_texts(unpacker, mesh.axis_units);
  mesh.vertex_attributes = get_attributes(unpacker, vertex_count(mesh));
  mesh.simplex_attributes = get_attributes(unpacker, simplex_count(mesh));
  const bool has_isovalue = unpacker.number<std::uint8_t>() != 0;
  const auto isovalue = unpacker.number<double>();
  if (has_isovalue && !std::isfinite(isovalue)) throw BadPackage();
  if (has_isovalue) mesh.isovalue = isovalue;
  const auto width = 2 * static_cast<std::uint64_t>(mesh.space_dim) + 1;
  mesh.periods.resize(unpacker.count(width * static_cast<std::uint64_t>(mesh.space_dim)));
  for (double& x : mesh.periods) {
    x = unpacker.number<double>();
    if (!std::isfinite(x)) throw BadPackage();
  }
  if (mesh.periods.size() % width != 0) throw BadPackage();
  return mesh;
}

/// Applies `get` to a whole package of the child.
template <class Get>
auto unpack(ChildProcess& child, Package& package, const Get& get) {
  try {
    Unpacker unpacker(package);
    auto result = get(unpacker);
    unpacker.require_end();
    return result;
  } catch (const BadPackage&) {
    child.fail_contradiction();
  }
}

/// Layers read by a child, several per request.
class SeparateLayers {
 public:
  SeparateLayers(fs::path path, const std::function<LayersOfFiles(const Progress&)>& open)
      : path_(std::move(path)),
        child_(path_, [&](const ParentLink& parent) { serve(open(parent.progress()), parent); }) {}

  /// Receives grid, metadata and files; reads no values.
  LayersOfFiles describe(const Progress& progress) {
    Package package = child_.receive(progress);
    LayersOfFiles opened = unpack(child_, package, [&](Unpacker& unpacker) {
      LayersOfFiles result;
      result.layers.grid = get_grid(unpacker);
      result.layers.info = get_info(unpacker);
      result.layers.block = std::max<std::size_t>(1, unpacker.count(std::size_t{1} << 60));
      type_ = get_type(unpacker);
      result.files = get_paths(unpacker);
      return result;
    });
    if (opened.layers.grid.axes.empty() || opened.layers.grid.axes.back().size() == 0) child_.fail_contradiction();
    const std::size_t layers = opened.layers.grid.axes.back().size();
    layer_size_ = sample_count(opened.layers.grid, path_) / layers;
    opened.layers.block = std::min(layers, worthwhile(std::clamp<std::size_t>(opened.layers.block, 1, layers)));
    return opened;
  }

  [[nodiscard]] const ValueArray& type() const noexcept { return type_; }

  /// A view of layers in the child's block; valid until the next call.
  ValueView look(std::size_t first, std::size_t count) {
    child_.request({first, count});
    package_ = child_.receive({}, ChildProcess::Blocks::lent);
    return unpack(child_, package_, [&](Unpacker& unpacker) {
      return std::visit(
          [&]<class T>(const ValueVector<T>&) -> ValueView {
            const auto values = unpacker.view<T>(child_.lent_block());
            if (values.size() != count * layer_size_) throw BadPackage();
            return values;
          },
          type_);
    });
  }

 private:
  /// Number of layers per request: a multiple of the file's blocks, some megabytes in total. A request takes some 20
  /// µs.
  [[nodiscard]] std::size_t worthwhile(std::size_t block) const {
    constexpr std::uint64_t kBytes = std::uint64_t{1} << 22;
    const std::size_t item = std::visit([]<class T>(const ValueVector<T>&) { return sizeof(T); }, type_);
    const std::uint64_t bytes = std::max<std::uint64_t>(1, layer_size_ * item * block);
    return bytes >= kBytes ? block : block * static_cast<std::size_t>((kBytes + bytes - 1) / bytes);
  }

  static void serve(const LayersOfFiles& opened, const ParentLink& parent) {
    const RawLayers& layers = opened.layers;
    {
      Packer packer;
      put_grid(packer, layers.grid);
      put_info(packer, layers.info);
      packer.number(static_cast<std::uint64_t>(layers.block));
      packer.number(static_cast<std::uint64_t>(layers.read(0, 0).index()));
      put_paths(packer, opened.files);
      parent.send(packer);
    }
    std::uint64_t layer = 1;
    for (std::size_t a = 0; a + 1 < layers.grid.axes.size(); ++a) layer *= layers.grid.axes[a].size();
    std::uint64_t most = 0;
    ValueArray values;
    while (const auto request = parent.receive()) {
      if (request->count > most) expect_memory(kBytesPerValue * layer * request->count);
      most = std::max(most, request->count);
      values = ValueArray();  // frees its block for reuse
      values = layers.read(request->first, request->count);
      Packer packer;
      std::visit([&](const auto& array) { packer.array(array); }, values);
      parent.send(packer);
    }
  }

  fs::path path_;
  ValueArray type_;
  std::uint64_t layer_size_ = 1;
  ChildProcess child_;
  Package package_;
};

}  // namespace

bool needs_separate_process(const fs::path& path) {
  if (is_dicom(path)) {
    load_dicom_dictionary();
    return true;
  }
  constexpr std::string_view kHdf5 = "\x89HDF";
  try {
    const auto prefix = read_prefix(path, kHdf5.size());
    return prefix.size() == kHdf5.size() &&
           std::equal(prefix.begin(), prefix.end(), kHdf5.begin(),
                      [](unsigned char a, char b) { return a == static_cast<unsigned char>(b); });
  } catch (const Error&) {
    return false;  // the reader reports the error
  }
}

bool needs_separate_process(std::span<const fs::path> paths) {
  return std::any_of(paths.begin(), paths.end(), [](const fs::path& path) { return needs_separate_process(path); });
}

ImageOfFiles read_separately(const fs::path& path, const Progress& progress,
                             const std::function<ImageOfFiles(const Progress&)>& read) {
  ChildProcess child(path, [&](const ParentLink& parent) {
    const ImageOfFiles result = read(parent.progress());
    Packer packer;
    put_grid(packer, result.image.grid);
    put_info(packer, result.image.info);
    put_values(packer, result.image.values);
    put_paths(packer, result.files);
    parent.send(packer);
  });
  Package package = child.receive(progress);
  child.end();
  return unpack(child, package, [&](Unpacker& unpacker) {
    ImageOfFiles result;
    result.image.grid = get_grid(unpacker);
    result.image.info = get_info(unpacker);
    result.image.values = get_values(unpacker);
    result.files = get_paths(unpacker);
    const std::size_t size = std::visit([](const auto& array) { return array.size(); }, result.image.values);
    if (size != sample_count(result.image.grid, path)) throw BadPackage();
    return result;
  });
}

Mesh read_separately(const fs::path& path, const Progress& progress, const std::function<Mesh(const Progress&)>& read) {
  ChildProcess child(path, [&](const ParentLink& parent) {
    Mesh mesh = read(parent.progress());
    Packer packer;
    put_mesh(packer, mesh);
    parent.send(packer);
  });
  Package package = child.receive(progress);
  child.end();
  return unpack(child, package, [](Unpacker& unpacker) { return get_mesh(unpacker); });
}

std::vector<ImageVariable> read_separately(const fs::path& path,
                                           const std::function<std::vector<ImageVariable>()>& read) {
  ChildProcess child(path, [&](const ParentLink& parent) {
    Packer packer;
    put_list(packer, read(), [&](const ImageVariable& variable) {
      packer.text(variable.name);
      put_list(packer, variable.sizes, [&](std::size_t size) { packer.number(static_cast<std::uint64_t>(size)); });
      packer.text(variable.unit);
      packer.text(variable.long_name);
      put_list(packer, variable.axes, [&](const std::string& axis) { packer.text(axis); });
    });
    parent.send(packer);
  });
  Package package = child.receive({});
  child.end();
  return unpack(child, package, [](Unpacker& unpacker) {
    std::vector<ImageVariable> result;
    get_list(unpacker, result, [&] {
      ImageVariable variable;
      variable.name = unpacker.text();
      get_list(unpacker, variable.sizes, [&] { return unpacker.count(std::size_t{1} << 60); });
      variable.unit = unpacker.text();
      variable.long_name = unpacker.text();
      get_list(unpacker, variable.axes, [&] { return unpacker.text(); });
      return variable;
    });
    return result;
  });
}

LayersOfFiles open_separately(const fs::path& path, const Progress& progress,
                              const std::function<LayersOfFiles(const Progress&)>& open) {
  const auto source = std::make_shared<SeparateLayers>(path, open);
  LayersOfFiles opened = source->describe(progress);
  opened.layers.look = [source](std::size_t first, std::size_t count) { return source->look(first, count); };
  opened.layers.read = [source](std::size_t first, std::size_t count) {
    if (count == 0) return source->type();
    return std::visit(
        []<class T>(std::span<const T> values) -> ValueArray { return ValueVector<T>(values.begin(), values.end()); },
        source->look(first, count));
  };
  return opened;
}

}  // namespace tegl::io_detail
