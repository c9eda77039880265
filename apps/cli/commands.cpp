// SPDX-License-Identifier: BSD-3-Clause
#include "commands.hpp"

#include <fmt/format.h>

#include <charconv>
#include <system_error>

#include "output.hpp"

namespace tegl::cli {

CLI::Validator whole_number(std::uint64_t least, std::uint64_t most) {
  return {[least, most](std::string& text) {
            std::uint64_t value = 0;
            const char* const end = text.data() + text.size();
            const auto [at, error] = std::from_chars(text.data(), end, value);
            if (error == std::errc{} && at == end && value >= least && value <= most) return std::string();
            return fmt::format("'{}'; expected a whole number from {} to {}", text, least, most);
          },
          ""};
}

Command::Command(CLI::App& program, const std::string& name, const std::string& description,
                 const std::string& file_help, Files files)
    : app_(program.add_subcommand(name, description)) {
  if (files == Files::several)
    app_->add_option("FILE", files_, file_help)->required();
  else
    app_->add_option("FILE", files_.front(), file_help)->required();
  json_option_ = app_->add_flag("--json", json_, "the report as JSON on standard output; errors as JSON too");
}

void Command::add_quiet() {
  app_->add_flag("-q,--quiet", quiet_, "no report and no progress bar")->excludes(json_option_);
}

void Command::add_variable() {
  app_->add_option("--var", variable_, "netCDF: the variable to read; needed where the file has several");
}

ReadImageResult Command::read(const Progress& progress) const {
  require_input(file());
  try {
    return read_image(file(), {.variable = variable_, .progress = progress});
  } catch (const Error& error) {
    if (error.code() != ErrorCode::VariableNotFound || !variable_.empty()) throw;
    throw Error(error.code(), fmt::format("{} (choose it with --var)", error.what()));
  }
}

}  // namespace tegl::cli
