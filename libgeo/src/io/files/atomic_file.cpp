#include "geo/io/files/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <system_error>
#include <utility>

#include "geo/core/error.hpp"

namespace geo::io {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSuffix = ".tmp";

std::string reason(int error) { return std::generic_category().message(error); }

/// A file descriptor that closes itself.
class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags) : number_(::open(path.c_str(), flags | O_CLOEXEC)) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int number() const { return number_; }
  [[nodiscard]] bool is_open() const { return number_ >= 0; }

 private:
  int number_;
};

/// The error that appending to a file meets, or 0. A full disk may still hold a few blocks that the
/// failed library gave back, so this asks for more than one of its buffers.
int error_of_appending(const fs::path& path) {
  const Descriptor file(path, O_WRONLY | O_APPEND | O_CREAT);
  if (!file.is_open()) return errno;
  static constexpr std::array<char, 65536> kBlock{};
  constexpr int kBlocks = 64;
  for (int i = 0; i < kBlocks; ++i) {
    if (::write(file.number(), kBlock.data(), kBlock.size()) < 0) return errno;
  }
  return ::fsync(file.number()) == 0 ? 0 : errno;
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

}  // namespace

AtomicFile::AtomicFile(fs::path final_path) : final_(std::move(final_path)) {
  std::string name = final_.filename().string();
  name.insert(name.begin(), '.');
  name += '.' + std::to_string(::getpid());
  name += kSuffix;
  temporary_ = folder_of(final_) / name;
  // Created here, so that a missing folder or permission is told before anything is computed.
  const int file = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) throw IoError("cannot write " + final_.string() + ": " + reason(errno));
  ::close(file);
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void AtomicFile::commit() {
  const auto refuse = [&] {
    throw IoError("cannot write " + final_.string() + ": " + reason(errno));
  };
  {
    const Descriptor file(temporary_, O_RDONLY);
    if (!file.is_open() || ::fsync(file.number()) != 0) refuse();
  }
  if (::rename(temporary_.c_str(), final_.c_str()) != 0) refuse();
  const Descriptor folder(folder_of(final_), O_RDONLY | O_DIRECTORY);
  // Some file systems cannot flush a folder (EINVAL); the rename itself has been done.
  if (folder.is_open() && ::fsync(folder.number()) != 0 && errno != EINVAL) refuse();
}

void AtomicFile::fail(const std::string& detail) const {
  const int error = error_of_appending(temporary_);
  throw IoError("cannot write " + final_.string() + ": " + (error != 0 ? reason(error) : detail));
}

void write_text_file(const fs::path& path, const std::string& text) {
  AtomicFile file(path);
  std::ofstream stream(file.temporary(), std::ios::binary);
  stream << text << std::flush;
  if (!stream) file.fail("write failed");
  stream.close();
  file.commit();
}

void copy_whole_file(const fs::path& from, const fs::path& to) {
  AtomicFile file(to);
  std::error_code error;
  fs::copy_file(from, file.temporary(), fs::copy_options::overwrite_existing, error);
  if (error) file.fail(error.message());
  file.commit();
}

void remove_leftovers(const fs::path& folder) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with('.') && name.ends_with(kSuffix)) fs::remove(entry.path(), ignored);
  }
}

}  // namespace geo::io
