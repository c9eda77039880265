// SPDX-License-Identifier: BSD-3-Clause
//
// File series read as one image with an additional axis: volumes over time as a 4D image, slices as a 3D one. Link with
// tegl::io; the rules for threads in tegl/io.hpp apply.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "tegl/io/layers.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// The order of files along the new axis.
enum class SeriesOrder {
  given,       ///< as listed
  by_name,     ///< by name, with runs of digits compared as numbers: frame_2 before frame_10
  coordinate,  ///< by ascending coordinate along the new axis, from `coordinates` or the files
};

/// Options of read_series and open_series.
struct SeriesOptions {
  std::string variable = {};             ///< netCDF: as in ReadImageOptions, for every file
  std::vector<double> coordinates = {};  ///< one per file, as listed; empty: see read_series
  std::optional<double> step = {};       ///< instead of `coordinates`: 0, step, 2 step, ...
  /// Unit of the new axis; empty: that of the files. Times that the files give in another unit are converted (ms, s,
  /// min, h, d; "since" the same moment, if there is one); other units are an error.
  std::string unit = {};
  SeriesOrder order = SeriesOrder::given;  ///< order of the files
  std::optional<RawLayout> raw = {};       ///< layout of each file, for headerless raw files
  WorkOptions work = {};                   ///< progress over all files; one thread reads
  std::vector<FixedIndex> fixed = {};      ///< as in ReadImageOptions, for every file
  bool allow_outside_paths = false;        ///< as in ReadImageOptions
  bool separate_process = false;           ///< as in ReadImageOptions: one child for all files
  bool keep_stored = false;                ///< as in ReadImageOptions; not in open_series
  bool as_cubic = false;                   ///< as in ReadImageOptions, for every file
};

/// An image read from several files, and the list of files.
struct ReadSeriesResult : ReadImageResult {
  std::vector<std::filesystem::path> files = {};  ///< in the order of the new axis; DICOM: as listed
};

/// Several files opened as one image by layers.
struct OpenSeriesResult : OpenLayersResult {
  std::vector<std::filesystem::path> files = {};  ///< in the order of the new axis; DICOM: as listed
};

/// Reads files of equal shape as one image with one additional, last axis: 3D files as a 4D image, 2D files as a 3D
/// one. Files are of any format of read_image, or raw. A single file is read without an additional axis.
///
/// The new axis is named t (for 3D files) or z (for 2D files). Its coordinates are `coordinates`, which stay with their
/// files in any order, or multiples of `step` in the order of the files. Without both they come from the files, with
/// name and unit, if every file has its coordinate in an axis of one sample (netCDF: a coordinate variable; NIfTI:
/// toffset, or the position of a slice; NRRD and MetaImage: the last axis) and these differ. Otherwise they are 0, 1,
/// 2, ... They must be strictly monotone in the order of the files.
///
/// Values and coordinates are those of read_image. The files must have the same sizes, value type, value unit, frame
/// and coordinates; coordinates may differ by up to a thousandth of a step, and those of the first file are used. All
/// headers are compared before any value is read. Memory: the image and one file.
///
/// Errors, naming the file and the difference from the first file: UnsupportedData (files that do not match; more than
/// 3 axes), InvalidArgument (no file; not one coordinate per file, or coordinates that are not monotone; both
/// `coordinates` and `step`; a unit that the files' unit does not convert to), and those of read_image.
[[nodiscard]] ReadSeriesResult read_series(std::span<const std::filesystem::path> files,
                                           const SeriesOptions& options = {});

/// An image in 5 dimensions read from one or several files.
struct ReadSeries5dResult : ReadImage5dResult {
  std::vector<std::filesystem::path> files = {};  ///< as in ReadSeriesResult
};

/// As read_series, also for images of 5 axes: a NRRD, NumPy or netCDF file, a raw file, or several files of 4 axes
/// each. Errors: UnsupportedData for more than 5 axes, and those of read_series.
[[nodiscard]] std::variant<ReadSeriesResult, ReadSeries5dResult> read_series_to_5d(
    std::span<const std::filesystem::path> files, const SeriesOptions& options = {});

/// Opens a series to be read layer by layer, one file per layer, for images larger than memory. Values as in
/// open_layers (uint32, int64 and uint64 as double). Memory: one file. Errors: those of read_series, immediately; and
/// in read() if a file has changed since. Progress is called once for each file that is opened, and not while layers
/// are read. A single file is opened by open_layers or open_raw_layers.
[[nodiscard]] OpenSeriesResult open_series(std::span<const std::filesystem::path> files,
                                           const SeriesOptions& options = {});

/// Whether the files are DICOM. DICOM files have their own positions: read_series accepts them in any order, without
/// coordinates and without a SeriesOrder.
[[nodiscard]] bool are_dicom_files(std::span<const std::filesystem::path> files);

/// Whether name `a` precedes `b` if runs of digits are compared as numbers: "frame_2" before "frame_10". Names that
/// differ only in leading zeros are compared by bytes.
[[nodiscard]] bool natural_less(std::string_view a, std::string_view b);

}  // namespace tegl
