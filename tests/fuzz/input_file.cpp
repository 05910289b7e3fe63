#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <filesystem>

#include "fuzz.hpp"

namespace geo::fuzz {

InputFile::InputFile(std::string_view name) {
  std::error_code error;
  const std::filesystem::path memory("/dev/shm");
  const auto parent = std::filesystem::is_directory(memory, error)
                          ? memory
                          : std::filesystem::temp_directory_path();
  std::string folder = (parent / "terrane-fuzz-XXXXXX").string();
  claim(::mkdtemp(folder.data()) != nullptr, "there is a folder for inputs");
  path_ = folder + "/" + std::string(name);
}

InputFile::~InputFile() {
  std::error_code ignored;
  std::filesystem::remove_all(std::filesystem::path(path_).parent_path(), ignored);
}

void InputFile::write(std::string_view bytes) const {
  const int file = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  claim(file >= 0, "inputs can be written");
  claim(::write(file, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()),
        "inputs can be written");
  ::close(file);
}

}  // namespace geo::fuzz
