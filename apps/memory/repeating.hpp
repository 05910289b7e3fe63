#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace terrane {

/// Calls `work` every so often on a thread of its own, until it is destroyed. The thread is let in
/// soon on busy machines, and gets none of the program's signals.
class Repeating {
 public:
  Repeating(std::chrono::milliseconds pause, std::function<void()> work);
  ~Repeating();
  Repeating(const Repeating&) = delete;
  Repeating& operator=(const Repeating&) = delete;

 private:
  void repeat(std::chrono::milliseconds pause);

  std::function<void()> work_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace terrane
