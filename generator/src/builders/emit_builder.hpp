// SPDX-License-Identifier: BSD-3-Clause
//
// Emits the builders of tiles as source text. The text depends only on the request.
//
// Based on: M. Liversage, thesis, 1994, sections 7.6 and 10.5.5 (recursion over dimension, generated code).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "builders/builder_request.hpp"

namespace tegl::gen {

/// Certifies and emits the builder of a dimension in the requested languages; the last file is the manifest,
/// `builderN_manifest.json`: the command, the certificate, and size and digest of each text. Errors: InvalidArgument
/// for a dimension or language without a builder, CertificateFailed.
[[nodiscard]] std::vector<EmittedFile> emit_builder(const BuilderRequest& request);
/// The manifest of a builder, with the texts of an earlier manifest of the same builder that are not in it: those in
/// other languages. `read(name)`: the content of a file beside the earlier manifest, "" if there is none. A text is
/// kept if its size and digest are still right. C++ comes first, then GLSL, WGSL.
[[nodiscard]] std::string with_earlier_texts(const std::string& manifest, const std::string& earlier,
                                             const std::function<std::string(const std::string&)>& read);
/// The same as emit_builder without the manifest, with the certificate in words.
[[nodiscard]] BuilderTexts emit_builder_texts(const BuilderRequest& request);

/// The builder of the square.
[[nodiscard]] BuilderTexts emit_square_builder(const BuilderRequest& request);
/// The builder of the cube.
[[nodiscard]] BuilderTexts emit_cube_builder(const BuilderRequest& request);
/// The builder of the 5-cube.
[[nodiscard]] BuilderTexts emit_five_cube_builder(const BuilderRequest& request);
/// The builder of the tesseract. Its third file has the arrays.
[[nodiscard]] BuilderTexts emit_tesseract_builder(const BuilderRequest& request);

}  // namespace tegl::gen
