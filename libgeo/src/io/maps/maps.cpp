#include "geo/io/maps/maps.hpp"

#include <algorithm>
#include <optional>

#include "io/drawing/map_canvas.hpp"
#include "io/drawing/map_page.hpp"
#include "io/report/side_by_side.hpp"
#include "map_field.hpp"
#include "map_plates.hpp"
#include "map_rivers.hpp"
#include "map_set.hpp"
#include "map_themes.hpp"

namespace geo::io {

/// A map that can be drawn: its words and how.
struct MapPlan {
  std::string file, title, units, caption;
  std::function<void(const Scene&, MapCanvas&)> draw;
  bool is_long = false;  ///< takes longer than others
};

namespace {

std::vector<MapPlan> plan_island(const State& state, const std::string& name) {
  std::vector<MapPlan> plans;
  if (state.has(field::elevation)) {
    plans.push_back({name, "Island", "metres above and below sea level",
                     "A part of the planet in detail: shaded relief, contours, rivers and lakes.",
                     draw_island, /*is_long=*/true});
  }
  for (const auto& map : category_maps()) {
    if (!state.has(*map.field)) continue;
    plans.push_back(
        {name + "-" + map.file, std::string(map.title) + " of the island", map.units, map.caption,
         [&map](const Scene& scene, MapCanvas& canvas) { draw_categories(map, scene, canvas); }});
  }
  return plans;
}

std::vector<MapPlan> plan_maps(const State& state) {
  std::vector<MapPlan> plans;
  if (state.has(field::elevation)) {
    plans.push_back({"elevation", "Elevation", "metres above and below sea level",
                     "Elevation in colours over relief shaded from the north-west.",
                     draw_elevation});
  }
  if (state.has(field::plate_id)) {
    plans.push_back({"plates", "Plates", "boundaries and velocities",
                     "Plates in colours, their boundaries by what happens there, and velocities.",
                     [](const Scene& scene, MapCanvas& canvas) {
                       draw_plates(canvas, scene.frame, scene.state, scene.base);
                     },
                     /*is_long=*/true});
  }
  const auto add_field = [&](const FieldMap& map) {
    if (!state.has(*map.field)) return;
    plans.push_back(
        {map.file, map.title, map.units, map.caption,
         [&map](const Scene& scene, MapCanvas& canvas) { draw_field(map, scene, canvas); }});
  };
  const auto add_categories = [&](const CategoryMap& map) {
    if (!state.has(*map.field)) return;
    plans.push_back(
        {map.file, map.title, map.units, map.caption,
         [&map](const Scene& scene, MapCanvas& canvas) { draw_categories(map, scene, canvas); }});
  };
  add_field(field_maps()[4]);
  add_field(field_maps()[5]);
  add_categories(category_maps()[2]);
  add_field(field_maps()[0]);
  add_field(field_maps()[1]);
  if (state.has(field::wind_east) && state.has(field::wind_north)) {
    plans.push_back({"wind", "Wind", "annual mean near the surface, m per s",
                     "Speed in colours; arrows show where the air goes.", draw_wind,
                     /*is_long=*/true});
  }
  if (has_rivers(state)) {
    plans.push_back({"rivers", "Rivers and lakes", "line width grows with discharge",
                     "The larger rivers and lakes; lines widen with the square root of the flow.",
                     draw_river_map, /*is_long=*/true});
  }
  add_categories(category_maps()[0]);
  add_categories(category_maps()[1]);
  add_field(field_maps()[2]);
  add_field(field_maps()[3]);
  return plans;
}

}  // namespace

MapLayout map_layout(const Grid& grid, const MapView& view) { return MapPage(grid, view).layout(); }

std::optional<std::array<double, 2>> position_on_map(const Grid& grid, const MapView& view,
                                                     Centre place) {
  const MapPage page(grid, view);
  const auto point = MapPage::Projector(page).point_of(place);
  if (!point) return {};
  return std::array{point->x, point->y};
}

std::vector<const FieldSpec*> map_fields() {
  std::vector<const FieldSpec*> fields{&field::elevation,
                                       &field::lake_depth,
                                       &field::plate_id,
                                       &field::boundary_type,
                                       &field::plate_velocity_east,
                                       &field::plate_velocity_north,
                                       &field::continental_fraction,
                                       &field::wind_east,
                                       &field::wind_north,
                                       &field::temperature_range,
                                       &field::ice_thickness,
                                       &field::flow_receiver,
                                       &field::drainage_area,
                                       &field::discharge};
  for (const auto& map : field_maps()) fields.push_back(map.field);
  for (const auto& map : category_maps()) fields.push_back(map.field);
  return fields;
}

std::vector<const FieldSpec*> island_map_fields() {
  std::vector<const FieldSpec*> fields{
      &field::elevation, &field::lake_depth,  &field::flow_receiver,    &field::drainage_area,
      &field::discharge, &field::temperature, &field::temperature_range};
  for (const auto& map : category_maps()) fields.push_back(map.field);
  return fields;
}

struct MapSet::Base {
  Base(const State& state, const MapView& view) : page(state.grid(), view) {}

  MapPage page;
  std::optional<MapFrame> frame;
  MapBase ground;
};

MapSet::MapSet(const State& state, std::vector<MapPlan> plans, const std::filesystem::path& folder,
               const MapView& view, std::string_view note, std::span<const EventMark> marks)
    : state_(&state),
      plans_(std::move(plans)),
      folder_(folder),
      note_(note),
      marks_(marks.begin(), marks.end()),
      base_(std::make_unique<Base>(state, view)) {}

MapSet::MapSet(MapSet&&) noexcept = default;
MapSet::~MapSet() = default;

MapSet MapSet::of_planet(const State& state, const std::filesystem::path& folder,
                         const MapView& view, std::string_view note,
                         std::span<const EventMark> marks) {
  return {state, plan_maps(state), folder, view, note, marks};
}

MapSet MapSet::of_island(const State& state, const std::filesystem::path& folder,
                         const std::string& name, const MapView& view, std::string_view note) {
  return {state, plan_island(state, name), folder, view, note, {}};
}

std::vector<MapFile> MapSet::files() const {
  const MapLayout layout = base_->page.layout();
  std::vector<MapFile> files;
  for (const MapPlan& plan : plans_) {
    files.push_back({folder_ / (plan.file + ".png"), plan.title, plan.caption, layout.width_px,
                     layout.height_px});
  }
  return files;
}

void MapSet::draw_all() {
  prepare();
  do_side_by_side(pieces());
}

void MapSet::prepare() {
  make_folder(folder_);
  base_->frame.emplace(base_->page);
  base_->ground = make_base(*base_->frame, *state_);
}

void MapSet::draw(const MapPlan& plan) const {
  MapCanvas canvas(*base_->frame);
  canvas.title(plan.title, plan.units, note_);
  plan.draw({*state_, *base_->frame, base_->ground, marks_}, canvas);
  canvas.save(folder_ / (plan.file + ".png"));
}

std::vector<std::function<void()>> MapSet::pieces() const {
  std::vector<std::function<void()>> pieces;
  for (const bool is_long : {true, false}) {
    for (const MapPlan& plan : plans_) {
      if (plan.is_long == is_long) pieces.emplace_back([this, &plan] { draw(plan); });
    }
  }
  return pieces;
}

namespace {

std::vector<MapFile> drawn(MapSet maps) {
  maps.draw_all();
  return maps.files();
}

}  // namespace

std::vector<MapFile> draw_map_files(const State& state, const std::filesystem::path& folder,
                                    const MapView& view, std::string_view note,
                                    std::span<const EventMark> marks) {
  return drawn(MapSet::of_planet(state, folder, view, note, marks));
}

std::vector<MapFile> draw_island_files(const State& state, const std::filesystem::path& folder,
                                       const std::string& name, const MapView& view,
                                       std::string_view note) {
  return drawn(MapSet::of_island(state, folder, name, view, note));
}

MapFile draw_field_file(const State& state, const FieldSpec& spec,
                        const std::filesystem::path& file, const MapView& view,
                        std::string_view note) {
  const MapPage page(state.grid(), view);
  const MapFrame frame(page);
  const bool other_relief = kind_of(spec) == FieldKind::relief && &spec != &field::elevation;
  State shown = state;
  if (other_relief) shown.share(field::elevation, state.values(spec));
  const MapBase base = make_base(frame, shown);
  MapCanvas canvas(frame);
  canvas.title(title_of(spec), units_on_map(spec), note);
  draw_any_field(spec, {shown, frame, base, {}}, canvas);
  canvas.save(file);
  return {file, title_of(spec), std::string(spec.doc), page.layout().width_px,
          page.layout().height_px};
}

std::vector<std::filesystem::path> draw_maps(const State& state,
                                             const std::filesystem::path& folder,
                                             const MapView& view, std::string_view note) {
  std::vector<std::filesystem::path> paths;
  for (auto& file : draw_map_files(state, folder, view, note)) {
    paths.push_back(std::move(file.path));
  }
  return paths;
}

}  // namespace geo::io
