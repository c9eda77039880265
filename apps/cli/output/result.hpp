// SPDX-License-Identifier: BSD-3-Clause
//
// What a command found and did, as text for people and as JSON for machines. docs/command-line.md lists the keys.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/console.hpp"
#include "base/exit_codes.hpp"
#include "output/lost_vertices.hpp"
#include "tegl/check.hpp"
#include "tegl/extract.hpp"
#include "tegl/io.hpp"

namespace tegl::cli {

/// JSON whose keys stay in the order in which they are set.
using Json = nlohmann::ordered_json;

/// A line of a report, made printable: "  label        value".
std::string report_line(std::string_view label, std::string_view value);
std::string report_line(std::string_view label, const Styled& value);

/// The name of an axis, or the customary letter x, y, z, t for one without.
std::string axis_label(const std::string& name, std::size_t axis);

/// Which of the axes has that name (any case), or that customary letter if none has it; labels.size() if none.
std::size_t axis_called(const std::string& name, const std::vector<std::string>& labels);

/// The document as text with a newline at its end. Bytes that are no UTF-8 (units in old files) are replaced; control
/// characters, and those that change the direction of text, are escaped.
std::string dump(const Json& json);

/// The file that a result was made of, or the files that were read as one image.
struct InputFiles {
  std::vector<std::string> names;

  /// "a.nrrd", or "a.nrrd .. z.nrrd (26 files)".
  [[nodiscard]] std::string text() const;
  /// A string, or a list of them.
  [[nodiscard]] Json json() const;
};

/// The line of a report that says what was read.
std::string input_line(const InputFiles& input, const std::string& variable);

/// How large a mesh is.
struct MeshSize {
  int dim = 0;  ///< of the simplices
  std::uint64_t vertices = 0;
  std::uint64_t simplices = 0;
};
MeshSize size_of(const Mesh& mesh);

/// Adds the eleven keys of a mesh check; all but the sizes are null without a report.
void add_check_keys(Json& json, const MeshSize& size, const std::optional<MeshReport>& report);

/// True when the complex is no oriented manifold, or has vertices at no finite place. A border is no fault, nor are
/// simplices of zero size.
bool has_faults(const MeshReport& report);

/// What reports say of results that are no plain contours.
struct Wording {
  std::string heading;                                                              ///< empty: "Contour in 3D"
  std::string unchecked = "left out";                                               ///< without a check
  std::string no_size = "where samples equal the isovalue, --epsilon avoids them";  ///< why simplices may have none
  std::string open;  ///< why there may be a border; empty: nothing is said
};

/// The lines of a mesh check: sizes, components, border, verdict.
std::string check_text(const Console& console, const MeshSize& size, const std::optional<MeshReport>& report,
                       const Wording& wording = {});

/// "segments", "triangles", "tetrahedra" for simplices of dimension 1, 2, 3; the singular for a count of 1.
std::string counted_simplices(int dim, std::uint64_t count);

/// Checks a mesh (tegl/check.hpp).
MeshReport check_mesh(const Mesh& mesh, const Progress& progress);

/// A hyperplane's coordinates, as `frame_of` has them.
struct CutFrame {
  std::vector<double> origin;
  std::vector<std::vector<double>> axes;
};

/// Where a cut was made: an axis, or a formula of several, and the value as a number and as it was typed.
struct Cut {
  std::string axis;
  double value = 0;
  std::string text;
  std::vector<double> normal;     ///< of the hyperplane <normal, x> = value
  std::optional<int> across;      ///< the axis, if it is one
  std::optional<CutFrame> frame;  ///< of others, where it is known
  std::optional<double> level;    ///< where to cut instead of at `value`: where the vertices are that it means
  bool is_outside = false;        ///< of what is cut
};

/// What --pick found.
struct Picked {
  std::vector<double> point;
  std::vector<std::size_t> tile;  ///< index of the nearest active tile
  double distance = 0;            ///< to it, in steps of the grid
  std::uint64_t tiles = 0;        ///< reached from it
  std::uint64_t components = 0;   ///< in those
};

/// Wall-clock seconds of each stage; what did not happen took 0.
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

/// A contour, or a cut of one, made and written.
struct ContourResult {
  InputFiles input;
  std::string variable;
  std::string output;
  std::uint64_t output_bytes = 0;
  int image_dim = 0;
  std::optional<double> isovalue;  ///< none for saved contours that do not say, and for several
  std::vector<double> isovalues;   ///< of several contours in one
  std::optional<Cut> cut;
  std::optional<Picked> picked;
  std::optional<ExtractStats> stats;  ///< none for cuts of a saved contour, and for picks
  std::optional<MeshReport> report;   ///< none with --no-check
  Mesh mesh;
  std::optional<MeshSize> streamed;             ///< for what went to the file without being in memory
  LostVertices lost;                            ///< in the file
  Compression compression = Compression::none;  ///< of the file
  StageSeconds seconds;
  Wording wording;

  [[nodiscard]] MeshSize size() const { return streamed ? *streamed : size_of(mesh); }
  [[nodiscard]] ExitCode exit_code() const { return report && has_faults(*report) ? ExitCode::Faults : ExitCode::Ok; }
};

Json to_json(const ContourResult& result);
std::string to_text(const Console& console, const ContourResult& result);

}  // namespace tegl::cli
