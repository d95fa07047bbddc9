#include "bench/meshing/mesh_once.hpp"

#include <fmt/ostream.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "bench/harness/machine.hpp"
#include "bench/worlds/measured_worlds.hpp"

namespace runstone::bench {

void mesh_counted(std::span<MesherCase> mesher_cases, unsigned times) {
  PhaseTimes phases{};
  for (unsigned i = 0; i < times; ++i) {
    for (MesherCase& mesher_case : mesher_cases) mesher_case.mesh(phases);
  }
}

Result<void, std::string> run_mesh_once(const BenchOptions& options, std::ostream& out) {
  const auto worlds = MeasuredWorlds::open(options.worlds, options.luanti);
  if (!worlds) return failure(worlds.error());
  const std::string& mesher = options.meshers.front();
  for (std::size_t w = 0; w < worlds->size(); ++w) {
    for (const unsigned edge : options.edges) {
      const MeasuredWorld world = worlds->at_edge(w, edge);
      std::vector<MesherCase> mesher_cases;
      std::size_t runs = 0, quads = 0;
      for (const Volume& volume : world.volumes) {
        auto mesher_case = make_mesher_case(mesher, volume, *world.visibility);
        if (!mesher_case) continue;
        PhaseTimes phases{};
        mesher_case->mesh(phases);  // buffers grow here
        mesher_cases.push_back(std::move(*mesher_case));
        runs += volume.scene.chunk.runs.size();
      }
      if (mesher_cases.empty()) {
        return failure(fmt::format("{} edge {}: nothing for {}", world.name, edge, mesher));
      }
      mesh_counted(mesher_cases, options.repetitions);
      for (const MesherCase& mesher_case : mesher_cases) quads += mesher_case.quads();
      const nlohmann::ordered_json line = {{"world", world.name},
                                           {"edge", edge},
                                           {"mesher", mesher},
                                           {"simd", this_machine().simd},
                                           {"commit", this_machine().commit},
                                           {"meshes", options.repetitions * mesher_cases.size()},
                                           {"volumes", mesher_cases.size()},
                                           {"runs", runs},
                                           {"quads", quads}};
      fmt::print(out, "{}\n", line.dump());
    }
  }
  return {};
}

}  // namespace runstone::bench
