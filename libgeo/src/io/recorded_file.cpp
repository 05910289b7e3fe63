#include "geo/io/recorded_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <omp.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <system_error>

#include "geo/core/error.hpp"

namespace geo::io {
namespace {

namespace fs = std::filesystem;

/// What a reader beside this process found.
struct Finding {
  bool is_readable = false;
  std::string text;  ///< why it is not, or what differs
};

std::string read_to_end(int pipe) {
  std::string text;
  std::array<char, 4096> block{};
  while (true) {
    const ssize_t size = ::read(pipe, block.data(), block.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return text;
    text.append(block.data(), static_cast<std::size_t>(size));
  }
}

/// In the new process: nothing that this one began is there but the memory.
[[noreturn]] void read_and_tell(const fs::path& path, const StageRecord& record, int pipe,
                                unsigned patience_s) {
  omp_set_num_threads(1);
  for (const int signal : {SIGALRM, SIGINT, SIGTERM}) std::signal(signal, SIG_DFL);
  ::alarm(patience_s);
  if (const int nowhere = ::open("/dev/null", O_WRONLY); nowhere >= 0) {
    ::dup2(nowhere, STDERR_FILENO);
  }
  std::string text;
  try {
    text = fmt::format("+{}", disagreement(record, read_netcdf(path)));
  } catch (const Error& error) {
    text = fmt::format("-{}", error.what());
  } catch (...) {
    ::_exit(1);
  }
  const ssize_t told = ::write(pipe, text.data(), text.size());
  ::_exit(told == static_cast<ssize_t>(text.size()) ? 0 : 1);
}

/// Reads a file in a process of its own and compares its values.
Finding read_beside(const fs::path& path, const StageRecord& record) {
  std::error_code ignored;
  const auto bytes = fs::file_size(path, ignored);
  const auto patience_s = static_cast<unsigned>(30 + (ignored ? 0 : bytes / 5'000'000));
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) {
    throw IoError(fmt::format("{}: could not be examined: {}", path.string(),
                              std::generic_category().message(errno)));
  }
  const pid_t reader = ::fork();
  if (reader == 0) read_and_tell(path, record, pipe[1], patience_s);
  ::close(pipe[1]);
  const std::string text = reader > 0 ? read_to_end(pipe[0]) : "";
  ::close(pipe[0]);
  int status = 1;
  while (reader > 0 && ::waitpid(reader, &status, 0) < 0 && errno == EINTR) {
  }
  const bool ended_well = WIFEXITED(status) && WEXITSTATUS(status) == 0 && !text.empty();
  if (!ended_well) return {false, fmt::format("{}: damaged", path.string())};
  return {text.front() == '+', text.substr(1)};
}

bool has_written_bytes(const fs::path& folder, const StageRecord& record, const std::string& name) {
  const auto written = record.file_digests.find(name);
  return written != record.file_digests.end() && digest_of_file(folder / name) == written->second;
}

[[noreturn]] void refuse(const fs::path& path, const std::string& difference) {
  throw InputError(
      fmt::format("{}: is not what manifest.json says: {}; without the file, terrane run --resume "
                  "makes it anew",
                  path.string(), difference));
}

}  // namespace

Standing standing_of(const fs::path& folder, const StageRecord& record) {
  const std::string name = netcdf_of(record);
  const fs::path path = folder / name;
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return {.fault = "missing", .difference = {}};
  if (has_written_bytes(folder, record, name)) {
    return {.fault = {}, .difference = disagreement(record, read_netcdf(path))};
  }
  const Finding found = read_beside(path, record);
  if (found.is_readable) return {.fault = {}, .difference = found.text};
  return {.fault = found.text, .difference = {}};
}

Snapshot read_recorded(const fs::path& folder, const StageRecord& record,
                       const std::function<bool(const FieldSpec&)>& wanted) {
  const std::string name = netcdf_of(record);
  const fs::path path = folder / name;
  std::error_code ignored;
  if (fs::exists(path, ignored) && !has_written_bytes(folder, record, name)) {
    const Finding found = read_beside(path, record);
    if (!found.is_readable) throw InputError(found.text);
    if (!found.text.empty()) refuse(path, found.text);
  }
  Snapshot snapshot = read_netcdf(path, wanted);
  for (const auto& [spec, values] : snapshot.fields) {
    const std::string difference = disagreement(record, *spec, *values);
    if (!difference.empty()) refuse(path, difference);
  }
  return snapshot;
}

Snapshot read_perhaps_recorded(const fs::path& file,
                               const std::function<bool(const FieldSpec&)>& wanted) {
  const fs::path folder = file.parent_path(), manifest = folder / "manifest.json";
  std::error_code ignored;
  if (fs::exists(manifest, ignored)) {
    const Manifest known = read_manifest(manifest);
    for (const StageRecord& record : known.stages) {
      if (netcdf_of(record) == file.filename()) return read_recorded(folder, record, wanted);
    }
  }
  return read_netcdf(file, wanted);
}

std::map<std::string, std::string> digests_of_summaries(const RunFolder& folder) {
  std::map<std::string, std::string> digests;
  const auto add = [&](const fs::path& path) {
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) return;
    digests[path.lexically_relative(folder.path()).generic_string()] = digest_of_file(path);
  };
  for (const fs::path& path :
       {folder.config(), folder.report(), folder.collection(), folder.islands(), folder.globes()}) {
    add(path);
  }
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder.maps(), none)) {
    if (entry.path().extension() == ".png") add(entry.path());
  }
  return digests;
}

void record_summaries(const RunFolder& folder) {
  Manifest manifest = read_manifest(folder.manifest());
  manifest.files = digests_of_summaries(folder);
  write_manifest(folder.manifest(), manifest);
}

Verification verify_run(const fs::path& place) {
  const RunFolder folder(place);
  std::error_code ignored;
  if (!fs::exists(folder.manifest(), ignored)) {
    throw ConfigurationError(fmt::format(
        "--verify {}: holds no manifest.json: give the folder of a run", place.string()));
  }
  const Manifest manifest = read_manifest(folder.manifest());
  Verification found;
  const auto note = [&](const std::string& name, const std::string& what) {
    found.differences.push_back(fmt::format("{}: {}", name, what));
  };
  const auto compare_bytes = [&](const std::string& name, const std::string& digest) {
    ++found.files;
    if (!fs::exists(place / name, ignored)) {
      note(name, "missing");
    } else if (!digest.empty() && digest_of_file(place / name) != digest) {
      note(name, "bytes differ");
    }
  };
  for (const StageRecord& record : manifest.stages) {
    const std::string netcdf = netcdf_of(record);
    for (const std::string& name : record.files) {
      const auto written = record.file_digests.find(name);
      const std::string digest = written == record.file_digests.end() ? "" : written->second;
      if (name != netcdf) {
        compare_bytes(name, digest);
        continue;
      }
      ++found.files;
      found.fields += static_cast<int>(record.fields.size());
      const Standing standing = standing_of(place, record);
      if (!standing.fault.empty()) {
        note(name, standing.fault);
      } else if (!standing.difference.empty()) {
        note(name, standing.difference);
      } else if (!digest.empty() && digest_of_file(place / name) != digest) {
        note(name, "bytes differ, values do not");
      }
    }
  }
  for (const auto& [name, digest] : manifest.files) compare_bytes(name, digest);
  return found;
}

}  // namespace geo::io
