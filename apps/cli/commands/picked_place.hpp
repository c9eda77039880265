// SPDX-License-Identifier: BSD-3-Clause
//
// The point of --pick, and the report on the component that was found there.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "output/result.hpp"
#include "tegl/error.hpp"
#include "tegl/pick.hpp"

namespace tegl::cli {

/// The point in N dimensions. `text`: value of --pick, for errors.
template <int N>
[[nodiscard]] std::array<double, N> picked_place(const Picked& picked, const std::string& text) {
  if (picked.point.size() != N)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("--pick {} has {} numbers; expected {}, one for each axis", text, picked.point.size(), N));
  std::array<double, N> point;
  std::copy_n(picked.point.begin(), N, point.begin());
  return point;
}

template <int N>
void take_report(const PickReport<N>& report, Picked& picked) {
  const std::vector<std::size_t> tile(report.at.begin(), report.at.end());
  picked = {picked.point, tile, report.distance, report.tiles, report.components};
}

}  // namespace tegl::cli
