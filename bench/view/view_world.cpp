#include "bench/view/view_world.hpp"

#include <algorithm>
#include <array>

#include "bench/worlds/seeded_worlds.hpp"
#include "common/core/assert.hpp"

namespace runstone::bench {
namespace {

constexpr unsigned kEdge = 32;
constexpr const char* kHill = "hill";

/// Colours of the materials of the seeded worlds, in the order of Block.
constexpr std::array<MaterialColour, 11> kColours = {{{142, 146, 152, 255},
                                                      {150, 112, 78, 255},
                                                      {104, 148, 74, 255},
                                                      {206, 188, 132, 255},
                                                      {62, 110, 190, 255},
                                                      {190, 214, 226, 255},
                                                      {128, 92, 56, 255},
                                                      {170, 84, 70, 255},
                                                      {74, 120, 58, 255},
                                                      {196, 160, 70, 255},
                                                      {150, 92, 84, 255}}};

Material last_material(const FramesWorld& world) {
  Material out = 0;
  for (const FramesChunk& chunk : world.chunks) {
    chunk.volume.scene.chunk.runs.visit([&](const auto& runs) {
      for (std::size_t i = 0; i < runs.size(); ++i) out = std::max(out, runs.material(i));
    });
  }
  return out;
}

}  // namespace

std::vector<std::string> view_world_names() {
  std::vector<std::string> out = {kHill};
  for (const VoxelWorld& world : seeded_worlds()) out.push_back(world.name);
  for (std::string& name : frames_world_names()) out.push_back(std::move(name));
  return out;
}

Result<FramesWorld, std::string> view_world(const std::string& name, const std::string& luanti) {
  const bool is_hill = name == kHill;
  for (const VoxelWorld& world : seeded_worlds()) {
    if (is_hill && world.name == "hills") return block_of(world, {0, -16, 0}, {1, 1, 1}, kEdge);
    if (world.name == name) return block_of(world, {0, -32, 0}, {4, 2, 4}, kEdge);
  }
  return frames_world(name, luanti);
}

MaterialTable materials_of(const FramesWorld& world) {
  if (world.materials) return *world.materials;
  MaterialTable out;
  const Material last = last_material(world);
  for (Material id = 1; id <= last; ++id) {
    MaterialInfo info;
    info.name = "material " + std::to_string(id);
    info.visibility = (*world.visibility)[id];
    info.colour = kColours[(id - 1U) % kColours.size()];
    if (info.visibility == Visibility::transparent) info.colour[3] = 150;
    const auto added = out.add(std::move(info));
    RUNSTONE_ASSERT(added);
  }
  return out;
}

}  // namespace runstone::bench
