// StoredRow: the columns of one row, decoded from the bytes of a cell without the SQLite library. A
// repair reads the rows of a database that SQLite refuses to read.
// Source: "Record Format" in https://sqlite.org/fileformat2.html
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/core/bytes.hpp"

namespace runstone {

/// monostate: NULL. It stands for a key that is the row id of the row.
using StoredValue = std::variant<std::monostate, std::int64_t, std::string, Bytes>;
using StoredRow = std::vector<StoredValue>;

/// Reads a varint of SQLite, big-endian, at `at` and moves `at` behind it. Returns nullopt if the
/// bytes end before.
std::optional<std::uint64_t> read_sqlite_varint(ByteView in, std::size_t& at);

/// Returns the columns of a record. As in SQLite, bytes behind them are ignored. Returns nullopt if
/// the bytes are no record of a world: they are too few, or a column is a floating-point number.
std::optional<StoredRow> decode_stored_row(ByteView record);

}  // namespace runstone
