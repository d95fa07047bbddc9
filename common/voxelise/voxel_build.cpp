#include "common/voxelise/voxel_build.hpp"

#include <optional>
#include <string_view>
#include <utility>

#include "common/builds/build_builder.hpp"
#include "common/core/assert.hpp"
#include "common/voxelise/beam.hpp"

namespace runstone {

std::string colour_material_name(const std::array<std::uint8_t, 3>& colour) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string out = "colour #";
  for (const std::uint8_t part : colour) {
    out += kDigits[part >> 4];
    out += kDigits[part & 15];
  }
  return out;
}

Result<VoxelBuild> voxel_build(const Model& model, const VoxeliseOptions& options,
                               std::size_t bytes_max, const ParallelFor& parallel_for) {
  // voxelise() checks the model again, which costs little.
  if (auto valid = validate(model); !valid) return failure(valid.error());
  if (!options.turn.valid()) return fail(ErrorCode::bad_value, "turn: is not one of the 48");
  const auto placement = ModelPlacement::of(model, options.turn, options.scale);
  if (!placement) return failure(placement.error());
  BuildCuts cuts;
  for (unsigned axis = 0; axis < 3; ++axis)
    cuts[axis] = grid_cuts(placement->side(axis), kVoxelSection);
  auto builder = BuildBuilder::of(std::move(cuts), bytes_max);
  if (!builder) return failure(builder.error());
  // The cell number of colour i is i + 1, that of its voxels.
  for (std::size_t i = 1; i <= options.colours_max && i <= kModelColoursMax; ++i)
    RUNSTONE_ASSERT(builder->number_of(static_cast<Material>(i)) == i);
  auto done = voxelise(
      model, options,
      [&](VoxelPiece&& piece) {
        const auto place = [](std::int32_t v) {
          return static_cast<std::uint32_t>(v / kVoxelSection);
        };
        return builder->put({place(piece.origin.x), place(piece.origin.y), place(piece.origin.z)},
                            std::move(piece.voxels));
      },
      parallel_for);
  if (!done) return failure(done.error());
  if (done->voxels == 0)
    return fail(ErrorCode::bad_value,
                "no voxel is left of the model: choose a larger scale, or a surface");
  auto build = builder->finish();
  if (!build) return failure(build.error());
  VoxelBuild out;
  out.build = *std::move(build);
  for (const auto& colour : done->colours) {
    MaterialRow row;
    row.name = colour_material_name(colour);
    row.colour = {colour[0], colour[1], colour[2], 255};
    out.materials.push_back(std::move(row));
  }
  out.result = *std::move(done);
  return out;
}

}  // namespace runstone
