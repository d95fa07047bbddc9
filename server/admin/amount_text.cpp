#include "server/admin/amount_text.hpp"

#include <array>

namespace runstone {

std::string byte_count_text(std::uint64_t bytes) {
  constexpr std::array<const char*, 3> kUnits = {"KiB", "MiB", "GiB"};
  if (bytes < 1024) return std::to_string(bytes) + " bytes";
  // The value has one decimal, so it is kept in tenths.
  std::uint64_t tenths = bytes / 1024 * 10 + bytes % 1024 * 10 / 1024;
  std::size_t unit = 0;
  for (; unit + 1 < kUnits.size() && tenths >= 10'240; ++unit) tenths /= 1024;
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " " + kUnits[unit];
}

}  // namespace runstone
