// SPDX-License-Identifier: BSD-3-Clause
//
// Series of files as one image with one more axis: volumes over time as a 4D image, slices as a 3D one. Link with
// tegl::io; what is said there of threads holds here, too.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tegl/io.hpp"

namespace tegl {

/// In which order files follow each other along the new axis.
enum class SeriesOrder {
  given,       ///< as they are listed
  by_name,     ///< by their names, whose numbers count as such: frame_2 before frame_10
  coordinate,  ///< by where they lie along the new axis, ascending; by `coordinates`, or as they say themselves
};

/// How files become one image.
struct SeriesOptions {
  std::string variable = {};             ///< netCDF: as in ReadImageOptions, of every file
  std::vector<double> coordinates = {};  ///< where each file lies, as they are listed; empty: see read_series
  std::optional<double> step = {};       ///< instead of them: 0, step, 2 step, ...
  /// Of the new axis; empty: the files' own. Where the files give times in a unit, these are converted (ms, s, min, h,
  /// d, "since" the same moment if that is said); another unit is an error.
  std::string unit = {};
  SeriesOrder order = SeriesOrder::given;  ///< of the files
  std::optional<RawLayout> raw = {};       ///< files of nothing but values: how each one of them is laid out
  Progress progress = {};                  ///< of read_series, over all files
  std::vector<FixedIndex> fixed = {};      ///< as in ReadImageOptions, of every file
  bool allow_outside_paths = false;        ///< as in ReadImageOptions
  bool separate_process = false;           ///< as in ReadImageOptions: one child for all files
};

/// An image of several files, which is a ReadImageResult as any other, and those files.
struct ReadSeriesResult : ReadImageResult {
  std::vector<std::filesystem::path> files = {};  ///< in the order of the new axis; of DICOM as they were listed
};

/// The same to be read layer by layer.
struct OpenSeriesResult : OpenLayersResult {
  std::vector<std::filesystem::path> files = {};  ///< as above
};

/// What a person asks of a series, where each is said or not.
struct SeriesRequest {
  std::string variable = {};                      ///< as in SeriesOptions
  std::optional<std::vector<double>> times = {};  ///< where each file lies along the new axis
  std::optional<double> time_step = {};           ///< or how far one is from the next
  std::optional<std::string> time_unit = {};      ///< of the new axis
  std::optional<SeriesOrder> sort = {};           ///< of the files
  std::optional<RawLayout> raw = {};              ///< as in SeriesOptions
  std::vector<FixedIndex> fixed = {};             ///< as in SeriesOptions
  bool allow_outside_paths = false;               ///< as in SeriesOptions
};

/// What these are called where they are asked for: "--times" on a command line.
struct SeriesWords {
  std::string_view times = {};      ///< of SeriesRequest::times
  std::string_view time_step = {};  ///< of SeriesRequest::time_step
  std::string_view time_unit = {};  ///< of SeriesRequest::time_unit
  std::string_view sort = {};       ///< of SeriesRequest::sort
  std::string_view by_time = {};    ///< of SeriesRequest::sort as SeriesOrder::coordinate
  std::string_view by_name = {};    ///< as SeriesOrder::by_name
  std::string_view given = {};      ///< as SeriesOrder::given
};

/// The options for what is asked for, where that makes sense together and for these files. Errors, all InvalidArgument
/// and in these words: what belongs to several files, asked of one; `times` with `time_step`; a step with an order by
/// times; other than one time for each file; a step of 0; and files without `sort` in an order that only
/// a shell would choose, frame_10 before frame_2, as a contour through these looks like one and is wrong. (DICOM files,
/// which say themselves where they lie, may come in any.)
SeriesOptions series_options(std::span<const std::filesystem::path> files, const SeriesRequest& request,
                             const SeriesWords& words);

/// What to add to an error of read_series or open_series, so that it says which requests do not go together where files
/// do not follow each other; empty where there is nothing.
std::string series_hint(const Error& error, const SeriesOptions& options, const SeriesWords& words);

/// Reads files of one shape as one image with one axis more, the last: 3D files as a 4D image, 2D files as a 3D one.
/// Any formats of read_image, or raw values. One file alone is read as it is.
///
/// The new axis is named t (of 3D files) or z (of 2D ones). Its coordinates are `coordinates`, each of which stays with
/// its file whatever the order, or multiples of `step` in that order; without either the files' own, where each says in
/// an axis of one sample where it lies (netCDF: a coordinate variable; NIfTI: toffset, or the position of a slice; NRRD
/// and MetaImage: the last axis) and these differ, and the name and unit they give; else 0, 1, 2, ... They have to be
/// strictly monotone in the order of the files.
///
/// Values and coordinates are those of read_image. The files must have the same sizes, type of values, unit of values,
/// frame and coordinates; the latter up to a thousandth of a step, and those of the first file count. All headers are
/// compared before any value is read. Memory: the image and one file.
///
/// Errors, naming the file and what differs from the first: UnsupportedData (files that do not fit together; more than
/// 3 axes), InvalidArgument (no file; coordinates that are not one for each file or not monotone, both `coordinates`
/// and `step`, a unit that the files' own does not become), and those of read_image.
ReadSeriesResult read_series(std::span<const std::filesystem::path> files, const SeriesOptions& options = {});

/// The same to be read layer by layer, a file for each layer: what is larger than memory as a whole. Values as in
/// open_layers (uint32, int64 and uint64 as double). Memory: one file. Errors: as above, at once; and by read() if a
/// file has become another since. One file alone is opened by open_layers, or open_raw_layers.
OpenSeriesResult open_series(std::span<const std::filesystem::path> files, const SeriesOptions& options = {});

/// Whether these are DICOM files, which say themselves where they lie: read_series reads them in any order, and takes
/// neither coordinates nor a SeriesOrder for them.
bool are_dicom_files(std::span<const std::filesystem::path> files);

/// Whether name `a` comes before `b` where runs of digits count as numbers: "frame_2" before "frame_10". Names that
/// differ in leading zeros alone come in the order of their bytes.
bool natural_less(std::string_view a, std::string_view b);

}  // namespace tegl
