#pragma once

#include <atomic>
#include <cstddef>
#include <thread>

#include "apps/ranks/page_server.hpp"
#include "guarded_pages.hpp"

namespace terrane {

/// Pages of the scratch region that are in the memory of other ranks while they are not in this
/// one's: a thread of its own fetches those that are touched, and those that will be.
class RemotePages : public GuardedPages {
 public:
  /// The region [base, base + bytes), which is mapped anew. Throws IoError where the system does
  /// not let it. One at a time, to the end of the program.
  RemotePages(std::byte* base, std::size_t bytes, PagesAtRanks& ranks);
  ~RemotePages() override;

  bool reserve(PageRanges::Range range) override;
  void send_away(PageRanges::Range range) override;
  PageRanges::Trace drop(PageRanges::Range range) override;
  void forget(PageRanges::Range range) override;

  /// What went to other ranks and came from them so far.
  [[nodiscard]] std::size_t exchanged_bytes() const { return moved_ * page_bytes(); }

 private:
  void open_fresh(std::size_t page) noexcept override;
  void open_unchanged(std::size_t page) noexcept override { open_fresh(page); }
  void bring_away(std::size_t page, Access access) noexcept override;
  void close(PageRanges::Range range);
  void clear(PageRanges::Range range);
  void fetch();

  PagesAtRanks& ranks_;
  int file_ = -1;                          ///< without a name or a disk: the region's own memory
  int wanted_from_ = -1, wanted_to_ = -1;  ///< a pipe of the numbers of pages that are wanted
  std::atomic<std::size_t> moved_{0};
  std::thread fetching_;
};

}  // namespace terrane
