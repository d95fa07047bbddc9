// The part of SqlStore that knows the material table: `meta` has the table before the first edit
// of the log, and records of the log append to it, and give its rows shapes and textures.
#include <algorithm>
#include <string>
#include <utility>

#include "common/materials/look_on_shape.hpp"
#include "common/tiles/tile_rules.hpp"
#include "server/store/sql_result.hpp"
#include "server/store/sql_store.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {

StoreResult<MaterialTable> SqlStore::materials(Sequence at) {
  return at_one_moment<MaterialTable>([&]() -> StoreResult<MaterialTable> {
    // The row is read anew: since this store was opened, a compaction may have moved records into it.
    const auto rows = meta_table_.read_all();
    if (!rows) return failed(rows.error());
    auto meta = meta_of(*rows);
    if (!meta) {
      return failure(StoreError{StoreError::Kind::corrupt, file(), "meta key=" + meta.error(),
                                "is missing or has an impossible value"});
    }
    MaterialTable table = std::move(meta->materials);
    StoreResult<void> appended;
    LogQuery in_log;
    in_log.cause = Cause::materials;
    in_log.last = at;
    const auto read = query_log(in_log, [&](const EditRecord& record) {
      appended = append_materials(record, table);
      return appended.has_value();
    });
    if (!read) return failed(read.error());
    if (!appended) return failed(appended.error());
    return table;
  });
}

StoreResult<void> SqlStore::append_materials(const EditRecord& record, MaterialTable& table) const {
  const AddedMaterials* added = added_materials_of(record.edit);
  const auto appended = added != nullptr ? table.append(added->first, added->rows)
                                         : table.give_shapes(given_shapes_of(record.edit)->rows);
  if (appended) return {};
  return failure(StoreError{StoreError::Kind::corrupt, file(),
                            "edit_log seq=" + std::to_string(record.version.seq),
                            appended.error().what});
}

StoreResult<void> SqlStore::check_continues_materials(std::span<const EditRecord> records) {
  std::optional<MaterialTable> table;
  for (const EditRecord& record : records) {
    if (!changes_materials(record.edit)) continue;
    if (!table) {
      auto read = materials(kSequenceMax);
      if (!read) return failed(read.error());
      table = *std::move(read);
    }
    if (const auto fits = append_materials(record, *table); !fits)
      return refuse(fits.error().where, fits.error().what);
  }
  return {};
}

StoreResult<void> SqlStore::mark_shapes(std::span<const EditRecord> records) {
  bool needs_format = false, are_for_old_rows = false;
  std::optional<Material> first_new;
  for (const EditRecord& record : records) {
    if (const AddedMaterials* added = added_materials_of(record.edit)) {
      if (!first_new) first_new = added->first;
      needs_format = needs_format || has_silhouettes(added->rows);
    }
    const GivenShapes* given = given_shapes_of(record.edit);
    if (given == nullptr) continue;
    needs_format = true;
    for (const GivenShape& row : given->rows)
      are_for_old_rows = are_for_old_rows || !first_new || row.material < *first_new;
  }
  if (!needs_format) return {};
  auto table = materials(kSequenceMax);
  if (!table) return failed(table.error());
  for (const EditRecord& record : records) {
    if (!changes_materials(record.edit)) continue;
    if (auto fits = append_materials(record, *table); !fits) return fits;
  }
  // No stored tile has a voxel of a material that is new with these records.
  if (are_for_old_rows) {
    if (auto cleared = tiles_->clear(); !cleared) return cleared;
  }
  const std::uint32_t rules = tile_rules_of(tile_shapes_number(*table));
  if (auto put = meta_table_.put("tile_rules", std::int64_t{rules}); !put) return put;
  if (auto put = meta_table_.put(kShapesKey, std::int64_t{1}); !put) return put;
  return raise_format(kWorldFormatOfShapes);
}

StoreResult<void> SqlStore::mark_textures(std::span<const EditRecord> records) {
  const bool has_textures = std::ranges::any_of(
      records, [](const EditRecord& record) { return given_texture_of(record.edit) != nullptr; });
  if (!has_textures) return {};
  if (auto put = meta_table_.put(kTexturesKey, std::int64_t{1}); !put) return put;
  return raise_format(kWorldFormatOfTextures);
}

StoreResult<MaterialTable> SqlStore::keep_materials(Sequence last) {
  auto table = materials(last);
  if (!table) return table;
  if (const auto put = meta_table_.put("materials", to_toml(*table)); !put)
    return failed(put.error());
  return table;
}

}  // namespace runstone
