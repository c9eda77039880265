// SPDX-License-Identifier: BSD-3-Clause
//
// The languages that tables are written in, and the files that come of it.
#pragma once

#include <string>

namespace tegl::gen {

/// What the tables are written in.
enum class Language { cpp, json, glsl, wgsl, cuda };
/// All of them.
inline constexpr Language kLanguages[] = {Language::cpp, Language::json, Language::glsl, Language::wgsl,
                                          Language::cuda};
const char* language_name(Language l) noexcept;  ///< "cpp", "json", "glsl", "wgsl", "cuda"

/// A file to be written.
struct EmittedFile {
  std::string name;  ///< relative to the output folder
  std::string text;  ///< bytes, for files of packed words
};

}  // namespace tegl::gen
