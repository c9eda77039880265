// SPDX-License-Identifier: BSD-3-Clause
//
// The FILE of commands that work on contours: an image, which is contoured first, or a contour that `tegl contour`
// saved.
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
#include "tegl/io.hpp"

namespace tegl::cli {

/// A contour in 2, 3 or 4 dimensions.
using AnyContour = std::variant<Contour<2, double>, Contour<3, double>, Contour<4, double>>;

/// The contour of a mesh. Throws UnsupportedData unless its simplices are segments in the plane, triangles in space or
/// tetrahedra in 4-space.
AnyContour to_any_contour(const Mesh& mesh);

/// A mesh that is to be worked on or checked. Throws MalformedFile if a coordinate is infinite or no number, and what
/// `read_mesh` throws.
Mesh read_finite_mesh(const std::string& file, const ReadMeshOptions& options);

/// The same of a contour with simplices. Throws EmptyResult if there are none, unless `allow_empty`.
Mesh read_saved_contour(const std::string& file, const ReadMeshOptions& options, bool allow_empty);

/// A contour to work on, and where it came from.
struct ContourInput {
  AnyContour contour;
  InputFiles file;
  std::string variable;                  ///< netCDF: the variable read
  std::optional<double> isovalue;        ///< none for a saved contour that does not say
  std::optional<ExtractStats> stats;     ///< none for a saved contour
  std::optional<ReadImageResult> image;  ///< where it was asked for, and FILE is one
  std::optional<CutAxis> last_axis;      ///< its extent in an image; none for a saved contour
  bool single_precision = false;         ///< all coordinates are those of --precision float
  StageSeconds seconds;                  ///< of reading and contouring

  /// 2, 3 or 4: the dimension of the space that the contour lies in.
  [[nodiscard]] int space_dim() const { return static_cast<int>(contour.index()) + 2; }
  [[nodiscard]] MeshSize size() const;
  /// The name of an axis of the contour, or its customary letter; and its unit, which may be empty.
  [[nodiscard]] std::string axis_name(int axis) const;
  [[nodiscard]] std::string axis_unit(int axis) const;

  /// What a report says of where a result came from; mesh, output, check and the stages after the contour are left to
  /// the caller.
  [[nodiscard]] ContourResult to_result() const;
};

/// Sets the keys "input", "variable", "image_dim" and "isovalue".
void add_input_keys(Json& json, const ContourInput& input);

/// The lines of a report on the input: the file, the isovalue if it has one, the size of the contour.
std::string input_text(const ContourInput& input);

/// The mesh of a contour that has vertices of the input's and no others, with its isovalue.
template <int N, class Real>
Mesh mesh_of(const Contour<N, Real>& contour, const ContourInput& input) {
  Mesh mesh = to_mesh(contour);
  mesh.isovalue = input.isovalue;
  mesh.single_precision = input.single_precision;
  return mesh;
}

/// A command whose FILE is an image (with --iso and the other options of the extraction, and --var) or a saved contour
/// (without any of them but --threads).
class ContourInputCommand : public Command {
 protected:
  /// Adds FILE, --json, --quiet, and the options of images and of the extraction.
  ContourInputCommand(CLI::App& program, const std::string& name, const std::string& description,
                      Files files = Files::image);

  /// --threads: 0 for all that the machine has.
  [[nodiscard]] unsigned threads() const { return options_.threads(); }

  /// The kind that --normals asks for; empty: none.
  [[nodiscard]] const std::string& normals() const { return options_.normals(); }
  /// Whether a value outside of the data gives an empty result (--allow-empty).
  [[nodiscard]] bool allows_empty() const { return options_.allows_empty(); }

  /// Reads FILE, and contours it if it is an image, which is kept if `keep_image`. Throws InvalidArgument if --iso is
  /// missing for an image, or options of images are given with a saved contour; EmptyResult if the isovalue is outside
  /// of the data or the saved contour empty, unless --allow-empty is given; and what the readers throw.
  [[nodiscard]] ContourInput read_contour(ProgressBar& bar, bool keep_image = false);

 private:
  ExtractionOptions options_;
};

/// World coordinates of the first and the last sample of the last axis; none where the world map mixes it with others.
std::pair<std::optional<double>, std::optional<double>> ends_of_last_axis(const AnyImage& image);

/// Throws InvalidArgument, naming them, if any of the options `refused` or those of images go with a saved contour,
/// which they cannot change; or if it is one of several `files`. `expected`: the options that would do, for the
/// message.
void refuse_image_options(const std::vector<std::string>& files, std::vector<std::string> refused,
                          const ImageOptions& images, const std::string& expected);

}  // namespace tegl::cli
