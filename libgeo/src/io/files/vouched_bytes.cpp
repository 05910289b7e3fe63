#include "vouched_bytes.hpp"

#include <sys/stat.h>

#include <map>
#include <mutex>
#include <tuple>

#include "geo/core/error.hpp"
#include "geo/io/files/digest.hpp"
#include "geo/io/run/manifest.hpp"

namespace geo::io {
namespace {

/// What tells one state of a file from another without reading it.
using Stamp = std::tuple<std::string, dev_t, ino_t, off_t, time_t, long>;

Stamp stamp_of(const std::filesystem::path& path) {
  struct stat state {};
  if (::stat(path.c_str(), &state) != 0) return {};
  return {path.string(), state.st_dev,         state.st_ino,
          state.st_size, state.st_mtim.tv_sec, state.st_mtim.tv_nsec};
}

bool look_up(const std::filesystem::path& path) {
  const auto manifest = path.parent_path() / "manifest.json";
  std::error_code error;
  if (!std::filesystem::is_regular_file(manifest, error)) return false;
  try {
    for (const StageRecord& record : read_manifest(manifest).stages) {
      const auto found = record.file_digests.find(path.filename().string());
      if (found != record.file_digests.end()) return found->second == digest_of_file(path);
    }
  } catch (const Error&) {
    // A manifest that nobody understands vouches for nothing.
  }
  return false;
}

}  // namespace

bool is_as_recorded(const std::filesystem::path& path) {
  static std::mutex mutex;
  static std::map<Stamp, bool> known;
  const Stamp stamp = stamp_of(path);
  const std::lock_guard lock(mutex);
  const auto [entry, is_new] = known.try_emplace(stamp, false);
  if (is_new) entry->second = look_up(path);
  return entry->second;
}

}  // namespace geo::io
