// SPDX-License-Identifier: BSD-3-Clause
//
// The command line as a whole: consistent options in all commands, and the files generated from the options: the manual
// page and the shell completions, as displayed by their programs.
#include "program/program.hpp"

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <set>

namespace tegl::cli {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Program : public testing::Test {
 protected:
  [[nodiscard]] std::vector<const CLI::App*> all() const {
    const CLI::App& program = program_;
    return program.get_subcommands([](const CLI::App*) { return true; });
  }

  /// Writes a file for the tests' shells.
  static std::string write(const std::string& name, const std::string& text) {
    const std::string path = testing::TempDir() + name + "_" + std::to_string(getpid());
    std::ofstream(path) << text;
    return path;
  }

  /// Runs a system command; returns its output, standard error included, and exit status.
  static std::pair<std::string, int> run(const std::string& command) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen((command + " 2>&1").c_str(), "r"),
                                                               [](std::FILE*) { return 0; });
    std::string text;
    std::array<char, 4096> buffer{};
    while (const std::size_t got = std::fread(buffer.data(), 1, buffer.size(), pipe.get()))
      text.append(buffer.data(), got);
    const int status = pclose(pipe.get());
    return {text, WIFEXITED(status) ? WEXITSTATUS(status) : -1};
  }
  /// Expects a manual page to fit a terminal of 80 columns.
  static void expect_narrow(const std::string& shown) {
    EXPECT_THAT(shown, HasSubstr(" \\\n")) << "a command that goes on in another line";
    for (std::size_t at = 0; at < shown.size();) {
      const std::size_t end = std::min(shown.find('\n', at), shown.size());
      EXPECT_LE(end - at, 80U) << shown.substr(at, end - at);
      at = end + 1;
    }
  }
  static bool has(const std::string& program) { return run("command -v " + program).second == 0; }

  CLI::App program_{"", "tegl"};
  std::vector<std::unique_ptr<Command>> commands_ = add_commands(program_, "1.2.3");
};

TEST_F(Program, HasExamplesForEveryCommand) {
  for (const CLI::App* command : all()) {
    EXPECT_THAT(command->get_footer(), testing::StartsWith("Examples:\n  tegl " + command->get_name()));
    EXPECT_FALSE(command->get_description().empty());
  }
}

TEST_F(Program, NamesAndTypesEveryOption) {
  for (const CLI::App* command : all())
    for (const CLI::Option* option : command->get_options()) {
      SCOPED_TRACE(command->get_name() + " " + option->get_name());
      EXPECT_FALSE(option->get_description().empty());
      if (option->nonpositional() && option->get_name() != "--title") {
        // "TEXT:{...}" lists the choices.
        EXPECT_THAT(option->get_type_name(), testing::Not(testing::ContainsRegex("TEXT$|INT|FLOAT"))) << "what is it?";
      }
      if (!option->get_description().ends_with(" ...")) {
        EXPECT_THAT(option->get_description(), testing::Not(testing::EndsWith(".")));
      }
    }
}

TEST_F(Program, CallsTheSameThingTheSameInAllCommands) {
  // Options whose text or type differs between commands because their function does.
  const std::set<std::string> own = {"--output", "--at",    "--iso",        "--triangulation", "--scale",  "--require",
                                     "--method", "--csv",   "--components", "--samples",       "--count",  "--largest",
                                     "--as",     "--limit", "--border",     "--stream",        "--lattice"};
  std::map<std::string, std::pair<std::string, std::string>> seen;
  for (const CLI::App* command : all())
    for (const CLI::Option* option : command->get_options()) {
      if (!option->nonpositional() || own.contains(option->get_name())) continue;
      const std::string name = option->get_name(false, true);
      const std::string text =
          option->get_type_name() + " | " + option->get_description() + " | " + option->get_default_str();
      const auto [known, is_new] = seen.try_emplace(option->get_name(), name + " | " + text, command->get_name());
      EXPECT_TRUE(is_new || known->second.first == name + " | " + text)
          << command->get_name() << ": " << name << " | " << text << "\n"
          << known->second.second << ": " << known->second.first;
    }
  for (const char* const everywhere : {"--json", "--help"})
    for (const CLI::App* command : all()) EXPECT_NE(command->get_option_no_throw(everywhere), nullptr) << everywhere;
}

TEST_F(Program, HasAManualPageOfAllCommandsAndOptions) {
  const std::string page = man_page(program_, "1.2.3", "2026-01-31");
  EXPECT_THAT(page, HasSubstr(".TH TEGL 1 2026-01-31 \"tegl 1.2.3\""));
  for (const CLI::App* command : all()) {
    std::string title = command->get_name();
    for (char& c : title) c = static_cast<char>(std::toupper(c));
    for (std::size_t at = title.find('-'); at != std::string::npos; at = title.find('-', at + 2))
      title.insert(at, "\\");
    EXPECT_THAT(page, HasSubstr(".SH TEGL " + title));
    for (const CLI::Option* option : command->get_options())
      for (std::string name : option->get_lnames()) {
        for (std::size_t at = name.find('-'); at != std::string::npos; at = name.find('-', at + 2))
          name.insert(at, "\\");
        EXPECT_THAT(page, HasSubstr("\\fB\\-\\-" + name + "\\fR")) << command->get_name();
      }
  }
}

TEST_F(Program, HasAManualPageThatFormattersReadWithoutAWarning) {
  const std::string page = write("tegl.1", man_page(program_, "1.2.3", "2026-01-31"));
  bool any = false;
  if (has("groff")) {
    const auto [text, status] = run("groff -ww -man -Tutf8 -k -z " + page);
    EXPECT_EQ(status, 0);
    EXPECT_EQ(text, "");
    expect_narrow(run("groff -man -Tascii -P-c -rLL=80n " + page + " | col -bx").first);
    any = true;
  }
  if (has("mandoc")) {
    const auto [text, status] = run("mandoc -T lint -W warning " + page);
    EXPECT_EQ(text, "");
    EXPECT_EQ(status, 0);
    const std::string shown = run("mandoc -T ascii -O width=78 " + page + " | col -bx").first;
    EXPECT_THAT(shown, HasSubstr("--ambiguity low|high|mean|saddle|squares|decider"));
    expect_narrow(shown);
    any = true;
  }
  std::filesystem::remove(page);
  if (!any) GTEST_SKIP() << "neither groff nor mandoc";
}

TEST_F(Program, CompletesInBash) {
  if (!has("bash")) GTEST_SKIP() << "no bash";
  const std::string script = write("tegl.bash", completion_script(program_, "bash"));
  const auto complete = [&](const std::string& words) {
    return run("bash -c 'set -u; source " + script + "; COMP_WORDS=(tegl " + words +
               "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _tegl; echo ${COMPREPLY[*]}'")
        .first;
  };
  EXPECT_EQ(complete("con"), "contour\n");
  EXPECT_EQ(complete("contour --tri"), "--triangulation\n");
  EXPECT_EQ(complete("contour a.nii --ambiguity sa"), "saddle\n");
  EXPECT_EQ(complete("check --require c"), "closed\n");
  EXPECT_EQ(complete("contour --triangulation = ba"), "barycentric\n") << "= breaks words";
  EXPECT_THAT(complete("contour --triangulation ="), HasSubstr("compact barycentric"));
  EXPECT_EQ(complete("contour --triangulation=ba"), "--triangulation=barycentric\n") << "it does not";
  EXPECT_EQ(complete("--completion = z"), "zsh\n");
  EXPECT_EQ(complete("contour --output = " + script.substr(0, script.size() - 3)), script + "\n");
  EXPECT_EQ(complete("info " + script.substr(0, script.size() - 3)), script + "\n");
  const std::string blank = write("with two blanks.nrrd", "");
  EXPECT_EQ(run("bash -c 'source " + script + "; COMP_WORDS=(tegl info \"" + blank.substr(0, blank.size() - 8) +
                "\"); COMP_CWORD=2; _tegl; echo ${#COMPREPLY[@]} \"${COMPREPLY[0]}\"'")
                .first,
            "1 " + blank + "\n");
  std::filesystem::remove(blank);
  std::filesystem::remove(script);
}

TEST_F(Program, CompletesInZshAndFish) {
  bool any = false;
  if (has("zsh")) {
    const std::string script = write("tegl.zsh", completion_script(program_, "zsh"));
    EXPECT_EQ(run("zsh -n " + script), std::pair(std::string(), 0));
    EXPECT_EQ(
        run("zsh -f -c 'autoload -U compinit && compinit -D && source " + script + " && echo $_comps[tegl]'").first,
        "_tegl\n");
    EXPECT_THAT(completion_script(program_, "zsh"), HasSubstr("--var=[netCDF\\: the variable to read"));
    std::filesystem::remove(script);
    any = true;
  }
  if (has("fish")) {
    const std::string script = write("tegl.fish", completion_script(program_, "fish"));
    const auto complete = [&](const std::string& line) {
      return run("HOME=/nonexistent fish --no-config -c 'source " + script + "; complete -C \"" + line + "\"'").first;
    };
    EXPECT_THAT(complete("tegl con"), testing::StartsWith("contour\t"));
    EXPECT_THAT(complete("tegl contour --tri"), testing::StartsWith("--triangulation\t"));
    EXPECT_THAT(complete("tegl contour --ambiguity sa"), HasSubstr("saddle"));
    EXPECT_THAT(complete("tegl contour --triangulation=ba"), testing::StartsWith("--triangulation=barycentric"));
    EXPECT_THAT(complete("tegl --comp"), testing::StartsWith("--completion\t"));
    EXPECT_THAT(complete("tegl --completion "), AllOf(HasSubstr("zsh"), Not(HasSubstr("contour"))));
    EXPECT_THAT(complete("tegl contour --var"), HasSubstr("variable to read")) << "more than what comes before a colon";
    std::filesystem::remove(script);
    any = true;
  }
  if (!any) GTEST_SKIP() << "neither zsh nor fish";
}

// Starts a zsh on a pseudo-terminal, presses the tab key and reads the completions offered.
TEST_F(Program, CompletesWhatIsTypedInZsh) {
  if (!has("zsh") || run("zsh -f -c 'zmodload zsh/zpty'").second != 0) GTEST_SKIP() << "no zsh with terminals";
  const std::string script = write("tegl.zsh", completion_script(program_, "zsh"));
  const std::string file = write("of_zsh.nrrd", "");
  const std::string setup = write("setup.zsh", R"(
PROMPT= ; RPROMPT=
autoload -U compinit && compinit -D -u
source )" + script + R"(
compadd() {
  if [[ -n ${(M)@[1,(i)(-|--)]:#-(O|A|D|OA|AO)} ]]; then builtin compadd "$@"; return; fi
  local -a hits
  builtin compadd -A hits "$@"
  builtin compadd "$@"
  local hit
  for hit in $hits; do print "\n<$IPREFIX$hit>"; done
}
told() { print "\n<end>"; }
comppostfuncs=(told)
bindkey '^I' complete-word
print ready.
)");
  const std::string driver = write("driver.zsh", R"(
zmodload zsh/zpty
zpty shell zsh -f -i
zpty -w shell "source )" + setup + R"("
zpty -r -m shell ignored '*ready.*' || exit 1
for line in "$@"; do
  zpty -w -n shell $line$'\t'
  zpty -r -m shell shown '*<end>*' || exit 1
  print -r -- "$line ->" ${(@M)${(@f)${shown//$'\r'}}:#<*>}
  zpty -w -n shell $'\x03'
done
zpty -d shell
)");
  const auto complete = [&](const std::string& line) {
    return run("timeout 30 zsh -f " + driver + " '" + line + "'").first;
  };
  EXPECT_THAT(complete("tegl con"), HasSubstr("-> <contour> <end>"));
  EXPECT_THAT(complete("tegl contour a.nii --ambiguity sa"), HasSubstr("-> <saddle> <end>"));
  EXPECT_THAT(complete("tegl contour --triangulation=ba"), HasSubstr("<--triangulation=barycentric> <end>"));
  EXPECT_THAT(complete("tegl contour --tri"), HasSubstr("-> <--triangulation> <end>"));
  EXPECT_THAT(complete("tegl info " + file.substr(0, file.size() - 2)),
              HasSubstr(std::filesystem::path(file).filename().string() + ">"));
  for (const std::string& each : {script, file, setup, driver}) std::filesystem::remove(each);
}

TEST_F(Program, KnowsNoOtherShell) { EXPECT_THROW((void)completion_script(program_, "tcsh"), Error); }

}  // namespace
}  // namespace tegl::cli
