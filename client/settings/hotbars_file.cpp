#include "client/settings/hotbars_file.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "client/settings/toml_text.hpp"
#include "common/core/text.hpp"
#include "common/os/private_file.hpp"
#include "common/os/text_file.hpp"
#include "common/os/user_folders.hpp"

namespace runstone {
namespace {

constexpr std::size_t kFileBytesMax = 1 << 18;
constexpr std::size_t kHotbarsBytesMax = 256;  // of a name
constexpr std::size_t kHotbarsMax = 32, kSlotsMax = 9;

std::optional<std::string> text_of(const toml::node* node) {
  auto text = node == nullptr ? std::nullopt : node->value<std::string>();
  if (!text || text->size() > kHotbarsBytesMax || !is_printable_utf8(*text)) return std::nullopt;
  return text;
}

}  // namespace

std::string default_hotbars_file() {
  const std::string folder = user_folder(UserFolder::state);
  return folder.empty() ? "" : folder + "/hotbars.toml";
}

HotbarRows load_hotbars(const std::string& file) {
  HotbarRows out;
  std::error_code error;
  if (file.empty() || !std::filesystem::exists(file, error)) return out;
  const auto text = read_text_file(file, kFileBytesMax);
  if (!text) return out;
  try {
    const toml::table root = toml::parse(*text);
    const toml::array* const rows = root["hotbar"].as_array();
    if (rows == nullptr) return out;
    for (const toml::node& node : *rows) {
      const toml::table* const row = node.as_table();
      const toml::array* const slots = row == nullptr ? nullptr : (*row)["slots"].as_array();
      const auto name = row == nullptr ? std::nullopt : text_of(row->get("name"));
      if (!name || slots == nullptr || slots->size() > kSlotsMax || out.size() == kHotbarsMax)
        continue;
      std::vector<std::string> materials;
      for (const toml::node& slot : *slots) materials.push_back(text_of(&slot).value_or(""));
      out.emplace(*name, std::move(materials));
    }
  } catch (const toml::parse_error&) {
    static_cast<void>(set_aside(file));
  }
  return out;
}

Result<void, std::string> save_hotbars(const std::string& file, const HotbarRows& hotbars) {
  if (file.empty()) return failure(std::string("no file for the hotbars"));
  std::string out = "# The hotbars that were kept in runstone-client: the materials by slot.\n";
  for (const auto& [name, materials] : hotbars) {
    out += fmt::format("\n[[hotbar]]\nname = {}\nslots = [", toml_string(name));
    for (std::size_t i = 0; i < materials.size(); ++i)
      out += (i == 0 ? "" : ", ") + toml_string(materials[i]);
    out += "]\n";
  }
  return write_private_file(file, out);
}

}  // namespace runstone
