// SPDX-License-Identifier: BSD-3-Clause
//
// The names of the languages.
#include "tables/language.hpp"

namespace tegl::gen {

const char* language_name(Language l) noexcept {
  switch (l) {
    case Language::cpp:
      return "cpp";
    case Language::json:
      return "json";
    case Language::glsl:
      return "glsl";
    case Language::wgsl:
      return "wgsl";
    case Language::cuda:
      return "cuda";
  }
  return "unknown";
}

}  // namespace tegl::gen
