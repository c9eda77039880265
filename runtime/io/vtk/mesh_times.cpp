// SPDX-License-Identifier: BSD-3-Clause
//
// Sorts the files of a mesh over time by their names or times, and finds their times.
#include "vtk/mesh_times.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <utility>

#include "base/common.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

/// Puts items of a list into an order.
template <class Item>
void reorder(std::vector<Item>& list, const std::vector<std::size_t>& order) {
  std::vector<Item> sorted;
  for (const std::size_t i : order) sorted.push_back(std::move(list[i]));
  list = std::move(sorted);
}

/// Where the times of a series are from.
enum class TimesFrom { caller, collection, files };

/// Throws InvalidArgument unless times ascend; names the option, or the files, that the times are from.
void require_ascending(const std::vector<double>& times, const std::vector<fs::path>& files, TimesFrom from,
                       const fs::path& collection) {
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i] > times[i - 1]) continue;
    const std::string before = files[i - 1].filename().string(), here = files[i].filename().string();
    const bool are_equal = times[i] == times[i - 1];  // in any order
    switch (from) {
      case TimesFrom::caller:
        throw Error(ErrorCode::InvalidArgument,
                    fmt::format("the given times (--times) have {} for {} after {} for {}; expected {}", times[i], here,
                                times[i - 1], before,
                                are_equal ? "a time of its own for each file"
                                          : "ascending times in the order of the files, or the files in the order of "
                                            "their times (--sort time)"));
      case TimesFrom::collection:
        fail(ErrorCode::InvalidArgument, collection,
             "has the timestep {} of {} after {} of {}; expected {}, or given times (--times)", times[i], here,
             times[i - 1], before,
             are_equal ? "a time of its own for each file" : "ascending times: the order by times (--sort time)");
      case TimesFrom::files:
        fail(ErrorCode::InvalidArgument, files[i],
             "has the time {} (TimeValue), after {} of {}; expected {}, or given times (--times)", times[i],
             times[i - 1], before,
             are_equal ? "a time of its own for each file"
                       : "ascending times: the files in the order of their times (--sort time)");
    }
  }
}

}  // namespace

void sort_files(CellMeshOptions& options, std::vector<fs::path>& files) {
  if (options.order == SeriesOrder::given) return;
  if (files.size() == 1)
    fail(ErrorCode::InvalidArgument, files[0], "is one mesh; expected several for an order of files (--sort)");
  if (options.order == SeriesOrder::coordinate && options.time_step)
    throw Error(ErrorCode::InvalidArgument,
                "files in the order of their times and a time step, which follows the order; expected times");
  if (!options.times.empty() && options.times.size() != files.size()) return;  // an error of times_of
  std::vector<std::size_t> order(files.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (options.order == SeriesOrder::by_name)
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return natural_less(files[a].native(), files[b].native()); });
  else if (!options.times.empty())
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return options.times[a] < options.times[b]; });
  reorder(files, order);
  if (!options.times.empty()) reorder(options.times, order);
}

void sort_by_own_times(const CellMeshOptions& options, std::vector<std::optional<double>>& own, CellMesh& mesh) {
  if (options.order != SeriesOrder::coordinate || !options.times.empty()) return;
  for (std::size_t i = 0; i < own.size(); ++i)
    if (!own[i])
      fail(ErrorCode::InvalidArgument, mesh.files[i],
           "has no time for the order by times (--sort time); expected one in the file, or given times (--times)");
  std::vector<std::size_t> order(own.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return *own[a] < *own[b]; });
  const auto move_blocks = [&](std::vector<double>& list) {
    const auto size = static_cast<std::ptrdiff_t>(list.size() / order.size());
    std::vector<double> sorted;
    for (const std::size_t i : order) {
      const auto first = list.begin() + static_cast<std::ptrdiff_t>(i) * size;
      sorted.insert(sorted.end(), first, first + size);
    }
    list = std::move(sorted);
  };
  move_blocks(mesh.values);
  if (mesh.points_move) move_blocks(mesh.points);
  reorder(mesh.files, order);
  reorder(own, order);
}

std::vector<double> times_of(const std::vector<std::optional<double>>& own, const CellMeshOptions& options,
                             const std::vector<fs::path>& files, const fs::path& collection) {
  std::vector<double> times = options.times;
  TimesFrom from = !collection.empty() ? TimesFrom::collection : TimesFrom::caller;
  const bool are_given = !times.empty() || options.time_step;
  if (are_given && own.size() == 1)
    fail(ErrorCode::InvalidArgument, files[0],
         "is one mesh; expected several for times (--times) or a time step (--time-step)");
  if (!times.empty() && options.time_step)
    throw Error(ErrorCode::InvalidArgument, "times and a time step; expected one of the two");
  if (own.size() == 1) return {};
  if (const auto step = options.time_step;
      step && !(*step > 0.0 && std::isfinite(*step * static_cast<double>(own.size() - 1))))
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("the time step (--time-step) is {}; expected a positive number for which the times of all "
                            "files are finite",
                            *step));
  for (std::size_t i = 0; i < own.size() && options.time_step; ++i)
    times.push_back(static_cast<double>(i) * *options.time_step);
  if (!times.empty() && times.size() != own.size())
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{} times for {} files; expected one for each", times.size(), own.size()));
  const bool is_known = std::all_of(own.begin(), own.end(), [](const auto& time) { return time.has_value(); });
  if (times.empty()) {
    from = TimesFrom::files;  // or numbers, which ascend
    for (std::size_t i = 0; i < own.size(); ++i) times.push_back(is_known ? *own[i] : static_cast<double>(i));
  }
  require_ascending(times, files, from, collection);
  return times;
}

}  // namespace tegl::io_detail
