// SPDX-License-Identifier: BSD-3-Clause
//
// Generates the manual page and the completion scripts from the option definitions.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "program/program.hpp"

namespace tegl::cli {

namespace {

std::vector<const CLI::App*> commands_of(const CLI::App& program) {
  return program.get_subcommands([](const CLI::App*) { return true; });
}

/// The options with a name, in the order of --help.
std::vector<const CLI::Option*> options_of(const CLI::App& app) {
  std::vector<const CLI::Option*> result;
  for (const CLI::Option* option : app.get_options())
    if (option->nonpositional() && !option->get_group().empty()) result.push_back(option);
  return result;
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

/// The allowed values of an option, if they are listed as "{a,b}" in its type description.
std::vector<std::string> words_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t open = type.find('{');
  const std::size_t close = type.find('}', open);
  std::vector<std::string> words;
  if (open == std::string::npos || close == std::string::npos) return words;
  for (std::size_t at = open + 1; at <= close;) {
    const std::size_t end = std::min(type.find(',', at), close);
    words.push_back(type.substr(at, end - at));
    at = end + 1;
  }
  return words;
}

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
  return text;
}

/// Names as typed: "-o", "--output".
std::vector<std::string> forms_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

// --- the manual page

/// Escapes text for troff: hyphens stay copyable, and no text becomes an escape or a control line.
std::string roff(const std::string& text) {
  std::string result = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
  result = replaced(replaced(result, "'", "\\(aq"), "`", "\\(ga");
  result = replaced(replaced(result, "~", "\\(ti"), "^", "\\(ha");
  std::string lines;
  for (std::size_t at = 0; at < result.size();) {
    const std::size_t end = std::min(result.find('\n', at), result.size());
    if (result[at] == '.') lines += "\\&";
    lines += result.substr(at, end - at + (end < result.size() ? 1 : 0));
    at = end + 1;
  }
  return lines;
}

/// A block without line filling. Empty lines are removed, because troff reads them as paragraphs.
std::string verbatim(const std::string& text) {
  std::string result = ".nf\n" + roff(text);
  while (!result.empty() && result.back() == '\n') result.pop_back();
  return replaced(result, "\n\n", "\n.sp\n") + "\n.fi\n";
}

/// Wraps a line to the width of an 80-column page: commands continue after a backslash, comments and other lines are
/// continued indented.
std::string wrapped(std::string line) {
  constexpr std::size_t kWidth = 71;  // without the page's indentation and margin
  const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
  const bool is_command = std::string_view(line).substr(indent).starts_with("tegl ");
  std::string comment;
  if (const std::size_t gap = line.find("  ", indent); is_command && line.size() > kWidth && gap < line.size()) {
    comment = "\n      " + line.substr(std::min(line.find_first_not_of(' ', gap), line.size()));
    line.resize(gap);
  }
  std::string text;
  while (line.size() > kWidth) {
    std::size_t at = indent;  // last blank outside of quotes; for commands, before an option
    std::size_t before_option = indent;
    bool quoted = false;
    for (std::size_t i = indent; i < kWidth - 2; ++i) {
      quoted = quoted != (is_command && line[i] == '\'');
      if (line[i] != ' ' || quoted) continue;
      at = i;
      if (line[i + 1] == '-') before_option = i;
    }
    if (is_command && before_option > kWidth / 2) at = before_option;
    if (at == indent) break;
    text += line.substr(0, at) + (is_command ? " \\\n" : "\n");
    line = std::string(indent + 4, ' ') + line.substr(at + 1);
  }
  return text + line + comment;
}

/// A command's examples: commands as a verbatim block, explanations as paragraphs.
std::string man_examples(const std::string& footer) {
  std::string text;
  std::string block;
  const auto end_block = [&] {
    if (!block.empty()) text += verbatim(block);
    block.clear();
  };
  for (std::size_t at = 0; at < footer.size();) {
    const std::size_t end = std::min(footer.find('\n', at), footer.size());
    const std::string line = footer.substr(at, end - at);
    at = end + 1;
    if (line.starts_with("  ")) {
      block += wrapped(line) + "\n";
      continue;
    }
    const bool is_new = !block.empty();
    end_block();
    if (line.empty()) continue;
    text += (is_new ? ".PP\n" : "") + roff(line) + "\n";
  }
  end_block();
  return text;
}

std::string man_option(const CLI::Option& option) {
  std::vector<std::string> names = forms_of(option);
  for (std::string& name : names) name = "\\fB" + roff(name) + "\\fR";
  std::string text = fmt::format(".TP\n{}", fmt::join(names, ", "));
  const std::vector<std::string> words = words_of(option);
  if (!words.empty())
    text += " " + replaced(roff(fmt::format("{}", fmt::join(words, "|"))), "|", "|\\:");  // lines may break at |
  else if (takes_value(option))
    text += fmt::format(" \\fI{}\\fR", roff(option.get_type_name()));
  text += "\n" + roff(option.get_description());
  if (!option.get_default_str().empty()) text += roff(fmt::format(" (default: {})", option.get_default_str()));
  if (option.get_required()) text += " (required)";
  return text + "\n";
}

}  // namespace

std::string man_page(const CLI::App& program, const std::string& version, const std::string& date) {
  std::string text =
      fmt::format(".\\\" Made by 'tegl \\-\\-man'.\n.TH TEGL 1 {} \"tegl {}\" \"User Commands\"\n", date, version);
  text += ".SH NAME\ntegl \\- contours of images in two, three and four dimensions\n";
  text += ".SH SYNOPSIS\n\\fBtegl\\fR \\fICOMMAND\\fR [\\fIOPTIONS\\fR] \\fIFILE\\fR...\n";
  text += ".SH DESCRIPTION\n" + roff(program.get_description()) + "\n.PP\nThe commands:\n";
  for (const CLI::App* command : commands_of(program))
    text += fmt::format(".TP\n\\fB{}\\fR\n{}\n", roff(command->get_name()), roff(command->get_description()));
  text += ".SH OPTIONS\n";
  for (const CLI::Option* option : options_of(program)) text += man_option(*option);
  for (const CLI::App* command : commands_of(program)) {
    text += fmt::format(".SH TEGL {}\n{}.\n", roff(upper(command->get_name())), roff(command->get_description()));
    for (const CLI::Option* option : command->get_options())
      if (option->get_positional())
        text += fmt::format(".TP\n\\fI{}\\fR\n{}\n", roff(option->get_name(true)), roff(option->get_description()));
    for (const CLI::Option* option : options_of(*command)) text += man_option(*option);
    text += ".PP\n" + man_examples(command->get_footer());
  }
  text += ".SH EXIT STATUS\n" + man_examples(exit_code_help());
  text +=
      ".SH ENVIRONMENT\n.TP\n\\fBNO_COLOR\\fR\nIf set and not empty: no colours. Without it there are none either if "
      "\\fBTERM\\fR is dumb or the output is not a\nterminal.\n.TP\n\\fBCOLUMNS\\fR\nThe width of reports if the "
      "output is not a terminal.\n";
  return text + ".SH SEE ALSO\n\\fBparaview\\fR(1), \\fBncdump\\fR(1)\n";
}

namespace {

// --- completion

/// Quotes a text in single quotes, for all shells.
std::string single_quoted(const std::string& text) { return "'" + replaced(text, "'", "'\\''") + "'"; }

/// The first clause of a description, because menus are narrow.
std::string brief(const std::string& description) {
  constexpr std::size_t kShort = 60;
  std::string text = replaced(description, "\n", " ");
  if (text.size() > kShort) {
    // "netCDF: the variable to read": the text before an early colon is too short.
    std::size_t end = std::min(text.find(';'), text.size());
    if (const std::size_t colon = text.find(": ", kShort / 2); colon < end) end = colon;
    text.resize(end);
  }
  return text;
}

/// The words that bash completes, as shell code.
struct BashWords {
  std::string commands;  ///< separated by blanks
  std::string values;    ///< branches of a `case` by command and option: the allowed values
  std::string options;   ///< branches of a `case` by command: its options
};

BashWords bash_words(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* command : commands_of(program)) names.push_back(command->get_name());
  BashWords result;
  result.commands = fmt::format("{}", fmt::join(names, " "));
  for (const CLI::App* command : commands_of(program)) {
    std::vector<std::string> words;
    for (const CLI::Option* option : options_of(*command)) {
      const std::vector<std::string> own = forms_of(*option);
      words.insert(words.end(), own.begin(), own.end());
      if (const auto allowed = words_of(*option); !allowed.empty())
        for (const std::string& name : own)
          result.values +=
              fmt::format("    {}:{}) words='{}' ;;\n", command->get_name(), name, fmt::join(allowed, " "));
    }
    result.options += fmt::format("      {}) words='{}' ;;\n", command->get_name(), fmt::join(words, " "));
  }
  return result;
}

std::string bash_script(const CLI::App& program) {
  const BashWords words = bash_words(program);
  // bash splits "--name=value" into three words at '=' by default.
  return fmt::format(
      "# bash completion of tegl, made by 'tegl --completion bash'\n"
      "_tegl() {{\n"
      "  local cur=${{COMP_WORDS[COMP_CWORD]}} prev=${{COMP_WORDS[COMP_CWORD-1]}} command=${{COMP_WORDS[1]}}\n"
      "  local before='' words=''\n"
      "  COMPREPLY=()\n"
      "  if ((COMP_CWORD == 1)) && [[ $cur != *=* ]]; then\n"
      "    mapfile -t COMPREPLY < <(compgen -W '{} --help --version --man --completion' -- \"$cur\")\n"
      "    return\n"
      "  fi\n"
      "  if [[ $cur == '=' ]]; then\n"
      "    cur=''\n"
      "  elif [[ $prev == '=' ]] && ((COMP_CWORD > 2)); then\n"
      "    prev=${{COMP_WORDS[COMP_CWORD-2]}}\n"
      "  elif [[ $cur == --*=* ]]; then\n"
      "    prev=${{cur%%=*}} before=${{cur%%=*}}= cur=${{cur#*=}}\n"
      "  fi\n"
      "  [[ $command == --completion=* ]] && command=--completion\n"
      "  case $command:$prev in\n"
      "    --completion:--completion) words='bash zsh fish' ;;\n"
      "{}"
      "  esac\n"
      "  if [[ -z $words && -z $before && $cur == -* ]]; then\n"
      "    case $command in\n{}    esac\n"
      "  fi\n"
      "  if [[ -n $words ]]; then\n"
      "    mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$cur\")\n"
      "  else\n"
      "    compopt -o filenames 2>/dev/null\n"
      "    mapfile -t COMPREPLY < <(compgen -f -- \"$cur\")\n"
      "  fi\n"
      "  if [[ -n $before ]]; then COMPREPLY=(\"${{COMPREPLY[@]/#/$before}}\"); fi\n"
      "}}\n"
      "complete -F _tegl tegl\n",
      words.commands, words.values, words.options);
}

std::string zsh_script(const CLI::App& program) {
  const auto escaped = [](const std::string& text) {
    return replaced(replaced(replaced(text, "[", "\\["), "]", "\\]"), ":", "\\:");
  };
  std::string names;
  std::string cases;
  for (const CLI::App* command : commands_of(program)) {
    names +=
        fmt::format("    {}\n", single_quoted(command->get_name() + ":" + escaped(brief(command->get_description()))));
    cases += fmt::format("    {})\n      _arguments -s \\\n", command->get_name());
    for (const CLI::Option* option : options_of(*command))
      for (const std::string& name : forms_of(*option)) {
        // "--name=" accepts its value after '=' or as the next word.
        std::string spec = fmt::format("*{}{}[{}]", name, takes_value(*option) && name.starts_with("--") ? "=" : "",
                                       escaped(brief(option->get_description())));
        const char* const colon = option->get_items_expected_min() == 0 ? "::" : ":";
        const auto words = words_of(*option);
        if (!words.empty())
          spec += fmt::format("{}value:({})", colon, fmt::join(words, " "));
        else if (takes_value(*option))
          spec += fmt::format("{}{}:_files", colon, escaped(option->get_type_name()));
        cases += "        " + single_quoted(spec) + " \\\n";
      }
    cases += "        '*:file:_files'\n      ;;\n";
  }
  return fmt::format(
      "#compdef tegl\n"
      "# zsh completion of tegl, made by 'tegl --completion zsh'\n"
      "_tegl() {{\n"
      "  local -a commands\n"
      "  commands=(\n{}  )\n"
      "  if (( CURRENT == 2 )); then\n"
      "    _describe command commands\n"
      "    return\n"
      "  fi\n"
      "  local command=$words[2]\n"
      "  shift words\n"
      "  (( CURRENT-- ))\n"
      "  case $command in\n{}  esac\n"
      "}}\n"
      "if [[ $funcstack[1] == _tegl ]]; then _tegl \"$@\"; else compdef _tegl tegl; fi\n",
      names, cases);
}

std::string fish_script(const CLI::App& program) {
  std::string text = "# fish completion of tegl, made by 'tegl --completion fish'\n";
  // fish has two escapes within single quotes.
  const auto in_fish = [](const std::string& words) {
    return "'" + replaced(replaced(words, "\\", "\\\\"), "'", "\\'") + "'";
  };
  text +=
      "function __tegl_needs_command; test (count (commandline -opc)) -eq 1; end\n"
      "complete -c tegl -n __tegl_needs_command -f\n";
  for (const CLI::Option* option : options_of(program)) {
    text += "complete -c tegl -n __tegl_needs_command";
    for (const std::string& letter : option->get_snames()) text += " -s " + letter;
    for (const std::string& word : option->get_lnames()) text += " -l " + word;
    if (const auto words = words_of(*option); !words.empty()) text += fmt::format(" -x -a '{}'", fmt::join(words, " "));
    text += fmt::format(" -d {}\n", in_fish(brief(option->get_description())));
  }
  text +=
      "complete -c tegl -n __tegl_needs_command -l man -d 'the manual page'\n"
      "function __tegl_takes_shell; __tegl_needs_command; or test (commandline -opc)[-1] = --completion; end\n"
      "complete -c tegl -n __tegl_takes_shell -l completion -x -a 'bash zsh fish' -d 'of a shell'\n";
  for (const CLI::App* command : commands_of(program)) {
    const std::string& name = command->get_name();
    text += fmt::format("complete -c tegl -n __tegl_needs_command -a {} -d {}\n", name,
                        in_fish(brief(command->get_description())));
    for (const CLI::Option* option : options_of(*command)) {
      text += fmt::format("complete -c tegl -n '__fish_seen_subcommand_from {}'", name);
      for (const std::string& letter : option->get_snames()) text += " -s " + letter;
      for (const std::string& word : option->get_lnames()) text += " -l " + word;
      if (const auto words = words_of(*option); !words.empty())
        text += fmt::format(" -x -a '{}'", fmt::join(words, " "));
      else if (takes_value(*option))
        text += " -r";
      text += fmt::format(" -d {}\n", in_fish(brief(option->get_description())));
    }
  }
  return text;
}

}  // namespace

std::string completion_script(const CLI::App& program, std::string_view shell) {
  if (shell == "bash") return bash_script(program);
  if (shell == "zsh") return zsh_script(program);
  if (shell == "fish") return fish_script(program);
  throw Error(ErrorCode::InvalidArgument, fmt::format("--completion {}; expected bash, zsh or fish", shell));
}

}  // namespace tegl::cli
