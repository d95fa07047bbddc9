// PageCells: the cells of one page of a b-tree of SQLite, read without the SQLite library. A cell
// whose bytes lie outside the page is left out and counted.
// Source: "B-tree Pages" in https://sqlite.org/fileformat2.html
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "common/core/bytes.hpp"

namespace runstone {

/// A row in a page. The views are those of the page.
struct PageCell {
  std::optional<std::int64_t> row_id;  // nullopt: the table has no row ids, or it is an index
  ByteView local;                      // the first bytes of the record
  std::uint64_t record_bytes = 0;      // of the whole record
  std::uint32_t overflow = 0;          // the page that has the next bytes; 0: `local` has all
};

struct PageCells {
  std::vector<PageCell> cells;
  std::uint64_t unreadable = 0;  // cells that lie outside the page
};

/// The bytes of the header of the database, with which its first page begins.
inline constexpr std::size_t kDatabaseHeaderBytes = 100;

/// Returns the big-endian number at `at`. Requires at + 4 <= in.size().
std::uint32_t sqlite_u32(ByteView in, std::size_t at);

/// Returns the cells of a page. Returns nullopt if the page is none of a b-tree. An interior page
/// of a table has no rows, so no cells are returned for it. `header_bytes` are those before the
/// header of the page; `usable` are the bytes of the page that SQLite uses. Requires that the size
/// of the page is a power of two.
std::optional<PageCells> cells_of(ByteView page, std::size_t header_bytes, std::size_t usable);

}  // namespace runstone
