// The folder of a Luanti world: where its map is. world.mt decides, because a map.sqlite from before
// a change of the backend may lie beside it.
#pragma once
#include <cstdint>
#include <string>

#include "common/core/result.hpp"
#include "server/import/import_error.hpp"

namespace runstone {

enum class LuantiBackend : std::uint8_t { sqlite, leveldb };

struct LuantiFolder {
  std::string map;  // the path of map.sqlite, or of the folder map.db of a LevelDB
  LuantiBackend backend = LuantiBackend::sqlite;
  /// The world has a second map, which is read where the map has no block. It is not imported.
  bool has_seed_map = false;
};

/// Finds the map of a world. A folder without world.mt has its map in map.sqlite. The error says
/// what the place is instead, or where the map is, and what to do.
Result<LuantiFolder, ImportError> find_luanti_map(const std::string& folder);

}  // namespace runstone
