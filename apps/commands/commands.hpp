#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace terrane {

/// What a chosen subcommand does once the whole command line is known to be right.
using Action = std::function<void()>;

// Each adds its subcommand with its options to the program; when it is the chosen one, `action`
// is what runs.
void add_run_command(CLI::App& program, Action& action);
void add_island_command(CLI::App& program, Action& action);
void add_maps_command(CLI::App& program, Action& action);
void add_params_command(CLI::App& program, Action& action);
void add_fields_command(CLI::App& program, Action& action);
void add_info_command(CLI::App& program, Action& action);
void add_presets_command(CLI::App& program, Action& action);
void add_completion_command(CLI::App& program, Action& action);
void add_manual_command(CLI::App& program, Action& action);
void add_calibrate_command(CLI::App& program, Action& action);
void add_score_command(CLI::App& program, Action& action);
void add_export_command(CLI::App& program, Action& action);
void add_diff_command(CLI::App& program, Action& action);
void add_sweep_command(CLI::App& program, Action& action);
void add_view_command(CLI::App& program, Action& action);

}  // namespace terrane
