// SPDX-License-Identifier: BSD-3-Clause
//
// tegl contour: extracts the contour of an image, in the dimension of the file.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/numbers.hpp"
#include "base/progress.hpp"
#include "commands/append_mesh.hpp"
#include "commands/facets.hpp"
#include "commands/over_scales.hpp"
#include "commands/picked_place.hpp"
#include "commands/streaming.hpp"
#include "input/attributes.hpp"
#include "input/commands.hpp"
#include "input/contour_input.hpp"
#include "input/curved_images.hpp"
#include "input/extraction.hpp"
#include "input/lattice_attributes.hpp"
#include "input/merging.hpp"
#include "input/mesh_input.hpp"
#include "input/point_arrays.hpp"
#include "input/positions.hpp"
#include "output/output.hpp"
#include "output/result.hpp"
#include "tegl/io/active_tiles.hpp"
#include "tegl/pick.hpp"

namespace tegl::cli {

namespace {

constexpr const char* kContourExamples =
    "Examples:\n"
    "  tegl contour head.nii.gz --iso 60 -o head.ply\n"
    "  tegl contour terrain.nrrd --iso 600 -o lines.glb --json\n"
    "  tegl contour head.nii.gz --iso 60 --pick 12.5,-40,8 -o bone.ply\n"
    "  tegl contour ocean.nc --var TEMP --iso 20 --close -o warm_water.vtkhdf\n"
    "  tegl contour ocean.nc --iso 15,20,25 -o 'warm_{iso}.vtkhdf'       (a file each; --one-file: all in one)\n"
    "  tegl contour frame_*.nrrd --sort name --time-step 0.5 --iso 60 -o film.vtkhdf\n"
    "  tegl contour scans/ --series 2 --iso 300 -o skull.ply             (a folder of DICOM files)\n"
    "  tegl contour head.nii.gz --index head.nii.gz.tindex --iso 60 -o head.ply\n"
    "  tegl contour head.nii.gz --iso 60 --triangulation halving-chord -o head.ply\n"
    "  tegl contour ocean.nc --var TEMP --iso 20 --facets -o polyhedra.vtu\n"
    "  tegl contour cavity.pvd --var p --iso 0 -o p.vtkhdf               (a mesh over time)\n"
    "  tegl contour flow.raw --raw 512x512x512x1000 --raw-type float --iso 0.1 -o flow.vtkhdf\n"
    "A file of 2 to 5 dimensions gives segments, triangles, tetrahedra or 4-simplices: 'tegl slice' cuts the last two.";

class ContourCommand final : public Command {
 public:
  explicit ContourCommand(CLI::App& program)
      : Command(
            program, "contour", "Extract the contour (isolines, isosurface) of an image in 2D to 5D",
            "the image: NIfTI, NRRD, MetaImage, NumPy (.npy, .npz), netCDF (.nc, also gzipped), VTK (.vti, .vtr, .pvd) "
            "or DICOM (a folder); or a mesh (.vtu, .vts, .pvd) or a table of points (.csv); several files form one "
            "image or mesh with one more axis",
            Files::image) {
    options_.add_to(app(), true);
    options_.add_tiling_to(
        app(), {"--index", "--pick", "--merge", "--merge-within", "--one-file", "--positions", "--scale-space"});
    app().add_flag("--unroll", unroll_,
                   "with --periodic, .vtkhdf: double the vertices on the seam, for pictures; other formats always do");
    app()
        .add_option("-o,--output", output_,
                    std::string("the result: ") + kContourFiles +
                        "; with --facets .vtu or, in 2D and 3D, .vtkhdf; with several isovalues, {iso} in the name is "
                        "replaced by the isovalue and {n} by its position")
        ->type_name("FILE")
        ->required();
    app().add_flag("--one-file", one_file_,
                   "several isovalues: all contours in one file, with the isovalue as an attribute");
    app().add_flag("--facets", facets_, "the contour without triangulation: segments, polygons or polyhedra");
    app().add_flag("--no-check", no_check_, "skip the check of the result");
    app()
        .add_option("--index", index_, "an index of the image's active tiles, written by 'tegl index'")
        ->type_name("FILE");
    app()
        .add_option("--pick", pick_,
                    "only the component nearest to the point x,y,z (x,y in 2D, x,y,z,t in 4D), in the units of the "
                    "image's axes")
        ->type_name("X,Y,Z[,T]");
    positions_.add_to(app());
    merging_.add_to(app());
    scales_.add_to(app());
    attributes_.add_to(app());
    compress_.add_to(app());
    app().add_flag("--stream", stream_,
                   "read and write layer by layer, with little memory: one FILE of any format, --raw, or "
                   "several FILEs, "
                   "to .vtkhdf");
    add_image_options();
    add_quiet();
    app().footer(kContourExamples);
  }

  ExitCode run(const Streams& streams) override {
    // validate options and files
    const std::vector<SpelledNumber> isovalues = positions_.isovalues(options_);
    if (!index_.empty() && facets_)
      throw Error(ErrorCode::InvalidArgument, "--facets with --index; expected one of the two");
    const std::vector<double> point = picked_point();
    ExtractOptions options = options_.library_options((!is_streamed() && index_.empty() && point.empty()) || facets_);
    require_tiling_options();
    require_positions();
    require_merging();
    require_scale_space();
    require_inputs();
    require_one_file_of_several(isovalues.size());
    const std::vector<std::string> outputs =
        one_file_ ? std::vector(isovalues.size(), output_) : isovalue_outputs(output_, isovalues);
    if (!one_file_) require_different_outputs(outputs);
    if (are_cell_meshes(files(), images())) refuse_options_of_images(file(), options_, images(), given_for_images());
    if (facets_) return run_facets(streams, isovalues, outputs, options);
    require_files(outputs);
    // extract and write
    ProgressBar bar(streams.err, wants_progress());
    std::vector<ContourResult> results = planned_results(isovalues, outputs, point);
    if (are_cell_meshes(files(), images()))
      contour_mesh(options, bar, results);
    else if (is_streamed())
      stream(options, bar, results);
    else
      contour(options, bar, results);
    bar.clear();
    for (const ContourResult& result : results) remark(result.lost.remark(result.output));
    return tell(streams, results);
  }

 private:
  [[nodiscard]] bool knows_lattices() const override { return true; }
  /// Checks the names of outputs and the other inputs.
  void require_files(const std::vector<std::string>& outputs) {
    for (const std::string& output : outputs) {
      if (!is_named_by_image()) require_output(output, files());
      require_output_keeps(output, options_.normals(), attributes_.wanted() || one_file_);
      compress_.require_known(output);
    }
    if (!index_.empty()) {
      also_read({index_});
      require_input(index_);
      if (is_streamed())
        throw Error(ErrorCode::InvalidArgument,
                    "--index with --stream; expected one of the two: an index needs the image in memory");
    }
    if (!positions_.file().empty()) also_read({parse_file_and_variable(positions_.file()).file});
    also_read(attributes_.files());
    attributes_.require_inputs();
  }

  [[nodiscard]] std::vector<ContourResult> planned_results(const std::vector<SpelledNumber>& isovalues,
                                                           const std::vector<std::string>& outputs,
                                                           const std::vector<double>& point) const {
    std::vector<ContourResult> results(isovalues.size());
    for (std::size_t i = 0; i < results.size(); ++i) {
      if (!point.empty()) results[i].picked = Picked{point, {}, 0, 0, 0};
      results[i].output = outputs[i];
      results[i].isovalue = isovalues[i].value;
      results[i].compression = compress_.compression();
    }
    return results;
  }

  /// Whether the output's name has an isovalue that is found in the image.
  [[nodiscard]] bool is_named_by_image() const {
    return positions_.finds_isovalue(options_) && output_.find("{iso}") != std::string::npos;
  }

  void name_by_isovalue(ContourResult& result) const {
    result.output = isovalue_outputs(output_, {{*result.isovalue, number(*result.isovalue)}}).front();
    require_output(result.output, files());
  }

  /// Calls refuse(with) for the options that know only cubic cells between samples.
  template <class Refuse>
  void for_plain_cells(const Refuse& refuse) const {
    if (is_streamed()) refuse(stream_ ? "--stream" : "--raw and a .vtkhdf output, which is streamed");
    if (!index_.empty()) refuse("--index");
    if (facets_) refuse(kFacets);
    if (app().count("--pick") > 0) refuse("--pick");
    if (one_file_) refuse("--one-file");
    if (options_.polygon_triangulation()) refuse("a triangulation of polygons");
  }

  /// Refuses options that cells and lattices do not have, if the samples of FILE are cells or on a lattice.
  void refuse_tiling_of_file(const ImageInfo& info) const {
    for_plain_cells([&](const char* with) {
      options_.refuse_cells(info.samples_are_cells, file(), with);
      if (!is_streamed() && with != std::string_view(kFacets)) options_.refuse_lattice(info, file(), with);
    });
    if (facets_ && options_.has_lattice(info)) options_.refuse_periodic_with(kFacetsOnLattice);
    if (attributes_.wanted()) options_.refuse_cells(info.samples_are_cells, file(), "--attribute");
    if (!positions_.are_linear()) options_.refuse_lattice(info, file(), "--positions");
  }

  void require_tiling_options() const {
    if (unroll_ && options_.tiling().periodic.empty())
      throw Error(ErrorCode::InvalidArgument, "--unroll without --periodic; expected both");
    if (unroll_ && (is_streamed() || facets_))
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("--unroll with {}; expected one of the two", facets_ ? "--facets" : "--stream"));
    for_plain_cells([&](const char* with) {
      if (is_streamed() && options_.tiling().lattice) return;
      if (with == std::string_view(kFacets) && options_.tiling().lattice)
        return options_.refuse_periodic_with(kFacetsOnLattice);
      is_streamed() || facets_ ? options_.refuse_other_tiling(with) : options_.refuse_tiling(with);
    });
    if (attributes_.wanted() && options_.tiling().of_cells) options_.refuse_tiling("--attribute");
  }

  /// Whether no option is given that needs straight axes.
  [[nodiscard]] bool knows_curved_grids() const {
    return index_.empty() && !options_.polygon_triangulation() && !scales_.are_given();
  }

  /// Refuses --positions with options of functions that know linear positions only, and checks its own options.
  void require_positions() const {
    if (is_streamed()) positions_.refuse("--stream");
    if (!index_.empty()) positions_.refuse("--index");
    if (facets_) positions_.refuse("--facets");
    if (app().count("--pick") > 0) positions_.refuse("--pick");
    if (options_.polygon_triangulation()) positions_.refuse("a triangulation of polygons");
    const Tiling tiling = options_.tiling();
    if (!tiling.is_plain() && !tiling.of_cells) positions_.refuse("--periodic or --lattice");
    positions_.require();
  }

  /// Refuses --scale-space with options that need the image itself, or layers of a file.
  void require_scale_space() {
    scales_.require();
    scales_.refuse(!index_.empty(), "--index");
    scales_.refuse(facets_, "--facets");
    scales_.refuse(attributes_.wanted(), "--attribute");
    scales_.refuse(!options_.tiling().is_plain() && !options_.tiling().of_cells, "--periodic, --lattice or --division");
  }

  /// Refuses options that 5D contours do not have.
  void require_to_5d() const {
    options_.require_to_5d();
    for (const char* const name : {"--index", "--pick", "--merge", "--merge-within", "--one-file"})
      if (app().get_option_no_throw(name) != nullptr && app().count(name) > 0)
        throw Error(ErrorCode::InvalidArgument, fmt::format("{} with an image of 5 axes; expected 2 to 4 axes", name));
    if (attributes_.wanted())
      throw Error(ErrorCode::InvalidArgument, "--attribute with an image of 5 axes; expected 2 to 4 axes");
  }

  /// Contours an image of 5 axes.
  void contour_5d(const ReadImage5dResult& input, ExtractOptions& options, Stopwatch& watch, ProgressBar& bar,
                  std::vector<ContourResult>& results) {
    require_to_5d();
    const PositionOptions placed = positions_.library_options_5d();
    require_output_holds(results.front().output, 4);
    for (ContourResult& result : results) {
      result.input = inputs();
      result.variable = input.info.variable;
      result.image_dim = 5;
      result.isovalue_of_samples = require_contour(input, *result.isovalue, options_.allows_empty());
    }
    results.front().seconds.read = watch.lap();
    WrittenFiles written;
    for (ContourResult& result : results) {
      options.work.progress = bar.stage("contour");
      const auto finished = [&](auto extraction) {
        result.stats = extraction.stats;
        return to_mesh(std::move(extraction.contour));
      };
      const bool single_precision = options_.single_precision();
      result.mesh = positions_.are_linear() ? extract_and_use<Mesh>(input.image, result.isovalue_of_samples, options,
                                                                    single_precision, finished, options_.tiling())
                                            : extract_placed_and_use<Mesh>(input.image, result.isovalue_of_samples,
                                                                           placed, options, single_precision, finished);
      result.seconds.add(*result.stats);
      check_and_write(result, bar, written);
      leave_the_sizes(result);
    }
    written.keep();
  }

  /// Refuses --merge with options of contours that are not in memory or have no simplices.
  void require_merging() const {
    if (is_streamed()) merging_.refuse("--stream");
    if (facets_) merging_.refuse("--facets");
    if (one_file_) merging_.refuse("--one-file");
    if (!options_.tiling().periodic.empty()) merging_.refuse("--periodic");
    (void)merging_.tolerance();
  }

  void require_one_file_of_several(std::size_t isovalues) const {
    if (!one_file_) return;
    if (isovalues < 2)
      throw Error(ErrorCode::InvalidArgument, "--one-file with one isovalue; expected several, as in --iso 20,25,30");
    if (is_streamed() || facets_)
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("--one-file with {}; expected a file for each isovalue, as in -o 'out_{{iso}}.vtkhdf'",
                              facets_ ? "--facets" : "--stream"));
    for (const char* const place : {"{iso}", "{n}"})
      if (output_.find(place) != std::string::npos)
        throw Error(
            ErrorCode::InvalidArgument,
            fmt::format("--output is '{}' with --one-file; expected a name without {}, for one file", output_, place));
  }

  /// Reports one object for one isovalue, a list for several.
  template <class Result>
  ExitCode tell(const Streams& streams, const std::vector<Result>& results) const {
    ExitCode exit = ExitCode::Ok;
    Json list = Json::array();
    for (const Result& result : results) {
      exit = std::max(exit, result.exit_code());
      if (json())
        list.push_back(to_json(result));
      else if (!quiet())
        streams.out.write(to_text(streams.out, result));
    }
    if (json()) streams.out.write(dump(results.size() == 1 ? list.front() : list));
    return exit;
  }

  void contour(ExtractOptions& options, ProgressBar& bar, std::vector<ContourResult>& results) {
    Stopwatch watch;
    auto any = read_to_5d(bar.stage("read"), knows_curved_grids() ? CurvedGrids::allowed : CurvedGrids::refused,
                          takes_stored_integers(options));
    remark(positions_.apply(any, results, options_.allows_empty()));
    if (is_named_by_image()) name_by_isovalue(results.front());
    if (scales_.are_given()) {
      if (const auto* const image = std::get_if<ReadImageResult>(&any))
        options_.refuse_lattice(image->info, file(), "--scale-space");
      scales_.apply(any, options_.threads(), bar.stage("scale space"));
    }
    if (const auto* const in_5d = std::get_if<ReadImage5dResult>(&any))
      return contour_5d(*in_5d, options, watch, bar, results);
    ReadImageResult input = std::move(std::get<ReadImageResult>(any));
    tiling_ = options_.tiling();
    std::optional<std::uint64_t> folded_cells;
    remark(take_grid(input, file(), options_, tiling_, folded_cells));
    refuse_tiling_of_file(input.info);
    refuse_attributes_on_seams(attributes_, tiling_);
    require_output_holds(results.front().output, image_dim(input.image) - 1);
    for (ContourResult& result : results) {
      result.input = inputs();
      result.variable = input.info.variable;
      result.image_dim = image_dim(input.image);
      result.folded_cells = folded_cells;
      result.isovalue_of_samples = require_contour(input, *result.isovalue, options_.allows_empty());
    }
    attributes_.keep_sizes_of(input.image);
    placed_ = positions_.library_options(input.image, image_options(bar.stage("positions")), position_values_);
    results.front().seconds.read = watch.lap();  // read once for all isovalues
    WrittenFiles written;
    const auto finished = [&](ContourResult& result) {
      if (result.stats) result.seconds.add(*result.stats);
      const std::size_t left = result.mesh.simplices.size();
      if (result.merging)
        remark(MergeArguments::require_left(*result.merging, left, true));
      else if (left == 0)
        remark(remark_without_contour(input.image, *result.isovalue, result.isovalue_of_samples));
      if (one_file_) return;
      if (&result == &results.back()) input.image = AnyImage();  // frees the image's memory for the check
      check_and_write(result, bar, written);
    };
    if (index_.empty()) {
      for (ContourResult& result : results) {
        make(input.image, options, bar, result);
        finished(result);
        if (!one_file_) leave_the_sizes(result);
      }
    } else {
      by_index(input.image, options, bar, results, finished);
    }
    if (one_file_) results = {merged(results, bar, written)};
    written.keep();
  }

  /// Options of this command that need an image.
  [[nodiscard]] std::vector<std::string> given_for_images() const {
    std::vector<std::string> given = {"--stream",    "--index",           "--pick",
                                      "--positions", "--positions-image", "--last-axis-weight",
                                      "--label",     "--scale-space",     "--factors"};
    std::erase_if(given, [&](const std::string& name) { return app().count(name) == 0; });
    return given;
  }

  void contour_mesh(ExtractOptions& options, ProgressBar& bar, std::vector<ContourResult>& results) {
    Stopwatch watch;
    const MeshInput input = read_mesh_input(files(), images(), bar.stage("read"), results.size() > 1);
    remark(input.mesh.remarks);
    const auto arrays = read_point_arrays(attributes_, input.mesh, files(), images(), bar);
    take_order(input.mesh.files);
    require_output_holds(results.front().output, input.space_dim() - 1);
    for (ContourResult& result : results) {
      result.input = inputs();
      result.variable = input.mesh.variable;
      result.image_dim = input.space_dim();
      result.wording.no_size = kNoSizeInMeshes;
      require_mesh_contour(input.mesh, *result.isovalue, options_.allows_empty());
    }
    results.front().seconds.read = watch.lap();
    WrittenFiles written;
    for (ContourResult& result : results) {
      options.work.progress = bar.stage("contour");
      result.mesh = extract_mesh_and_use<Mesh>(
          input, *result.isovalue, options, options_.single_precision(), [&](auto extraction) {
            result.stats = extraction.stats;
            add_point_arrays(extraction.contour, input, *result.isovalue, options, arrays);
            return with_additions(std::move(extraction.contour), options.work.threads, bar, result);
          });
      result.seconds.add(*result.stats);
      if (one_file_) continue;
      check_and_write(result, bar, written);
      leave_the_sizes(result);
    }
    if (one_file_) results = {merged(results, bar, written)};
    written.keep();
  }

  void check_and_write(ContourResult& result, ProgressBar& bar, WrittenFiles& written) const {
    if (!no_check_) check_result(result, options_.threads(), bar);
    write_result(result, bar, written);
  }

  /// Replaces a written mesh by its size, for the report, to free memory.
  static void leave_the_sizes(ContourResult& result) {
    result.streamed = result.size();
    result.mesh = Mesh();
  }

  /// Whether the samples may be stored integers: for contours that depend on the samples' sides and, along edges, on
  /// their differences only. Other rules compare sums, and files beside the image have its values.
  [[nodiscard]] bool takes_stored_integers(const ExtractOptions& options) const {
    return index_.empty() && !scales_.are_given() && positions_.are_linear() && !positions_.has_label() &&
           options_.tiling().is_plain() && !options_.polygon_triangulation() &&
           (options.ambiguity == Ambiguity::low || options.ambiguity == Ambiguity::high);
  }

  /// Extracts the contour of one isovalue, without an index.
  void make(const AnyImage& image, ExtractOptions& options, ProgressBar& bar, ContourResult& result) const {
    options.work.progress = bar.stage("contour");
    if (!tiling_.curved.empty()) return make_curved(image, options, bar, result);
    if (tiling_.of_cells) result.wording.no_size = "cells touch; --merge drops most of them";
    if (placed_.rule == Positions::filtered) result.wording.no_size = PositionArguments::kNoSize;
    if (result.picked) return pick(image, options, bar, result);
    const auto finished = [&](auto extraction) {
      result.stats = extraction.stats;
      if (tiling_.lattice)
        sample_on_lattice(attributes_, extraction.contour, image, tiling_, result.isovalue_of_samples, options,
                          image_options(), bar);
      return with_additions(std::move(extraction.contour), options.work.threads, bar, result);
    };
    const bool single_precision = options_.single_precision();
    if (const auto method = options_.polygon_triangulation())
      result.mesh = std::visit(finished, triangulated_polygons(image,
                                                               {result.isovalue_of_samples, options, single_precision,
                                                                no_check_, compress_.compression()},
                                                               *method, bar));
    else if (!positions_.are_linear())
      result.mesh = extract_placed_and_use<Mesh>(image, result.isovalue_of_samples, placed_, options, single_precision,
                                                 tiling_, finished);
    else
      result.mesh =
          extract_and_use<Mesh>(image, result.isovalue_of_samples, options, single_precision, finished, tiling_);
  }

  /// As `make`, for an image on a curved grid: makes the contour on the indices and moves it.
  void make_curved(const AnyImage& image, const ExtractOptions& options, ProgressBar& bar,
                   ContourResult& result) const {
    const auto of_owned = [&]<Value T, int N>(const OwnedImage<T, N>& owned) {
      const Image<T, N> indexed = on_indices(owned, tiling_.curved);
      const auto seams = seams_of(owned.grid, tiling_.curved, tiling_.periodic);
      const auto move = [&]<class Real>(Contour<N, Real> contour) {
        const Contour<N, Real> in_indices = attributes_.wanted() ? contour : Contour<N, Real>();
        auto moved = on_curved_grid<Real>(std::move(contour), owned.grid, tiling_.curved,
                                          {options.work.threads, bar.stage("move")}, seams);
        attributes_.sample_to(moved, image_options(), options.work.threads, bar, {tiling_.curved, &in_indices, false});
        result.mesh = with_additions(std::move(moved), options.work.threads, bar, result);
      };
      const auto make = [&]<class Real>(Real) {
        if (result.picked) {
          auto found = extract_component<Real>(
              indexed, *result.isovalue,
              nearest_sample<N>(owned.grid, tiling_.curved, picked_place<N>(*result.picked, pick_)), options);
          take_report(found.report, *result.picked);
          return move(std::move(found.contour));
        }
        auto extraction =
            !seams.empty()
                ? extract_periodic_with_stats<Real>(indexed, index_periods<N>(owned.grid, tiling_.curved, seams),
                                                    *result.isovalue, options)
            : positions_.are_linear() ? extract_with_stats<Real>(indexed, *result.isovalue, options)
                                      : extract_placed_with_stats<Real>(indexed, *result.isovalue, placed_, options);
        result.stats = extraction.stats;
        move(std::move(extraction.contour));
      };
      options_.single_precision() ? make(float{}) : make(double{});
    };
    std::visit([&](const auto& typed) { std::visit(of_owned, typed); }, image);
  }

  /// The contours as one mesh, checked and written.
  ContourResult merged(std::vector<ContourResult>& results, ProgressBar& bar, WrittenFiles& written) const {
    ContourResult all = in_one_mesh(results);
    check_and_write(all, bar, written);
    return all;
  }

  /// Whether the image is read by layers and the contour written in parts: if requested, and for raw files whenever
  /// possible.
  [[nodiscard]] bool is_streamed() const {
    if (stream_ || !images().raw()) return stream_;
    const auto sizes = app().get_option("--raw")->as<std::string>();
    if (std::count(sizes.begin(), sizes.end(), 'x') >= 4) return false;  // 5D contours are made in memory
    Tiling tiling = options_.tiling();
    if (!unroll_) tiling.periodic.clear();  // periodic axes are streamed
    const bool needs_memory = !tiling.is_plain() || !index_.empty() || facets_ || one_file_ ||
                              app().count("--pick") > 0 || !positions_.are_linear() || merging_.are_given() ||
                              scales_.are_given() || options_.wants_shape_normals() || attributes_.wanted() ||
                              options_.polygon_triangulation();
    return !needs_memory && equal_ignoring_case(std::filesystem::path(output_).extension().string(), ".vtkhdf");
  }

  /// The numbers of --pick; empty without the option.
  [[nodiscard]] std::vector<double> picked_point() const {
    if (app().count("--pick") == 0) return {};
    if (is_streamed() || !index_.empty() || facets_)
      throw Error(ErrorCode::InvalidArgument, "--pick with --index, --facets or --stream; expected it without them");
    return parse_list("--pick", pick_);
  }

  /// Extracts the component nearest to the point of --pick.
  void pick(const AnyImage& image, const ExtractOptions& options, ProgressBar& bar, ContourResult& result) const {
    Stopwatch watch;
    const auto keep = [&](auto found) {
      take_report(found.report, *result.picked);
      result.mesh = with_additions(std::move(found.contour), options.work.threads, bar, result);
    };
    const auto of_owned = [&]<Value T, int N>(const OwnedImage<T, N>& owned) {
      const std::array<double, N> point = picked_place<N>(*result.picked, pick_);
      if (options_.single_precision())
        keep(extract_component<float>(owned.view(), result.isovalue_of_samples, point, options));
      else
        keep(extract_component<double>(owned.view(), result.isovalue_of_samples, point, options));
    };
    std::visit([&](const auto& typed) { std::visit(of_owned, typed); }, image);
    result.seconds.generate += watch.lap();
  }

  /// The mesh of a contour with the normals and attributes of --normals and --attribute; merged (--merge) or unrolled
  /// if it has to be.
  template <class AnyContour>
  Mesh with_additions(AnyContour contour, unsigned threads, ProgressBar& bar, ContourResult& result) const {
    if (merging_.are_given()) {
      result.merging = merging_.merge(contour, {threads, bar.stage("merge")});
      MergeArguments::require_left(*result.merging, contour.simplices.size(), options_.allows_empty());
    }
    options_.add_shape_normals(contour);
    if (tiling_.curved.empty() && !tiling_.lattice)
      attributes_.sample_to(contour, image_options(), threads, bar,
                            {{}, nullptr, images().index_grid(), are_cell_meshes(files(), images())});
    return to_mesh(unrolled_for(std::move(contour), output_, unroll_));
  }

  /// Extracts the contours with --index, which is read once; its time counts as reading.
  template <class Finished>
  void by_index(const AnyImage& image, ExtractOptions& options, ProgressBar& bar, std::vector<ContourResult>& results,
                const Finished& finished) const {
    const WorkOptions reading{options.work.threads, bar.stage("index")};
    const auto keep = [&](ContourResult& result, auto extraction) {
      result.stats = extraction.stats;
      result.mesh = with_additions(std::move(extraction.contour), options.work.threads, bar, result);
    };
    Stopwatch watch;
    const auto of_owned = [&](const auto& owned) {
      const auto view = owned.view();
      const auto active = read_active_tiles(index_, view, reading);
      results.front().seconds.read += watch.lap();
      for (ContourResult& result : results) {
        options.work.progress = bar.stage("contour");
        if (options_.single_precision())
          keep(result, extract_with_stats<float>(view, *result.isovalue, *active, options));
        else
          keep(result, extract_with_stats<double>(view, *result.isovalue, *active, options));
      }
    };
    std::visit([&](const auto& typed) { std::visit(of_owned, typed); }, image);
    for (ContourResult& result : results) finished(result);
  }

  void require_facets_options(const std::vector<std::string>& outputs) const {
    refuse_with_facets(options_, is_streamed(), attributes_.wanted());
    for (const std::string& output : outputs) {
      require_facets_output(output, files());
      compress_.require_known(output, true);
    }
  }

  ExitCode run_facets(const Streams& streams, const std::vector<SpelledNumber>& isovalues,
                      const std::vector<std::string>& outputs, const ExtractOptions& options) {
    require_facets_options(outputs);
    ProgressBar bar(streams.err, wants_progress());
    Stopwatch watch;
    const FacetsWork work = {
        0.0, options, options_.single_precision(), no_check_, compress_.compression(), {}, options_.allows_empty()};
    if (are_cell_meshes(files(), images())) {
      const MeshInput mesh = read_mesh_input(files(), images(), bar.stage("read"), isovalues.size() > 1);
      remark(mesh.mesh.remarks);
      take_order(mesh.mesh.files);
      const auto of_mesh = write_mesh_facets(mesh, inputs(), watch.lap(), isovalues, outputs, work, bar);
      return tell(streams, of_mesh);
    }
    const ReadImageResult input = with_option_to_4d("--facets", [&] { return read(bar.stage("read")); });
    refuse_tiling_of_file(input.info);
    std::vector<FacetsResult> results(isovalues.size());
    for (std::size_t i = 0; i < results.size(); ++i) {
      FacetsResult& result = results[i];
      result.input = inputs();
      result.variable = input.info.variable;
      result.output = outputs[i];
      result.image_dim = image_dim(input.image);
      result.isovalue = isovalues[i].value;
      require_output_holds_facets(result.output, result.image_dim);
      require_contour(input, result.isovalue, options_.allows_empty());
    }
    Tiling tiling = options_.tiling();
    options_.take_lattice(input.info, file(), tiling);
    if (!tiling.lattice) remark(take_longitudes(input.image, options_, tiling));
    results.front().seconds.read = watch.lap();
    WrittenFiles written;
    for (FacetsResult& result : results)
      write_image_facets(input.image,
                         {result.isovalue, options, options_.single_precision(), no_check_, compress_.compression(),
                          tiling.periodic, options_.allows_empty(), tiling.lattice},
                         bar, result, written);
    written.keep();
    bar.clear();
    for (const FacetsResult& result : results)
      if (result.facets[0] == 0) remark(remark_without_contour(input.image, result.isovalue));
    return tell(streams, results);
  }

  /// The layers of FILE, or the layers of its scale space, which need FILE in memory as `image`.
  OpenLayersResult open_or_smooth(ReadImageResult& image, ProgressBar& bar) {
    if (!scales_.are_given()) return open();
    image = read(bar.stage("read"));
    options_.refuse_lattice(image.info, file(), "--scale-space");
    return scales_.layers(image, options_.threads());
  }

  void stream(ExtractOptions& options, ProgressBar& bar, std::vector<ContourResult>& results) {
    require_open_files(results.size());
    for (const ContourResult& result : results) require_output_grows(result.output);
    require_streamed_additions(options_.wants_shape_normals(), attributes_.wanted());
    // open, extract and write in one pass
    ReadImageResult image;  // of a scale space, whose layers are computed from it
    Stopwatch watch;
    OpenLayersResult input = with_option_to_4d("--stream", [&] { return open_or_smooth(image, bar); });
    const double read_seconds = watch.lap();
    refuse_tiling_of_file(input.info);
    for (ContourResult& result : results) {
      result.input = inputs();
      result.variable = input.info.variable;
    }
    Tiling tiling = options_.tiling();
    options_.take_lattice(input.info, file(), tiling);
    remark(take_longitudes(input.layers, options_, tiling));
    options.work.progress = bar.stage("stream");
    const StreamOptions streaming{
        options,       options_.single_precision(), options_.allows_empty(), compress_.compression(), tiling.periodic,
        tiling.lattice};
    for (std::string& text : stream_contours(input, streaming, results)) remark(std::move(text));
    results.front().seconds.read += read_seconds;
    for (ContourResult& result : results) result.output_bytes = std::filesystem::file_size(result.output);
  }

  ExtractionOptions options_;
  MergeArguments merging_;
  ScaleSpaceArguments scales_;
  PositionArguments positions_;
  Tiling tiling_;  ///< with the image's curved grid
  PositionOptions placed_;
  PositionValues position_values_;
  AttributeOptions attributes_;
  CompressOption compress_;
  std::string output_;
  std::string index_;
  bool stream_ = false, one_file_ = false, facets_ = false;
  bool unroll_ = false;
  std::string pick_;
  bool no_check_ = false;
};

}  // namespace

std::unique_ptr<Command> make_contour_command(CLI::App& program) { return std::make_unique<ContourCommand>(program); }

}  // namespace tegl::cli
