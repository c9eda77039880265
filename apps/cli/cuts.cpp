// SPDX-License-Identifier: BSD-3-Clause
#include "cuts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "numbers.hpp"

namespace tegl::cli {

std::vector<Cut> parse_cuts(const std::vector<std::string>& at) {
  std::vector<Cut> cuts;
  for (const std::string& argument : at) {
    const std::size_t equals = argument.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("--at is '{}'; expected an axis and a number, as in t=7.3", argument));
    }
    std::string_view values = std::string_view(argument).substr(equals + 1);
    while (true) {
      const std::size_t comma = values.find(',');
      const std::string_view text = values.substr(0, comma);
      cuts.push_back(
          {argument.substr(0, equals), parse_finite(fmt::format("--at {}", argument), text), std::string(text)});
      if (comma == std::string_view::npos) break;
      values.remove_prefix(comma + 1);
    }
  }
  return cuts;
}

std::vector<std::string> cut_outputs(const std::string& pattern, const std::vector<Cut>& cuts) {
  std::vector<std::string> outputs;
  for (const Cut& cut : cuts) {
    std::string output = pattern;
    for (const std::string& placeholder : {std::string("{t}"), "{" + cut.axis + "}"}) {
      for (auto at = output.find(placeholder); at != std::string::npos; at = output.find(placeholder, at)) {
        output.replace(at, placeholder.size(), cut.text);
        at += cut.text.size();
      }
    }
    if (std::find(outputs.begin(), outputs.end(), output) != outputs.end()) {
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("--output is '{}' for two cuts; expected {{t}} in it, and each cut once", output));
    }
    outputs.push_back(output);
  }
  return outputs;
}

}  // namespace tegl::cli
