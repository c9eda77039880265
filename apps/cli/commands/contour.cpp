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
#include "commands/contour_arguments.hpp"
#include "commands/facets.hpp"
#include "commands/picked_place.hpp"
#include "commands/streaming.hpp"
#include "input/commands.hpp"
#include "input/contour_input.hpp"
#include "input/curved_images.hpp"
#include "input/lattice_attributes.hpp"
#include "input/mesh_input.hpp"
#include "input/point_arrays.hpp"
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
    "A file of 2 to 5 dimensions gives segments, triangles, tetrahedra or 4-simplices.\n"
    "'tegl slice' takes all except segments.";

class ContourCommand final : public Command {
 public:
  explicit ContourCommand(CLI::App& program)
      : Command(
            program, "contour", "Extract the contour (isolines, isosurface) of an image in 2D to 5D",
            "the image: NIfTI, NRRD, MetaImage, NumPy (.npy, .npz), netCDF (.nc, also gzipped), VTK (.vti, .vtr, .pvd) "
            "or DICOM (a folder); or a mesh (.vtu, .vts, .pvd) or a table of points (.csv); several files form one "
            "image or mesh with one more axis",
            Files::image) {
    given_.add_to(app(), images());
    add_image_options();
    add_quiet();
    app().footer(kContourExamples);
  }

  ExitCode run(const Streams& streams) override {
    // validate options and files
    const std::vector<SpelledNumber> isovalues = given_.positions.isovalues(given_.extraction);
    if (!given_.index.empty() && given_.facets)
      throw Error(ErrorCode::InvalidArgument, "--facets with --index; expected one of the two");
    const std::vector<double> point = given_.picked_point();
    ExtractOptions options = given_.extraction.library_options(
        (!given_.is_streamed() && given_.index.empty() && point.empty()) || given_.facets);
    given_.require_tiling();
    given_.require_positions();
    given_.require_merging();
    given_.require_scale_space();
    require_inputs();
    given_.require_one_file_of_several(isovalues.size());
    const std::vector<std::string> outputs =
        given_.one_file ? std::vector(isovalues.size(), given_.output) : isovalue_outputs(given_.output, isovalues);
    if (!given_.one_file) require_different_outputs(outputs);
    if (are_cell_meshes(files(), images()))
      refuse_options_of_images(file(), given_.extraction, images(), given_.for_images());
    if (given_.facets) return run_facets(streams, isovalues, outputs, options);
    require_files(outputs);
    // extract and write
    ProgressBar bar(streams.err, wants_progress());
    std::vector<ContourResult> results = planned_results(isovalues, outputs, point);
    if (are_cell_meshes(files(), images()))
      contour_mesh(options, bar, results);
    else if (given_.is_streamed())
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
      if (!given_.is_named_by_image()) require_output(output, files());
      require_output_keeps(output, given_.extraction.normals(), given_.attributes.wanted() || given_.one_file);
      given_.compress.require_known(output);
    }
    if (!given_.index.empty()) {
      also_read({given_.index});
      require_input(given_.index);
      if (given_.is_streamed())
        throw Error(ErrorCode::InvalidArgument,
                    "--index with --stream; expected one of the two: an index needs the image in memory");
    }
    if (!given_.positions.file().empty()) also_read({parse_file_and_variable(given_.positions.file()).file});
    also_read(given_.attributes.files());
    given_.attributes.require_inputs();
  }

  [[nodiscard]] std::vector<ContourResult> planned_results(const std::vector<SpelledNumber>& isovalues,
                                                           const std::vector<std::string>& outputs,
                                                           const std::vector<double>& point) const {
    std::vector<ContourResult> results(isovalues.size());
    for (std::size_t i = 0; i < results.size(); ++i) {
      if (!point.empty()) results[i].picked = Picked{.point = point};
      results[i].output = outputs[i];
      results[i].isovalue = isovalues[i].value;
      results[i].compression = given_.compress.compression();
    }
    return results;
  }

  void name_by_isovalue(ContourResult& result) const {
    result.output = isovalue_outputs(given_.output, {{*result.isovalue, number(*result.isovalue)}}).front();
    require_output(result.output, files());
  }

  /// Contours an image of 5 axes.
  void contour_5d(const ReadImage5dResult& input, ExtractOptions& options, Stopwatch& watch, ProgressBar& bar,
                  std::vector<ContourResult>& results) {
    given_.require_to_5d();
    const PositionOptions placed = given_.positions.library_options_5d();
    require_output_holds(results.front().output, 4);
    for (ContourResult& result : results) {
      result.input = inputs();
      result.variable = input.info.variable;
      result.image_dim = 5;
      result.isovalue_of_samples =
          require_contour(input, *result.isovalue, given_.extraction.allows_empty(), std::nullopt);
    }
    results.front().seconds.read = watch.lap();
    WrittenFiles written;
    for (ContourResult& result : results) {
      options.work.progress = bar.stage("contour");
      const auto finished = [&](auto extraction) {
        result.stats = extraction.stats;
        return to_mesh(unrolled_for(std::move(extraction.contour), result.output, given_.unroll));
      };
      const bool single_precision = given_.extraction.single_precision();
      result.mesh = given_.positions.are_linear()
                        ? extract_and_use<Mesh>(input.image, result.isovalue_of_samples, options, single_precision,
                                                finished, given_.extraction.tiling())
                        : extract_placed_and_use<Mesh>(input.image, result.isovalue_of_samples, placed, options,
                                                       single_precision, finished);
      result.seconds.add(*result.stats);
      check_and_write(result, bar, written);
      leave_the_sizes(result);
    }
    written.keep();
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
    auto any = read_to_5d(bar.stage("read"), given_.knows_curved_grids() ? CurvedGrids::allowed : CurvedGrids::refused,
                          given_.takes_stored_integers(options));
    remark(given_.positions.apply(any, results, given_.extraction.allows_empty()));
    if (given_.is_named_by_image()) name_by_isovalue(results.front());
    if (given_.scales.are_given()) {
      if (const auto* const image = std::get_if<ReadImageResult>(&any))
        given_.extraction.refuse_lattice(image->info, file(), "--scale-space");
      given_.scales.apply(any, given_.extraction.threads(), bar.stage("scale space"));
    }
    if (const auto* const in_5d = std::get_if<ReadImage5dResult>(&any))
      return contour_5d(*in_5d, options, watch, bar, results);
    ReadImageResult input = std::move(std::get<ReadImageResult>(any));
    tiling_ = given_.extraction.tiling();
    std::optional<std::uint64_t> folded_cells;
    remark(take_grid(input, file(), given_.extraction, tiling_, folded_cells));
    given_.refuse_tiling_of_file(input.info, file());
    refuse_attributes_on_seams(given_.attributes, tiling_);
    require_output_holds(results.front().output, image_dim(input.image) - 1);
    for (ContourResult& result : results) {
      result.input = inputs();
      result.variable = input.info.variable;
      result.image_dim = image_dim(input.image);
      result.folded_cells = folded_cells;
      result.isovalue_of_samples =
          require_contour(input, *result.isovalue, given_.extraction.allows_empty(), tiling_.lattice);
    }
    given_.attributes.keep_sizes_of(input.image);
    placed_ = given_.positions.library_options(input.image, image_options(bar.stage("positions")), position_values_);
    results.front().seconds.read = watch.lap();  // read once for all isovalues
    WrittenFiles written;
    const auto finished = [&](ContourResult& result) {
      if (result.stats) result.seconds.add(*result.stats);
      remark_if_empty(
          result, [&] { return remark_without_contour(input.image, *result.isovalue, result.isovalue_of_samples); });
      if (given_.one_file) return;
      if (!given_.no_check && !tiling_.of_cells && placed_.rule != Positions::filtered)
        result.wording.no_size = reason_of_zero_size(input.image, result.isovalue_of_samples, options.epsilon);
      if (&result == &results.back()) input.image = AnyImage();  // frees the image's memory for the check
      check_and_write(result, bar, written);
    };
    if (given_.index.empty()) {
      for (ContourResult& result : results) {
        make(input.image, options, bar, result);
        finished(result);
        if (!given_.one_file) leave_the_sizes(result);
      }
    } else {
      by_index(input.image, options, bar, results, finished);
    }
    if (given_.one_file) results = {merged(results, bar, written)};
    written.keep();
  }

  /// Adds a remark on an empty contour. `why`: returns the reason if no simplices were extracted.
  template <class Why>
  void remark_if_empty(const ContourResult& result, const Why& why) {
    if (!result.mesh.simplices.empty()) return;
    const bool vanished = result.merging && result.merging->counts.before.simplices > 0;
    remark(vanished ? MergeArguments::require_left(*result.merging, 0, true) : why());
  }

  void contour_mesh(ExtractOptions& options, ProgressBar& bar, std::vector<ContourResult>& results) {
    Stopwatch watch;
    const MeshInput input = read_mesh_input(files(), images(), bar.stage("read"), results.size() > 1);
    remark(input.mesh.remarks);
    const auto arrays = read_point_arrays(given_.attributes, input.mesh, files(), images(), bar);
    take_order(input.mesh.files);
    require_output_holds(results.front().output, input.space_dim() - 1);
    for (ContourResult& result : results) {
      result.input = inputs();
      result.variable = input.mesh.variable;
      result.image_dim = input.space_dim();
      result.wording.no_size = kNoSizeInMeshes;
      require_mesh_contour(input.mesh, *result.isovalue, given_.extraction.allows_empty(), options.ambiguity);
    }
    results.front().seconds.read = watch.lap();
    WrittenFiles written;
    for (ContourResult& result : results) {
      options.work.progress = bar.stage("contour");
      result.mesh = extract_mesh_and_use<Mesh>(
          input, *result.isovalue, options, given_.extraction.single_precision(), [&](auto extraction) {
            result.stats = extraction.stats;
            add_point_arrays(extraction.contour, input, *result.isovalue, options, arrays);
            return with_additions(std::move(extraction.contour), options.work.threads, bar, result);
          });
      remark_if_empty(result, [&] { return remark_without_contour(input.mesh, *result.isovalue); });
      result.seconds.add(*result.stats);
      if (given_.one_file) continue;
      check_and_write(result, bar, written);
      leave_the_sizes(result);
    }
    if (given_.one_file) results = {merged(results, bar, written)};
    written.keep();
  }

  void check_and_write(ContourResult& result, ProgressBar& bar, WrittenFiles& written) const {
    if (!given_.no_check) check_result(result, given_.extraction.threads(), bar);
    write_result(result, bar, written);
  }

  /// Replaces a written mesh by its size, for the report, to free memory.
  static void leave_the_sizes(ContourResult& result) {
    result.streamed = result.size();
    result.mesh = Mesh();
  }

  /// Extracts the contour of one isovalue, without an index.
  void make(const AnyImage& image, ExtractOptions& options, ProgressBar& bar, ContourResult& result) const {
    options.work.progress = bar.stage("contour");
    if (!tiling_.curved.empty()) return make_curved(image, options, bar, result);
    if (tiling_.of_cells) result.wording.no_size = "cells touch; --merge drops most of them";
    if (placed_.rule == Positions::filtered) result.wording.no_size = PositionArguments::kNoSize;
    if (result.picked && !tiling_.lattice) return pick(image, options, bar, result);
    const auto finished = [&](auto extraction) {
      result.stats = extraction.stats;
      if (tiling_.lattice) {
        sample_on_lattice(given_.attributes, extraction.contour, image, tiling_, result.isovalue_of_samples, options,
                          image_options(), bar);
        if (result.picked) extraction.contour = picked_on_lattice(image, extraction.contour, result);
      }
      return with_additions(std::move(extraction.contour), options.work.threads, bar, result);
    };
    const bool single_precision = given_.extraction.single_precision();
    if (const auto method = given_.extraction.polygon_triangulation())
      result.mesh = std::visit(finished, triangulated_polygons(image,
                                                               {result.isovalue_of_samples, options, single_precision,
                                                                given_.no_check, given_.compress.compression()},
                                                               *method, bar));
    else if (!given_.positions.are_linear())
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
        const Contour<N, Real> in_indices = given_.attributes.wanted() ? contour : Contour<N, Real>();
        auto moved = on_curved_grid<Real>(std::move(contour), owned.grid, tiling_.curved,
                                          {options.work.threads, bar.stage("move")}, seams);
        given_.attributes.sample_to(moved, image_options(), options.work.threads, bar,
                                    {tiling_.curved, &in_indices, false});
        result.mesh = with_additions(std::move(moved), options.work.threads, bar, result);
      };
      const auto make = [&]<class Real>(Real) {
        if (result.picked) {
          auto found = extract_component<Real>(
              indexed, *result.isovalue,
              nearest_sample<N>(owned.grid, tiling_.curved, picked_place<N>(*result.picked, given_.pick)), options);
          take_report(found.report, *result.picked);
          return move(std::move(found.contour));
        }
        auto extraction = !seams.empty() ? extract_periodic_with_stats<Real>(
                                               indexed, index_periods<N>(owned.grid, tiling_.curved, seams),
                                               *result.isovalue, options)
                          : given_.positions.are_linear()
                              ? extract_with_stats<Real>(indexed, *result.isovalue, options)
                              : extract_placed_with_stats<Real>(indexed, *result.isovalue, placed_, options);
        result.stats = extraction.stats;
        move(std::move(extraction.contour));
      };
      given_.extraction.single_precision() ? make(float{}) : make(double{});
    };
    std::visit([&](const auto& typed) { std::visit(of_owned, typed); }, image);
  }

  /// The contours as one mesh, checked and written.
  ContourResult merged(std::vector<ContourResult>& results, ProgressBar& bar, WrittenFiles& written) const {
    ContourResult all = in_one_mesh(results);
    check_and_write(all, bar, written);
    return all;
  }

  /// Extracts the component nearest to the point of --pick.
  void pick(const AnyImage& image, const ExtractOptions& options, ProgressBar& bar, ContourResult& result) const {
    Stopwatch watch;
    const auto keep = [&](auto found) {
      take_report(found.report, *result.picked);
      result.mesh = with_additions(std::move(found.contour), options.work.threads, bar, result);
    };
    const auto of_owned = [&]<Value T, int N>(const OwnedImage<T, N>& owned) {
      const std::array<double, N> point = picked_place<N>(*result.picked, given_.pick);
      if (given_.extraction.single_precision())
        keep(extract_component<float>(owned.view(), result.isovalue_of_samples, point, options));
      else
        keep(extract_component<double>(owned.view(), result.isovalue_of_samples, point, options));
    };
    std::visit([&](const auto& typed) { std::visit(of_owned, typed); }, image);
    result.seconds.generate += watch.lap();
  }

  /// The component of the whole contour of an image on a lattice nearest to the point of --pick.
  template <int N, class Real>
  [[nodiscard]] Contour<N, Real> picked_on_lattice(const AnyImage& image, const Contour<N, Real>& contour,
                                                   ContourResult& result) const {
    const std::array<double, N> point = picked_place<N>(*result.picked, given_.pick);
    return std::visit(
        [&](const auto& owned) {
          return pick_on_lattice<N>(contour, owned.grid, *tiling_.lattice, point, *result.picked,
                                    given_.extraction.threads());
        },
        std::get<N - 2>(image));
  }

  /// The mesh of a contour with the normals and attributes of --normals and --attribute; merged (--merge) or unrolled
  /// if it has to be.
  template <class AnyContour>
  Mesh with_additions(AnyContour contour, unsigned threads, ProgressBar& bar, ContourResult& result) const {
    if (given_.merging.are_given()) {
      result.merging = given_.merging.merge(contour, {threads, bar.stage("merge")});
      MergeArguments::require_left(*result.merging, contour.simplices.size(), given_.extraction.allows_empty());
    }
    given_.extraction.add_shape_normals(contour);
    if (tiling_.curved.empty() && !tiling_.lattice)
      given_.attributes.sample_to(contour, image_options(), threads, bar,
                                  {{}, nullptr, images().index_grid(), are_cell_meshes(files(), images())});
    return to_mesh(unrolled_for(std::move(contour), given_.output, given_.unroll));
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
      const auto active = read_active_tiles(given_.index, view, reading);
      results.front().seconds.read += watch.lap();
      for (ContourResult& result : results) {
        options.work.progress = bar.stage("contour");
        if (given_.extraction.single_precision())
          keep(result, extract_with_stats<float>(view, *result.isovalue, *active, options));
        else
          keep(result, extract_with_stats<double>(view, *result.isovalue, *active, options));
      }
    };
    std::visit([&](const auto& typed) { std::visit(of_owned, typed); }, image);
    for (ContourResult& result : results) finished(result);
  }

  void require_facets_options(const std::vector<std::string>& outputs) const {
    refuse_with_facets(given_.extraction, given_.is_streamed(), given_.attributes.wanted());
    for (const std::string& output : outputs) {
      require_facets_output(output, files());
      given_.compress.require_known(output, true);
    }
  }

  ExitCode run_facets(const Streams& streams, const std::vector<SpelledNumber>& isovalues,
                      const std::vector<std::string>& outputs, const ExtractOptions& options) {
    require_facets_options(outputs);
    ProgressBar bar(streams.err, wants_progress());
    Stopwatch watch;
    const FacetsWork work = {0.0,
                             options,
                             given_.extraction.single_precision(),
                             given_.no_check,
                             given_.compress.compression(),
                             {},
                             given_.extraction.allows_empty()};
    if (are_cell_meshes(files(), images())) {
      const MeshInput mesh = read_mesh_input(files(), images(), bar.stage("read"), isovalues.size() > 1);
      remark(mesh.mesh.remarks);
      take_order(mesh.mesh.files);
      const auto of_mesh = write_mesh_facets(mesh, inputs(), watch.lap(), isovalues, outputs, work, bar);
      for (const FacetsResult& result : of_mesh)
        if (result.facets[0] == 0) remark(remark_without_contour(mesh.mesh, result.isovalue));
      return tell(streams, of_mesh);
    }
    ReadImageResult input = with_option_to_4d("--facets", [&] { return read(bar.stage("read")); });
    given_.refuse_tiling_of_file(input.info, file());
    Tiling tiling = given_.extraction.tiling();
    given_.extraction.take_lattice(input.info, file(), tiling);
    std::vector<FacetsResult> results(isovalues.size());
    for (std::size_t i = 0; i < results.size(); ++i) {
      FacetsResult& result = results[i];
      result.input = inputs();
      result.variable = input.info.variable;
      result.output = outputs[i];
      result.image_dim = image_dim(input.image);
      result.isovalue = isovalues[i].value;
      require_output_holds_facets(result.output, result.image_dim);
      require_contour(input, result.isovalue, given_.extraction.allows_empty(), tiling.lattice);
    }
    remark(take_longitudes(input.image, given_.extraction, tiling));
    remark(leave_out_repeated(input.image, tiling));
    results.front().seconds.read = watch.lap();
    WrittenFiles written;
    write_image_facets(
        input.image,
        {0.0, options, given_.extraction.single_precision(), given_.no_check, given_.compress.compression(),
         tiling.periodic, given_.extraction.allows_empty(), tiling.lattice, tiling.division},
        bar, results, written);
    written.keep();
    bar.clear();
    for (const FacetsResult& result : results)
      if (result.facets[0] == 0) remark(remark_without_contour(input.image, result.isovalue));
    return tell(streams, results);
  }

  /// The layers of FILE, or the layers of its scale space, which need FILE in memory as `image`.
  OpenLayersResult open_or_smooth(ReadImageResult& image, ProgressBar& bar) {
    if (!given_.scales.are_given()) return open();
    image = read(bar.stage("read"));
    given_.extraction.refuse_lattice(image.info, file(), "--scale-space");
    return given_.scales.layers(image, given_.extraction.threads());
  }

  void stream(ExtractOptions& options, ProgressBar& bar, std::vector<ContourResult>& results) {
    require_open_files(results.size());
    for (const ContourResult& result : results) require_output_grows(result.output);
    require_streamed_additions(given_.extraction.wants_shape_normals(), given_.attributes.wanted());
    // open, extract and write in one pass
    ReadImageResult image;  // of a scale space, whose layers are computed from it
    Stopwatch watch;
    OpenLayersResult input = with_option_to_4d("--stream", [&] { return open_or_smooth(image, bar); });
    const double read_seconds = watch.lap();
    given_.refuse_tiling_of_file(input.info, file());
    for (ContourResult& result : results) {
      result.input = inputs();
      result.variable = input.info.variable;
    }
    Tiling tiling = given_.extraction.tiling();
    given_.extraction.take_lattice(input.info, file(), tiling);
    remark(take_longitudes(input.layers, given_.extraction, tiling));
    options.work.progress = bar.stage("stream");
    const StreamOptions streaming{options,
                                  given_.extraction.single_precision(),
                                  given_.extraction.allows_empty(),
                                  given_.compress.compression(),
                                  tiling.periodic,
                                  tiling.lattice};
    for (std::string& text : stream_contours(input, streaming, results)) remark(std::move(text));
    results.front().seconds.read += read_seconds;
    for (ContourResult& result : results) result.output_bytes = std::filesystem::file_size(result.output);
  }

  ContourArguments given_;
  Tiling tiling_;  ///< with the image's curved grid
  PositionOptions placed_;
  PositionValues position_values_;
};

}  // namespace

std::unique_ptr<Command> make_contour_command(CLI::App& program) { return std::make_unique<ContourCommand>(program); }

}  // namespace tegl::cli
