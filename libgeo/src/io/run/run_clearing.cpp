#include "io/run/run_clearing.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "geo/io/files/atomic_file.hpp"

namespace geo::io {
namespace {

/// An island that was made by command and has the name of the run's own becomes a further one. Its
/// files have both names until the manifest knows the new one.
void name_islands_anew(const StageFolder& at, const RunPlan& plan, Manifest& manifest) {
  const std::string_view own = at.run.name_of(plan.first);
  for (StageRecord& record : manifest.stages) {
    if (!record.on_command || record.name != own) continue;
    record.name = manifest.free_name(own, 2);
    const auto digests = std::exchange(record.file_digests, {});
    for (std::string& file : record.files) {
      const std::string before = file;
      const auto extension = std::filesystem::path(before).extension().string();
      const auto path = at.folder.stage_file(at.numbers[plan.first], record.name, extension);
      file = path.filename().string();
      if (std::filesystem::exists(at.folder.path() / before)) {
        copy_whole_file(at.folder.path() / before, path);
      }
      if (const auto known = digests.find(before); known != digests.end()) {
        record.file_digests[file] = known->second;
      }
    }
  }
}

}  // namespace

void clear_for_run(const StageFolder& at, const RunPlan& plan, Manifest& manifest) {
  manifest.complete = false;
  manifest.files.clear();
  // From here on no stage that is about to be replaced counts as complete.
  const bool planet_stays = at.run.pipeline.stages()[plan.first]->info().own_grid;
  if (planet_stays) name_islands_anew(at, plan, manifest);
  std::erase_if(manifest.stages, [&](const StageRecord& record) {
    if (record.on_command) return !planet_stays;
    const int position = at.run.pipeline.find(record.name);
    return position < plan.begin || position >= plan.first;
  });
  write_manifest(at.folder.manifest(), manifest);
  for (int k = 0; k < static_cast<int>(at.run.pipeline.stages().size()); ++k) {
    if (k >= plan.begin && k < plan.first) continue;
    at.folder.remove_stage(at.numbers[k], at.run.name_of(k));
  }
  if (!planet_stays) at.folder.remove_further_islands();
  at.folder.remove_summaries();
}

}  // namespace geo::io
