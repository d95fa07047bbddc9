// Previews on the world strand: who gets them, what is dropped, and what a flood costs.
#include "server/world/people/previews.hpp"

#include "tests/unit/server/world/world_bench.hpp"

namespace runstone::test::preview_handlers_test {
namespace {

struct PreviewBench : WorldBench {
  explicit PreviewBench(WorldConfig c = config()) : WorldBench(std::move(c)) {}
  /// Joins with these features, and sees five chunks around one.
  void enter(SessionId session, std::uint64_t features = kFeaturePreviews, ChunkCoord at = {}) {
    join(session, static_cast<std::uint8_t>(session), session, {}, features);
    view(session, View{1, at, 1, 0});
  }
  void share(SessionId session, std::vector<EditDescriptor> edits) {
    server.received(session, PreviewShare{std::move(edits)}, now());
  }
  std::vector<PlayerPreview> previews(SessionId session) const {
    return environment.messages<PlayerPreview>(session, kEdge);
  }
};

EditDescriptor box_at(std::int32_t x, Material material = 1) {
  return {FillBox{{{x, 0, 0}, {x + 3, 3, 3}}}, {}, material};
}

}  // namespace

TEST_CASE("those who see the place get a preview, and learn when it is gone", "[world]") {
  PreviewBench bench;
  for (const SessionId session : {1U, 2U}) bench.enter(session);
  bench.enter(3, kFeaturePreviews, {40, 0, 0});  // far away
  bench.enter(4, 0);                             // without the feature
  const std::size_t records = bench.environment.records.size();
  bench.share(1, {box_at(4), box_at(8, kEmpty)});
  REQUIRE(bench.previews(2).size() == 1);
  CHECK(bench.previews(2)[0].edits == std::vector{box_at(4), box_at(8, kEmpty)});
  CHECK(bench.previews(2)[0].author != 0);
  CHECK(bench.previews(1).empty());
  CHECK(bench.previews(3).empty());
  CHECK(bench.previews(4).empty());
  bench.share(1, {});
  REQUIRE(bench.previews(2).size() == 2);
  CHECK(bench.previews(2)[1] == PlayerPreview{bench.previews(2)[0].author, {}});
  bench.share(1, {});
  CHECK(bench.previews(2).size() == 2);  // nobody shows one any more
  bench.tick();
  CHECK(bench.environment.records.size() == records);
  CHECK(bench.server.order().head() == 0);
}

TEST_CASE("a preview in a place that only the sender or only the other sees goes to nobody",
          "[world]") {
  PreviewBench bench;
  bench.enter(1);
  bench.enter(2, kFeaturePreviews, {2, 0, 0});  // shares the chunk (1, 0, 0)
  bench.share(1, {box_at(-10)});
  bench.share(1, {box_at(16 * 3)});
  CHECK(bench.previews(2).empty());
  bench.share(1, {box_at(17)});
  CHECK(bench.previews(2).size() == 1);
  bench.share(1, {box_at(-10)});  // moved out of sight
  REQUIRE(bench.previews(2).size() == 2);
  CHECK(bench.previews(2)[1].edits.empty());
}

TEST_CASE("a preview that could be no edit is passed on as none", "[world]") {
  WorldConfig c = config();
  c.reach_max = 30;
  PreviewBench bench(std::move(c));
  bench.enter(1);
  bench.enter(2);
  bench.share(1, {box_at(4)});
  REQUIRE(bench.previews(2).size() == 1);
  EditDescriptor wrong = box_at(4);
  SECTION("an unknown material") { wrong.material = 999; }
  SECTION("out of reach") { wrong = {FillSphere{{100, 0, 0}, 1}, {}, 1}; }
  SECTION("above the world") { wrong = {SetVoxel{{1, 1'000'000, 1}}, {}, 1}; }
  SECTION("too many chunks") { wrong = {FillBox{{{0, 0, 0}, {1000, 1, 1000}}}, {}, 1}; }
  bench.share(1, {wrong});
  REQUIRE(bench.previews(2).size() == 2);
  CHECK(bench.previews(2)[1].edits.empty());
  CHECK(bench.environment.charged[1] >= 4'096);
}

TEST_CASE("a stroke goes to those who take strokes, and the others get its edits", "[world]") {
  WorldConfig c = config();
  c.reach_max = 30;
  PreviewBench bench(std::move(c));
  bench.enter(1, kFeaturePreviews | kFeatureStrokes);
  bench.enter(2, kFeaturePreviews | kFeatureStrokes);
  bench.enter(3);
  BrushStroke stroke;
  stroke.size = 8;
  stroke.places = {{4, 0, 0}, {9, 1, 3}};
  const auto share = [&] {
    bench.server.received(1, PreviewShare{{box_at(4)}, stroke}, bench.now());
  };
  share();
  REQUIRE(bench.previews(2).size() == 1);
  CHECK(bench.previews(2)[0].stroke == stroke);
  CHECK(bench.previews(2)[0].edits == std::vector{box_at(4)});
  REQUIRE(bench.previews(3).size() == 1);
  CHECK_FALSE(bench.previews(3)[0].stroke);
  CHECK(bench.previews(3)[0].edits == std::vector{box_at(4)});
  SECTION("out of reach") { stroke.places.push_back({100, 0, 0}); }
  SECTION("an unknown material") { stroke.material = 999; }
  SECTION("too much work") { stroke.places.assign(256, {4, 0, 0}), stroke.size = 128; }
  share();
  REQUIRE(bench.previews(2).size() == 2);
  CHECK_FALSE(bench.previews(2)[1].stroke);
  CHECK(bench.environment.charged[1] >= 4'096);
}

TEST_CASE("a flood of previews is dropped and charged to its sender", "[world]") {
  PreviewBench bench;
  bench.enter(1);
  bench.enter(2);
  for (std::int32_t i = 0; i < 200; ++i) bench.share(1, {box_at(i % 8)});
  CHECK(bench.previews(2).size() <= kPreviewBurst);
  CHECK(bench.environment.charged[1] >= 100 * 4'096);
  CHECK(bench.environment.closed.empty());
  const std::size_t before = bench.previews(2).size();
  bench.time_us += 1'000'000;
  bench.share(1, {box_at(2)});
  CHECK(bench.previews(2).size() == before + 1);
}

TEST_CASE("one who is behind misses previews, and gets few a second from all together", "[world]") {
  PreviewBench bench;
  for (SessionId session = 1; session <= 60; ++session) bench.enter(session);
  bench.environment.full.insert(2);
  for (SessionId session = 3; session <= 60; ++session) bench.share(session, {box_at(3)});
  CHECK(bench.previews(2).empty());
  CHECK(bench.previews(1).size() <= kPreviewsReadBurst);
  CHECK_FALSE(bench.previews(1).empty());
  std::size_t of_one = 0;
  for (SessionId session = 1; session <= 60; ++session) {
    for (const PlayerPreview& preview : bench.previews(session))
      of_one += preview.author == bench.previews(1)[0].author ? 1 : 0;
  }
  CHECK(of_one <= kPreviewReadersMax);
}

TEST_CASE("one who gets too many previews keeps the last one of a player", "[world]") {
  PreviewBench bench;
  for (SessionId session = 1; session <= 42; ++session) bench.enter(session);
  bench.share(2, {box_at(3)});
  REQUIRE(bench.previews(1).size() == 1);
  const AuthorId author = bench.previews(1)[0].author;
  for (SessionId session = 3; session <= 42; ++session) bench.share(session, {box_at(3)});
  const std::size_t before = bench.previews(1).size();
  CHECK(before == kPreviewsReadBurst);
  bench.share(2, {box_at(5)});
  CHECK(bench.previews(1).size() == before);  // neither the new one nor "none"
  bench.share(2, {});
  REQUIRE(bench.previews(1).size() == before + 1);
  CHECK(bench.previews(1).back() == PlayerPreview{author, {}});
}

}  // namespace runstone::test::preview_handlers_test
