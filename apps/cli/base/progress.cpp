// SPDX-License-Identifier: BSD-3-Clause
//
// Implements the progress bar.
#include "base/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

namespace tegl::cli {

std::string time_left(double seconds, double fraction) {
  constexpr double kEarliest = 2.0;  // seconds
  constexpr double kLeastFraction = 0.01;
  if (seconds < kEarliest || fraction < kLeastFraction || fraction >= 1.0) return "";
  const double left = seconds * (1.0 - fraction) / fraction;
  if (left < 99.5) return fmt::format("{:.0f} s left", left);
  const auto minutes = static_cast<long long>(left / 60.0 + 0.5);
  if (minutes < 100) return fmt::format("{} min left", minutes);
  return fmt::format("{} h {} min left", minutes / 60, minutes % 60);
}

Progress ProgressBar::stage(std::string name) {
  InterruptHandler::throw_if_requested();
  {
    const std::lock_guard lock(mutex_);
    name_ = std::move(name);
    last_ = {};
    start_ = std::chrono::steady_clock::now();
  }
  if (draw_) draw(0);
  return [this](double fraction) {
    if (draw_) draw(fraction);
    return !InterruptHandler::requested();
  };
}

void ProgressBar::draw(double fraction) {
  constexpr auto kInterval = std::chrono::milliseconds(50);
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return;  // another thread is drawing
  const auto now = std::chrono::steady_clock::now();
  if (now - last_ < kInterval) return;
  last_ = now;
  visible_ = true;
  console_->write("\r\x1b[K" + text(std::clamp(fraction, 0.0, 1.0)));
}

std::string ProgressBar::text(double fraction) const {
  constexpr int kMostCells = 60;
  const std::string share = fmt::format("{:3.0f} %", 100 * fraction);
  const double seconds = std::chrono::duration<double>(last_ - start_).count();
  const std::string left = fmt::format("{:<16}", time_left(seconds, fraction));
  const std::string name = fmt::format("{:<10}", name_);
  // A full line would wrap to the next one and stay there.
  const int room = console_->width() - 1;
  const auto cells_beside = [&](std::size_t size) { return std::min(kMostCells, room - static_cast<int>(size) - 4); };
  const auto bar = [&](int cells) {
    const auto full = static_cast<std::size_t>(fraction * cells);
    return fmt::format("{} [{}{}] {}", name, std::string(full, '#'),
                       std::string(static_cast<std::size_t>(cells) - full, '.'), share);
  };
  constexpr int kLeastCells = 4;
  const int beside_time = cells_beside(name.size() + share.size() + left.size() + 1);
  if (beside_time >= kLeastCells) return fmt::format("{} {}", bar(beside_time), left);
  if (const int cells = cells_beside(name.size() + share.size()); cells >= kLeastCells) return bar(cells);
  const std::string both = fmt::format("{} {}", name_, share);
  for (const std::string& shorter : {both, share})
    if (static_cast<int>(shorter.size()) <= room) return shorter;
  return "";
}

void ProgressBar::clear() {
  const std::lock_guard lock(mutex_);
  if (visible_) console_->write("\r\x1b[K");
  visible_ = false;
}

double Stopwatch::lap() {
  const auto now = std::chrono::steady_clock::now();
  const double seconds = std::chrono::duration<double>(now - start_).count();
  start_ = now;
  return seconds;
}

}  // namespace tegl::cli
