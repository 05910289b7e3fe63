#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace terrane {

/// How a child ended.
struct ChildEnd {
  pid_t process = -1;
  int exit_code = 0;  ///< 128 + the signal where one ended it, as shells count
};

/// Starts this program once more with other arguments; its output goes into a file, its messages
/// into another or the same. It gets SIGTERM when this program ends. Throws IoError.
pid_t start_this_program(const std::vector<std::string>& arguments,
                         const std::filesystem::path& output,
                         const std::filesystem::path& messages);

/// Waits until one of the children ends. With `stop_requested()` all get SIGTERM first, once.
ChildEnd wait_for_child(const std::vector<pid_t>& children);

}  // namespace terrane
