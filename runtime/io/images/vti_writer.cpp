// SPDX-License-Identifier: BSD-3-Clause
//
// Writes VTK's ImageData (.vti) with appended raw samples.
//
// Based on: The VTK User's Guide, "XML File Formats" (Kitware).
#include <bit>
#include <cmath>

#include "base/common.hpp"
#include "base/output_file.hpp"
#include "images/image_writer.hpp"

namespace tegl::io_detail {

namespace {

class VtiWriter final : public LayerWriter {
 public:
  VtiWriter(const PendingPath& pending, const std::string& header, std::uint64_t bytes, std::uint64_t layer_bytes)
      : file_(pending), layer_bytes_(layer_bytes) {
    file_.write(header);
    file_.write(&bytes, sizeof(bytes));
  }
  void add(const void* layer) override { file_.write(layer, static_cast<std::size_t>(layer_bytes_)); }
  void close() override {
    file_.write(std::string("\n</AppendedData>\n</VTKFile>\n"));
    file_.close();
  }

 private:
  OutputFile file_;
  std::uint64_t layer_bytes_;
};

const char* vtk_type(ValueType type) {
  switch (type) {
    case ValueType::uint8:
      return "UInt8";
    case ValueType::int8:
      return "Int8";
    case ValueType::uint16:
      return "UInt16";
    case ValueType::int16:
      return "Int16";
    case ValueType::int32:
      return "Int32";
    case ValueType::float64:
      return "Float64";
    default:
      return "Float32";
  }
}

/// A text for an attribute of XML.
std::string attribute_text(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '<')
      result += "&lt;";
    else if (c == '&')
      result += "&amp;";
    else if (c == '"')
      result += "&quot;";
    else
      result += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return result;
}

void require_image_data(const ImageHead& head, const PendingPath& file) {
  if (head.axes() > 3)
    fail(ErrorCode::UnsupportedData, file.target(), "{} axes, of which VTK's images hold 3; expected .nrrd or .nc",
         head.axes());
  for (std::size_t a = 0; a < head.axes(); ++a)
    if (!head.grid.axes[a].is_uniform())
      fail(ErrorCode::UnsupportedData, file.target(),
           "axis '{}' has uneven steps, which ImageData cannot hold; expected a netCDF file (.nc)", head.axis_name(a));
}

}  // namespace

std::unique_ptr<LayerWriter> write_vti(const PendingPath& file, const ImageHead& head) {
  require_image_data(head, file);
  // sample (i, j, k) lies at origin + direction (spacing (i, j, k))
  std::array<double, 3> origin{}, spacing = {1, 1, 1};
  std::array<double, 9> direction = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const bool of_cells = head.info.samples_are_cells;  // the origin is then a corner of the first cell
  std::string extent;
  std::uint64_t bytes = head.layer_bytes;
  for (std::size_t a = 0; a < 3; ++a) {
    extent +=
        fmt::format("{}0 {}", a == 0 ? "" : " ", a < head.axes() ? head.grid.axes[a].size() - (of_cells ? 0 : 1) : 0);
    if (a >= head.axes()) continue;
    const Axis& axis = head.grid.axes[a];
    if (a + 1 == head.axes()) bytes *= axis.size();
    origin[a] += head.grid.offset[a];
    double square = 0;
    for (std::size_t row = 0; row < head.axes(); ++row) {
      origin[row] += head.linear(row, a) * (axis.origin() - (of_cells ? 0.5 * axis.step() : 0.0));
      direction[3 * row + a] = head.linear(row, a) * axis.step();
      square += direction[3 * row + a] * direction[3 * row + a];
    }
    spacing[a] = head.is_separate(a) ? std::abs(direction[4 * a]) : std::sqrt(square);
    for (std::size_t row = 0; row < head.axes(); ++row) direction[3 * row + a] /= spacing[a];
  }
  const std::string& variable = head.info.variable.empty() ? head.info.value_name : head.info.variable;
  const std::string name = attribute_text(variable.empty() ? "values" : variable);
  const char* const part = of_cells ? "CellData" : "PointData";
  const char* const order = std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
  const std::string header = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"{}\" header_type=\"UInt64\">\n"
      "<ImageData WholeExtent=\"{}\" Origin=\"{}\" Spacing=\"{}\" Direction=\"{}\">\n<Piece Extent=\"{}\">\n"
      "<{} Scalars=\"{}\">\n<DataArray type=\"{}\" Name=\"{}\" format=\"appended\" "
      "offset=\"0\"/>\n</{}>\n"
      "</Piece>\n</ImageData>\n<AppendedData encoding=\"raw\">\n_",
      order, extent, fmt::join(origin, " "), fmt::join(spacing, " "), fmt::join(direction, " "), extent, part, name,
      vtk_type(head.type), name, part);
  return std::make_unique<VtiWriter>(file, header, bytes, head.layer_bytes);
}

}  // namespace tegl::io_detail
