// SPDX-License-Identifier: BSD-3-Clause
//
// The parts of a DICOM file's header that an image is assembled from.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "tegl/error.hpp"

namespace tegl::io_detail {

/// One frame: a plane of samples. Most files have one.
struct DicomFrame {
  std::optional<Eigen::Vector3d> position;                ///< of the centre of the first sample, mm, LPS
  std::optional<Eigen::Matrix<double, 3, 2>> directions;  ///< unit vectors along a row and along a column
  std::optional<Eigen::Vector2d> spacing;                 ///< distance of samples along a row and along a column, mm
  double slope = 1;
  double intercept = 0;
  std::optional<double> temporal_position;  ///< Temporal Position Identifier or Index
  std::optional<double> trigger_time;       ///< ms
  std::optional<double> acquisition_time;   ///< s, since midnight of an unknown day or 1970
};

/// The header of a file.
struct DicomFile {
  std::filesystem::path path;
  std::string series;        ///< Series Instance UID
  std::string description;   ///< may be empty
  std::string modality;      ///< such as "CT"
  std::string value_unit;    ///< such as "HU"; may be empty
  double series_number = 0;  ///< 0 if absent
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::string type;            ///< type of the stored values: "int16", ...
  int bits_stored = 0;         ///< number of bits of each value
  int high_bit = 0;            ///< index of the highest of them
  double least = 0, most = 0;  ///< range of stored values
  std::vector<DicomFrame> frames;
  std::optional<double> frame_time;  ///< ms between frames, if frames are times and not positions
  std::optional<Error> fault;        ///< why the values cannot be read; thrown on access
};

}  // namespace tegl::io_detail
