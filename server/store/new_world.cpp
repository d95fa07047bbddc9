#include "server/store/new_world.hpp"

#include <string>

#include "common/materials/look_on_shape.hpp"
#include "common/tiles/tile_rules.hpp"
#include "server/store/meta_table.hpp"
#include "server/store/sql_result.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {

StoreResult<void> check_new_meta(const WorldMeta& meta, const std::string& file) {
  if (const auto readable = meta_of(rows_of(meta)); !readable) {
    return failure(StoreError{StoreError::Kind::bad_request, file, "",
                              "a new world cannot have this " + readable.error()});
  }
  return {};
}

StoreResult<void> fill_new_world(sql::Database& database, const WorldMeta& meta) {
  if (auto made = create_schema(database); !made) return made;
  auto table = MetaTable::open(database);
  if (!table) return failed(table.error());
  MetaRows rows = rows_of(meta);
  rows["epoch"] = std::int64_t{0};
  rows["checkpoint"] = std::int64_t{0};
  rows["author_max"] = std::int64_t{0};
  rows["log_last"] = std::int64_t{0};
  rows["tile_rules"] = std::int64_t{tile_rules_of(tile_shapes_number(meta.materials))};
  if (meta.materials.has_shapes() || has_silhouettes(meta.materials))
    rows[kShapesKey] = std::int64_t{1};
  for (const auto& [key, value] : rows) {
    if (auto put = table->put(key, value); !put) return put;
  }
  for (const char* key : {"base_fold", "snapshot_fold", "player_fold", "player_instance_fold",
                          "name_claim_fold", "rights_record_fold"}) {
    if (auto put = table->put_fold(key, {}); !put) return put;
  }
  if (auto put = table->put_log_head({}); !put) return put;
  return table->put_row_counts({});
}

}  // namespace runstone
