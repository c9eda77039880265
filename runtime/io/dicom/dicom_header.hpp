// SPDX-License-Identifier: BSD-3-Clause
//
// What the header of a DICOM file says that an image is put together from.
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
  std::optional<Eigen::Vector3d> position;                ///< of the first sample's centre, mm, LPS
  std::optional<Eigen::Matrix<double, 3, 2>> directions;  ///< along a row, along a column; of length 1
  std::optional<Eigen::Vector2d> spacing;                 ///< of samples along a row and along a column, mm
  double slope = 1;
  double intercept = 0;
  std::optional<double> temporal_position;  ///< Temporal Position Identifier or Index
  std::optional<double> trigger_time;       ///< ms
  std::optional<double> acquisition_time;   ///< s, since some midnight
};

/// What a header says.
struct DicomFile {
  std::filesystem::path path;
  std::string series;        ///< Series Instance UID
  std::string description;   ///< may be empty
  std::string modality;      ///< such as "CT"
  std::string value_unit;    ///< such as "HU"; may be empty
  double series_number = 0;  ///< 0 if there is none
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::string type;            ///< of the stored values: "int16", ...
  int bits_stored = 0;         ///< of each value
  int high_bit = 0;            ///< the highest of them
  double least = 0, most = 0;  ///< what stored values may be
  std::vector<DicomFrame> frames;
  std::optional<double> frame_time;  ///< ms between frames that are moments, not places
  std::optional<Error> fault;        ///< why its values are none that can be read: for whoever wants them
};

}  // namespace tegl::io_detail
