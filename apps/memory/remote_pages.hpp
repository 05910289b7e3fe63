#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <thread>

#include "apps/ranks/page_server.hpp"
#include "page_store.hpp"
#include "read_ahead.hpp"

namespace terrane {

/// Pages of the scratch region that are in the memory of other ranks while they are not in this
/// one's. A page that is touched and not here stops whoever touches it (the system tells by a
/// signal) until a thread of its own has fetched it. Nothing of this changes what a kernel reads or
/// writes.
///
/// A page is in one of five states. It is `fresh` if it was never touched, or its block was freed;
/// `here`; `away`, at another rank; `wanted` from there; or `moving`, while somebody changes its
/// state.
class RemotePages : public PageStore {
 public:
  /// The region [base, base + bytes), which is mapped anew. Throws IoError where the system does
  /// not let it. One at a time, to the end of the program.
  RemotePages(std::byte* base, std::size_t bytes, PagesAtRanks& ranks);
  ~RemotePages() override;

  bool reserve(PageRanges::Range range) override;
  void send_away(PageRanges::Range range) override;
  PageRanges::Trace drop(PageRanges::Range range) override;
  void forget(PageRanges::Range range) override;
  [[nodiscard]] bool asks_for_room() const override { return true; }
  void allow(std::size_t bytes) override;
  [[nodiscard]] std::size_t least_clear_bytes(std::size_t cap_bytes) const override;

  /// Brings the page of an address here and returns true; false if it is none of the region's.
  /// From signal handlers too.
  bool bring(const void* address) noexcept;

  /// What went to other ranks and came from them so far.
  [[nodiscard]] std::size_t exchanged_bytes() const { return moved_ * page_bytes_; }

 private:
  enum State : std::uint32_t { fresh, here, away, wanted, moving };
  using Word = std::atomic<std::uint32_t>;

  [[nodiscard]] std::byte* at(std::size_t page) const { return base_ + page * page_bytes_; }
  [[nodiscard]] off_t place(std::size_t pages) const {
    return static_cast<off_t>(pages * page_bytes_);
  }
  /// Whether it was in that state, and is moving now.
  bool starts(std::size_t page, State from) {
    std::uint32_t expected = from;
    return state_[page].compare_exchange_strong(expected, moving);
  }
  void ends(std::size_t page, State to) noexcept;
  void open(std::size_t page) noexcept;
  void close(PageRanges::Range range);
  void clear(PageRanges::Range range);
  void wait_for_room() noexcept;
  void fetch();
  [[nodiscard]] PageRanges::Range with_those_ahead(std::size_t page);

  std::byte* base_;
  std::size_t pages_, page_bytes_;
  PagesAtRanks& ranks_;
  int file_ = -1;                          ///< without a name or a disk: the region's own memory
  std::span<Word> state_;                  ///< of each page
  int wanted_from_ = -1, wanted_to_ = -1;  ///< a pipe of the numbers of pages that are wanted
  ReadAhead ahead_;
  std::atomic<std::size_t> moved_{0};
  std::atomic<std::int64_t> allowed_{0};  ///< pages that may come
  Word allowances_{0};                    ///< how often that was said
  std::thread fetching_;
};

/// Brings every page of [bytes, bytes + size) here if they lie in such a region. Returns whether
/// any did.
bool bring_pages(const void* bytes, std::size_t size) noexcept;

}  // namespace terrane
