#include "server/import/luanti_map.hpp"

namespace runstone {

Result<std::unique_ptr<LuantiMap>, std::string> open_luanti_map(const LuantiFolder& folder) {
  return folder.backend == LuantiBackend::leveldb ? open_luanti_leveldb_map(folder.map)
                                                  : open_luanti_sqlite_map(folder.map);
}

}  // namespace runstone
