#include "server/admin/server_list.hpp"

#include <catch2/catch.hpp>

namespace runstone {

TEST_CASE("servers are listed with number, address, sessions and edits", "[admin][servers]") {
  CHECK(server_list({{std::nullopt, "", 1, 0}}) ==
        "this server, the owner: 1 session, 0 edits since it owns the world");
  CHECK(
      server_list({{std::nullopt, "one.example:4747", 0, 120},
                   {17, "two.example:4747", 5, 1},
                   {23, "", 0, 0}}) ==
      "this server, the owner at one.example:4747: 0 sessions, 120 edits since it owns the world\n"
      "server 17 at two.example:4747: 5 sessions, 1 edit since it connected\n"
      "server 23: 0 sessions, 0 edits since it connected");
}

}  // namespace runstone
