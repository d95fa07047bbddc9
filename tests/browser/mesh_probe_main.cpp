// runstone-mesh-probe: meshes fixed chunks. For each world it prints the number of quads, a number that
// depends on all of their bits, and the time of a chunk in microseconds, with vector instructions and
// without. The presets release and web build it: scripts/check-browser compares the meshes of both.
//   runstone-mesh-probe [SECONDS]    time each world for about SECONDS (0.2)
//   runstone-mesh-probe digests      print the digests of generated worlds instead
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/digest.hpp"
#include "common/core/hash.hpp"
#include "common/generate/generator.hpp"
#include "common/generate/generator_parameters.hpp"
#include "common/materials/material_table.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/mesh/visibility.hpp"
#include "common/os/steady_clock.hpp"
#include "common/runs/reorder.hpp"

namespace runstone {
namespace {

struct ProbeWorld {
  std::string name;
  GeneratorPin pin;
  ChunkCoord first, last;  // the chunks that are meshed, with these corners
};

std::vector<ProbeWorld> worlds() {
  std::vector<ProbeWorld> out = {{"terrain", {"terrain", 1, 7, ""}, {-3, -1, -3}, {2, 2, 2}},
                                 {"landscape", {"landscape", 1, 7, ""}, {-3, -1, -3}, {2, 3, 2}}};
  for (int number = 1; number <= 37; ++number) {
    if (number == 5) continue;  // the thesis' noise, which no generator has
    const ScenarioParameters parameters{number, 32, "stone"};
    out.push_back({"scenario " + std::to_string(number),
                   {"scenario", 1, 1, to_toml(parameters)},
                   {1, 1, 1},
                   {1, 1, 1}});
  }
  return out;
}

constexpr std::int32_t kEdge = 32;

/// The chunks of a world and those around them.
class Chunks {
 public:
  Chunks(const Generator& generator, const ProbeWorld& world) {
    for (std::int32_t x = world.first.x - 1; x <= world.last.x + 1; ++x) {
      for (std::int32_t y = world.first.y - 1; y <= world.last.y + 1; ++y) {
        for (std::int32_t z = world.first.z - 1; z <= world.last.z + 1; ++z) {
          const ChunkCoord at{x, y, z};
          chunks_.emplace(
              at, in_cheapest_order(generator.generate(origin_of(at, kEdge), Extent::cube(kEdge))));
          if (x >= world.first.x && x <= world.last.x && y >= world.first.y && y <= world.last.y &&
              z >= world.first.z && z <= world.last.z)
            meshed_.push_back(at);
        }
      }
    }
  }

  const std::vector<ChunkCoord>& meshed() const { return meshed_; }
  const RunChunk& at(ChunkCoord at) const { return chunks_.at(at); }
  MeshNeighbours beside(ChunkCoord at) const {
    MeshNeighbours out{};
    for (int d = 0; d < kDirectionCount; ++d)
      out[static_cast<std::size_t>(d)] = &chunks_.at(neighbour(at, static_cast<Direction>(d)));
    return out;
  }

 private:
  std::map<ChunkCoord, RunChunk> chunks_;
  std::vector<ChunkCoord> meshed_;
};

/// Meshes all chunks of the world once. Returns a number of all quads.
std::uint64_t mesh_all(const Chunks& chunks, const VisibilityTable& visibility, RdmScratch& scratch,
                       std::size_t& quads) {
  std::uint64_t out = 0;
  ChunkMesh mesh;
  quads = 0;
  for (const ChunkCoord at : chunks.meshed()) {
    mesh_rdm(chunks.at(at), chunks.beside(at), visibility, scratch, mesh);
    quads += mesh.quad_count();
    for (const QuadLayers* pass : {&mesh.opaque, &mesh.transparent}) {
      for (const Quad& quad : pass->quads)
        out = (out ^ quad.bits) * 0x9e3779b97f4a7c15 + (out >> 31);
    }
  }
  return out;
}

/// Returns the time of a chunk, in microseconds: the shortest of some passes, because other programs
/// of the machine only make them longer.
double chunk_us(const Chunks& chunks, const VisibilityTable& visibility, RdmScratch& scratch,
                double seconds) {
  double best_us = 0;
  const std::int64_t until_ns = steady_now_ns() + static_cast<std::int64_t>(seconds * 1e9);
  for (bool is_first = true; is_first || steady_now_ns() < until_ns; is_first = false) {
    // The clock of a browser has steps of 5 us, so a pass is repeated until it takes longer.
    constexpr std::int64_t kPassNs = 2'000'000;
    const std::int64_t start_ns = steady_now_ns();
    std::int64_t took_ns = 0;
    std::size_t repeats = 0, quads = 0;
    while (took_ns < kPassNs) {
      static_cast<void>(mesh_all(chunks, visibility, scratch, quads));
      ++repeats;
      took_ns = steady_now_ns() - start_ns;
    }
    const double us =
        static_cast<double>(took_ns) / 1e3 / static_cast<double>(repeats * chunks.meshed().size());
    best_us = is_first ? us : std::min(best_us, us);
  }
  return best_us;
}

int probe(double seconds) {
  const MaterialTable& materials = landscape_material_table();
  const VisibilityTable visibility(cube_visibilities(materials));
  for (const ProbeWorld& world : worlds()) {
    const auto generator = make_generator(world.pin, materials);
    if (!generator) {
      std::fprintf(stderr, "%s: %s\n", world.name.c_str(), generator.error().what);
      return 1;
    }
    const Chunks chunks(**generator, world);
    RdmScratch scratch, plain;
    plain.use_plain_path(true);
    std::size_t quads = 0, plain_quads = 0;
    const std::uint64_t number = mesh_all(chunks, visibility, scratch, quads);
    if (mesh_all(chunks, visibility, plain, plain_quads) != number || quads != plain_quads) {
      std::fprintf(stderr, "%s: vector instructions give another mesh\n", world.name.c_str());
      return 1;
    }
    const double us = chunk_us(chunks, visibility, scratch, seconds);
    const double plain_us = chunk_us(chunks, visibility, plain, seconds);
    std::printf("%s, %zu, %016llx, %.3f, %.3f\n", world.name.c_str(), quads,
                static_cast<unsigned long long>(number), us, plain_us);
  }
  return 0;
}

/// A column of chunks of a world, and the coarse tiles at its foot.
Digest digest_of_column(const Generator& generator, ChunkCoord foot) {
  constexpr std::int32_t kHigh = 16;      // chunks
  constexpr std::uint8_t kLevelStep = 3;  // levels 3 and 6
  Digest out;
  for (std::int32_t y = 0; y < kHigh; ++y) {
    const ChunkCoord at{foot.x, foot.y + y, foot.z};
    const RunChunk chunk = generator.generate(origin_of(at, kEdge), Extent::cube(kEdge));
    out = out + world_digest_term({0, at}, digest_of(chunk));
  }
  for (std::uint8_t level = kLevelStep; level <= 2 * kLevelStep; level += kLevelStep) {
    const std::int32_t wide = kEdge << level;
    const ChunkCoord at = chunk_of(origin_of(foot, kEdge), wide);
    const auto tile = generator.coarse(origin_of(at, wide), kEdge, level);
    if (tile) out = out + world_digest_term({level, at}, digest_of(*tile));
  }
  return out;
}

/// Prints a line for each generator, seed and place: the digest, and the height of the surface
/// there.
int print_digests() {
  const MaterialTable& materials = landscape_material_table();
  constexpr std::uint64_t kSeeds[] = {0, 7, (std::uint64_t{1} << 53) + 1,
                                      std::numeric_limits<std::uint64_t>::max()};
  constexpr ChunkCoord kFeet[] = {{0, -8, 0}, {-37, -8, 1001}, {2'000'003, -8, -3'000'017}};
  for (const char* const name : {"landscape", "terrain"}) {
    for (const std::uint64_t seed : kSeeds) {
      const auto generator = make_generator({name, 1, seed, ""}, materials);
      if (!generator) {
        std::fprintf(stderr, "%s: %s\n", name, generator.error().what);
        return 1;
      }
      for (const ChunkCoord& foot : kFeet) {
        const VoxelPos origin = origin_of(foot, kEdge);
        std::printf("%s %llu at %d %d, %s, %d\n", name, static_cast<unsigned long long>(seed),
                    foot.x, foot.z, to_hex(digest_of_column(**generator, foot)).c_str(),
                    (*generator)->surface_y(origin.x, origin.z));
      }
      const VoxelPos spawn = (*generator)->spawn().value_or(VoxelPos{});
      std::printf("%s %llu spawn, %d %d, %d\n", name, static_cast<unsigned long long>(seed),
                  spawn.x, spawn.y, spawn.z);
    }
  }
  return 0;
}

}  // namespace
}  // namespace runstone

int main(int argc, char** argv) {
  constexpr double kSeconds = 0.2;
  if (argc > 1 && std::string_view(argv[1]) == "digests") return runstone::print_digests();
  return runstone::probe(argc > 1 ? std::strtod(argv[1], nullptr) : kSeconds);
}
