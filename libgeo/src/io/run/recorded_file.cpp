#include "geo/io/run/recorded_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "geo/core/error.hpp"
#include "io/files/vouched_bytes.hpp"

namespace geo::io {
namespace {

namespace fs = std::filesystem;

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
  const fs::path path = folder / netcdf_of(record);
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return {.fault = "missing", .difference = {}};
  try {
    return {.fault = {}, .difference = disagreement(record, read_netcdf(path))};
  } catch (const InputError& error) {
    return {.fault = error.what(), .difference = {}};
  }
}

Snapshot read_recorded(const fs::path& folder, const StageRecord& record,
                       const std::function<bool(const FieldSpec&)>& wanted) {
  const std::string name = netcdf_of(record);
  const fs::path path = folder / name;
  std::error_code ignored;
  // The bytes of a file that has not changed are read once.
  if (fs::exists(path, ignored) && !is_as_recorded(path) &&
      !has_written_bytes(folder, record, name)) {
    const std::string difference = disagreement(record, read_netcdf(path));
    if (!difference.empty()) refuse(path, difference);
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
