#include "progress.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "log.hpp"

namespace terrane {

namespace {

void print_line(const nlohmann::ordered_json& line) {
  fmt::print(stderr, "{}\n", line.dump());
  std::fflush(stderr);
}

}  // namespace

Progress::Progress(ProgressStyle style) : style_(style) {
  if (style == ProgressStyle::bar && isatty(STDERR_FILENO) != 1) style_ = ProgressStyle::none;
}

void Progress::begin(std::string_view stage, double cells) {
  stage_ = stage;
  cells_ = cells;
  start_ = Clock::now();
  last_ = {};
  if (style_ == ProgressStyle::json) {
    print_line({{"event", "stage-begins"}, {"stage", stage_}, {"cells", cells}});
  }
}

void Progress::end(std::string_view stage, double seconds) {
  clear();
  if (style_ != ProgressStyle::json) return;
  print_line({{"event", "stage-ends"}, {"stage", stage}, {"seconds", seconds}});
}

void Progress::update(double fraction) {
  if (style_ == ProgressStyle::none) return;
  const auto now = Clock::now();
  const bool json = style_ == ProgressStyle::json;
  if ((drawn_ || json) && now - last_ < std::chrono::milliseconds(json ? 250 : 100)) return;
  last_ = now;
  constexpr int kWidth = 24;
  fraction = std::clamp(fraction, 0.0, 1.0);
  const int filled = static_cast<int>(fraction * kWidth);
  const double seconds = std::chrono::duration<double>(now - start_).count();
  if (json) {
    return print_line(
        {{"event", "progress"}, {"stage", stage_}, {"fraction", fraction}, {"seconds", seconds}});
  }
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
