#include "common/generate/scenarios/scenario_world.hpp"

#include <algorithm>
#include <bit>

#include "common/runs/run_builder.hpp"

namespace runstone {
namespace {

/// Returns the end of the stretch of equal bits that holds `at`; at most `edge`.
unsigned stretch_end(const ColumnBits& bits, unsigned at, unsigned edge) {
  const bool solid = (bits[at / 64] >> (at % 64) & 1) != 0;
  while (at < edge) {
    const std::uint64_t word = solid ? bits[at / 64] : ~bits[at / 64];
    const auto more = static_cast<unsigned>(std::countr_one(word >> (at % 64)));
    at += more;
    if (at % 64 != 0 || more == 0) break;
  }
  return at < edge ? at : edge;
}

/// Appends voxels [from, to) of a column of a model. Requires to <= edge.
void append(const ColumnBits& bits, unsigned from, unsigned to, Material material,
            RunBuilder& out) {
  while (from < to) {
    const unsigned end = stretch_end(bits, from, to);
    const bool solid = (bits[from / 64] >> (from % 64) & 1) != 0;
    out.append(end - from, solid ? material : kEmpty);
    from = end;
  }
}

}  // namespace

RunChunk scenario_chunk(const ScenarioModel& model, Material material) {
  const unsigned edge = model.edge();
  RunBuilder out(Extent::cube(edge), AxisOrder::yzx);
  for (unsigned x = 0; x < edge; ++x) {
    for (unsigned z = 0; z < edge; ++z) append(model.column(x, z), 0, edge, material, out);
  }
  return out.finish();
}

Result<std::unique_ptr<Generator>> ScenarioWorld::make(const ScenarioParameters& parameters,
                                                       const MaterialTable& materials) {
  const auto model = scenario_model(static_cast<unsigned>(parameters.number),
                                    static_cast<unsigned>(parameters.edge));
  if (!model) return failure(model.error());
  const auto material = materials.find(parameters.material);
  if (!material) return fail(ErrorCode::not_found, "the scenario's material is none of the table");
  return std::unique_ptr<Generator>(std::make_unique<ScenarioWorld>(*model, *material));
}

ColumnBits ScenarioWorld::column(std::int32_t x, std::int32_t z) const {
  const auto inside = [this](std::int32_t at) {
    return static_cast<unsigned>(at - floor_div(at, edge()) * edge());
  };
  return model_.column(inside(x), inside(z));
}

RunChunk ScenarioWorld::generate(VoxelPos origin, Extent extent) const {
  const VoxelBox requested = {origin,
                              {origin.x + extent.x, origin.y + extent.y, origin.z + extent.z}};
  const VoxelBox solid = intersect(requested, bounds());
  if (solid.empty()) return uniform_chunk(extent, kEmpty);
  RunBuilder out(extent, AxisOrder::yzx);
  for (std::int32_t x = requested.min.x; x < requested.max.x; ++x) {
    for (std::int32_t z = requested.min.z; z < requested.max.z; ++z) {
      if (x < solid.min.x || x >= solid.max.x || z < solid.min.z || z >= solid.max.z) {
        out.append(extent.y, kEmpty);
        continue;
      }
      const ColumnBits bits = column(x, z);
      out.append(static_cast<std::uint32_t>(solid.min.y - requested.min.y), kEmpty);
      for (std::int32_t y = solid.min.y; y < solid.max.y;) {  // one model above another
        const std::int32_t foot = floor_div(y, edge()) * edge();
        const std::int32_t end = std::min(foot + edge(), solid.max.y);
        append(bits, static_cast<unsigned>(y - foot), static_cast<unsigned>(end - foot), material_,
               out);
        y = end;
      }
      out.append(static_cast<std::uint32_t>(requested.max.y - solid.max.y), kEmpty);
    }
  }
  return out.finish();
}

std::int32_t ScenarioWorld::surface_y(std::int32_t x, std::int32_t z) const {
  const VoxelBox all = bounds();
  if (x < all.min.x || x >= all.max.x || z < all.min.z || z >= all.max.z) return y_min();
  const ColumnBits bits = column(x, z);
  for (unsigned word = 2; word-- > 0;) {
    if (bits[word] == 0) continue;
    const auto height = static_cast<std::int32_t>(64 * word + 64) - std::countl_zero(bits[word]);
    return edge() + height;  // in the topmost of the three models
  }
  return y_min();
}

}  // namespace runstone
