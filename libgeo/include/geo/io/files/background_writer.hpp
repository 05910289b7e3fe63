#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace geo::io {

/// Writes files one after the other on a thread of its own, while the next stage computes.
/// The first error stops the queue and is thrown again by the next `submit` or `wait`.
class BackgroundWriter {
 public:
  BackgroundWriter();
  /// As `stop`; an error that nobody asked for is lost.
  ~BackgroundWriter();
  BackgroundWriter(const BackgroundWriter&) = delete;
  BackgroundWriter& operator=(const BackgroundWriter&) = delete;

  /// Appends a job. Throws the error of an earlier one.
  void submit(std::function<void()> job);
  /// Returns when all jobs are done. Throws the first error.
  void wait() { wait_until_left(0); }
  /// Returns when no more than so many jobs are left, the one that runs included. Throws the first
  /// error.
  void wait_until_left(std::size_t most);
  /// Finishes the job that runs now and drops the rest. No job may be submitted afterwards.
  void stop();

  /// How many threads the work of the calling thread may take. On a writer's: one while others
  /// compute, all of the program's while they wait for it; elsewhere as many as OpenMP would give.
  [[nodiscard]] static int threads_to_take();

 private:
  void work();
  void rethrow();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> jobs_;
  std::exception_ptr error_;
  bool busy_ = false;
  bool stopping_ = false;
  std::atomic<int> waiting_ = 0;  ///< threads that wait for jobs
  int threads_;                   ///< of the program
  std::thread thread_;
};

}  // namespace geo::io
