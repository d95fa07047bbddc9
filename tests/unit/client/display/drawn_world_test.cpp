#include "client/display/drawn_world.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "common/materials/material_table.hpp"
#include "tests/unit/client/display/fake_screen.hpp"

namespace runstone {
namespace {

using Lines = std::vector<std::string>;

constexpr std::int32_t kEdge = 16;

ChunkKey at(std::int32_t x) { return {0, {x, 0, 0}}; }

RunChunk stone() { return uniform_chunk(Extent::cube(kEdge), 1); }

/// Returns a chunk of stone without the voxel at (x, 5, 5).
RunChunk holed(unsigned x) {
  RunChunk chunk = stone();
  fill(chunk, x + kEdge * (5 + kEdge * 5), 1, kEmpty);
  return chunk;
}

class Drawn {
 public:
  explicit Drawn(unsigned workers = 0)
      : screen_(log_), world(screen_, kEdge, default_material_table(), workers) {}
  /// Draws, and returns the sorted calls of the screen without the frame itself.
  Lines draw() {
    const std::size_t before = log_.lines().size();
    world.draw(Camera{}, 64, 48);
    Lines lines = log_.lines();
    lines.erase(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(before));
    REQUIRE(!lines.empty());
    CHECK(lines.back() == "draw");
    lines.pop_back();
    std::sort(lines.begin(), lines.end());
    return lines;
  }

 private:
  test::FakeScreenLog log_;
  test::FakeScreen screen_;

 public:
  DrawnWorld world;
};

}  // namespace

TEST_CASE(
    "a picture meshes the chunks that changed since the last one, "
    "and the neighbours that touch a change",
    "[client_app]") {
  Drawn drawn;
  CHECK(drawn.draw().empty());
  CHECK(drawn.world.put(at(0), stone()));
  CHECK(drawn.world.put(at(1), stone()));
  CHECK(drawn.draw() == Lines{"upload 0 quads 5", "upload 1 quads 5"});
  CHECK(drawn.draw().empty());
  drawn.world.put(at(1), stone());
  CHECK(drawn.draw().empty());
  drawn.world.put(at(1), holed(7));
  CHECK(drawn.draw() == Lines{"upload 1 quads 11"});
  drawn.world.put(at(1), holed(0));  // at the border to chunk 0, which now has a face there
  CHECK(drawn.draw() == Lines{"upload 0 quads 6", "upload 1 quads 10"});
  CHECK(drawn.world.chunk_count() == 2);
}

TEST_CASE("after a chunk is removed its neighbours have faces towards it", "[client_app]") {
  Drawn drawn;
  for (int x = 0; x < 3; ++x) drawn.world.put(at(x), stone());
  drawn.draw();
  drawn.world.forget(at(1));
  drawn.world.forget(at(7));  // never stored
  CHECK(drawn.draw() == Lines{"upload 0 quads 6", "upload 2 quads 6"});
  CHECK(drawn.world.chunk_count() == 2);
  // A removed chunk that waited for a mesh is not meshed.
  drawn.world.put(at(9), stone());
  drawn.world.forget(at(9));
  CHECK(drawn.draw().empty());
}

TEST_CASE("mesh threads upload the same meshes", "[client_app]") {
  Drawn alone, together(3);
  for (int x = 0; x < 200; ++x) {
    alone.world.put(at(x), holed(static_cast<unsigned>(x) % kEdge));
    together.world.put(at(x), holed(static_cast<unsigned>(x) % kEdge));
  }
  const Lines lines = alone.draw();
  CHECK(lines.size() == 200);
  CHECK(together.draw() == lines);
  CHECK(together.world.meshes() == 200);
  together.world.put(at(3), stone());
  alone.world.put(at(3), stone());
  CHECK(together.draw() == alone.draw());
}

}  // namespace runstone
