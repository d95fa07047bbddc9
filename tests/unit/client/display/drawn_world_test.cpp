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

/// Stone but for the voxel at (x, 5, 5).
RunChunk holed(unsigned x) {
  RunChunk chunk = stone();
  fill(chunk, x + kEdge * (5 + kEdge * 5), 1, kEmpty);
  return chunk;
}

class Drawn {
 public:
  explicit Drawn(unsigned workers = 0)
      : screen_(book_), world(screen_, kEdge, default_material_table(), workers) {}
  /// What the screen was told by a picture of now, sorted; without the frame itself.
  Lines draw() {
    const std::size_t before = book_.lines().size();
    world.draw(Camera{}, 64, 48);
    Lines lines = book_.lines();
    lines.erase(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(before));
    REQUIRE(!lines.empty());
    CHECK(lines.back() == "draw");
    lines.pop_back();
    std::sort(lines.begin(), lines.end());
    return lines;
  }

 private:
  test::FakeScreenBook book_;
  test::FakeScreen screen_;

 public:
  DrawnWorld world;
};

}  // namespace

TEST_CASE("a picture meshes what changed since the last one, with the neighbours that see it",
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
  drawn.world.put(at(1), holed(0));  // towards chunk 0, which shows a face there now
  CHECK(drawn.draw() == Lines{"upload 0 quads 6", "upload 1 quads 10"});
  CHECK(drawn.world.chunk_count() == 2);
}

TEST_CASE("a chunk that is forgotten leaves its neighbours open", "[client_app]") {
  Drawn drawn;
  for (int x = 0; x < 3; ++x) drawn.world.put(at(x), stone());
  drawn.draw();
  drawn.world.forget(at(1));
  drawn.world.forget(at(7));  // never held
  CHECK(drawn.draw() == Lines{"upload 0 quads 6", "upload 2 quads 6"});
  CHECK(drawn.world.chunk_count() == 2);
  // One that was to be meshed is not any more.
  drawn.world.put(at(9), stone());
  drawn.world.forget(at(9));
  CHECK(drawn.draw().empty());
}

TEST_CASE("mesh threads make the same picture", "[client_app]") {
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
