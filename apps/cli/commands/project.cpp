// SPDX-License-Identifier: BSD-3-Clause
//
// tegl project: projects a 4D contour to 3-space, coloured by time.
#include "tegl/project.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "base/empty_result.hpp"
#include "base/numbers.hpp"
#include "input/attributes.hpp"
#include "input/commands.hpp"
#include "input/contour_input.hpp"
#include "input/cuts.hpp"
#include "input/mesh_input.hpp"
#include "output/output.hpp"
#include "tegl/eigen.hpp"
#include "tegl/slice.hpp"

namespace tegl::cli {

namespace {

constexpr const char* kProjectExamples =
    "Examples:\n"
    "  tegl project heart.nii.gz --iso 400 --close -o swept.glb          (the space that the wall sweeps, by time)\n"
    "  tegl project fingers.vtkhdf --as cuts --count 6 -o positions.ply  (six positions in one file)\n"
    "  tegl project fingers.vtkhdf --as tetrahedra -o all.vtkhdf         (everything; slice or clip it in ParaView)\n"
    "  tegl project fingers.vtkhdf --along 1,0,0,0 -o along_x.vtkhdf     (an outline in y, z and t)\n"
    "The attribute t (or the axis's name) is the time; color shows it from dark blue (first) to yellow (last). The\n"
    "outline of a contour that is not closed (--close) is open at the first and the last time.";

/// Colours of increasing lightness: viridis, by S. van der Walt and N. Smith, 2015, at eighths.
constexpr std::array<std::array<double, 3>, 9> kColors = {{{68, 1, 84},
                                                           {71, 45, 123},
                                                           {59, 82, 139},
                                                           {44, 114, 142},
                                                           {33, 145, 140},
                                                           {40, 174, 128},
                                                           {94, 201, 98},
                                                           {173, 220, 48},
                                                           {253, 231, 37}}};

/// Maps values from minimum to maximum to colours, as multiples of 1/255.
Attribute colors_of(const Attribute& values) {
  Attribute result{"color", "", 3, {}};
  if (values.values.empty()) return result;
  const auto [least, most] = std::minmax_element(values.values.begin(), values.values.end());
  const double range = *most - *least;
  for (const double value : values.values) {
    const double at = range > 0.0 ? (value - *least) / range * static_cast<double>(kColors.size() - 1) : 0.0;
    const auto below = std::min(static_cast<std::size_t>(at), kColors.size() - 2);
    const double share = at - static_cast<double>(below);
    for (std::size_t c = 0; c < 3; ++c)
      result.values.push_back(std::round(kColors[below][c] + share * (kColors[below + 1][c] - kColors[below][c])) /
                              255.0);
  }
  return result;
}

void add_colors(Mesh& mesh, const std::string& by) {
  const auto found = std::find_if(mesh.vertex_attributes.begin(), mesh.vertex_attributes.end(),
                                  [&](const Attribute& attribute) { return attribute.name == by; });
  std::erase_if(mesh.vertex_attributes, [](const Attribute& attribute) { return attribute.name == "color"; });
  if (found != mesh.vertex_attributes.end()) mesh.vertex_attributes.push_back(colors_of(*found));
}

Mesh to_mesh(ProjectedContour<double> projected) {
  Mesh mesh;
  mesh.dim = 3;
  mesh.space_dim = 3;
  mesh.coordinates = std::move(projected.vertices);
  mesh.simplices = std::move(projected.tetrahedra);
  mesh.axis_names.assign(projected.axis_names.begin(), projected.axis_names.end());
  mesh.axis_units.assign(projected.axis_units.begin(), projected.axis_units.end());
  mesh.vertex_attributes = std::move(projected.vertex_attributes);
  mesh.simplex_attributes = std::move(projected.simplex_attributes);
  return mesh;
}

/// Appends a mesh with the same attributes.
void append(Mesh& to, const Mesh& more) {
  const auto first = static_cast<Index>(to.coordinates.size() / 3);
  const auto put = [](auto& rows, const auto& others) { rows.insert(rows.end(), others.begin(), others.end()); };
  put(to.coordinates, more.coordinates);
  put(to.normals, more.normals);
  for (const Index v : more.simplices) to.simplices.push_back(first + v);
  for (std::size_t i = 0; i < to.vertex_attributes.size(); ++i)
    put(to.vertex_attributes[i].values, more.vertex_attributes[i].values);
  for (std::size_t i = 0; i < to.simplex_attributes.size(); ++i)
    put(to.simplex_attributes[i].values, more.simplex_attributes[i].values);
}

class ProjectCommand final : public ContourInputCommand {
 public:
  explicit ProjectCommand(CLI::App& program)
      : ContourInputCommand(program, "project",
                            "Project a 4D contour into space, coloured by time: the region that it sweeps") {
    app()
        .add_option("--as", kind_,
                    "kind of result: the outline of the projection, slices in one file, or all tetrahedra")
        ->check(CLI::IsMember({"outline", "cuts", "tetrahedra"}))
        ->capture_default_str();
    app()
        .add_option("--along", along_, "direction of the projection, such as 1,0,0,0; default: along the time")
        ->type_name("A,B,C,D");
    app()
        .add_option("--eye", eye_, "perspective: distance of the eye before the first time; 0: parallel projection")
        ->type_name("NUMBER");
    app()
        .add_option("--count", count_, "number of slices with --as cuts")
        ->check(whole_number(1, 100000))
        ->type_name("COUNT")
        ->capture_default_str();
    app()
        .add_option("-o,--output", output_, std::string("the result: ") + kContourFiles)
        ->type_name("FILE")
        ->required();
    app().add_flag("--no-check", no_check_, "skip the check of the result");
    compress_.add_to(app());
    attributes_.add_to(app());
    interpolate_arrays_of(&attributes_);
    app().footer(kProjectExamples);
  }

  ExitCode run(const Streams& streams) override {
    // validate options and files
    const Projection projection = projection_from_options();
    require_inputs();
    require_output(output_, files());
    compress_.require_known(output_);
    require_output_holds(output_, kind_ == "tetrahedra" ? 3 : 2);
    require_output_keeps(output_, normals(), attributes_.wanted());
    also_read(attributes_.files());
    attributes_.require_inputs();
    // read and project
    ProgressBar bar(streams.err, wants_progress());
    ContourInput input = read_contour(bar);
    auto* const contour = std::get_if<Contour<4, double>>(&input.contour);
    if (contour == nullptr)
      throw Error(ErrorCode::UnsupportedData,
                  fmt::format("{} has a contour in {}D; expected a 4D one", file(), input.space_dim()));
    ContourResult result = input.to_result();
    result.output = output_;
    result.compression = compress_.compression();
    result.wording = wording();
    attributes_.sample_to(*contour, image_options(), threads(), bar,
                          {{}, nullptr, false, are_cell_meshes(files(), images())});
    remark(unroll_input(input));  // after the images are sampled, which is across periods
    Stopwatch watch;
    result.mesh = projected(*contour, projection, bar);
    result.seconds.slice = watch.lap();
    if (result.mesh.simplices.empty() && !contour->simplices.empty())
      throw EmptyResult(
          "the projection along this direction has no outline: the contour does not move along it; expected a "
          "moving contour, another direction or --as cuts");
    // check, write, report
    if (!no_check_ && kind_ != "tetrahedra") check_result(result, threads(), bar);
    write_result(result, bar);
    remark(result.lost.remark(output_));
    bar.clear();
    if (json())
      streams.out.write(dump(to_json(result)));
    else if (!quiet())
      streams.out.write(to_text(streams.out, result));
    return result.exit_code();
  }

 private:
  [[nodiscard]] Wording wording() const {
    Wording wording;
    const std::string along = along_.empty() ? "time" : along_;
    wording.heading = kind_ == "outline" ? fmt::format("Outline of a contour in 4D along {}", along)
                      : kind_ == "cuts"  ? fmt::format("{} slices of a contour in 4D along {}", count_, along)
                                         : fmt::format("Tetrahedra of a contour in 4D, seen along {}", along);
    wording.unchecked = no_check_ ? "skipped" : "skipped: projected tetrahedra overlap and are not a manifold";
    if (kind_ == "outline") {
      wording.no_size = "the contour is perpendicular to the direction, as at the first and last time if it is closed";
      wording.open = "the contour itself is open there; --close closes the contour of an image";
    }
    return wording;
  }

  [[nodiscard]] Projection projection_from_options() const {
    Projection projection;
    if (kind_ != "cuts" && app().count("--count") > 0)
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("--count {} with --as {}; expected it with --as cuts", count_, kind_));
    if (!along_.empty()) {
      const std::vector<double> direction = parse_normal("--along", along_);
      if (direction.size() != 4)
        throw Error(ErrorCode::InvalidArgument,
                    fmt::format("--along {} has {} numbers; expected 4", along_, direction.size()));
      std::copy(direction.begin(), direction.end(), projection.direction.begin());
    }
    if (!eye_.empty()) projection.eye_distance = parse_finite("--eye", eye_);
    if (projection.eye_distance < 0.0)
      throw Error(ErrorCode::InvalidArgument, fmt::format("--eye {}; expected 0 or more", eye_));
    if (projection.eye_distance > 0.0 && kind_ == "cuts")
      throw Error(ErrorCode::InvalidArgument, "--eye is not for --as cuts, which have no perspective");
    return projection;
  }

  Mesh projected(const Contour<4, double>& contour, const Projection& projection, ProgressBar& bar) const {
    const Progress progress = bar.stage("project");
    Mesh mesh = kind_ == "outline"      ? tegl::to_mesh(outline(contour, projection, {threads(), progress}))
                : kind_ == "tetrahedra" ? to_mesh(project(contour, projection, {threads(), progress}))
                                        : cuts(contour, projection, progress);
    const std::string by = mesh.vertex_attributes.back().name;
    add_colors(mesh, by);
    return mesh;
  }

  /// Evenly spaced cuts; the first and the last are half a step from the ends.
  [[nodiscard]] Mesh cuts(const Contour<4, double>& contour, const Projection& projection,
                          const Progress& progress) const {
    const Attribute heights = project(contour, projection).vertex_attributes.back();
    if (heights.values.empty()) return tegl::to_mesh(outline(contour, projection, {threads(), progress}));
    const auto [least, most] = std::minmax_element(heights.values.begin(), heights.values.end());
    const Eigen::Vector4d direction = as_eigen(projection.direction);
    std::vector<Hyperplane<4>> hyperplanes;
    for (int i = 0; i < count_; ++i) {
      const double height = *least + (i + 0.5) / count_ * (*most - *least);
      hyperplanes.push_back({projection.direction, height * direction.norm()});
    }
    const auto stack = slice_stack(contour, hyperplanes, {threads(), progress});
    Mesh mesh;
    for (std::size_t i = 0; i < stack.size(); ++i) {
      Mesh cut = tegl::to_mesh(stack[i]);
      Attribute when{heights.name, heights.unit, 1, {}};
      when.values.assign(stack[i].vertices.size(), hyperplanes[i].offset / direction.norm());
      std::erase_if(cut.vertex_attributes, [&](const Attribute& attribute) { return attribute.name == when.name; });
      cut.vertex_attributes.push_back(std::move(when));
      if (i == 0)
        mesh = std::move(cut);
      else
        append(mesh, cut);
    }
    return mesh;
  }

  AttributeOptions attributes_;
  std::string kind_ = "outline";
  std::string along_, eye_, output_;
  int count_ = 8;
  bool no_check_ = false;
  CompressOption compress_;
};

}  // namespace

std::unique_ptr<Command> make_project_command(CLI::App& program) { return std::make_unique<ProjectCommand>(program); }

}  // namespace tegl::cli
