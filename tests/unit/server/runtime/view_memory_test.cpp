#include "server/runtime/view_memory.hpp"

#include <catch2/catch.hpp>
#include <vector>

#include "server/interest/view_cells.hpp"

using namespace runstone;

TEST_CASE("the memory of a view grows with its chunks", "[runtime]") {
  for (const std::uint8_t radius :
       {std::uint8_t{0}, std::uint8_t{1}, std::uint8_t{7}, std::uint8_t{16}}) {
    CAPTURE(int{radius});
    View view;
    view.radius_h = view.radius_v = radius;
    std::vector<ChunkCoord> chunks;
    append_difference(view, std::nullopt, CoordLimit{1'000}, chunks);
    CHECK(view_bytes(radius) == chunks.size() * 14);
  }
  // A session with the largest view was measured to take 22 MB.
  CHECK(view_bytes(64) > 20'000'000);
  CHECK(view_bytes(64) < 25'000'000);
}

TEST_CASE("a host is warned of views that could take more than memory_mib", "[runtime]") {
  ServerConfig config;
  CHECK(view_memory_warning(config) == std::nullopt);
  config.view_radius_max = 64;
  const auto warning = view_memory_warning(config);
  REQUIRE(warning.has_value());
  CHECK(
      warning->starts_with("view_radius_max = 64: a session that sees so far takes about 22 MiB"));
  CHECK(warning->find("beside memory_mib = 512") != std::string::npos);
  config.sessions_max = 8;
  CHECK(view_memory_warning(config) == std::nullopt);
}
