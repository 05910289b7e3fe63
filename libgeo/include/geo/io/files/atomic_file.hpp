#pragma once

#include <filesystem>
#include <string>

namespace geo::io {

/// A file that appears under its name only when it is whole. Write to `temporary()`, a hidden name
/// in the same folder, then `commit()`: flush file and folder to the disk and rename. Without
/// commit the temporary file is removed.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path final_path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  [[nodiscard]] const std::filesystem::path& temporary() const noexcept { return temporary_; }
  /// Throws IoError that names the final path and the reason.
  void commit();
  /// IoError for a library that failed to write the temporary file without saying why: asks the
  /// file system by appending to the file. `detail` is used when it finds nothing wrong.
  [[noreturn]] void fail(const std::string& detail) const;

 private:
  std::filesystem::path final_, temporary_;
};

/// Writes a short text file whole or not at all. Throws IoError.
void write_text_file(const std::filesystem::path& path, const std::string& text);

/// Copies a file whole or not at all. Throws IoError.
void copy_whole_file(const std::filesystem::path& from, const std::filesystem::path& to);

/// Removes temporary files that a killed run left in a folder.
void remove_leftovers(const std::filesystem::path& folder);

}  // namespace geo::io
