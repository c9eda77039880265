// SPDX-License-Identifier: BSD-3-Clause
//
// tegl sample: writes samples of an analytic field.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/numbers.hpp"
#include "base/printable.hpp"
#include "base/progress.hpp"
#include "commands/image_makers.hpp"
#include "output/image_result.hpp"
#include "tegl/field.hpp"
#include "tegl/io/image_writer.hpp"

namespace tegl::cli {

namespace {

/// The fields, their dimensions and parameters.
std::string field_help() {
  std::string text =
      "Examples:\n"
      "  tegl sample gyroid --size 64 -o gyroid.nrrd\n"
      "  tegl sample merging --dim 4 --size 32 -o merging.nrrd\n"
      "  tegl sample metaballs --size 128 --set count=50 --seed 7 -o balls.nrrd\n"
      "  tegl sample orbital --size 80 --set n=3 --set l=2 -o orbital.nrrd\n"
      "  tegl sample torus --lattice bcc --size 40 -o torus.nrrd   (then: tegl contour torus.nrrd --iso "
      "0 ...)\n"
      "  tegl sample 'max(ball(x-0.3, y, z, 0.5), box(x, 0.3, y, 0.2, z, 0.6))' --size 64 -o shape.nrrd\n"
      "Fields, with their dimensions and parameters (--set):\n";
  for (const FieldInfo& field : fields()) {
    text += fmt::format("  {} ({} to {}D): {}\n", field.name, field.least_dim, field.most_dim, field.meaning);
    for (const FieldParameter& one : field.parameters)
      text += fmt::format("      {} = {}: {}\n", one.name, number(one.value), one.meaning);
  }
  return text +
         "FIELD may also be an expression of x, y, z, t, u and r (the distance from the origin): + - * / ^,\n"
         "comparisons, ?:, sin, exp, sqrt, abs, min, max, _pi, and ball(x, y, z, radius), box(x, a, y, b, z, c),\n"
         "torus(x, y, z, ring, tube). Contours are at 0, except those of orbitals.";
}

class SampleCommand final : public Command {
 public:
  explicit SampleCommand(CLI::App& program)
      : Command(program, "sample", "Write samples of an analytic field: metaballs, gyroid, orbitals, an expression",
                "no file") {
    app().remove_option(app().get_option("FILE"));
    app().add_option("FIELD", field_, "name of a field, or an expression")->required();
    app().add_option("-o,--output", output_, std::string("the samples: ") + kImageFiles)->type_name("FILE")->required();
    dim_option_ = app()
                      .add_option("--dim", dim_, "number of axes, 2 to 5; default: as --lattice needs, else 3")
                      ->check(whole_number(2, 5))
                      ->type_name("COUNT");
    app()
        .add_option("--size", size_, "number of samples along each axis: one number, or one for each, as in 64,64,20")
        ->type_name("COUNTS")
        ->capture_default_str();
    app()
        .add_option("--range", range_, "coordinates of the first and the last sample along each axis")
        ->type_name("FIRST:LAST")
        ->capture_default_str();
    app()
        .add_option(
            "--lattice", lattice_,
            "lattice of the samples; with one number of --size, its last axis gets the regular step and as many "
            "layers as the range needs")
        ->check(CLI::IsMember({"cubic", "triangular", "fcc", "bcc", "d4", "fcc_in_time"}))
        ->capture_default_str();
    app()
        .add_option("--set", parameters_, "a parameter of the field; may be given again")
        ->allow_extra_args(false)
        ->type_name("NAME=NUMBER");
    app()
        .add_option("--seed", seed_, "of the places of metaballs, and of noise; not for other fields")
        ->check(whole_number(0, std::uint64_t{1} << 62))
        ->type_name("NUMBER")
        ->capture_default_str();
    add_threads_option(app(), threads_);
    add_quiet();
    app().footer(field_help());
  }

  ExitCode run(const Streams& streams) override {
    // validate options and files
    const std::optional<Lattice> lattice = parse_lattice(lattice_);
    const int dim = dim_option_->count() > 0 ? dim_ : lattice ? dimension(*lattice) : 3;
    if (lattice && dimension(*lattice) != dim)
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("--lattice {} with --dim {}; expected {}", lattice_, dim, dimension(*lattice)));
    const Field field = field_in(dim);
    require_image_output(output_, {});
    // sample, write, report
    ProgressBar bar(streams.err, wants_progress());
    ImageResult result;
    result.heading = fmt::format("Samples of {}", field_);
    result.what = field_;
    result.output = output_;
    result.more["lattice"] = lattice_;
    if (dim == 2) write<2>(field, lattice, bar, result);
    if (dim == 3) write<3>(field, lattice, bar, result);
    if (dim == 4) write<4>(field, lattice, bar, result);
    if (dim == 5) write<5>(field, lattice, bar, result);
    bar.clear();
    result.report(streams.out, json(), quiet());
    if (lattice && !quiet() && !records_lattice(output_))
      streams.err.write(fmt::format("tegl: {} does not record the lattice; contour it with --lattice {}\n",
                                    printable(output_), lattice_));
    return ExitCode::Ok;
  }

 private:
  [[nodiscard]] Field field_in(int dim) const {
    std::vector<std::pair<std::string, double>> parameters;
    for (const std::string& text : parameters_) {
      const std::size_t equals = text.find('=');
      if (equals == std::string::npos || equals == 0)
        throw Error(ErrorCode::InvalidArgument, fmt::format("--set is '{}'; expected NAME=NUMBER", text));
      const std::string name = text.substr(0, equals);
      parameters.emplace_back(name, parse_finite("--set " + name, std::string_view(text).substr(equals + 1)));
    }
    const bool is_name =
        std::all_of(field_.begin(), field_.end(), [](char c) { return (c >= 'a' && c <= 'z') || c == '_'; });
    if (is_name && field_.size() > 1) {
      for (const FieldInfo& known : fields())
        if (known.name == field_ && !known.has_seed && app().count("--seed") > 0)
          throw Error(
              ErrorCode::InvalidArgument,
              fmt::format("--seed with {}, which has no random numbers; expected it with metaballs or noise", field_));
      return make_field(field_, dim, parameters, seed_);
    }
    if (app().count("--seed") > 0)
      throw Error(ErrorCode::InvalidArgument, "--seed with an expression; expected it with metaballs or noise");
    if (!parameters.empty())
      throw Error(ErrorCode::InvalidArgument, "--set with an expression; expected it with the name of a field");
    return make_expression(field_, dim);
  }

  template <int N>
  [[nodiscard]] Grid<N> grid_of(const std::optional<Lattice>& lattice) const {
    const std::vector<std::string_view> ends = split(range_, ':');
    if (ends.size() != 2)
      throw Error(ErrorCode::InvalidArgument, fmt::format("--range is '{}'; expected FIRST:LAST", range_));
    const double first = parse_finite("--range", ends[0]), last = parse_finite("--range", ends[1]);
    if (!(first < last))
      throw Error(ErrorCode::InvalidArgument, fmt::format("--range is '{}'; expected FIRST less than LAST", range_));
    if (!std::isfinite(last - first))
      throw Error(ErrorCode::InvalidArgument, fmt::format("--range is '{}'; expected ends of finite distance", range_));
    std::vector<double> sizes;
    for (const std::string_view part : split(size_, ',')) {
      sizes.push_back(parse_finite("--size", part));
      if (sizes.back() < 2 || sizes.back() != std::floor(sizes.back()) || sizes.back() > 1e6)
        throw Error(ErrorCode::InvalidArgument,
                    fmt::format("--size has {}; expected whole numbers from 2 to 1000000", part));
    }
    if (sizes.size() != 1 && sizes.size() != N)
      throw Error(ErrorCode::InvalidArgument, fmt::format("--size has {}; expected one, or one for each of {} axes",
                                                          counted(sizes.size(), "number", "numbers"), N));
    Grid<N> grid;
    constexpr std::array<const char*, 5> kNames = {"x", "y", "z", "t", "u"};
    for (std::size_t a = 0; a < N; ++a) {
      const double size = sizes.size() == 1 ? sizes[0] : sizes[a];
      grid.axes[a] = Axis::uniform(static_cast<std::size_t>(size), first, (last - first) / (size - 1));
      grid.axes[a].name = kNames.at(a);
    }
    if (!lattice || sizes.size() != 1) return grid;
    const std::size_t across = *lattice == Lattice::fcc_in_time ? N - 2 : N - 1;
    const double step = grid.axes[0].step() * layer_step(*lattice);
    const std::string name = grid.axes[across].name;
    grid.axes[across] =
        Axis::uniform(static_cast<std::size_t>(std::floor((last - first) / step + 1e-9)) + 1, first, step);
    grid.axes[across].name = name;
    return grid;
  }

  template <int N>
  void write(const Field& field, const std::optional<Lattice>& lattice, ProgressBar& bar, ImageResult& result) const {
    const Grid<N> grid = grid_of<N>(lattice);
    try {
      FieldLayers<N> layers(field, grid, lattice, threads_);
      ImageInfo info;
      info.lattice = lattice;
      stream_image_result(layers, info, bar, result);
    } catch (const std::bad_alloc&) {
      throw Error(ErrorCode::TooLarge,
                  fmt::format("out of memory for a layer of an image of {} samples; expected a smaller --size",
                              fmt::join(grid.sizes(), " x ")));
    }
  }

  std::string field_, output_;
  std::string size_ = "64";
  std::string range_ = "-1:1";
  std::string lattice_ = "cubic";
  std::vector<std::string> parameters_;
  std::uint64_t seed_ = 0;
  int dim_ = 3;
  CLI::Option* dim_option_ = nullptr;
  unsigned threads_ = 0;
};

}  // namespace

std::unique_ptr<Command> make_sample_command(CLI::App& program) { return std::make_unique<SampleCommand>(program); }

}  // namespace tegl::cli
