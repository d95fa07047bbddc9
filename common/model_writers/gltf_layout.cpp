#include "common/model_writers/gltf_layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace runstone {

Result<GltfLayout> GltfLayout::of(ModelLevels& levels, bool is_quantised) {
  GltfLayout out;
  std::size_t level = 0;
  const auto count = [&](const RegionModel& region) {
    GltfRegion counted;
    counted.origin = region.origin;
    counted.first_part = out.parts.size();
    counted.part_count = region.parts.size();
    counted.is_fine = region.is_fine;
    const std::uint32_t vertex_bytes = gltf_vertex(is_quantised, region.is_fine).bytes;
    for (const ModelPart& part : region.parts) {
      GltfPart made;
      made.number = levels.finest_number(level, part.number);
      made.vertices = static_cast<std::uint32_t>(part.vertex_count);
      made.indices = static_cast<std::uint32_t>(part.index_count);
      made.min.fill(kModelRegionUnits);
      for (const ModelVertex& vertex : region.vertices_of(part)) {
        const Corner at = {vertex.x, vertex.y, vertex.z};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          made.min[axis] = std::min(made.min[axis], at[axis]);
          made.max[axis] = std::max(made.max[axis], at[axis]);
        }
      }
      counted.vertices_bytes += std::uint64_t{made.vertices} * vertex_bytes;
      counted.indices_bytes += made.indices_bytes();
      out.parts.push_back(made);
    }
    out.buffer_bytes += counted.vertices_bytes + counted.indices_bytes;
    out.regions.push_back(counted);
    return true;
  };
  for (; level < levels.count(); ++level) {
    levels.walk(level).for_each_region(count);
    if (const auto checked = levels.walk(level).check(); !checked) return failure(checked.error());
    if (out.regions.empty()) return fail(ErrorCode::bad_value, "model: build shows no face");
    out.level_ends.push_back(out.regions.size());
  }
  return out;
}

void write_gltf_region(const RegionModel& region, bool is_quantised, ModelOutput& out) {
  for (const ModelVertex& vertex : region.vertices) {
    const std::array<std::uint16_t, 3> places = {vertex.x, vertex.y, vertex.z};
    const std::array<double, 3> normal = unit_normal(vertex.normal);
    if (!is_quantised) {
      for (const std::uint16_t place : places) out.f32(static_cast<float>(place) / kShapeUnits);
      for (const double share : normal) out.f32(static_cast<float>(share));
      continue;
    }
    for (const std::uint16_t place : places) {
      if (region.is_fine) {
        out.u16(place);
      } else {
        out.u8(static_cast<std::uint8_t>(place / kShapeUnits));
      }
    }
    if (region.is_fine) out.u8(0);
    out.u8(0);
    for (const double share : normal)
      out.u8(static_cast<std::uint8_t>(static_cast<std::int8_t>(std::lround(share * 127))));
    out.u8(0);
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
