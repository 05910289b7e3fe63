#include "page_server.hpp"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <thread>
#include <unordered_map>

namespace terrane {
namespace {

using Wish = PageRequest::Wish;

/// Looks for messages without taking a processor from the rank that computes: after some looks in
/// vain it rests, for longer and longer.
RankMessages::Waiting next_message(RankMessages& messages) {
  using namespace std::chrono_literals;
  constexpr int kLooks = 200;
  constexpr auto kLongest = 500us;
  auto rest = 10us;
  for (int looks = 0;; ++looks) {
    if (const auto message = messages.waiting()) return *message;
    if (looks < kLooks) {
      ::sched_yield();
      continue;
    }
    std::this_thread::sleep_for(rest);
    rest = std::min(2 * rest, std::chrono::microseconds(kLongest));
  }
}

std::span<const std::byte> bytes_of(const PageRequest& request) {
  return std::as_bytes(std::span(&request, 1));
}

void tell_all(RankMessages& messages, const PageRequest& request) {
  for (int rank = 1; rank < messages.count(); ++rank) messages.send(rank, bytes_of(request));
}

std::uint64_t this_machine() { return static_cast<std::uint64_t>(::gethostid()); }

/// Pages as they came, each with its request at the head. What a page leaves is for the next.
class KeptPages {
 public:
  using Page = std::vector<std::byte>;

  Page room(std::size_t bytes) {
    if (spare_.empty()) return Page(bytes);
    Page page = std::move(spare_.back());
    spare_.pop_back();
    page.resize(bytes);
    return page;
  }
  void keep(std::uint64_t number, Page page) { pages_[number] = std::move(page); }
  /// Behind its request; nothing of a page that is not kept.
  [[nodiscard]] std::span<const std::byte> content(std::uint64_t number) const {
    const auto at = pages_.find(number);
    if (at == pages_.end()) return {};
    return std::span(at->second).subspan(sizeof(PageRequest));
  }
  void forget(std::uint64_t number) {
    const auto at = pages_.find(number);
    if (at == pages_.end()) return;
    constexpr std::size_t kSpare = 64;
    if (spare_.size() < kSpare) spare_.push_back(std::move(at->second));
    pages_.erase(at);
  }

 private:
  std::unordered_map<std::uint64_t, Page> pages_;
  std::vector<Page> spare_;
};

}  // namespace

void serve_pages(RankMessages& messages, const std::function<void(pid_t)>& begins) {
  KeptPages kept;
  for (;;) {
    const auto [from, bytes] = next_message(messages);
    PageRequest request;
    KeptPages::Page page;
    if (bytes == sizeof request) {
      messages.receive(from, std::as_writable_bytes(std::span(&request, 1)));
    } else {
      page = kept.room(bytes);
      messages.receive(from, page);
      std::memcpy(&request, page.data(), sizeof request);
    }
    switch (request.wish) {
      case Wish::begin:
        if (request.pages == this_machine()) begins(static_cast<pid_t>(request.first));
        break;
      case Wish::keep:
        kept.keep(request.first, std::move(page));
        break;
      case Wish::hand_on:
        messages.send(from, kept.content(request.first));
        kept.forget(request.first);
        break;
      case Wish::forget:
        for (std::uint64_t k = 0; k < request.pages; ++k) kept.forget(request.first + k);
        break;
      case Wish::end:
        return;
    }
  }
}

PagesAtRanks::PagesAtRanks(RankMessages& messages, std::size_t page_bytes)
    : messages_(messages), page_bytes_(page_bytes), buffer_(sizeof(PageRequest) + page_bytes) {
  messages_.expect(buffer_.size());
}

void PagesAtRanks::send_page(std::size_t page) {
  const PageRequest request{Wish::keep, page, 1};
  std::memcpy(buffer_.data(), &request, sizeof request);
  messages_.send(home(page), buffer_);
}

void PagesAtRanks::ask_for(std::size_t page) {
  messages_.send(home(page), bytes_of({Wish::hand_on, page, 1}));
}

std::size_t PagesAtRanks::receive_page(std::size_t page) {
  return messages_.receive(home(page), payload());
}

void PagesAtRanks::forget(std::size_t first, std::size_t pages) {
  const std::lock_guard lock(mutex_);
  const auto others = static_cast<std::size_t>(messages_.count() - 1);
  for (std::size_t k = 0; k < std::min(pages, others); ++k) {
    messages_.send(home(first + k), bytes_of({Wish::forget, first, pages}));
  }
}

void begin_page_servers(RankMessages& messages) {
  tell_all(messages, {Wish::begin, static_cast<std::uint64_t>(::getpid()), this_machine()});
}

void end_page_servers(RankMessages& messages) { tell_all(messages, {Wish::end, 0, 0}); }

}  // namespace terrane
