// SPDX-License-Identifier: BSD-3-Clause
//
// read_image: which format a file has, and the steps that all formats share.
#include <array>
#include <cstring>
#include <string_view>

#include "common.hpp"
#include "inflate.hpp"
#include "raw_image.hpp"
#include "readers.hpp"
#include "separate_reading.hpp"

namespace tegl {

namespace fs = std::filesystem;

namespace {

using namespace io_detail;

enum class Format { Nifti, Nrrd, MetaImage, NetCdf };

struct Extension {
  std::string_view text;
  Format format;
};

constexpr std::array<Extension, 17> kExtensions = {{{".nii", Format::Nifti},
                                                    {".nii.gz", Format::Nifti},
                                                    {".hdr", Format::Nifti},
                                                    {".hdr.gz", Format::Nifti},
                                                    {".img", Format::Nifti},
                                                    {".img.gz", Format::Nifti},
                                                    {".nrrd", Format::Nrrd},
                                                    {".nhdr", Format::Nrrd},
                                                    {".mha", Format::MetaImage},
                                                    {".mhd", Format::MetaImage},
                                                    {".nc", Format::NetCdf},
                                                    {".nc.gz", Format::NetCdf},
                                                    {".cdf", Format::NetCdf},
                                                    {".cdf.gz", Format::NetCdf},
                                                    {".nc4", Format::NetCdf},
                                                    {".nc4.gz", Format::NetCdf},
                                                    {".netcdf", Format::NetCdf}}};

/// By extension, as users mean it; a file without a known one, by its first bytes.
Format format_of(const fs::path& path) {
  const std::string name = lower_name(path);
  for (const Extension& extension : kExtensions)
    if (name.ends_with(extension.text)) return extension.format;
  const auto prefix = read_prefix(path, 348);
  const std::string_view start(reinterpret_cast<const char*>(prefix.data()), prefix.size());
  if (start.starts_with("NRRD000")) return Format::Nrrd;
  if (start.starts_with("CDF") || start.starts_with("\x89HDF")) return Format::NetCdf;
  if (start.size() == 348 && (start.substr(344, 3) == "n+1" || start.substr(344, 3) == "ni1")) return Format::Nifti;
  fail(ErrorCode::UnsupportedFormat, path,
       "no image format known by its name or first bytes {}; expected NIfTI (.nii, .nii.gz, .hdr/.img), NRRD (.nrrd, "
       ".nhdr), MetaImage (.mha, .mhd), netCDF (.nc, .cdf, .nc4, also gzipped) or DICOM (.dcm, a folder)",
       shown(std::span(prefix).first(std::min<std::size_t>(8, prefix.size()))));
}

RawImage read_format(const fs::path& path, Extent extent, const ReadImageOptions& options) {
  const Format format = format_of(path);
  if (format != Format::NetCdf && !options.variable.empty())
    fail(ErrorCode::InvalidArgument, path, "variable '{}' asked of a file that holds one image without a name",
         options.variable);
  switch (format) {
    case Format::Nifti:
      return read_nifti(path, extent, options.progress);
    case Format::Nrrd:
      return read_nrrd(path, extent, options.progress);
    case Format::MetaImage:
      return read_metaimage(path, extent, options.progress);
    default:
      return read_netcdf(path, extent, options);
  }
}

}  // namespace

RawImage io_detail::read_any(const fs::path& path, Extent extent, const ReadImageOptions& options) {
  if (is_dicom(path)) {
    RawLayers layers = open_dicom(std::span(&path, 1), options.variable, options.progress);
    const std::size_t count = extent == Extent::whole ? layers.grid.axes.back().size() : 0;
    ValueArray values = layers.read(0, count);
    return {std::move(layers.grid), std::move(values), std::move(layers.info)};
  }
  require_readable_file(path);
  RawImage image = read_format(path, extent, options);
  drop_trailing_axes(image);
  return image;
}

ReadImageResult read_image(const fs::path& path, const ReadImageOptions& options) {
  tick(options.progress, 0.0, path);
  const auto read = [&](const Progress& progress) {
    ReadImageOptions own = options;
    own.progress = progress;
    return ImageOfFiles{read_any(path, Extent::whole, own), {}};
  };
  const bool separate = options.separate_process && needs_separate_process(path);
  RawImage image = (separate ? read_separately(path, options.progress, read) : read(options.progress)).image;
  ImageInfo info = std::move(image.info);
  AnyImage result = to_any_image(std::move(image), path);
  tick(options.progress, 1.0, path);
  return {std::move(result), std::move(info)};
}

std::vector<ImageVariable> list_image_variables(const fs::path& path, const ReadImageOptions& options) {
  if (options.separate_process && needs_separate_process(path))
    return read_separately(path, [&] { return list_image_variables(path); });
  if (is_dicom(path)) return list_dicom(path);
  require_readable_file(path);
  return format_of(path) == Format::NetCdf ? list_netcdf(path) : std::vector<ImageVariable>();
}

}  // namespace tegl
