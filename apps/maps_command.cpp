#include <fmt/core.h>

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "commands.hpp"
#include "configuration.hpp"
#include "geo/core/error.hpp"
#include "geo/io/config.hpp"
#include "geo/io/run_folder.hpp"
#include "geo/io/run_pictures.hpp"

namespace terrane {

void add_maps_command(CLI::App& program, Action& action) {
  struct Options {
    std::string folder;
    std::string width;
  };
  CLI::App* command = program.add_subcommand(
      "maps", "Draws the PNG maps and the HTML report again from the files of a run");
  const auto options = std::make_shared<Options>();
  command->add_option("DIR", options->folder, "Folder of a run");
  command
      ->add_option("--width", options->width, "Width of the maps in pixels (default: as the run)")
      ->type_name("PX");
  command->callback([&action, options] {
    action = [options] {
      const geo::io::RunFolder folder(options->folder);
      if (options->folder.empty() || !std::filesystem::exists(folder.manifest())) {
        throw geo::ConfigurationError(
            fmt::format("maps: {} holds no run: give the folder of one",
                        options->folder.empty() ? "nothing" : options->folder));
      }
      Configuration configuration;
      const auto& parameters = configuration.parameters();
      geo::io::apply_config_file(folder.config(), parameters, &configuration.settings.events);
      if (!options->width.empty()) {
        geo::find_parameter(parameters, "output.map_width_px")->set_text(options->width);
      }
      const auto width_px = static_cast<int>(configuration.settings.map_width_px);
      for (const auto& path : geo::io::draw_run(folder, width_px)) {
        fmt::print("{}\n", path.string());
      }
    };
  });
}

}  // namespace terrane
