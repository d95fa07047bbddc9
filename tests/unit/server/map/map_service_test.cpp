#include "server/map/map_service.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <latch>
#include <string>
#include <vector>

#include "common/edits/descriptor/given_shapes.hpp"
#include "common/tiles/tile_rules.hpp"
#include "server/map/map_world.hpp"
#include "server/store/store.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/core/text_contains.hpp"
#include "tests/support/sql/crash_image.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

/// Makes a world that was killed, and the same world without its newest edits.
void make_partial_world(const std::string& whole, const std::string& part) {
  const std::string live = whole + "-live";
  const auto store = *create_world(live, sample_meta());
  REQUIRE(store->raise_epoch().has_value());
  SplitMix64 rng(1);
  const PlayerRow player = sample_player(1);
  REQUIRE(store->append({&player, 1}, sample_records(rng, store->epoch(), 1, 4)).has_value());
  copy_crash_image(live, whole);
  copy_crash_image(live, part);
  std::filesystem::remove(part + "/world.sqlite-wal");
}

/// Asks for the state of a map and returns the answer.
MapAnswer state_of(MapService& service) {
  std::latch is_done(1);
  MapAnswer answer;
  service.ask(MapStateRequest{}, "", [&](MapAnswer reply) {
    answer = std::move(reply);
    is_done.count_down();
  });
  is_done.wait();
  return answer;
}

}  // namespace

TEST_CASE("the map of a world that lacks edits says so to its host, once, and to those who look",
          "[map]") {
  const TempFolder folder;
  make_partial_world(folder / "whole", folder / "part");
  for (const char* name : {"whole", "part"}) {
    CAPTURE(name);
    const bool is_part = name == std::string("part");
    std::vector<std::string> warnings;  // the one thread of the maps writes them
    {
      MapThreads threads(1);
      MapService service(threads, folder / name, 1 << 20,
                         [&](const std::string& warning) { warnings.push_back(warning); });
      for (int i = 0; i < 2; ++i) {
        const MapAnswer answer = state_of(service);
        INFO(*answer.body);
        REQUIRE(answer.status == 200);
        CHECK(contains(*answer.body, is_part ? "\"lacks_edits\":true" : "\"lacks_edits\":false"));
        CHECK_FALSE(contains(*answer.body, folder.path()));
      }
    }
    REQUIRE(warnings.size() == (is_part ? 1 : 0));
    if (is_part) {
      CHECK(contains(warnings[0], "LOST: " + folder / "part/world.sqlite"));
      CHECK(contains(warnings[0], "The map shows what is left"));
    }
  }
}

TEST_CASE("a map that lacks edits looks again whether its host has put the world right", "[map]") {
  const TempFolder folder;
  make_partial_world(folder / "whole", folder / "part");
  MapCaches caches(1 << 20);
  MapWorld world(folder / "part", caches);
  REQUIRE(world.refresh(1, 0).has_value());
  REQUIRE(world.loss().has_value());
  {
    auto store = *open_world(folder / "part", StoreAccess::repair);
    REQUIRE(store->accept_losses().has_value());
    const auto epoch = store->raise_epoch();
    REQUIRE(epoch.has_value());
    SplitMix64 rng(2);
    const PlayerRow player = sample_player(1);
    REQUIRE(store->append({&player, 1}, sample_records(rng, *epoch, 1, 1)).has_value());
  }
  REQUIRE(world.refresh(MapWorld::kLossAgeUsMax + 1, 0).has_value());
  CHECK_FALSE(world.loss().has_value());
}

TEST_CASE("a full queue refuses at once, and a stop answers each request that waits", "[map]") {
  const TempFolder empty;
  std::latch is_begun(1), may_end(1);
  std::atomic<std::size_t> answers{0}, refusals{0};
  {
    MapThreads threads(1);
    MapService service(threads, empty.path(), 1 << 20, [](const std::string&) {});
    // This reply keeps the thread, so nothing leaves the queue.
    service.ask(RightsRequest{}, "", [&](const MapAnswer&) {
      is_begun.count_down();
      may_end.wait();
    });
    is_begun.wait();
    const auto count = [&](const MapAnswer& answer) {
      CHECK(answer.status == 503);
      ++answers;
    };
    for (std::size_t i = 0; i < MapService::kQueueMax; ++i) service.ask(RightsRequest{}, "", count);
    CHECK(answers == 0);
    service.ask(RightsRequest{}, "", [&](const MapAnswer& answer) {
      CHECK(answer.status == 503);
      CHECK(*answer.body == "the map has much to do: ask again in a moment\n");
      ++refusals;
    });
    CHECK(refusals == 1);
    may_end.count_down();
  }
  CHECK(answers == MapService::kQueueMax);
}

TEST_CASE("requests that draw nothing are answered before tiles, and do not starve them", "[map]") {
  const TempFolder empty;
  std::latch is_begun(1), may_end(1), is_done(4 + MapService::kQuickInRowMax + 1);
  std::string order;  // the one thread of the maps writes it
  MapThreads threads(1);
  MapService service(threads, empty.path(), 1 << 20, [](const std::string&) {});
  service.ask(RightsRequest{}, "", [&](const MapAnswer&) {
    is_begun.count_down();
    may_end.wait();
  });
  is_begun.wait();
  const auto note = [&](char what) {
    return [&, what](const MapAnswer&) {
      order += what;
      is_done.count_down();
    };
  };
  for (int i = 0; i < 3; ++i) service.ask(TilePictureRequest{}, "", note('t'));
  service.ask(MapStateRequest{}, "", note('s'));
  for (int i = 0; i <= MapService::kQuickInRowMax; ++i)
    service.ask(RecentEditsRequest{}, "", note('r'));
  may_end.count_down();
  is_done.wait();
  CHECK(order.starts_with("sr"));
  const std::size_t tile = order.find('t');
  CHECK(tile > 2);
  CHECK(tile < order.rfind('r'));  // it did not wait for all of them
  CHECK(order.ends_with("tt"));
}

TEST_CASE("the map is drawn again when materials get shapes", "[map][shapes]") {
  const TempFolder folder;
  const auto store = *create_world(folder / "w", sample_meta());
  REQUIRE(store->raise_epoch().has_value());
  EditRecord record;
  record.version = {store->epoch(), 1};
  record.op = {1, 5, 1};
  record.time_us = 1'700'000'000'000'000;
  record.edit = {FillBox{{{0, 0, 0}, {40, 3, 40}}}, {}, 2};
  const PlayerRow player = sample_player(1);
  REQUIRE(store->append({&player, 1}, std::vector{record}).has_value());

  MapCaches caches(1 << 20);
  MapWorld world(folder / "w", caches);
  const auto goes_on = [] { return true; };
  constexpr TimeUs kLater = 1'000'000;
  REQUIRE(world.refresh(kLater, kLater).has_value());
  std::vector<std::string> before;
  for (std::uint8_t zoom = 0; zoom <= 2; ++zoom)
    before.push_back(**world.draw(world.present(), {zoom, 0, 0}, goes_on));
  CHECK(world.tile_rules() == kTileRules);
  CHECK(world.changes().after(1).is_complete);

  const GivenShape plant{2, {ShapeForm::crossed, {{{1, 0, 1}, {15, 12, 15}}}}};
  record.version.seq = 2;
  record.op = {0, 6, 1};
  record.cause = Cause::materials;
  record.edit = shapes_edit({{plant}});
  REQUIRE(store->append({}, std::vector{record}).has_value());
  REQUIRE(world.refresh(2 * kLater, 2 * kLater).has_value());
  CHECK(world.tile_rules() == tile_rules_of(tile_shapes_number(world.materials())));
  CHECK(world.tile_rules() != kTileRules);
  CHECK_FALSE(world.changes().after(1).is_complete);  // browsers ask for all tiles again
  for (std::uint8_t zoom = 0; zoom <= 2; ++zoom) {
    CAPTURE(static_cast<int>(zoom));
    CHECK(**world.draw(world.present(), {zoom, 0, 0}, goes_on) != before[zoom]);
  }
}
