// counted: a number with its noun, for answers to commands.
#pragma once
#include <cstdint>
#include <string>

namespace runstone {

/// Returns "1 edit", "2 edits".
inline std::string counted(std::uint64_t count, const char* one) {
  return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

}  // namespace runstone
