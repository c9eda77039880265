// SPDX-License-Identifier: BSD-3-Clause
//
// Writing of images: NRRD, netCDF and VTK, from memory or layer by layer. Link with tegl::io; the rules for threads in
// tegl/io.hpp apply.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

#include "tegl/io/images.hpp"
#include "tegl/layers.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// Whether the extension is one of write_image: .nrrd, .nc (or .cdf), .vti.
[[nodiscard]] bool is_image_output(const std::filesystem::path& path);

/// Whether write_image records ImageInfo::lattice in a file with this extension: .nrrd, .nc (or .cdf), not .vti.
[[nodiscard]] bool records_lattice(const std::filesystem::path& path);

namespace detail {

/// The grid of an image in any dimension.
struct StoredGrid {
  std::vector<Axis> axes;
  std::vector<double> linear;  ///< row by row
  std::vector<double> offset;
};

/// An image file that is written layer by layer, and appears when it is complete.
class ImageFile {
 public:
  ImageFile(const std::filesystem::path& path, ValueType type, StoredGrid grid, const ImageInfo& info);
  ~ImageFile();
  ImageFile(const ImageFile&) = delete;
  ImageFile& operator=(const ImageFile&) = delete;
  void add(const void* layer);
  void finish();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

template <int N>
StoredGrid stored_grid(const Grid<N>& grid) {
  StoredGrid result{{grid.axes.begin(), grid.axes.end()}, {}, {grid.offset.begin(), grid.offset.end()}};
  for (int row = 0; row < N; ++row)
    result.linear.insert(result.linear.end(), grid.linear[row].begin(), grid.linear[row].end());
  return result;
}

}  // namespace detail

/// Writes an image layer by layer, for images larger than memory. The file appears when it is complete. Of `info`,
/// value_unit, value_name, world_frame, variable, axis_directions, samples_are_cells (.nrrd, .vti) and lattice
/// (records_lattice) are written if the format has them. read_image (in 5D read_series_to_5d, .nrrd only) gives the
/// same values, coordinates, names and units back; coordinates of cells in .vti up to rounding.
///
/// .nrrd: NRRD0005 with raw values. Axes must be uniform. The world map becomes space directions; of more than four
/// axes, those after the third must be separate from the others then. The frames LPS, LAS and RAS are named in the file
/// (read_image converts RAS and LAS to LPS). .nc, .cdf: netCDF in the format CDF-5, with the coordinates of each axis.
/// The world map must keep the axes separate; it becomes part of the coordinates, and its frame is not written. .vti:
/// VTK's ImageData, for other programs: 2D and 3D, uniform axes; the world map becomes origin, spacing and direction.
/// Names of axes, units and frames are not written.
///
/// Errors: UnsupportedFormat (another extension), UnsupportedData (a grid that the format cannot hold), WriteFailed,
/// Cancelled, and those of the reader. No file is left after an error.
template <Value T, int N>
requires DimensionBetween<N, 2, 5>
void write_layers(LayerReader<T, N>& layers, const std::filesystem::path& path, const ImageInfo& info = {},
                  const WorkOptions& work = {}) {
  const Grid<N>& grid = layers.grid();
  detail::ImageFile file(path, kValueType<T>, detail::stored_grid(grid), info);
  std::size_t size = 1;
  for (int a = 0; a + 1 < N; ++a) size *= grid.axes[a].size();
  std::vector<T> layer(size);
  const std::size_t count = grid.axes[N - 1].size();
  for (std::size_t k = 0; k < count; ++k) {
    if (work.progress && !work.progress(static_cast<double>(k) / static_cast<double>(count)))
      throw Error(ErrorCode::Cancelled, path.string() + ": cancelled by the progress callback");
    layers.read(k, layer.data());
    file.add(layer.data());
  }
  file.finish();
  if (work.progress) work.progress(1.0);
}

/// Writes an image in memory: see write_layers.
template <Value T, int N>
requires DimensionBetween<N, 2, 5>
void write_image(const Image<T, N>& image, const std::filesystem::path& path, const ImageInfo& info = {},
                 const WorkOptions& work = {}) {
  FunctionLayers<T, N> layers(image.grid(), [&](std::size_t k, T* to) {
    std::array<std::size_t, N> index{};
    index[N - 1] = k;
    std::size_t rows = 1;
    for (int a = 1; a + 1 < N; ++a) rows *= image.size(a);
    const std::size_t width = N > 1 ? image.size(0) : 1;
    for (std::size_t r = 0; r < rows; ++r) {
      for (std::size_t i = 0; i < width; ++i, ++index[0]) *to++ = image(index);
      index[0] = 0;
      for (int a = 1; a + 1 < N && ++index[a] == image.size(a); ++a) index[a] = 0;
    }
  });
  write_layers(layers, path, info, work);
}

}  // namespace tegl
