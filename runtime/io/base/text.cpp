// SPDX-License-Identifier: BSD-3-Clause
//
// Implements the writing of text files.
#include "base/text.hpp"

#include "base/output_file.hpp"
#include "base/pending_path.hpp"
#include "tegl/io/text.hpp"

namespace tegl {

void write_text(std::string_view text, const PendingPath& file) {
  io_detail::OutputFile output(file);
  output.write(text);
  output.close();
}

void write_text(std::string_view text, const std::filesystem::path& path) {
  write_complete_file(path, [&](const PendingPath& file) { write_text(text, file); });
}

}  // namespace tegl
