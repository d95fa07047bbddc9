// A measurement that a person starts: unit_client_body "[.time]". It prints microseconds of processor
// time of the thread, and checks no bound, because another machine has other times.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <map>
#include <memory>
#include <vector>

#include "client/body/walker.hpp"
#include "common/generate/generator.hpp"
#include "common/os/thread_cpu_ns.hpp"
#include "common/runs/reorder.hpp"

namespace runstone::test {
namespace {

/// Generated terrain in the axis orders that need the fewest runs, as a client has it.
class TerrainSpace final : public VoxelSpace {
 public:
  static constexpr std::int32_t kEdge = 32;
  TerrainSpace() : VoxelSpace(kEdge) {
    auto made = make_generator({"terrain", 1, 7, ""}, default_material_table());
    REQUIRE(made);
    generator_ = *std::move(made);
  }
  const RunChunk* chunk(ChunkCoord at) const override {
    auto found = chunks_.find(at);
    if (found == chunks_.end()) {
      found = chunks_
                  .emplace(at, in_cheapest_order(
                                   generator_->generate(origin_of(at, kEdge), Extent::cube(kEdge))))
                  .first;
    }
    return &found->second;
  }
  std::int32_t surface_y(std::int32_t x, std::int32_t z) const {
    return generator_->surface_y(x, z);
  }

 private:
  std::unique_ptr<Generator> generator_;
  mutable std::map<ChunkCoord, RunChunk> chunks_;
};

}  // namespace

TEST_CASE("the time of a frame of a walking player", "[.time]") {
  const TerrainSpace space;
  const BodyMaterials materials = body_materials(default_material_table());
  constexpr double kFrameS = 1.0 / 60;
  constexpr int kFrames = 6000;
  // The first round generates the chunks on the way, and the second one is measured.
  for (const bool is_measured : {false, true}) {
    Walker walker;
    walker.place({0.5, static_cast<double>(space.surface_y(0, 0)), 0.5});
    std::vector<double> us;
    for (int i = 0; i < kFrames; ++i) {
      WalkInput input;
      input.x = 0.8;
      input.z = 0.6;
      input.up = i % 20 == 0;
      input.fast = i % 600 < 300;
      const std::int64_t begun_ns = thread_cpu_ns();
      walker.advance(space, materials, input, kFrameS);
      us.push_back(static_cast<double>(thread_cpu_ns() - begun_ns) / 1e3);
    }
    if (!is_measured) continue;
    REQUIRE(walker.feet().x > 100);
    std::sort(us.begin(), us.end());
    std::printf("frame of a walking player: p50 %.1f us, p99 %.1f us, max %.1f us; walked %.0f\n",
                us[us.size() / 2], us[us.size() * 99 / 100], us.back(), walker.feet().x);
  }
}

}  // namespace runstone::test
