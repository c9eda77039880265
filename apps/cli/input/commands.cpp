// SPDX-License-Identifier: BSD-3-Clause
//
// Implements the base class of the commands: FILE, common options, and reading of the input.
#include "input/commands.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "output/output.hpp"

namespace tegl::cli {

namespace {

/// Options to read a file as an image or a mesh.
template <class Options>
Options reading_options(const ImageOptions& given, Progress progress) {
  Options options;
  options.work.progress = std::move(progress);
  options.allow_outside_paths = given.allow_outside_paths();
  options.separate_process = given.separate_process();
  return options;
}

}  // namespace

Command::Command(CLI::App& program, const std::string& name, const std::string& description,
                 const std::string& file_help, Files files)
    : app_(program.add_subcommand(name, description)), files_kind_(files) {
  if (files == Files::one)
    app_->add_option("FILE", files_.front(), file_help)->required();
  else
    app_->add_option("FILE", files_, file_help)->required();
  app_->parse_complete_callback(
      [this, files] { worked_on_ = files == Files::each ? std::vector{files_.front()} : files_; });
  app_->add_flag("--allow-outside-paths", images_.allow_outside_paths(),
                 "read files that FILE refers to (samples of NRRD and MetaImage headers, glTF buffers, HDF5 links) "
                 "from anywhere, not only from its folder and below");
  json_option_ = app_->add_flag("--json", json_, "the report as JSON on standard output; errors as JSON too");
  images_.add_in_process_to(*app_);
}

ReadImageOptions Command::image_options(Progress progress) const {
  return reading_options<ReadImageOptions>(images_, std::move(progress));
}

ReadMeshOptions Command::mesh_options(Progress progress) const {
  return reading_options<ReadMeshOptions>(images_, std::move(progress));
}

void Command::add_quiet() {
  app_->add_flag("-q,--quiet", quiet_, "no report and no progress bar")->excludes(json_option_);
}

unsigned Command::threads_wanted() const {
  const CLI::Option* const option = app_->get_option_no_throw("--threads");
  return option == nullptr || option->count() == 0 ? 0 : option->as<unsigned>();
}

ReadImageResult Command::read(const Progress& progress, CurvedGrids curved) {
  take_cubic();
  ReadSeriesResult result = images_.read(worked_on_, progress);
  take_order(result.files);
  settle_curved(result.info, curved);
  settle_lattice(result.info);
  return {std::move(result.image), std::move(result.info)};
}

std::variant<ReadImageResult, ReadImage5dResult> Command::read_to_5d(const Progress& progress, CurvedGrids curved,
                                                                     bool keep_stored) {
  take_cubic();
  auto any = images_.read_to_5d(worked_on_, progress, keep_stored);
  std::visit([&](const auto& read) { take_order(read.files); }, any);
  if (auto* const read = std::get_if<ReadSeries5dResult>(&any)) {
    settle_curved(read->info, curved);
    return ReadImage5dResult{std::move(read->image), std::move(read->info)};
  }
  auto& read = std::get<ReadSeriesResult>(any);
  settle_curved(read.info, curved);
  settle_lattice(read.info);
  return ReadImageResult{std::move(read.image), std::move(read.info)};
}

OpenLayersResult Command::open() {
  take_cubic();
  OpenSeriesResult result = images_.open(worked_on_);
  take_order(result.files);
  settle_curved(result.info, CurvedGrids::refused);
  settle_lattice(result.info);
  return {std::move(result.layers), std::move(result.info)};
}

void Command::settle_curved(ImageInfo& info, CurvedGrids curved) const {
  if (images_.index_grid() && info.format != "netCDF" && info.curved.empty())
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("--index-grid with {}, which is {}; expected it with a curved grid: a netCDF file, or a "
                            ".vts file with --curved-grid",
                            worked_on_.front(), info.format));
  if (images_.index_grid()) info.curved.clear();
  if (info.curved.empty() || curved == CurvedGrids::allowed) return;
  std::vector<std::string> names;
  for (const CurvedAxis& one : info.curved) names.push_back(one.name);
  throw Error(
      ErrorCode::UnsupportedData,
      fmt::format("{} has a curved grid ({} in arrays of several dimensions), which this command or option does "
                  "not know; expected --index-grid, for indices as coordinates",
                  worked_on_.front(), fmt::join(names, ", ")));
}

void Command::take_cubic() {
  const CLI::Option* const option = app_->get_option_no_throw("--lattice");
  if (option != nullptr && option->count() > 0 && option->as<std::string>() == "cubic") images_.read_as_cubic();
}

void Command::settle_lattice(const ImageInfo& info) const {
  if (!info.lattice || knows_lattices()) return;
  throw Error(ErrorCode::UnsupportedData,
              fmt::format("{} is on the lattice {}, which this command does not know: it takes samples as neighbours "
                          "that are those of a cubic grid; expected an image on a cubic grid",
                          worked_on_.front(), name_of(*info.lattice)));
}

void Command::take_order(const std::vector<std::filesystem::path>& files) {
  if (files.size() != worked_on_.size()) return;
  std::transform(files.begin(), files.end(), worked_on_.begin(),
                 [](const std::filesystem::path& file) { return file.string(); });
}

void Command::require_inputs() const {
  for (const std::string& name : worked_on_)
    require_input(name, files_kind_ == Files::one ? Folders::refused : Folders::allowed);
}

}  // namespace tegl::cli
