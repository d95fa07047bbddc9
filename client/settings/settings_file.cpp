#include "client/settings/settings_file.hpp"

#include <filesystem>
#include <system_error>

#include "common/os/private_file.hpp"
#include "common/os/text_file.hpp"
#include "common/os/user_folders.hpp"

namespace runstone {
namespace {

constexpr std::size_t kSettingsBytesMax = 1 << 20;

std::string in_folder(UserFolder kind, const char* name) {
  const std::string folder = user_folder(kind);
  return folder.empty() ? "" : folder + "/" + name;
}

}  // namespace

std::string default_settings_file() { return in_folder(UserFolder::config, "client.toml"); }
std::string default_key_file() { return in_folder(UserFolder::data, "key"); }

LoadedSettings load_settings(const std::string& file) {
  LoadedSettings out;
  std::error_code error;
  if (file.empty() || (!std::filesystem::exists(file, error) && !error)) return out;
  const auto text = read_text_file(file, kSettingsBytesMax);
  if (!text) {
    out.warnings.push_back(text.error() + "; the default settings are used");
    return out;
  }
  ReadSettings read = read_settings(*text, file);
  out.settings = std::move(read.settings);
  out.warnings = std::move(read.warnings);
  if (!read.is_broken) return out;
  const std::string kept = set_aside(file);
  out.warnings.push_back("the settings file is broken, and the default settings are used" +
                         (kept.empty() ? std::string() : "; the broken file is kept as " + kept));
  return out;
}

Result<void, std::string> save_settings(const std::string& file, const ClientSettings& settings) {
  if (file.empty())
    return failure("the settings are not kept: neither XDG_CONFIG_HOME nor HOME names a folder");
  return write_private_file(file, to_toml(settings));
}

}  // namespace runstone
