#include "server/admin/config_reload.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace runstone {
namespace {

// They are read each time they are used, on the world strand, by the loggers or for a new connection.
// Clients learn none of them when they join.
constexpr std::array<std::string_view, 17> kReloaded = {
    "log_level",           "log_format",    "sessions_per_key", "sessions_per_address",
    "range_seats_percent", "idle_s",        "operators",        "public_address",
    "reach_max",           "speed_max",     "tls_certificate",  "tls_key",
    "message_of_the_day",  "announcements", "move_to_builders", "border",
    "retention_days"};

std::string list_of(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

bool is_reloaded(const std::string& field) {
  return std::find(kReloaded.begin(), kReloaded.end(), field) != kReloaded.end();
}

std::string ConfigReload::text() const {
  if (taken.empty() && waiting.empty()) return "nothing has changed";
  std::string text = taken.empty() ? "nothing reloaded" : "reloaded: " + list_of(taken);
  if (!waiting.empty()) text += "; after a restart: " + list_of(waiting);
  return text;
}

ConfigReload reload_config(const ServerConfig& running, const ServerConfig& read) {
  ConfigReload out{running, {}, {}};
  for (const SettingField& field : config_fields()) {
    if (config_text(running, field.name) == config_text(read, field.name)) continue;
    if (is_reloaded(field.name)) {
      copy_config(out.config, read, field.name);
      out.taken.push_back(field.name);
    } else {
      out.waiting.push_back(field.name);
    }
  }
  return out;
}

}  // namespace runstone
