#include "client/tools/pasted_build.hpp"

#include <catch2/catch.hpp>
#include <vector>

#include "client/tools/tool_box.hpp"
#include "client/tools/tool_command.hpp"
#include "tests/unit/client/tools/tool_bench.hpp"

namespace runstone::test {
namespace {

/// A random world, and a clipboard of a part of it.
struct NudgeBench : ToolBench {
  NudgeBench() { show_random(); }
  void copy(bool is_solid) {
    box.select(VoxelBox{{-30, -30, -30}, {-24, -25, -27}});
    REQUIRE(box.copy(replica, is_solid));
    REQUIRE(box.choose("paste"));
  }
  ToolAction paste(VoxelPos voxel) {
    auto made = box.press(replica, aim_at(voxel, Direction::pos_y), ToolButton::place);
    REQUIRE(made);
    return *std::move(made);
  }
  std::vector<Material> around() const {
    std::vector<Material> out;
    for (VoxelPos v{0, 0, -20}; v.z < 20; ++v.z) {
      for (v.y = -20; v.y < 20; ++v.y) {
        for (v.x = -20; v.x < 20; ++v.x) out.push_back(at(v));
      }
    }
    return out;
  }
};

}  // namespace

TEST_CASE("a paste that is moved leaves the world of a paste at its last place",
          "[tools][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  for (int round = 0; round < 20; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    const bool is_solid = round % 2 == 0;
    const std::int32_t mask = rng.between(0, 3);
    // Two equal worlds: in one the paste is moved, in the other it is put down where it ends.
    std::vector<std::vector<Material>> worlds;
    VoxelPos place{rng.between(-5, 5), rng.between(-5, 5), rng.between(-5, 5)};
    for (const bool is_moved : {true, false}) {
      NudgeBench bench;
      bench.copy(is_solid);
      if (mask < static_cast<std::int32_t>(bench.box.tool().parameters()[0].choices.size()))
        REQUIRE(bench.box.set_parameter("mask", mask));
      const ToolAction made = bench.paste(place);
      CHECK(made.chain == ActionChain::begins);
      CHECK(part_of(made, 0) == ActionPart::first);
      bench.predict(made);
      for (int i = 0; is_moved && i < 6; ++i) {
        const auto direction = static_cast<Direction>(rng.below(kDirectionCount));
        place = moved(place, direction, 1);
        const auto step = carry_out(bench.box, bench.replica, 2, PasteNudge{direction});
        REQUIRE(step);
        for (std::size_t e = 0; e < step->edits.size(); ++e)
          CHECK(part_of(*step, e) == ActionPart::next);
        bench.predict(*step);
      }
      worlds.push_back(bench.around());
    }
    CHECK(worlds[0] == worlds[1]);
  }
}

TEST_CASE_METHOD(NudgeBench, "a voxel that somebody has changed since is not restored", "[tools]") {
  predict({{FillBox{{{-20, -20, -20}, {20, 20, 20}}}, {}, 1}});
  predict({{FillBox{{{-30, -30, -30}, {-24, -25, -27}}}, {}, 2}});
  copy(true);
  predict(paste({0, 0, 0}));
  const VoxelBox pasted{{-3, 1, -1}, {3, 6, 2}};
  REQUIRE(at(pasted.min) == 2);
  REQUIRE(at({2, 5, 1}) == 2);
  predict({{SetVoxel{pasted.min}, {}, 3}, {SetVoxel{{-3, 2, -1}}, {}, 3}});
  predict(box.nudge(replica, Direction::pos_x).value());
  CHECK(at(pasted.min) == 3);
  CHECK(at({-3, 2, -1}) == 3);
  CHECK(at({-3, 3, -1}) == 1);
  CHECK(at({3, 3, -1}) == 2);
}

TEST_CASE_METHOD(NudgeBench, "only the last paste is moved, until another action begins",
                 "[tools]") {
  const std::string none =
      "nothing that can be moved was just pasted (a paste of at most 262,144 voxels, not mirrored)";
  CHECK(box.nudge(replica, Direction::pos_x).error() == none);
  copy(true);
  predict(paste({0, 0, 0}));
  box.begin_action();  // that of the paste
  REQUIRE(box.nudge(replica, Direction::pos_x));
  box.begin_action();
  CHECK(box.nudge(replica, Direction::pos_x).error() == none);
}

TEST_CASE_METHOD(NudgeBench, "a paste with mirrored copies cannot be moved", "[tools]") {
  copy(true);
  for (const SymmetryKind kind :
       {SymmetryKind::x, SymmetryKind::z, SymmetryKind::both, SymmetryKind::point}) {
    CAPTURE(static_cast<int>(kind));
    box.set_symmetry({});
    CHECK(paste({6, 0, 9}).chain == ActionChain::begins);
    box.set_symmetry({kind, 0, 0});
    const ToolAction made = paste({6, 0, 9});
    CHECK(made.chain == ActionChain::closed);
    predict(made);
    const auto before = around();
    CHECK_FALSE(box.nudge(replica, Direction::pos_x));
    CHECK(around() == before);
  }
}

}  // namespace runstone::test
