#include "server/replay/luanti_world_writer.hpp"

#include <utility>

#include "common/core/assert.hpp"
#include "common/formats/luanti_block.hpp"
#include "common/os/output_file.hpp"
#include "common/sqlite/sqlite_file.hpp"

namespace runstone {
namespace {

constexpr std::uint64_t kBlocksPerTransaction = 8192;

constexpr const char* kMapSettings =
    "mg_name = singlenode\n"
    "mg_flags = nocaves, nodungeons, nolight, nodecorations, nobiomes\n"
    "seed = 0\n"
    "water_level = -31000\n"
    "[end_of_params]\n";

std::string world_settings(const std::string& name) {
  return "world_name = " + name +
         "\n"
         "gameid = minetest\n"
         "backend = sqlite3\n"
         "player_backend = sqlite3\n"
         "auth_backend = sqlite3\n";
}

}  // namespace

LuantiWorldWriter::LuantiWorldWriter(NewFolder folder, sql::Database map, sql::Statement insert)
    : folder_(std::move(folder)),
      map_(std::make_unique<sql::Database>(std::move(map))),
      insert_(std::move(insert)) {}

Result<LuantiWorldWriter, std::string> LuantiWorldWriter::make(const std::string& folder,
                                                               const std::string& name,
                                                               std::ostream& out) {
  auto made = NewFolder::make(folder, out);
  if (!made) return failure(made.error());
  const std::string path = made->path() + '/';
  if (auto done = write_output_file(path + "world.mt", world_settings(name)); !done)
    return failure(done.error());
  if (auto done = write_output_file(path + "map_meta.txt", kMapSettings); !done)
    return failure(done.error());
  auto map = sql::open_sqlite(path + "map.sqlite", sql::SqliteMode::create);
  if (!map) return failure(map.error().file + ": " + map.error().what);
  for (const char* statement :
       {"CREATE TABLE blocks (pos INTEGER PRIMARY KEY NOT NULL, data BLOB)", "BEGIN"}) {
    if (const auto done = map->run(statement); !done)
      return failure(done.error().file + ": " + done.error().what);
  }
  auto insert = map->prepare("INSERT INTO blocks (pos, data) VALUES (?1, ?2)");
  if (!insert) return failure(insert.error().file + ": " + insert.error().what);
  return LuantiWorldWriter(*std::move(made), *std::move(map), *std::move(insert));
}

Unexpected<std::string> LuantiWorldWriter::error(const sql::Error& error) const {
  return failure(error.file + ": " + error.what);
}

Result<void, std::string> LuantiWorldWriter::put(ChunkCoord block, ByteView data) {
  RUNSTONE_ASSERT(map_ != nullptr);
  insert_.bind(1, luanti_block_pos(block)).bind(2, data);
  if (const auto done = insert_.run(); !done) return error(done.error());
  if (++blocks_ % kBlocksPerTransaction != 0) return {};
  for (const char* statement : {"COMMIT", "BEGIN"}) {
    if (const auto done = map_->run(statement); !done) return error(done.error());
  }
  return {};
}

Result<void, std::string> LuantiWorldWriter::finish() {
  RUNSTONE_ASSERT(map_ != nullptr);
  if (const auto done = map_->run("COMMIT"); !done) return error(done.error());
  insert_ = {};
  map_.reset();
  return folder_.finish("world.mt");
}

}  // namespace runstone
