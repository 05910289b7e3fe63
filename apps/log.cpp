#include "log.hpp"

#include <fmt/core.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

namespace terrane {
namespace {

/// One JSON object a line, whatever the message holds.
class JsonFormatter : public spdlog::formatter {
 public:
  void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& out) override {
    const auto time = std::chrono::duration<double>(message.time.time_since_epoch()).count();
    const auto level = spdlog::level::to_string_view(message.level);
    const nlohmann::ordered_json line{
        {"time", std::round(time * 1000.0) / 1000.0},
        {"level", std::string(level.data(), level.size())},
        {"message", std::string(message.payload.data(), message.payload.size())}};
    const auto text =
        line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
    out.append(text.data(), text.data() + text.size());
  }
  [[nodiscard]] std::unique_ptr<spdlog::formatter> clone() const override {
    return std::make_unique<JsonFormatter>();
  }
};

spdlog::logger& logger() {
  static const auto kLogger = [] {
    auto made = spdlog::stderr_color_mt("terrane");
    made->set_pattern("%v");
    return made;
  }();
  return *kLogger;
}

std::atomic<bool> json{false};

std::string one_line(std::string_view message) {
  std::string line(message);
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return line;
}

}  // namespace

void set_log_style(LogStyle style) {
  json = style.json;
  if (style.json) logger().set_formatter(std::make_unique<JsonFormatter>());
  logger().set_level(style.quiet ? spdlog::level::warn : spdlog::level::info);
}

bool logs_json() { return json; }

void log_info(std::string_view message) { logger().info("{}", one_line(message)); }
void log_warning(std::string_view message) {
  logger().warn("{}", "terrane: warning: " + one_line(message));
}
void log_error(std::string_view message) {
  logger().error("{}", "terrane: error: " + one_line(message));
}

std::string shown_bytes(double bytes) {
  if (bytes < 1e9) return fmt::format("{:.0f} MB", std::ceil(bytes / 1e6));
  return fmt::format("{:.1f} GB", bytes / 1e9);
}

std::string shown_seconds(double seconds) {
  if (seconds < 9.95) return fmt::format("{:.1f} s", seconds);
  if (seconds < 120.0) return fmt::format("{:.0f} s", seconds);
  const auto minutes = static_cast<int>(seconds / 60.0);
  return fmt::format("{} min {:.0f} s", minutes, seconds - 60.0 * minutes);
}

}  // namespace terrane
