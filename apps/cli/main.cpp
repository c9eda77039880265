// SPDX-License-Identifier: BSD-3-Clause
//
// The program `tegl`: parses the command line, runs the command that it names, and turns what goes wrong
// into one message and an exit code.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <exception>
#include <filesystem>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "program.hpp"
#include "progress.hpp"
#include "result.hpp"

namespace {

using tegl::cli::Command;
using tegl::cli::ExitCode;
using tegl::cli::Streams;

/// Writes the one message of a failed run, as text or as JSON, to standard error.
ExitCode report(const Streams& streams, bool json, ExitCode exit, std::string_view code, std::string_view message) {
  if (json) {
    tegl::cli::Json document;
    document["error"] = {{"code", code}, {"exit", static_cast<int>(exit)}, {"message", message}};
    streams.err.write(tegl::cli::dump(document));
  } else {
    streams.err.write(fmt::format("{} {}\n", streams.err.red("tegl:"), message));
  }
  return exit;
}

/// The message with the input's name in front where the library did not know it. To who pressed Ctrl-C it is no matter
/// which callback was told so, and where.
std::string with_file(const tegl::Error& error, const tegl::cli::InputFiles& input) {
  using tegl::ErrorCode;
  constexpr std::array kAboutInput = {
      ErrorCode::InvalidGrid,     ErrorCode::EmptyResult,      ErrorCode::FileNotFound, ErrorCode::MalformedFile,
      ErrorCode::UnsupportedData, ErrorCode::VariableNotFound, ErrorCode::TooLarge,     ErrorCode::UnsupportedFormat,
  };
  if (error.code() == ErrorCode::Cancelled) return "cancelled";
  const std::string message = error.what();
  const bool about_input = std::find(kAboutInput.begin(), kAboutInput.end(), error.code()) != kAboutInput.end();
  const bool named = std::any_of(input.names.begin(), input.names.end(),
                                 [&](const std::string& file) { return message.find(file) != std::string::npos; });
  return !about_input || named ? message : fmt::format("{}: {}", input.text(), message);
}

ExitCode run(Command& command, const Streams& streams) {
  const auto fail = [&](ExitCode exit, std::string_view code, std::string_view message) {
    return report(streams, command.json(), exit, code, message);
  };
  try {
    const tegl::cli::InterruptHandler handler;
    const ExitCode exit = command.run(streams);
    for (const std::string& remark : command.remarks()) streams.err.write(fmt::format("tegl: {}\n", remark));
    return exit;
  } catch (const tegl::Error& error) {
    return fail(tegl::cli::exit_code(error.code()), tegl::error_name(error.code()), with_file(error, command.inputs()));
  } catch (const std::bad_alloc&) {
    return fail(ExitCode::Internal, "OutOfMemory", fmt::format("{}: memory ran out", command.inputs().text()));
  } catch (const std::exception& error) {
    return fail(ExitCode::Internal, "Internal",
                fmt::format("{}: internal error: {}", command.inputs().text(), error.what()));
  }
}

/// "info, contour or check".
std::string command_names(const CLI::App& program) {
  std::string names;
  const std::vector<const CLI::App*> commands = program.get_subcommands([](const CLI::App*) { return true; });
  for (std::size_t i = 0; i < commands.size(); ++i)
    names += (i == 0 ? "" : i + 1 == commands.size() ? " or " : ", ") + commands[i]->get_name();
  return names;
}

std::string unknown_normals(std::string_view kind) {
  return fmt::format("--normals {}: expected gradient, sobel, geometric or flat", kind);
}

/// A command line that CLI11 refused, or a request for help.
/// `normals_of`: what follows --normals, if it is neither a kind of normals nor an option.
ExitCode refuse(const CLI::App& program, const CLI::ParseError& error, const Streams& streams, bool json,
                std::string_view first_word, std::string_view normals_of) {
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
    program.exit(error);  // prints the help or the version to standard output
    return ExitCode::Ok;
  }
  std::string help = "tegl";
  for (const CLI::App* command : program.get_subcommands()) help += " " + command->get_name();
  std::string what = error.what();
  if (error.get_name() == "ArgumentMismatch" && what.find("At Most 1 required") != std::string::npos)
    what = what.substr(0, what.find(':')) + " is given more than once; expected it once";
  std::error_code ignored;
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError) && !normals_of.empty() &&
      !std::filesystem::exists(normals_of, ignored))
    what = unknown_normals(normals_of);
  if (help == "tegl" && !first_word.empty() && first_word.front() != '-') {
    what = fmt::format("there is no command '{}'; expected {}", first_word, command_names(program));
  }
  const std::string message = fmt::format("{} (see {} --help)", what, help);
  return report(streams, json, ExitCode::Usage, "InvalidArgument", message);
}

constexpr std::array<std::string_view, 4> kNormals = {"gradient", "sobel", "geometric", "flat"};

/// The arguments, last first, as CLI11 takes them. What --normals may be followed by is joined to it: an option whose
/// value may be left out would take the next argument, whatever it is, for one.
std::vector<std::string> joined_arguments(int argc, char** argv) {
  std::vector<std::string> arguments;
  for (const std::string_view argument : std::vector<std::string_view>(argv + std::min(1, argc), argv + argc)) {
    const bool is_kind = std::find(kNormals.begin(), kNormals.end(), argument) != kNormals.end();
    if (is_kind && !arguments.empty() && arguments.back() == "--normals")
      arguments.back().append("=").append(argument);
    else
      arguments.emplace_back(argument);
  }
  std::reverse(arguments.begin(), arguments.end());
  return arguments;
}

/// What follows --normals, if it is neither a kind of normals nor an option: FILE, or a kind that there is not.
std::string_view after_normals(int argc, char** argv) {
  for (int i = 1; i + 1 < argc; ++i)
    if (const std::string_view next = argv[i + 1]; std::string_view(argv[i]) == "--normals" && !next.starts_with("-") &&
                                                   std::find(kNormals.begin(), kNormals.end(), next) == kNormals.end())
      return next;
  return {};
}

/// What `tegl --man` and `tegl --completion SHELL` write; nothing for other command lines.
std::optional<ExitCode> write_reference(const CLI::App& program, int argc, char** argv, const Streams& streams) {
  std::vector<std::string_view> words(argv + std::min(1, argc), argv + argc);
  constexpr std::string_view kJoined = "--completion=";
  if (!words.empty() && words[0].starts_with(kJoined)) {
    words.insert(words.begin() + 1, words[0].substr(kJoined.size()));
    words[0] = kJoined.substr(0, kJoined.size() - 1);
  }
  if (words.empty() || (words[0] != "--man" && words[0] != "--completion")) return std::nullopt;
  const bool man = words[0] == "--man";
  try {
    if (!man && words.size() < 2)
      throw tegl::Error(tegl::ErrorCode::InvalidArgument, "--completion needs a shell; expected bash, zsh or fish");
    if (words.size() > (man ? 1 : 2))
      throw tegl::Error(tegl::ErrorCode::InvalidArgument,
                        fmt::format("{} with '{}'; expected nothing behind it", words[0], words[man ? 1 : 2]));
    streams.out.write(man ? tegl::cli::man_page(program, TEGL_VERSION, TEGL_MANUAL_DATE)
                          : tegl::cli::completion_script(program, words[1]));
    return ExitCode::Ok;
  } catch (const tegl::Error& error) {
    return report(streams, false, tegl::cli::exit_code(error.code()), tegl::error_name(error.code()), error.what());
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grows beyond its limit is a failed write, which leaves nothing behind
  const Streams streams;
  CLI::App program("", "tegl");
  const std::vector<std::unique_ptr<Command>> commands = tegl::cli::add_commands(program, TEGL_VERSION);
  // Before anything is parsed, too, whoever asks for JSON wants errors in JSON.
  const bool asks_for_json =
      std::any_of(argv, argv + argc, [](std::string_view argument) { return argument == "--json"; });
  if (const auto exit = write_reference(program, argc, argv, streams)) return static_cast<int>(*exit);
  try {
    program.parse(joined_arguments(argc, argv));
  } catch (const CLI::ParseError& error) {
    return static_cast<int>(
        refuse(program, error, streams, asks_for_json, argc > 1 ? argv[1] : "", after_normals(argc, argv)));
  }
  // FILE may be several, so that what is meant as a kind of normals is one of them.
  std::error_code ignored;
  if (const std::string_view kind = after_normals(argc, argv); !kind.empty() && !std::filesystem::exists(kind, ignored))
    return static_cast<int>(report(streams, asks_for_json, ExitCode::Usage, "InvalidArgument",
                                   fmt::format("{} (see tegl {} --help)", unknown_normals(kind), argv[1])));
  const auto named =
      std::find_if(commands.begin(), commands.end(), [](const auto& command) { return command->named(); });
  return static_cast<int>(run(**named, streams));
}
