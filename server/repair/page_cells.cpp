#include "server/repair/page_cells.hpp"

#include "server/repair/stored_row.hpp"

namespace runstone {
namespace {

constexpr std::uint8_t kInteriorIndex = 2, kInteriorTable = 5, kLeafIndex = 10, kLeafTable = 13;
constexpr std::size_t kLeafHeaderBytes = 8, kChildBytes = 4;

std::size_t u16_at(ByteView page, std::size_t at) {
  return static_cast<std::size_t>(page[at]) << 8 | page[at + 1];
}

/// Returns how many bytes of a record are in the page itself.
std::uint64_t local_bytes(std::uint64_t record, std::size_t usable, bool is_table) {
  const std::uint64_t most = is_table ? usable - 35 : (usable - 12) * 64 / 255 - 23;
  if (record <= most) return record;
  const std::uint64_t least = (usable - 12) * 32 / 255 - 23;
  const std::uint64_t fitting = least + (record - least) % (usable - 4);
  return fitting <= most ? fitting : least;
}

std::optional<PageCell> cell_at(ByteView page, std::size_t at, std::size_t usable,
                                std::uint8_t type) {
  const ByteView used = page.first(usable);
  if (type == kInteriorIndex) at += kChildBytes;
  PageCell cell;
  const auto bytes = read_sqlite_varint(used, at);
  if (!bytes) return std::nullopt;
  cell.record_bytes = *bytes;
  if (type == kLeafTable) {
    const auto row_id = read_sqlite_varint(used, at);
    if (!row_id) return std::nullopt;
    cell.row_id = static_cast<std::int64_t>(*row_id);
  }
  const std::uint64_t local = local_bytes(*bytes, usable, type == kLeafTable);
  const bool is_whole = local == *bytes;
  if (at > usable || local + (is_whole ? 0 : 4) > usable - at) return std::nullopt;
  cell.local = used.subspan(at, static_cast<std::size_t>(local));
  if (!is_whole) cell.overflow = sqlite_u32(used, at + static_cast<std::size_t>(local));
  return cell;
}

}  // namespace

std::uint32_t sqlite_u32(ByteView in, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = at; i < at + 4; ++i) value = value << 8 | in[i];
  return value;
}

std::optional<PageCells> cells_of(ByteView page, std::size_t header_bytes, std::size_t usable) {
  if (usable > page.size() || usable < 480 || header_bytes + kLeafHeaderBytes > usable)
    return std::nullopt;
  const std::uint8_t type = page[header_bytes];
  if (type == kInteriorTable) return PageCells{};
  if (type != kInteriorIndex && type != kLeafIndex && type != kLeafTable) return std::nullopt;
  const std::size_t count = u16_at(page, header_bytes + 3);
  const std::size_t pointers =
      header_bytes + kLeafHeaderBytes + (type == kInteriorIndex ? kChildBytes : 0);
  if (pointers + 2 * count > usable) return std::nullopt;
  PageCells out;
  for (std::size_t i = 0; i < count; ++i) {
    // SQLite ignores the bits of a pointer that no place in the page has.
    const std::size_t at = u16_at(page, pointers + 2 * i) & (page.size() - 1);
    const auto cell = at < pointers ? std::nullopt : cell_at(page, at, usable, type);
    if (cell) {
      out.cells.push_back(*cell);
    } else {
      ++out.unreadable;
    }
  }
  return out;
}

}  // namespace runstone
