#include <fmt/core.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "commands.hpp"
#include "described_command.hpp"
#include "geo/core/error.hpp"
#include "geo/io/config/config.hpp"

namespace terrane {
namespace {

std::string replaced(std::string_view text, char what, std::string_view by) {
  std::string all;
  for (const char letter : text) {
    if (letter == what) {
      all += by;
    } else {
      all += letter;
    }
  }
  return all;
}

/// Text within single quotes of a POSIX shell.
std::string shell_quoted(std::string_view text) {
  return "'" + replaced(text, '\'', "'\\''") + "'";
}

std::vector<std::string> names_of(const std::vector<DescribedCommand>& commands) {
  std::vector<std::string> names;
  for (const DescribedCommand& command : commands) names.push_back(command.name);
  return names;
}

std::vector<std::string> options_of(const DescribedCommand& command) {
  std::vector<std::string> all;
  for (const DescribedOption& option : command.options) {
    all.insert(all.end(), option.names.begin(), option.names.end());
  }
  return all;
}

/// Each option with a list of words for its value, once, whichever commands have it.
std::vector<DescribedOption> options_with_words(const std::vector<DescribedCommand>& commands) {
  std::vector<DescribedOption> found;
  for (const DescribedCommand& command : commands) {
    for (const DescribedOption& option : command.options) {
      const bool known = std::any_of(found.begin(), found.end(), [&](const DescribedOption& other) {
        return other.names == option.names;
      });
      if (!known && !words_for(option).empty()) found.push_back(option);
    }
  }
  return found;
}

void print_bash(const std::vector<DescribedCommand>& commands) {
  fmt::print(
      "# bash completion of terrane; written by `terrane completion bash`\n"
      "_terrane() {{\n"
      "  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}}\n"
      "  COMPREPLY=()\n"
      "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
      "    COMPREPLY=($(compgen -W \"{} --help --version\" -- \"$word\"))\n"
      "    return\n"
      "  fi\n"
      "  case $before in\n",
      fmt::join(names_of(commands), " "));
  for (const DescribedOption& option : options_with_words(commands)) {
    const bool goes_on = words_for(option).front().back() == '=';
    fmt::print("    {})\n      COMPREPLY=($(compgen -W \"{}\" -- \"$word\"))\n{}      return ;;\n",
               fmt::join(option.names, "|"), fmt::join(words_for(option), " "),
               goes_on ? "      compopt -o nospace\n" : "");
  }
  fmt::print("  esac\n  [[ $word == -* ]] || return\n  case ${{COMP_WORDS[1]}} in\n");
  for (const DescribedCommand& command : commands) {
    fmt::print("    {}) COMPREPLY=($(compgen -W \"{}\" -- \"$word\")) ;;\n", command.name,
               fmt::join(options_of(command), " "));
  }
  // Without a word of ours bash offers files.
  fmt::print("  esac\n}}\ncomplete -o default -F _terrane terrane\n");
}

/// A description within `[...]` of _arguments.
std::string zsh_doc(std::string_view doc) {
  return replaced(replaced(replaced(doc, '[', "("), ']', ")"), ':', "\\:");
}

void print_zsh(const std::vector<DescribedCommand>& commands) {
  fmt::print(
      "#compdef terrane\n# written by `terrane completion zsh`\n_terrane() {{\n"
      "  local -a commands\n  commands=(\n");
  for (const DescribedCommand& command : commands) {
    fmt::print("    {}\n", shell_quoted(command.name + ":" + replaced(command.doc, ':', "\\:")));
  }
  fmt::print(
      "  )\n  if (( CURRENT == 2 )); then\n    _describe command commands\n    return\n  fi\n"
      "  local command=$words[2]\n  shift words\n  (( CURRENT-- ))\n  case $command in\n");
  for (const DescribedCommand& command : commands) {
    fmt::print("    {})\n      _arguments", command.name);
    for (const DescribedOption& option : command.options) {
      const auto words = words_for(option);
      const std::string value =
          words.empty() ? ":" + option.argument + ":_files"
                        : fmt::format(":{}:({})", option.argument, fmt::join(words, " "));
      for (const std::string& name : option.names) {
        fmt::print(" \\\n        {}",
                   shell_quoted(fmt::format("*{}[{}]{}", name, zsh_doc(option.doc),
                                            option.takes_value ? value : std::string())));
      }
    }
    fmt::print(" \\\n        '*:file:_files' ;;\n");
  }
  fmt::print("  esac\n}}\n_terrane \"$@\"\n");
}

void print_fish(const std::vector<DescribedCommand>& commands) {
  fmt::print("# fish completion of terrane; written by `terrane completion fish`\n");
  const auto fish_quoted = [](std::string_view text) {
    return "'" + replaced(replaced(text, '\\', "\\\\"), '\'', "\\'") + "'";
  };
  for (const DescribedCommand& command : commands) {
    fmt::print("complete -c terrane -n __fish_use_subcommand -f -a {} -d {}\n", command.name,
               fish_quoted(command.doc));
    for (const DescribedOption& option : command.options) {
      if (option.names.empty()) continue;
      fmt::print("complete -c terrane -n '__fish_seen_subcommand_from {}'", command.name);
      for (const std::string& name : option.names) {
        fmt::print(" -{} {}", name.starts_with("--") ? "l" : "s",
                   name.substr(name.find_first_not_of('-')));
      }
      const auto words = words_for(option);
      if (option.takes_value) fmt::print("{}", words.empty() ? " -r" : " -x");
      if (!words.empty()) {
        fmt::print(" -a {}", fish_quoted(fmt::format("{}", fmt::join(words, " "))));
      }
      fmt::print(" -d {}\n", fish_quoted(option.doc));
    }
  }
}

}  // namespace

void add_completion_command(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("completion", "Completion for a shell, as a script");
  const auto shell = std::make_shared<std::string>();
  command->add_option("SHELL", *shell, "bash, zsh or fish")->required();
  command->callback([&action, &program, shell] {
    action = [&program, shell] {
      const auto commands = describe_commands(program);
      constexpr std::string_view kShells[] = {"bash", "zsh", "fish"};
      if (*shell == "bash") return print_bash(commands);
      if (*shell == "zsh") return print_zsh(commands);
      if (*shell == "fish") return print_fish(commands);
      throw geo::ConfigurationError(fmt::format("completion {}: must be one of {}{}", *shell,
                                                fmt::join(kShells, ", "),
                                                geo::io::suggestion(*shell, kShells)));
    };
  });
}

}  // namespace terrane
