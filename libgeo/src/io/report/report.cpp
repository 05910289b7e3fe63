#include "geo/io/report/report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <pugixml.hpp>
#include <sstream>
#include <tuple>

#include "geo/io/files/atomic_file.hpp"
#include "geo/io/files/embedded_data.hpp"
#include "report_scorecard.hpp"

namespace geo::io {
namespace {

/// A comment of this name stands where the globe, which is markup already, goes.
constexpr const char* kGlobesName = "globe";

void add_head(pugi::xml_node html, const std::string& title) {
  auto head = add_element(html, "head");
  add_element(head, "meta").append_attribute("charset") = "utf-8";
  auto viewport = add_element(head, "meta");
  viewport.append_attribute("name") = "viewport";
  viewport.append_attribute("content") = "width=device-width, initial-scale=1";
  add_element(head, "title", title);
  add_element(head, "style", std::string(embedded_file("report/report.css")));
}

/// A heading that contents can lead to.
void add_heading(pugi::xml_node main, const char* id, const char* words) {
  add_element(main, "h2", words).append_attribute("id") = id;
}

/// Links to what the page has, in its order.
void add_contents(pugi::xml_node main, const Report& report) {
  const std::tuple<const char*, const char*, bool> parts[] = {
      {"globe", "Globe", !report.globe.empty()},
      {"maps", "Maps", !report.maps.empty()},
      {"beside-earth", "Beside Earth", report.scorecard && !report.scorecard->lines.empty()},
      {"events", "Events", !report.events.empty()},
      {"fields", "Fields", !report.fields.empty()},
      {"parameters", "Parameters", !report.parameters.empty()},
      {"provenance", "Provenance", !report.provenance.empty()}};
  auto nav = add_element(main, "nav");
  nav.append_attribute("aria-label") = "Contents";
  for (const auto& [id, words, is_there] : parts) {
    if (is_there)
      add_element(nav, "a", words).append_attribute("href") = fmt::format("#{}", id).c_str();
  }
}

void add_pictures(pugi::xml_node main, const std::filesystem::path& folder,
                  const std::vector<MapFile>& maps) {
  for (const auto& map : maps) {
    auto figure = add_element(main, "figure");
    const std::string path = map.path.lexically_proximate(folder).generic_string();
    auto link = add_element(figure, "a");
    link.append_attribute("href") = path.c_str();
    auto image = add_element(link, "img");
    image.append_attribute("src") = path.c_str();
    image.append_attribute("alt") = map.title.c_str();
    image.append_attribute("loading") = "lazy";
    if (map.width_px > 0) {
      image.append_attribute("width") = map.width_px;
      image.append_attribute("height") = map.height_px;
    }
    auto caption = add_element(figure, "figcaption");
    add_element(caption, "strong", map.title);
    caption.append_child(pugi::node_pcdata).set_value((" " + map.caption).c_str());
  }
}

std::string shown(double value) {
  return std::isfinite(value) ? fmt::format("{:.5g}", value) : "–";
}

void add_fields(pugi::xml_node main, const std::vector<FieldFigures>& fields) {
  add_heading(main, "fields", "Fields");
  auto scroll = add_element(main, "div");
  scroll.append_attribute("class") = "wide";
  auto table = add_element(scroll, "table");
  auto heads = add_element(add_element(table, "thead"), "tr");
  for (const char* head : {"field", "min", "mean", "max", "unit", "meaning"}) {
    add_element(heads, "th", head).append_attribute("scope") = "col";
  }
  auto body = add_element(table, "tbody");
  for (const auto& field : fields) {
    auto row = add_element(body, "tr");
    add_element(add_element(row, "td"), "code", field.name);
    for (const double value : {field.min, field.mean, field.max}) {
      add_element(row, "td", shown(value)).append_attribute("class") = "number";
    }
    add_element(row, "td", field.units);
    add_element(row, "td", field.doc);
  }
}

void add_events(pugi::xml_node main, const std::vector<std::string>& events) {
  add_heading(main, "events", "Events");
  auto list = add_element(main, "ol");
  for (const auto& event : events) add_element(list, "li", event);
}

void add_provenance(pugi::xml_node main,
                    const std::vector<std::pair<std::string, std::string>>& provenance) {
  add_heading(main, "provenance", "Provenance");
  auto list = add_element(main, "dl");
  for (const auto& [name, value] : provenance) {
    add_element(list, "dt", name);
    add_element(list, "dd", value);
  }
}

// Numbers of cells, lakes and basins are integers without flags.
bool is_measured(const FieldSpec& spec) {
  return spec.type == Type::float32 || spec.type == Type::float64;
}

}  // namespace

std::vector<FieldFigures> field_figures(const Manifest& manifest) {
  std::vector<FieldFigures> figures;
  for (const FieldSpec* spec : field::all()) {
    if (!is_measured(*spec)) continue;
    const FieldRecord* last = nullptr;
    for (const StageRecord& stage : manifest.stages) {
      if (stage.own_grid) continue;
      for (const FieldRecord& field : stage.fields) {
        if (field.name == spec->name) last = &field;
      }
    }
    if (last == nullptr) continue;
    figures.push_back({std::string(spec->name), std::string(spec->units), std::string(spec->doc),
                       last->min, last->mean, last->max});
  }
  return figures;
}

std::filesystem::path write_report(const std::filesystem::path& folder, const Report& report) {
  pugi::xml_document document;
  document.append_child(pugi::node_doctype).set_value("html");
  auto html = document.append_child("html");
  html.append_attribute("lang") = "en";
  add_head(html, report.title);
  auto main = add_element(add_element(html, "body"), "main");
  add_element(main, "h1", report.title);
  if (!report.introduction.empty()) add_element(main, "p", report.introduction);
  add_contents(main, report);
  if (!report.globe.empty()) main.append_child(pugi::node_comment).set_value(kGlobesName);
  if (!report.maps.empty()) add_heading(main, "maps", "Maps");
  add_pictures(main, folder, report.maps);
  if (report.scorecard && !report.scorecard->lines.empty()) {
    add_scorecard(main, *report.scorecard);
  }
  if (!report.events.empty()) add_events(main, report.events);
  if (!report.fields.empty()) add_fields(main, report.fields);
  if (!report.parameters.empty()) {
    auto details = add_element(main, "details");
    details.append_attribute("id") = "parameters";
    add_element(details, "summary", "Parameters");
    add_element(details, "pre", report.parameters);
  }
  if (!report.provenance.empty()) add_provenance(main, report.provenance);

  std::ostringstream text;
  // As HTML wants it: no XML declaration, and no indentation that `pre` would show.
  document.save(text, "", pugi::format_raw | pugi::format_no_declaration, pugi::encoding_utf8);
  std::string page = text.str() + "\n";
  const std::string place = fmt::format("<!--{}-->", kGlobesName);
  if (const auto at = page.find(place); at != std::string::npos) {
    page.replace(at, place.size(), report.globe);
  }
  const auto path = folder / "report.html";
  write_text_file(path, page);
  return path;
}

}  // namespace geo::io
