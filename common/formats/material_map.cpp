#include "common/formats/material_map.hpp"

#include <algorithm>
#include <utility>

#include "common/formats/material_match.hpp"
#include "common/formats/minecraft_blocks.hpp"
#include "common/formats/shape_names.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {
namespace {

constexpr std::string_view kEmptyName = "air";
constexpr std::size_t kUnusedListed = 8;

MaterialRow empty_row() { return {std::string(kEmptyName), {0, 0, 0, 0}, Visibility::empty}; }

/// Returns the name of a material without its states, and all its states.
ForeignBlock block_of(const BuildMaterial& material) {
  const std::string& name = material.row.name;
  if (auto block = block_of_minecraft_material(name)) {
    // The name of a block that Minecraft does not know may lack the states.
    if (block->states.empty()) block->states = material.states;
    return *std::move(block);
  }
  const std::size_t open = name.rfind('[');
  if (!name.ends_with(']') || open == std::string::npos || open == 0)
    return {name, material.states};
  const std::string states = name.substr(open + 1, name.size() - open - 2);
  return {name.substr(0, open), material.states.empty() ? states : material.states};
}

/// Returns the material that a name stands for, with the look of `source` if nobody knows the name.
/// Its shape is that of the name.
MaterialRow row_named(const std::string& name, const MaterialRow& source) {
  const MaterialTable& known = default_material_table();
  if (const auto id = known.find(name)) return row_of(known[*id]);
  MaterialRow out = source;
  const auto block = block_of_minecraft_material(name);
  if (block && block->name.starts_with("minecraft:"))
    out = row_of(material_of_minecraft_block(*block, true));
  if (out.visibility == Visibility::empty) return empty_row();
  out.name = name;
  out.shape = shape_of_material_name(name).value_or(Shape{});
  return out;
}

}  // namespace

Result<MaterialMap> MaterialMap::of(std::vector<MaterialMapRow> rows) {
  MaterialMap out;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string& from = rows[i].from;
    if (from.empty()) return fail(ErrorCode::bad_value, "names no material of the source", i);
    if (from.size() > kMaterialPatternBytesMax)
      return fail(ErrorCode::limit_exceeded, "is longer than 512 bytes", i);
    if (rows[i].to.empty()) return fail(ErrorCode::bad_value, "names no material", i);
    if (rows[i].to.size() > kMaterialNameBytesMax)
      return fail(ErrorCode::limit_exceeded, "must be a name of at most 64 bytes", i);
    const MaterialRow to{rows[i].to};
    if (!validate_material(to.name, to.colour, to.visibility, to.body, to.look))
      return fail(ErrorCode::bad_value, "must be a name without control characters", i);
    const std::size_t star = from.find('*');
    const bool is_beginning = star == from.size() - 1;
    if (star != std::string::npos && !is_beginning)
      return fail(ErrorCode::bad_value,
                  "has a * before its end: only the last character may be one", i);
    const bool is_new = is_beginning ? out.beginnings_.try_emplace(from.substr(0, star), i).second
                                     : out.exact_.try_emplace(from, i).second;
    if (!is_new) return fail(ErrorCode::bad_value, "is there twice", i);
  }
  out.rows_ = std::move(rows);
  return out;
}

std::optional<std::size_t> MaterialMap::find(const BuildMaterial& material) const {
  const ForeignBlock block = block_of(material);
  const std::string full =
      block.states.empty() ? block.name : block.name + '[' + block.states + ']';
  for (const std::string& form : {world_name_of(material), full, block.name}) {
    const auto row = exact_.find(form);
    if (row != exact_.end()) return row->second;
  }
  std::string_view beginning(full);
  beginning = beginning.substr(0, kMaterialPatternBytesMax);
  while (!beginnings_.empty()) {
    const auto row = beginnings_.find(beginning);
    if (row != beginnings_.end()) return row->second;
    if (beginning.empty()) break;
    beginning.remove_suffix(1);
  }
  return std::nullopt;
}

std::optional<MaterialRow> MaterialMap::apply(const BuildMaterial& material,
                                              AppliedRows& applied) const {
  if (material.row.visibility == Visibility::empty) return std::nullopt;
  const auto number = find(material);
  if (!number) return std::nullopt;
  applied.insert(*number);
  const std::string& to = rows_[*number].to;
  return to == kEmptyName ? empty_row() : row_named(to, material.row);
}

std::string unused_rows_text(const MaterialMap& map, const AppliedRows& applied) {
  std::string out;
  std::size_t unused = 0;
  for (std::size_t i = 0; i < map.rows().size(); ++i) {
    if (applied.contains(i) || ++unused > kUnusedListed) continue;
    out += (out.empty() ? "\"" : ", \"") + map.rows()[i].from + '"';
  }
  if (unused > kUnusedListed) out += " and " + std::to_string(unused - kUnusedListed) + " more";
  return out;
}

}  // namespace runstone
