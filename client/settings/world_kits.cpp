#include "client/settings/world_kits.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "client/settings/toml_text.hpp"
#include "common/core/text.hpp"
#include "common/os/private_file.hpp"
#include "common/os/text_file.hpp"
#include "common/os/user_folders.hpp"

namespace runstone {
namespace {

constexpr std::size_t kKitsBytesMax = 1 << 16;
constexpr std::size_t kKitTextBytesMax = 256;

struct KitRow {
  std::string world, line;
};

/// Returns the rows of the file. A missing or broken file has none.
std::vector<KitRow> read_kits(const std::string& file) {
  std::vector<KitRow> out;
  const auto text = read_text_file(file, kKitsBytesMax);
  if (!text) return out;
  try {
    const toml::table root = toml::parse(*text);
    const toml::array* const rows = root["world"].as_array();
    if (rows == nullptr) return out;
    for (const toml::node& node : *rows) {
      const toml::table* const row = node.as_table();
      if (row == nullptr || out.size() == kWorldKitsMax) continue;
      auto world = (*row)["id"].value<std::string>();
      auto line = (*row)["kit"].value<std::string>();
      const auto is_sound = [](const std::optional<std::string>& value) {
        return value && value->size() <= kKitTextBytesMax && is_printable_utf8(*value);
      };
      if (is_sound(world) && is_sound(line)) out.push_back({*std::move(world), *std::move(line)});
    }
  } catch (const toml::parse_error&) {
    static_cast<void>(set_aside(file));
  }
  return out;
}

}  // namespace

std::string default_kits_file() {
  const std::string folder = user_folder(UserFolder::state);
  return folder.empty() ? "" : folder + "/worlds.toml";
}

std::optional<std::string> load_kit(const std::string& file, const std::string& world) {
  std::error_code error;
  if (file.empty() || !std::filesystem::exists(file, error)) return std::nullopt;
  for (KitRow& row : read_kits(file)) {
    if (row.world == world) return std::move(row.line);
  }
  return std::nullopt;
}

Result<void, std::string> save_kit(const std::string& file, const std::string& world,
                                   const std::string& line) {
  if (file.empty()) return failure(std::string("no file for the kits of worlds"));
  std::error_code error;
  std::vector<KitRow> rows;
  if (std::filesystem::exists(file, error)) rows = read_kits(file);
  std::erase_if(rows, [&](const KitRow& row) { return row.world == world; });
  rows.insert(rows.begin(), {world, line});
  if (rows.size() > kWorldKitsMax) rows.resize(kWorldKitsMax);
  std::string out =
      "# The hotbars and tools of runstone-client by world, newest first: the tool, the\n"
      "# chosen slot from 0, and the numbers of the materials.\n";
  for (const KitRow& row : rows)
    out += fmt::format("\n[[world]]\nid = {}\nkit = {}\n", toml_string(row.world),
                       toml_string(row.line));
  return write_private_file(file, out);
}

void UnsavedKits::add(std::string world, std::string line) {
  std::erase_if(lines_, [&](const auto& entry) { return entry.first == world; });
  lines_.emplace_back(std::move(world), std::move(line));
}

Result<void, std::string> UnsavedKits::save(const std::string& file) {
  for (; !lines_.empty(); lines_.erase(lines_.begin())) {
    const auto& [world, line] = lines_.front();
    if (auto saved = save_kit(file, world, line); !saved) return saved;
  }
  return {};
}

}  // namespace runstone
