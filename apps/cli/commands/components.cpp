// SPDX-License-Identifier: BSD-3-Clause
//
// tegl components: lists the connected components of a contour with their measures, and writes files with some of them.
#include "tegl/components.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "base/empty_result.hpp"
#include "base/numbers.hpp"
#include "base/table.hpp"
#include "base/units.hpp"
#include "input/commands.hpp"
#include "input/component_selection.hpp"
#include "input/contour_input.hpp"
#include "io/base/text.hpp"
#include "io/meshes/meshes.hpp"
#include "output/output.hpp"

namespace tegl::cli {

namespace {

constexpr const char* kComponentsExamples =
    "Examples:\n"
    "  tegl components head.nii.gz --iso 60\n"
    "  tegl components head.nii.gz --iso 60 --largest 1 -o skin.ply\n"
    "  tegl components cells.vtkhdf --select 'size > 10 and t contains 7.3' -o some.vtkhdf\n"
    "  tegl components cells.ply --select 'closed and x within 0..50' --split 'cell_{label}.ply'\n"
    "Conditions: label, rank (1: the largest), vertices, simplices, size (length, area or volume), content (enclosed\n"
    "area or volume; negative for a cavity), euler, boundary: with <, <=, >, >=, =, != and a number; closed; open;\n"
    "AXIS contains NUMBER, AXIS meets LOW..HIGH, AXIS within LOW..HIGH for the range that the component has along an\n"
    "axis; AXIS.min, AXIS.max, AXIS.span, AXIS.centroid; and, or, not, parentheses.";

/// The components, independent of their dimension.
struct FoundComponents {
  std::vector<ComponentFacts> facts;  ///< by label
  std::vector<bool> chosen;
};

template <int N>
std::vector<ComponentFacts> facts_of(const std::vector<Component<N>>& found) {
  std::vector<ComponentFacts> result;
  for (const Component<N>& component : found) {
    ComponentFacts& facts = result.emplace_back();
    facts.label = component.label;
    facts.vertices = static_cast<double>(component.vertices);
    facts.simplices = static_cast<double>(component.simplices);
    facts.size = component.size;
    facts.content = component.content;
    facts.euler = static_cast<double>(component.euler);
    facts.boundary = static_cast<double>(component.boundary_simplices);
    facts.lowest.assign(component.lowest.begin(), component.lowest.end());
    facts.highest.assign(component.highest.begin(), component.highest.end());
    facts.centroid.assign(component.centroid.begin(), component.centroid.end());
  }
  std::vector<std::size_t> order(result.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return result[a].size > result[b].size; });
  for (std::size_t i = 0; i < order.size(); ++i) result[order[i]].rank = static_cast<double>(i + 1);
  return result;
}

std::string integer(double value) { return fmt::format("{:.0f}", value); }

class ComponentsCommand final : public ContourInputCommand {
 public:
  explicit ComponentsCommand(CLI::App& program)
      : ContourInputCommand(program, "components",
                            "List the connected components of a contour, and write some or all of them") {
    app()
        .add_option("--select", conditions_,
                    "only components that meet this condition; several conditions must all be met")
        ->allow_extra_args(false)
        ->type_name("CONDITION");
    app()
        .add_option("--largest", largest_, "only this many of them, the largest by size")
        ->check(whole_number(1))
        ->type_name("COUNT");
    app()
        .add_option(
            "-o,--output", output_,
            fmt::format("one file with the selected components and their labels as an attribute: {}", kContourFiles))
        ->type_name("FILE");
    compress_.add_to(app());
    app()
        .add_option("--split", split_, "one file per component; {label} in the name is replaced by its label")
        ->type_name("FILE");
    app().add_option("--csv", csv_, "the table as CSV")->type_name("FILE");
    app()
        .add_option("--rows", rows_, "number of table rows shown, the largest components first; 0: all")
        ->check(whole_number(0))
        ->type_name("COUNT")
        ->capture_default_str();
    app().footer(kComponentsExamples);
  }

  ExitCode run(const Streams& streams) override {
    require_inputs();
    require_outputs();
    // read, parse conditions, select and write
    ProgressBar bar(streams.err, wants_progress());
    ContourInput input = read_contour(bar);
    require_outputs_hold(input.space_dim() - 1);
    for (int a = 0; a < input.space_dim(); ++a) axes_.push_back(input.axis_name(a));
    std::vector<ComponentSelection> conditions;
    for (const std::string& condition : conditions_) conditions.emplace_back(condition, axes_);
    const FoundComponents found =
        std::visit([&](auto& contour) { return work(contour, input, conditions, bar); }, input.contour);
    // report
    bar.clear();
    if (json())
      streams.out.write(dump(document(input, found)));
    else if (!quiet())
      streams.out.write(report(streams.out, input, found));
    return ExitCode::Ok;
  }

 private:
  void require_outputs() const {
    compress_.require_file(!output_.empty() || !split_.empty());
    if (!output_.empty()) {
      require_output(output_, files());
      require_output_keeps(output_, normals(), true);
      compress_.require_known(output_);
    }
    if (!csv_.empty()) require_text_output(csv_, files());
    std::vector<std::string> outputs;
    for (const std::string& output : {output_, csv_})
      if (!output.empty()) outputs.push_back(output);
    require_different_outputs(outputs);
    if (split_.empty()) return;
    if (split_.find(kLabel) == std::string::npos)
      throw Error(
          ErrorCode::InvalidArgument,
          fmt::format("--split is '{}'; expected a name with {{label}}, which the label of each component replaces",
                      split_));
    require_output(split_name(0), files());
    require_output_keeps(split_name(0), normals(), false);
    compress_.require_known(split_name(0));
  }

  void require_outputs_hold(int dim) const {
    if (!output_.empty()) require_output_holds(output_, dim);
    if (!split_.empty()) require_output_holds(split_name(0), dim);
  }

  [[nodiscard]] std::string split_name(std::size_t label) const {
    std::string name = split_;
    const std::string text = std::to_string(label);
    for (auto at = name.find(kLabel); at != std::string::npos; at = name.find(kLabel, at + text.size()))
      name.replace(at, kLabel.size(), text);
    return name;
  }

  /// Labels, selects and writes components.
  template <int N>
  FoundComponents work(Contour<N, double>& contour, const ContourInput& input,
                       const std::vector<ComponentSelection>& conditions, ProgressBar& bar) {
    Stopwatch watch;
    const ComponentLabels labels = label_components(contour, {threads(), bar.stage("components")});
    FoundComponents found;
    found.facts = facts_of(components(contour, labels, {threads(), bar.stage("measure")}));
    components_seconds_ = watch.lap();
    choose(found, conditions);
    WrittenFiles written;
    if (!output_.empty()) {
      contour = add_component_attribute(std::move(contour), labels);
      const Mesh mesh =
          mesh_of(select_components(contour, labels, found.chosen, {threads(), bar.stage("select")}), input);
      const Progress progress = bar.stage("write");
      written.write(output_, [&](const PendingPath& file) {
        write_mesh(mesh, file, {.work = {.progress = progress}, .compression = compress_.compression()});
      });
      lost_ = lost_vertices(mesh, output_);
      remark(lost_.remark(output_));
    }
    if (!split_.empty()) {
      const LostVertices lost = write_split(contour, input, labels, found, bar, written);
      remark(lost.remark(split_));
      lost_ += lost;
    }
    if (!csv_.empty())
      written.write(csv_,
                    [&](const PendingPath& file) { write_text(table(input, found, &exact_number).to_csv(), file); });
    written.keep();
    write_seconds_ = watch.lap();
    return found;
  }

  void choose(FoundComponents& found, const std::vector<ComponentSelection>& conditions) const {
    for (const ComponentFacts& facts : found.facts)
      found.chosen.push_back(
          std::all_of(conditions.begin(), conditions.end(), [&](const auto& condition) { return condition(facts); }));
    std::vector<std::size_t> order = by_size(found);
    if (order.empty() && !found.facts.empty())
      throw EmptyResult(fmt::format("none of the {} meets the conditions; expected at least one",
                                    counted(found.facts.size(), "component", "components")));
    for (std::size_t i = largest_; largest_ > 0 && i < order.size(); ++i) found.chosen[order[i]] = false;
  }

  /// The labels of the selected components, the largest first.
  static std::vector<std::size_t> by_size(const FoundComponents& found) {
    std::vector<std::size_t> order;
    for (std::size_t label = 0; label < found.facts.size(); ++label)
      if (found.chosen[label]) order.push_back(label);
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return found.facts[a].rank < found.facts[b].rank; });
    return order;
  }

  /// Writes a file per component; returns the number of vertices that coincide in the files.
  template <int N>
  LostVertices write_split(const Contour<N, double>& contour, const ContourInput& input, const ComponentLabels& labels,
                           const FoundComponents& found, ProgressBar& bar, WrittenFiles& written) const {
    constexpr std::size_t kMostFiles = 10000;
    const auto count = static_cast<std::size_t>(std::count(found.chosen.begin(), found.chosen.end(), true));
    if (count > kMostFiles)
      throw Error(ErrorCode::InvalidArgument, fmt::format("--split would write {} files; expected at most {} (choose "
                                                          "components with --select or --largest)",
                                                          count, kMostFiles));
    const std::vector<Contour<N, double>> parts = split_components(contour, labels, {threads(), bar.stage("split")});
    const Progress progress = bar.stage("write");
    std::size_t done = 0;
    LostVertices lost;
    for (std::size_t label = 0; label < parts.size(); ++label) {
      if (!found.chosen[label]) continue;
      const std::string name = split_name(label);
      require_output(name, files());
      if (!progress(static_cast<double>(done++) / static_cast<double>(count))) InterruptHandler::throw_if_requested();
      const MeshView mesh = mesh_of(parts[label], input);
      written.write(name,
                    [&](const PendingPath& file) { write_mesh(mesh, file, {.compression = compress_.compression()}); });
      lost += lost_vertices(mesh, name);
    }
    return lost;
  }

  [[nodiscard]] Table table(const ContourInput& input, const FoundComponents& found,
                            std::string (*to_text)(double)) const {
    const std::vector<std::string> of_axes = units(input);
    Table result{{"label", "rank", "vertices", "simplices",
                  heading_with_unit("size", measure_unit(of_axes, input.space_dim() - 1)),
                  heading_with_unit("content", content_unit(of_axes)), "euler", "boundary"},
                 {}};
    for (const char* const quantity : {".min", ".max", ".centroid"})
      for (std::size_t a = 0; a < axes_.size(); ++a)
        result.headings.push_back(heading_with_unit(axes_[a] + quantity, of_axes[a]));
    for (const std::size_t label : by_size(found)) {
      const ComponentFacts& facts = found.facts[label];
      std::vector<std::string>& row = result.rows.emplace_back();
      row = {integer(facts.label),     integer(facts.rank),    integer(facts.vertices),
             integer(facts.simplices), to_text(facts.size),    facts.content ? to_text(*facts.content) : "",
             integer(facts.euler),     integer(facts.boundary)};
      for (const auto& place : {facts.lowest, facts.highest, facts.centroid})
        for (const double x : place) row.push_back(to_text(x));
    }
    return result;
  }

  /// A narrower table, with the box as ranges.
  [[nodiscard]] Table shown_table(const FoundComponents& found, int dim) const {
    Table result{{"label", "simplices", measure_name(dim, dim + 1), "enclosed", "Euler"}, {}};
    for (const std::string& axis : axes_) result.headings.push_back(axis);
    for (const std::size_t label : by_size(found)) {
      const ComponentFacts& facts = found.facts[label];
      std::vector<std::string>& row = result.rows.emplace_back();
      row = {integer(facts.label), integer(facts.simplices), number(facts.size),
             facts.content        ? number(*facts.content)
             : facts.boundary > 0 ? "open"
                                  : "-",
             integer(facts.euler)};
      for (std::size_t a = 0; a < axes_.size(); ++a)
        row.push_back(fmt::format("{:.4g}..{:.4g}", facts.lowest[a], facts.highest[a]));
    }
    return result;
  }

  static std::vector<std::string> units(const ContourInput& input) {
    std::vector<std::string> result;
    for (int a = 0; a < input.space_dim(); ++a) result.push_back(input.axis_unit(a));
    return result;
  }

  [[nodiscard]] std::string report(const Console& console, const ContourInput& input,
                                   const FoundComponents& found) const {
    const int dim = input.space_dim() - 1;
    const std::size_t chosen = by_size(found).size();
    const std::string all = counted(found.facts.size(), "component", "components");
    std::string text = fmt::format(
        "{}\n", console.bold(chosen == found.facts.size() ? all : fmt::format("{} of {}", grouped(chosen), all)));
    text += input_text(input);
    const std::optional<std::string> size_unit = measure_unit(units(input), dim);
    const std::optional<std::string> in = content_unit(units(input));
    const auto named = [](const std::optional<std::string>& unit, const char* without) {
      return !unit ? without : unit->empty() ? "none" : unit->c_str();
    };
    text += report_line("units", fmt::format("{}: {}, enclosed: {}", measure_name(dim, dim + 1),
                                             named(size_unit, "mixed (the axes have different units)"),
                                             named(in, "incomplete (some axes have no unit)")));
    text += shown_table(found, dim).to_text(rows_ == 0 ? chosen : rows_);
    if (rows_ != 0 && chosen > rows_)
      text += fmt::format("  ... and {} smaller ones (--rows 0 shows all)\n", grouped(chosen - rows_));
    text += report_line("seconds", fmt::format("read and contour {:.3f} + components {:.3f} + write {:.3f}",
                                               input.seconds.total(), components_seconds_, write_seconds_));
    if (!output_.empty()) text += report_line("output", output_);
    if (!split_.empty())
      text += report_line("output", fmt::format("{} ({})", split_, counted(chosen, "file", "files")));
    if (lost_.count() > 0) text += report_line("in the file", console.red(lost_.text()));
    if (!csv_.empty()) text += report_line("table", csv_);
    return text;
  }

  [[nodiscard]] Json document(const ContourInput& input, const FoundComponents& found) const {
    Json json;
    add_input_keys(json, input);
    const auto unit = [](const std::optional<std::string>& of) { return of ? Json(*of) : Json(nullptr); };
    json["output"] = output_.empty() ? Json(nullptr) : Json(output_);
    json["axes"] = axes_;
    json["size_unit"] = unit(measure_unit(units(input), input.space_dim() - 1));
    json["content_unit"] = unit(content_unit(units(input)));
    json["count"] = found.facts.size();
    json["vertices_together"] = lost_.count();
    Json& list = json["components"] = Json::array();
    for (std::size_t label = 0; label < found.facts.size(); ++label)
      if (found.chosen[label]) list.push_back(to_json(found.facts[label], label));
    json["seconds"] = {{"read", input.seconds.total()}, {"components", components_seconds_}, {"write", write_seconds_}};
    return json;
  }

  [[nodiscard]] Json to_json(const ComponentFacts& facts, std::size_t label) const {
    const auto whole = [](double value) { return static_cast<std::int64_t>(value); };
    Json json;
    json["label"] = whole(facts.label);
    json["rank"] = whole(facts.rank);
    json["vertices"] = whole(facts.vertices);
    json["simplices"] = whole(facts.simplices);
    json["size"] = facts.size;
    json["content"] = facts.content ? Json(*facts.content) : Json(nullptr);
    json["euler"] = whole(facts.euler);
    json["boundary_simplices"] = whole(facts.boundary);
    json["closed"] = facts.boundary == 0;
    json["lowest"] = facts.lowest;
    json["highest"] = facts.highest;
    json["centroid"] = facts.centroid;
    json["output"] = split_.empty() ? Json(nullptr) : Json(split_name(label));
    return json;
  }

  static constexpr std::string_view kLabel = "{label}";
  std::vector<std::string> conditions_;
  std::size_t largest_ = 0;
  std::string output_;
  std::string split_;
  std::string csv_;
  CompressOption compress_;
  std::size_t rows_ = 20;
  std::vector<std::string> axes_;
  LostVertices lost_;  ///< vertices that coincide in the files
  double components_seconds_ = 0;
  double write_seconds_ = 0;
};

}  // namespace

std::unique_ptr<Command> make_components_command(CLI::App& program) {
  return std::make_unique<ComponentsCommand>(program);
}

}  // namespace tegl::cli
