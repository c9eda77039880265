// SPDX-License-Identifier: BSD-3-Clause
//
// The commands of the program. Each adds its options to the command line, and runs when it was named.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/console.hpp"
#include "base/exit_codes.hpp"
#include "input/image_input.hpp"
#include "output/result.hpp"
#include "tegl/io.hpp"

namespace tegl::cli {

/// The two streams of the program.
struct Streams {
  Console out{stdout};
  Console err{stderr};
};

/// A command of the program: `tegl NAME FILE ...`.
class Command {
 public:
  /// What FILE stands for: one file; one image, in a file or several; or several, which are worked on one by one.
  enum class Files { one, image, each };

  /// Adds the command with its FILE argument and --json to the command line.
  Command(CLI::App& program, const std::string& name, const std::string& description, const std::string& file_help,
          Files files = Files::one);
  virtual ~Command() = default;
  Command(const Command&) = delete;
  Command& operator=(const Command&) = delete;

  /// Does the work. Throws tegl::Error.
  virtual ExitCode run(const Streams& streams) = 0;

  /// Whether this is the command that was named.
  [[nodiscard]] bool named() const { return app_->parsed(); }
  /// FILE; where there are several, the (first) one that is worked on.
  [[nodiscard]] const std::string& file() const { return worked_on_.front(); }
  /// What is worked on: FILE, or all that are one image.
  [[nodiscard]] InputFiles inputs() const { return {worked_on_}; }
  [[nodiscard]] bool json() const { return json_; }
  [[nodiscard]] bool quiet() const { return quiet_; }
  /// Files that are read besides.
  [[nodiscard]] const std::vector<std::string>& other_inputs() const { return other_inputs_; }
  /// --threads; 0 for all that the machine has, and without that option.
  [[nodiscard]] unsigned threads_wanted() const;
  /// What there is to say of the images that were read and of what was written, unless silence is asked for.
  [[nodiscard]] std::vector<std::string> remarks() const {
    if (quiet_) return {};
    std::vector<std::string> all = images_.remarks();
    all.insert(all.end(), remarks_.begin(), remarks_.end());
    return all;
  }

 protected:
  [[nodiscard]] CLI::App& app() { return *app_; }
  [[nodiscard]] const CLI::App& app() const { return *app_; }
  /// Progress bars are for people who wait.
  [[nodiscard]] bool wants_progress() const { return !json_ && !quiet_; }
  /// The files that are worked on: FILE, or all that are one image.
  [[nodiscard]] const std::vector<std::string>& files() const { return worked_on_; }
  /// All of FILE...
  [[nodiscard]] const std::vector<std::string>& all_files() const { return files_; }
  /// Turns to the file of this place among them.
  void turn_to_file(std::size_t place) { worked_on_ = {files_.at(place)}; }
  /// Turns to all of them, as one image.
  void turn_to_all_files() { worked_on_ = files_; }
  /// Adds --quiet.
  void add_quiet();
  /// Adds the options that say how FILE is read as an image.
  void add_image_options() { images_.add_to(*app_); }
  [[nodiscard]] const ImageOptions& images() const { return images_; }
  /// How a file beside FILE is read as an image, with --allow-outside-paths and --in-process.
  [[nodiscard]] ReadImageOptions image_options(Progress progress = {}) const;
  /// How FILE is read as a mesh, with --allow-outside-paths and --in-process.
  [[nodiscard]] ReadMeshOptions mesh_options(Progress progress) const;
  /// Reads the image that FILE and these options name. From then on the files that are worked on stand in the order in
  /// which they follow each other.
  [[nodiscard]] ReadImageResult read(const Progress& progress);
  /// The same to be read layer by layer.
  [[nodiscard]] OpenLayersResult open();
  /// Throws FileNotFound unless the files that are worked on can be read.
  void require_inputs() const;
  /// Errors that name one of these files are not taken for errors of FILE.
  void also_read(const std::vector<std::string>& files) {
    other_inputs_.insert(other_inputs_.end(), files.begin(), files.end());
  }
  /// Keeps a remark for the end; an empty one is none.
  void remark(std::string text) {
    if (!text.empty()) remarks_.push_back(std::move(text));
  }

 private:
  void take_order(const std::vector<std::filesystem::path>& files);

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
/// `version`: of the program, which pages name.
std::unique_ptr<Command> make_view_command(CLI::App& program, std::string version);

}  // namespace tegl::cli
