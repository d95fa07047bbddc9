#include "common/model_writers/gltf_layout.hpp"

#include <algorithm>
#include <array>

namespace runstone {

Result<GltfLayout> GltfLayout::of(ModelLevels& levels, bool is_quantised) {
  GltfLayout out;
  out.vertex_bytes = is_quantised ? 8 : 24;
  std::size_t level = 0;
  const auto count = [&](const RegionModel& region) {
    GltfRegion counted{region.origin, out.parts.size(), region.parts.size(), 0, 0};
    for (const ModelPart& part : region.parts) {
      GltfPart made;
      made.number = levels.finest_number(level, part.number);
      made.vertices = static_cast<std::uint32_t>(part.vertex_count);
      made.indices = static_cast<std::uint32_t>(part.index_count);
      made.min.fill(kModelRegionEdge);
      for (const ModelVertex& vertex : region.vertices_of(part)) {
        const Corner at = {vertex.x, vertex.y, vertex.z};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          made.min[axis] = std::min(made.min[axis], at[axis]);
          made.max[axis] = std::max(made.max[axis], at[axis]);
        }
      }
      counted.vertices_bytes += std::uint64_t{made.vertices} * out.vertex_bytes;
      counted.indices_bytes += made.indices_bytes();
      out.parts.push_back(made);
    }
    out.buffer_bytes += counted.vertices_bytes + counted.indices_bytes;
    out.regions.push_back(counted);
    return true;
  };
  for (; level < levels.count(); ++level) {
    levels.walk(level).for_each_region(count);
    if (out.regions.empty()) return fail(ErrorCode::bad_value, "model: build shows no face");
    out.level_ends.push_back(out.regions.size());
  }
  return out;
}

void write_gltf_region(const RegionModel& region, bool is_quantised, ModelOutput& out) {
  for (const ModelVertex& vertex : region.vertices) {
    std::array<int, 3> normal{};
    normal[static_cast<std::size_t>(axis_of(vertex.direction))] =
        is_positive(vertex.direction) ? 1 : -1;
    if (is_quantised) {
      const auto share = [&](std::size_t axis) {
        return static_cast<std::uint8_t>(static_cast<std::int8_t>(normal[axis] * 127));
      };
      out.bytes(std::array<std::uint8_t, 8>{vertex.x, vertex.y, vertex.z, 0, share(0), share(1),
                                            share(2), 0});
    } else {
      for (const std::uint8_t place : {vertex.x, vertex.y, vertex.z})
        out.f32(static_cast<float>(place));
      for (const int share : normal) out.f32(static_cast<float>(share));
    }
  }
  for (const ModelPart& part : region.parts) {
    const auto indices = region.indices_of(part);
    if (part.vertex_count > 65'535) {
      for (const std::uint32_t index : indices) out.u32(index);
      continue;
    }
    for (const std::uint32_t index : indices) out.u16(static_cast<std::uint16_t>(index));
    if (indices.size() % 2 != 0) out.u16(0);
  }
}

}  // namespace runstone
