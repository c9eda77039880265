// SPDX-License-Identifier: BSD-3-Clause
//
// Contours as facets: `tegl contour --facets`, which writes them without triangulation, and contours of 3D images with
// triangulated polygons.
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "base/progress.hpp"
#include "input/extraction.hpp"
#include "input/mesh_input.hpp"
#include "output/output.hpp"
#include "output/result.hpp"
#include "tegl/facet_hierarchy.hpp"
#include "tegl/io/images.hpp"
#include "tegl/io/write_options.hpp"
#include "tegl/lattice.hpp"
#include "tegl/polygons.hpp"

namespace tegl::cli {

inline constexpr const char* kFacets = "--facets";

/// Facets that were extracted and written.
struct FacetsResult {
  InputFiles input;
  std::string variable;
  std::string output;
  std::uint64_t output_bytes = 0;
  int image_dim = 0;
  double isovalue = 0;
  ExtractStats stats;
  std::array<std::uint64_t, 4> facets{};  ///< by dimension
  std::optional<FacetReport> report;      ///< none with --no-check
  StageSeconds seconds;

  [[nodiscard]] ExitCode exit_code() const {
    return report && report->branching + report->conflicts + report->open_boundaries > 0 ? ExitCode::Faults
                                                                                         : ExitCode::Ok;
  }
};

Json to_json(const FacetsResult& result);
std::string to_text(const Console& console, const FacetsResult& result);

/// Throws WriteFailed unless the file can hold facets: .vtu or .vtkhdf. The second function also checks the image's
/// dimension, once that is known.
void require_facets_output(const std::filesystem::path& output, const std::vector<std::string>& inputs);
void require_output_holds_facets(const std::filesystem::path& output, int image_dim);

/// Throws InvalidArgument for options of the extraction that facets do not have.
void refuse_with_facets(const ExtractionOptions& extraction, bool is_streamed, bool has_attributes);

/// How contours are extracted and written.
struct FacetsWork {
  double isovalue = 0;
  ExtractOptions options;
  bool single_precision = false;
  bool no_check = false;
  Compression compression = Compression::none;
  std::vector<std::string> periodic = {};  ///< the axes of --periodic
  bool allows_empty = false;               ///< of meshes
  std::optional<Lattice> lattice = {};     ///< on which the samples of an image are
  std::optional<Division> division = {};   ///< of an image's cells
};

/// Extracts the facets of an image at the isovalues of the results, checks them and writes them to the results'
/// outputs, which are `written`; fills the rest of the results. `work.isovalue` is not read.
void write_image_facets(const AnyImage& image, const FacetsWork& work, ProgressBar& bar,
                        std::vector<FacetsResult>& results, WrittenFiles& written);

/// The same for a mesh of cells, which was read in this time, and several isovalues with a file for each. Throws
/// WriteFailed for 4D facets and a file that cannot hold them, and EmptyResult.
std::vector<FacetsResult> write_mesh_facets(const MeshInput& input, const InputFiles& files, double read_seconds,
                                            const std::vector<SpelledNumber>& isovalues,
                                            const std::vector<std::string>& outputs, FacetsWork work, ProgressBar& bar);

/// The contour of a 3D image, triangulated from its polygons. Throws InvalidArgument for images of other dimensions.
std::variant<Extraction<3, float>, Extraction<3, double>> triangulated_polygons(const AnyImage& image,
                                                                                const FacetsWork& work,
                                                                                PolygonTriangulation method,
                                                                                ProgressBar& bar);

}  // namespace tegl::cli
