// SPDX-License-Identifier: BSD-3-Clause
//
// Reads collections of files over time.
#include "vtk/pvd.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/common.hpp"
#include "base/named_path.hpp"
#include "vtk/xml_file.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

bool is_pvd(const fs::path& path) { return lower_name(path).ends_with(".pvd"); }

std::vector<PvdStep> read_pvd(const fs::path& path, bool allow_outside_paths) {
  require_readable_file(path);
  const XmlFile xml = parse_xml(path, "AppendedData", {});
  const XmlElement* const collection = xml.root.child("Collection");
  if (xml.root.name != "VTKFile" || collection == nullptr)
    fail(ErrorCode::MalformedFile, path, "a file of <{}> without <Collection>; expected <VTKFile> with it",
         xml.root.name);
  std::vector<PvdStep> steps;
  for (const XmlElement& element : collection->children) {
    if (element.name != "DataSet") continue;
    const auto require_given = [&](std::string_view key, std::string_view expected) {
      if (!element.attributes.contains(key))
        fail(ErrorCode::MalformedFile, path, "<DataSet> has no {}; expected {}", key, expected);
    };
    require_given("timestep", "one that is a finite number");
    require_given("file", "the name of a file");
    PvdStep step;
    const std::string_view time = element.attribute("timestep");
    if (!parse_number(trim(time), step.time) || !std::isfinite(step.time))
      fail(ErrorCode::MalformedFile, path, "<DataSet> has timestep={}; expected a finite number", shown(time));
    const std::string name(element.attribute("file"));
    const std::string extension = lower(fs::path(name).extension().string());
    constexpr std::array<std::string_view, 4> kExtensions = {".vti", ".vtr", ".vts", ".vtu"};
    if (std::find(kExtensions.begin(), kExtensions.end(), extension) == kExtensions.end())
      fail(ErrorCode::UnsupportedData, path, "<DataSet> has file={}; expected a .vti, .vtr, .vts or .vtu file",
           shown(name));
    step.file = named_path(path, name, allow_outside_paths);
    steps.push_back(std::move(step));
  }
  if (steps.empty()) fail(ErrorCode::MalformedFile, path, "a collection without a <DataSet>; expected at least one");
  std::stable_sort(steps.begin(), steps.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  for (std::size_t i = 1; i < steps.size(); ++i)
    if (steps[i].time == steps[i - 1].time)
      fail(ErrorCode::UnsupportedData, path, "has '{}' and '{}' at the time {}; expected one file for each time",
           steps[i - 1].file.filename().string(), steps[i].file.filename().string(), steps[i].time);
  return steps;
}

}  // namespace tegl::io_detail
