#include "geo/io/report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "geo/core/error.hpp"
#include "geo/io/atomic_file.hpp"
#include "geo/io/config.hpp"
#include "geo/io/stage_file.hpp"

namespace geo::io {
namespace {

constexpr std::string_view kHead = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>terrane</title>
<style>
body { font: 15px/1.5 system-ui, sans-serif; color: #222; background: #fafaf8; margin: 0 auto;
       max-width: 1200px; padding: 1.5rem; }
h1 { font-weight: 600; } h2 { margin-top: 2.5rem; font-weight: 600; }
figure { margin: 1.5rem 0; } figure img { width: 100%; height: auto; border: 1px solid #ddd; }
figcaption { color: #555; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
td, th { padding: .2rem .8rem .2rem 0; text-align: left; border-bottom: 1px solid #e4e4e0; }
td.n, th.n { text-align: right; }
pre { background: #f0f0ec; padding: 1rem; overflow-x: auto; font-size: 13px; }
</style>
</head>
<body>
)";

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '&':
        safe += "&amp;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

std::string figure(double number) {
  return std::isnan(number) ? std::string("none") : fmt::format("{:.5g}", number);
}

std::string pictures(const std::vector<MapFile>& maps, const std::filesystem::path& folder) {
  std::string html;
  for (const MapFile& map : maps) {
    html += fmt::format(
        "<figure><img src=\"{}\" alt=\"{}\" width=\"{}\" height=\"{}\" loading=\"lazy\">"
        "<figcaption><b>{}.</b> {}</figcaption></figure>\n",
        escaped(map.path.lexically_relative(folder).generic_string()), escaped(map.title),
        map.width_px, map.height_px, escaped(map.title), escaped(map.caption));
  }
  return html;
}

std::string field_table(const StageRecord& stage) {
  std::string html =
      "<table><tr><th>field</th><th>unit</th><th class=n>min</th><th class=n>mean</th>"
      "<th class=n>max</th></tr>\n";
  for (const FieldSummary& field : stage.fields) {
    html += fmt::format(
        "<tr><td>{}</td><td>{}</td><td class=n>{}</td><td class=n>{}</td><td class=n>{}</td></tr>"
        "\n",
        escaped(field.name), escaped(field.units), figure(field.min), figure(field.mean),
        figure(field.max));
  }
  return html + "</table>\n";
}

std::string budget_table(const StageRecord& stage) {
  if (stage.budget.empty()) return {};
  std::string html = "<table><tr><th>budget</th><th class=n>value</th></tr>\n";
  for (const auto& [name, value] : stage.budget) {
    html += fmt::format("<tr><td>{}</td><td class=n>{}</td></tr>\n", escaped(name), figure(value));
  }
  return html + "</table>\n";
}

}  // namespace

void write_report(const std::filesystem::path& path, const Report& report) {
  const Manifest& manifest = report.manifest;
  std::string html(kHead);
  html += fmt::format("<h1>A planet by terrane {}</h1>\n<p>Seed {}, commit {}.</p>\n",
                      escaped(manifest.version), manifest.seed, escaped(manifest.commit));
  html += pictures(report.maps, path.parent_path());
  html += "<h2>Figures</h2>\n";
  for (const StageRecord& stage : manifest.stages) {
    html += fmt::format("<h3>{}</h3>\n", escaped(stage.name));
    html += field_table(stage) + budget_table(stage);
    for (const std::string& warning : stage.warnings) {
      html += fmt::format("<p>{}</p>\n", escaped(warning));
    }
  }
  html += fmt::format("<h2>Parameters</h2>\n<pre>{}</pre>\n</body>\n</html>\n",
                      escaped(report.config_toml));
  write_text_file(path, html);
}

std::vector<std::filesystem::path> draw_run(const RunFolder& folder, int map_width_px) {
  Report report{read_manifest(folder.manifest()), read_text(folder.config()), {}};
  std::optional<State> state;
  for (const StageRecord& stage : report.manifest.stages) {
    for (const std::string& file : stage.files) {
      if (std::filesystem::path(file).extension() != ".nc") continue;
      Snapshot snapshot = read_netcdf(folder.path() / file);
      if (!state) state.emplace(snapshot.grid);
      for (const auto& [spec, values] : snapshot.fields) state->set(*spec, *values);
    }
  }
  if (!state) {
    throw InputError(
        fmt::format("{}: holds no complete stage to draw", folder.path().string()));
  }
  const std::string note =
      fmt::format("seed {}, terrane {}", report.manifest.seed, report.manifest.version);
  report.maps = draw_map_files(*state, folder.maps(), map_width_px, note);
  if (state->has(field::elevation)) {
    report.maps.push_back(draw_hypsometry_file(*state, folder.maps(), note));
  }
  write_report(folder.report(), report);
  std::vector<std::filesystem::path> written;
  for (const MapFile& map : report.maps) written.push_back(map.path);
  written.push_back(folder.report());
  return written;
}

}  // namespace geo::io
