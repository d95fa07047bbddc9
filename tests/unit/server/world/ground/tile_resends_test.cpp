#include "server/world/ground/tile_resends.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <memory>

using namespace runstone;

TEST_CASE("changed tiles are sent at a steady pace, one session after another", "[world]") {
  TileResends resends;
  const ChunkPtr tile = std::make_shared<const Chunk>();
  std::vector<SessionId> crowd;
  for (SessionId session = 1; session <= 300; ++session) crowd.push_back(session);
  resends.add({1, {}}, tile, crowd);
  TimeUs now_us = 1'000'000;
  std::vector<SessionId> sent;
  for (; !resends.empty(); now_us += kTileResendBurstUs) {
    std::size_t at_once = 0;
    for (; const auto next = resends.next(now_us); ++at_once) {
      CHECK(next->tile == tile);
      sent.push_back(next->session);
    }
    CHECK(at_once <= 1 + kTileResendBurstUs / kTileResendUs);
    CHECK(at_once > 0);
  }
  std::ranges::sort(sent);
  CHECK(sent == crowd);
  CHECK(now_us >= 1'000'000 + 290 * kTileResendUs);
  CHECK_FALSE(resends.next(now_us));
}

TEST_CASE("a tile that is cancelled is not sent, and its sessions are known", "[world]") {
  TileResends resends;
  const ChunkPtr tile = std::make_shared<const Chunk>();
  resends.add({1, {}}, tile, {});
  CHECK(resends.empty());
  resends.add({1, {}}, tile, {1, 2});
  resends.add({2, {}}, tile, {3});
  CHECK(resends.next(1'000'000)->session == 2);
  CHECK(resends.cancel({1, {}}) == std::vector<SessionId>{1});
  CHECK(resends.cancel({1, {}}).empty());
  CHECK(resends.next(1'000'000)->session == 3);
  CHECK(resends.empty());
}
