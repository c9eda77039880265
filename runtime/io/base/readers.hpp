// SPDX-License-Identifier: BSD-3-Clause
//
// Declares the readers of the image formats.
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

/// How much of a file to read: everything, or grid and metadata with an empty array of the values' type.
enum class Extent { whole, header };

/// The header of an image whose samples are contiguous in one file.
struct StoredImage {
  RawGrid grid;
  ImageInfo info;
  StoredSamples samples;
  /// Index, among the file's axes, of the image's last axis if that is not last in the file: a list of images in NRRD.
  std::optional<std::size_t> list_axis;
  /// Converts stored values to those of the image; empty if they are equal.
  std::function<ValueArray(ValueArray&&)> convert;
};
StoredImage open_nifti(const std::filesystem::path& path);
StoredImage open_nrrd(const std::filesystem::path& path, bool allow_outside_paths);
StoredImage open_metaimage(const std::filesystem::path& path, bool allow_outside_paths);

RawImage read_netcdf(const std::filesystem::path& path, Extent extent, const ReadImageOptions& options);

/// Reads a file of any format; trailing axes of one sample are dropped.
RawImage read_any(const std::filesystem::path& path, Extent extent, const ReadImageOptions& options);

/// An image whose samples are read later, in groups of layers along its last axis.
struct RawLayers {
  RawGrid grid;
  ImageInfo info;
  std::size_t block = 1;  ///< number of layers that are most efficient to read together
  /// Reads the layers [first, first + count); always of the same type. Keeps the file open.
  std::function<ValueArray(std::size_t first, std::size_t count)> read;
  /// Returns the same samples without a copy, valid until the next call. May be empty.
  std::function<ValueView(std::size_t first, std::size_t count)> look = {};
};
/// Converts to layers of the library's value types and dimensions.
OpenLayersResult to_open_layers(RawLayers&& source, const std::filesystem::path& path);

/// Opens a headerless raw file.
RawLayers open_raw(const std::filesystem::path& path, const RawLayout& layout);
/// Whether a path is a DICOM file, or a folder or DICOMDIR, which may contain some.
bool is_dicom(const std::filesystem::path& path);
/// Loads the data dictionary, so that child processes inherit it and do not load it one by one (some 30 ms).
void load_dicom_dictionary();
/// Opens the image of DICOM files and folders whose UID, number or description is `series`. `progress` is called while
/// headers are read (with 0) and for each read.
RawLayers open_dicom(std::span<const std::filesystem::path> paths, const std::string& series, const Progress& progress);
/// Lists the DICOM series of a path.
std::vector<ImageVariable> list_dicom(const std::filesystem::path& path);
RawLayers open_netcdf_layers(const std::filesystem::path& path, const ReadImageOptions& options);
/// Opens a file of any format. UnsupportedData if it cannot be read layer by layer.
RawLayers open_any_layers(const std::filesystem::path& path, const ReadImageOptions& options);

/// Lists the variables of a netCDF file that are readable as images.
std::vector<ImageVariable> list_netcdf(const std::filesystem::path& path, bool allow_outside_paths);

}  // namespace tegl::io_detail
