// A writer of map.sqlite of Luanti worlds for tests.
#pragma once
#include <fstream>
#include <string>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "tests/support/formats/luanti_bytes.hpp"
#include "tests/support/sql/raw_sql.hpp"

namespace runstone::test {

struct LuantiMapRow {
  ChunkCoord block;
  Bytes data;
};

/// Returns a block of stone.
inline LuantiBlockFields stone_block() {
  LuantiBlockFields fields;
  fields.names = {{0, "default:stone"}};
  return fields;
}

/// Returns the bytes as a literal of SQL.
inline std::string hex_row(ByteView data) {
  std::string out = "x'";
  for (const std::uint8_t byte : data) {
    out += "0123456789abcdef"[byte >> 4];
    out += "0123456789abcdef"[byte & 15];
  }
  return out + "'";
}

/// Makes a map with these rows, in this order. `schema` makes the table blocks(pos, data).
inline void write_luanti_map(
    const std::string& file, const std::vector<LuantiMapRow>& rows,
    const std::string& schema = "CREATE TABLE blocks (pos INT PRIMARY KEY, data BLOB)") {
  std::string sql = "BEGIN; " + schema;
  for (const LuantiMapRow& row : rows) {
    const std::int64_t pos = (std::int64_t{row.block.z} * 4096 + row.block.y) * 4096 + row.block.x;
    sql += "; INSERT INTO blocks VALUES (" + std::to_string(pos) + ", " + hex_row(row.data) + ")";
  }
  std::ofstream(file).close();  // SQLite makes a database of an empty file
  raw_sql(file, sql + "; COMMIT");
}

}  // namespace runstone::test
