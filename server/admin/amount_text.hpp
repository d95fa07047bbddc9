// Amounts as text for operators.
#pragma once
#include <cstdint>
#include <string>

namespace runstone {

/// Returns a count of bytes in the largest unit of which there is at least one, such as "12 MiB".
inline std::string memory_text(std::uint64_t bytes) {
  if (bytes < 1024) return std::to_string(bytes) + " bytes";
  if (bytes < 1024 * 1024) return std::to_string(bytes / 1024) + " KiB";
  return std::to_string(bytes / (1024 * 1024)) + " MiB";
}

}  // namespace runstone
