#include <fmt/core.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "described_command.hpp"
#include "geo/core/error.hpp"
#include "geo/io/config/config.hpp"
#include "geo/io/files/build_info.hpp"

namespace terrane {
namespace {

/// Text as roff prints it: hyphens are those of the command line, and no line is a request.
std::string roff(std::string_view text) {
  std::string safe;
  for (const char letter : text) {
    if (letter == '-') {
      safe += "\\-";
    } else if (letter == '\\') {
      safe += "\\e";
    } else {
      if ((letter == '.' || letter == '\'') && safe.empty()) safe += "\\&";
      safe += letter;
    }
  }
  return safe;
}

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char letter) {
    return static_cast<char>(letter >= 'a' && letter <= 'z' ? letter - 'a' + 'A' : letter);
  });
  return text;
}

void print_heading(const std::string& page, std::string_view doc) {
  fmt::print(".TH {} 1 \"\" \"terrane {}\" \"User commands\"\n.SH NAME\n{} \\- {}\n",
             roff(upper(page)), geo::io::build_info().version, roff(page), roff(doc));
}

void print_options(const DescribedCommand& command) {
  fmt::print(".SH OPTIONS\n");
  for (const DescribedOption& option : command.options) {
    std::string head;
    for (const std::string& name : option.names) {
      head += fmt::format("{}\\fB{}\\fR", head.empty() ? "" : ", ", roff(name));
    }
    if (option.takes_value && !option.argument.empty()) {
      head += fmt::format("{}\\fI{}\\fR", head.empty() ? "" : " ", roff(option.argument));
    }
    fmt::print(".TP\n{}\n{}\n", head, roff(option.doc));
  }
}

void print_footer(const DescribedCommand& command) {
  if (command.footer.empty()) return;
  fmt::print(".SH NOTES\n");
  bool is_filled = true;
  std::istringstream lines(command.footer);
  for (std::string line; std::getline(lines, line);) {
    const bool fills = !line.starts_with(' ');
    if (fills != is_filled) fmt::print("{}", fills ? ".fi\n" : ".nf\n");
    is_filled = fills;
    fmt::print("{}\n", line.empty() ? ".PP" : roff(line));
  }
  if (!is_filled) fmt::print(".fi\n");
}

void print_exit_codes() {
  fmt::print(".SH EXIT STATUS\n");
  constexpr std::pair<int, std::string_view> kCodes[] = {
      {0, "done"},
      {1, "a bug in terrane"},
      {2, "wrong command line or configuration, or less memory than it needs"},
      {3, "unusable input data"},
      {4, "a file could not be read or written"},
      {5, "a calibration did not converge, or not near its target"},
      {6, "terrane diff: the two differ"},
      {130, "interrupted; terrane run --resume goes on"}};
  for (const auto& [code, words] : kCodes) fmt::print(".TP\n{}\n{}\n", code, roff(words));
}

void print_page(const DescribedCommand& command) {
  const std::string page = "terrane-" + command.name;
  print_heading(page, command.doc);
  std::string arguments;
  for (const DescribedOption& option : command.options) {
    if (option.names.empty()) arguments += fmt::format(" [\\fI{}\\fR]", roff(option.argument));
  }
  fmt::print(".SH SYNOPSIS\n\\fBterrane {}\\fR [\\fIOPTIONS\\fR]{}\n", roff(command.name),
             arguments);
  print_options(command);
  print_footer(command);
  print_exit_codes();
  fmt::print(".SH SEE ALSO\n\\fBterrane\\fR(1)\n");
}

void print_program(const CLI::App& program, const std::vector<DescribedCommand>& commands) {
  print_heading("terrane", "a whole planet's surface from physics");
  fmt::print(".SH SYNOPSIS\n\\fBterrane\\fR \\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n.SH COMMANDS\n");
  for (const DescribedCommand& command : commands) {
    fmt::print(".TP\n\\fBterrane\\-{}\\fR(1)\n{}\n", roff(command.name), roff(command.doc));
  }
  const DescribedCommand whole = describe(program);
  print_options(whole);
  print_footer(whole);
  print_exit_codes();
}

}  // namespace

void add_manual_command(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("manual", "The manual page of a command, in roff");
  const auto page = std::make_shared<std::string>();
  command->add_option("COMMAND", *page, "A command; the program without it");
  command->callback([&action, &program, page] {
    action = [&program, page] {
      const auto commands = describe_commands(program);
      if (page->empty()) return print_program(program, commands);
      const auto at = std::find_if(commands.begin(), commands.end(),
                                   [&](const auto& described) { return described.name == *page; });
      if (at != commands.end()) return print_page(*at);
      std::vector<std::string_view> names;
      for (const DescribedCommand& described : commands) names.push_back(described.name);
      throw geo::ConfigurationError(fmt::format("manual {}: must be one of {}{}", *page,
                                                fmt::join(names, ", "),
                                                geo::io::suggestion(*page, names)));
    };
  });
}

}  // namespace terrane
