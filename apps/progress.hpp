#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace terrane {

/// How a run says how far it is.
enum class ProgressStyle {
  none,
  bar,   ///< drawn where stderr is a terminal
  json,  ///< an object a line, for programs that watch
};

/// Progress on stderr: stage, fraction, rate in cells a second, time left. As JSON one object when
/// a stage begins ("stage-begins", with `cells`), a few a second ("progress", with `fraction` and
/// `seconds`), and one when it ends ("stage-ends").
class Progress {
 public:
  explicit Progress(ProgressStyle style);
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void begin(std::string_view stage, double cells);
  void update(double fraction);
  /// The stage is done, in so many seconds.
  void end(std::string_view stage, double seconds);
  /// Wipes the bar, so that a line of text can stand in its place.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  ProgressStyle style_;
  bool drawn_ = false;
  std::string stage_;
  double cells_ = 0.0;
  Clock::time_point start_, last_;
};

}  // namespace terrane
