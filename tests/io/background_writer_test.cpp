#include "geo/io/files/background_writer.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <atomic>
#include <future>
#include <memory>
#include <thread>
#include <vector>

#include "geo/core/error.hpp"

namespace geo::io {
namespace {

TEST(BackgroundWriter, RunsJobsInOrder) {
  std::vector<int> done;
  BackgroundWriter writer;
  for (int i = 0; i < 100; ++i) writer.submit([&done, i] { done.push_back(i); });
  writer.wait();
  ASSERT_EQ(done.size(), 100U);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(done[i], i);
}

TEST(BackgroundWriter, FirstErrorComesBackAndStopsTheQueue) {
  BackgroundWriter writer;
  std::promise<void> gate;
  std::atomic<bool> ran = false;
  writer.submit([&gate] {
    gate.get_future().wait();
    throw IoError("disk full");
  });
  writer.submit([&ran] { ran = true; });
  gate.set_value();
  EXPECT_THROW(writer.wait(), IoError);
  EXPECT_FALSE(ran);
  EXPECT_NO_THROW(writer.wait()) << "an error is told once";
}

TEST(BackgroundWriter, WaitsUntilNoMoreThanSoManyJobsAreLeft) {
  std::promise<void> first, second;
  std::atomic<int> done = 0;
  BackgroundWriter writer;
  writer.submit([&] {
    first.get_future().wait();
    ++done;
  });
  writer.submit([&] {
    second.get_future().wait();
    ++done;
  });
  writer.wait_until_left(2);  // at once
  first.set_value();
  writer.wait_until_left(1);
  EXPECT_EQ(done, 1);
  second.set_value();
  writer.wait_until_left(0);
  EXPECT_EQ(done, 2);
}

TEST(BackgroundWriter, StopFinishesTheJobAtHandAndDropsTheRest) {
  std::promise<void> started, gate;
  std::atomic<bool> finished = false, second = false;
  BackgroundWriter writer;
  writer.submit([&] {
    started.set_value();
    gate.get_future().wait();
    finished = true;
  });
  writer.submit([&second] { second = true; });
  started.get_future().wait();
  std::thread stopper([&writer] { writer.stop(); });
  gate.set_value();
  stopper.join();
  EXPECT_TRUE(finished);
  EXPECT_THROW(writer.submit([] {}), Bug);
}

TEST(BackgroundWriter, LetsGoOfAJobsDataWhenItIsDone) {
  const auto data = std::make_shared<int>(1);
  BackgroundWriter writer;
  writer.submit([data] {});
  writer.wait();
  EXPECT_EQ(data.use_count(), 1);
}

TEST(BackgroundWriter, TakesAllThreadsOnlyWhileItIsWaitedFor) {
  omp_set_num_threads(3);
  EXPECT_EQ(BackgroundWriter::threads_to_take(), 3);
  BackgroundWriter writer;
  std::promise<int> alone;
  std::atomic<int> waited_for = 0;
  writer.submit([&] {
    alone.set_value(BackgroundWriter::threads_to_take());
    while (BackgroundWriter::threads_to_take() == 1) std::this_thread::yield();
    waited_for = BackgroundWriter::threads_to_take();
  });
  EXPECT_EQ(alone.get_future().get(), 1);
  writer.wait();
  EXPECT_EQ(waited_for, 3);
  omp_set_num_threads(omp_get_num_procs());
}

}  // namespace
}  // namespace geo::io
