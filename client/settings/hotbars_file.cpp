#include "client/settings/hotbars_file.hpp"

#include <fmt/format.h>

#include <utility>

#include "client/settings/toml_rows.hpp"
#include "client/settings/toml_text.hpp"
#include "common/os/private_file.hpp"
#include "common/os/user_folders.hpp"

namespace runstone {
namespace {

constexpr std::size_t kHotbarsFileBytesMax = 1 << 18;
constexpr std::size_t kRowTextBytesMax = 256;  // the name of a hotbar, or that of a material
constexpr std::size_t kHotbarsMax = 32, kSlotsMax = 9;

}  // namespace

std::string default_hotbars_file() {
  const std::string folder = user_folder(UserFolder::state);
  return folder.empty() ? "" : folder + "/hotbars.toml";
}

HotbarRows load_hotbars(const std::string& file) {
  HotbarRows out;
  each_row_of_file(file, kHotbarsFileBytesMax, "hotbar", [&](const toml::table& row) {
    const toml::array* const slots = row["slots"].as_array();
    const auto name = line_of(row.get("name"), kRowTextBytesMax);
    if (!name || slots == nullptr || slots->size() > kSlotsMax || out.size() == kHotbarsMax) return;
    std::vector<std::string> materials;
    for (const toml::node& slot : *slots)
      materials.push_back(line_of(&slot, kRowTextBytesMax).value_or(""));
    out.emplace(*name, std::move(materials));
  });
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
