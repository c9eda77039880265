// SPDX-License-Identifier: BSD-3-Clause
//
// Implements --attribute: parses files and variables, reads the images and interpolates them at the vertices.
#include "input/attributes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include "input/curved_images.hpp"
#include "input/extraction.hpp"
#include "input/repeated_image.hpp"
#include "output/output.hpp"
#include "tegl/io/cell_meshes.hpp"
#include "tegl/sample.hpp"

namespace tegl::cli {

namespace {

namespace fs = std::filesystem;

/// File name without extensions: "salinity" for "data/salinity.nii.gz".
std::string stem(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.substr(0, std::max<std::size_t>(1, std::min(name.find('.', 1), name.size())));
}

bool is_same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// Throws unless the coordinates of an image's curved grid are those of the contour's.
void require_same_grid(const std::string& file, const std::vector<CurvedAxis>& image,
                       std::span<const CurvedAxis> contour) {
  const auto is_equal = [](const CurvedAxis& a, const CurvedAxis& b) {
    return a.axis == b.axis && a.along == b.along &&
           std::equal(a.values.begin(), a.values.end(), b.values.begin(), b.values.end(), is_same);
  };
  if (std::equal(image.begin(), image.end(), contour.begin(), contour.end(), is_equal)) return;
  throw Error(
      ErrorCode::UnsupportedData,
      fmt::format("{} has a curved grid, and the contour {}; expected the coordinates of the contour's own image, "
                  "or straight axes (--index-grid: the indices)",
                  file, contour.empty() ? "has none" : "another one"));
}

/// Reads an image of --attribute, which its errors name: they may name only a file that it refers to.
ReadImageResult read_attribute(const std::string& file, const ReadImageOptions& options) {
  try {
    return read_other_image(file, options);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::Cancelled || std::string_view(error.what()).find(file) != std::string_view::npos)
      throw;
    throw Error(error.code(), fmt::format("--attribute {}: {}", file, error.what()));
  }
}

/// Throws: the image has nothing to do with the contour, whose image has the sizes `own`.
[[noreturn]] void throw_unrelated(const std::string& file, const AnyImage& image, const std::vector<std::size_t>& own,
                                  const char* reason) {
  throw Error(ErrorCode::UnsupportedData,
              fmt::format("--attribute {}: an image of {} samples; the image that is contoured has {}: {}", file,
                          fmt::join(sizes_of(image), " x "), fmt::join(own, " x "), reason));
}

}  // namespace

std::vector<std::size_t> sizes_of(const AnyImage& image) {
  std::vector<std::size_t> sizes;
  const auto of_owned = [&](const auto& owned) {
    for (const Axis& axis : owned.grid.axes) sizes.push_back(axis.size());
  };
  std::visit([&](const auto& typed) { std::visit(of_owned, typed); }, image);
  return sizes;
}

ReadImageResult read_other_image(const std::string& file, const ReadImageOptions& options) {
  try {
    return read_image(file, options);
  } catch (const Error& error) {
    throw Error(error.code(), with_option_names(error.what()));
  }
}

FileAndVariable parse_file_and_variable(const std::string& text) {
  std::error_code ignored;
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || colon == 0 || fs::exists(text, ignored)) return {text, {}};
  for (std::size_t at = colon; at != std::string::npos && at > 0; at = text.rfind(':', at - 1))
    if (fs::exists(text.substr(0, at), ignored)) return {text.substr(0, at), text.substr(at + 1)};
  return {text.substr(0, colon), text.substr(colon + 1)};
}

void AttributeOptions::add_to(CLI::App& app) {
  app.add_option("--attribute", texts_,
                 "values of another image, or of another array of the mesh, at the vertices: FILE, or FILE:VARIABLE; "
                 "may be given again")
      ->allow_extra_args(false)
      ->type_name("FILE[:VAR]");
}

std::vector<std::string> AttributeOptions::files() const {
  std::vector<std::string> files;
  for (const std::string& text : texts_) files.push_back(parse_file_and_variable(text).file);
  return files;
}

std::vector<FileAndVariable> AttributeOptions::meshes(bool allow_outside_paths) const {
  std::vector<FileAndVariable> result;
  for (const std::string& text : texts_)
    if (FileAndVariable from = parse_file_and_variable(text); is_cell_mesh_file(from.file, allow_outside_paths))
      result.push_back(std::move(from));
  return result;
}

void AttributeOptions::keep_sizes_of(const AnyImage& image) { sizes_ = sizes_of(image); }

void AttributeOptions::require_inputs() const {
  for (const std::string& file : files()) require_input(file, Folders::allowed);
}

template <int N, class Real>
void AttributeOptions::sample_to(Contour<N, Real>& contour, ReadImageOptions reading, unsigned threads,
                                 ProgressBar& bar, const std::type_identity_t<CurvedContour<N, Real>>& curved) const {
  for (const std::string& text : texts_) {
    const FileAndVariable from = parse_file_and_variable(text);
    if (curved.of_mesh && is_cell_mesh_file(from.file, reading.allow_outside_paths)) continue;
    const Progress progress = bar.stage("attribute");
    reading.variable = from.variable;
    reading.work.progress = [&](double fraction) { return progress(0.7 * fraction); };
    const ReadImageResult input = read_attribute(from.file, reading);
    if (image_dim(input.image) != N)
      throw Error(ErrorCode::UnsupportedData,
                  fmt::format("{}: an image of {} dimensions for a contour in {}D; expected {}", from.file,
                              image_dim(input.image), N, N));
    const std::string name = input.info.variable.empty() ? stem(from.file) : input.info.variable;
    for (const Attribute& other : contour.vertex_attributes)
      if (other.name == name)
        throw Error(
            ErrorCode::InvalidArgument,
            fmt::format("--attribute {}: the contour already has an attribute '{}'; expected each once", text, name));
    if (curved.by_index && !sizes_.empty() && sizes_of(input.image) != sizes_)
      throw_unrelated(from.file, input.image, sizes_, "expected the same sizes with --index-grid");
    if (curved.on_lattice) {
      Attribute& attribute = contour.vertex_attributes.emplace_back(curved.on_lattice(input, from.file));
      attribute.name = name;
      attribute.unit = input.info.value_unit;
      continue;
    }
    if (input.info.lattice)
      throw Error(
          ErrorCode::UnsupportedData,
          fmt::format("--attribute {}: an image on the lattice {}, and the contour is not; expected an image on "
                      "a cubic grid",
                      from.file, name_of(*input.info.lattice)));
    const bool is_curved = !curved.by_index && !input.info.curved.empty();
    if (is_curved) require_same_grid(from.file, input.info.curved, curved.axes);
    const auto sampling = [&](double fraction) { return progress(0.7 + 0.3 * fraction); };
    const auto sample_owned = [&](const auto& owned) {
      const WorkOptions work{threads, sampling};
      const std::string& unit = input.info.value_unit;
      contour.vertex_attributes.push_back(
          is_curved ? sample(on_indices(owned, input.info.curved), *curved.in_indices, name, unit, work)
                    : sample_across_periods(owned, contour, name, unit, work));
    };
    std::visit(sample_owned, std::get<AnyImageN<N>>(input.image));
    const auto& values = contour.vertex_attributes.back().values;
    if (!curved.axes.empty() && !values.empty() &&
        std::all_of(values.begin(), values.end(), [](double value) { return std::isnan(value); }))
      throw_unrelated(from.file, input.image, sizes_,
                      "it has no value at any vertex of the contour; expected an image that covers the contour");
  }
}

#define TEGL_INSTANTIATE_SAMPLE_TO(N, Real)                                                              \
  template void AttributeOptions::sample_to(Contour<N, Real>&, ReadImageOptions, unsigned, ProgressBar&, \
                                            const CurvedContour<N, Real>&) const;
TEGL_INSTANTIATE_SAMPLE_TO(2, float)
TEGL_INSTANTIATE_SAMPLE_TO(2, double)
TEGL_INSTANTIATE_SAMPLE_TO(3, float)
TEGL_INSTANTIATE_SAMPLE_TO(3, double)
TEGL_INSTANTIATE_SAMPLE_TO(4, float)
TEGL_INSTANTIATE_SAMPLE_TO(4, double)
#undef TEGL_INSTANTIATE_SAMPLE_TO

}  // namespace tegl::cli
