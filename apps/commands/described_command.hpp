#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace terrane {

/// What the parser knows of an option or an argument.
struct DescribedOption {
  std::vector<std::string> names;  ///< "-o", "--set"; empty for an argument
  std::string argument;            ///< of an argument its name; of an option the kind of its value
  std::string doc;
  bool takes_value = true;
};

/// What the parser knows of a command: help, manual pages and completion all say this.
struct DescribedCommand {
  std::string name, doc;
  std::vector<DescribedOption> options;
  std::string
      footer;  ///< what help says below them; lines that begin with a space stand as they are
};

[[nodiscard]] DescribedCommand describe(const CLI::App& command);
/// All commands of a program, in the order of its help.
[[nodiscard]] std::vector<DescribedCommand> describe_commands(const CLI::App& program);

/// The words that an option's value may be, as far as there is a list of them: presets, stages,
/// parameters with "=", fields. Empty where any file or text may follow.
[[nodiscard]] std::vector<std::string> words_for(const DescribedOption& option);

}  // namespace terrane
