#include "server/admin/material_file.hpp"

#include <algorithm>

#include "common/os/text_file.hpp"

namespace runstone {
namespace {

constexpr std::size_t kRowsInLine = 8;

}  // namespace

Result<std::vector<MaterialFileRow>, std::string> read_material_file(const std::string& file) {
  const auto toml = read_text_file(file, kMaterialFileBytesMax, FileKinds::regular);
  if (!toml) return failure(toml.error());
  auto rows = parse_material_rows(*toml, file);
  if (!rows) return failure(rows.error().message());
  return *std::move(rows);
}

std::vector<std::string> material_lines(Material first, std::span<const MaterialRow> rows) {
  std::vector<std::string> lines;
  lines.reserve(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    lines.push_back(std::to_string(first + i) + " " + rows[i].name);
  return lines;
}

std::string added_materials_text(const AddedMaterials& added) {
  const std::span<const MaterialRow> rows(added.rows);
  std::string text;
  for (const std::string& line :
       material_lines(added.first, rows.first(std::min(rows.size(), kRowsInLine)))) {
    text += (text.empty() ? "" : ", ") + line;
  }
  if (rows.size() > kRowsInLine)
    text += " and " + std::to_string(rows.size() - kRowsInLine) + " more";
  return text;
}

std::string material_names_text(const std::vector<Material>& ids, const MaterialTable& materials) {
  std::string text;
  std::size_t shown = 0;
  for (; shown < std::min(ids.size(), kRowsInLine); ++shown) {
    const Material id = ids[shown];
    text += shown == 0 ? "" : ", ";
    text += materials.knows(id) ? materials[id].name : std::to_string(id);
  }
  if (ids.size() > shown) text += " and " + std::to_string(ids.size() - shown) + " more";
  return text;
}

}  // namespace runstone
