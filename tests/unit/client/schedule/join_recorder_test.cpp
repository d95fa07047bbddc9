#include "client/schedule/join_recorder.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

constexpr View kView{1, {10, 0, -10}, 4, 1};  // 49 columns of 3; the near ones are 29 of 3

std::vector<ChunkKey> keys_of(const View& view) {
  std::vector<ChunkKey> out;
  for (int x = -20; x <= 20; ++x) {
    for (int y = -20; y <= 20; ++y) {
      for (int z = -20; z <= 20; ++z) {
        const ChunkCoord at{view.centre.x + x, view.centre.y + y, view.centre.z + z};
        if (view.contains(at)) out.push_back({0, at});
      }
    }
  }
  return out;
}

}  // namespace

TEST_CASE("a join reports when four fifths and all of the first view are meshed", "[join]") {
  JoinRecorder join;
  CHECK_FALSE(join.is_open());
  join.done({0, kView.centre}, 5);  // before begin(): ignored
  join.begin(kView, 1000);
  REQUIRE(join.is_open());
  const std::vector<ChunkKey> keys = keys_of(kView);
  CHECK(join.report().view.chunks == keys.size());
  CHECK(join.report().view.chunks == 147);
  CHECK(join.report().near.chunks == 87);
  TimeUs at_us = 1000;
  for (const ChunkKey& key : keys) {
    at_us += 10;
    join.done(key, at_us);
    join.done(key, at_us + 5);                   // again, after an edit
    join.done({0, {key.at.x, 9, key.at.z}}, 1);  // outside
  }
  CHECK_FALSE(join.is_open());
  const JoinReport& report = join.report();
  CHECK(report.view.done == 147);
  CHECK(report.near.done == 87);
  CHECK(report.view.first_us == 10);
  CHECK(report.view.most_us == 1180);  // 118 of 147
  CHECK(report.view.all_us == 1470);
  CHECK(report.near.most_us < report.near.all_us);
  CHECK(report.near.all_us < 1470);
}

TEST_CASE("an unfinished join reports how far it came, and a later view changes nothing",
          "[join]") {
  JoinRecorder join;
  join.begin(kView, 0);
  join.begin({1, {0, 0, 0}, 1, 0}, 50);
  join.done({0, kView.centre}, 70);
  join.done({0, {0, 0, 0}}, 80);
  CHECK(join.report().view.done == 1);
  CHECK(join.report().near.done == 1);
  CHECK(join.report().near.first_us == 70);
  CHECK_FALSE(join.report().near.most_us);
  CHECK_FALSE(join.report().view.all_us);
}
