// SPDX-License-Identifier: BSD-3-Clause
//
// Reports of a command's result, as text and as JSON. docs/command-line.md lists the keys.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/console.hpp"
#include "base/exit_codes.hpp"
#include "output/lost_vertices.hpp"
#include "output/merge_summary.hpp"
#include "tegl/check.hpp"
#include "tegl/extract.hpp"
#include "tegl/io/meshes.hpp"

namespace tegl::cli {

/// JSON that keeps the order of keys.
using Json = nlohmann::ordered_json;

/// A line of a report, made printable: "  label        value".
std::string report_line(std::string_view label, std::string_view value);
std::string report_line(std::string_view label, const Styled& value);

/// The name of an axis, or the customary letter x, y, z, t for an unnamed one.
std::string axis_label(const std::string& name, std::size_t axis);

/// The index of the axis with that name (ignoring case), or with that customary letter if no name matches and the axis
/// is not named by another letter; labels.size() if there is none.
std::size_t axis_called(const std::string& name, const std::vector<std::string>& labels);

/// Formats a document, with a newline at the end. Invalid UTF-8 (units in old files) is replaced; control characters
/// and characters that change the text direction are escaped.
std::string dump(const Json& json);

/// The input file of a result, or the files that were read as one image.
struct InputFiles {
  std::vector<std::string> names;

  /// "a.nrrd", or "a.nrrd .. z.nrrd (26 files)".
  [[nodiscard]] std::string text() const;
  /// A string, or a list of strings.
  [[nodiscard]] Json json() const;
};

/// The line of a report about the input.
std::string input_line(const InputFiles& input, const std::string& variable);

/// Size of a mesh.
struct MeshSize {
  int dim = 0;  ///< dimension of the simplices
  std::uint64_t vertices = 0;
  std::uint64_t simplices = 0;
};
MeshSize size_of(const Mesh& mesh);

/// Adds the eleven keys of a mesh check; without a report all except the sizes are null.
void add_check_keys(Json& json, const MeshSize& size, const std::optional<MeshReport>& report);

/// Whether the complex is not an oriented manifold, or has non-finite vertices. A boundary is no fault, nor are
/// simplices of zero size.
bool has_faults(const MeshReport& report);

/// Texts of reports about results that are not plain contours.
struct Wording {
  std::string heading;                                                        ///< empty: "Contour in 3D"
  std::string unchecked = "skipped";                                          ///< if there was no check
  std::string no_size = "samples equal the isovalue; --epsilon avoids them";  ///< reason for zero sizes
  std::string open;  ///< why there may be a boundary; empty: no reason is given
};

/// The lines of a mesh check: sizes, components, boundary, result.
std::string check_text(const Console& console, const MeshSize& size, const std::optional<MeshReport>& report,
                       const Wording& wording = {});

/// "segments", "triangles", "tetrahedra" for simplices of dimension 1, 2, 3; the singular for a count of 1.
std::string counted_simplices(int dim, std::uint64_t count);

/// Checks a mesh (tegl/check.hpp).
MeshReport check_mesh(const Mesh& mesh, const WorkOptions& work);

/// The frame of a hyperplane, as from `frame_of`.
struct CutFrame {
  std::vector<double> origin;
  std::vector<std::vector<double>> axes;
};

/// The place of a cut: an axis or a formula, and the value as a number and as typed.
struct Cut {
  std::string axis;
  double value = 0;
  std::string text;
  std::vector<double> normal;     ///< of the hyperplane <normal, x> = value
  std::optional<int> across;      ///< the axis, for a cut across one
  std::optional<CutFrame> frame;  ///< for other cuts, if known
  std::optional<double> level;    ///< replaces `value` if it means vertices at this coordinate
  bool is_outside = false;        ///< outside of the data
};

/// The result of --pick.
struct Picked {
  std::vector<double> point;
  std::vector<std::size_t> tile = {};   ///< index of the nearest active tile; empty if the whole contour was made
  std::optional<double> distance = {};  ///< distance to the tile, or to the nearest vertex; none if there is none
  std::uint64_t tiles = 0;              ///< tiles reached from it
  std::uint64_t components = 0;         ///< components in those tiles, or of the whole contour
  bool is_in_world = false;             ///< whether `distance` is in the world, not in grid steps
};

/// Wall-clock seconds of each stage; 0 for stages that were not run.
struct StageSeconds {
  double read = 0;
  double classify = 0;
  double find = 0;
  double generate = 0;
  double close = 0;
  double slice = 0;
  double check = 0;
  double write = 0;

  void add(const ExtractStats& stats);
  [[nodiscard]] double total() const { return read + classify + find + generate + close + slice + check + write; }
};

/// A contour or a cut that was made and written.
struct ContourResult {
  InputFiles input;
  std::string variable;
  std::string output;
  std::uint64_t output_bytes = 0;
  int image_dim = 0;
  std::optional<double> isovalue;  ///< none for saved contours without it, and for several isovalues
  double isovalue_of_samples = 0;  ///< of an image that may have stored integers (ImageInfo::scaling)
  std::vector<double> isovalues;   ///< for several contours in one file
  std::optional<Cut> cut;
  std::optional<Picked> picked;
  std::optional<ExtractStats> stats;               ///< none for cuts of a saved contour, and for picks
  std::optional<double> label = {};                ///< whose samples are contoured (--label)
  std::optional<std::uint64_t> folded_cells = {};  ///< of a curved grid
  std::optional<MeshReport> report;                ///< none with --no-check
  std::optional<MergeSummary> merging;             ///< of --merge
  Mesh mesh;
  std::optional<MeshSize> streamed;             ///< for contours that were written without being in memory
  LostVertices lost;                            ///< vertices that coincide in the file
  Compression compression = Compression::none;  ///< of the file
  StageSeconds seconds;
  Wording wording;

  [[nodiscard]] MeshSize size() const { return streamed ? *streamed : size_of(mesh); }
  /// Pinches are no fault if vertices were merged on request.
  [[nodiscard]] ExitCode exit_code() const {
    if (!report) return ExitCode::Ok;
    MeshReport faults = *report;
    if (merging) faults.nonmanifold_simplices = faults.bad_links = 0;
    return has_faults(faults) ? ExitCode::Faults : ExitCode::Ok;
  }
};

Json to_json(const ContourResult& result);
std::string to_text(const Console& console, const ContourResult& result);

}  // namespace tegl::cli
