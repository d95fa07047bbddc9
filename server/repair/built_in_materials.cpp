#include "server/repair/built_in_materials.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "common/core/key_text.hpp"
#include "server/repair/log_gaps.hpp"
#include "server/store/chunk_table.hpp"
#include "server/store/kept_records.hpp"
#include "server/store/world_folder.hpp"

namespace runstone {
namespace {

constexpr std::size_t kKeysAtOnce = 1'024;

std::string lacks_text(std::string where, std::size_t material, const MaterialTable& table) {
  return std::move(where) + " has material " + std::to_string(material) + ", and the table has " +
         std::to_string(table.size());
}

/// Returns the reason why the table does not fit the base, or an empty text.
StoreResult<std::string> fault_of_base(sql::Database& database, const MaterialsPin& pin,
                                       const MaterialTable& table) {
  auto base = ChunkTable::open(database, ChunkTable::Kind::base);
  if (!base) return failure(base.error());
  std::optional<ChunkKey> behind;
  for (;;) {
    const auto keys = base->keys(database, behind, kKeysAtOnce);
    if (!keys) return failure(keys.error());
    if (keys->empty()) return std::string();
    behind = keys->back();
    for (const ChunkKey& key : *keys) {
      const auto chunk = base->load(key, kSequenceMax, pin.chunk_edge, RowCheck::bytes);
      if (!chunk) return failure(chunk.error());
      if (!chunk->has_value()) continue;
      if ((*chunk)->version == Version{})
        return std::string("the world was imported, and its table came with it");
      const RunList& runs = (*chunk)->voxels.runs;
      for (std::size_t i = 0; i < runs.size(); ++i) {
        if (!table.knows(runs.material(i)))
          return lacks_text("base chunk=" + text_of(key), runs.material(i), table);
      }
    }
  }
}

/// Returns the greatest material of a record that has voxels or gives a texture, otherwise 0.
Material material_of(const EditRecord& record) {
  if (has_voxels(record.edit)) return material_max(record.edit);
  Material greatest = kEmpty;
  if (const GivenTexture* given = given_texture_of(record.edit)) {
    for (const TextureUse& use : given->uses) greatest = std::max(greatest, use.material);
  }
  return greatest;
}

/// Returns the reason why the table does not fit the records that a compaction kept, or an empty
/// text.
StoreResult<std::string> fault_of_kept(sql::Database& database, const MaterialTable& table) {
  auto kept = KeptRecords::open(database);
  if (!kept) return failure(kept.error());
  const auto records = kept->records();
  if (!records) return failure(records.error());
  for (const EditRecord& record : records->rows) {
    if (!table.knows(material_of(record)))
      return lacks_text("rights_record seq=" + std::to_string(record.version.seq),
                        material_of(record), table);
  }
  return std::string();
}

/// Returns the reason why the table does not fit the log, or an empty text.
StoreResult<std::string> fault_of_log(sql::Database& database, MaterialTable table) {
  std::string fault;
  auto read = each_record(database, [&](const EditRecord& record) -> StoreResult<void> {
    if (!fault.empty()) return {};
    const std::string where = "edit_log seq=" + std::to_string(record.version.seq);
    if (const AddedMaterials* added = added_materials_of(record.edit)) {
      if (!table.append(added->first, added->rows))
        fault = where + " adds material " + std::to_string(added->first) + ", and the table has " +
                std::to_string(table.size());
    } else if (const GivenShapes* given = given_shapes_of(record.edit)) {
      if (!table.give_shapes(given->rows))
        fault = where + " gives shapes that do not fit the table";
    } else if (!table.knows(material_of(record))) {
      fault = lacks_text(where, material_of(record), table);
    }
    return {};
  });
  if (!read) return failure(read.error());
  return fault;
}

StoreResult<std::string> fault_of(sql::Database& database, const MaterialsPin& pin,
                                  const MaterialTable& table) {
  if (const auto generator = make_generator(pin.generator, table); !generator)
    return "the generator cannot be made with it: " + std::string(generator.error().what);
  auto fault = fault_of_base(database, pin, table);
  if (fault && fault->empty()) fault = fault_of_kept(database, table);
  if (fault && fault->empty()) fault = fault_of_log(database, table);
  return fault;
}

}  // namespace

StoreResult<BuiltInMaterials> find_built_in_materials(sql::Database& database,
                                                      const MaterialsPin& pin) {
  // Tables only grow from version to version. An older world has fewer rows, and no shapes.
  const std::string own = "the built-in table of the generator " + pin.generator.name;
  std::array<std::pair<std::string, std::string>, 2> tried = {
      std::pair("the built-in table without shapes", ""), std::pair(own, pin.generator.name)};
  if (pin.has_shapes) std::swap(tried[0], tried[1]);
  BuiltInMaterials out;
  for (const auto& [name, generator] : tried) {
    auto table = read_materials("", generator);
    if (!table) continue;
    auto fault = fault_of(database, pin, *table);
    if (!fault) return failure(fault.error());
    out.fault = *std::move(fault);
    if (!out.fault.empty()) continue;
    return BuiltInMaterials{*std::move(table), name, ""};
  }
  return out;
}

}  // namespace runstone
