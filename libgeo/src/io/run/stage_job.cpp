#include "io/run/stage_job.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "geo/io/files/atomic_file.hpp"
#include "geo/io/files/build_info.hpp"
#include "geo/io/files/source_date.hpp"
#include "geo/io/run/recorded_file.hpp"
#include "io/vtk/globe_files.hpp"

namespace geo::io {
namespace {

/// A table as comma-separated values with a line of names.
std::string text_of(const StepTable& steps) {
  std::string text = fmt::format("{}\n", fmt::join(steps.columns, ","));
  for (const auto& row : steps.rows) {
    for (std::size_t k = 0; k < steps.columns.size(); ++k) {
      if (k > 0) text += ',';
      if (k < row.size() && std::isfinite(row[k])) text += fmt::format("{}", row[k]);
    }
    text += '\n';
  }
  return text;
}

std::string text_of(const TextTable& table) {
  std::string text = fmt::format("{}\n", fmt::join(table.columns, ","));
  for (const auto& row : table.rows) text += fmt::format("{}\n", fmt::join(row, ","));
  return text;
}

std::string references_of(const RunConfiguration& run, int position) {
  std::vector<std::string_view> sources;
  for (const Parameter& parameter : run.parameters) {
    const std::string prefix = fmt::format("{}.", run.name_of(position));
    if (!parameter.name.starts_with(prefix) || parameter.source == "design") continue;
    if (std::find(sources.begin(), sources.end(), parameter.source) == sources.end()) {
      sources.push_back(parameter.source);
    }
  }
  std::sort(sources.begin(), sources.end());
  return fmt::format("docs/references.bib: {}", fmt::join(sources, ", "));
}

}  // namespace

void StageJob::write(const RunSettings& settings) {
  for (const auto& [spec, values] : snapshot.fields) {
    record.fields.push_back(summarise(*spec, *values, *snapshot.grid));
  }
  // What reads all fields at once comes first: to NetCDF they go one by one, and leave memory.
  if (settings.vtk) {
    write_vti(vti, snapshot, provenance, static_cast<int>(settings.vtk_compression));
  }
  const auto release = [&](const FieldSpec& written) {
    for (auto& [spec, values] : snapshot.fields) {
      if (spec == &written) values.reset();
    }
  };
  write_netcdf(netcdf, snapshot, provenance, static_cast<int>(settings.compression), release);
  const auto folder = netcdf.parent_path();
  record.list(folder, netcdf.filename().string());
  if (settings.vtk) record.list(folder, vti.filename().string());
  if (!steps.rows.empty()) write_table(csv, text_of(steps));
  for (const TextTable& table : tables) {
    write_table(csv.parent_path() / fmt::format("{}-{}.csv", csv.stem().string(), table.name),
                text_of(table));
  }
}
void StageJob::write_table(const std::filesystem::path& path, const std::string& text) {
  write_text_file(path, text);
  record.list(path.parent_path(), path.filename().string());
}

Provenance provenance_of(const RunConfiguration& run, int position, const std::string& config) {
  const auto& build = build_info();
  return {.title = fmt::format("terrane: {}", run.name_of(position)),
          .config_toml = config,
          .seed = static_cast<std::uint64_t>(run.settings.seed),
          .version = build.version,
          .history = fmt::format("{:%Y-%m-%dT%H:%M:%SZ} terrane {} ({}): stage {}",
                                 fmt::gmtime(now_or_given()), build.version, build.commit,
                                 run.name_of(position)),
          .references = references_of(run, position)};
}

StageJob job_of(const StageFolder& at, int position, const std::string& config, const State& state,
                const Context& context, double seconds) {
  const RunConfiguration& run = at.run;
  StageJob job;
  job.snapshot.stage = run.name_of(position);
  job.snapshot.grid = state.shared_grid();
  const auto& written = run.stage(position).info().writes;
  for (const FieldSpec* spec : written) {
    job.snapshot.fields.emplace_back(spec, state.values(*spec));
  }
  const bool makes_months =
      std::find(written.begin(), written.end(), &field::temperature) != written.end() &&
      !run.stage(position).info().own_grid;
  if (run.settings.monthly && makes_months) job.snapshot.months = context.monthly_fields;
  job.provenance = provenance_of(run, position, config);
  job.netcdf = at.file_of(position, ".nc");
  job.vti = at.file_of(position, ".vti");
  job.csv = at.file_of(position, ".csv");
  job.steps = context.steps;
  job.tables = context.tables;
  job.record.name = run.name_of(position);
  job.record.own_grid = run.stage(position).info().own_grid;
  job.record.builder = this_builder();
  job.record.seconds = time_is_given() ? 0.0 : seconds;
  job.record.budget = context.budget;
  job.record.events = context.event_records;
  job.record.warnings = context.warnings;
  return job;
}

}  // namespace geo::io
