// SPDX-License-Identifier: BSD-3-Clause
//
// Implements read_image: detects the format and performs the steps common to all formats.
#include "images/images.hpp"

#include <array>
#include <memory>
#include <new>
#include <string_view>

#include "base/collected_values.hpp"
#include "base/common.hpp"
#include "base/inflate.hpp"
#include "base/raw_image.hpp"
#include "base/sample_reader.hpp"
#include "dicom/dicom.hpp"
#include "images/members.hpp"
#include "images/metaimage.hpp"
#include "images/netcdf.hpp"
#include "images/nifti.hpp"
#include "images/npy.hpp"
#include "images/nrrd.hpp"
#include "images/vtk_image.hpp"
#include "process/separate_reading.hpp"
#include "tegl/curved.hpp"
#include "vtk/pvd.hpp"

namespace tegl {

namespace fs = std::filesystem;

namespace {

using namespace io_detail;

enum class Format { Nifti, Nrrd, MetaImage, NetCdf, Npy, Npz, Vtk, Pvd };

struct Extension {
  std::string_view text;
  Format format;
};

constexpr std::array<Extension, 24> kExtensions = {
    {{".nii", Format::Nifti},     {".nii.gz", Format::Nifti},  {".hdr", Format::Nifti},  {".hdr.gz", Format::Nifti},
     {".img", Format::Nifti},     {".img.gz", Format::Nifti},  {".nrrd", Format::Nrrd},  {".nhdr", Format::Nrrd},
     {".mha", Format::MetaImage}, {".mhd", Format::MetaImage}, {".nc", Format::NetCdf},  {".nc.gz", Format::NetCdf},
     {".cdf", Format::NetCdf},    {".cdf.gz", Format::NetCdf}, {".nc4", Format::NetCdf}, {".nc4.gz", Format::NetCdf},
     {".netcdf", Format::NetCdf}, {".npy", Format::Npy},       {".npz", Format::Npz},    {".vti", Format::Vtk},
     {".vtr", Format::Vtk},       {".vts", Format::Vtk},       {".vtu", Format::Vtk},    {".pvd", Format::Pvd}}};

/// By extension; a file with an unknown extension, by its first bytes.
Format format_of(const fs::path& path) {
  const std::string name = lower_name(path);
  for (const Extension& extension : kExtensions)
    if (name.ends_with(extension.text)) return extension.format;
  const auto prefix = read_prefix(path, 348);
  const std::string_view start(reinterpret_cast<const char*>(prefix.data()), prefix.size());
  if (start.starts_with("NRRD000")) return Format::Nrrd;
  if (start.starts_with("<VTKFile") || (start.starts_with("<?xml") && start.find("<VTKFile") != start.npos))
    return Format::Vtk;
  if (start.starts_with("# vtk DataFile"))
    fail(ErrorCode::UnsupportedFormat, path,
         "VTK's old format; expected VTK's XML: .vti, .vtr, .vts, .vtu or .pvd (ParaView saves data in these)");
  if (start.starts_with("\x93NUMPY")) return Format::Npy;
  if (start.starts_with("CDF") || start.starts_with("\x89HDF")) return Format::NetCdf;
  if (start.size() == 348 && (start.substr(344, 3) == "n+1" || start.substr(344, 3) == "ni1")) return Format::Nifti;
  fail(ErrorCode::UnsupportedFormat, path,
       "unknown image format, by its name and first bytes {}; expected NIfTI (.nii, .nii.gz, .hdr/.img), NRRD (.nrrd, "
       ".nhdr), MetaImage (.mha, .mhd), NumPy (.npy, .npz), netCDF (.nc, .cdf, .nc4, also gzipped), VTK (.vti, .vtr, "
       ".pvd) or DICOM (.dcm, a folder)",
       shown(std::span(prefix).first(std::min<std::size_t>(8, prefix.size()))));
}

StoredImage open_stored(const fs::path& path, Format format, const ReadImageOptions& options) {
  if (!options.variable.empty() && format != Format::Npz)
    fail(ErrorCode::InvalidArgument, path, "variable '{}' for a file with one image and no variables; expected none",
         options.variable);
  if (!options.fixed.empty())
    fail(ErrorCode::InvalidArgument, path,
         "an index of the dimension '{}' for a file whose dimensions have no names; expected none, or a netCDF file",
         options.fixed[0].dimension);
  switch (format) {
    case Format::Nifti:
      return open_nifti(path, options.keep_stored);
    case Format::Nrrd:
      return open_nrrd(path, options.allow_outside_paths);
    case Format::Npy:
      return open_npy(path);
    case Format::Npz:
      return open_npz(path, options.variable);
    default:
      return open_metaimage(path, options.allow_outside_paths);
  }
}

/// Reads all samples, and converts them block by block.
ValueArray read_converted(SampleReader& reader, std::uint64_t count, const StoredImage& stored,
                          const Progress& progress) {
  CollectedValues all(static_cast<std::size_t>(count));
  for (std::uint64_t first = 0; first < count; first += CollectedValues::kBlock) {
    const std::uint64_t size = std::min<std::uint64_t>(CollectedValues::kBlock, count - first);
    const auto of_all = [&](double fraction) {
      return progress((static_cast<double>(first) + fraction * static_cast<double>(size)) / static_cast<double>(count));
    };
    all.add(stored.convert(reader.read(first, size, progress ? Progress(of_all) : Progress())));
  }
  return all.take();
}

RawImage read_stored(StoredImage&& stored, Extent extent, const Progress& progress) {
  SampleReader reader(std::move(stored.samples));
  const std::vector<std::uint64_t>& sizes = reader.samples().sizes;
  const std::uint64_t count = extent == Extent::whole ? checked_bytes(sizes, 1, reader.samples().path) : 0;
  ValueArray values;
  try {
    if (stored.convert && count > 0)
      values = read_converted(reader, count, stored, progress);
    else
      values = reader.read(0, count, progress);
  } catch (const std::bad_alloc&) {
    fail(ErrorCode::TooLarge, reader.samples().path, "{} values of type {} do not fit into memory", count,
         reader.samples().type);
  }
  if (stored.list_axis && extent == Extent::whole) {
    std::uint64_t inner = 1;
    for (std::size_t a = 0; a < *stored.list_axis; ++a) inner *= sizes[a];
    const std::uint64_t outer = count / sizes[*stored.list_axis] / inner;
    values = with_axis_last(values, inner, sizes[*stored.list_axis], outer);
  }
  if (stored.is_reversed && extent == Extent::whole) values = with_axes_reversed(values, {sizes.begin(), sizes.end()});
  if (stored.convert && count == 0) values = stored.convert(std::move(values));
  return {std::move(stored.grid), std::move(values), std::move(stored.info)};
}

RawLayers open_stored_layers(StoredImage&& stored, const fs::path& path) {
  if (stored.list_axis)
    fail(ErrorCode::UnsupportedData, path,
         "a list of images along axis {} of {} in the file cannot be read layer by layer; expected the list along the "
         "last axis",
         *stored.list_axis, stored.samples.sizes.size());
  if (stored.is_reversed)
    fail(ErrorCode::UnsupportedData, path,
         "an array in Fortran order, whose layers are not contiguous, cannot be read layer by layer; expected C order "
         "(numpy.ascontiguousarray)");
  const std::uint64_t per_layer = checked_bytes(stored.samples.sizes, 1, path) / stored.grid.axes.back().size();
  RawLayers layers;
  layers.grid = std::move(stored.grid);
  layers.info = std::move(stored.info);
  layers.read = [reader = std::make_shared<SampleReader>(std::move(stored.samples)), per_layer,
                 convert = std::move(stored.convert)](std::size_t first, std::size_t count) {
    ValueArray values = reader->read(first * per_layer, count * per_layer, {});
    return convert ? convert(std::move(values)) : values;
  };
  return layers;
}

RawLayers open_dicom_with(const fs::path& path, bool keep_stored, const ReadImageOptions& options) {
  if (!options.fixed.empty())
    fail(ErrorCode::InvalidArgument, path,
         "an index of the dimension '{}' for DICOM, whose dimensions have no names; expected none, or a netCDF file",
         options.fixed[0].dimension);
  return open_dicom(std::span(&path, 1), options.variable, keep_stored, options.work.progress);
}

/// The images of a collection, over time.
RawLayers open_pvd_layers(const fs::path& path, const ReadImageOptions& options) {
  SeriesOptions series;
  std::vector<fs::path> files;
  for (PvdStep& step : read_pvd(path, options.allow_outside_paths)) {
    files.push_back(std::move(step.file));
    series.coordinates.push_back(step.time);
  }
  series.work = options.work;
  const auto read = [options](const fs::path& file, Extent extent, const Progress& progress) {
    ReadImageOptions own = options;
    own.work.progress = progress;
    return read_any(file, extent, own);
  };
  if (files.size() == 1) return open_any_layers(files[0], options);
  return open_members(files, series, read).layers;
}

RawImage all_layers(RawLayers&& layers, Extent extent) {
  const std::size_t count = extent == Extent::whole ? layers.grid.axes.back().size() : 0;
  ValueArray values = layers.read(0, count);
  return {std::move(layers.grid), std::move(values), std::move(layers.info)};
}

/// The lattice that the file records, unless it is to be read as cubic.
void settle_recorded_lattice(const RawGrid& grid, ImageInfo& info, const fs::path& path,
                             const ReadImageOptions& options) {
  if (options.as_cubic) info.lattice.reset();
  io_detail::settle_lattice(grid, info, path);
}

}  // namespace

RawImage io_detail::read_any(const fs::path& path, Extent extent, const ReadImageOptions& options) {
  if (is_dicom(path)) {
    return all_layers(open_dicom_with(path, options.keep_stored, options), extent);
  }
  require_readable_file(path);
  const Format format = format_of(path);
  if (format == Format::Vtk) return read_vtk_image(path, extent, options);
  if (format == Format::Pvd) return all_layers(open_pvd_layers(path, options), extent);
  RawImage image = format == Format::NetCdf
                       ? read_netcdf(path, extent, options)
                       : read_stored(open_stored(path, format, options), extent, options.work.progress);
  drop_trailing_axes(image.grid, image.info);
  settle_recorded_lattice(image.grid, image.info, path, options);
  return image;
}

RawLayers io_detail::open_any_layers(const fs::path& path, const ReadImageOptions& options) {
  if (is_dicom(path)) return open_dicom_with(path, false, options);
  require_readable_file(path);
  const Format format = format_of(path);
  if (format == Format::NetCdf) {
    RawLayers layers = open_netcdf_layers(path, options);
    settle_recorded_lattice(layers.grid, layers.info, path, options);
    return layers;
  }
  if (format == Format::Vtk) return open_vtk_layers(path, options);
  if (format == Format::Pvd) return open_pvd_layers(path, options);
  ReadImageOptions converted = options;
  converted.keep_stored = false;
  StoredImage stored = open_stored(path, format, converted);
  drop_trailing_axes(stored.grid, stored.info);
  settle_recorded_lattice(stored.grid, stored.info, path, options);
  return open_stored_layers(std::move(stored), path);
}

ReadImageResult read_image(const fs::path& path, const ReadImageOptions& options) {
  tick(options.work.progress, 0.0, path);
  const auto read = [&](const Progress& progress) {
    ReadImageOptions own = options;
    own.work.progress = progress;
    return ImageOfFiles{read_any(path, Extent::whole, own), {}};
  };
  const bool separate = options.separate_process && needs_separate_process(path);
  RawImage image = (separate ? read_separately(path, options.work.progress, read) : read(options.work.progress)).image;
  // Contours take less time, and coordinates that float represents less memory. Not in a child, which has one thread.
  image.info.curved = by_points(std::move(image.info.curved), options.work.threads);
  ImageInfo info = image.info;  // errors about the axes name the format
  AnyImage result = to_any_image(std::move(image), path);
  tick(options.work.progress, 1.0, path);
  return {std::move(result), std::move(info)};
}

std::vector<ImageVariable> list_image_variables(const fs::path& path, const ReadImageOptions& options) {
  if (options.separate_process && needs_separate_process(path))
    return read_separately(path, [&] {
      ReadImageOptions own = options;
      own.separate_process = false;
      return list_image_variables(path, own);
    });
  if (is_dicom(path)) return list_dicom(path);
  require_readable_file(path);
  const Format format = format_of(path);
  if (format == Format::NetCdf) return list_netcdf(path, options.allow_outside_paths);
  if (format == Format::Vtk) return list_vtk_image(path);
  if (format == Format::Pvd) return list_vtk_image(read_pvd(path, options.allow_outside_paths).front().file);
  return format == Format::Npz ? list_npz(path) : std::vector<ImageVariable>();
}

}  // namespace tegl
