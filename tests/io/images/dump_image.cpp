// SPDX-License-Identifier: BSD-3-Clause
//
// Prints an image as JSON, coordinates and all values, for comparison with other readers. Arguments: the series or
// variable (may be empty), "whole", "stored" or "layers", and the files. "stored" keeps stored integers (`keep_stored`)
// and prints their values. Reads the files both in this process and in a child process, and expects equal results; of
// error messages the range of layers read together is ignored.
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tegl/io/series.hpp"

namespace {

using nlohmann::json;

template <int N>
json describe(const tegl::Grid<N>& grid) {
  json result;
  for (int a = 0; a < N; ++a) {
    json coordinates = json::array();
    for (std::size_t i = 0; i < grid.axes[a].size(); ++i) coordinates.push_back(grid.axes[a][i]);
    result["axes"].push_back({{"name", grid.axes[a].name}, {"unit", grid.axes[a].unit}, {"at", coordinates}});
    std::vector<double> row;
    for (int b = 0; b < N; ++b) row.push_back(grid.linear[a][b]);
    result["linear"].push_back(row);
    result["offset"].push_back(grid.offset[a]);
  }
  return result;
}

template <class T>
const char* type_of(T) {
  return std::is_same_v<T, std::uint8_t>    ? "uint8"
         : std::is_same_v<T, std::int8_t>   ? "int8"
         : std::is_same_v<T, std::uint16_t> ? "uint16"
         : std::is_same_v<T, std::int16_t>  ? "int16"
         : std::is_same_v<T, std::int32_t>  ? "int32"
         : std::is_same_v<T, float>         ? "float32"
                                            : "float64";
}

json whole(std::span<const std::filesystem::path> files, const tegl::SeriesOptions& options) {
  const tegl::ReadImageResult read = tegl::read_series(files, options);
  const auto of_image = [&]<class T, int N>(const tegl::OwnedImage<T, N>& image) {
    json result = describe(image.grid);
    result["values"] = image.values;
    if (options.keep_stored) result["kept"] = read.info.scaling.has_value();
    if (read.info.scaling)
      for (json& value : result["values"]) value = read.info.scaling->value_of(value);
    result["type"] = type_of(T{});
    result["frame"] = read.info.world_frame;
    result["remarks"] = read.info.remarks;
    result["value_unit"] = read.info.value_unit;
    return result;
  };
  return std::visit([&](const auto& typed) { return std::visit(of_image, typed); }, read.image);
}

json layers(std::span<const std::filesystem::path> files, const tegl::SeriesOptions& options) {
  tegl::OpenLayersResult opened = tegl::open_series(files, options);
  const auto of_layers = [&]<class T, int N>(const std::unique_ptr<tegl::LayerReader<T, N>>& reader) {
    json result = describe(reader->grid());
    std::size_t size = 1;
    for (int a = 0; a + 1 < N; ++a) size *= reader->grid().axes[a].size();
    std::vector<T> layer(size);
    for (std::size_t k = 0; k < reader->grid().axes[N - 1].size(); ++k) {
      reader->read(k, layer.data());
      for (const T value : layer) result["values"].push_back(value);
    }
    result["type"] = type_of(T{});
    result["frame"] = opened.info.world_frame;
    result["remarks"] = opened.info.remarks;
    result["value_unit"] = opened.info.value_unit;
    return result;
  };
  return std::visit([&](auto& typed) { return std::visit(of_layers, typed); }, opened.layers);
}

/// The message without the range of layers read together, which is larger in a child process.
std::string without_layers(const std::string& message) { return message.substr(0, message.find(" (layer")); }

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  tegl::SeriesOptions options;
  options.variable = argv[1];
  const std::vector<std::filesystem::path> files(argv + 3, argv + argc);
  options.keep_stored = std::string(argv[2]) == "stored";
  const auto read = [&](bool separate_process) -> json {
    options.separate_process = separate_process;
    try {
      return std::string(argv[2]) == "layers" ? layers(files, options) : whole(files, options);
    } catch (const tegl::Error& error) {
      return {{"error", tegl::name_of(error.code())}, {"message", without_layers(error.what())}};
    }
  };
  const json result = read(false);
  if (read(true) != result) {  // NaN is written as null
    std::fprintf(stderr, "in this process: %s\nin a child process: %s\n", result.dump().c_str(),
                 read(true).dump().c_str());
    return 1;
  }
  std::printf("%s\n", result.dump().c_str());
  return 0;
}
