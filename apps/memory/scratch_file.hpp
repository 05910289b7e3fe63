#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "guarded_pages.hpp"

namespace terrane {

/// Pages in a file without a name, which ends with the program, however that ends. Its room on the
/// disk is reserved block by block.
///
/// A page that is here has memory of its own, of which the system's cache of files knows nothing:
/// it is written when it leaves, and only where it changed since it came. The system's cache keeps
/// what was written as long as the machine has memory to spare. Whoever touches a page that is away
/// reads it back.
class ScratchFile : public GuardedPages {
 public:
  /// The region [base, base + bytes), which is mapped anew, as the pages of a file in `folder`, or
  /// the nearest one above it that exists. Throws IoError where there can be none.
  ScratchFile(const std::filesystem::path& folder, std::byte* base, std::size_t bytes,
              std::size_t page_bytes);
  ~ScratchFile() override;

  bool reserve(PageRanges::Range range) override;
  void send_away(PageRanges::Range range) override;
  PageRanges::Trace drop(PageRanges::Range range) override;
  void forget(PageRanges::Range range) override;

  /// What to say when the disk has no more room.
  [[nodiscard]] std::string full_message() const;

 private:
  void open_fresh(std::size_t page) noexcept override;
  void open_unchanged(std::size_t page) noexcept override;
  void bring_away(std::size_t page, Access access) noexcept override;
  void empty(PageRanges::Range range) noexcept;
  void write(PageRanges::Range range) const;

  std::filesystem::path folder_;
  int file_ = -1;
};

}  // namespace terrane
