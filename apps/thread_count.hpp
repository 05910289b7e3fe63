#pragma once

#include <string>

namespace terrane {

/// What `--threads` asks for: as many as there are cores when empty. Throws ConfigurationError.
int thread_count(const std::string& text);

}  // namespace terrane
