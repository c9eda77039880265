// SPDX-License-Identifier: BSD-3-Clause
//
// Implements checks and reports of images as results.
#include "output/image_result.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/numbers.hpp"

namespace tegl::cli {

void require_image_output(const std::string& output, const std::vector<std::string>& inputs) {
  require_text_output(output, inputs);
  if (is_image_output(output)) return;
  const std::string extension = std::filesystem::path(output).extension().string();
  throw Error(ErrorCode::WriteFailed,
              fmt::format("{}: {}; expected {}", output,
                          extension.empty() ? "the name has no extension"
                                            : fmt::format("the extension '{}' is not known", extension),
                          kImageFiles));
}

void add_threads_option(CLI::App& app, unsigned& threads) {
  app.add_option("--threads", threads, "number of threads; 0: all processors")
      ->type_name("COUNT")
      ->check(whole_number(0, 4096))
      ->capture_default_str();
}

void ImageResult::report(const Console& console, bool as_json, bool quiet) const {
  if (as_json)
    console.write(dump(json()));
  else if (!quiet)
    console.write(text(console));
}

Json ImageResult::json() const {
  Json json;
  json["input"] = input.names.empty() ? Json(nullptr) : input.json();
  json["variable"] = variable.empty() ? Json(nullptr) : Json(variable);
  json["kind"] = what;
  json["output"] = output;
  json["image_dim"] = sizes.size();
  json["sizes"] = sizes;
  json["value_type"] = name_of(type);
  for (const auto& [key, value] : more.items()) json[key] = value;
  json["output_bytes"] = output_bytes;
  json["seconds"] = {{"read", read_seconds},
                     {"make", make_seconds},
                     {"write", write_seconds},
                     {"total", read_seconds + make_seconds + write_seconds}};
  return json;
}

std::string ImageResult::text(const Console& console) const {
  std::string text = fmt::format("{}\n", console.bold(heading));
  if (!variable.empty()) text += report_line("variable", variable);
  for (const auto& [label, value] : lines) text += report_line(label, value);
  text += report_line("image", fmt::format("{} samples, {}", fmt::join(sizes, " x "), name_of(type)));
  text += report_line("output", fmt::format("{}, {}", output, byte_size(output_bytes)));
  return text + report_line("seconds", fmt::format("{:.3f} = read {:.3f} + make {:.3f} + write {:.3f}",
                                                   read_seconds + make_seconds + write_seconds, read_seconds,
                                                   make_seconds, write_seconds));
}

}  // namespace tegl::cli
