#include "client/tools/edit_preview.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <map>
#include <set>
#include <tuple>
#include <vector>

#include "client/tools/shown_voxels.hpp"
#include "tests/unit/client/tools/tool_bench.hpp"

namespace runstone::test {
namespace {

using UnitFace = std::tuple<VoxelPos, Direction, Material>;
using Voxels = std::map<VoxelPos, Material>;

constexpr std::int32_t kLow = -2 * ToolBench::kEdge, kEnd = 2 * ToolBench::kEdge;

/// Returns the faces of one voxel each that the quads of a mesh cover.
void add_faces(const GhostChunk& ghost, const ChunkMesh* mesh, std::set<UnitFace>& out) {
  if (mesh == nullptr) return;
  const VoxelPos origin = origin_of(ghost.key.at, ghost.edge);
  for (const QuadLayers* pass : {&mesh->opaque, &mesh->transparent}) {
    for (const Quad quad : pass->quads) {
      const QuadFields q = unpack(quad);
      const Axis axis = axis_of(q.direction);
      for (int u = 0; u < q.width; ++u) {
        for (int v = 0; v < q.height; ++v) {
          std::array<std::int32_t, 3> at = {origin.x + q.x, origin.y + q.y, origin.z + q.z};
          at[static_cast<std::size_t>(u_axis_of(axis))] += u;
          at[static_cast<std::size_t>(v_axis_of(axis))] += v;
          if (!out.insert({{at[0], at[1], at[2]}, q.direction, q.material}).second)
            FAIL_CHECK("two quads cover one face");
        }
      }
    }
  }
}

std::set<UnitFace> faces_of(const EditPreview& preview, bool of_placed) {
  std::set<UnitFace> out;
  for (const GhostChunk& ghost : preview.ghosts())
    add_faces(ghost, of_placed ? ghost.placed.get() : ghost.removed.get(), out);
  return out;
}

/// Returns the faces between these opaque voxels and all others.
std::set<UnitFace> faces_of(const Voxels& voxels) {
  std::set<UnitFace> out;
  for (const auto& [at, material] : voxels) {
    for (int d = 0; d < kDirectionCount; ++d) {
      const auto side = static_cast<Direction>(d);
      if (voxels.count(moved(at, side, 1)) == 0) out.insert({at, side, material});
    }
  }
  return out;
}

/// Returns all voxels by z, y and x.
std::vector<Material> read_all(const ToolBench& bench) {
  std::vector<Material> out;
  ShownVoxels voxels(bench.replica);
  for (VoxelPos p{0, 0, kLow}; p.z < kEnd; ++p.z) {
    for (p.y = kLow; p.y < kEnd; ++p.y) {
      for (p.x = kLow; p.x < kEnd; ++p.x) out.push_back(voxels.at(p).value());
    }
  }
  return out;
}

/// Makes the preview of the next click, some chunks at a time. That of a costly tool begins when
/// the aim has rested.
void finish_preview(ToolBench& bench, const Aim& aim) {
  const unsigned rest = bench.box.tool().is_costly() ? ToolBox::kRestCalls : 0;
  for (unsigned turn = 0; turn < 1000; ++turn) {
    bench.box.step_preview(bench.replica, aim, 3);
    if (turn >= rest && bench.box.preview().is_complete()) return;
  }
  FAIL("the preview does not end");
}

/// Checks that the ghosts are the differences between two states of the shown voxels.
void check_ghosts(const EditPreview& preview, const std::vector<Material>& before,
                  const std::vector<Material>& after) {
  constexpr std::int32_t kSide = kEnd - kLow;
  Voxels placed, removed;
  for (std::int32_t i = 0; i < kSide * kSide * kSide; ++i) {
    const Material was = before[static_cast<std::size_t>(i)];
    const Material is = after[static_cast<std::size_t>(i)];
    if (is == was) continue;
    const VoxelPos at{kLow + i % kSide, kLow + i / kSide % kSide, kLow + i / kSide / kSide};
    (is == kEmpty ? removed : placed)[at] = is == kEmpty ? was : is;
  }
  CHECK(preview.placed_voxels() == placed.size());
  CHECK(preview.removed_voxels() == removed.size());
  CHECK(faces_of(preview, true) == faces_of(placed));
  CHECK(faces_of(preview, false) == faces_of(removed));
}

}  // namespace

TEST_CASE("a preview shows exactly the voxels that the edit changes", "[tools][property]") {
  ToolBench bench;
  bench.show_random();
  bench.box.select(VoxelBox{{-9, -7, -5}, {8, 9, 4}});
  REQUIRE(bench.box.copy(bench.replica, true));
  SplitMix64& rng = bench.rng;
  std::size_t changed = 0;
  for (int round = 0; round < 100; ++round) {
    const auto& tools = bench.box.tools();
    const Tool& tool = *tools[static_cast<std::size_t>(round) % tools.size()];
    if (tool.selects()) continue;
    REQUIRE(bench.box.choose(tool.name()));
    for (const ToolParameter& p : tool.parameters()) {
      const std::int32_t high = std::min(p.high, p.low + 6);
      REQUIRE(bench.box.set_parameter(p.name, rng.between(p.low, high)));
    }
    for (const ToolText& text : tool.texts()) {
      if (text.kind == ToolText::Kind::plain) continue;
      const bool is_given = text.kind == ToolText::Kind::pattern || rng.below(2) == 0;
      const char* const typed = text.kind == ToolText::Kind::filter    ? "not noise 20%"
                                : text.kind == ToolText::Kind::pattern ? "air where not noise 20%"
                                                                       : "air";
      REQUIRE(bench.box.set_text(text.name, is_given ? typed : ""));
    }
    bench.box.set_symmetry(
        {static_cast<SymmetryKind>(rng.between(0, 4)), rng.between(-9, 9), rng.between(-9, 9)});
    REQUIRE(bench.box.rotate(rng.between(0, 3)));
    if (rng.between(0, 1) == 0) REQUIRE(bench.box.mirror(Axis::x));
    const auto place = [&] { return rng.between(-12, 11); };
    const auto aim = [&] {
      return bench.aim_at({place(), place(), place()}, static_cast<Direction>(rng.between(0, 5)),
                          static_cast<Material>(rng.between(1, 3)));
    };
    CAPTURE(round, tool.name());
    const ToolButton button =
        rng.between(0, 2) == 0 && tool.points_before() != 0 ? ToolButton::clear : ToolButton::place;
    for (std::size_t i = 0; i < tool.points_before(); ++i)
      REQUIRE(bench.box.press(bench.replica, aim(), button)->empty());
    Aim last = aim();
    if (tool.is_drawn()) {
      REQUIRE(bench.box.press(bench.replica, last, button)->empty());
      for (int i = 0; i < 3; ++i) {
        last = aim();
        bench.box.drag(last);
      }
    }
    // The second click on a corner completes a tool with any number of corners.
    if (!tool.is_drawn() && tool.points_before_max() != tool.points_before())
      REQUIRE(bench.box.press(bench.replica, last, button)->empty());
    finish_preview(bench, last);
    const auto edits = tool.is_drawn() ? bench.box.release(bench.replica, last)
                                       : bench.box.press(bench.replica, last, button);
    const std::vector<Material> before = read_all(bench);
    if (edits) bench.predict(*edits);
    const std::vector<Material> after = read_all(bench);
    if (after != before) ++changed;
    check_ghosts(bench.box.preview(), before, after);
    CHECK(edits.has_value() == bench.box.preview_refusal().empty());
  }
  CHECK(changed > 30);
}

TEST_CASE("a preview follows changes of the chunks below it", "[tools]") {
  ToolBench bench;
  bench.show_flat();
  REQUIRE(bench.box.choose("box"));
  const Aim aim = bench.aim_at({3, -1, 3}, Direction::pos_y);
  finish_preview(bench, aim);
  CHECK(bench.box.preview().placed_voxels() == 1);
  CHECK_FALSE(bench.box.step_preview(bench.replica, aim, 64));
  bench.predict({{SetVoxel{{3, 0, 3}}, {}, 2}});  // another edit sets the same voxel
  CHECK(bench.box.step_preview(bench.replica, aim, 64));
  CHECK(bench.box.preview().placed_voxels() == 0);
  CHECK(bench.box.preview().ghosts().empty());
}

TEST_CASE("the chunks that are not here are counted and have no ghost", "[tools]") {
  ToolBench bench;
  bench.show({0, 0, 0}, uniform_chunk(Extent::cube(ToolBench::kEdge), 1));
  EditPreview preview;
  preview.set({{FillBox{{{-4, 2, 2}, {4, 3, 3}}}, {}, kEmpty}});
  CHECK(preview.step(bench.replica, 64));
  CHECK(preview.missing_chunks() == 1);
  CHECK(preview.removed_voxels() == 4);
  REQUIRE(preview.ghosts().size() == 1);
  CHECK(preview.ghosts()[0].key == ChunkKey{0, {0, 0, 0}});
  CHECK(preview.ghosts()[0].placed == nullptr);
}

TEST_CASE("a large preview is made in parts, and the ghosts before stay until it is complete",
          "[tools]") {
  ToolBench bench;
  bench.show_flat();
  EditPreview preview;
  preview.set({{SetVoxel{{0, 0, 0}}, {}, 2}});
  CHECK(preview.step(bench.replica, 64));
  CHECK(preview.placed_voxels() == 1);
  preview.set({{FillBox{{{-30, 0, -30}, {30, 4, 30}}}, {}, 2}});  // 16 chunks
  int turns = 1;
  for (; !preview.step(bench.replica, 8); ++turns) {
    CHECK(preview.placed_voxels() == 1);
    REQUIRE(turns < 20);
  }
  CHECK(turns >= 4);
  CHECK(preview.placed_voxels() == 60 * 60 * 4);
}

}  // namespace runstone::test
