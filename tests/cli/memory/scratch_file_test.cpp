// Pages that leave memory for a file and come back when they are touched.
#include "memory/scratch_file.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <span>
#include <string>
#include <thread>

#include "io/temporary_folder.hpp"
#include "memory/memory.hpp"

namespace terrane {

void end_at_once(const char* message, int code) {
  std::fprintf(stderr, "%s\n", message);
  ::_exit(code);
}

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPageBytes = std::size_t(64) << 10, kPages = 64;
constexpr PageRanges::Range kAll{0, kPages};

/// Bytes that this process read from files, or wrote to them, from the cache or the disk.
std::size_t moved_bytes(const std::string& what) {
  std::ifstream told("/proc/self/io");
  for (std::string word; told >> word;) {
    std::size_t bytes = 0;
    if (word == what + ":" && told >> bytes) return bytes;
  }
  return 0;
}

class ScratchPages : public testing::Test {
 protected:
  void SetUp() override {
#ifdef TERRANE_SANITIZED
    GTEST_SKIP() << "a sanitizer watches what is touched by itself";
#endif
    ASSERT_TRUE(file_.reserve(kAll));
    file_.allow(2 * kPages * kPageBytes);
  }
  ~ScratchPages() override { ::munmap(base_, kPages * kPageBytes); }

  [[nodiscard]] std::span<std::uint32_t> words() const {
    return {reinterpret_cast<std::uint32_t*>(base_), kPages * kPageBytes / sizeof(std::uint32_t)};
  }
  void count_up() const {
    std::uint32_t next = 0;
    for (std::uint32_t& word : words()) word = next++;
  }
  [[nodiscard]] bool is_counted_up() const {
    std::uint32_t next = 0;
    for (const std::uint32_t word : words()) {
      if (word != next++) return false;
    }
    return true;
  }

  geo::TemporaryFolder folder_;
  std::byte* base_ = static_cast<std::byte*>(::mmap(
      nullptr, kPages* kPageBytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0));
  ScratchFile file_{folder_.path(), base_, kPages* kPageBytes, kPageBytes};
};

TEST_F(ScratchPages, ComeBackAsTheyWere) {
  count_up();
  file_.send_away(kAll);
  EXPECT_TRUE(is_counted_up());
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(ScratchPages, AreWrittenOnlyWhereTheyChanged) {
  count_up();
  file_.send_away(kAll);
  ASSERT_TRUE(is_counted_up());
  words()[0] = 7;
  const std::size_t before = moved_bytes("wchar");
  file_.send_away(kAll);
  EXPECT_EQ(moved_bytes("wchar") - before, kPageBytes);
  file_.allow(2 * kPages * kPageBytes);
  EXPECT_EQ(words()[0], 7U);
  words()[0] = 0;
  EXPECT_TRUE(is_counted_up());
}

TEST_F(ScratchPages, OfFreedBlocksAreNeitherWrittenNorRead) {
  count_up();
  file_.send_away({0, kPages / 2});
  const std::size_t written = moved_bytes("wchar");
  file_.drop(kAll);
  EXPECT_EQ(moved_bytes("wchar"), written);
  const std::size_t read = moved_bytes("rchar");
  ASSERT_TRUE(file_.reserve(kAll));
  file_.allow(2 * kPages * kPageBytes);
  words().back() = 1;
  words().front() = 1;
  EXPECT_LT(moved_bytes("rchar") - read, kPageBytes);
}

// What is written while a page leaves would be lost if nothing stopped whoever writes.
TEST_F(ScratchPages, LoseNothingThatThreadsWriteMeanwhile) {
  constexpr std::uint32_t kTimes = 40, kThreads = 3;
  std::atomic<bool> done{false};
  std::thread sending([&] {
    for (std::size_t page = 0; !done; page = (page + 4) % kPages) {
      file_.send_away({page, 4});
      file_.allow(kPages * kPageBytes);
    }
  });
  std::vector<std::thread> counting;
  for (std::uint32_t thread = 0; thread < kThreads; ++thread) {
    counting.emplace_back([&, thread] {
      std::mt19937 random(thread);
      for (std::uint32_t time = 0; time < kTimes * kPages; ++time) {
        const std::size_t page = random() % kPages, each = kPageBytes / sizeof(std::uint32_t);
        for (std::size_t k = thread; k < each; k += kThreads) ++words()[page * each + k];
      }
    });
  }
  for (std::thread& thread : counting) thread.join();
  done = true;
  sending.join();
  file_.allow(2 * kPages * kPageBytes);
  std::vector<std::uint32_t> wanted(kThreads * kPages, 0);
  for (std::uint32_t thread = 0; thread < kThreads; ++thread) {
    std::mt19937 random(thread);
    for (std::uint32_t time = 0; time < kTimes * kPages; ++time) {
      ++wanted[(random() % kPages) * kThreads + thread];
    }
  }
  const std::size_t each = kPageBytes / sizeof(std::uint32_t);
  for (std::size_t k = 0; k < words().size(); ++k) {
    ASSERT_EQ(words()[k], wanted[k / each * kThreads + k % each % kThreads]) << k;
  }
}

TEST_F(ScratchPages, WaitForRoom) {
  file_.allow(0);
  std::atomic<bool> came{false};
  std::thread touching([&] {
    words()[0] = 1;
    came = true;
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_FALSE(came);
  file_.allow(kPageBytes);
  touching.join();
  EXPECT_EQ(words()[0], 1U);
}

TEST_F(ScratchPages, ThatCannotBeReadEndTheProgramWithOneLine) {
  count_up();
  file_.send_away(kAll);
  const auto lose_and_touch = [&] {
    for (const auto& open : fs::directory_iterator("/proc/self/fd")) {
      std::error_code error;
      const std::string file = fs::read_symlink(open.path(), error).string();
      if (file.starts_with(folder_.path().string())) ::truncate(open.path().c_str(), 0);
    }
    std::printf("%u", words()[0]);
  };
  EXPECT_EXIT(lose_and_touch(), testing::ExitedWithCode(4),
              "the scratch file of --memory could not be read or written: the disk is full or "
              "fails; --scratch DIR");
}

}  // namespace
}  // namespace terrane
