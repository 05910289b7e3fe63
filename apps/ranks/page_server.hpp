#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <vector>

#include "rank_messages.hpp"

namespace terrane {

/// What rank 0 asks of the others, at the head of each message.
struct PageRequest {
  enum class Wish : std::uint64_t {
    begin,    ///< rank 0 is process `first` on the machine `pages`
    keep,     ///< the page that follows
    hand_on,  ///< a page, which is kept no longer
    forget,   ///< so many pages from `first` on
    end       ///< the job is done
  };
  Wish wish = Wish::end;
  std::uint64_t first = 0, pages = 0;
};

/// Keeps pages for rank 0 until it says that the job is done. For every rank but 0. `begins` is
/// given the process of rank 0 where that is on the same machine.
void serve_pages(RankMessages& messages, const std::function<void(pid_t)>& begins);

/// The pages of a region at the other ranks of the job, in turn: page p at rank 1 + p mod
/// (ranks - 1). A page is at one place only, so that all memory is of use. For several threads at
/// once.
class PagesAtRanks {
 public:
  PagesAtRanks(RankMessages& messages, std::size_t page_bytes);

  [[nodiscard]] std::size_t page_bytes() const { return page_bytes_; }
  /// `read` is given the place of the page's bytes.
  template <class Read>
  void put(std::size_t page, Read&& read) {
    const std::lock_guard lock(mutex_);
    read(payload());
    send_page(page);
  }
  /// Pages in a row, all asked for before the first is waited for. `write` is given the number of
  /// each and its bytes: none where its block was freed while it was on its way, and they are of no
  /// worth.
  template <class Write>
  void take(std::size_t first, std::size_t pages, Write&& write) {
    const std::lock_guard lock(mutex_);
    for (std::size_t k = 0; k < pages; ++k) ask_for(first + k);
    for (std::size_t k = 0; k < pages; ++k) {
      write(first + k, std::span<const std::byte>(payload()).first(receive_page(first + k)));
    }
  }
  void forget(std::size_t first, std::size_t pages);

 private:
  [[nodiscard]] int home(std::size_t page) const {
    return 1 + static_cast<int>(page % static_cast<std::size_t>(messages_.count() - 1));
  }
  [[nodiscard]] std::span<std::byte> payload() {
    return std::span(buffer_).subspan(sizeof(PageRequest));
  }
  void send_page(std::size_t page);
  void ask_for(std::size_t page);
  std::size_t receive_page(std::size_t page);

  RankMessages& messages_;
  std::size_t page_bytes_;
  std::mutex mutex_;
  std::vector<std::byte> buffer_;
};

/// Tell every other rank that the job begins, and that it is done.
void begin_page_servers(RankMessages& messages);
void end_page_servers(RankMessages& messages);

}  // namespace terrane
