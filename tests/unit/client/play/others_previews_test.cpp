#include "client/play/others_previews.hpp"

#include "client/render/author_rgb.hpp"
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
    others.set_materials(mesh_materials_of(default_material_table()));
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

}  // namespace

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
