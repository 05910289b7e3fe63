#include <fmt/core.h>

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "apps/configuration.hpp"
#include "apps/memory_option.hpp"
#include "apps/thread_count.hpp"
#include "commands.hpp"
#include "geo/core/error.hpp"
#include "geo/io/config/config.hpp"
#include "geo/io/run/recorded_file.hpp"
#include "geo/io/run/run_folder.hpp"
#include "geo/io/run/run_pictures.hpp"

namespace terrane {
namespace {

struct MapsOptions {
  std::string folder, width, projection, center, box, stage, output;
  std::vector<std::string> fields;
  MemoryOption memory;
  bool frames = false;

  [[nodiscard]] bool is_other_view() const {
    return !projection.empty() || !center.empty() || !box.empty();
  }
};

geo::io::MapView view_of(const MapsOptions& options, Configuration& configuration) {
  const auto& parameters = configuration.parameters();
  if (!options.width.empty()) {
    geo::find_parameter(parameters, "output.map_width_px")->set_text(options.width);
  }
  geo::io::MapView view = configuration.settings.map_view();
  if (!options.projection.empty()) {
    view.projection = geo::io::find_projection(options.projection).name;
    view.centre.reset();
  }
  if (!options.box.empty()) {
    view.box = geo::io::parse_box("--bbox", options.box);
    view.centre.reset();
  }
  if (!options.center.empty()) view.centre = geo::io::parse_centre("--center", options.center);
  return view;
}

/// Pictures of another view than the run's lie in a folder of their own.
std::filesystem::path folder_for(const MapsOptions& options, const geo::io::RunFolder& folder,
                                 const geo::io::MapView& view) {
  if (!options.output.empty()) return options.output;
  std::filesystem::path path = folder.maps();
  if (options.is_other_view()) {
    path /=
        view.projection == "equirectangular" ? (view.box ? "window" : "centred") : view.projection;
  }
  if (options.frames) path /= "frames";
  return options.fields.empty() ? path : path / "fields";
}

void draw_maps(const MapsOptions& options) {
  use_threads();
  geo::io::RunFolder folder(options.folder);
  if (options.folder.empty() || !std::filesystem::exists(folder.manifest())) {
    throw geo::ConfigurationError(fmt::format("maps: {} holds no run: give the folder of one",
                                              options.folder.empty() ? "nothing" : options.folder));
  }
  if (!options.stage.empty() && options.fields.empty()) {
    throw geo::ConfigurationError(
        fmt::format("--stage {}: goes with --field, which it is drawn of", options.stage));
  }
  const auto cap = options.memory.cap(options.folder);
  Configuration configuration;
  geo::io::apply_config_file(folder.config(), configuration.parameters(),
                             &configuration.settings.events);
  const geo::io::MapView view = view_of(options, configuration);
  std::vector<std::filesystem::path> drawn;
  if (options.frames) {
    drawn = geo::io::draw_frames(folder, view, folder_for(options, folder, view));
  } else if (!options.fields.empty()) {
    for (const std::string& field : options.fields) {
      drawn.push_back(geo::io::draw_field(folder, view, {field, options.stage},
                                          folder_for(options, folder, view)));
    }
  } else if (options.is_other_view() || !options.output.empty()) {
    drawn = geo::io::draw_view(folder, view, folder_for(options, folder, view));
  } else {
    folder.open();  // nobody else changes its manifest now
    drawn = geo::io::draw_run(folder, view);
    geo::io::record_summaries(folder);
  }
  for (const auto& path : drawn) fmt::print("{}\n", path.string());
}

std::string footer() {
  std::string text =
      "With none but --width the pictures and the report of the run are drawn anew. Another view\n"
      "or single fields leave them alone and go to folders below DIR/maps, or to -o.\n\n"
      "Projections:\n";
  for (const auto& each : geo::io::map_projections()) {
    text += fmt::format("  {:<16} {}\n", each.name, each.doc);
  }
  return text;
}

}  // namespace

void add_maps_command(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand(
      "maps", "Draws the PNG maps and the HTML report again from the files of a run");
  const auto options = std::make_shared<MapsOptions>();
  command->add_option("DIR", options->folder, "Folder of a run");
  command
      ->add_option("--width", options->width, "Width of the maps in pixels (default: as the run)")
      ->type_name("PX");
  command
      ->add_option("--projection", options->projection,
                   "Projection of the planet (default: as the run)")
      ->type_name("NAME");
  command
      ->add_option("--center", options->center,
                   "Middle of the map in degrees; azimuthal projections take the latitude too")
      ->type_name("LAT,LON");
  command
      ->add_option("--bbox", options->box,
                   "Only what lies within; east of the date line too, as in 160,-60,-150,-10")
      ->type_name("W,S,E,N");
  command
      ->add_option("--field", options->fields, "Draws that field alone, whatever it is; repeatable")
      ->type_name("NAME")
      ->expected(1)
      ->take_all()
      ->allow_extra_args(false);  // the folder may follow
  command
      ->add_option("--stage", options->stage,
                   "Stage or island that the field is of (default: the last that wrote it)")
      ->type_name("NAME");
  command
      ->add_flag("--frames", options->frames,
                 "Draws the frames of a run through time instead, for films: frames/THEME/TIME.png")
      ->excludes("--field");
  command->add_option("-o,--output", options->output, "Folder for the pictures")->type_name("DIR");
  add_memory_options(*command, options->memory, "the pictures");
  command->footer(footer());
  command->callback([&action, options] { action = [options] { draw_maps(*options); }; });
}

}  // namespace terrane
