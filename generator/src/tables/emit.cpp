// SPDX-License-Identifier: BSD-3-Clause
//
// Selects the emitter of a language.
#include "tables/emit.hpp"

namespace tegl::gen {

std::vector<EmittedFile> emit(const TableSet& set, Language language) {
  switch (language) {
    case Language::cpp: {
      auto files = emit_cpp(set);
      files.push_back(emit_manifest(set));
      return files;
    }
    case Language::json:
      return emit_json(set);
    case Language::glsl:
    case Language::wgsl:
    case Language::cuda:
      return emit_packed(set, language);
  }
  return {};
}

}  // namespace tegl::gen
