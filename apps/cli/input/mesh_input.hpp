// SPDX-License-Identifier: BSD-3-Clause
//
// FILE as a mesh of cells (.vtu, .vts, and .pvd of them), for the commands that contour images.
#pragma once

#include <string>
#include <vector>

#include "input/extraction.hpp"
#include "input/image_input.hpp"
#include "tegl/io/cell_meshes.hpp"

namespace tegl::cli {

/// Why simplices of contours of meshes have zero size, for reports.
inline constexpr const char* kNoSizeInMeshes =
    "samples equal the isovalue, which --epsilon avoids, or cells of the mesh are flat";

/// Whether the files are meshes of cells, by the first one.
bool are_cell_meshes(const std::vector<std::string>& files, const ImageOptions& images);

/// Throws InvalidArgument, with the option's name, for options that are for images only: of the extraction, of reading,
/// and `others` that were given.
void refuse_options_of_images(const std::string& file, const ExtractionOptions& extraction, const ImageOptions& images,
                              const std::vector<std::string>& others = {});

/// A mesh to be contoured.
struct MeshInput {
  CellMesh mesh;
  AnyComplex complex;
  [[nodiscard]] int space_dim() const { return mesh.dim + (is_moving() ? 1 : 0); }
  [[nodiscard]] bool is_moving() const { return mesh.times.size() > 1; }
};

/// The space of the mesh. The extents of its axes are the ranges of its points' coordinates, then of its times.
CutSpace space_of(const MeshInput& input);

/// Reads the files, without a complex.
MeshInput read_cells(const std::vector<std::string>& files, const ImageOptions& images, const Progress& progress);
/// Makes the complex.
void make_complex(MeshInput& input);
/// Reads the files and makes a complex of them, with its edges if there are `several` isovalues.
MeshInput read_mesh_input(const std::vector<std::string>& files, const ImageOptions& images, const Progress& progress,
                          bool several);

/// Drops the times of a moving mesh that slices at times from `first` to `last` do not depend on. Other times remain:
/// the ends of the intervals of these times, and one more on each side, for gradients.
void keep_times(CellMesh& mesh, double first, double last);

/// Throws EmptyResult unless the values have both sides of the isovalue, or `allow_empty`; InvalidArgument for a rule
/// other than low if no cell can be ambiguous.
void require_mesh_contour(const CellMesh& mesh, double isovalue, bool allow_empty, Ambiguity ambiguity);

/// The remark about an empty contour: empty if all values are on one side of the isovalue, which was allowed; else that
/// no cell without missing values has some on both sides.
std::string remark_without_contour(const CellMesh& mesh, double isovalue);

/// Extracts the contour and passes it to `use`, as Extraction<N, float> or Extraction<N, double>.
template <class Result, class Use>
Result extract_mesh_and_use(const MeshInput& input, double isovalue, const ExtractOptions& options,
                            bool single_precision, const Use& use) {
  const auto named = [&]<int N, class Real>(Extraction<N, Real> extraction) -> Result {
    auto& names = extraction.contour.axis_names;
    for (std::size_t a = 0; a < N; ++a)
      names[a] = a < input.mesh.axis_names.size() ? input.mesh.axis_names[a] : std::string("t");
    return use(std::move(extraction));
  };
  const auto of_complex = [&](const auto& complex) -> Result {
    if (single_precision) return named(extract_with_stats<float>(complex, isovalue, options));
    return named(extract_with_stats<double>(complex, isovalue, options));
  };
  return std::visit(of_complex, input.complex);
}

}  // namespace tegl::cli
