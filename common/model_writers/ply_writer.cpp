#include <array>
#include <cmath>

#include "common/core/assert.hpp"
#include "common/core/version.hpp"
#include "common/model_writers/model_walk.hpp"
#include "common/model_writers/model_writers.hpp"

namespace runstone {
namespace {

struct PlyCounts {
  std::uint64_t vertices = 0, triangles = 0;
};

void write_ply_head(const WrittenBuild& source, const PlyCounts& counts, ModelOutput& out) {
  out.text("ply\nformat binary_little_endian 1.0\ncomment Runstone ");
  out.text(version());
  out.text("\ncomment origin in the world: ");
  const VoxelPos& origin = source.info.origin;
  out.number(origin.x);
  out.text(" ");
  out.number(origin.y);
  out.text(" ");
  out.number(origin.z);
  out.text("\nelement vertex ");
  out.number(counts.vertices);
  for (const std::string_view name : {"x", "y", "z", "nx", "ny", "nz"}) {
    out.text("\nproperty float ");
    out.text(name);
  }
  for (const std::string_view name : {"red", "green", "blue", "alpha"}) {
    out.text("\nproperty uchar ");
    out.text(name);
  }
  out.text("\nelement face ");
  out.number(counts.triangles);
  out.text("\nproperty list uchar int vertex_indices\nend_header\n");
}

void write_ply_vertices(const WrittenBuild& source, double scale, const RegionModel& region,
                        ModelOutput& out) {
  // The axis z of the file points up: x east, y north, z up.
  const auto triple = [&](double x, double y, double z, double factor) {
    for (const double v : {x, 0 - z, y}) out.f32(static_cast<float>(v * factor));
  };
  const VoxelPos& origin = region.origin;
  const auto voxels = [](std::int32_t from, std::uint16_t units) {
    return from + static_cast<double>(units) / kShapeUnits;
  };
  for (const ModelPart& part : region.parts) {
    const MaterialColour& colour = source.materials[part.number - 1U].colour;
    for (const ModelVertex& vertex : region.vertices_of(part)) {
      triple(voxels(origin.x, vertex.x), voxels(origin.y, vertex.y), voxels(origin.z, vertex.z),
             scale);
      const std::array<double, 3> normal = unit_normal(vertex.normal);
      triple(normal[0], normal[1], normal[2], 1);
      out.bytes(colour);
    }
  }
}

}  // namespace

Result<void> write_ply_model(const WrittenBuild& source, const ModelWriting& writing,
                             const ModelSink& sink) {
  RUNSTONE_ASSERT(std::isfinite(writing.metres_per_voxel) && writing.metres_per_voxel > 0);
  ModelWalk walk(source, writing, PlaneSides::both);
  PlyCounts counts;
  walk.for_each_region([&](const RegionModel& region) {
    counts.vertices += region.vertices.size();
    counts.triangles += region.indices.size() / 3;
    return true;
  });
  if (const auto checked = walk.check(); !checked) return checked;
  if (counts.triangles == 0) return fail(ErrorCode::bad_value, "model: build shows no face");
  if (counts.vertices > kPlyCountMax || counts.triangles > kPlyCountMax) {
    return fail(
        ErrorCode::limit_exceeded,
        "model: a .ply has at most 2,147,483,647 vertices and triangles; write a smaller box");
  }
  ModelOutput out(sink);
  write_ply_head(source, counts, out);
  walk.for_each_region([&](const RegionModel& region) {
    write_ply_vertices(source, writing.metres_per_voxel, region, out);
    return out.ok();
  });
  std::uint32_t first = 0;
  walk.for_each_region([&](const RegionModel& region) {
    for (const ModelPart& part : region.parts) {
      const auto indices = region.indices_of(part);
      for (std::size_t i = 0; i < indices.size(); i += 3) {
        out.u8(3);
        for (std::size_t k = i; k < i + 3; ++k) out.u32(first + indices[k]);
      }
      first += static_cast<std::uint32_t>(part.vertex_count);
    }
    return out.ok();
  });
  if (!out.flush()) return fail(ErrorCode::io_failed, "model: cannot be written");
  return {};
}

}  // namespace runstone
