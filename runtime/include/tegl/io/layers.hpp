// SPDX-License-Identifier: BSD-3-Clause
//
// Reading of images layer by layer, for images larger than memory, and headerless raw files. Link with tegl::io; the
// rules for threads in tegl/io.hpp apply.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "tegl/io/images.hpp"
#include "tegl/layers.hpp"
#include "tegl/value_type.hpp"

namespace tegl {

/// Readers of an image's layers, for any value type in N dimensions.
template <int N>
using AnyLayersN =
    std::variant<std::unique_ptr<LayerReader<std::uint8_t, N>>, std::unique_ptr<LayerReader<std::int8_t, N>>,
                 std::unique_ptr<LayerReader<std::uint16_t, N>>, std::unique_ptr<LayerReader<std::int16_t, N>>,
                 std::unique_ptr<LayerReader<std::int32_t, N>>, std::unique_ptr<LayerReader<float, N>>,
                 std::unique_ptr<LayerReader<double, N>>>;
/// Readers of an image's layers, for any value type in 2, 3 or 4 dimensions.
using AnyLayers = std::variant<AnyLayersN<2>, AnyLayersN<3>, AnyLayersN<4>>;

/// An opened image and its metadata.
struct OpenLayersResult {
  AnyLayers layers = {};  ///< of any type and dimension
  ImageInfo info = {};    ///< metadata besides values and grid
};

/// Opens an image to be read layer by layer. Grid and values are those of read_image, except that uint32, int64 and
/// uint64 become double. Formats: NIfTI, NRRD, MetaImage and NumPy, compressed or not; variables of netCDF files and
/// datasets of HDF5 files; DICOM, slice by slice. The file stays open as long as the reader exists. Memory: one layer,
/// or all layers of one compressed block of a netCDF-4 or HDF5 file if these take at most 256 MiB. Compressed and text
/// files of NIfTI, NRRD, MetaImage and NumPy are read in one pass if layers are requested in ascending order; a layer
/// before the last one starts a new pass. Errors: those of read_image, here or in read() (faults in compressed samples
/// are found when they are read); UnsupportedData for a netCDF file that is gzipped as a whole, for an NRRD list of
/// images whose axis is not the last one in the file, and for a NumPy array in Fortran order. Progress is called while
/// the file is opened, once for each file of a DICOM folder, and not while layers are read.
[[nodiscard]] OpenLayersResult open_layers(const std::filesystem::path& path, const ReadImageOptions& options = {});

/// The layout of a headerless raw file: contiguous values, axis 0 fastest.
struct RawLayout {
  std::vector<std::size_t> sizes = {};       ///< sizes of 2 to 4 axes; 5 for read_series_to_5d
  std::optional<ValueType> type = {};        ///< required; one that images in memory may have
  std::uint64_t offset = 0;                  ///< bytes before the first value
  bool big_endian = false;                   ///< byte order of values
  std::vector<double> spacing = {};          ///< distance of adjacent samples by axis, not 0; empty: 1
  std::vector<double> origin = {};           ///< coordinates of the first sample; empty: 0
  std::vector<std::string> axis_names = {};  ///< empty: x, y, z, t
  std::vector<std::string> axis_units = {};  ///< empty: none
};

/// Opens a headerless raw file to be read layer by layer. Trailing axes of one sample are dropped while more than two
/// axes are left. Errors: FileNotFound; InvalidArgument (the layout: another value type, an invalid size, spacing or
/// origin, or lists of another length than `sizes`); MalformedFile if the file is shorter than the layout requires.
[[nodiscard]] OpenLayersResult open_raw_layers(const std::filesystem::path& path, const RawLayout& layout);

}  // namespace tegl
