// SPDX-License-Identifier: BSD-3-Clause
//
// The output languages of tables, and emitted files.
#pragma once

#include <string>

namespace tegl::gen {

/// Output language of tables.
enum class Language { cpp, json, glsl, wgsl, cuda };
/// All languages.
inline constexpr Language kLanguages[] = {Language::cpp, Language::json, Language::glsl, Language::wgsl,
                                          Language::cuda};
const char* language_name(Language l) noexcept;  ///< "cpp", "json", "glsl", "wgsl", "cuda"

/// A file to be written.
struct EmittedFile {
  std::string name;  ///< relative to the output folder
  std::string text;  ///< text, or bytes for files of packed words
};

}  // namespace tegl::gen
