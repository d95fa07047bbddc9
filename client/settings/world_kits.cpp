#include "client/settings/world_kits.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "client/settings/toml_rows.hpp"
#include "client/settings/toml_text.hpp"
#include "common/os/private_file.hpp"
#include "common/os/user_folders.hpp"

namespace runstone {
namespace {

constexpr std::size_t kKitsFileBytesMax = 1 << 16;
constexpr std::size_t kKitTextBytesMax = 256;

struct KitRow {
  std::string world, line;
};

/// Returns the rows of the file. A missing or broken file has none.
std::vector<KitRow> read_kits(const std::string& file) {
  std::vector<KitRow> out;
  each_row_of_file(file, kKitsFileBytesMax, "world", [&](const toml::table& row) {
    auto world = line_of(row.get("id"), kKitTextBytesMax);
    auto line = line_of(row.get("kit"), kKitTextBytesMax);
    if (world && line && out.size() < kWorldKitsMax)
      out.push_back({*std::move(world), *std::move(line)});
  });
  return out;
}

}  // namespace

std::string default_kits_file() {
  const std::string folder = user_folder(UserFolder::state);
  return folder.empty() ? "" : folder + "/worlds.toml";
}

std::optional<std::string> load_kit(const std::string& file, const std::string& world) {
  for (KitRow& row : read_kits(file)) {
    if (row.world == world) return std::move(row.line);
  }
  return std::nullopt;
}

Result<void, std::string> save_kit(const std::string& file, const std::string& world,
                                   const std::string& line) {
  if (file.empty()) return failure(std::string("no file for the kits of worlds"));
  std::vector<KitRow> rows = read_kits(file);
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

void UnsavedKits::add_all(UnsavedKits newer) {
  for (auto& [world, line] : newer.lines_) add(std::move(world), std::move(line));
}

std::optional<std::string> UnsavedKits::find(const std::string& world) const {
  for (const auto& [of, line] : lines_) {
    if (of == world) return line;
  }
  return std::nullopt;
}

Result<void, std::string> UnsavedKits::save(const std::string& file) {
  for (; !lines_.empty(); lines_.erase(lines_.begin())) {
    const auto& [world, line] = lines_.front();
    if (auto saved = save_kit(file, world, line); !saved) return saved;
  }
  return {};
}

}  // namespace runstone
