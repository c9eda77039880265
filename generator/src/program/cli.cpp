// SPDX-License-Identifier: BSD-3-Clause
//
// The parser of the command line. One table of options holds for each its name, whether it takes a value, the commands
// that accept it, and its effect on Options. The generator depends only on fmt, so it uses no parser library.
#include "program/cli.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "symmetry/transversal.hpp"
#include "tegl/table_contract.hpp"

namespace tegl::gen {
namespace {

[[noreturn]] void refuse(const std::string& message) {
  throw Error(ErrorCode::InvalidArgument, message + "; see gen --help");
}

/// Returns the value with the given name.
template <typename Value, std::size_t Count>
Value choose(std::string_view option, std::string_view given,
             const std::array<std::pair<std::string_view, Value>, Count>& choices) {
  std::vector<std::string_view> names;
  for (const auto& [name, value] : choices) {
    if (name == given) {
      return value;
    }
    names.push_back(name);
  }
  refuse(fmt::format("{} {}: expected {}", option, given, fmt::join(names, " or ")));
}

using Apply = void (*)(Options&, std::string_view);

template <typename Number>
void set_number(std::string_view option, std::string_view given, Number& number, Number least) {
  const char* const end = given.data() + given.size();
  const auto [stop, error] = std::from_chars(given.data(), end, number);
  const bool in_range = error == std::errc{} && stop == end && number >= least;
  if (in_range) return;
  if (least == std::numeric_limits<Number>::min() && std::is_signed_v<Number>) {
    refuse(fmt::format("{} {}: expected a whole number", option, given));
  }
  refuse(fmt::format("{} {}: expected a whole number from {} to {}", option, given, least,
                     std::numeric_limits<Number>::max()));
}

void set_dim(Options& options, std::string_view given) {
  set_number("--dim", given, options.dim, std::numeric_limits<int>::min());
}

void set_sample(Options& options, std::string_view given) {
  set_number("--sample", given, options.sample, std::uint64_t{1});
}

void set_seed(Options& options, std::string_view given) { set_number("--seed", given, options.seed, std::uint64_t{0}); }

void set_threads(Options& options, std::string_view given) { set_number("--threads", given, options.threads, 0U); }

void set_group(Options& options, std::string_view given) {
  using Pair = std::pair<std::string_view, GroupKind>;
  options.group =
      choose("--group", given, std::array{Pair{"full", GroupKind::Full}, Pair{"rotations", GroupKind::Rotations}});
}

void set_tile(Options& options, std::string_view given) {
  for (const TileKind kind : {TileKind::cube, TileKind::simplex, TileKind::octahedron}) {
    if (given != tile_kind_name(kind)) continue;
    options.tile = kind;
    return;
  }
  std::vector<std::string_view> names;
  for (const CellName& cell : kCellNames) {
    if (given == cell.given) {
      options.tile = TileKind::other;
      options.cell = &cell;
      return;
    }
    names.push_back(cell.given);
  }
  refuse(fmt::format("--tile {}: expected cube, simplex, octahedron, {}", given, fmt::join(names, ", ")));
}

void set_alternative(Options& options, std::string_view given) {
  using Pair = std::pair<std::string_view, Alternative>;
  options.alternative =
      choose("--alternative", given, std::array{Pair{"low", Alternative::low}, Pair{"high", Alternative::high}});
}

void set_layout(Options& options, std::string_view given) {
  using Pair = std::pair<std::string_view, LayoutChoice>;
  options.layout = choose("--layout", given,
                          std::array{Pair{"class", LayoutChoice::Class}, Pair{"flat", LayoutChoice::Flat},
                                     Pair{"auto", LayoutChoice::Auto}});
}

void set_triangulation(Options& options, std::string_view given) {
  using Pair = std::pair<std::string_view, TriangulationChoice>;
  constexpr std::array kChoices{Pair{"barycentric", TriangulationChoice::Barycentric},
                                Pair{"compact", TriangulationChoice::Compact}, Pair{"all", TriangulationChoice::All}};
  if (options.command == Command::Builder)  // of one triangulation
    options.triangulation = choose("--triangulation", given, std::array{kChoices[0], kChoices[1]});
  else
    options.triangulation = choose("--triangulation", given, kChoices);
}

void set_leaf(Options& options, std::string_view given) {
  using Pair = std::pair<std::string_view, Leaf>;
  options.leaf = choose("--leaf", given, std::array{Pair{"table", Leaf::table}, Pair{"edges", Leaf::edges}});
}

/// Parses names separated by commas, in any order, each at most once.
void set_languages(Options& options, std::string_view given) {
  options.languages.clear();
  for (std::size_t first = 0; first <= given.size();) {
    const std::size_t end = std::min(given.find(',', first), given.size());
    const std::string_view name = given.substr(first, end - first);
    const auto* const found = std::find_if(std::begin(kLanguages), std::end(kLanguages),
                                           [name](Language l) { return language_name(l) == name; });
    if (found == std::end(kLanguages)) {
      std::vector<std::string_view> names;
      for (const Language l : kLanguages) {
        names.push_back(language_name(l));
      }
      refuse(fmt::format("--language {}: unknown language '{}': expected one or several, separated by commas, of {}",
                         given, name, fmt::join(names, ", ")));
    }
    if (std::find(options.languages.begin(), options.languages.end(), *found) != options.languages.end()) {
      refuse(fmt::format("--language {}: {} twice: expected each once", given, name));
    }
    options.languages.push_back(*found);
    first = end + 1;
  }
}

/// A set of commands, as bits.
constexpr unsigned bit(Command command) { return 1U << static_cast<unsigned>(command); }
constexpr unsigned kCount = bit(Command::Count);
constexpr unsigned kTransversal = bit(Command::Transversal);
constexpr unsigned kClasses = bit(Command::Classes);
constexpr unsigned kCertify = bit(Command::Certify);
constexpr unsigned kOut = bit(Command::Out);
constexpr unsigned kCases = bit(Command::Cases);
constexpr unsigned kBuilder = bit(Command::Builder);
constexpr unsigned kCells = bit(Command::Cells);
constexpr unsigned kSymmetries = bit(Command::Symmetries);
constexpr unsigned kSummary = bit(Command::Summary);

struct OptionSpec {
  std::string_view name;
  bool takes_value;
  std::optional<Command> command;  ///< set if the option is itself a command
  unsigned known_to;               ///< otherwise: the commands that accept it
  Apply apply;                     ///< null if the option only selects the command
};

constexpr std::array kOptions{
    OptionSpec{"--version", false, Command::Version, 0, nullptr},
    OptionSpec{"--count", false, Command::Count, 0, nullptr},
    OptionSpec{"--transversal", false, Command::Transversal, 0, nullptr},
    OptionSpec{"--symmetries", false, Command::Symmetries, 0, nullptr},
    OptionSpec{"--classes", false, Command::Classes, 0, nullptr},
    OptionSpec{"--certify", false, Command::Certify, 0, nullptr},
    OptionSpec{"--out", true, Command::Out, kBuilder | kCells,
               [](Options& o, std::string_view given) { o.out = given; }},
    OptionSpec{"--cases", true, Command::Cases, 0, [](Options& o, std::string_view given) { o.out = given; }},
    OptionSpec{"--builder", false, Command::Builder, 0, nullptr},
    OptionSpec{"--cells", false, Command::Cells, 0, nullptr},
    OptionSpec{"--leaf", true, std::nullopt, kBuilder, set_leaf},
    OptionSpec{"--dim", true, std::nullopt,
               kCount | kTransversal | kSymmetries | kClasses | kCertify | kOut | kCases | kBuilder | kSummary,
               set_dim},
    OptionSpec{"--tile", true, std::nullopt, kCount | kClasses | kCertify | kOut | kSummary, set_tile},
    OptionSpec{"--group", true, std::nullopt, kCount | kTransversal | kSymmetries | kCertify, set_group},
    OptionSpec{"--list", false, std::nullopt, kTransversal, [](Options& o, std::string_view) { o.list = true; }},
    OptionSpec{"--inversion", false, std::nullopt, kCount | kSymmetries | kCertify,
               [](Options& o, std::string_view) { o.inversion = true; }},
    OptionSpec{"--table-by-class", false, std::nullopt, kCertify,
               [](Options& o, std::string_view) { o.table_by_class = true; }},
    OptionSpec{"--all", false, std::nullopt, kCertify, [](Options& o, std::string_view) { o.all_resolutions = true; }},
    OptionSpec{"--sample", true, std::nullopt, kCertify, set_sample},
    OptionSpec{"--seed", true, std::nullopt, kCertify, set_seed},
    OptionSpec{"--threads", true, std::nullopt, kCertify, set_threads},
    OptionSpec{"--alternative", true, std::nullopt, kClasses, set_alternative},
    OptionSpec{"--json", false, std::nullopt, kCount | kTransversal | kSymmetries | kClasses | kCertify | kSummary,
               [](Options& o, std::string_view) { o.json = true; }},
    OptionSpec{"--keep", false, std::nullopt, kOut | kBuilder | kCells,
               [](Options& o, std::string_view) { o.keeps_same = true; }},
    OptionSpec{"--layout", true, std::nullopt, kOut, set_layout},
    OptionSpec{"--language", true, std::nullopt, kOut | kBuilder, set_languages},
    OptionSpec{"--triangulation", true, std::nullopt, kOut | kBuilder, set_triangulation},
};

/// Names of the options for which `wanted` holds, for messages.
template <typename Predicate>
std::string names_of(Predicate wanted) {
  std::vector<std::string_view> names;
  for (const OptionSpec& spec : kOptions) {
    if (wanted(spec)) {
      names.push_back(spec.name);
    }
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

/// An option of the command line, with its value if it takes one.
struct Given {
  const OptionSpec* spec;
  std::string_view value;
};

std::vector<Given> split(std::span<const std::string_view> arguments) {
  std::vector<Given> result;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::size_t equals = arguments[i].find('=');
    const std::string_view name = arguments[i].substr(0, equals);
    const auto* const spec = std::find_if(kOptions.begin(), kOptions.end(),
                                          [name](const OptionSpec& candidate) { return candidate.name == name; });
    if (spec == kOptions.end()) {
      refuse(fmt::format("unknown option '{}': expected one of --help, {}", arguments[i],
                         names_of([](const OptionSpec&) { return true; })));
    }
    std::string_view value;
    if (equals != std::string_view::npos) {
      value = arguments[i].substr(equals + 1);
    } else if (spec->takes_value && i + 1 < arguments.size() && !arguments[i + 1].starts_with("--")) {
      value = arguments[++i];
    }
    if (spec->takes_value && value.empty()) {
      refuse(fmt::format("{} has no value: expected one after it", name));
    }
    if (!spec->takes_value && equals != std::string_view::npos) {
      refuse(fmt::format("{} takes no value, but '{}' was given", name, value));
    }
    result.push_back({spec, value});
  }
  return result;
}

/// Whether the option, also a command, only names the folder of another command: `--out` with `--builder`, `--cells`.
bool is_folder_of_another(const Given& option, const std::vector<Given>& given) {
  return option.spec->command == Command::Out && std::any_of(given.begin(), given.end(), [](const Given& g) {
           return g.spec->command == Command::Builder || g.spec->command == Command::Cells;
         });
}

/// The only option that is a command, or null if there is none but a dimension or a tile, which select the summary.
/// Refuses several, and none without one of these.
const OptionSpec* command_of(const std::vector<Given>& given) {
  const OptionSpec* command = nullptr;
  for (const Given& option : given) {
    if (!option.spec->command || is_folder_of_another(option, given)) {
      continue;
    }
    if (command != nullptr && command != option.spec) {
      refuse(fmt::format("{} and {} were both given: expected one command", command->name, option.spec->name));
    }
    command = option.spec;
  }
  const bool is_summary = std::any_of(given.begin(), given.end(), [](const Given& option) {
    return option.spec->name == "--dim" || option.spec->name == "--tile";
  });
  if (command == nullptr && !is_summary) {
    refuse(fmt::format("no command was given: expected --dim N or --tile CELL for a summary, or one of --help, {}",
                       names_of([](const OptionSpec& spec) { return spec.command.has_value(); })));
  }
  return command;
}

/// Highest dimension in which single tiles can be built.
constexpr int kMaxSampledDim = 6;
/// Highest dimension that has a builder.
constexpr int kMaxBuilderDim = 5;

/// Checks --dim without a command. The message names the commands that go further.
void check_summary_dim(const Options& options) {
  const bool is_cube = options.tile == TileKind::cube;
  const int highest = is_cube ? kMaxBuilderDim : kMaxEnumeratedDim;
  if (options.dim >= 2 && options.dim <= highest) {
    return;
  }
  refuse(fmt::format("--dim {} without a command: expected 2 to {}{}", options.dim, highest,
                     is_cube ? fmt::format(", or one of --count (1 to {}), --certify --sample COUNT (2 to {})", kMaxDim,
                                           kMaxSampledDim)
                             : ", where all tables are certified"));
}

/// Checks --dim against the range of the command.
void check_dim(const Options& options, std::string_view command) {
  if (options.command == Command::Version || options.command == Command::Cells) {
    return;
  }
  if (options.command == Command::Summary) {
    check_summary_dim(options);
    return;
  }
  const bool count = options.command == Command::Count;
  const int lowest = count ? 1 : 2;
  const bool sample = options.sample > 0 && options.tile == TileKind::cube;
  const int highest = count                                           ? kMaxDim
                      : options.command == Command::Transversal       ? kMaxSignatureDim
                      : options.command == Command::Builder           ? kMaxBuilderDim
                      : options.command == Command::Certify && sample ? kMaxSampledDim
                                                                      : kMaxEnumeratedDim;
  if (options.dim < lowest || options.dim > highest) {
    const bool could_sample = options.command == Command::Certify && options.tile == TileKind::cube;
    refuse(fmt::format("--dim {}: {} expects {} to {}{}", options.dim, command, lowest, highest,
                       could_sample && !sample ? fmt::format(", with --sample to {}", kMaxSampledDim) : ""));
  }
}

/// Sets the dimension of a mesh cell, which its name gives. The octahedron of four dimensions is a mesh cell.
void set_cell(Options& options, bool has_dim) {
  if (options.tile == TileKind::octahedron && options.dim == 4) {
    options.tile = TileKind::other;
    options.cell = &*std::find_if(kCellNames.begin(), kCellNames.end(),
                                  [](const CellName& cell) { return cell.given == "cross4"; });
  }
  if (options.cell == nullptr) return;
  if (has_dim && options.dim != options.cell->dim)
    refuse(fmt::format("--dim {}: --tile {} expects {}", options.dim, options.cell->given, options.cell->dim));
  options.dim = options.cell->dim;
}

/// Checks the dimension and the options that a tile other than the cube allows.
void check_tile(const Options& options) {
  if (options.tile == TileKind::cube) {
    return;
  }
  const std::string_view name = tile_text(options);
  const bool octahedron = options.tile == TileKind::octahedron;
  if (octahedron ? options.dim != 3 : options.dim < 2 || options.dim > 4) {
    refuse(fmt::format("--dim {}: --tile {} expects {}", options.dim, name, octahedron ? "3 or 4" : "2 to 4"));
  }
  if (options.cell != nullptr && options.layout != LayoutChoice::Auto)
    refuse(fmt::format("--layout does not go with --tile {}: its table has the layout of the mesh cells", name));
  if (options.cell != nullptr && options.dim == 4 && options.triangulation == TriangulationChoice::Compact)
    refuse(fmt::format("--triangulation compact: --tile {} expects barycentric, or all", name));
  if (options.table_by_class || options.layout == LayoutChoice::Class) {
    refuse(fmt::format("--tile {} does not go with {}: expected a cube", name,
                       options.table_by_class ? "--table-by-class" : "--layout class"));
  }
  for (const Language language : options.languages) {
    if (language != Language::cpp && language != Language::json) {
      refuse(
          fmt::format("--tile {} does not go with --language {}: expected cpp or json", name, language_name(language)));
    }
  }
}

/// Checks the combinations of options of `--certify`: --group and --inversion only with --table-by-class, which exists
/// for dimensions 2 and 3; --seed only with --sample; --threads only with --all or --sample.
void check_certify(const Options& options, const std::vector<const OptionSpec*>& seen) {
  if (options.command != Command::Certify) {
    return;
  }
  if (options.table_by_class && options.dim > 3) {
    refuse(fmt::format("--dim {}: --table-by-class expects 2 or 3", options.dim));
  }
  const bool resolutions = options.all_resolutions || options.sample > 0;
  if (options.all_resolutions && options.sample > 0) {
    refuse("--all and --sample were both given: expected one of them");
  }
  if (options.table_by_class && resolutions) {
    refuse(fmt::format("{} does not go with --table-by-class", options.sample > 0 ? "--sample" : "--all"));
  }
  for (const OptionSpec* const spec : seen) {
    if (spec->name == "--seed" && options.sample == 0) {
      refuse("--seed does not go with --certify without --sample");
    }
    if (spec->name == "--threads" && !resolutions) {
      refuse("--threads does not go with --certify without --all or --sample");
    }
    if (!options.table_by_class && (spec->name == "--group" || spec->name == "--inversion")) {
      refuse(fmt::format("{} does not go with --certify without --table-by-class", spec->name));
    }
  }
}

}  // namespace

Options parse(std::span<const std::string_view> arguments) {
  Options options;
  // --help overrides everything else
  for (const std::string_view argument : arguments) {
    if (argument == "--help" || argument == "-h") {
      return options;
    }
  }
  // the command
  const std::vector<Given> given = split(arguments);
  const OptionSpec* const command = command_of(given);
  options.command = command == nullptr ? Command::Summary : *command->command;
  const std::string_view name = command == nullptr ? std::string_view() : command->name;
  // its options, each at most once
  std::vector<const OptionSpec*> seen;
  for (const Given& option : given) {
    if (std::find(seen.begin(), seen.end(), option.spec) != seen.end()) {
      refuse(fmt::format("{} was given more than once", option.spec->name));
    }
    seen.push_back(option.spec);
    if (!option.spec->command && (option.spec->known_to & bit(options.command)) == 0) {
      const unsigned command_bit = bit(options.command);
      const std::string known = names_of([=](const OptionSpec& spec) { return (spec.known_to & command_bit) != 0; });
      if (command == nullptr) {
        refuse(fmt::format("{} without a command: expected only {}, or one of {}", option.spec->name, known,
                           names_of([](const OptionSpec& spec) { return spec.command.has_value(); })));
      }
      refuse(fmt::format("{} does not go with {}: expected {}", option.spec->name, name,
                         known.empty() ? "nothing else" : "only " + known));
    }
    if (option.spec->apply != nullptr) {
      option.spec->apply(options, option.value);
    }
  }
  // values that depend on each other
  const bool has_dim = std::any_of(seen.begin(), seen.end(), [](const auto* spec) { return spec->name == "--dim"; });
  const bool is_octahedron = options.tile == TileKind::octahedron;
  if (!has_dim && is_octahedron) options.dim = 3;
  if (!has_dim && !is_octahedron && options.cell == nullptr && options.command != Command::Version &&
      options.command != Command::Cells) {
    refuse(fmt::format("{} without --dim: expected --dim N", command == nullptr ? "--tile" : name));
  }
  set_cell(options, has_dim);
  check_dim(options, name);
  if (options.list && options.json) refuse("--list and --json were both given: expected one of them");
  check_certify(options, seen);
  if (options.keeps_same && options.out.empty()) refuse(fmt::format("--keep does not go with {} without --out", name));
  check_tile(options);
  return options;
}

std::string version_text() {
  return fmt::format("gen {} (table contract {})\n", TEGL_VERSION, tables::kContractVersion);
}

std::string help_text() {
  return R"(gen: counts, proves and writes the tables for contours of n-dimensional images.

usage: gen --dim N COMMAND [OPTIONS]
       gen --cells [--out DIR]
       gen --dim N [--tile T] [--json]
       gen --tile CELL [COMMAND] [OPTIONS]

Without a command, gen makes and certifies all tables (N = 2 ... 4) and the builder (N = 2 ... 5) of dimension N, writes
nothing, and prints a summary: classes by group, certified signatures and pairs of neighbours, non-spherical classes,
sizes of the tables and of the builder. In 5D, which has no tables, 200 random tiles are certified.

commands (one of)
  --count          orbits of the 2^(2^N) signatures under the cube's symmetries, by Burnside's lemma (N = 1 ... 8)
                   and, for N up to 4, by enumeration too: the two must agree
  --transversal    the smallest signature of every class and its orbit's length (N = 2 ... 5), checked by Burnside's
                   lemma and by the sum of the lengths; prints the number of classes for each length
  --symmetries     the elements of a group (N = 2 ... 4; in 4D by kind) as words in quarter turns and mirrors, with the
                   signatures that each fixes, and every class with its isotropy group: the elements that fix its
                   smallest signature
  --classes        every class of signatures under all 2^N N! symmetries (N = 2 ... 4): its smallest signature,
                   orbit length, stabiliser order, facets, components, Euler characteristics, ambiguous faces
  --certify        proves every signature of both alternatives (N = 2 ... 4): closed, manifold, oriented, matching
                   its neighbours; prints the figures. With --table-by-class: the pairs of neighbours in a table
                   that has one entry per class
  --out DIR        certifies, then writes the tables of dimension N (2 ... 4) into DIR
  --cases DIR      writes the catalogue of cases (N = 2 ... 4) into DIR: a Markdown page and its pictures
  --builder        certifies, then prints source code that builds the contour of one tile by recursion over its
                   faces, each ambiguity resolved by its caller (N = 2 ... 5): header and sources, each after a line
                   with its name; with --out DIR, writes them into DIR
  --cells          (without --dim) makes and certifies the tables of the cells of meshes and lattices: simplices,
                   quadrilateral, wedge, pyramid, hexahedron, octahedron, the prisms of 3D cells over time, and the
                   16-cell; prints classes and figures; with --out DIR, writes the tables into DIR
  --help, -h       this text
  --version        version of the program and of the tables' layout

options of --count, --classes, --certify, --out, and without a command
  --tile cube|simplex|octahedron    shape of the tile (default cube): simplices have N = 2 (triangle), 3 (tetrahedron)
                                    and 4, the octahedron has N = 3; their tables are written as C++ and JSON. The
                                    octahedron needs no --dim; with N = 4 it is cross4
  --tile CELL                       a cell of meshes and lattices, whose name gives its dimension: triangle,
                                    quadrilateral, tetrahedron, wedge, pyramid, hexahedron, simplex4,
                                    prism:tetrahedron, prism:wedge, prism:pyramid, prism:hexahedron, prism:octahedron
                                    (prisms over an interval of time) or cross4 (the 16-cell)

options of --count
  --group full|rotations            all symmetries (default) or only rotations
  --inversion                       also the exchange of high and low
  --json                            one object: dim, group, inversion, order, orbits. All numbers are plain JSON
                                    integers; from N = 7 on orbits exceeds 2^53, so read it as a big integer

options of --transversal
  --group full|rotations            all symmetries (default) or only rotations
  --list                            prints the signatures instead, ascending, each with its orbit's length
  --json                            the same as JSON

options of --symmetries
  --group full|rotations            all symmetries (default) or only rotations
  --inversion                       also the exchange of high and low
  --json                            all elements and classes as JSON

options of --classes
  --alternative low|high            corners that are connected in an ambiguous face (default low)
  --json                            the same as JSON

options of --certify
  --table-by-class                  tests a table with one entry per class of a group of symmetries (N = 2, 3). --group
                                    and --inversion select the group; with inversion it is the table of the original
                                    marching cubes, and has holes (exit status 4)
  --all                             every resolution of the ambiguous squares of every class (N = 2 ... 4), one tile for
                                    all that are equal up to symmetry: in 4D 134 683 for 48 453 090, half a minute;
                                    prints the histogram of Euler characteristics
  --sample COUNT                    this many tiles with random signatures and choices in all faces (N = 2 ... 6)
  --seed S                          seed of the sample (default 1)
  --threads T                       number of threads, with --all and --sample (default 0: one per processor)
  --json                            the same as JSON

options of --out
  --layout class|flat|auto          one list of simplices per class or per signature; auto (default): the faster one for
                                    this dimension, by measurement
  --triangulation barycentric|compact|all
                                    triangulations to write (default all)
  --language cpp|json|glsl|wgsl|cuda
                                    language of the tables (default cpp); several with commas: json,glsl
  --keep                            leaves a file that has its text already as it is, with its time

options of --builder
  --out DIR                         writes the source and a manifest with its digest into DIR; advised for N = 4, whose
                                    text has more than 2 MB
  --keep                            as above, with --out
  --triangulation barycentric|compact
                                    N = 3: polygons coned from their barycentre, or as in the compact tables (default)
  --leaf edges|table                contours of the faces by recursion down to the edges, or by table (default)
  --language cpp|glsl|wgsl          language of the source (default cpp); several with commas. N = 2, 3; N = 4, 5: cpp

Facets are cycles of edges, each written as a ternary number, axis N-1 first, with e for the axis along the edge: in 3D
1e0 is the edge along y at x = 0, z = 1. High corners are on a facet's positive side: on the left in 2D, on the
side of the right-hand normal in 3D.

Words name quarter turns rho, mirrors mu and the exchange of high and low iota. Their first letter is applied first:
rho_x^2 rho_y turns twice about x, then once about y.

examples
  gen --dim 3                                        certifies all tables of cubes and prints a summary
  gen --dim 3 --count                                the 22 classes of marching cubes
  gen --dim 3 --count --group rotations --inversion  its 15 classes
  gen --dim 8 --count --json
  gen --dim 2 --symmetries --group rotations         the four rotations of the square
  gen --dim 3 --classes
  gen --dim 3 --tile octahedron --classes
  gen --tile wedge                                   counts and certifies a mesh cell and prints a summary
  gen --tile prism:wedge --certify --all             all signatures and resolutions of the wedge over time
  gen --dim 4 --certify
  gen --dim 4 --certify --all
  gen --dim 5 --certify --sample 10000 --seed 7
  gen --dim 4 --out tables
  gen --dim 3 --builder --leaf edges
  gen --dim 3 --certify --group rotations --inversion --table-by-class

exit status
  0  success
  1  a fault in the generator itself, or out of memory
  2  the command line: unknown, repeated, missing or contradictory options or values
  3  the two counts disagree
  4  a certificate failed; nothing was written
  5  output could not be written
)";
}

}  // namespace tegl::gen
