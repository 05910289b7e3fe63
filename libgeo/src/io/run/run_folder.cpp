#include "geo/io/run/run_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "geo/core/error.hpp"
#include "geo/io/files/atomic_file.hpp"

namespace geo::io {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& path, const std::string& reason) {
  throw IoError(fmt::format("{}: {}", path.string(), reason));
}

/// The folder itself or the nearest one above it that exists.
fs::path existing_ancestor(const fs::path& path) {
  fs::path here = fs::absolute(path);
  std::error_code ignored;
  while (!fs::exists(here, ignored) && here.has_relative_path()) here = here.parent_path();
  return here;
}

void remove_file(const fs::path& path) {
  std::error_code error;
  fs::remove(path, error);
  if (error) refuse(path, "could not remove: " + error.message());
}

/// "03-" and so on: a stage file's name begins with its number.
bool is_stage_file(const fs::path& path) {
  const std::string name = path.filename().string();
  return name.size() > 6 && std::isdigit(static_cast<unsigned char>(name[0])) != 0 &&
         std::isdigit(static_cast<unsigned char>(name[1])) != 0 && name[2] == '-' &&
         (path.extension() == ".nc" || path.extension() == ".vti" || path.extension() == ".vtp" ||
          path.extension() == ".csv");
}

}  // namespace

RunFolder::RunFolder(fs::path path) : path_(std::move(path)) {}

RunFolder::~RunFolder() {
  if (locked_ >= 0) ::close(locked_);
}

/// The kernel drops the lock with the process, so that a killed run leaves none behind. A file
/// system without locks is used without.
void RunFolder::lock() {
  if (locked_ >= 0) return;
  locked_ = ::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (locked_ >= 0 && ::flock(locked_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    refuse(path_, "another run is at work in this folder: wait for it or choose another");
  }
}

fs::path RunFolder::stage_file(int number, std::string_view stage,
                               std::string_view extension) const {
  return path_ / fmt::format("{:02}-{}{}", number, stage, extension);
}

bool RunFolder::holds_run() const {
  std::error_code error;
  const auto status = fs::status(path_, error);
  if (!fs::status_known(status)) refuse(path_, "could not look: " + error.message());
  if (!fs::is_directory(status)) return false;
  if (fs::exists(config()) || fs::exists(manifest())) return true;
  for (const auto& entry : fs::directory_iterator(path_, error)) {
    if (is_stage_file(entry.path())) return true;
  }
  if (error) refuse(path_, "could not read: " + error.message());
  return false;
}

void RunFolder::check_writable(double bytes) const {
  const fs::path there = existing_ancestor(path_);
  std::error_code error;
  if (!fs::is_directory(there, error)) {
    refuse(there, error ? error.message() : "is a file, must be a folder");
  }
  if (::access(there.c_str(), W_OK | X_OK) != 0) {
    refuse(there, fmt::format("cannot write here: {}", std::strerror(errno)));
  }
  const auto space = fs::space(there, error);
  if (!error && static_cast<double>(space.available) < bytes) {
    refuse(path_, fmt::format("not enough room on the disk: the run writes about {:.1f} GB, {:.1f} "
                              "GB are free; choose another -o, a smaller --grid or --no-vtk",
                              bytes / 1e9, static_cast<double>(space.available) / 1e9));
  }
}

void RunFolder::open() {
  std::error_code error;
  fs::create_directories(path_, error);
  if (error) refuse(path_, "could not make the folder: " + error.message());
  lock();
  for (const fs::path& folder : {path_, maps(), path_ / "frames"}) {
    if (fs::is_directory(folder, error)) remove_leftovers(folder);
  }
}

void RunFolder::remove_stage(int number, std::string_view stage) const {
  for (const std::string_view extension : {".nc", ".vti", ".vtp", ".csv"}) {
    remove_file(stage_file(number, stage, extension));
  }
  // Its tables, NN-STAGE-NAME.csv.
  const std::string begin = stage_file(number, stage, "-").filename().string();
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(path_, error)) {
    const fs::path name = entry.path().filename();
    if (name.string().starts_with(begin) && name.extension() == ".csv") remove_file(entry.path());
  }
}

void RunFolder::remove_further_islands() const {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(path_, error)) {
    const std::string name = entry.path().filename().string();
    if (is_stage_file(entry.path()) && name.find("-island-") != std::string::npos) {
      remove_file(entry.path());
    }
  }
}

void RunFolder::remove_summaries() const {
  remove_file(collection());
  remove_file(islands());
  remove_file(globes());
  remove_file(report());
  std::error_code error;
  if (!fs::is_directory(maps(), error)) return;
  for (const auto& entry : fs::directory_iterator(maps(), error)) {
    if (entry.path().extension() == ".png") remove_file(entry.path());
  }
}

}  // namespace geo::io
