// SPDX-License-Identifier: BSD-3-Clause
//
// tegl check: checks whether a mesh is a manifold.
#include <fmt/format.h>

#include <vector>

#include "base/progress.hpp"
#include "input/commands.hpp"
#include "input/contour_input.hpp"
#include "output/output.hpp"
#include "output/result.hpp"

namespace tegl::cli {

namespace {

constexpr const char* kCheckExamples =
    "Examples:\n"
    "  tegl check skull.ply\n"
    "  tegl check --require closed --json ball.vtkhdf\n"
    "The exit code is 0 for an oriented manifold, with or without a border, and 1 for anything else.";

class CheckCommand final : public Command {
 public:
  explicit CheckCommand(CLI::App& program)
      : Command(program, "check", "Check whether a mesh is an oriented manifold, and count its faults",
                "the mesh: .ply, .gltf, .glb, .vtkhdf, .stl or .obj") {
    add_quiet();
    app()
        .add_option("--require", required_,
                    "further requirements: closed (no border), nondegenerate (no simplices of zero size)")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::IsMember({"closed", "nondegenerate"}));
    app().footer(kCheckExamples);
  }

  ExitCode run(const Streams& streams) override {
    require_inputs();
    ProgressBar bar(streams.err, wants_progress());
    Stopwatch watch;
    const Mesh mesh = read_finite_mesh(file(), mesh_options(bar.stage("read")));
    const double read_seconds = watch.lap();
    const MeshReport report = check_mesh(mesh, bar.stage("check"));
    const double check_seconds = watch.lap();
    bar.clear();
    const std::string missed = missed_requirement(report);
    if (json()) {
      Json json;
      add_check_keys(json, size_of(mesh), report);
      json["seconds"] = {{"read", read_seconds}, {"check", check_seconds}, {"total", read_seconds + check_seconds}};
      streams.out.write(dump(json));
    } else if (!quiet()) {
      streams.out.write(
          fmt::format("{}\n{}{}{}", streams.out.bold(file()), check_text(streams.out, size_of(mesh), report, wording()),
                      missed.empty() ? "" : report_line("", streams.out.red(missed)),
                      report_line("seconds", fmt::format("read {:.3f} + check {:.3f}", read_seconds, check_seconds))));
    }
    return has_faults(report) || !missed.empty() ? ExitCode::Faults : ExitCode::Ok;
  }

 private:
  /// Texts for a mesh of unknown origin.
  static Wording wording() {
    Wording wording;
    wording.no_size = "if tegl made the contour: samples equal the isovalue; 'tegl contour --epsilon' avoids them";
    return wording;
  }

  [[nodiscard]] std::string missed_requirement(const MeshReport& report) const {
    for (const std::string& requirement : required_) {
      if (report.simplices == 0) return fmt::format("empty; --require {} expects simplices", requirement);
      if (requirement == "closed" && report.boundary_simplices > 0)
        return "has a border; --require closed expects none";
      if (requirement == "nondegenerate" && report.degenerate_simplices > 0) {
        return "has simplices of zero size; --require nondegenerate expects none";
      }
    }
    return {};
  }

  std::vector<std::string> required_;
};

}  // namespace

std::unique_ptr<Command> make_check_command(CLI::App& program) { return std::make_unique<CheckCommand>(program); }

}  // namespace tegl::cli
