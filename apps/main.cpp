#include <fmt/core.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Version.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "commands/commands.hpp"
#include "geo/core/error.hpp"
#include "geo/io/config/config.hpp"
#include "geo/io/files/build_info.hpp"
#include "geo/io/input/reading_aside.hpp"
#include "geo/io/run/manifest.hpp"
#include "log.hpp"
#include "memory/memory.hpp"
#include "memory/memory_cap.hpp"
#include "ranks/ranks.hpp"
#include "signals.hpp"
#include "waiting.hpp"

namespace {

/// The word by which this program starts itself to read a file (read_files_aside). No command of
/// its user's.
constexpr const char* kReader = "--answer-reader";

std::string version_text() {
  const auto& build = geo::io::build_info();
  std::string text =
      fmt::format("terrane {} (commit {}, {})\n", build.version, build.commit, build.compiler);
  for (const auto& [name, version] : geo::io::library_versions()) {
    text += fmt::format("{} {}\n", name, version);
  }
  text += fmt::format("CLI11 {}", CLI11_VERSION);
  return text;
}

/// Words that could have been meant where an unknown one stands.
std::vector<std::string> known_words(const CLI::App& app, bool options) {
  std::vector<std::string> words;
  if (options) {
    for (const CLI::Option* option : app.get_options()) {
      for (const auto& name : option->get_lnames()) words.push_back("--" + name);
    }
  } else {
    for (const CLI::App* command : app.get_subcommands({})) words.push_back(command->get_name());
  }
  return words;
}

/// Refuses the first argument that nothing took, with the nearest known word.
void refuse_extras(const CLI::App& program) {
  const CLI::App* place = &program;
  std::vector<std::string> extras = program.remaining();
  if (extras.empty() && !program.get_subcommands().empty()) {
    place = program.get_subcommands().front();
    extras = place->remaining();
  }
  if (extras.empty()) return;
  const std::string word = extras.front().substr(0, extras.front().find('='));
  const bool is_option = word.size() > 1 && word.front() == '-';
  const auto known = known_words(*place, is_option);
  const std::vector<std::string_view> candidates(known.begin(), known.end());
  const bool at_top = place == &program;
  const auto hint = geo::io::suggestion(word, candidates);
  const std::string remedy = !hint.empty()
                                 ? hint
                                 : fmt::format("; {} --help lists what there is",
                                               at_top ? "terrane" : "terrane " + place->get_name());
  throw geo::ConfigurationError(fmt::format("unknown {} {}{}",
                                            is_option ? "option"
                                            : at_top  ? "command"
                                                      : "argument",
                                            word, remedy));
}

/// What the system said, without the exception's own words.
std::string system_message(const std::system_error& error) {
  const std::string reason = error.code().message();
  if (std::ferror(stdout) != 0) return fmt::format("standard output: {}", reason);
  const auto* const file = dynamic_cast<const std::filesystem::filesystem_error*>(&error);
  if (file == nullptr) return fmt::format("the system refused: {}", reason);
  const std::string path = file->path1().string();
  return fmt::format("{}: {}", path.size() > 200 ? path.substr(0, 200) + "..." : path, reason);
}

void run_program(int argc, char** argv) {
  CLI::App program("A whole planet's surface from physics.", "terrane");
  program.set_version_flag("--version", version_text, "Version, commit and library versions");
  program.set_help_flag("-h,--help", "This help");
  terrane::Action action;
  terrane::add_run_command(program, action);
  terrane::add_island_command(program, action);
  terrane::add_sweep_command(program, action);
  terrane::add_score_command(program, action);
  terrane::add_calibrate_command(program, action);
  terrane::add_maps_command(program, action);
  terrane::add_view_command(program, action);
  terrane::add_export_command(program, action);
  terrane::add_diff_command(program, action);
  terrane::add_params_command(program, action);
  terrane::add_fields_command(program, action);
  terrane::add_info_command(program, action);
  terrane::add_presets_command(program, action);
  terrane::add_completion_command(program, action);
  terrane::add_manual_command(program, action);
  program.footer(
      "terrane COMMAND --help tells more.");  // behind its commands: they would inherit it
  program.allow_extras();
  // One: what follows it is a stage, a folder or a file, whatever its name.
  program.require_subcommand(0, 1);
  for (CLI::App* command : program.get_subcommands({})) {
    command->allow_extras();
    command->set_help_flag("-h,--help", "This help");
  }
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& asked) {
    program.exit(asked);
    return;
  } catch (const CLI::ParseError& error) {
    throw geo::ConfigurationError(error.what());
  }
  refuse_extras(program);
  if (!action) throw geo::ConfigurationError("no command given; terrane --help lists them");
  action();
}

/// Returns the exit code of the program; every error is told in one line.
template <class Program>
int exit_code_of(Program&& program) {
  try {
    return program();
  } catch (const geo::Bug& error) {
    terrane::log_error(
        fmt::format("{} (a bug in terrane: please report it with the command line)", error.what()));
    return static_cast<int>(error.kind());
  } catch (const geo::Error& error) {
    terrane::log_error(error.what());
    return static_cast<int>(error.kind());
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::broken_pipe) terrane::end_by_broken_pipe();
    terrane::log_error(system_message(error));
    return static_cast<int>(geo::ErrorKind::io);
  } catch (const std::bad_alloc&) {
    if (terrane::scratch_is_full()) {
      terrane::log_error(terrane::scratch_error());
      return static_cast<int>(geo::ErrorKind::io);
    }
    terrane::log_error(terrane::want_of_memory());
    return static_cast<int>(geo::ErrorKind::configuration);
  } catch (...) {
    terrane::log_error(
        "unexpected failure (a bug in terrane: please report it with the command line)");
    return static_cast<int>(geo::ErrorKind::bug);
  }
}

int run_and_flush(int argc, char** argv) {
  run_program(argc, argv);
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    if (errno == EPIPE) terrane::end_by_broken_pipe();
    throw geo::IoError("standard output: could not be written");
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::string_view(argv[1]) == kReader) std::_Exit(geo::io::answer_reader());
  terrane::wait_without_spinning(argc, argv);
  geo::io::read_files_aside({"/proc/self/exe", kReader});
  terrane::prepare_memory();
  terrane::keep_standard_streams();
  terrane::prepare_signals();
  const auto program = [&] { return exit_code_of([&] { return run_and_flush(argc, argv); }); };
  if (!terrane::is_one_of_several()) return program();
  return exit_code_of([&] { return terrane::run_as_rank(program); });
}
