#include "geo/io/report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <pugixml.hpp>
#include <sstream>

#include "embedded_data.hpp"
#include "geo/io/atomic_file.hpp"

namespace geo::io {
namespace {

pugi::xml_node add(pugi::xml_node parent, const char* tag, const std::string& text = {}) {
  auto node = parent.append_child(tag);
  if (!text.empty()) node.append_child(pugi::node_pcdata).set_value(text.c_str());
  return node;
}

void add_head(pugi::xml_node html, const std::string& title) {
  auto head = add(html, "head");
  add(head, "meta").append_attribute("charset") = "utf-8";
  auto viewport = add(head, "meta");
  viewport.append_attribute("name") = "viewport";
  viewport.append_attribute("content") = "width=device-width, initial-scale=1";
  add(head, "title", title);
  add(head, "style", std::string(embedded_file("report/report.css")));
}

void add_pictures(pugi::xml_node main, const std::filesystem::path& folder,
                  const std::vector<MapFile>& maps) {
  for (const auto& map : maps) {
    auto figure = add(main, "figure");
    const std::string path = map.path.lexically_proximate(folder).generic_string();
    auto link = add(figure, "a");
    link.append_attribute("href") = path.c_str();
    auto image = add(link, "img");
    image.append_attribute("src") = path.c_str();
    image.append_attribute("alt") = map.title.c_str();
    image.append_attribute("loading") = "lazy";
    if (map.width_px > 0) {
      image.append_attribute("width") = map.width_px;
      image.append_attribute("height") = map.height_px;
    }
    auto caption = add(figure, "figcaption");
    add(caption, "strong", map.title);
    caption.append_child(pugi::node_pcdata).set_value((" " + map.caption).c_str());
  }
}

std::string shown(double value) {
  return std::isfinite(value) ? fmt::format("{:.5g}", value) : "–";
}

void add_fields(pugi::xml_node main, const std::vector<FieldFigures>& fields) {
  add(main, "h2", "Fields");
  auto scroll = add(main, "div");
  scroll.append_attribute("class") = "wide";
  auto table = add(scroll, "table");
  auto heads = add(add(table, "thead"), "tr");
  for (const char* head : {"field", "min", "mean", "max", "unit", "meaning"}) {
    add(heads, "th", head).append_attribute("scope") = "col";
  }
  auto body = add(table, "tbody");
  for (const auto& field : fields) {
    auto row = add(body, "tr");
    add(add(row, "td"), "code", field.name);
    for (const double value : {field.min, field.mean, field.max}) {
      add(row, "td", shown(value)).append_attribute("class") = "number";
    }
    add(row, "td", field.units);
    add(row, "td", field.doc);
  }
}

void add_provenance(pugi::xml_node main,
                    const std::vector<std::pair<std::string, std::string>>& provenance) {
  add(main, "h2", "Provenance");
  auto list = add(main, "dl");
  for (const auto& [name, value] : provenance) {
    add(list, "dt", name);
    add(list, "dd", value);
  }
}

template <class T>
bool is_value(T value, int missing) {
  if constexpr (std::is_floating_point_v<T>) {
    return std::isfinite(value);
  } else {
    return value != missing;
  }
}

template <class T>
FieldFigures summarise(const Grid& grid, const FieldSpec& spec, const std::vector<T>& values) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  struct Row {
    double sum = 0.0, area = 0.0, min = kInfinity, max = -kInfinity;
  };
  std::vector<Row> rows(grid.ny());
#pragma omp parallel for schedule(static)
  for (int row = 0; row < grid.ny(); ++row) {
    Row& here = rows[row];
    for (int column = 0; column < grid.nx(); ++column) {
      const T value = values[grid.cell(column, row)];
      if (!is_value(value, spec.missing)) continue;
      here.sum += static_cast<double>(value) * grid.area_m2(row);
      here.area += grid.area_m2(row);
      here.min = std::min(here.min, static_cast<double>(value));
      here.max = std::max(here.max, static_cast<double>(value));
    }
  }
  Row all;
  for (const Row& row : rows) {
    all.sum += row.sum;
    all.area += row.area;
    all.min = std::min(all.min, row.min);
    all.max = std::max(all.max, row.max);
  }
  FieldFigures summary{std::string(spec.name), std::string(spec.units), std::string(spec.doc)};
  const bool empty = !(all.area > 0.0);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  summary.min = empty ? kNaN : all.min;
  summary.mean = empty ? kNaN : all.sum / all.area;
  summary.max = empty ? kNaN : all.max;
  return summary;
}

// Numbers of cells, lakes and basins are integers without flags.
bool is_measured(const FieldSpec& spec) {
  return spec.type == Type::float32 || spec.type == Type::float64;
}

}  // namespace

std::vector<FieldFigures> summarise_fields(const State& state) {
  std::vector<FieldFigures> summaries;
  for (const FieldSpec* spec : state.present()) {
    if (!is_measured(*spec)) continue;
    std::visit(
        [&](const auto& values) { summaries.push_back(summarise(state.grid(), *spec, values)); },
        *state.values(*spec));
  }
  return summaries;
}

std::filesystem::path write_report(const std::filesystem::path& folder, const Report& report) {
  pugi::xml_document document;
  document.append_child(pugi::node_doctype).set_value("html");
  auto html = document.append_child("html");
  html.append_attribute("lang") = "en";
  add_head(html, report.title);
  auto main = add(add(html, "body"), "main");
  add(main, "h1", report.title);
  if (!report.introduction.empty()) add(main, "p", report.introduction);
  add_pictures(main, folder, report.maps);
  if (!report.fields.empty()) add_fields(main, report.fields);
  if (!report.parameters.empty()) {
    auto details = add(main, "details");
    add(details, "summary", "Parameters");
    add(details, "pre", report.parameters);
  }
  if (!report.provenance.empty()) add_provenance(main, report.provenance);

  std::ostringstream text;
  // As HTML wants it: no XML declaration, and no indentation that `pre` would show.
  document.save(text, "", pugi::format_raw | pugi::format_no_declaration, pugi::encoding_utf8);
  const auto path = folder / "report.html";
  write_text_file(path, text.str() + "\n");
  return path;
}

}  // namespace geo::io
