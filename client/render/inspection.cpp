#include "client/render/inspection.hpp"

#include <algorithm>

namespace runstone {

std::optional<InspectionMode> parse_inspection_mode(std::string_view name) {
  const auto* const found =
      std::find_if(kInspectionModes.begin(), kInspectionModes.end(),
                   [name](InspectionMode mode) { return to_string(mode) == name; });
  if (found == kInspectionModes.end()) return std::nullopt;
  return *found;
}

std::vector<std::uint32_t> run_start_bits(const RunChunk& chunk) {
  std::vector<std::uint32_t> out(chunk.volume() / 32);
  std::uint32_t start = 0;
  for (std::size_t run = 0; run < chunk.runs.size(); ++run) {
    out[start / 32] |= 1U << (start % 32);
    start = chunk.runs.end(run);
  }
  return out;
}

}  // namespace runstone
