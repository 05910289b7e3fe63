#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "page_store.hpp"
#include "read_ahead.hpp"

namespace terrane {

/// What somebody is about to do with a page.
enum class Access { read, write };

/// Pages of the scratch region that stop whoever touches them while they are not here: the system
/// tells by a signal, and the thread goes on once the page is here. Nothing of this changes what a
/// kernel reads or writes. Where pages are meanwhile is for those who derive from this.
///
/// A page is in one of six states. It is `fresh` if it was never touched, or its block was freed;
/// `here`; `unchanged`, here and not to be written, as the same bytes are elsewhere; `away`;
/// `wanted` from there; or `moving`, while somebody changes its state.
class GuardedPages : public PageStore {
 public:
  void allow(std::size_t bytes) override;
  void wait_for_room(std::size_t bytes) noexcept override;
  void have_come(std::size_t bytes) noexcept override;

  /// Brings the page of an address here and returns true; false if it is none of the region's.
  /// From signal handlers too.
  bool bring(const void* address, Access access) noexcept;

 protected:
  enum State : std::uint32_t { fresh, here, unchanged, away, wanted, moving };
  using Word = std::atomic<std::uint32_t>;

  /// The region [base, base + bytes). One at a time, to the end of the program. Throws IoError
  /// where the system has no memory for the states.
  GuardedPages(std::byte* base, std::size_t bytes, std::size_t page_bytes);

  /// Somebody touches a fresh page, or writes to an unchanged one, which is moving: it can be read
  /// and written from now on.
  virtual void open_fresh(std::size_t page) noexcept = 0;
  virtual void open_unchanged(std::size_t page) noexcept = 0;
  /// Somebody touches a page that is away: it is not when this returns, or is looked at again.
  virtual void bring_away(std::size_t page, Access access) noexcept = 0;
  /// A page that moves because it is wanted, and those behind it or before it that were away and
  /// will be wanted, which move then too.
  [[nodiscard]] PageRanges::Range with_those_ahead(std::size_t page) noexcept;

  [[nodiscard]] std::byte* at(std::size_t page) const { return base_ + page * page_bytes_; }
  [[nodiscard]] off_t place(std::size_t pages) const {
    return static_cast<off_t>(pages * page_bytes_);
  }
  [[nodiscard]] std::size_t page_bytes() const { return page_bytes_; }
  [[nodiscard]] std::size_t pages() const { return state_.size(); }

  /// Lets pages be touched so. False where the system does not: it has no room for one more entry.
  [[nodiscard]] bool protect(PageRanges::Range range, int protection) const noexcept;

  /// Whether it was in that state, and is moving now.
  bool starts(std::size_t page, State from) noexcept {
    std::uint32_t expected = from;
    return state_[page].compare_exchange_strong(expected, moving);
  }
  /// Whether it was in that state, and is in the other now.
  bool turns(std::size_t page, State from, State to) noexcept {
    std::uint32_t expected = from;
    return state_[page].compare_exchange_strong(expected, to);
  }
  void ends(std::size_t page, State to) noexcept;
  /// All pages of `range` in a state: `work` is given those in a row, which move meanwhile and are
  /// in the other state afterwards. Returns how many there were.
  template <class Work>
  std::size_t with_all(PageRanges::Range range, State from, State to, Work&& work) {
    const std::size_t end = range.first + range.pages;
    std::size_t all = 0;
    for (std::size_t first = range.first; first < end;) {
      std::size_t last = first;
      while (last < end && starts(last, from)) ++last;
      if (last == first) {
        ++first;
        continue;
      }
      all += last - first;
      work(PageRanges::Range{first, last - first});
      for (; first < last; ++first) ends(first, to);
    }
    return all;
  }

 private:
  void wait_while(Word& word, std::uint32_t value) noexcept;

  std::byte* base_;
  std::size_t page_bytes_;
  std::span<Word> state_;  ///< of each page
  ReadAhead ahead_;
  std::atomic_flag looks_ahead_ = ATOMIC_FLAG_INIT;
  std::atomic<std::size_t> waiting_{0};  ///< threads
  std::atomic<std::size_t> allowed_{0};  ///< bytes that may come
  std::atomic<std::size_t> coming_{0};   ///< of those that were let in, what is not there yet
  Word allowances_{0};                   ///< how often that was said
};

/// Brings every page of [bytes, bytes + size) here if they lie in such a region. Returns whether
/// any did.
bool bring_pages(const void* bytes, std::size_t size, Access access) noexcept;

}  // namespace terrane
