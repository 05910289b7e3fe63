#include <fmt/core.h>

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <memory>
#include <string>

#include "commands.hpp"
#include "geo/io/config/presets.hpp"

namespace terrane {

void add_presets_command(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("presets", "The built-in configurations");
  const auto show = std::make_shared<std::string>();
  command->add_option("--show", *show, "Print one as TOML")->type_name("NAME");
  command->callback([&action, show] {
    action = [show] {
      if (!show->empty()) {
        fmt::print("{}", geo::io::find_preset(*show).toml);
        return;
      }
      for (const auto& preset : geo::io::presets()) {
        fmt::print("{:<12} {}\n", preset.name, preset.summary);
      }
    };
  });
}

}  // namespace terrane
