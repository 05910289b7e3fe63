#include "geo/core/state.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <numeric>
#include <thread>
#include <utility>

namespace geo {
namespace {

State small_state() {
  State state(std::make_shared<const Grid>(Grid::sphere(64, 32)));
  state.set(field::elevation, std::vector<float>(state.grid().size(), 1.0F));
  return state;
}

TEST(State, ChangesInPlaceWhatNobodyElseHolds) {
  State state = small_state();
  const float* const before = state.read(field::elevation).data();
  EXPECT_EQ(state.update(field::elevation).data(), before);
  { const auto held = state.values(field::elevation); }
  EXPECT_EQ(state.update(field::elevation).data(), before);
}

TEST(State, CopiesFirstWhatSomebodyStillHolds) {
  State state = small_state();
  const auto held = state.values(field::elevation);
  const auto again = held;
  state.update(field::elevation)[0] = 5.0F;
  EXPECT_EQ(std::get<std::vector<float>>(*held)[0], 1.0F);
  const float* const own = state.read(field::elevation).data();
  EXPECT_EQ(state.update(field::elevation).data(), own);
}

TEST(State, HoldsTheValuesOfItsCopiesApart) {
  State state = small_state();
  {
    State copy = state;
    copy.update(field::elevation)[3] = 7.0F;
    state.update(field::elevation)[3] = 9.0F;
    EXPECT_EQ(copy.read(field::elevation)[3], 7.0F);
  }
  const float* const own = state.read(field::elevation).data();
  {
    const State copy = state;
    EXPECT_EQ(copy.read(field::elevation).data(), own);
  }
  EXPECT_EQ(state.update(field::elevation).data(), own);
  const State moved = std::move(state);
  EXPECT_EQ(moved.read(field::elevation)[3], 9.0F);
}

TEST(State, NeverChangesWhatItShares) {
  State state = small_state(), other(state.shared_grid());
  other.share(field::elevation, state.values(field::elevation));
  other.update(field::elevation)[0] = 3.0F;
  EXPECT_EQ(state.read(field::elevation)[0], 1.0F);
  other.share(field::elevation, state.values(field::elevation));
  state.update(field::elevation)[0] = 4.0F;
  EXPECT_EQ(other.read(field::elevation)[0], 1.0F);
}

/// A writer reads what it was lent and gives it back while the next stage changes the field: under
/// the thread sanitizer a change that does not come after the last read is a race.
TEST(State, ChangesInPlaceOnlyAfterTheLastReadOfAnotherThread) {
  State state = small_state();
  std::mutex mutex;
  std::condition_variable changed;
  std::shared_ptr<const Values> lent;
  bool ends = false;
  double sum = 0.0;
  std::thread writer([&] {
    while (true) {
      std::unique_lock lock(mutex);
      changed.wait(lock, [&] { return lent || ends; });
      if (!lent) return;
      const std::shared_ptr<const Values> held = std::move(lent);
      lent = nullptr;
      lock.unlock();
      const auto& values = std::get<std::vector<float>>(*held);
      sum += std::accumulate(values.begin(), values.end(), 0.0);
    }
  });
  int in_place = 0;
  for (int round = 0; round < 300; ++round) {
    const float* const before = state.read(field::elevation).data();
    {
      const std::lock_guard lock(mutex);
      lent = state.values(field::elevation);
    }
    changed.notify_one();
    // Time to read, without a word from the writer but that it gives back what it holds.
    std::this_thread::sleep_for(std::chrono::microseconds(500));
    const auto values = state.update(field::elevation);
    in_place += values.data() == before ? 1 : 0;
    for (float& value : values) value = 2.0F;
  }
  {
    const std::lock_guard lock(mutex);
    ends = true;
  }
  changed.notify_one();
  writer.join();
  EXPECT_GT(in_place, 0);
  EXPECT_GT(sum, 0.0);
}

}  // namespace
}  // namespace geo
