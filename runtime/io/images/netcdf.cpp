// SPDX-License-Identifier: BSD-3-Clause
//
// Reads netCDF variables as images: selects the variable, and applies packing and missing values.
//
// Based on: "NetCDF Climate and Forecast (CF) Metadata Conventions" 1.10, sections 2.5 and 8; the attribute conventions
// of the NetCDF Users' Guide.
#include "images/netcdf.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/ranges.h>

#include "base/collected_values.hpp"
#include "base/common.hpp"
#include "base/reading_process.hpp"
#include "base/stored_integers.hpp"
#include "images/netcdf_coordinates.hpp"
#include "images/netcdf_file.hpp"
#include "images/netcdf_packing.hpp"

namespace tegl::io_detail {

namespace {

/// Number of dimensions longer than 1.
std::size_t rank(const std::vector<std::size_t>& sizes) {
  return static_cast<std::size_t>(std::count_if(sizes.begin(), sizes.end(), [](std::size_t size) { return size > 1; }));
}

bool is_image_rank(std::size_t axes) { return axes >= 2 && axes <= 5; }

/// Names and sizes of the dimensions longer than 1, fastest first.
ImageVariable describe(const NcFile& file, const NcVariable& variable) {
  ImageVariable result;
  result.name = variable.name;
  for (std::size_t d = variable.sizes.size(); d-- > 0;) {
    if (variable.sizes[d] == 1) continue;
    result.sizes.push_back(variable.sizes[d]);
    result.axes.push_back(file.dimension_name(variable, d));
  }
  return result;
}

/// The samples of a variable at fixed indices. Fixed dimensions that the variable does not have are ignored.
NcSlab slab_of(const NcFile& file, const NcVariable& variable, const std::vector<FixedIndex>& fixed) {
  NcSlab slab = whole(variable);
  for (std::size_t d = 0; d < variable.sizes.size() && !fixed.empty(); ++d) {
    const std::string name = file.dimension_name(variable, d);
    for (const FixedIndex& one : fixed) {
      if (one.dimension != name) continue;
      if (one.index >= variable.sizes[d])
        fail(ErrorCode::InvalidArgument, file.path(), "{}={}; expected an index from 0 to {} of the dimension of '{}'",
             name, one.index, variable.sizes[d] - std::min<std::size_t>(variable.sizes[d], 1), variable.name);
      slab.start[d] = one.index;
      slab.count[d] = 1;
    }
  }
  return slab;
}

/// Throws unless the variable has each fixed dimension, and each is given once.
void require_dimensions(const NcFile& file, const NcVariable& variable, const std::vector<FixedIndex>& fixed) {
  std::vector<std::string> names;
  for (std::size_t d = 0; d < variable.sizes.size(); ++d) names.push_back(file.dimension_name(variable, d));
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    const std::string& name = fixed[i].dimension;
    if (std::ranges::find(names, name) == names.end())
      fail(ErrorCode::InvalidArgument, file.path(), "variable '{}' has no dimension '{}'; expected one of {}",
           variable.name, name, fmt::join(names, ", "));
    for (std::size_t j = 0; j < i; ++j)
      if (fixed[j].dimension == name)
        fail(ErrorCode::InvalidArgument, file.path(), "two indices of the dimension '{}', {} and {}; expected one",
             name, fixed[j].index, fixed[i].index);
  }
}

/// The variables that are images, possibly after fixing some dimensions.
std::vector<NcVariable> image_variables(const NcFile& file, const std::vector<NcVariable>& all) {
  std::set<std::string, std::less<>> auxiliary;  // bounds or coordinates of other variables
  for (const NcVariable& variable : all)
    for (const char* attribute : {"bounds", "climatology", "coordinates", "cell_measures", "grid_mapping"}) {
      const std::string names = file.text(variable, attribute);
      for (const std::string_view word : words(names)) auxiliary.emplace(word);
    }
  std::vector<NcVariable> result;
  for (const NcVariable& variable : all) {
    const std::string plain = variable.name.substr(variable.name.rfind('/') + 1);
    const bool empty = std::find(variable.sizes.begin(), variable.sizes.end(), 0U) != variable.sizes.end();
    if (is_numeric(variable.type) && rank(variable.sizes) >= 2 && !empty && !auxiliary.contains(plain))
      result.push_back(variable);
  }
  return result;
}

/// Sizes of all dimensions, fastest first.
std::string image_shape(const NcVariable& variable) {
  return shape_text(std::vector<std::size_t>(variable.sizes.rbegin(), variable.sizes.rend()));
}

std::string listing(const std::vector<NcVariable>& variables) {
  std::vector<std::string> items;
  for (const NcVariable& variable : variables)
    items.push_back(fmt::format("{} ({})", variable.name, image_shape(variable)));
  return fmt::format("{}", fmt::join(items, ", "));
}

NcVariable choose(const NcFile& file, const std::vector<NcVariable>& all, const std::vector<NcVariable>& candidates,
                  const ReadImageOptions& options) {
  const std::string& wanted = options.variable;
  if (!wanted.empty()) {
    for (const NcVariable& variable : all)
      if (variable.name == wanted || variable.name == "/" + wanted) return variable;
    fail(ErrorCode::VariableNotFound, file.path(), "no variable '{}'; expected one of {}", wanted,
         candidates.empty() ? "none: no variable here has 2 or more axes" : listing(candidates));
  }
  if (candidates.size() == 1) return candidates[0];
  // one of 2 to 4 axes before one of 5
  std::vector<NcVariable> usual, fitting;
  for (const NcVariable& variable : candidates) {
    const std::size_t axes = rank(slab_of(file, variable, options.fixed).count);
    if (is_image_rank(axes)) fitting.push_back(variable);
    if (is_image_rank(axes) && axes < 5) usual.push_back(variable);
  }
  if (usual.size() == 1) return usual[0];
  if (fitting.size() == 1) return fitting[0];
  if (candidates.empty())
    fail(ErrorCode::UnsupportedData, file.path(), "no variable with 2 to 5 axes longer than 1; it has {}",
         all.empty() ? "no variables" : listing(all));
  fail(ErrorCode::VariableNotFound, file.path(), "{} variables, and none chosen; expected one of {}", candidates.size(),
       listing(candidates));
}

/// Moves the grid's last axis to the end; the values have the file's order and `count` samples along that axis.
ValueArray in_order(ValueArray&& values, const VariableGrid& grid, std::size_t count) {
  const std::vector<Axis>& axes = grid.grid.axes;
  std::size_t inner = 1;
  std::size_t outer = 1;
  for (std::size_t a = 0; a + 1 < axes.size(); ++a) (a < grid.time_axis ? inner : outer) *= axes[a].size();
  return outer == 1 || count == 1 ? std::move(values) : with_axis_last(values, inner, count, outer);
}

struct Found {
  NcVariable variable;
  NcSlab slab;
  ImageInfo info;
};

/// Throws unless the selected samples of a variable form an image.
void require_image(const NcFile& file, const NcVariable& variable, const NcSlab& slab) {
  if (std::find(variable.sizes.begin(), variable.sizes.end(), 0U) != variable.sizes.end())
    fail(ErrorCode::UnsupportedData, file.path(), "variable '{}' is {}; expected at least one sample", variable.name,
         image_shape(variable));
  const std::size_t axes = rank(slab.count);
  if (is_image_rank(axes)) return;
  const bool is_fixed = axes < rank(variable.sizes);
  if (axes < 2)
    fail(ErrorCode::UnsupportedData, file.path(), "variable '{}' is {}{}; expected 2 to 5 axes longer than 1",
         variable.name, variable.sizes.empty() ? "a single value" : image_shape(variable),
         is_fixed ? fmt::format(", of which the fixed indices leave {}", axes) : "");
  const ImageVariable described = describe(file, variable);
  fail(ErrorCode::UnsupportedData, file.path(),
       "variable '{}' is {} ({}){}; expected 2 to 5 axes longer than 1, or a fixed index of another dimension, such "
       "as {}=0",
       variable.name, shape_text(described.sizes), fmt::join(described.axes, ", "),
       is_fixed ? fmt::format(", of which the fixed indices leave {}", axes) : "", described.axes.back());
}

/// Throws unless only the slowest dimensions have one index: times of images on a lattice.
void require_whole_lattice(const NcFile& file, Lattice lattice, const NcSlab& slab) {
  const auto first = std::ranges::find_if(slab.count, [](std::size_t count) { return count > 1; });
  if (std::find(first, slab.count.end(), 1U) != slab.count.end())
    fail(ErrorCode::UnsupportedData, file.path(),
         "one index of a dimension of samples on the lattice {}; expected all of its samples", name_of(lattice));
}

/// Finds the requested variable, and checks that it can be an image.
Found find_variable(const NcFile& file, const ReadImageOptions& options) {
  const auto all = file.variables();
  const auto candidates = image_variables(file, all);
  const NcVariable variable = choose(file, all, candidates, options);
  require_dimensions(file, variable, options.fixed);
  const NcSlab slab = slab_of(file, variable, options.fixed);
  require_image(file, variable, slab);
  ImageInfo info;
  info.format = "netCDF";
  info.variable = variable.name;
  for (const NcVariable& candidate : candidates) info.variables.push_back(candidate.name);
  info.value_unit = file.text(variable, "units");
  info.value_name = file.text(variable, "long_name");
  if (info.value_name.empty()) info.value_name = file.text(variable, "standard_name");
  info.stored_type = parse_value_type(nc_type_name(variable.type));
  info.lattice = lattice_of_text(file.text(variable, kLatticeKey), file.path());
  if (info.lattice && !options.as_cubic) require_whole_lattice(file, *info.lattice, slab);
  return {variable, slab, info};
}

/// Restricts a slab to `count` layers along a dimension, from layer `first`.
NcSlab layers_of(NcSlab slab, std::size_t dimension, std::size_t first, std::size_t count) {
  slab.start[dimension] = first;
  slab.count[dimension] = count;
  return slab;
}

/// Reads and unpacks the values of a slab, block by block unless they stay as they are stored.
ValueArray unpacked_values(const NcFile& file, const NcVariable& variable, const NcSlab& slab, const Packing& packing,
                           const Progress& progress) {
  const bool is_real = variable.type == NC_FLOAT || variable.type == NC_DOUBLE;
  // blocks of layers along the slowest dimension with more than one sample: they are contiguous in memory
  std::size_t along = 0;
  while (along + 1 < slab.count.size() && slab.count[along] == 1) ++along;
  std::size_t layer = 1;
  for (std::size_t d = along + 1; d < slab.count.size(); ++d) layer *= slab.count[d];
  const std::size_t layers = slab.count.empty() ? 0 : slab.count[along];
  if (layers * layer <= CollectedValues::kBlock || (!is_real && !packing.any_attribute))
    return unpack(file.values(variable, slab, progress), packing);
  if (is_real && file.is_one_piece(variable, slab))
    return file.values(variable, slab, progress, [&](ValueArray& values, std::size_t first, std::size_t count) {
      unpack_reals(values, first, count, packing);
    });
  file.require_stored(variable, slab);
  expect_memory(kBytesPerValue * layers * layer);                // of all blocks: they are collected in one array
  const std::size_t chunk = file.block_length(variable, along);  // no chunk is read twice
  const std::size_t step = std::max<std::size_t>(1, CollectedValues::kBlock / layer / chunk) * chunk;
  CollectedValues all(layers * layer);
  for (std::size_t first = 0; first < layers; first += step) {
    const std::size_t count = std::min(step, layers - first);
    const auto of_all = [&](double fraction) {
      return progress((static_cast<double>(first) + fraction * static_cast<double>(count)) /
                      static_cast<double>(layers));
    };
    NcSlab part = slab;
    part.start[along] += first;
    part.count[along] = count;
    all.add(unpack(file.values(variable, part, progress ? Progress(of_all) : Progress()), packing));
  }
  return all.take();
}

/// Reads the values of a slab as they are stored and sets their scaling; unpacked if that is not possible.
ValueArray stored_values(const NcFile& file, const NcVariable& variable, const NcSlab& slab, const Packing& packing,
                         const Progress& progress, std::optional<ValueScaling>& scaling) {
  if (variable.type == NC_FLOAT || variable.type == NC_DOUBLE)
    return unpacked_values(file, variable, slab, packing, progress);
  ValueArray values = file.values(variable, slab, progress);
  scaling = stored_scaling(values, packing);
  if (!scaling) return unpack(std::move(values), packing);
  return scaling->slope < 0 ? in_reverse_order(std::move(values)) : std::move(values);
}

}  // namespace

RawImage read_netcdf(const std::filesystem::path& path, Extent extent, const ReadImageOptions& options) {
  // header
  const NcFile file(path, options.work.progress, options.allow_outside_paths);
  Found found = find_variable(file, options);
  VariableGrid grid = read_grid(file, found.variable, found.slab);
  found.info.curved = find_curved(file, found.variable, found.slab, grid, found.info.remarks);
  found.info.axis_directions = std::move(grid.directions);
  // values
  RawImage image;
  const Packing packing = read_packing(file, found.variable);
  const NcSlab slab = extent == Extent::header ? layers_of(found.slab, grid.last_dimension, 0, 0) : found.slab;
  if (options.keep_stored && packing.any_attribute && found.info.curved.empty())
    image.values = stored_values(file, found.variable, slab, packing, options.work.progress, found.info.scaling);
  else
    image.values = unpacked_values(file, found.variable, slab, packing, options.work.progress);
  if (extent == Extent::whole) image.values = in_order(std::move(image.values), grid, grid.grid.axes.back().size());
  if (extent == Extent::whole) hide_unknown(found.info.curved, grid.grid.axes, image.values);
  image.grid = std::move(grid.grid);
  image.info = std::move(found.info);
  return image;
}

RawLayers open_netcdf_layers(const std::filesystem::path& path, const ReadImageOptions& options) {
  const auto file = std::make_shared<const NcFile>(path, options.work.progress, options.allow_outside_paths);
  if (file->is_compressed())
    fail(ErrorCode::UnsupportedData, path,
         "is compressed as a whole and cannot be read layer by layer; expected an uncompressed file");
  Found found = find_variable(*file, options);
  file->require_stored(found.variable, found.slab);
  VariableGrid grid = read_grid(*file, found.variable, found.slab);
  found.info.curved = find_curved(*file, found.variable, found.slab, grid, found.info.remarks);
  found.info.axis_directions = grid.directions;
  const Packing packing = read_packing(*file, found.variable);
  expect_memory(2 * file->chunk_bytes(found.variable, sizeof(double)));
  return {grid.grid, found.info, file->block_length(found.variable, grid.last_dimension),
          [file, packing, grid, variable = found.variable, slab = found.slab](std::size_t first, std::size_t count) {
            const NcSlab layers = layers_of(slab, grid.last_dimension, first, count);
            return in_order(unpack(file->values(variable, layers), packing), grid, count);
          }};
}

std::vector<ImageVariable> list_netcdf(const std::filesystem::path& path, bool allow_outside_paths) {
  const NcFile file(path, {}, allow_outside_paths);
  std::vector<ImageVariable> result;
  for (const NcVariable& variable : image_variables(file, file.variables())) {
    ImageVariable& entry = result.emplace_back(describe(file, variable));
    entry.unit = file.text(variable, "units");
    entry.long_name = file.text(variable, "long_name");
  }
  return result;
}

}  // namespace tegl::io_detail
