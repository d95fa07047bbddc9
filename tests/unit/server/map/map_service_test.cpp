#include "server/map/map_service.hpp"

#include <catch2/catch.hpp>
#include <latch>

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
