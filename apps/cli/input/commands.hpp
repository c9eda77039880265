// SPDX-License-Identifier: BSD-3-Clause
//
// Base class of the commands, and their factories. A command adds its options to the command line, and runs if it is
// named.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/console.hpp"
#include "base/exit_codes.hpp"
#include "input/image_input.hpp"
#include "output/result.hpp"
#include "tegl/io/images.hpp"
#include "tegl/io/layers.hpp"
#include "tegl/io/meshes.hpp"

namespace tegl::cli {

/// The output streams of the program.
struct Streams {
  Console out{stdout};
  Console err{stderr};
};

/// Whether a command can use the coordinates of curved grids.
enum class CurvedGrids : std::uint8_t { allowed, refused };

/// A command of the program: `tegl NAME FILE ...`.
class Command {
 public:
  /// Meaning of FILE. one: one file; image: one image, from one or several files; each: several files, processed one by
  /// one.
  enum class Files { one, image, each };

  /// Adds the command with its FILE argument and --json to the command line.
  Command(CLI::App& program, const std::string& name, const std::string& description, const std::string& file_help,
          Files files = Files::one);
  virtual ~Command() = default;
  Command(const Command&) = delete;
  Command& operator=(const Command&) = delete;

  /// Runs the command. Throws tegl::Error.
  virtual ExitCode run(const Streams& streams) = 0;

  /// Whether the command line names this command.
  [[nodiscard]] bool named() const { return app_->parsed(); }
  /// The current FILE; the first one if there are several.
  [[nodiscard]] const std::string& file() const { return worked_on_.front(); }
  /// The current input: FILE, or all files of one image.
  [[nodiscard]] InputFiles inputs() const { return {worked_on_}; }
  [[nodiscard]] bool json() const { return json_; }
  [[nodiscard]] bool quiet() const { return quiet_; }
  /// Other files that are read.
  [[nodiscard]] const std::vector<std::string>& other_inputs() const { return other_inputs_; }
  /// Value of --threads; 0 for all of the machine, and for commands without the option.
  [[nodiscard]] unsigned threads_wanted() const;
  /// Remarks about the images read and files written; none with --quiet.
  [[nodiscard]] std::vector<std::string> remarks() const {
    if (quiet_) return {};
    std::vector<std::string> all = images_.remarks();
    all.insert(all.end(), remarks_.begin(), remarks_.end());
    return all;
  }

 protected:
  [[nodiscard]] CLI::App& app() { return *app_; }
  [[nodiscard]] const CLI::App& app() const { return *app_; }
  /// Progress bars are for interactive use.
  [[nodiscard]] bool wants_progress() const { return !json_ && !quiet_; }
  /// The current files: FILE, or all files of one image.
  [[nodiscard]] const std::vector<std::string>& files() const { return worked_on_; }
  /// All files of the command line.
  [[nodiscard]] const std::vector<std::string>& all_files() const { return files_; }
  /// Makes one file current.
  void turn_to_file(std::size_t place) { worked_on_ = {files_.at(place)}; }
  /// Makes all files current, as one image.
  void turn_to_all_files() { worked_on_ = files_; }
  /// Adds --quiet.
  void add_quiet();
  /// Adds the options to read FILE as an image.
  void add_image_options() { images_.add_to(*app_); }
  [[nodiscard]] const ImageOptions& images() const { return images_; }
  /// Options to read another file as an image, with --allow-outside-paths and --in-process.
  [[nodiscard]] ReadImageOptions image_options(Progress progress = {}) const;
  /// Options to read FILE as a mesh, with --allow-outside-paths and --in-process.
  [[nodiscard]] ReadMeshOptions mesh_options(Progress progress) const;
  /// Reads the image of FILE and these options. Then the current files are in the order of the series.
  /// Curved grids are errors unless they are allowed or --index-grid is given.
  [[nodiscard]] ReadImageResult read(const Progress& progress, CurvedGrids curved = CurvedGrids::refused);
  /// The same for images of up to 5 axes. `keep_stored`: as in ReadImageOptions.
  [[nodiscard]] std::variant<ReadImageResult, ReadImage5dResult> read_to_5d(const Progress& progress,
                                                                            CurvedGrids curved = CurvedGrids::refused,
                                                                            bool keep_stored = false);
  /// Opens the image to be read layer by layer. Curved grids are errors unless --index-grid is given.
  [[nodiscard]] OpenLayersResult open();
  /// Throws FileNotFound unless the current files are readable.
  void require_inputs() const;
  /// Adds other input files; errors that name one of them are not attributed to FILE.
  void also_read(const std::vector<std::string>& files) {
    other_inputs_.insert(other_inputs_.end(), files.begin(), files.end());
  }
  /// Adds a remark to be printed at the end, unless it is empty.
  void remark(std::string text) {
    if (!text.empty()) remarks_.push_back(std::move(text));
  }
  void remark(std::vector<std::string> texts) {
    for (std::string& text : texts) remark(std::move(text));
  }
  /// Takes the order in which the files were read. Files that a collection names are not taken.
  void take_order(const std::vector<std::filesystem::path>& files);

 private:
  void settle_curved(ImageInfo& info, CurvedGrids curved) const;
  /// Leaves lattices of files out of account if the command has --lattice and it is cubic.
  void take_cubic();
  /// Throws UnsupportedData for an image on a lattice, unless the command knows lattices.
  void settle_lattice(const ImageInfo& info) const;
  /// Whether the command takes the lattice of an image into account, or refuses it itself.
  [[nodiscard]] virtual bool knows_lattices() const { return false; }

  CLI::App* app_;
  CLI::Option* json_option_;
  std::vector<std::string> files_ = {""};
  std::vector<std::string> worked_on_ = {""};
  std::vector<std::string> other_inputs_;
  Files files_kind_;
  ImageOptions images_;
  std::vector<std::string> remarks_;
  bool json_ = false;
  bool quiet_ = false;
};

std::unique_ptr<Command> make_info_command(CLI::App& program);
std::unique_ptr<Command> make_filter_command(CLI::App& program);
std::unique_ptr<Command> make_contour_command(CLI::App& program);
std::unique_ptr<Command> make_slice_command(CLI::App& program);
std::unique_ptr<Command> make_elements_command(CLI::App& program);
std::unique_ptr<Command> make_check_command(CLI::App& program);
std::unique_ptr<Command> make_project_command(CLI::App& program);
std::unique_ptr<Command> make_index_command(CLI::App& program);
std::unique_ptr<Command> make_components_command(CLI::App& program);
std::unique_ptr<Command> make_measure_command(CLI::App& program);
std::unique_ptr<Command> make_track_command(CLI::App& program);
std::unique_ptr<Command> make_simplify_command(CLI::App& program);
/// `version`: version of the program, for the pages.
std::unique_ptr<Command> make_view_command(CLI::App& program, std::string version);

}  // namespace tegl::cli
