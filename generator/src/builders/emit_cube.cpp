// SPDX-License-Identifier: BSD-3-Clause
//
// Emits the builder of the cube.
#include "base/error.hpp"
#include "builders/emit_builder.hpp"

namespace tegl::gen {

BuilderTexts emit_cube_builder(const BuilderRequest&) {
  throw Error(ErrorCode::InvalidArgument, "--dim 3: --builder does not emit this dimension yet; expected 2");
}

}  // namespace tegl::gen
