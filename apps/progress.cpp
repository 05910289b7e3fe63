#include "progress.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "log.hpp"

namespace terrane {

Progress::Progress(bool wanted) : enabled_(wanted && isatty(STDERR_FILENO) == 1) {}

void Progress::begin(std::string_view stage, double cells) {
  stage_ = stage;
  cells_ = cells;
  start_ = Clock::now();
  last_ = {};
}

void Progress::update(double fraction) {
  if (!enabled_) return;
  const auto now = Clock::now();
  if (drawn_ && now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  constexpr int kWidth = 24;
  fraction = std::clamp(fraction, 0.0, 1.0);
  const int filled = static_cast<int>(fraction * kWidth);
  const double seconds = std::chrono::duration<double>(now - start_).count();
  std::string figures;
  if (fraction > 0.0 && seconds > 0.2) {
    figures = fmt::format("  {:.2g} M cells/s  {} left", cells_ * fraction / seconds / 1e6,
                          shown_seconds(seconds * (1.0 - fraction) / fraction));
  }
  fmt::print(stderr, "\r\033[K{:<10} [{:=<{}}{:>{}}] {:3.0f} %{}", stage_, "", filled, "",
             kWidth - filled, 100.0 * fraction, figures);
  std::fflush(stderr);
  drawn_ = true;
}

void Progress::clear() {
  if (!drawn_) return;
  fmt::print(stderr, "\r\033[K");
  std::fflush(stderr);
  drawn_ = false;
}

}  // namespace terrane
