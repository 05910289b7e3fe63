#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "commands.hpp"
#include "geo/core/error.hpp"

extern char** environ;  // NOLINT(readability-redundant-declaration): not in every <unistd.h>

namespace terrane {
namespace {

namespace fs = std::filesystem;

/// Gives a file to the program that the desktop opens it with.
void open_on_desktop(const fs::path& file) {
  std::string program = "xdg-open", path = file.string();
  char* arguments[] = {program.data(), path.data(), nullptr};
  pid_t process = -1;
  int status = 0;
  const int error = ::posix_spawnp(&process, program.c_str(), nullptr, nullptr, arguments, environ);
  const bool ended = error == 0 && ::waitpid(process, &status, 0) == process;
  if (ended && WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  throw geo::IoError(
      fmt::format("no browser could be opened (xdg-open {}): open {} in one yourself",
                  error == 0 ? "failed" : "is not installed", path));
}

void view(const std::string& folder) {
  if (folder.empty()) {
    throw geo::ConfigurationError("view: give the folder of a run or a fit: terrane view DIR");
  }
  const fs::path report = fs::absolute(fs::path(folder) / "report.html").lexically_normal();
  if (!fs::exists(report)) {
    throw geo::ConfigurationError(
        fmt::format("view: {} holds no report: terrane maps {} draws one", folder, folder));
  }
  fmt::print("{}\n", report.string());
  open_on_desktop(report);
}

}  // namespace

void add_view_command(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand(
      "view", "Opens the report of a run, with its globe and maps, in the browser");
  const auto folder = std::make_shared<std::string>();
  command->add_option("DIR", *folder, "Folder of a run or a fit");
  command->callback([&action, folder] { action = [folder] { view(*folder); }; });
}

}  // namespace terrane
