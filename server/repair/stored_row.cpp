#include "server/repair/stored_row.hpp"

#include <array>

namespace runstone {
namespace {

/// Returns the bytes of an integer of a serial type from 1 to 6.
std::size_t integer_bytes(std::uint64_t type) {
  constexpr std::array<std::size_t, 7> kBytes = {0, 1, 2, 3, 4, 6, 8};
  return kBytes[static_cast<std::size_t>(type)];
}

std::int64_t big_endian(ByteView in) {
  std::uint64_t value = in[0] >= 0x80 ? ~std::uint64_t{0} : 0;
  for (const std::uint8_t byte : in) value = value << 8 | byte;
  return static_cast<std::int64_t>(value);
}

}  // namespace

std::optional<std::uint64_t> read_sqlite_varint(ByteView in, std::size_t& at) {
  std::uint64_t value = 0;
  for (int i = 0; i < 9; ++i) {
    if (at >= in.size()) return std::nullopt;
    const std::uint8_t byte = in[at++];
    if (i == 8) return value << 8 | byte;
    value = value << 7 | (byte & 0x7fU);
    if (byte < 0x80) break;
  }
  return value;
}

std::optional<StoredRow> decode_stored_row(ByteView record) {
  std::size_t at = 0;
  const auto head = read_sqlite_varint(record, at);
  if (!head || *head > record.size() || *head < at) return std::nullopt;
  const ByteView types = record.first(static_cast<std::size_t>(*head));
  ByteView body = record.subspan(types.size());
  StoredRow row;
  while (at < types.size()) {
    const auto type = read_sqlite_varint(types, at);
    if (!type || *type == 7 || *type == 10 || *type == 11) return std::nullopt;
    const std::uint64_t bytes = *type >= 12  ? (*type - 12) / 2
                                : *type <= 6 ? integer_bytes(*type)
                                             : 0;
    if (bytes > body.size()) return std::nullopt;
    const ByteView value = body.first(static_cast<std::size_t>(bytes));
    body = body.subspan(value.size());
    if (*type == 0) {
      row.emplace_back();
    } else if (*type <= 6) {
      row.emplace_back(big_endian(value));
    } else if (*type <= 9) {
      row.emplace_back(static_cast<std::int64_t>(*type - 8));
    } else if (*type % 2 == 0) {
      row.emplace_back(Bytes(value.begin(), value.end()));
    } else {
      row.emplace_back(std::string(value.begin(), value.end()));
    }
  }
  return row;
}

}  // namespace runstone
