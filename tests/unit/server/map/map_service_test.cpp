#include "server/map/map_service.hpp"

#include <catch2/catch.hpp>
#include <latch>
#include <string>

#include "tests/support/core/temp_folder.hpp"

using namespace runstone;
using namespace runstone::test;

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
