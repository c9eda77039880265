// SPDX-License-Identifier: BSD-3-Clause
//
// What the emitters of several languages share: names and the banner.
#pragma once

#include <cctype>
#include <iterator>
#include <string>

#include <fmt/format.h>

#include "tegl/gen/emit.hpp"

namespace tegl::gen {

using Out = std::back_insert_iterator<std::string>;

inline std::string upper_camel(const char* name) {
  std::string result(name);
  result[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(result[0])));
  return result;
}

/// The generated-file banner in `//` comments: command, licence, `what`, and the certificate.
std::string banner(const TableSet& set, Language language, const std::string& what);

/// The command that writes this language, for banners: the C++ one is the command's default.
std::string command_for(const TableSet& set, Language language);

}  // namespace tegl::gen
