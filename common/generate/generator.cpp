#include "common/generate/generator.hpp"

#include "common/generate/flat_generator.hpp"
#include "common/generate/generator_parameters.hpp"
#include "common/generate/landscape/landscape_generator.hpp"
#include "common/generate/scenarios/scenario_world.hpp"
#include "common/generate/terrain_generator.hpp"

namespace runstone {

Result<std::unique_ptr<Generator>> make_generator(const GeneratorPin& pin,
                                                  const MaterialTable& materials) {
  if (pin.name != "empty" && pin.name != "flat" && pin.name != "landscape" &&
      pin.name != "terrain" && pin.name != "scenario") {
    return fail(ErrorCode::not_found, "generator name is unknown to this build");
  }
  if (pin.version != 1)
    return fail(ErrorCode::bad_version, "generator version is unknown to this build");
  if (pin.name == "empty") {
    if (!pin.parameters.empty())
      return fail(ErrorCode::bad_value, "generator \"empty\" takes no parameters");
    return FlatGenerator::make_empty();
  }
  if (pin.name == "flat") {
    const auto parameters = parse_flat_parameters(pin.parameters);
    if (!parameters) return failure(parameters.error());
    return FlatGenerator::make(*parameters, materials);
  }
  if (pin.name == "landscape") {
    const auto parameters = parse_landscape_parameters(pin.parameters);
    if (!parameters) return failure(parameters.error());
    return LandscapeGenerator::make(pin.seed, *parameters, materials);
  }
  if (pin.name == "scenario") {
    const auto parameters = parse_scenario_parameters(pin.parameters);
    if (!parameters) return failure(parameters.error());
    return ScenarioWorld::make(*parameters, materials);
  }
  const auto parameters = parse_terrain_parameters(pin.parameters);
  if (!parameters) return failure(parameters.error());
  return TerrainGenerator::make(pin.seed, *parameters, materials);
}

std::optional<RunChunk> Generator::coarse(VoxelPos, std::int32_t, std::uint8_t) const {
  return std::nullopt;
}

std::optional<RunChunk> coarse_outside(const VoxelBox& bounds, VoxelPos origin, std::int32_t edge,
                                       std::uint8_t level) {
  const std::int32_t width = edge << level;
  const VoxelBox tile{origin, {origin.x + width, origin.y + width, origin.z + width}};
  if (!intersect(bounds, tile).empty()) return std::nullopt;
  return uniform_chunk(Extent::cube(static_cast<unsigned>(edge)), kEmpty);
}

}  // namespace runstone
