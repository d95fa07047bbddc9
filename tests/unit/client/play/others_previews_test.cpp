#include "client/play/others_previews.hpp"

#include "client/render/author_rgb.hpp"
#include "client/tools/ground_stroke.hpp"
#include "common/mesh_materials/mesh_materials_of.hpp"
#include "tests/unit/client/tools/tool_bench.hpp"

namespace runstone {
namespace {

using Shared = std::map<AuthorId, SharedPreviews::Shared>;

SharedPreviews::Shared box_of(std::int32_t x, Material material = 2) {
  return {{{FillBox{{{x, -1, 0}, {x + 2, 1, 2}}}, {}, material}}, 0};
}

struct OthersBench : test::ToolBench {
  OthersBench() {
    show_flat();
    others.set_materials(default_material_table(), mesh_materials_of(default_material_table()));
  }
  /// Makes the ghosts of all previews. Returns the number of calls in which they changed.
  int settle(const Shared& shared) {
    int changes = 0;
    for (int i = 0; i < 100; ++i) changes += others.step(replica, shared) ? 1 : 0;
    return changes;
  }
  std::vector<GhostChunk> ghosts() const {
    std::vector<GhostChunk> out;
    others.append_ghosts(out);
    return out;
  }
  OthersPreviews others;
};

/// Returns the ghosts by chunk, with the tints of players removed.
std::vector<GhostChunk> untinted(std::vector<GhostChunk> ghosts) {
  for (GhostChunk& ghost : ghosts) ghost.tint.reset();
  return ghosts;
}

/// Fails unless two lists of ghosts have the same quads of the same voxels.
void require_equal(const std::vector<GhostChunk>& a, const std::vector<GhostChunk>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    REQUIRE(a[i].key == b[i].key);
    REQUIRE(a[i].shift == b[i].shift);
    for (const auto part : {&GhostChunk::placed, &GhostChunk::removed}) {
      REQUIRE((a[i].*part == nullptr) == (b[i].*part == nullptr));
      if (a[i].*part != nullptr) {
        REQUIRE((a[i].*part)->opaque.quads == (b[i].*part)->opaque.quads);
        REQUIRE((a[i].*part)->transparent.quads == (b[i].*part)->transparent.quads);
      }
    }
  }
}

}  // namespace

TEST_CASE_METHOD(OthersBench, "the ghost of another player's stroke is that player's own preview",
                 "[client_app]") {
  show_random();
  box.set_materials(default_material_table());
  const char* const tool = GENERATE("terrain", "path");
  REQUIRE(box.choose(tool));
  for (const std::int32_t mode : {0, 2, 3, 4}) {
    if (box.tool().name() == "terrain") {
      REQUIRE(box.set_parameter("mode", mode));
      REQUIRE(box.set_parameter("radius", 7));
      REQUIRE(box.set_text("material", "70% stone, 30% dirt"));
    }
    const auto place = [&](std::int32_t x, std::int32_t z) {
      VoxelPos voxel{x, 2 * kEdge - 1, z};
      while (voxel.y > -2 * kEdge && at(voxel) == kEmpty) --voxel.y;
      return aim_at(voxel, Direction::pos_y);
    };
    REQUIRE(box.press(replica, place(-9, 2), ToolButton::place));
    for (std::int32_t x = -8; x < 9; x += 3) box.drag(place(x, 2 + x / 2));
    const Aim last = place(9, 3);
    for (int i = 0; i < 40; ++i) static_cast<void>(box.step_preview(replica, last, 10'000));
    const auto stroke = box.next_stroke(last);
    REQUIRE(stroke);
    REQUIRE(check_stroke(*stroke));
    const auto sent = decode_stroke(encode_stroke(*stroke));
    REQUIRE(sent);
    settle({{7, {box_of(0).edits, 0, *sent}}});
    if (mode == 0) CHECK_FALSE(box.ghosts().empty());
    require_equal(untinted(ghosts()), box.ghosts());
    box.cancel();
  }
}

TEST_CASE_METHOD(OthersBench, "a stroke follows the ground, and its edits stand in for it",
                 "[client_app]") {
  BrushStroke stroke;
  stroke.size = 5;
  stroke.strength = 3;
  stroke.places = {{0, -1, 0}, {4, -1, 2}};
  const Shared shared = {{7, {box_of(3).edits, 0, stroke}}};
  CHECK(settle(shared) == 1);
  const auto before = ghosts();
  CHECK_FALSE(before.empty());
  predict({{FillBox{{{-1, 0, -1}, {6, 2, 4}}}, {}, 1}});
  CHECK(settle(shared) == 1);
  BrushStroke far = stroke;
  far.places = {{9'000, 0, 0}};  // its ground is not shown
  settle({{7, {box_of(3).edits, 0, far}}});
  const auto stood_in = ghosts();
  settle({{7, box_of(3)}});
  require_equal(stood_in, ghosts());
}

TEST_CASE_METHOD(OthersBench, "a stroke whose mix is too much work has the ghost of its edits",
                 "[client_app]") {
  BrushStroke stroke;
  stroke.size = 5;
  stroke.strength = 3;
  stroke.mix = "70% stone, 30% dirt";
  stroke.places = {{0, -1, 0}, {4, -1, 2}};
  const MaterialTable table = default_material_table();
  UprightChunks upright{1'000'000};
  CHECK(edits_of_stroke(stroke, replica, table, upright, OthersPreviews::kPatternWorkMax));
  CHECK_FALSE(edits_of_stroke(stroke, replica, table, upright, stroke.mix.size()));
  stroke.mix.clear();
  stroke.material = 1;
  CHECK(edits_of_stroke(stroke, replica, table, upright, 0));
}

TEST_CASE_METHOD(OthersBench, "the previews of others are ghosts in the colours of the players",
                 "[client_app]") {
  CHECK(settle({{7, box_of(3)}, {9, box_of(8, kEmpty)}}) == 2);
  bool has_placed = false, has_removed = false;
  for (const GhostChunk& ghost : ghosts()) {
    REQUIRE(ghost.tint.has_value());
    const bool is_of_7 = ghost.tint == author_rgb(7);
    CHECK((is_of_7 || ghost.tint == author_rgb(9)));
    has_placed = has_placed || (is_of_7 && ghost.placed);
    has_removed = has_removed || (!is_of_7 && ghost.removed);
  }
  CHECK(has_placed);
  CHECK(has_removed);
  std::vector<Marker> outlines;
  others.append_outlines(outlines);
  REQUIRE(outlines.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto rgb = author_rgb(i == 0 ? 7 : 9);
    CHECK(std::array{outlines[i].r, outlines[i].g, outlines[i].b} == rgb);
    CHECK(outlines[i].x == Approx(i == 0 ? 3 : 8).margin(0.1));
    CHECK(outlines[i].size_x == Approx(2).margin(0.1));
  }
  CHECK(settle({{7, box_of(3)}, {9, box_of(8, kEmpty)}}) == 0);
  CHECK(settle({{7, box_of(3)}}) == 1);
  for (const GhostChunk& ghost : ghosts()) CHECK(ghost.tint == author_rgb(7));
  CHECK(others.clear());
  CHECK(ghosts().empty());
  CHECK_FALSE(others.clear());
}

TEST_CASE_METHOD(OthersBench, "a preview of another player follows the world", "[client_app]") {
  const Shared shared = {{7, box_of(3)}};
  settle(shared);
  predict(shared.at(7).edits);
  CHECK(settle(shared) == 1);
  CHECK(ghosts().empty());
}

TEST_CASE_METHOD(OthersBench, "few previews are shown, and each step makes a bounded part of them",
                 "[client_app]") {
  Shared shared;
  for (AuthorId author = 1; author <= 50; ++author)
    shared[author] = {{{FillSphere{{0, 0, 0}, 24}, {}, Material{3}}}, 0};
  int steps = 0;
  while (ghosts().empty()) {
    static_cast<void>(others.step(replica, shared));
    REQUIRE(++steps < 1'000);
  }
  CHECK(steps > 3);  // the sphere touches 64 chunks, which are compared and then meshed
  settle(shared);
  std::vector<std::array<std::uint8_t, 3>> tints;
  for (const GhostChunk& ghost : ghosts()) tints.push_back(*ghost.tint);
  std::sort(tints.begin(), tints.end());
  tints.erase(std::unique(tints.begin(), tints.end()), tints.end());
  CHECK(tints.size() == OthersPreviews::kShownMax);
}

}  // namespace runstone
