#include "geo/io/files/build_info.hpp"

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include <cstring>

#include "terrane_commit.hpp"

namespace geo::io {
namespace {

constexpr std::size_t aligned(std::size_t size) { return (size + 3) / 4 * 4; }

/// The build ID among the notes of the program itself, which the loader lists first.
int read_id(dl_phdr_info* program, std::size_t, void* into) {
  std::string& id = *static_cast<std::string*>(into);
  for (int k = 0; k < program->dlpi_phnum; ++k) {
    const auto& segment = program->dlpi_phdr[k];
    if (segment.p_type != PT_NOTE) continue;
    const auto* const notes =
        reinterpret_cast<const unsigned char*>(program->dlpi_addr + segment.p_vaddr);
    std::size_t at = 0;
    while (at + sizeof(ElfW(Nhdr)) <= segment.p_memsz) {
      ElfW(Nhdr) note;
      std::memcpy(&note, notes + at, sizeof(note));
      const std::size_t name = at + sizeof(note), text = name + aligned(note.n_namesz);
      if (note.n_type == NT_GNU_BUILD_ID && note.n_namesz == 4 &&
          std::memcmp(notes + name, "GNU", 4) == 0) {
        for (std::size_t i = 0; i < note.n_descsz; ++i)
          id += fmt::format("{:02x}", notes[text + i]);
        return 1;
      }
      at = text + aligned(note.n_descsz);
    }
  }
  return 1;
}

std::string linkers_id() {
  std::string id;
  dl_iterate_phdr(read_id, &id);
  return id;
}

}  // namespace

const BuildInfo& build_info() {
  static const BuildInfo kInfo{TERRANE_VERSION, TERRANE_COMMIT, TERRANE_COMPILER, linkers_id()};
  return kInfo;
}

}  // namespace geo::io
