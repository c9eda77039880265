// SPDX-License-Identifier: BSD-3-Clause
//
// Resolves paths that files name, and checks that they stay in the folder of the file.
#include "base/named_path.hpp"

#include <algorithm>
#include <system_error>

#include "base/common.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

/// The path without `..` and symbolic links.
fs::path resolved(const fs::path& path, const fs::path& header) {
  std::error_code error;
  fs::path result = fs::absolute(path, error);
  if (!error) result = fs::weakly_canonical(result, error);
  if (error)
    fail(ErrorCode::FileNotFound, header, "names {}, which cannot be resolved ({})", shown(path.string()),
         error.message());
  return result;
}

}  // namespace

fs::path named_path(const fs::path& header, const std::string& name, bool allow_outside) {
  constexpr std::size_t kLongest = 4096;  // PATH_MAX of Linux
  if (name.size() > kLongest || name.find('\0') != std::string::npos)
    fail(ErrorCode::MalformedFile, header, "names the file {} of {} bytes; expected at most {}, none of them 0",
         shown(name), name.size(), kLongest);
  fs::path path = header.parent_path() / name;
  if (allow_outside) return path;
  const fs::path folder = resolved(header.has_parent_path() ? header.parent_path() : fs::path("."), header);
  const fs::path target = resolved(path, header);
  if (std::mismatch(folder.begin(), folder.end(), target.begin(), target.end()).first != folder.end())
    fail(ErrorCode::UnsupportedData, header,
         "names the file '{}', which is '{}', outside of the folder '{}'; expected a file there or below it, or the "
         "option allow_outside_paths (--allow-outside-paths)",
         name, target.string(), folder.string());
  return path;
}

}  // namespace tegl::io_detail
