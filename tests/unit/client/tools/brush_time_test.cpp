// Measurements that a person starts: unit_client_tools "[.time]". They print microseconds of
// processor time of the thread and bytes, and check no bound, because another machine has other
// times.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "client/tools/action_source.hpp"
#include "client/tools/tool_box.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/generate/generator.hpp"
#include "common/materials/material_table.hpp"
#include "common/os/thread_cpu_ns.hpp"
#include "common/runs/reorder.hpp"
#include "tests/support/codec/chunks_message.hpp"

namespace runstone::test {
namespace {

constexpr std::int32_t kBrushEdge = 32;
constexpr std::int32_t kBrushReach = 4;  // chunks along x and z
constexpr std::int32_t kBrushLow = -4, kBrushHigh = 4;

/// Terrain of 256 x 256 x 256 voxels, in the cheapest axis orders, and a tool box over it.
struct BrushTimes {
  BrushTimes() {
    replica.set_view({1, {0, 0, 0}, 7, 7});
    static_cast<void>(replica.open({kBrushEdge, 5, 77, 3, 0, 0, 0}));
    const auto made = make_generator({"terrain", 1, 7, ""}, default_material_table());
    REQUIRE(made);
    for (std::int32_t x = -kBrushReach; x < kBrushReach; ++x) {
      for (std::int32_t y = kBrushLow; y < kBrushHigh; ++y) {
        for (std::int32_t z = -kBrushReach; z < kBrushReach; ++z) {
          ChunkSnapshot snapshot;
          snapshot.key = {0, {x, y, z}};
          snapshot.chunk.voxels = in_cheapest_order(
              (*made)->generate(origin_of({x, y, z}, kBrushEdge), Extent::cube(kBrushEdge)));
          snapshot.chunk.digest = digest_of(snapshot.chunk.voxels);
          replica.receive(chunks_of(std::move(snapshot)), {1000, 1100, 1200});
        }
      }
    }
    box.set_materials(default_material_table());
  }
  /// Returns the highest solid voxel of a column.
  VoxelPos ground(std::int32_t x, std::int32_t z) const {
    VoxelPos at{x, kBrushHigh * kBrushEdge - 1, z};
    while (at.y > kBrushLow * kBrushEdge && replica.shown_at(at).value_or(kEmpty) == kEmpty) --at.y;
    return at;
  }
  Aim aim_at(VoxelPos voxel) const {
    Aim aim;
    aim.eye = {voxel.x + 0.5, voxel.y + 20.5, voxel.z + 0.5};
    aim.look = {0, -1, 0};
    aim.held = *default_material_table().find("stone");
    aim.hit = RayHit{voxel, replica.shown_at(voxel).value_or(kEmpty), Direction::pos_y, 20};
    return aim;
  }
  Replica replica;
  ToolBox box;
};

void print_line(const std::string& name, std::vector<double> us) {
  std::sort(us.begin(), us.end());
  std::printf("%-52s p50 %8.0f us  max %8.0f us  n %zu\n", name.c_str(), us[us.size() / 2],
              us.back(), us.size());
}

template <class F>
double us_of(F&& f) {
  const std::int64_t begun_ns = thread_cpu_ns();
  f();
  return static_cast<double>(thread_cpu_ns() - begun_ns) / 1e3;
}

/// Takes all edits of an action, and adds up their bytes. Returns the longest turn.
double take_all(const ToolAction& action, const EditLimits& limits, std::size_t& bytes,
                std::size_t& edits) {
  const auto source = source_of(action, limits);
  double longest = 0;
  for (bool is_done = false; !is_done;) {
    longest = std::max(longest, us_of([&] {
                         const SourceStep step = source->next();
                         is_done = step.kind == SourceStep::Kind::end ||
                                   step.kind == SourceStep::Kind::failed;
                         if (step.kind != SourceStep::Kind::edit) return;
                         ++edits;
                         bytes += encode(step.edit).size();
                       }));
  }
  return longest;
}

}  // namespace

TEST_CASE("the time of a brush of radius 32 that is dragged for ten seconds", "[.time]") {
  BrushTimes bench;
  for (const auto& [mode, name] : {std::pair{0, "raise"}, {2, "smooth"}, {3, "erode"}}) {
    REQUIRE(bench.box.choose("terrain"));
    REQUIRE(bench.box.set_parameter("radius", 32));
    REQUIRE(bench.box.set_parameter("mode", mode));
    std::vector<double> previews;
    REQUIRE(bench.box.press(bench.replica, bench.aim_at(bench.ground(-80, 0)), ToolButton::place));
    Aim last;
    // 200 places in ten seconds, along a curve of 160 voxels.
    for (int i = 1; i <= 200; ++i) {
      last = bench.aim_at(
          bench.ground(-80 + i * 4 / 5, static_cast<std::int32_t>(30 * std::sin(i * 0.04))));
      bench.box.drag(last);
      if (i % 20 != 0) continue;
      previews.push_back(us_of([&] {
        // A costly preview waits for a resting aim: those calls are part of it.
        for (unsigned k = 0; k < ToolBox::kRestCalls + 2; ++k)
          static_cast<void>(bench.box.step_preview(bench.replica, last, 10'000));
      }));
    }
    print_line(std::string("radius 32, ") + name + ": preview of the stroke so far", previews);
    ToolEdits made = failure(std::string());
    const double plan_us = us_of([&] { made = bench.box.release(bench.replica, last); });
    if (!made) {
      std::printf("  release: plan %.0f us; %s\n", plan_us, made.error().c_str());
      continue;
    }
    std::size_t bytes = 0, edits = 0;
    const double longest_us = take_all(*made, bench.replica.edit_limits(), bytes, edits);
    std::printf("  release: plan %.0f us, longest edit %.0f us; %zu edits, %zu bytes of log\n",
                plan_us, longest_us, edits, bytes);
  }
}

TEST_CASE("the time to smooth an area of 200 x 200", "[.time]") {
  BrushTimes bench;
  REQUIRE(bench.box.choose("terrain"));
  REQUIRE(bench.box.set_parameter("radius", 100));
  REQUIRE(bench.box.set_parameter("mode", 2));
  std::vector<double> previews, plans;
  for (int i = 0; i < 9; ++i) {
    const Aim aim = bench.aim_at(bench.ground(i - 7, 7 - i));
    previews.push_back(us_of([&] {
      for (unsigned k = 0; k < ToolBox::kRestCalls + 2; ++k)
        static_cast<void>(bench.box.step_preview(bench.replica, aim, 10'000));
    }));
    REQUIRE(bench.box.press(bench.replica, aim, ToolButton::place));
    std::size_t bytes = 0, edits = 0;
    plans.push_back(us_of([&] {
      const auto made = bench.box.release(bench.replica, aim);
      if (!made) FAIL(made.error());
      take_all(*made, bench.replica.edit_limits(), bytes, edits);
    }));
    if (i == 0) std::printf("smooth of 200 x 200: %zu edits, %zu bytes of log\n", edits, bytes);
  }
  print_line("smooth of 200 x 200: preview after the aim moved", previews);
  print_line("smooth of 200 x 200: plan and all edits", plans);
}

TEST_CASE("the time to replace by a mix in 200 x 200 x 200", "[.time]") {
  BrushTimes bench;
  REQUIRE(bench.box.choose("mix"));
  for (const char* pattern :
       {"70% stone, 20% gravel, 10% clay where solid", "noise 8: 60% stone, 40% gravel where solid",
        "stone where is dirt and exposed", "y 0..100: stone, gravel, grass where exposed"}) {
    REQUIRE(bench.box.set_text("pattern", pattern));
    std::vector<double> all, turns;
    std::size_t bytes = 0, edits = 0;
    for (int i = 0; i < 3; ++i) {
      bytes = edits = 0;
      bench.box.type_places(
          TypedPlaces{ToolButton::place, {{-100, -100, -100}, {99, 99, 99}}, Direction::pos_y});
      all.push_back(us_of([&] {
        const auto made = bench.box.apply_typed(bench.replica, 2);
        REQUIRE(made);
        turns.push_back(take_all(*made, bench.replica.edit_limits(), bytes, edits));
      }));
    }
    print_line(std::string("mix 200^3: ") + pattern, all);
    print_line("  longest turn", turns);
    std::printf("  %zu edits, %zu bytes of log\n", edits, bytes);
  }
}

}  // namespace runstone::test
