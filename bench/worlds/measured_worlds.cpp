#include "bench/worlds/measured_worlds.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <ostream>

#include "bench/harness/clocks.hpp"
#include "bench/worlds/luanti_world.hpp"
#include "bench/worlds/seeded_worlds.hpp"
#include "common/generate/scenarios/scenario_model.hpp"
#include "tests/support/scenarios/scenario_scene.hpp"

namespace runstone::bench {
namespace {

/// Returns the chunk in the middle of the thesis' 3 x 3 x 3, with its neighbours, for each
/// scenario.
MeasuredWorld scenarios_at(unsigned edge) {
  MeasuredWorld out;
  out.name = "scenarios";
  out.visibility = std::make_shared<const VisibilityTable>(test::scenario_visibility());
  if (!scenario_edge_valid(edge)) {
    out.missing = "the models have edges of 8, 16, 32, 64 and 128";
    return out;
  }
  for (unsigned number = 1; number <= kScenarioCount; ++number) {
    if (number == 5 && edge != 32) {
      out.missing = "scenario 5 is data of edge 32";
      continue;
    }
    const auto world = test::scenario_generator(number, edge);
    out.volumes.push_back({{}, edge, test::scenario_scene(*world, {}, edge, false)});
    out.parts.push_back(fmt::format("{}", number));
  }
  return out;
}

}  // namespace

std::set<std::string> measured_world_names() {
  std::set<std::string> out = {"luanti", "scenarios"};
  for (const VoxelWorld& world : seeded_worlds()) out.insert(world.name);
  return out;
}

std::set<std::string> landscape_names() {
  return {"hills", "terrain", "overhangs", "caves", "town", "luanti"};
}

Result<MeasuredWorlds, std::string> MeasuredWorlds::open(const std::vector<std::string>& names,
                                                         const std::string& luanti_folder) {
  const auto wanted = [&](const std::string& name) {
    return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
  };
  MeasuredWorlds out;
  for (VoxelWorld& world : seeded_worlds()) {
    if (wanted(world.name)) out.worlds_.push_back(std::move(world));
  }
  if (wanted("luanti")) {
    auto world = luanti_world(luanti_folder);
    if (!world) return failure(world.error());
    out.worlds_.push_back(std::move(*world));
  }
  for (const VoxelWorld& world : out.worlds_) out.names_.push_back(world.name);
  if (wanted("scenarios")) out.names_.push_back("scenarios");
  return out;
}

const VoxelWorld* MeasuredWorlds::voxels(std::size_t world) const {
  return world < worlds_.size() ? &worlds_[world] : nullptr;
}

MeasuredWorld MeasuredWorlds::at_edge(std::size_t world, unsigned edge) const {
  if (voxels(world) == nullptr) return scenarios_at(edge);
  const VoxelWorld& from = worlds_[world];
  MeasuredWorld out{from.name, from.visibility, volumes_of(from, edge), {}, ""};
  if (out.volumes.empty()) out.missing = "no volume of that edge has two materials";
  for (const Volume& volume : out.volumes) {
    out.parts.push_back(fmt::format("{} {} {}", volume.origin.x, volume.origin.y, volume.origin.z));
  }
  return out;
}

void MeasuredWorlds::measure_each(std::span<const unsigned> edges, const Measure& measure,
                                  std::vector<std::string>& skipped, std::ostream& progress) const {
  for (std::size_t w = 0; w < size(); ++w) {
    for (const unsigned edge : edges) {
      const std::uint64_t start = now_ns();
      const MeasuredWorld world = at_edge(w, edge);
      if (!world.missing.empty()) {
        skipped.push_back(fmt::format("{} edge {}: {}", world.name, edge, world.missing));
      }
      measure(w, world, edge);
      fmt::print(progress, "{} edge {}: {} volumes, {:.1f} s\n", world.name, edge,
                 world.volumes.size(), static_cast<double>(now_ns() - start) * 1e-9);
      progress.flush();
    }
  }
}

}  // namespace runstone::bench
