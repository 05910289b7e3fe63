#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace terrane {

/// A progress bar on stderr: stage, fraction, rate in cells a second, time left. Draws nothing when
/// stderr is no terminal.
class Progress {
 public:
  explicit Progress(bool wanted);
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void begin(std::string_view stage, double cells);
  void update(double fraction);
  /// Wipes the bar, so that a line of text can stand in its place.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  bool enabled_;
  bool drawn_ = false;
  std::string stage_;
  double cells_ = 0.0;
  Clock::time_point start_, last_;
};

}  // namespace terrane
