// SPDX-License-Identifier: BSD-3-Clause
//
// The readers of the single formats.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/raw_image.hpp"
#include "base/sample_reader.hpp"

namespace tegl::io_detail {

/// How much of a file to read: all of it, or grid and description with an empty array of the values' type.
enum class Extent { whole, header };

/// An image whose samples lie in one file in their order: what its header says of it.
struct StoredImage {
  RawGrid grid;
  ImageInfo info;
  StoredSamples samples;
  /// The place among the file's axes of the image's last axis, if it is not the last there: a list of images in NRRD.
  std::optional<std::size_t> list_axis;
  /// From values as stored to those of the image; none: they are these.
  std::function<ValueArray(ValueArray&&)> convert;
};
StoredImage open_nifti(const std::filesystem::path& path);
StoredImage open_nrrd(const std::filesystem::path& path, bool allow_outside_paths);
StoredImage open_metaimage(const std::filesystem::path& path, bool allow_outside_paths);

RawImage read_netcdf(const std::filesystem::path& path, Extent extent, const ReadImageOptions& options);

/// A file of any format, without trailing axes of one sample.
RawImage read_any(const std::filesystem::path& path, Extent extent, const ReadImageOptions& options);

/// An image whose samples are read later, some layers along its last axis at a time.
struct RawLayers {
  RawGrid grid;
  ImageInfo info;
  std::size_t block = 1;  ///< layers that are best read together
  /// The samples of the layers [first, first + count); always of the same type. Keeps the file open.
  std::function<ValueArray(std::size_t first, std::size_t count)> read;
  /// The same samples without a copy, valid until the next call; there may be `read` only.
  std::function<ValueView(std::size_t first, std::size_t count)> look = {};
};
/// The layers, of the value types and dimensions of the library.
OpenLayersResult to_open_layers(RawLayers&& source, const std::filesystem::path& path);

/// Files that hold nothing but values.
RawLayers open_raw(const std::filesystem::path& path, const RawLayout& layout);
/// Whether a path is a DICOM file, or a folder or DICOMDIR, which may hold some.
bool is_dicom(const std::filesystem::path& path);
/// Loads the data dictionary, so that child processes have it and need not load it one by one (some 30 ms).
void load_dicom_dictionary();
/// The images of DICOM files and folders, as the one whose UID, number or description `series` says. `progress` is told
/// of while headers are read (0), and of each read.
RawLayers open_dicom(std::span<const std::filesystem::path> paths, const std::string& series, const Progress& progress);
/// The series there.
std::vector<ImageVariable> list_dicom(const std::filesystem::path& path);
RawLayers open_netcdf_layers(const std::filesystem::path& path, const ReadImageOptions& options);
/// One file of any format. UnsupportedData for one that cannot be read layer by layer.
RawLayers open_any_layers(const std::filesystem::path& path, const ReadImageOptions& options);

/// The variables of a netCDF file that can be read as images.
std::vector<ImageVariable> list_netcdf(const std::filesystem::path& path, bool allow_outside_paths);

}  // namespace tegl::io_detail
