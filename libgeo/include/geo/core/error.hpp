#pragma once

#include <stdexcept>
#include <string>

namespace geo {

/// What went wrong, as the exit code that `terrane` ends with.
enum class ErrorKind : int {
  bug = 1,            ///< terrane itself is at fault
  configuration = 2,  ///< wrong command line or configuration
  input = 3,          ///< unusable input data
  io = 4,             ///< could not read or write
  unreached = 5,      ///< a calibration did not converge, or not near its target
  interrupted = 130,  ///< stopped by SIGINT or SIGTERM
};

/// Base of every error that terrane throws on purpose. The message is one line that says
/// what is wrong, where, and what would be right; breaks in what it quotes become spaces.
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message)
      : std::runtime_error(one_line(message)), kind_(kind) {}
  [[nodiscard]] ErrorKind kind() const noexcept { return kind_; }

 private:
  static std::string one_line(std::string text) {
    for (char& letter : text) letter = letter == '\n' || letter == '\r' ? ' ' : letter;
    return text;
  }

  ErrorKind kind_;
};

/// A contract inside the program was broken (undeclared field access, impossible state).
struct Bug : Error {
  explicit Bug(const std::string& message) : Error(ErrorKind::bug, message) {}
};
/// The user's configuration or command line cannot be used.
struct ConfigurationError : Error {
  explicit ConfigurationError(const std::string& message)
      : Error(ErrorKind::configuration, message) {}
};
/// The user's data cannot be used.
struct InputError : Error {
  explicit InputError(const std::string& message) : Error(ErrorKind::input, message) {}
};
/// The operating system refused to read or write.
struct IoError : Error {
  explicit IoError(const std::string& message) : Error(ErrorKind::io, message) {}
};
/// A signal asked the run to stop.
struct Interrupted : Error {
  Interrupted() : Error(ErrorKind::interrupted, "interrupted") {}
};

}  // namespace geo
