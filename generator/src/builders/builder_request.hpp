// SPDX-License-Identifier: BSD-3-Clause
//
// What `gen --builder` emits: arguments of the emitters of builders.
#pragma once

#include <string>
#include <vector>

#include "tables/language.hpp"
#include "tegl/tile/triangulation.hpp"

namespace tegl::gen {

/// How a builder obtains the contours of the faces of its tile.
enum class Leaf {
  table,  ///< from a table, in the highest dimension that has one
  edges,  ///< by recursion down to the edges: slow, the specification itself
};
const char* leaf_name(Leaf leaf) noexcept;  ///< "table", "edges"

/// Arguments of emit_builder.
struct BuilderRequest {
  int dim = 0;                                           ///< dimension of the tile, 2 to 5
  Leaf leaf = Leaf::table;                               ///< contours of the faces
  std::vector<Language> languages{Language::cpp};        ///< cpp; for dim 2 and 3 also glsl and wgsl
  Triangulation triangulation = Triangulation::compact;  ///< dim 3: of polygons; squares have none
};

/// The sources of one builder.
struct BuilderTexts {
  std::vector<EmittedFile> files;  ///< of all languages of the request; for C++ the header, then the source
  std::string certificate;         ///< the certificate in words, without a period; also in the banner of each file
};

/// Name of a builder's files without suffix: "builder3", followed by "_barycentric" and by "_edges" for Leaf::edges.
std::string builder_name(const BuilderRequest& request);

/// Namespace of a builder within tegl: "builders", followed by "::edges" for Leaf::edges and by "::barycentric". So a
/// program can have all of them.
std::string builder_namespace(const BuilderRequest& request);

/// The command line that writes `language`.
std::string builder_command(const BuilderRequest& request, Language language);

/// The banner of a file in `//` comments: command, licence, `what` and the certificate, each ending with a new line.
std::string builder_banner(const BuilderRequest& request, Language language, const std::string& what,
                           const std::string& certificate);

}  // namespace tegl::gen
