#pragma once

#include <map>
#include <regex>
#include <string>

#include "support.hpp"

namespace geo::test {

/// Entries of docs/references.bib, text by key. Throws if braces do not match or a key comes twice.
inline std::map<std::string, std::string> bibliography() {
  const std::string text = read_text(repository() / "docs/references.bib");
  std::map<std::string, std::string> entries;
  for (std::size_t at = text.find('@'); at != std::string::npos; at = text.find('@', at)) {
    const std::size_t open = text.find('{', at), comma = text.find(',', at);
    const std::string key = text.substr(open + 1, comma - open - 1);
    int depth = 0;
    std::size_t end = open;
    do {
      if (end >= text.size()) throw std::runtime_error(key + ": brace not closed");
      depth += text[end] == '{' ? 1 : text[end] == '}' ? -1 : 0;
      ++end;
    } while (depth > 0);
    const std::string entry = text.substr(at, end - at);
    if (entry.find("\n@") != std::string::npos) throw std::runtime_error(key + ": not closed");
    if (!entries.emplace(key, entry).second) throw std::runtime_error(key + ": twice");
    at = end;
  }
  return entries;
}

}  // namespace geo::test
