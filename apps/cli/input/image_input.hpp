// SPDX-License-Identifier: BSD-3-Clause
//
// The image that FILE names, for all commands alike: one file, or several that are one image, and the options that say
// how to read them.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "output/result.hpp"
#include "tegl/io.hpp"
#include "tegl/io/series.hpp"

namespace tegl::cli {

/// The message of an error of the library's readers with the names of the program's options.
std::string with_option_names(std::string message);

/// --var, --series, --times, --time-step, --time-unit, --sort, --fix, --raw and the options of its layout.
class ImageOptions {
 public:
  /// Adds the options to a command. This must outlive the parse.
  void add_to(CLI::App& app);
  /// Adds --in-process, which commands without images have, too.
  void add_in_process_to(CLI::App& app);
  /// Whether files are read in a child process where that is of use: always, unless --in-process is given.
  [[nodiscard]] bool separate_process() const { return !in_process_; }

  /// Of --allow-outside-paths, which every command has, for meshes too: Command adds it.
  [[nodiscard]] bool& allow_outside_paths() { return allow_outside_paths_; }
  [[nodiscard]] bool allow_outside_paths() const { return allow_outside_paths_; }

  /// Reads the files as one image. Errors: those of read_series; InvalidArgument for options that contradict each other
  /// or the files, and for files in an order that only a shell would choose.
  [[nodiscard]] ReadSeriesResult read(const std::vector<std::string>& files, const Progress& progress) const;

  /// The same to be read layer by layer.
  [[nodiscard]] OpenSeriesResult open(const std::vector<std::string>& files) const;

  /// The variables of the files, as list_image_variables has them; none of raw ones.
  [[nodiscard]] std::vector<ImageVariable> variables(const std::vector<std::string>& files) const;

  /// The variable or DICOM series that is chosen; may be empty.
  [[nodiscard]] const std::string& variable() const { return series_.empty() ? variable_ : series_; }
  /// The option that chooses among what these files hold.
  [[nodiscard]] static std::string choosing_option(const std::vector<std::string>& files);
  /// What the readers said of the files read so far: what they left out, what is uneven.
  [[nodiscard]] const std::vector<std::string>& remarks() const { return remarks_; }
  [[nodiscard]] bool raw() const { return raw_option_->count() > 0; }
  /// Whether the index of a dimension is given.
  [[nodiscard]] bool has_fixed() const { return !fixed_.empty(); }
  /// The names of those that are given.
  [[nodiscard]] std::vector<std::string> given() const;

 private:
  /// --var is not for DICOM, nor --series for anything else.
  void require_fitting_choice(const std::vector<std::string>& files) const;
  [[nodiscard]] SeriesOptions series_options(const std::vector<std::string>& files) const;
  void add_raw_to(CLI::App& app);
  /// Throws InvalidArgument.
  [[nodiscard]] RawLayout raw_layout() const;
  /// Keeps the remarks on what was read.
  template <class Result>
  Result remembered(Result result) const {
    remarks_.insert(remarks_.end(), result.info.remarks.begin(), result.info.remarks.end());
    return result;
  }

  std::string variable_, series_, times_, time_step_, time_unit_, sort_, raw_, raw_type_, spacing_, origin_,
      axis_names_, axis_units_;
  std::uint64_t raw_offset_ = 0;
  bool raw_big_endian_ = false;
  bool allow_outside_paths_ = false;
  bool in_process_ = false;
  std::vector<std::string> fixed_;
  CLI::Option* raw_option_ = nullptr;
  std::vector<CLI::Option*> options_;
  mutable std::vector<std::string> remarks_;
};

}  // namespace tegl::cli
