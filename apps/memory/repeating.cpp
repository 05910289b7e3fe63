#include "repeating.hpp"

#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <utility>

namespace terrane {
namespace {

/// A busy machine lets a thread that seldom works wait for those that always do; this one says that
/// it works for a tenth of a millisecond at a time, and is let in soon. Where the system knows no
/// such thing, or does not let it go ahead of others, nothing changes.
void ask_for_short_turns() {
  struct {
    std::uint32_t size = 48, policy = SCHED_OTHER;
    std::uint64_t flags = 0;
    std::int32_t nice = 0;
    std::uint32_t priority = 0;
    std::uint64_t runtime_ns = 100000, deadline_ns = 0, period_ns = 0;
  } attributes;
  ::syscall(SYS_sched_setattr, 0, &attributes, 0);
  constexpr int kAhead = -15;
  ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kAhead);
}

void block_signals() {
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, nullptr);
}

}  // namespace

Repeating::Repeating(std::chrono::milliseconds pause, std::function<void()> work)
    : work_(std::move(work)), thread_([this, pause] { repeat(pause); }) {}

Repeating::~Repeating() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Repeating::repeat(std::chrono::milliseconds pause) {
  block_signals();  // they are the main thread's to handle
  ask_for_short_turns();
  std::unique_lock lock(mutex_);
  while (!changed_.wait_for(lock, pause, [this] { return stopping_; })) {
    lock.unlock();
    work_();
    lock.lock();
  }
}

}  // namespace terrane
