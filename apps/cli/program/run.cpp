// SPDX-License-Identifier: BSD-3-Clause
//
// Parses the command line, runs the named command, and turns errors into one message and an exit code.
#include "program/run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

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

#include "base/empty_result.hpp"
#include "base/interrupt.hpp"
#include "base/parse_errors.hpp"
#include "base/printable.hpp"
#include "base/suggestions.hpp"
#include "base/thread_limit.hpp"
#include "output/result.hpp"
#include "program/program.hpp"

namespace {

using tegl::cli::Command;
using tegl::cli::ExitCode;
using tegl::cli::Streams;

/// The error message of a failed run, as text or as JSON.
std::string error_text(const Streams& streams, bool json, ExitCode exit, std::string_view code,
                       std::string_view message) {
  if (!json) return fmt::format("{} {}\n", streams.err.red("tegl:").text, tegl::cli::printable(message));
  tegl::cli::Json document;
  document["error"] = {{"code", code}, {"exit", static_cast<int>(exit)}, {"message", message}};
  return tegl::cli::dump(document);
}

/// Writes the error message to standard error; returns `exit`.
ExitCode report(const Streams& streams, bool json, ExitCode exit, std::string_view code, std::string_view message) {
  streams.err.write(error_text(streams, json, exit, code, message));
  return exit;
}

constexpr std::string_view kCancelled = "cancelled";

/// A message about the input, preceded by the input's name if it does not contain it.
std::string with_file(const std::string& message, const Command& command) {
  const auto names_one_of = [&](const std::vector<std::string>& files) {
    return std::any_of(files.begin(), files.end(),
                       [&](const std::string& file) { return message.find(file) != std::string::npos; });
  };
  const tegl::cli::InputFiles input = command.inputs();
  const bool is_named = names_one_of(input.names) || names_one_of(command.other_inputs());
  return is_named || input.names.empty() ? message : fmt::format("{}: {}", input.text(), message);
}

/// The message of an error of the library, with the input's name if it is about the input.
std::string message_of(const tegl::Error& error, const Command& command) {
  using tegl::ErrorCode;
  constexpr std::array kAboutInput = {
      ErrorCode::InvalidGrid,      ErrorCode::FileNotFound, ErrorCode::MalformedFile,     ErrorCode::UnsupportedData,
      ErrorCode::VariableNotFound, ErrorCode::TooLarge,     ErrorCode::UnsupportedFormat,
  };
  const bool about_input = std::find(kAboutInput.begin(), kAboutInput.end(), error.code()) != kAboutInput.end();
  return about_input ? with_file(error.what(), command) : error.what();
}

/// Runs the command with signal handling, and reports its error.
ExitCode run(Command& command, const Streams& streams) {
  const auto text = [&](ExitCode exit, std::string_view code, std::string_view message) {
    return error_text(streams, command.json(), exit, code, message);
  };
  const auto fail = [&](ExitCode exit, std::string_view code, std::string_view message) {
    // If a signal arrived, it is the reason, whatever error the cancelled stage had.
    if (tegl::cli::InterruptHandler::requested()) {
      exit = ExitCode::Cancelled;
      code = tegl::name_of(tegl::ErrorCode::Cancelled);
      message = kCancelled;
    }
    streams.err.write(text(exit, code, message));
    return exit;
  };
  // Removes a progress bar, or the demo's picture, from the terminal.
  const std::string cleared = streams.err.moves_its_cursor() ? "\r\x1b[0m\x1b[K\x1b[?25h" : "";
  const tegl::cli::InterruptHandler handler(
      cleared + text(ExitCode::Cancelled, tegl::name_of(tegl::ErrorCode::Cancelled), kCancelled));
  try {
    const tegl::cli::ThreadLimit threads(command.threads_wanted());
    const ExitCode exit = command.run(streams);
    if (!command.quiet() && !threads.remark().empty())
      streams.err.write(fmt::format("tegl: {}\n", tegl::cli::printable(threads.remark())));
    for (const std::string& remark : command.remarks())
      streams.err.write(fmt::format("tegl: {}\n", tegl::cli::printable(remark)));
    return exit;
  } catch (const tegl::cli::BrokenPipe&) {
    tegl::cli::end_by_signal(SIGPIPE);
  } catch (const tegl::Error& error) {
    return fail(tegl::cli::exit_code(error.code()), tegl::name_of(error.code()), message_of(error, command));
  } catch (const tegl::cli::EmptyResult& error) {
    return fail(ExitCode::Nothing, "EmptyResult", with_file(error.what(), command));
  } catch (const std::bad_alloc&) {
    return fail(
        ExitCode::Internal, "OutOfMemory",
        command.inputs().names.empty() ? "out of memory" : fmt::format("{}: out of memory", command.inputs().text()));
  } catch (const std::exception& error) {
    if (tegl::cli::is_of_threads(error)) return fail(ExitCode::Internal, "Threads", tegl::cli::thread_message());
    return fail(ExitCode::Internal, "Internal",
                fmt::format("{}: internal error: {}", command.inputs().text(), error.what()));
  }
}

constexpr std::array<std::string_view, 8> kNormals = {"gradient", "sobel",    "prewitt",   "context",
                                                      "forward",  "backward", "geometric", "flat"};

std::string unknown_normals(std::string_view kind) {
  return fmt::format("--normals is '{}'; expected one of {}", kind, fmt::join(kNormals, ", "));
}

/// Handles a command line that CLI11 refused, or a request for help. `normals_of`: the argument after --normals, if it
/// is neither a kind of normals nor an option.
ExitCode refuse(const CLI::App& program, const CLI::ParseError& error, const Streams& streams, bool json,
                const std::vector<std::string>& arguments, std::string_view normals_of) {
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
    program.exit(error);  // prints the help or the version to standard output
    return ExitCode::Ok;
  }
  // the command, for the hint at --help
  std::string help = "tegl";
  const CLI::App* named = &program;
  for (const CLI::App* command : program.get_subcommands()) {
    help += " " + command->get_name();
    named = command;
  }
  // the message
  std::string what = tegl::cli::parse_error_text(*named, error);
  std::error_code ignored;
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError) && !normals_of.empty() &&
      !std::filesystem::exists(normals_of, ignored))
    what = unknown_normals(normals_of);
  const std::string_view first_word = arguments.empty() ? std::string_view() : arguments.front();
  if (named == &program && !first_word.empty() && first_word.front() != '-')
    what = tegl::cli::unknown_command_text(program, first_word);
  else if (const auto unknown = tegl::cli::unknown_option(*named, arguments))
    what = tegl::cli::unknown_option_text(*named, *unknown);
  const std::string message = fmt::format("{} (see {} --help)", what, help);
  return report(streams, json, ExitCode::Usage, "InvalidArgument", message);
}

/// The arguments in reverse order, as CLI11 expects them. A kind of normals after --normals is joined to it, because
/// CLI11 would take any next argument as the value of an option with an optional value.
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

/// The argument after --normals, if it is neither a kind of normals nor an option: FILE, or an invalid kind.
std::string_view after_normals(int argc, char** argv) {
  for (int i = 1; i + 1 < argc; ++i)
    if (const std::string_view next = argv[i + 1]; std::string_view(argv[i]) == "--normals" && !next.starts_with("-") &&
                                                   std::find(kNormals.begin(), kNormals.end(), next) == kNormals.end())
      return next;
  return {};
}

/// Handles `tegl --man` and `tegl --completion SHELL`; nullopt for other command lines.
std::optional<ExitCode> write_reference(const CLI::App& program, int argc, char** argv,
                                        const tegl::cli::Release& release, const Streams& streams) {
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
                        fmt::format("{} with '{}'; expected no further argument", words[0], words[man ? 1 : 2]));
    streams.out.write(man ? tegl::cli::man_page(program, release.version, release.date)
                          : tegl::cli::completion_script(program, words[1]));
    return ExitCode::Ok;
  } catch (const tegl::Error& error) {
    return report(streams, false, tegl::cli::exit_code(error.code()), tegl::name_of(error.code()), error.what());
  }
}

}  // namespace

namespace tegl::cli {

int run_program(int argc, char** argv, const Release& release) {
  tegl::cli::occupy_closed_streams();
  std::signal(SIGXFSZ, SIG_IGN);  // exceeding the file size limit becomes a failed write, which leaves no file
  const Streams streams;
  CLI::App program("", "tegl");
  const std::vector<std::unique_ptr<Command>> commands = tegl::cli::add_commands(program, release.version);
  // With --json, errors of parsing are reported as JSON too.
  const bool asks_for_json =
      std::any_of(argv, argv + argc, [](std::string_view argument) { return argument == "--json"; });
  if (const auto exit = write_reference(program, argc, argv, release, streams)) return static_cast<int>(*exit);
  try {
    program.parse(joined_arguments(argc, argv));
  } catch (const CLI::ParseError& error) {
    const std::vector<std::string> arguments(argv + std::min(1, argc), argv + argc);
    return static_cast<int>(refuse(program, error, streams, asks_for_json, arguments, after_normals(argc, argv)));
  }
  // FILE accepts several values, so an invalid kind of normals would be read as one of them.
  std::error_code ignored;
  const std::string_view kind = after_normals(argc, argv);
  const bool is_empty = std::any_of(argv, argv + argc, [](std::string_view word) { return word == "--normals="; });
  if (is_empty || (!kind.empty() && !std::filesystem::exists(kind, ignored)))
    return static_cast<int>(
        report(streams, asks_for_json, ExitCode::Usage, "InvalidArgument",
               fmt::format("{} (see tegl {} --help)", unknown_normals(is_empty ? std::string_view() : kind), argv[1])));
  const auto named =
      std::find_if(commands.begin(), commands.end(), [](const auto& command) { return command->named(); });
  const ExitCode exit = run(**named, streams);
  if (exit == ExitCode::Cancelled && tegl::cli::InterruptHandler::signal() != 0)
    tegl::cli::end_by_signal(tegl::cli::InterruptHandler::signal());
  return static_cast<int>(exit);
}

}  // namespace tegl::cli
