// SPDX-License-Identifier: BSD-3-Clause
//
// The FILE of commands that work on contours: an image, which is contoured first, or a saved contour of `tegl contour`.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "base/progress.hpp"
#include "input/commands.hpp"
#include "input/extraction.hpp"
#include "output/result.hpp"
#include "tegl/contour.hpp"
#include "tegl/curved.hpp"
#include "tegl/io/layers.hpp"
#include "tegl/io/meshes.hpp"

namespace tegl::cli {

/// A contour in 2 to 5 dimensions.
using AnyContour = std::variant<Contour<2, double>, Contour<3, double>, Contour<4, double>, Contour<5, double>>;

/// Converts a mesh to a contour. Throws UnsupportedData unless its simplices are segments in the plane, triangles in
/// space, tetrahedra in 4-space or 4-simplices in 5-space.
AnyContour to_any_contour(Mesh&& mesh);

/// Throws UnsupportedData: the operation exists in 2 to 4 dimensions only.
[[noreturn]] void throw_5d();

/// Calls f with a contour in 2, 3 or 4 dimensions. Throws UnsupportedData for one in 5.
template <class Any, class F>
decltype(auto) visit_to_4d(Any& contour, const F& f) {
  // Not by std::visit: clang 14 does not instantiate member templates that f calls from a lambda in a lambda.
  switch (contour.index()) {
    case 0:
      return f(std::get<0>(contour));
    case 1:
      return f(std::get<1>(contour));
    case 2:
      return f(std::get<2>(contour));
    default:
      throw_5d();
  }
}

/// Reads a mesh with finite coordinates. Throws MalformedFile if a coordinate is infinite or NaN, and errors of
/// `read_mesh`.
Mesh read_finite_mesh(const std::string& file, const ReadMeshOptions& options);

/// Takes what the file says of its cells to the tiling: whether samples are cells, if the options ask for it, and the
/// coordinates of a curved grid, and longitudes for --periodic auto. Leaves out samples as leave_out_repeated. Sets the
/// number of folded cells of a curved grid, and returns remarks on them and on longitudes. Throws InvalidArgument for
/// options that choose other tilings.
std::vector<std::string> take_grid(ReadImageResult& input, const std::string& file, const ExtractionOptions& options,
                                   Tiling& tiling, std::optional<std::uint64_t>& folded_cells);
/// ExtractionOptions::take_longitudes for an image, or the readers of its layers.
template <class Any>
std::string take_longitudes(const Any& image, const ExtractionOptions& options, Tiling& tiling) {
  const auto of_one = [&](const auto& one) {
    if constexpr (requires { one.grid; })
      return options.take_longitudes(one.grid, longitude_axes(one.view(), tiling.curved), tiling);
    else
      return options.take_longitudes(one->grid(), longitude_axes(one->grid(), tiling.curved), tiling);
  };
  return std::visit([&](const auto& typed) { return std::visit(of_one, typed); }, image);
}
/// Leaves out the samples that repeat the first ones of axes of --periodic (`without_repeated`), of the image and of
/// the tiling's curved grid. Returns a remark on them, or an empty text. Throws InvalidArgument if their values differ.
std::string leave_out_repeated(AnyImage& image, Tiling& tiling);
/// Whether an image has samples that leave_out_repeated would leave out if their values are equal.
bool has_repeated_longitudes(const AnyLayers& layers);
/// The space of an image with the ranges of its curved coordinates. `periodic`: the axes of --periodic.
CutSpace space_of(const AnyImage& image, const std::vector<CurvedAxis>& curved,
                  const std::vector<std::string>& periodic = {});
/// As space_of, to the outer faces of cells. `faces`: as in the file.
CutSpace space_of_cells(const AnyImage& image, const CellFaces& faces);

/// As space_of, over the whole periods of the axes of --periodic.
CutSpace space_of_periods(const AnyImage& image, const std::vector<std::string>& periodic);
CutSpace space_of_periods(const AnyImage5d& image, const std::vector<std::string>& periodic);

/// Reads a saved contour with finite coordinates. Throws EmptyResult if it has no simplices, unless `allow_empty`.
Mesh read_saved_contour(const std::string& file, const ReadMeshOptions& options, bool allow_empty);

/// A contour to work on, with its origin.
struct ContourInput {
  AnyContour contour;
  InputFiles file;
  std::string variable;                       ///< netCDF: the variable read
  std::optional<double> isovalue;             ///< none if a saved contour does not have it
  std::optional<ExtractStats> stats;          ///< none for a saved contour
  std::optional<std::uint64_t> folded_cells;  ///< of a curved grid
  std::optional<ReadImageResult> image;       ///< if requested, and FILE is an image
  std::optional<CutAxis> last_axis;           ///< extent in an image or a mesh of cells; none for a saved contour
  const char* last_axis_of = "image";         ///< the object that this extent belongs to
  /// World coordinates of the first and the last sample on the last axis, or the first and the last time of a mesh;
  /// none for a saved contour, and if an image's world map mixes the axis with others.
  std::pair<std::optional<double>, std::optional<double>> ends;
  bool single_precision = false;   ///< all coordinates have single precision, from --precision float
  bool is_curved = false;          ///< of an image on a curved grid
  std::optional<Lattice> lattice;  ///< of the image's samples
  StageSeconds seconds;            ///< time of reading and contouring

  /// 2 to 5: the dimension of the space that the contour lies in.
  [[nodiscard]] int space_dim() const { return static_cast<int>(contour.index()) + 2; }
  [[nodiscard]] MeshSize size() const;
  /// The name of a contour's axis, or its customary letter; and its unit, which may be empty.
  [[nodiscard]] std::string axis_name(int axis) const;
  [[nodiscard]] std::string axis_unit(int axis) const;

  /// The parts of a report that describe the input. The caller fills mesh, output, check and later stages.
  [[nodiscard]] ContourResult to_result() const;
};

/// Unrolls a wrapped contour, for operations that do not know periods. Returns a remark on it, or an empty text.
std::string unroll_input(ContourInput& input);

/// Sets the keys "input", "variable", "image_dim" and "isovalue".
void add_input_keys(Json& json, const ContourInput& input);

/// Lines of a report about the input: the file, the isovalue if known, the size of the contour.
std::string input_text(const ContourInput& input);

/// A contour as a mesh with the isovalue of the input: a view of the contour, or its memory taken over from a
/// temporary. All its vertices must be from the input.
template <int N, class Real>
MeshView mesh_of(const Contour<N, Real>& contour, const ContourInput& input) {
  MeshView mesh(contour);
  mesh.isovalue = input.isovalue;
  mesh.single_precision = input.single_precision;
  return mesh;
}
template <int N, class Real>
Mesh mesh_of(Contour<N, Real>&& contour, const ContourInput& input) {
  Mesh mesh = to_mesh(std::move(contour));
  mesh.isovalue = input.isovalue;
  mesh.single_precision = input.single_precision;
  return mesh;
}

class AttributeOptions;

/// A command whose FILE is an image (with --iso and other options of extraction, and --var) or a saved contour (which
/// allows only --threads of these).
class ContourInputCommand : public Command {
 protected:
  /// Adds FILE, --json, --quiet, and the options of images and of the extraction.
  ContourInputCommand(CLI::App& program, const std::string& name, const std::string& description,
                      Files files = Files::image);

  /// `read_contour` takes lattices into account.
  [[nodiscard]] bool knows_lattices() const override { return true; }
  /// Value of --threads: 0 for all of the machine.
  [[nodiscard]] unsigned threads() const { return options_.threads(); }

  /// Value of --normals; empty: none.
  [[nodiscard]] const std::string& normals() const { return options_.normals(); }
  /// Whether a value outside of the data gives an empty result and not an error (--allow-empty).
  [[nodiscard]] bool allows_empty() const { return options_.allows_empty(); }

  /// Reads FILE, and contours it if it is an image, which is kept if `keep_image`, on a curved grid only if allowed;
  /// images of 5 axes are not kept but errors. Throws InvalidArgument if --iso is missing for an image, or if options
  /// of images are given with a saved contour; EmptyResult if the isovalue is outside of the data or the saved contour
  /// is empty, unless --allow-empty is given; and errors of the readers.
  [[nodiscard]] ContourInput read_contour(ProgressBar& bar, bool keep_image = false,
                                          CurvedGrids curved = CurvedGrids::allowed);

  /// Sets the options whose arrays at the points of a mesh read_contour adds to its contour; null: none.
  void interpolate_arrays_of(const AttributeOptions* attributes) { attributes_of_meshes_ = attributes; }

 private:
  /// Contours an image of 5 axes.
  void contour_5d(const ReadImage5dResult& input, ExtractOptions options, ProgressBar& bar, Stopwatch& watch,
                  ContourInput& result) const;
  /// Reads FILE as a mesh of cells, and contours it.
  [[nodiscard]] ContourInput read_mesh_contour(ProgressBar& bar);

  ExtractionOptions options_;
  const AttributeOptions* attributes_of_meshes_ = nullptr;
};

/// World coordinates of the first and the last sample on the last axis; none if the world map mixes it with other axes.
std::pair<std::optional<double>, std::optional<double>> ends_of_last_axis(const AnyImage& image);

/// Throws InvalidArgument if options in `refused`, or those of images, are given with a saved contour, which they
/// cannot change; or if it is one of several `files`. `expected`: the allowed options, for the message.
void refuse_image_options(const std::vector<std::string>& files, std::vector<std::string> refused,
                          const ImageOptions& images, const std::string& expected);

}  // namespace tegl::cli
