// SPDX-License-Identifier: BSD-3-Clause
//
// tegl slice: cuts the contour of an image, or a saved contour, at one or several times, or by any hyperplanes.
#include "tegl/slice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/empty_result.hpp"
#include "base/interrupt.hpp"
#include "base/numbers.hpp"
#include "base/progress.hpp"
#include "input/attributes.hpp"
#include "input/commands.hpp"
#include "input/contour_input.hpp"
#include "input/cuts.hpp"
#include "input/extraction.hpp"
#include "input/lattice_attributes.hpp"
#include "input/layer_image.hpp"
#include "input/mesh_input.hpp"
#include "input/point_arrays.hpp"
#include "output/output.hpp"
#include "output/result.hpp"

namespace tegl::cli {

namespace {

constexpr const char* kSliceExamples =
    "Examples:\n"
    "  tegl slice heart.nii.gz --iso 400 --at t=7.3 -o heart.ply\n"
    "  tegl contour ocean.nc --iso 20 -o ocean.vtkhdf\n"
    "  tegl slice ocean.vtkhdf --at t=1.5,3.25,7.3 -o 'ocean_{t}.ply'\n"
    "  tegl slice ocean.vtkhdf --at t=1:12:45 -o 'film_{n}.glb'      (45 times from 1 to 12: film_01 to film_45)\n"
    "  tegl slice ocean.vtkhdf --at x=329.5 -o meridian.vtkhdf       (a surface in y, z and t)\n"
    "  tegl slice ocean.vtkhdf --at t=7.3 --attribute ocean.nc -o july.ply\n"
    "  tegl slice ocean.vtkhdf --plane 1,0,0,5=200 --scale t=10 -o moving.vtkhdf   (where x + 5 t = 200)\n"
    "An axis has the name in the file or x, y, z, t, u; numbers are in its unit and need not be whole. A slice\n"
    "across an axis has the other axes as its coordinates; other slices have orthonormal ones, which --json reports\n"
    "as 'frame'.\n"
    "For an image, only the layers next to each slice are contoured; all of them with --plane, --periodic, --lattice,\n"
    "--division and --samples-are cells. A saved contour is sliced directly, all slices of one direction in one pass.\n"
    "Every place on a periodic axis has a slice. If all axes are periodic, so has every lattice plane.\n"
    "At a layer of the image, a saved 5D contour by --ambiguity low or high has other tetrahedra than the layer's\n"
    "contour, with the same topology: slice the image for the layer's own.";

void require_cuttable(int dim, std::string_view what) {
  if (dim >= 3 && dim <= 5) return;
  throw Error(ErrorCode::UnsupportedData, fmt::format("holds a {}D {}; expected a 3D, 4D or 5D one", dim, what));
}

/// The hyperplane of a cut, after axis a is scaled by factors[a].
template <int N>
Hyperplane<N> hyperplane_of(const Cut& cut, const std::vector<double>& factors) {
  // Across an axis the same product as for vertices, so that the cut meets those at this coordinate.
  if (cut.across)
    return Hyperplane<N>::across(*cut.across,
                                 cut.level.value_or(cut.value) * factors[static_cast<std::size_t>(*cut.across)]);
  Hyperplane<N> hyperplane;
  for (int a = 0; a < N; ++a)
    hyperplane.normal[a] = cut.normal[static_cast<std::size_t>(a)] / factors[static_cast<std::size_t>(a)];
  hyperplane.offset = cut.value;
  return hyperplane;
}

/// The frame of a hyperplane, for reports; nullopt across an axis, where it is trivial.
template <int N>
std::optional<CutFrame> frame_for_report(const Cut& cut, const std::vector<double>& factors) {
  if (cut.across) return std::nullopt;
  const HyperplaneFrame<N> frame = frame_of(hyperplane_of<N>(cut, factors));
  CutFrame result{{frame.origin.begin(), frame.origin.end()}, {}};
  for (const Vector<N>& axis : frame.axes) result.axes.emplace_back(axis.begin(), axis.end());
  return result;
}

template <int N, class Real>
void stretch(Contour<N, Real>& contour, const std::vector<double>& factors) {
  Vector<N> by_axis;
  std::copy(factors.begin(), factors.end(), by_axis.begin());
  if (std::any_of(by_axis.begin(), by_axis.end(), [](double factor) { return factor != 1.0; }))
    contour = scale_axes(std::move(contour), by_axis);
}

/// What cuts of a wrapped contour need to know of it.
struct Wrapped {
  std::vector<double> periods = {};  ///< period_numbers, before its axes are scaled
  bool is_unrolled = false;          ///< for cuts that wrapped contours refuse
};

/// Throws InvalidArgument, with the cut as it was given, for a cut too far from the contour's periods.
template <int N, class Real>
void require_near_periods(const Contour<N, Real>& contour, const Cut& cut, const std::vector<double>& factors) {
  Contour<N, Real> empty;  // so that its cut takes no time
  empty.axis_names = contour.axis_names;
  empty.periods = contour.periods;
  try {
    (void)slice(empty, hyperplane_of<N>(cut, factors));
  } catch (const Error& error) {
    const bool is_scaled = std::any_of(factors.begin(), factors.end(), [](double factor) { return factor != 1.0; });
    throw Error(error.code(), fmt::format("the slice at {} = {}{}: {}", cut.axis, cut.text,
                                          is_scaled ? ", on axes scaled by --scale" : "", error.what()));
  }
}

/// Cuts a contour after its axes are scaled; all cuts of one direction in one pass.
template <int N, class Real>
Wrapped cut_contour_of(Contour<N, Real> contour, const std::vector<double>& factors, const ExtractionOptions& own,
                       std::vector<ContourResult>& results, ProgressBar& bar) {
  Wrapped wrapped{period_numbers(contour.periods)};
  stretch(contour, factors);
  std::optional<Contour<N, Real>> unrolled;  // for cuts that wrapped contours refuse
  for (std::size_t first = 0, end = 0; first < results.size(); first = end) {
    const Cut& like = *results[first].cut;
    std::vector<Hyperplane<N>> hyperplanes;
    for (end = first;
         end < results.size() && results[end].cut->normal == like.normal && results[end].cut->across == like.across;
         ++end)
      hyperplanes.push_back(hyperplane_of<N>(*results[end].cut, factors));
    Stopwatch watch;
    const bool is_refused = !cuts_wrapped(contour.periods, hyperplanes.front());
    for (std::size_t i = first; i < end && !is_refused; ++i) require_near_periods(contour, *results[i].cut, factors);
    if (is_refused && !unrolled) unrolled = unroll(contour).contour;
    auto cuts = slice_stack(is_refused ? *unrolled : contour, hyperplanes, {own.threads(), bar.stage("slice")});
    for (std::size_t i = 0; i < cuts.size(); ++i) {
      ContourResult& result = results[first + i];
      result.image_dim = N;
      auto cut = std::exchange(cuts[i], {});
      own.add_shape_normals(cut);
      result.mesh = to_mesh(unrolled_for(std::move(cut), result.output, false));
      result.cut->frame = frame_for_report<N>(*result.cut, factors);
    }
    // The time of a pass is divided equally among its cuts.
    const double seconds = watch.lap() / static_cast<double>(hyperplanes.size());
    for (std::size_t i = first; i < end; ++i) results[i].seconds.slice = seconds;
  }
  wrapped.is_unrolled = unrolled.has_value();
  return wrapped;
}

/// An empty cut, outside of an image, with names and units of its axes.
template <int N, class Real>
Contour<N, Real> empty_cut(const Grid<N + 1>& grid, int across) {
  Contour<N, Real> cut;
  for (int a = 0, b = 0; a <= N; ++a) {
    if (a == across) continue;
    cut.axis_names[static_cast<std::size_t>(b)] = grid.axes[static_cast<std::size_t>(a)].name;
    cut.axis_units[static_cast<std::size_t>(b++)] = grid.axes[static_cast<std::size_t>(a)].unit;
  }
  return cut;
}

/// The cut of an image, of which it reads only the layers beside the cut.
template <class Real, Value T, int N>
Extraction<N - 1, Real> slice_slab(const Image<T, N>& image, double isovalue, const Cut& cut,
                                   const ExtractOptions& options) {
  if (cut.is_outside) return {empty_cut<N - 1, Real>(image.grid(), *cut.across), {}};
  return slice_image_with_stats<Real>(image, isovalue, Hyperplane<N>::across(*cut.across, cut.value), options);
}

/// Calls f with the image of any type.
template <class F>
decltype(auto) visit_owned(const AnyImage& image, const F& f) {
  return std::visit([&](const auto& typed) { return std::visit(f, typed); }, image);
}
template <class F>
decltype(auto) visit_owned(const AnyImage5d& image, const F& f) {
  return std::visit(f, image);
}

/// Whether a cut across an axis needs only the layers beside it.
template <class AnyDimension>
bool is_separate(const AnyDimension& image, int axis) {
  return visit_owned(image, [axis](const auto& owned) { return owned.grid.is_separate(axis); });
}

/// The mesh of a cut, after its axes are scaled, with the normals of --normals.
template <int N, class Real>
Mesh cut_mesh(Contour<N, Real> contour, const Cut& cut, const std::vector<double>& factors,
              const ExtractionOptions& own) {
  if (cut.is_outside) return to_mesh(std::move(contour));
  std::vector<double> others = factors;
  others.erase(others.begin() + *cut.across);
  stretch(contour, others);
  own.add_shape_normals(contour);
  return to_mesh(std::move(contour));
}

/// Appends the vertices of a cut, in the coordinates of the space that was cut.
template <int N>
void append_points(const ContourResult& result, const std::vector<double>& factors, Contour<N, double>& points) {
  const HyperplaneFrame<N> frame = frame_of(hyperplane_of<N>(*result.cut, factors));
  const auto& coordinates = result.mesh.coordinates;
  for (std::size_t i = 0; i < coordinates.size(); i += N - 1) {
    Vector<N - 1> within;
    std::copy_n(coordinates.data() + i, N - 1, within.begin());
    const Vector<N> x = frame.to_space(within);
    auto& point = points.vertices.emplace_back();
    for (int a = 0; a < N; ++a) point[a] = x[a] / factors[static_cast<std::size_t>(a)];
  }
}

/// Adds the values of other images at the vertices of the cuts. `periods`: Wrapped::periods.
template <int N>
void add_attributes(const AttributeOptions& attributes, const ReadImageOptions& reading,
                    const std::vector<double>& factors, const std::vector<double>& periods, unsigned threads,
                    bool by_index, bool of_mesh, std::vector<ContourResult>& results, ProgressBar& bar) {
  Contour<N, double> points;  // the points of all cuts, so that each image is read once
  points.periods = periods_of_numbers<N>(periods);
  for (const ContourResult& result : results) append_points<N>(result, factors, points);
  attributes.sample_to(points, reading, threads, bar, {{}, nullptr, by_index, of_mesh});
  for (const Attribute& all : points.vertex_attributes) {
    std::size_t first = 0;
    for (ContourResult& result : results) {
      auto& own = result.mesh.vertex_attributes;
      if (std::any_of(own.begin(), own.end(), [&](const Attribute& other) { return other.name == all.name; }))
        throw Error(ErrorCode::InvalidArgument,
                    fmt::format("--attribute: the contour already has an attribute '{}'; expected another", all.name));
      const std::size_t end = first + result.mesh.coordinates.size() / (N - 1);
      own.push_back({all.name,
                     all.unit,
                     all.width,
                     {all.values.begin() + static_cast<std::ptrdiff_t>(first),
                      all.values.begin() + static_cast<std::ptrdiff_t>(end)}});
      first = end;
    }
  }
}

class SliceCommand final : public Command {
 public:
  explicit SliceCommand(CLI::App& program)
      : Command(program, "slice", "Slice a contour at a time, or by any other hyperplane",
                "an image in 3D to 5D, a 4D or 3D mesh, or a contour in 3D to 5D saved by 'tegl contour' (.vtkhdf ...)",
                Files::image) {
    app()
        .add_option("--at", at_,
                    "axis and coordinate of the slice, in the unit of the axis: t=7.3, x=2; t=1,2.5 for several; "
                    "t=0:10:21 for 21 from 0 to 10")
        ->allow_extra_args(false)
        ->type_name("AXIS=NUMBERS");
    app()
        .add_option("--plane", planes_,
                    "slices by the hyperplane with this normal: 1,0,0,5=2 is where x + 5 t = 2; several as with --at")
        ->allow_extra_args(false)
        ->type_name("A,B,..=NUMBERS");
    app()
        .add_option("--scale", scale_, "factors that stretch axes, to make lengths along them comparable: t=10,z=2")
        ->allow_extra_args(false)
        ->type_name("AXIS=FACTOR");
    options_.add_to(app(), false);
    options_.add_tiling_to(app());
    attributes_.add_to(app());
    compress_.add_to(app());
    app()
        .add_option("-o,--output", output_,
                    std::string("the result: ") + kContourFiles +
                        "; in the name, {t} is replaced by the number, {axis} by its axis, and {n} by 1, 2, 3 ... with "
                        "leading zeros")
        ->type_name("FILE")
        ->required();
    app().add_flag("--no-check", no_check_, "skip the check of the result");
    add_image_options();
    add_quiet();
    app().footer(kSliceExamples);
  }

  ExitCode run(const Streams& streams) override {
    // validate options and files
    std::vector<Cut> cuts = parse_cuts(at_);
    for (Cut& cut : parse_planes(planes_)) cuts.push_back(std::move(cut));
    if (cuts.empty())
      throw Error(ErrorCode::InvalidArgument,
                  "neither --at nor --plane is given; expected one of them, as in --at t=7.3");
    outputs_ = cut_outputs(output_, cuts);
    require_inputs();
    for (const std::string& output : outputs_) {
      require_output(output, files());
      require_output_keeps(output, options_.normals(), attributes_.wanted());
      compress_.require_known(output);
    }
    require_different_outputs(outputs_);
    also_read(attributes_.files());
    attributes_.require_inputs();
    // cut
    ProgressBar bar(streams.err, wants_progress());
    std::vector<ContourResult> results = find_mesh_file_format(file()) != nullptr ? cut_contour(std::move(cuts), bar)
                                         : are_cell_meshes(files(), images())     ? cut_cell_mesh(std::move(cuts), bar)
                                                                                  : cut_image(std::move(cuts), bar);
    if (attributes_.wanted() && results[0].image_dim == 5)
      throw Error(ErrorCode::InvalidArgument, "--attribute with a slice of a 5D contour; expected a 3D or 4D contour");
    const bool of_mesh = are_cell_meshes(files(), images());
    if (attributes_.wanted() && results[0].image_dim == 4)
      add_attributes<4>(attributes_, image_options(), factors_, wrapped_.periods, options_.threads(),
                        images().index_grid(), of_mesh, results, bar);
    else if (attributes_.wanted())
      add_attributes<3>(attributes_, image_options(), factors_, wrapped_.periods, options_.threads(),
                        images().index_grid(), of_mesh, results, bar);
    // check and write
    for (std::size_t i = 0; i < results.size(); ++i) {
      results[i].input = inputs();
      results[i].compression = compress_.compression();
      if (!no_check_) check_result(results[i], options_.threads(), bar);
    }
    write_all(results, bar);
    bar.clear();
    if (wrapped_.is_unrolled) remark(kUnrolledForCuts);
    for (const ContourResult& result : results) remark(result.lost.remark(result.output));
    // report
    if (json()) {
      streams.out.write(dump(document(results)));
    } else if (!quiet()) {
      for (const ContourResult& result : results) streams.out.write(to_text(streams.out, result));
    }
    ExitCode exit = ExitCode::Ok;
    for (const ContourResult& result : results) exit = std::max(exit, result.exit_code());
    return exit;
  }

 private:
  [[nodiscard]] bool knows_lattices() const override { return true; }
  /// One object for one cut, a list for several.
  static Json document(const std::vector<ContourResult>& results) {
    if (results.size() == 1) return to_json(results.front());
    Json list = Json::array();
    for (const ContourResult& result : results) list.push_back(to_json(result));
    return list;
  }

  /// Checks that an input of this dimension can be cut as requested.
  void require_cuts(int dim, std::string_view what) const {
    require_cuttable(dim, what);
    for (const std::string& output : outputs_) require_output_holds(output, dim - 2);
  }

  /// Makes a result for each cut, with the data that is known in advance.
  [[nodiscard]] std::vector<ContourResult> results_for(std::vector<Cut> cuts, const CutSpace& space) const {
    std::vector<ContourResult> results;
    for (Cut& cut : resolve(std::move(cuts), space, options_.allows_empty())) {
      ContourResult& result = results.emplace_back();
      result.cut = std::move(cut);
      result.wording.no_size =
          "the slice passes through vertices of the contour, or samples equal the isovalue, which --epsilon avoids";
    }
    for (std::size_t i = 0; i < results.size(); ++i) results[i].output = outputs_[i];
    return results;
  }

  std::vector<ContourResult> cut_image(const std::vector<Cut>& cuts, ProgressBar& bar) {
    Tiling tiling = options_.tiling();
    if (options_.finds_longitudes()) tiling.periodic.clear();  // cut_layers looks for them
    if (planes_.empty() && options_.samples_are_points() && tiling.is_plain())
      if (std::optional<std::vector<ContourResult>> results = cut_layers(cuts, bar)) return std::move(*results);
    turn_to_all_files();  // as listed, whatever order they were opened in
    return cut_whole_image(cuts, bar);
  }

  /// Cuts an image across its last axis, of which it reads only the layers that the cuts need. Nullopt if the whole
  /// image has to be read. Wrong cuts and cuts outside of the image are errors before any sample is read.
  std::optional<std::vector<ContourResult>> cut_layers(const std::vector<Cut>& cuts, ProgressBar& bar) {
    const double isovalue = options_.isovalue();
    Stopwatch watch;
    const Progress progress = bar.stage("read");
    std::vector<ContourResult> results;
    OpenLayersResult input;
    try {
      input = open();
    } catch (const Error&) {
      return std::nullopt;  // not a format with layers, or reading reports the error
    }
    if (options_.has_lattice(input.info)) return std::nullopt;  // cells of a lattice extend over more layers
    if (options_.finds_longitudes() && has_repeated_longitudes(input.layers))
      return std::nullopt;  // values are compared
    Tiling tiling = options_.tiling();
    const std::string on_longitudes = take_longitudes(input.layers, options_, tiling);
    if (!tiling.is_plain()) return std::nullopt;  // cuts of wrapped contours
    const auto of_layers = [&]<Value T, int N>(const std::unique_ptr<LayerReader<T, N>>& layers) {
      require_cuts(N, "image");
      if constexpr (N >= 3) {
        std::vector<LayerRange> needed;
        results = plan(layers->grid(), sizeof(T), input.info, cuts, needed);
        if (results.empty()) return;
        if (std::is_same_v<T, double> && may_be_whole_numbers(input.info)) {
          results.clear();
          return;
        }
        RangedLayers<T, N> ranged(*layers, isovalue, isovalue);
        LayerImage<T, N> image(ranged);
        read_layers(image, needed, progress);
        if (!options_.allows_empty()) require_both_sides(image, input.info, progress);
        results.front().seconds.read = watch.lap();
        const Image<T, N> view = image.view();
        for (ContourResult& result : results) {
          result.seconds.read = results.front().seconds.read;
          cut_slab(view, result, bar);
        }
      }
    };
    std::visit([&](const auto& any) { std::visit(of_layers, any); }, input.layers);
    if (results.empty()) return std::nullopt;
    remark(on_longitudes);
    return results;
  }

  /// A result for each cut, and the layers that it needs; none if the cuts need more than layers along the last axis.
  /// Throws for cuts that are wrong or outside of the image.
  template <int N>
  std::vector<ContourResult> plan(const Grid<N>& grid, std::size_t sample_bytes, const ImageInfo& info,
                                  const std::vector<Cut>& cuts, std::vector<LayerRange>& needed) {
    constexpr int kLast = N - 1;
    const CutSpace space = space_of(grid);
    attributes_.keep_sizes_of(grid);
    factors_ = parse_scale(scale_, space);
    std::vector<ContourResult> results = results_for(cuts, space);
    if (std::any_of(grid.axes.begin(), grid.axes.end(), [](const Axis& axis) { return axis.size() < 2; }) ||
        !grid.is_separate(kLast) || !fits_address_space(grid, sample_bytes))
      return {};
    const ExtractOptions options = options_.library_options();
    for (ContourResult& result : results) {
      if (*result.cut->across != kLast) return {};
      if (result.cut->is_outside)
        needed.emplace_back();
      else if (options_.single_precision())
        needed.push_back(layers_of_cut<float>(grid, kLast, result.cut->value, options));
      else
        needed.push_back(layers_of_cut<double>(grid, kLast, result.cut->value, options));
      result.image_dim = N;
      result.isovalue = options_.isovalue();
      result.variable = info.variable;
    }
    return results;
  }

  /// Reads the layers that cuts need, in ascending order.
  template <Value T, int N>
  static void read_layers(LayerImage<T, N>& image, std::vector<LayerRange> needed, const Progress& progress) {
    std::ranges::sort(needed, {}, &LayerRange::first);
    for (std::size_t i = 0; i < needed.size(); ++i) {
      if (!progress(static_cast<double>(i) / static_cast<double>(needed.size())))
        InterruptHandler::throw_if_requested();
      image.read(needed[i]);
    }
  }

  /// As require_contour, for an image that is not read as a whole: reads further layers only if all samples of the
  /// layers of the cuts are on one side of the isovalue.
  template <Value T, int N>
  void require_both_sides(LayerImage<T, N>& image, const ImageInfo& info, const Progress& progress) const {
    image.complete_range([&](double fraction) {
      if (!progress(fraction)) InterruptHandler::throw_if_requested();
    });
    const double isovalue = options_.isovalue();
    if (!image.range().has_both_sides(isovalue)) throw outside_error(isovalue, image.range(), info.value_unit);
  }

  std::vector<ContourResult> cut_whole_image(std::vector<Cut> cuts, ProgressBar& bar) {
    Stopwatch watch;
    auto any = read_to_5d(bar.stage("read"), CurvedGrids::allowed);
    return std::visit([&](auto& input) { return cut_read_image(input, std::move(cuts), bar, watch); }, any);
  }

  template <class Input>
  std::vector<ContourResult> cut_read_image(Input& input, std::vector<Cut> cuts, ProgressBar& bar, Stopwatch& watch) {
    const double isovalue = options_.isovalue();
    require_cuts(image_dim(input.image), "image");
    Tiling tiling = options_.tiling();
    CutSpace space = space_of(input.image);
    if constexpr (std::is_same_v<Input, ReadImageResult>) {
      std::optional<std::uint64_t> folded_cells;
      attributes_.keep_sizes_of(input.image);
      remark(take_grid(input, file(), options_, tiling, folded_cells));
      space = tiling.of_cells ? space_of_cells(input.image, tiling.cell_faces)
              : tiling.periodic.empty() || !tiling.curved.empty()
                  ? space_of(input.image, tiling.curved, tiling.periodic)
                  : space_of_periods(input.image, tiling.periodic);
      refuse_attributes_on_lattices(attributes_, tiling);
    } else {
      options_.require_to_5d();
      if (!tiling.periodic.empty()) space = space_of_periods(input.image, tiling.periodic);
    }
    factors_ = parse_scale(scale_, space);
    std::vector<ContourResult> results = results_for(std::move(cuts), space);
    require_contour(input, isovalue, options_.allows_empty(), tiling.lattice);
    const double read_seconds = watch.lap();
    std::vector<ContourResult> of_whole;
    std::vector<std::size_t> places;
    // cuts across an axis from a slab; the others, and those of curved grids, from the whole contour
    for (std::size_t i = 0; i < results.size(); ++i) {
      ContourResult& result = results[i];
      result.variable = input.info.variable;
      result.isovalue = isovalue;
      result.image_dim = image_dim(input.image);
      result.seconds.read = read_seconds;
      if (tiling.is_plain() && result.cut->across && is_separate(input.image, *result.cut->across)) {
        const auto of_owned = [&]<Value T, int N>(const OwnedImage<T, N>& owned) {
          if constexpr (N >= 3) cut_slab(owned.view(), result, bar);  // others are refused by require_cuts
        };
        visit_owned(input.image, of_owned);
        continue;
      }
      of_whole.push_back(result);
      places.push_back(i);
    }
    if (!of_whole.empty()) cut_whole(input.image, tiling, of_whole, bar);
    for (std::size_t i = 0; i < places.size(); ++i) results[places[i]] = std::move(of_whole[i]);
    return results;
  }

  /// Contours only the layers of a cut.
  template <Value T, int N>
  void cut_slab(const Image<T, N>& image, ContourResult& result, ProgressBar& bar) const {
    ExtractOptions options = options_.library_options();
    options.work.progress = bar.stage("slice");
    Stopwatch watch;
    if (options_.single_precision())
      finish_slab(slice_slab<float>(image, *result.isovalue, *result.cut, options), result, watch);
    else
      finish_slab(slice_slab<double>(image, *result.isovalue, *result.cut, options), result, watch);
  }

  template <int N, class Real>
  void finish_slab(Extraction<N, Real> extraction, ContourResult& result, Stopwatch& watch) const {
    result.stats = extraction.stats;
    result.mesh = cut_mesh(std::move(extraction.contour), *result.cut, factors_, options_);
    const double seconds = watch.lap();
    result.seconds.add(extraction.stats);
    // The slab's extraction is part of the time; the rest is the cut itself.
    result.seconds.slice = std::max(0.0, seconds - (result.seconds.total() - result.seconds.read));
  }

  /// Cuts the contour of the whole image.
  template <class AnyDimension>
  void cut_whole(const AnyDimension& image, const Tiling& tiling, std::vector<ContourResult>& results,
                 ProgressBar& bar) {
    ExtractOptions options = options_.library_options();
    options.work.progress = bar.stage("contour");
    cut_extraction(
        [&](const auto& use) {
          const double isovalue = *results[0].isovalue;
          extract_and_use<Nothing>(image, isovalue, options, options_.single_precision(), use, tiling);
        },
        results, bar);
  }

  struct Nothing {};

  /// Cuts the contour that `extract` passes to its argument.
  template <class Extract>
  void cut_extraction(const Extract& extract, std::vector<ContourResult>& results, ProgressBar& bar) {
    ExtractStats stats;
    extract([&]<int N, class Real>(Extraction<N, Real>&& extraction) {
      stats = extraction.stats;
      if constexpr (N >= 3) wrapped_ = cut_contour_of(std::move(extraction.contour), factors_, options_, results, bar);
      return Nothing();
    });
    for (ContourResult& result : results) {
      result.stats = stats;
      result.seconds.add(stats);
    }
  }

  /// Cuts the contour of a mesh of cells.
  std::vector<ContourResult> cut_cell_mesh(std::vector<Cut> cuts, ProgressBar& bar) {
    const double isovalue = options_.isovalue();
    refuse_options_of_images(file(), options_, images());
    Stopwatch watch;
    MeshInput input = read_cells(files(), images(), bar.stage("read"));
    for (const std::string& text : input.mesh.remarks) remark(text);
    require_cuts(input.space_dim(), "mesh");
    const CutSpace space = space_of(input);
    factors_ = parse_scale(scale_, space);
    std::vector<ContourResult> results = results_for(std::move(cuts), space);
    require_mesh_contour(input.mesh, isovalue, options_.allows_empty(), options_.library_options().ambiguity);
    auto arrays = read_point_arrays(attributes_, input.mesh, files(), images(), bar);
    take_order(input.mesh.files);
    for (PointArray& array : arrays) keep_times_of_cuts(array.mesh, results);
    keep_times_of_cuts(input.mesh, results);
    make_complex(input);
    const double read_seconds = watch.lap();
    for (ContourResult& result : results) {
      result.variable = input.mesh.variable;
      result.isovalue = isovalue;
      result.seconds.read = read_seconds;
    }
    ExtractOptions options = options_.library_options();
    options.work.progress = bar.stage("contour");
    cut_extraction(
        [&](const auto& use) {
          extract_mesh_and_use<Nothing>(input, isovalue, options, options_.single_precision(), [&](auto extraction) {
            add_point_arrays(extraction.contour, input, isovalue, options, arrays);
            return use(std::move(extraction));
          });
        },
        results, bar);
    return results;
  }

  /// Drops the times of a mesh that no cut needs, if all cuts are across the time.
  static void keep_times_of_cuts(CellMesh& mesh, const std::vector<ContourResult>& results) {
    if (mesh.times.size() < 2) return;
    double first = std::numeric_limits<double>::infinity(), last = -first;
    for (const ContourResult& result : results) {
      if (result.cut->is_outside) continue;
      if (!result.cut->across || *result.cut->across != mesh.dim) return;
      first = std::min(first, result.cut->value);
      last = std::max(last, result.cut->value);
    }
    if (first <= last) keep_times(mesh, first, last);
  }

  std::vector<ContourResult> cut_contour(std::vector<Cut> cuts, ProgressBar& bar) {
    std::vector<std::string> given = options_.given();
    std::erase(given, "--threads");
    refuse_image_options(files(), given, images(),
                         "only --at, --plane, --scale, --threads, --allow-empty and --output");
    Stopwatch watch;
    Mesh mesh = read_saved_contour(file(), mesh_options(bar.stage("read")), options_.allows_empty());
    require_cuts(mesh.space_dim, "contour");
    const CutSpace space = space_of(mesh);
    factors_ = parse_scale(scale_, space);
    std::vector<ContourResult> results = results_for(std::move(cuts), space);
    const double read_seconds = watch.lap();
    for (ContourResult& result : results) {
      result.seconds.read = read_seconds;
      result.isovalue = mesh.isovalue;
    }
    if (mesh.space_dim == 5)
      wrapped_ = cut_contour_of(to_contour<5>(std::move(mesh)), factors_, options_, results, bar);
    else if (mesh.space_dim == 4)
      wrapped_ = cut_contour_of(to_contour<4>(std::move(mesh)), factors_, options_, results, bar);
    else
      wrapped_ = cut_contour_of(to_contour<3>(std::move(mesh)), factors_, options_, results, bar);
    return results;
  }

  /// Writes all files or none.
  static void write_all(std::vector<ContourResult>& results, ProgressBar& bar) {
    WrittenFiles written;
    for (ContourResult& result : results) write_result(result, bar, written);
    written.keep();
  }

  ExtractionOptions options_;
  AttributeOptions attributes_;
  CompressOption compress_;
  std::vector<double> factors_;  ///< from --scale, by axis
  Wrapped wrapped_;
  std::vector<std::string> at_, planes_, scale_;
  std::string output_;                ///< with placeholders
  std::vector<std::string> outputs_;  ///< output of each cut
  bool no_check_ = false;
};

}  // namespace

std::unique_ptr<Command> make_slice_command(CLI::App& program) { return std::make_unique<SliceCommand>(program); }

}  // namespace tegl::cli
