// SPDX-License-Identifier: BSD-3-Clause
//
// Emits the builder of the 5-cube, which fills ten tesseracts and then the components of their contours.
#include <fmt/format.h>

#include <cstdint>
#include <string>

#include "base/error.hpp"
#include "builders/emit_builder.hpp"
#include "builders/five_cube_faces.hpp"
#include "builders/templates.hpp"

namespace tegl::gen {

BuilderTexts emit_five_cube_builder(const BuilderRequest& request) {
  BuilderTexts texts;
  certify_five_cube_faces();
  texts.certificate =
      "faces and incidence signs against the lattice of the 5-cube. "
      "Embedded: cones that hyperplanes divide are proved, other fillings are neither proved nor searched";
  const std::string name = builder_name(request), space = builder_namespace(request);
  const BuilderRequest faces{.dim = 4, .leaf = request.leaf};
  const auto banner = [&](const char* what) { return builder_banner(request, Language::cpp, what, texts.certificate); };
  const std::string what = banner("The contour in one 5-cube, a cell of a 5D image.");
  texts.files.push_back(
      {name + ".hpp",
       filled("builder5.hpp", {{"banner", what}, {"builder4", builder_name(faces)}, {"namespace", space}})});
  texts.files.push_back(
      {name + ".cpp", filled("builder5.cpp", {{"banner", what},
                                              {"name", name},
                                              {"namespace", space},
                                              {"reads_table", request.leaf == Leaf::table ? "true" : "false"},
                                              {"faces", five_cube_faces()}})});
  return texts;
}

}  // namespace tegl::gen
