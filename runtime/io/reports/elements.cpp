// SPDX-License-Identifier: BSD-3-Clause
//
// Writes elements as text and HDF5; see tegl/io/elements.hpp.
//
// Based on: P. Huovinen and H. Petersen, "Particlization in hybrid models", Eur. Phys. J. A 48 (2012) 171,
// arXiv:1206.3371, and the authors' example program, whose line format is used.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/common.hpp"
#include "base/hdf5_file.hpp"
#include "base/output_file.hpp"
#include "base/pending_path.hpp"
#include "meshes/attributes.hpp"
#include "tegl/io/elements.hpp"

namespace tegl {

namespace fs = std::filesystem;

using namespace io_detail;

namespace {

constexpr std::size_t kRows = std::size_t{1} << 16;  ///< rows between two progress reports

/// The axes in the order of the file.
template <int N>
std::array<int, N> order_of(const ElementFileOptions& options) {
  std::array<int, N> order;
  for (int i = 0; i < N; ++i) order[i] = options.axes == ElementAxes::as_is ? i : (i + N - 1) % N;
  return order;
}

/// The factor of a component.
template <int N>
double sign_of(int axis, const ElementFileOptions& options) {
  return options.components == ElementComponents::contravariant && axis != N - 1 ? -1.0 : 1.0;
}

/// Replaces blanks in a name.
std::string word(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) <= 0x20) c = '_';
  return text;
}

template <int N>
std::string name_of_axis(const Elements<N>& elements, int axis) {
  const std::string& name = elements.axis_names[axis];
  constexpr const char* kUsual = N == 5 ? "xyztu" : "xyzt";
  return word(name.empty() ? std::string(1, kUsual[axis]) : name);
}

/// The unit of a normal's component: the product of the units of all other axes; empty if one of them is unknown.
template <int N>
std::string unit_of_component(const Elements<N>& elements, int axis) {
  std::string unit;
  for (int a = 0; a < N; ++a) {
    if (a == axis) continue;
    if (elements.axis_units[a].empty()) return {};
    unit += (unit.empty() ? "" : " ") + elements.axis_units[a];
  }
  return unit;
}

template <int N>
void write_lines(const Elements<N>& elements, const PendingPath& pending, const ElementFileOptions& options) {
  const fs::path& path = pending.target();
  OutputFile file(pending);
  fmt::memory_buffer buffer;
  const auto out = std::back_inserter(buffer);
  if (options.header) fmt::format_to(out, "# {}\n", fmt::join(element_columns(elements, options), " "));
  const std::array<int, N> order = order_of<N>(options);
  const std::size_t count = elements.centroids.size();
  for (std::size_t e = 0; e < count; ++e) {
    if (e % kRows == 0) {
      tick(options.work.progress, static_cast<double>(e) / static_cast<double>(count), path);
      file.write(buffer.data(), buffer.size());
      buffer.clear();
    }
    // centroid, normal, attributes
    for (int i = 0; i < N; ++i) {
      if (i > 0) buffer.push_back(' ');
      fmt::format_to(out, "{}", elements.centroids[e][order[i]]);
    }
    for (int i = 0; i < N; ++i) {
      // Adding 0 turns -0 into 0.
      const double component = sign_of<N>(order[i], options) * elements.normals[e][order[i]] + 0.0;
      fmt::format_to(out, " {}", component);
    }
    for (const Attribute& attribute : elements.attributes) {
      const auto width = static_cast<std::size_t>(attribute.width);
      for (std::size_t i = 0; i < width; ++i) {
        const double value = attribute.values[e * width + i];
        if (std::isnan(value))
          fmt::format_to(out, " nan");  // for either sign of NaN
        else
          fmt::format_to(out, " {}", value);
      }
    }
    buffer.push_back('\n');
  }
  tick(options.work.progress, 1.0, path);
  file.write(buffer.data(), buffer.size());
  file.close();
}

/// Writes a dataset of `count` rows of `columns` numbers number(row, column); 0 columns: one-dimensional.
template <class Number, class Make>
void put_table(const H5File& file, hid_t group, const std::string& name, std::uint64_t count, std::uint64_t columns,
               const std::string& units, hid_t file_type, hid_t memory_type, const Make& number) {
  H5Table table = file.create_table(group, name.c_str(), file_type, columns, count);
  const std::uint64_t width = std::max<std::uint64_t>(1, columns);
  std::vector<Number> block;
  for (std::uint64_t first = 0; first < count; first += kRows) {
    const std::uint64_t rows = std::min<std::uint64_t>(kRows, count - first);
    block.clear();
    for (std::uint64_t r = 0; r < rows; ++r)
      for (std::uint64_t c = 0; c < width; ++c) block.push_back(number(first + r, c));
    table.append(memory_type, block.data(), rows);
  }
  file.put_text(table.id(), "units", units);
}

template <class Make>
void put_numbers(const H5File& file, hid_t group, const std::string& name, std::uint64_t count, std::uint64_t columns,
                 const std::string& units, const Make& number) {
  put_table<double>(file, group, name, count, columns, units, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, number);
}

template <int N>
void put_attributes(const Elements<N>& elements, const H5File& file, const ElementFileOptions& options,
                    const fs::path& path) {
  const H5Handle group = file.create_group("/attributes");
  FileNames names({"."});
  const std::size_t count = elements.centroids.size();
  double done = 0.5;
  for (const Attribute& attribute : elements.attributes) {
    tick(options.work.progress, done, path);
    done += 0.5 / static_cast<double>(elements.attributes.size());
    std::string name = attribute.name.empty() ? "_" : attribute.name;
    std::replace(name.begin(), name.end(), '/', '_');
    const auto width = static_cast<std::uint64_t>(attribute.width);
    put_numbers(file, group.id(), names.make(name), count, width == 1 ? 0 : width, attribute.unit,
                [&](std::uint64_t e, std::uint64_t c) { return attribute.values[e * width + c]; });
  }
}

template <int N>
void write_hdf5(const Elements<N>& elements, const PendingPath& pending, const ElementFileOptions& options) {
  const H5Quiet quiet;
  const fs::path& path = pending.target();
  H5File file = H5File::create(pending.path(), path);
  // names and units of columns
  const std::array<int, N> order = order_of<N>(options);
  std::string axes, units, component_units;
  for (int i = 0; i < N; ++i) {
    const char* const end = i + 1 < N ? "\n" : "";
    axes += name_of_axis(elements, order[i]) + end;
    units += elements.axis_units[order[i]] + end;
    component_units += unit_of_component(elements, order[i]) + end;
  }
  {
    // attributes of the file
    const H5Handle root = file.open_group("/");
    file.put_text(root.id(), "format", "tegl elements 1");
    file.put_text(root.id(), "axes", axes);
    file.put_text(root.id(), "components",
                  options.components == ElementComponents::covariant ? "covariant" : "contravariant");
    file.put_text(root.id(), "direction", elements.direction == GradientDirection::descent ? "descent" : "ascent");
    // datasets
    const std::size_t count = elements.centroids.size();
    tick(options.work.progress, 0.0, path);
    put_numbers(file, root.id(), "centroid", count, N, units,
                [&](std::uint64_t e, std::uint64_t c) { return elements.centroids[e][order[c]]; });
    tick(options.work.progress, 0.2, path);
    put_numbers(file, root.id(), "dsigma", count, N, component_units, [&](std::uint64_t e, std::uint64_t c) {
      return sign_of<N>(order[c], options) * elements.normals[e][order[c]] + 0.0;
    });
    tick(options.work.progress, 0.4, path);
    put_numbers(file, root.id(), "measure", count, 0, "",
                [&](std::uint64_t e, std::uint64_t) { return elements.measures[e]; });
    put_table<std::uint32_t>(file, root.id(), "simplices", count, 0, "", H5T_STD_U32LE, H5T_NATIVE_UINT32,
                             [&](std::uint64_t e, std::uint64_t) { return elements.counts[e]; });
    put_attributes(elements, file, options, path);
  }
  tick(options.work.progress, 1.0, path);
  file.close();
}

}  // namespace

template <int N>
requires DimensionBetween<N, 2, 5> std::vector<std::string> element_columns(const Elements<N>& elements,
                                                                            const ElementFileOptions& options) {
  std::vector<std::string> columns;
  for (const char* prefix : {"", "dsigma_"})
    for (const int axis : order_of<N>(options)) columns.push_back(prefix + name_of_axis(elements, axis));
  for (const Attribute& attribute : elements.attributes)
    for (int i = 0; i < attribute.width; ++i)
      columns.push_back(word(attribute.name) + (attribute.width == 1 ? "" : "_" + std::to_string(i)));
  return columns;
}

template <int N>
requires DimensionBetween<N, 2, 5>
void write_elements(const Elements<N>& elements, const fs::path& path, const ElementFileOptions& options) {
  const std::string extension = lower(path.extension().string());
  const bool is_text = extension == ".dat" || extension == ".txt";
  if (!is_text && extension != ".h5" && extension != ".hdf5")
    fail(ErrorCode::UnsupportedFormat, path, "'{}' is not a format of elements; expected .dat, .txt, .h5 or .hdf5",
         extension);
  write_complete_file(path, [&](const PendingPath& file) {
    is_text ? write_lines(elements, file, options) : write_hdf5(elements, file, options);
  });
}

#define TEGL_INSTANTIATE(N)                                                                            \
  template std::vector<std::string> element_columns<N>(const Elements<N>&, const ElementFileOptions&); \
  template void write_elements<N>(const Elements<N>&, const std::filesystem::path&, const ElementFileOptions&);
TEGL_INSTANTIATE(2)
TEGL_INSTANTIATE(3)
TEGL_INSTANTIATE(4)
TEGL_INSTANTIATE(5)
#undef TEGL_INSTANTIATE

}  // namespace tegl
