#include "client/app/player_defaults.hpp"

#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "client/settings/settings_file.hpp"
#include "common/core/text.hpp"
#include "common/os/private_file.hpp"
#include "common/os/usable_memory.hpp"
#include "protocol/limits.hpp"

namespace runstone {
namespace {

/// Returns the name of the user's account, or an empty text if it cannot be a player's name.
std::string account_name() {
  const passwd* const account = ::getpwuid(::getuid());
  const std::string name = account != nullptr ? account->pw_name : "";
  return name.size() <= kPlayerNameBytesMax && is_plain_name(name) && name != "root" ? name : "";
}

}  // namespace

std::uint64_t automatic_memory_mib() {
  constexpr std::uint64_t kLeast = 256, kMost = 1024;
  const auto bytes = usable_memory_bytes();
  return bytes ? std::clamp((*bytes >> 20) / 8, kLeast, kMost) : kMost;
}

void apply_settings(const ClientSettings& settings, ClientOptions& options) {
  if (!options.given.name) {
    options.name = settings.name;
    const std::string account = account_name();
    if (settings.name == ClientSettings{}.name && !account.empty()) options.name = account;
  }
  if (!options.given.view) {
    options.view_radius = settings.view_radius;
    if (!options.given.view_vertical)
      options.view_radius_v = static_cast<std::uint8_t>((settings.view_radius + 1) / 2);
  }
  if (!options.given.far_levels) options.far_levels = settings.far_levels;
  options.settings = settings;
  if (!options.given.memory) options.memory_mib = settings.memory_mib;
  if (!options.given.quality) options.quality = quality_of(settings);
  if (!options.given.antialiasing) options.antialiasing = settings.antialiasing;
  use_kept_key(settings, options);
}

std::optional<Quality> quality_of(const ClientSettings& settings) {
  switch (settings.quality) {
    case QualityChoice::automatic:
      return std::nullopt;
    case QualityChoice::low:
      return Quality::low;
    case QualityChoice::medium:
      return Quality::medium;
    case QualityChoice::high:
      return Quality::high;
  }
  return std::nullopt;
}

KeyMap key_map_of(const ClientSettings& settings, std::vector<std::string>& warnings) {
  KeyMap out;
  for (const auto& [name, keys] : settings.keys) {
    const auto rows = action_table();
    const auto row = std::ranges::find(rows, name, &ActionInfo::name);
    const auto chords = parse_key_chords(keys);
    if (row == rows.end()) {
      warnings.push_back("keys." + name + ": there is no such action");
    } else if (!chords) {
      warnings.push_back("keys." + name + ": \"" + keys + "\" names no keys, such as \"ctrl+Z\"");
    } else {
      out.bind(row->action, *chords);
    }
  }
  return out;
}

void use_kept_key(const ClientSettings& settings, ClientOptions& options) {
  if (!options.key_file.empty()) return;
  options.key_file = settings.key_file.empty() ? default_key_file() : settings.key_file;
  if (options.key_file.empty()) return;
  const std::string folder = std::filesystem::path(options.key_file).parent_path().string();
  // A folder that cannot be made is reported with the key file.
  static_cast<void>(make_private_folder(folder));
}

}  // namespace runstone
