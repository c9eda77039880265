// SPDX-License-Identifier: BSD-3-Clause
//
// Reading of images: NIfTI, NRRD, MetaImage, NumPy, netCDF, DICOM. Link with tegl::io; the rules for threads in
// tegl/io.hpp apply.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "tegl/image.hpp"
#include "tegl/lattice.hpp"
#include "tegl/value_type.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// An image of any value type in N dimensions.
template <int N>
using AnyImageN =
    std::variant<OwnedImage<std::uint8_t, N>, OwnedImage<std::int8_t, N>, OwnedImage<std::uint16_t, N>,
                 OwnedImage<std::int16_t, N>, OwnedImage<std::int32_t, N>, OwnedImage<float, N>, OwnedImage<double, N>>;
/// An image of any value type in 2, 3 or 4 dimensions.
using AnyImage = std::variant<AnyImageN<2>, AnyImageN<3>, AnyImageN<4>>;
/// An image in 5 dimensions. Values of at most 16 bits, and float, are float; others are double.
using AnyImage5d = std::variant<OwnedImage<float, 5>, OwnedImage<double, 5>>;

/// The direction in which the coordinates of an axis increase, if the file defines it: ocean depths and atmospheric
/// pressures increase downwards.
enum class AxisDirection : std::uint8_t { unknown, up, down };

/// The map from stored integers to the values of an image (`ReadImageOptions::keep_stored`). Values ascend with the
/// integers, and different integers have different values. If the slope is below 0, the image has the integers
/// least + greatest - i in place of the file's i. Thread-safe.
struct ValueScaling {
  double slope = 1.0;             ///< of the file; not 0
  double intercept = 0.0;         ///< of the file: the value of its integer 0
  std::int64_t least = 0;         ///< the smallest integer of the type
  std::int64_t greatest = 0;      ///< the largest integer of the type
  bool single_precision = false;  ///< values are rounded to float, else to double

  /// The value of an integer of the image: the one that `read_image` gives without `keep_stored`.
  [[nodiscard]] double value_of(double stored) const noexcept;
  /// The isovalue of the integers that gives the contour of the values at `isovalue`, a finite number. The same samples
  /// are below it, and the same are equal to it, so signatures and simplices are those of the values. Positions are
  /// computed without the rounding of values. Takes at most 33 steps.
  [[nodiscard]] double stored_isovalue(double isovalue) const noexcept;

  bool operator==(const ValueScaling&) const = default;  ///< member by member
};

/// Metadata of an image file besides values and grid.
struct ImageInfo {
  std::string format = {};                          ///< "NIfTI", "NRRD", "MetaImage", "NumPy", "netCDF", "DICOM", "raw"
  std::string variable = {};                        ///< netCDF, .npz: the variable read
  std::vector<std::string> variables = {};          ///< netCDF, .npz: all variables that are readable as an image
  std::string value_unit = {};                      ///< such as "degC"; may be empty
  std::string value_name = {};                      ///< long name; may be empty
  std::string world_frame = {};                     ///< such as "RAS", "LPS"; empty if unknown
  std::optional<ValueType> stored_type = {};        ///< value type in the file, before any conversion; none: float16
  std::vector<AxisDirection> axis_directions = {};  ///< netCDF: one per axis of the image; else empty
  /// netCDF: coordinates in arrays of two or more dimensions (CF conventions, section 5.2), for tegl/curved.hpp; VTK:
  /// the points of a StructuredGrid. The grid has indices on these axes. Empty if the grid's axes are straight.
  std::vector<CurvedAxis> curved = {};
  /// VTK's rectilinear grids with values of cells: coordinates of the cells' faces by axis, one more than samples; for
  /// extract_cells. Empty, or without an axis: the faces are midway between the samples.
  std::vector<std::vector<double>> cell_faces = {};
  /// VTK: values of cells; NRRD: `centers: cell` on all axes. The samples then lie at the centres of cells, which
  /// tegl/cells.hpp makes contours of.
  bool samples_are_cells = false;
  /// NRRD: the key `sample_lattice`, netCDF: the attribute, .npz: the array of this name. The samples are on this
  /// lattice, which tegl/lattice.hpp makes contours of. None: on a cubic grid.
  std::optional<Lattice> lattice = {};
  std::optional<ValueScaling> scaling = {};  ///< set if the image has stored integers (`keep_stored`)
  std::vector<std::string> remarks =
      {};  ///< DICOM: skipped files, uneven slice distances; coordinates and bytes of raw files that are not used
};

/// An image and its metadata.
struct ReadImageResult {
  AnyImage image = {};  ///< values and grid
  ImageInfo info = {};  ///< metadata
};

/// An image in 5 dimensions and its metadata.
struct ReadImage5dResult {
  AnyImage5d image = {};  ///< values and grid
  ImageInfo info = {};    ///< metadata
};

/// A fixed index along one dimension of a netCDF variable.
struct FixedIndex {
  std::string dimension = {};  ///< name of the dimension in the file
  std::size_t index = 0;       ///< 0 is the first
};

/// Options of read_image.
struct ReadImageOptions {
  std::string variable =
      {};  ///< netCDF: variable; .npz: array; DICOM: UID, description or number of a series; empty: the only one
  WorkOptions work = {};  ///< progress; files are read by one thread
  /// netCDF: reads only the samples at these indices. The image does not have these dimensions as axes.
  std::vector<FixedIndex> fixed = {};
  /// Headers may name a file of samples (NRRD `data file`, MetaImage `ElementDataFile`). By default it must lie in the
  /// header's folder or below, with symbolic links resolved; this option allows any place.
  bool allow_outside_paths = false;
  /// Reads formats whose libraries may crash on damaged files, HDF5 (netCDF-4) and DCMTK, in a child process with
  /// limits of memory and time. If it crashes, loops or exceeds its memory, the error is MalformedFile. The values are
  /// the same; they stay in the memory that the child filled, without a copy. The child starts in a few milliseconds,
  /// plus some 20 ms for each gigabyte that this process has in small pages. Other threads may run meanwhile. Linux
  /// only.
  bool separate_process = false;
  /// NIfTI, netCDF and DICOM: integers with a scale and an offset stay as they are stored, in half of the memory or
  /// less, and ImageInfo::scaling maps them to values. For integers of up to 32 bits, not uint32. By default they are
  /// converted; also if values are missing, if the grid is curved, if frames or files have different scales or offsets,
  /// and if float (of 32 bits: double) has not four numbers between the values of neighbouring integers. Integers of
  /// DICOM whose values are integers of the same size are always converted: they take no more memory.
  bool keep_stored = false;
  /// Leaves the lattice that the file records out of account: ImageInfo::lattice is none, and axes that the lattice
  /// could not have are no error.
  bool as_cubic = false;
};

/// Reads NIfTI-1 (.nii, .nii.gz, .hdr/.img), NRRD (.nrrd, .nhdr; raw, gzip, ascii, hex; one data file), MetaImage
/// (.mha, .mhd; one data file), NumPy (.npy, .npz; numbers only) and netCDF (.nc, .cdf, .nc4; also gzipped as a whole).
/// Files with another extension are recognised by their first bytes. With DCMTK also DICOM: a file, a DICOMDIR, or a
/// folder and everything below it. DICOM slices are sorted by position, and by time if several have one position. Files
/// there that are not DICOM, or have colours, are skipped; slices at uneven distances give a rectilinear axis.
/// ImageInfo::remarks reports both.
///
/// Axes: the fastest axis in the file is axis 0, time is last. Trailing axes of one sample are dropped (in netCDF at
/// any position); 2, 3 or 4 axes must remain (read_series_to_5d of tegl/io/series.hpp reads 5). Units are those of the
/// file. Orientations that couple axes become Grid::linear and offset, exactly, even if sheared; other orientations
/// become part of the axes. NRRD spaces RAS and LAS are converted to LPS. Values are those stored; uint32, int64 and
/// uint64 become int32 if all values fit, else double. NIfTI slope and intercept and netCDF packing are applied (see
/// `keep_stored`). Missing values of netCDF become NaN, in float, or in double if float cannot represent the values.
/// netCDF variables on curved grids, with longitude and latitude (or a vertical coordinate) in arrays of two or more
/// dimensions, have indices on those axes, and the arrays in ImageInfo::curved; longitudes are continued across 360
/// degrees, and samples with unknown coordinates are missing. So have structured grids of VTK, by their points.
///
/// Errors, all naming the file: FileNotFound, MalformedFile (damaged, truncated or inconsistent; compressed data are
/// checked to the last byte), UnsupportedFormat, UnsupportedData (colours, vectors, other than 2 to 4 axes; a file of
/// samples outside of the header's folder), VariableNotFound (lists the variables), InvalidGrid (a coordinate variable
/// that is not monotone), InvalidArgument (a variable or a fixed index for a format without names; a fixed dimension or
/// index that the variable does not have), TooLarge, Cancelled. Memory: up to three times the values; a damaged file
/// takes no more than its bytes can hold.
[[nodiscard]] ReadImageResult read_image(const std::filesystem::path& path, const ReadImageOptions& options = {});

/// A variable that is readable as an image.
struct ImageVariable {
  std::string name = {};                ///< name for ReadImageOptions::variable
  std::vector<std::size_t> sizes = {};  ///< of its axes longer than 1, in the image's order: fastest first
  std::string unit = {};                ///< may be empty
  std::string long_name = {};           ///< may be empty
  std::vector<std::string> axes = {};   ///< netCDF: dimension names, in the order of `sizes`
};

/// Lists the values for ReadImageOptions::variable: the variables of a netCDF file, the arrays of an .npz file, or the
/// series of DICOM (with the description as long_name). Empty for other formats, whose files hold one unnamed image.
/// Variables of more than 4 axes are only readable with ReadImageOptions::fixed. Reads no values. Errors: those of
/// read_image.
[[nodiscard]] std::vector<ImageVariable> list_image_variables(const std::filesystem::path& path,
                                                              const ReadImageOptions& options = {});

}  // namespace tegl
