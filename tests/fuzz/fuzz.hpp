#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "geo/core/error.hpp"

// A fuzz target is a file here with LLVMFuzzerTestOneInput. libFuzzer calls it with what it makes
// up (CMake option TERRANE_FUZZ, script scripts/fuzz), test_fuzz_NAME with the files of
// corpus/NAME.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace geo::fuzz {

/// A file in memory that readers open by its name.
class InputFile {
 public:
  /// `name` says of what kind it is, by its ending.
  explicit InputFile(std::string_view name);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  /// Replaces what it holds.
  void write(std::string_view bytes) const;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// A claim of a target.
inline void claim(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "claim broken: %s\n", what);
  std::abort();
}

/// Runs a reader that may refuse what it is given, in one line. Anything else that it throws is a
/// fault: nothing that a file holds is a bug in terrane.
template <class Read>
void expect_value_or_refusal(const Read& read) {
  try {
    read();
  } catch (const Error& error) {
    claim(error.kind() != ErrorKind::bug, error.what());
    claim(std::string_view(error.what()).find('\n') == std::string_view::npos,
          "a refusal is one line");
  }
}

/// Numbers out of the bytes of an input; zeros behind its end.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  [[nodiscard]] std::uint8_t byte() { return at_ < size_ ? data_[at_++] : 0; }
  /// 0 to below.
  [[nodiscard]] int below(int end) { return end <= 1 ? 0 : (byte() * 256 + byte()) % end; }
  [[nodiscard]] bool one_in(int n) { return below(n) == n - 1; }
  template <class T>
  [[nodiscard]] T value() {
    T value{};
    auto* const bytes = reinterpret_cast<unsigned char*>(&value);
    for (std::size_t k = 0; k < sizeof(T); ++k) bytes[k] = byte();
    return value;
  }
  [[nodiscard]] std::string text(int most) {
    std::string text(below(most + 1), '\0');
    for (char& letter : text) letter = static_cast<char>(byte());
    return text;
  }
  /// One of the words, or text of its own.
  template <std::size_t kWords>
  [[nodiscard]] std::string word(const char* const (&words)[kWords]) {
    const int which = byte() % (kWords + 1);
    return which == kWords ? text(12) : words[which];
  }
  [[nodiscard]] bool is_at_end() const { return at_ >= size_; }

 private:
  const std::uint8_t* data_;
  std::size_t size_, at_ = 0;
};

}  // namespace geo::fuzz
