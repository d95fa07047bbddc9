#include "common/runs/material_scan.hpp"

namespace runstone {

bool has_material_from(const RunChunk& chunk, Material first) {
  return chunk.runs.visit([first](const auto& runs) {
    for (std::size_t i = 0; i < runs.size(); ++i) {
      if (runs.material(i) >= first) return true;
    }
    return false;
  });
}

}  // namespace runstone
