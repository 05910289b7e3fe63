#include "geo/io/files/background_writer.hpp"

#include <omp.h>

#include <csignal>
#include <utility>

#include "geo/core/error.hpp"

namespace geo::io {
namespace {

/// Signals are the main thread's to handle, but those that a thread's own work brings about.
void block_signals() {
  sigset_t all;
  sigfillset(&all);
  for (const int own : {SIGSEGV, SIGBUS, SIGFPE, SIGILL}) sigdelset(&all, own);
  pthread_sigmask(SIG_BLOCK, &all, nullptr);
}

thread_local const BackgroundWriter* writer_of_this_thread = nullptr;

}  // namespace

BackgroundWriter::BackgroundWriter()
    : threads_(omp_get_max_threads()), thread_([this] { work(); }) {}

BackgroundWriter::~BackgroundWriter() { stop(); }

void BackgroundWriter::submit(std::function<void()> job) {
  std::unique_lock lock(mutex_);
  rethrow();
  if (stopping_) throw Bug("background writer: job submitted after stop");
  jobs_.push_back(std::move(job));
  lock.unlock();
  changed_.notify_all();
}

void BackgroundWriter::wait_until_left(std::size_t most) {
  std::unique_lock lock(mutex_);
  waiting_.fetch_add(1, std::memory_order_relaxed);
  changed_.wait(lock, [&] { return jobs_.size() + (busy_ ? 1 : 0) <= most; });
  waiting_.fetch_sub(1, std::memory_order_relaxed);
  rethrow();
}

int BackgroundWriter::threads_to_take() {
  const BackgroundWriter* const writer = writer_of_this_thread;
  if (writer == nullptr) return omp_in_parallel() != 0 ? 1 : omp_get_max_threads();
  return writer->waiting_.load(std::memory_order_relaxed) > 0 ? writer->threads_ : 1;
}

void BackgroundWriter::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    jobs_.clear();
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void BackgroundWriter::rethrow() {
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void BackgroundWriter::work() {
  block_signals();
  writer_of_this_thread = this;
  // OpenMP would give this thread a team of its own beside that of the stage that computes.
  omp_set_num_threads(1);
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stopping_ || !jobs_.empty(); });
    if (stopping_) return;
    // Moved out, so that the job's fields leave memory as soon as it is done.
    auto job = std::exchange(jobs_.front(), nullptr);
    jobs_.pop_front();
    busy_ = true;
    lock.unlock();
    std::exception_ptr error;
    try {
      job();
    } catch (...) {
      error = std::current_exception();
    }
    job = nullptr;
    lock.lock();
    busy_ = false;
    if (error) {
      if (!error_) error_ = error;
      jobs_.clear();
    }
    changed_.notify_all();
  }
}

}  // namespace geo::io
