// SPDX-License-Identifier: BSD-3-Clause
//
// Formats reports as text and JSON.
#include "output/result.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "base/numbers.hpp"
#include "base/printable.hpp"
#include "io/base/simplex_names.hpp"

namespace tegl::cli {

namespace {

std::array<std::pair<const char*, double>, 8> stages(const StageSeconds& seconds) {
  return {{{"read", seconds.read},
           {"classify", seconds.classify},
           {"find", seconds.find},
           {"generate", seconds.generate},
           {"close", seconds.close},
           {"slice", seconds.slice},
           {"check", seconds.check},
           {"write", seconds.write}}};
}

std::string seconds_text(const StageSeconds& seconds) {
  std::string text = fmt::format("{:.3f}", seconds.total());
  const char* separator = " = ";
  for (const auto& [name, value] : stages(seconds)) {
    if (value < 0.0005) continue;
    text += fmt::format("{}{} {:.3f}", separator, name, value);
    separator = " + ";
  }
  return text;
}

/// The faults as text; empty if there are none.
std::string fault_text(const MeshReport& report) {
  std::string text;
  const auto add = [&](std::uint64_t count, std::string_view singular, std::string_view plural) {
    if (count > 0) text += fmt::format("{}{}", text.empty() ? "" : ", ", counted(count, singular, plural));
  };
  add(report.nonmanifold_simplices, "face in more than two simplices", "faces in more than two simplices");
  add(report.bad_links, "vertex with a bad link", "vertices with a bad link");
  add(report.orientation_conflicts, "orientation conflict", "orientation conflicts");
  add(report.nonfinite_vertices, "vertex with an infinite or NaN coordinate",
      "vertices with infinite or NaN coordinates");
  return text;
}

Json merge_json(const MergeSummary& summary) {
  const MergeCounts& counts = summary.counts;
  Json json;
  json["tolerance"] = summary.tolerance;
  json["vertices_before"] = counts.before.vertices;
  json["simplices_before"] = counts.before.simplices;
  json["merged_vertices"] = counts.merged_vertices;
  json["collapsed_simplices"] = counts.collapsed_simplices;
  json["flat_simplices"] = counts.flat_simplices;
  json["kept_flat_simplices"] = counts.kept_flat_simplices;
  json["divided_simplices"] = counts.divided_simplices;
  json["turned_simplices"] = counts.turned_simplices;
  json["euler_before"] = counts.euler_before;
  json["euler_after"] = counts.euler_after;
  json["components_before"] = counts.components_before;
  json["components_after"] = counts.components_after;
  json["vanished_components"] = counts.vanished_components;
  json["vanished_at"] = summary.vanished;
  json["shrunk_places"] = counts.shrunk_places;
  json["shrunk_at"] = summary.shrunk;
  json["pinched_vertices"] = counts.pinched_vertices;
  json["pinched_at"] = summary.vertices;
  json["pinched_faces"] = counts.pinched_faces;
  json["faces_at"] = summary.faces;
  return json;
}

std::string merge_text(const MergeSummary& summary) {
  const MergeCounts& counts = summary.counts;
  const int dim = summary.simplex_dim;
  const std::uint64_t dropped = counts.collapsed_simplices + counts.flat_simplices;
  std::string text = report_line(
      "merged", fmt::format("{} of {}; {} without size dropped", grouped(counts.merged_vertices),
                            counted(counts.before.vertices, "vertex", "vertices"), counted_simplices(dim, dropped)));
  if (counts.pinched_vertices > 0)
    text += report_line(
        "pinched",
        dim == 1 ? counted(counts.pinched_vertices, "vertex", "vertices")
                 : fmt::format("{}, {} in more than two {}", counted(counts.pinched_vertices, "vertex", "vertices"),
                               counted_simplices(dim - 1, counts.pinched_faces), io_detail::simplex_name(dim).plural));
  if (counts.vanished_components > 0)
    text += report_line("vanished",
                        counted(counts.vanished_components, "component without size", "components without size"));
  if (counts.components_after + counts.vanished_components != counts.components_before || counts.shrunk_places > 0)
    text += report_line("components", fmt::format("{} before, {} after; tubes and loops shrank in {}",
                                                  grouped(counts.components_before), grouped(counts.components_after),
                                                  counted(counts.shrunk_places, "place", "places")));
  if (counts.turned_simplices > 0)
    text += report_line("turned", fmt::format("{}; a smaller --merge-within turns fewer",
                                              counted_simplices(dim, counts.turned_simplices)));
  return text;
}

std::string pick_text(const Picked& picked) {
  const auto line = [&](const std::string& found) {
    return report_line("picked", fmt::format("({}): {}", fmt::join(picked.point, ", "), found));
  };
  if (picked.components == 0) return line("no component, as the contour is empty");
  const std::string all = fmt::format("1 of {}", counted(picked.components, "component", "components"));
  if (!picked.distance) return line("no tile is active; the component of the nearest vertex") + report_line("", all);
  const std::string away = number(*picked.distance) + (picked.is_in_world ? " away in the world" : " steps away");
  if (picked.tile.empty()) return line("the nearest vertex is " + away) + report_line("", all);
  return line(fmt::format("tile ({}), {}", fmt::join(picked.tile, ", "),
                          *picked.distance == 0 ? "which contains it" : away)) +
         report_line("", fmt::format("{} in {}", all, counted(picked.tiles, "tile", "tiles")));
}

}  // namespace

std::string report_line(std::string_view label, std::string_view value) {
  return report_line(label, Styled{printable(value)});
}

std::string report_line(std::string_view label, const Styled& value) {
  return fmt::format("  {:<12} {}\n", printable(label), value.text);
}

std::string InputFiles::text() const {
  if (names.size() == 1) return names.front();
  return fmt::format("{} .. {} ({})", names.front(), names.back(), counted(names.size(), "file", "files"));
}

Json InputFiles::json() const { return names.size() == 1 ? Json(names.front()) : Json(names); }

std::string input_line(const InputFiles& input, const std::string& variable) {
  return report_line("input", variable.empty() ? input.text() : fmt::format("{} ({})", input.text(), variable));
}

std::string axis_label(const std::string& name, std::size_t axis) {
  return name.empty() ? std::string(1, "xyztu"[axis]) : name;
}

std::size_t axis_called(const std::string& name, const std::vector<std::string>& labels) {
  constexpr std::string_view kLetters = "xyztu";
  for (std::size_t a = 0; a < labels.size(); ++a)
    if (equal_ignoring_case(name, labels[a])) return a;
  const std::size_t a = std::min(name.size() == 1 ? kLetters.find(name[0]) : std::string_view::npos, labels.size());
  // An axis that is named by a letter itself, as in a mesh in the plane of x and z, has no other letter.
  const auto is_letter = [&](const std::string& label) {
    return std::any_of(kLetters.begin(), kLetters.end(),
                       [&](char letter) { return equal_ignoring_case(label, std::string_view(&letter, 1)); });
  };
  return a < labels.size() && is_letter(labels[a]) ? labels.size() : a;
}

std::string dump(const Json& json) {
  return printable_json(json.dump(2, ' ', false, Json::error_handler_t::replace)) + "\n";
}

MeshSize size_of(const Mesh& mesh) {
  return {mesh.dim, mesh.coordinates.size() / static_cast<std::size_t>(mesh.space_dim),
          mesh.simplices.size() / (static_cast<std::size_t>(mesh.dim) + 1)};
}

void add_check_keys(Json& json, const MeshSize& size, const std::optional<MeshReport>& report) {
  const auto of = [&](auto member) { return report ? Json((*report).*member) : Json(nullptr); };
  json["dim"] = size.dim;
  json["vertices"] = report ? report->vertices : size.vertices;
  json["simplices"] = size.simplices;
  json["components"] = of(&MeshReport::components);
  json["euler"] = of(&MeshReport::euler);
  json["boundary_simplices"] = of(&MeshReport::boundary_simplices);
  json["nonmanifold_simplices"] = of(&MeshReport::nonmanifold_simplices);
  json["bad_links"] = of(&MeshReport::bad_links);
  json["orientation_conflicts"] = of(&MeshReport::orientation_conflicts);
  json["degenerate_simplices"] = of(&MeshReport::degenerate_simplices);
  json["nonfinite_vertices"] = of(&MeshReport::nonfinite_vertices);
}

bool has_faults(const MeshReport& report) {
  return report.nonmanifold_simplices + report.bad_links + report.orientation_conflicts + report.nonfinite_vertices > 0;
}

std::string counted_simplices(int dim, std::uint64_t count) {
  const auto [singular, plural] = io_detail::simplex_name(dim);
  return counted(count, singular, plural);
}

std::string check_text(const Console& console, const MeshSize& size, const std::optional<MeshReport>& report,
                       const Wording& wording) {
  std::string text = report_line("size", fmt::format("{}, {}", counted(size.vertices, "vertex", "vertices"),
                                                     counted_simplices(size.dim, size.simplices)));
  if (!report) return text + report_line("check", wording.unchecked);
  if (report->unused_vertices > 0) {
    text += report_line("unused", counted(report->unused_vertices, "vertex in no simplex", "vertices in no simplex"));
  }
  if (report->simplices == 0) return text + report_line("check", "empty: no simplices");
  text += report_line("components", grouped(report->components));
  text += report_line("Euler", fmt::format("{}", report->euler));
  text += report_line("border", report->boundary_simplices == 0
                                    ? "none: closed"
                                    : counted_simplices(report->dim - 1, report->boundary_simplices));
  if (report->boundary_simplices > 0 && !wording.open.empty()) text += report_line("", wording.open);
  const std::string faults = fault_text(*report);
  text += report_line("check", faults.empty() ? console.green("an oriented manifold") : console.red(faults));
  if (report->degenerate_simplices > 0) {
    text += report_line("", fmt::format("{} of zero size ({})",
                                        counted_simplices(report->dim, report->degenerate_simplices), wording.no_size));
  }
  return text;
}

MeshReport check_mesh(const Mesh& mesh, const WorkOptions& work) {
  return check(mesh.dim, mesh.simplices, mesh.space_dim, mesh.coordinates, work);
}

void StageSeconds::add(const ExtractStats& stats) {
  read += stats.read_seconds;
  classify += stats.classify_seconds;
  find += stats.find_seconds;
  generate += stats.generate_seconds;
  close += stats.close_seconds;
}

Json to_json(const ContourResult& result) {
  // input and request
  Json json;
  json["input"] = result.input.json();
  json["variable"] = result.variable.empty() ? Json(nullptr) : Json(result.variable);
  json["output"] = result.output;
  json["image_dim"] = result.image_dim;
  json["isovalue"] = result.isovalue ? Json(*result.isovalue) : Json(nullptr);
  if (!result.isovalues.empty()) json["isovalues"] = result.isovalues;
  if (result.label) json["label"] = *result.label;
  if (result.folded_cells) json["folded_cells"] = *result.folded_cells;
  // cut and pick
  json["at"] = nullptr;
  if (result.cut) {
    json["at"] = {{"axis", result.cut->axis}, {"value", result.cut->value}};
    if (result.cut->frame) {
      json["at"]["normal"] = result.cut->normal;
      json["at"]["frame"] = {{"origin", result.cut->frame->origin}, {"axes", result.cut->frame->axes}};
    }
  }
  json["pick"] = nullptr;
  if (result.picked)
    json["pick"] = {{"point", result.picked->point},
                    {"tile", result.picked->tile.empty() ? Json(nullptr) : Json(result.picked->tile)},
                    {"distance", result.picked->distance ? Json(*result.picked->distance) : Json(nullptr)},
                    {"tiles", result.picked->tile.empty() ? Json(nullptr) : Json(result.picked->tiles)},
                    {"components", result.picked->components}};
  // mesh and times
  add_check_keys(json, result.size(), result.report);
  json["merge"] = result.merging ? merge_json(*result.merging) : Json(nullptr);
  json["vertices_together"] = result.lost.count();
  json["tiles"] = result.stats ? Json(result.stats->tiles) : Json(nullptr);
  json["active_tiles"] = result.stats ? Json(result.stats->active_tiles) : Json(nullptr);
  Json& seconds = json["seconds"];
  for (const auto& [name, value] : stages(result.seconds)) seconds[name] = value;
  seconds["total"] = result.seconds.total();
  return json;
}

std::string to_text(const Console& console, const ContourResult& result) {
  // heading
  std::string what = result.cut ? fmt::format("Slice at {} = {}", result.cut->axis, number(result.cut->value))
                                : fmt::format("Contour in {}D", result.image_dim);
  if (!result.wording.heading.empty()) what = result.wording.heading;
  if (result.isovalue) what += fmt::format(" of the isovalue {}", number(*result.isovalue));
  if (!result.isovalues.empty()) {
    std::string all;
    for (const double isovalue : result.isovalues) all += (all.empty() ? "" : ", ") + number(isovalue);
    what += " of the isovalues " + all;
  }
  std::string text = fmt::format("{}\n", console.bold(what));
  // input and pick
  text += input_line(result.input, result.variable);
  if (result.picked) text += pick_text(*result.picked);
  if (result.stats) {
    text += report_line(
        "tiles", fmt::format("{} active of {}", grouped(result.stats->active_tiles), grouped(result.stats->tiles)));
  }
  // mesh, times, output
  if (result.merging) text += merge_text(*result.merging);
  text += check_text(console, result.size(), result.report, result.wording);
  if (result.lost.count() > 0) text += report_line("in the file", console.red(result.lost.text()));
  text += report_line("seconds", seconds_text(result.seconds));
  text += report_line("output", fmt::format("{} ({})", result.output, byte_size(result.output_bytes)));
  return text;
}

}  // namespace tegl::cli
