#include "server/mapping/material_map_file.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "common/os/text_file.hpp"

namespace runstone {
namespace {

constexpr std::string_view kSection = "materials";

/// Returns a key for a message. A long one is cut.
std::string shown_key(std::string_view key) {
  constexpr std::size_t kShownMax = 80;
  return '"' + std::string(key.substr(0, kShownMax)) + (key.size() > kShownMax ? "...\"" : "\"");
}

Result<toml::table, TextError> table_of(std::string_view toml, std::string_view file) {
  try {
    return toml::parse(toml, file);
  } catch (const toml::parse_error& error) {
    return failure(TextError{std::string(file), error.source().begin.line, "",
                             std::string(error.description())});
  }
}

}  // namespace

Result<MaterialMap, TextError> parse_material_map(std::string_view toml, std::string_view file) {
  const auto refused = [&](std::uint32_t line, std::string key, std::string what) {
    return failure(TextError{std::string(file), line, std::move(key), std::move(what)});
  };
  const auto root = table_of(toml, file);
  if (!root) return failure(root.error());
  for (const auto& [key, node] : *root) {
    if (key.str() == kSection) continue;
    return refused(key.source().begin.line, shown_key(key.str()),
                   "unknown key: rows stand below the line [materials]");
  }
  const toml::node* const section = root->get(kSection);
  const toml::table* const table = section != nullptr ? section->as_table() : nullptr;
  if (table == nullptr || table->empty()) {
    return refused(section != nullptr ? section->source().begin.line : 0, "",
                   "has no rows: they stand below the line [materials], such as "
                   "\"minecraft:oak_planks\" = \"planks\"");
  }
  std::vector<std::pair<std::uint32_t, MaterialMapRow>> rows;  // with their lines
  for (const auto& [key, node] : *table) {
    const auto to = node.value_exact<std::string>();
    if (!to)
      return refused(key.source().begin.line, shown_key(key.str()),
                     "must be the name of a material, in quotes");
    rows.push_back({key.source().begin.line, {std::string(key.str()), *to}});
  }
  // In the order of the file, whatever that of the table is.
  std::sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) {
    return std::tie(a.first, a.second.from) < std::tie(b.first, b.second.from);
  });
  std::vector<MaterialMapRow> plain;
  for (const auto& [line, row] : rows) plain.push_back(row);
  auto map = MaterialMap::of(std::move(plain));
  if (!map) {
    const auto& [line, row] = rows[static_cast<std::size_t>(map.error().offset)];
    return refused(line, shown_key(row.from), map.error().what);
  }
  return *std::move(map);
}

Result<MaterialMap, std::string> read_material_map(const std::string& file) {
  const auto toml = read_text_file(file, kMaterialMapFileBytesMax, FileKinds::regular);
  if (!toml) return failure(toml.error());
  auto map = parse_material_map(*toml, file);
  if (!map) return failure(map.error().message());
  return *std::move(map);
}

std::string unused_rows_notice(const std::string& file, const MaterialMap& map,
                               const AppliedRows& applied) {
  const std::string unused = unused_rows_text(map, applied);
  return unused.empty() ? "" : file + ": these rows fit no material: " + unused;
}

}  // namespace runstone
