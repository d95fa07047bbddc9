#include "tests/bench/meshing/mesh_once.hpp"

#include <fmt/ostream.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "tests/bench/harness/machine.hpp"
#include "tests/bench/worlds/measured_worlds.hpp"

namespace runstone::bench {

void mesh_counted(std::span<Contestant> contestants, unsigned times) {
  PhaseTimes phases{};
  for (unsigned i = 0; i < times; ++i) {
    for (Contestant& contestant : contestants) contestant.mesh(phases);
  }
}

Result<void, std::string> run_mesh_once(const BenchOptions& options, std::ostream& out) {
  const auto worlds = MeasuredWorlds::open(options.worlds, options.luanti);
  if (!worlds) return Unexpected<std::string>{worlds.error()};
  const std::string& mesher = options.meshers.front();
  for (std::size_t w = 0; w < worlds->size(); ++w) {
    for (const unsigned edge : options.edges) {
      const MeasuredWorld world = worlds->at_edge(w, edge);
      std::vector<Contestant> contestants;
      std::size_t runs = 0, quads = 0;
      for (const Volume& volume : world.volumes) {
        auto contestant = make_contestant(mesher, volume, *world.visibility);
        if (!contestant) continue;
        PhaseTimes phases{};
        contestant->mesh(phases);  // buffers grow here
        contestants.push_back(std::move(*contestant));
        runs += volume.scene.chunk.runs.size();
      }
      if (contestants.empty()) {
        return Unexpected<std::string>{fmt::format("{} edge {}: nothing for {}", world.name, edge, mesher)};
      }
      mesh_counted(contestants, options.repetitions);
      for (const Contestant& contestant : contestants) quads += contestant.quads();
      const nlohmann::ordered_json line = {{"world", world.name},
                                           {"edge", edge},
                                           {"mesher", mesher},
                                           {"simd", this_machine().simd},
                                           {"commit", this_machine().commit},
                                           {"meshes", options.repetitions * contestants.size()},
                                           {"volumes", contestants.size()},
                                           {"runs", runs},
                                           {"quads", quads}};
      fmt::print(out, "{}\n", line.dump());
    }
  }
  return {};
}

}  // namespace runstone::bench
