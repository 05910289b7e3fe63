#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "page_store.hpp"

namespace terrane {

/// Pages in a file without a name, which ends with the program, however that ends. Its room on the
/// disk is reserved block by block. Pages that left memory stay in the system's cache of files as
/// long as the machine has memory to spare.
class ScratchFile : public PageStore {
 public:
  /// `folder`, or the nearest one above it that exists, takes the file. Throws IoError where it
  /// cannot.
  explicit ScratchFile(const std::filesystem::path& folder);
  ~ScratchFile() override;

  /// The region lies in the file from now on. Throws IoError where that cannot be.
  void map(std::byte* base, std::size_t bytes);

  bool reserve(PageRanges::Range range) override;
  void send_away(PageRanges::Range range) override;
  PageRanges::Trace drop(PageRanges::Range range) override;
  void forget(PageRanges::Range range) override;
  [[nodiscard]] std::size_t least_clear_bytes(std::size_t cap_bytes) const override;

  /// What to say when the disk has no more room.
  [[nodiscard]] std::string full_message() const;

 private:
  std::filesystem::path folder_;
  int file_ = -1;
  std::byte* base_ = nullptr;
};

}  // namespace terrane
