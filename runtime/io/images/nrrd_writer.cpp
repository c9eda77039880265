// SPDX-License-Identifier: BSD-3-Clause
//
// Writes NRRD files with attached raw samples.
//
// Based on: G. Kindlmann, "Definition of NRRD File Format" (Teem).
#include <algorithm>
#include <bit>

#include "base/common.hpp"
#include "base/output_file.hpp"
#include "base/raw_image.hpp"
#include "images/image_writer.hpp"

namespace tegl::io_detail {

namespace {

class NrrdWriter final : public LayerWriter {
 public:
  NrrdWriter(const PendingPath& pending, const std::string& header, std::uint64_t layer_bytes)
      : file_(pending), layer_bytes_(layer_bytes) {
    file_.write(header);
  }
  void add(const void* layer) override { file_.write(layer, static_cast<std::size_t>(layer_bytes_)); }
  void close() override { file_.close(); }

 private:
  OutputFile file_;
  std::uint64_t layer_bytes_;
};

/// A text within one line of a header.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  return text;
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : one_line(text)) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + "\"";
}

const char* nrrd_type(ValueType type) {
  switch (type) {
    case ValueType::float32:
      return "float";
    case ValueType::float64:
      return "double";
    default:
      return name_of(type).data();  // a literal: "uint8", "int16", ...
  }
}

/// The space that a frame means; empty if there is none.
std::string space_of(const std::string& frame) {
  if (frame == "LPS") return "left-posterior-superior";
  if (frame == "LAS") return "left-anterior-superior";
  if (frame == "RAS") return "right-anterior-superior";
  return "";
}

void require_uniform(const ImageHead& head, const PendingPath& file) {
  for (std::size_t a = 0; a < head.axes(); ++a)
    if (!head.grid.axes[a].is_uniform())
      fail(ErrorCode::UnsupportedData, file.target(),
           "axis '{}' has uneven steps, which NRRD cannot hold; expected a netCDF file (.nc)", head.axis_name(a));
}

std::string vector_text(const std::vector<double>& vector) { return fmt::format("({})", fmt::join(vector, ",")); }

/// The lines about directions of the first `count` axes; others have spacings.
std::string direction_lines(const ImageHead& head, std::size_t count, const std::string& space) {
  std::string text = space.empty() ? fmt::format("space dimension: {}\n", count) : fmt::format("space: {}\n", space);
  text += "space directions:";
  std::vector<double> origin(head.grid.offset.begin(), head.grid.offset.begin() + static_cast<std::ptrdiff_t>(count));
  for (std::size_t a = 0; a < head.axes(); ++a) {
    if (a >= count) {
      text += " none";
      continue;
    }
    std::vector<double> column;
    for (std::size_t row = 0; row < count; ++row) {
      column.push_back(head.linear(row, a) * head.grid.axes[a].step());
      origin[row] += head.linear(row, a) * head.grid.axes[a].origin();
    }
    text += " " + vector_text(column);
  }
  std::string units;
  for (std::size_t a = 0; a < count; ++a) units += " " + quoted(head.grid.axes[a].unit);
  return text + fmt::format("\nspace units:{}\nspace origin: {}\n", units, vector_text(origin));
}

/// Number of axes that may have directions in space; time and scale have none. Those of cells have, unless the space
/// has a name and thus three axes: `axis mins` are coordinates of faces, half a step before the first sample.
std::size_t spatial_axes(const ImageHead& head) {
  if (head.info.samples_are_cells && space_of(head.info.world_frame).empty()) return head.axes();
  for (std::size_t a = 3; a < head.axes(); ++a)
    if (!head.is_separate(a)) return head.axes();
  return std::min<std::size_t>(head.axes(), 3);
}

/// The space that the format has a name for, or nothing.
std::string space_of_image(const ImageHead& head) {
  return spatial_axes(head) == 3 ? space_of(head.info.world_frame) : "";
}

/// Number of axes that are written with directions.
std::size_t directed_axes(const ImageHead& head) {
  const bool directed = head.has_world_map() || !space_of_image(head).empty() || head.info.samples_are_cells;
  return directed ? spatial_axes(head) : 0;
}

std::string geometry_lines(const ImageHead& head, const PendingPath& file) {
  const std::size_t axes = head.axes();
  const std::size_t spatial = spatial_axes(head);
  const std::string space = space_of_image(head);
  const bool directed = directed_axes(head) > 0;
  if (directed && spatial > 4)
    fail(ErrorCode::UnsupportedData, file.target(), "{} axes coupled by a world map; expected at most 4", spatial);
  std::string spacings = "spacings:";
  std::string mins = "axis mins:";
  for (std::size_t a = 0; a < axes; ++a) {
    const bool by_direction = directed && a < spatial;
    // a separate axis has its part of the world map in its coordinates
    const double factor = head.linear(a, a);
    spacings += by_direction ? " nan" : fmt::format(" {}", factor * head.grid.axes[a].step());
    const Axis& axis = head.grid.axes[a];
    const double first = axis.origin() - (head.info.samples_are_cells ? 0.5 * axis.step() : 0.0);
    mins += by_direction ? " nan" : fmt::format(" {}", factor * first + head.grid.offset[a]);
  }
  std::string text = directed ? direction_lines(head, spatial, space) : "";
  if (!directed || spatial < axes) text += spacings + "\n" + mins + "\n";
  return text;
}

}  // namespace

std::unique_ptr<LayerWriter> write_nrrd(const PendingPath& file, const ImageHead& head) {
  require_uniform(head, file);
  std::string sizes, labels, units, centers;
  const std::size_t directed = directed_axes(head);
  for (std::size_t a = 0; a < head.axes(); ++a) {
    sizes += fmt::format(" {}", head.grid.axes[a].size());
    labels += " " + quoted(head.axis_name(a));
    // an axis with a direction has no unit of its own, but the unit of the space
    units += " " + quoted(a < directed ? std::string() : head.grid.axes[a].unit);
    centers += head.info.samples_are_cells ? " cell" : " node";
  }
  std::string header = "NRRD0005\n";
  if (!head.info.value_name.empty()) header += fmt::format("content: {}\n", one_line(head.info.value_name));
  header += fmt::format("type: {}\ndimension: {}\nsizes:{}\n", nrrd_type(head.type), head.axes(), sizes);
  header += geometry_lines(head, file);
  header += fmt::format("centerings:{}\nlabels:{}\nunits:{}\n", centers, labels, units);
  if (!head.info.value_unit.empty()) header += fmt::format("sample units: {}\n", quoted(head.info.value_unit));
  header += fmt::format("endian: {}\nencoding: raw\n", std::endian::native == std::endian::little ? "little" : "big");
  if (head.info.lattice) header += fmt::format("{}:={}\n", kLatticeKey, name_of(*head.info.lattice));
  header += "\n";
  return std::make_unique<NrrdWriter>(file, header, head.layer_bytes);
}

}  // namespace tegl::io_detail
