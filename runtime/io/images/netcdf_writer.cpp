// SPDX-License-Identifier: BSD-3-Clause
//
// Writes netCDF files: one variable with the coordinates of its axes.
//
// Based on: "NetCDF Climate and Forecast (CF) Metadata Conventions" 1.10.
#include <netcdf.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <utility>

#include "base/common.hpp"
#include "base/raw_image.hpp"
#include "images/image_writer.hpp"

namespace tegl::io_detail {

namespace {

nc_type nc_type_of(ValueType type) {
  switch (type) {
    case ValueType::uint8:
      return NC_UBYTE;
    case ValueType::int8:
      return NC_BYTE;
    case ValueType::uint16:
      return NC_USHORT;
    case ValueType::int16:
      return NC_SHORT;
    case ValueType::int32:
      return NC_INT;
    case ValueType::float64:
      return NC_DOUBLE;
    default:
      return NC_FLOAT;
  }
}

/// A name that netCDF accepts and that is not yet taken.
std::string free_name(std::string name, std::vector<std::string>& taken) {
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && (static_cast<unsigned char>(c) < 128)) c = '_';
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) != 0) name = "_" + name;
  while (std::find(taken.begin(), taken.end(), name) != taken.end()) name += "_";
  taken.push_back(name);
  return name;
}

class NetcdfWriter final : public LayerWriter {
 public:
  NetcdfWriter(const PendingPath& file, const ImageHead& head) : target_(file.target()) {
    check(nc_create(file.path().c_str(), NC_CLOBBER | NC_64BIT_DATA, &id_), "cannot be created");
    try {
      write_head(head);
    } catch (...) {
      nc_abort(id_);
      throw;
    }
  }
  ~NetcdfWriter() override {
    if (id_ >= 0) nc_abort(id_);
  }
  NetcdfWriter(const NetcdfWriter&) = delete;
  NetcdfWriter& operator=(const NetcdfWriter&) = delete;

  void add(const void* layer) override {
    start_[0] = next_++;
    check(nc_put_vara(id_, variable_, start_.data(), count_.data(), layer), "samples");
  }
  void close() override {
    const int id = std::exchange(id_, -1);
    check(nc_close(id), "cannot be closed");
  }

 private:
  void check(int status, const char* what) const {
    // Positive ones are errors of the system, such as a full disk.
    if (status > 0) fail(ErrorCode::WriteFailed, target_, "cannot be written ({})", nc_strerror(status));
    if (status != NC_NOERR) fail(ErrorCode::WriteFailed, target_, "{}: {}", what, nc_strerror(status));
  }
  void put_text(int variable, const char* name, const std::string& text) const {
    if (!text.empty()) check(nc_put_att_text(id_, variable, name, text.size(), text.c_str()), name);
  }
  void write_head(const ImageHead& head);
  int define_axis(const ImageHead& head, std::size_t axis, const std::string& name, int& dimension) const;

  std::filesystem::path target_;
  int id_ = -1;
  int variable_ = -1;
  std::vector<std::size_t> start_, count_;
  std::size_t next_ = 0;
};

/// Defines a dimension and its coordinate variable, and returns the latter.
int NetcdfWriter::define_axis(const ImageHead& head, std::size_t axis, const std::string& name, int& dimension) const {
  const Axis& of = head.grid.axes[axis];
  int coordinate = -1;
  check(nc_def_dim(id_, name.c_str(), of.size(), &dimension), "dimension");
  check(nc_def_var(id_, name.c_str(), NC_DOUBLE, 1, &dimension, &coordinate), "coordinate");
  std::string unit = of.unit;
  // A calendar was appended to the unit when it was read.
  const std::size_t open = unit.rfind(" (");
  if (unit.find(" since ") != std::string::npos && open != std::string::npos && unit.ends_with(')')) {
    put_text(coordinate, "calendar", unit.substr(open + 2, unit.size() - open - 3));
    unit.resize(open);
  }
  put_text(coordinate, "units", unit);
  if (axis < head.info.axis_directions.size()) {
    const AxisDirection direction = head.info.axis_directions[axis];
    if (direction == AxisDirection::up) put_text(coordinate, "positive", "up");
    if (direction == AxisDirection::down) put_text(coordinate, "positive", "down");
  }
  return coordinate;
}

void NetcdfWriter::write_head(const ImageHead& head) {
  const std::size_t axes = head.axes();
  std::vector<std::string> taken;
  std::vector<int> dimensions(axes), coordinates(axes);
  for (std::size_t a = 0; a < axes; ++a)
    coordinates[a] = define_axis(head, a, free_name(head.axis_name(a), taken), dimensions[axes - 1 - a]);
  const std::string name = free_name(head.info.variable.empty() ? "values" : head.info.variable, taken);
  check(nc_def_var(id_, name.c_str(), nc_type_of(head.type), static_cast<int>(axes), dimensions.data(), &variable_),
        "variable");
  put_text(variable_, "units", head.info.value_unit);
  put_text(variable_, "long_name", head.info.value_name);
  if (head.info.lattice) put_text(variable_, kLatticeKey, std::string(name_of(*head.info.lattice)));
  constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();
  constexpr double kMissingDouble = std::numeric_limits<double>::quiet_NaN();
  if (head.type == ValueType::float32)
    check(nc_put_att_float(id_, variable_, "_FillValue", NC_FLOAT, 1, &kMissing), "_FillValue");
  if (head.type == ValueType::float64)
    check(nc_put_att_double(id_, variable_, "_FillValue", NC_DOUBLE, 1, &kMissingDouble), "_FillValue");
  put_text(NC_GLOBAL, "Conventions", "CF-1.10");
  int before = 0;
  check(nc_set_fill(id_, NC_NOFILL, &before), "fill mode");
  check(nc_enddef(id_), "header");
  for (std::size_t a = 0; a < axes; ++a) {
    std::vector<double> values;
    for (std::size_t i = 0; i < head.grid.axes[a].size(); ++i)
      values.push_back(head.linear(a, a) * head.grid.axes[a][i] + head.grid.offset[a]);
    check(nc_put_var_double(id_, coordinates[a], values.data()), "coordinates");
  }
  start_.assign(axes, 0);
  count_.assign(axes, 1);
  for (std::size_t a = 0; a + 1 < axes; ++a) count_[axes - 1 - a] = head.grid.axes[a].size();
}

}  // namespace

std::unique_ptr<LayerWriter> write_netcdf(const PendingPath& file, const ImageHead& head) {
  for (std::size_t a = 0; a < head.axes(); ++a)
    if (!head.is_separate(a))
      fail(ErrorCode::UnsupportedData, file.target(),
           "axis '{}' is oblique, which netCDF cannot hold; expected an NRRD file (.nrrd)", head.axis_name(a));
  return std::make_unique<NetcdfWriter>(file, head);
}

}  // namespace tegl::io_detail
