#include "server/admin/chat_list.hpp"

#include <catch2/catch.hpp>

#include "protocol/codec/key_fingerprint.hpp"

namespace runstone {
namespace {

TEST_CASE("the list of chat lines names the player with the fingerprint", "[admin][chat]") {
  PublicKey key{};
  key.fill(3);
  const std::string print = key_fingerprint(key);
  CHECK(chat_list({}) == "the log of the chat has no such lines");
  CHECK(chat_list({{{ChatLineKind::player, 0, "the mole", "hi: all", 0}, key},
                   {{ChatLineKind::server, 0, "", "restart", 1'000'000}, {}},
                   {{ChatLineKind::server, 0, "", "now", 2'000'000}, key}}) ==
        "1970-01-01T00:00:00Z the mole " + print +
            ": hi: all\n1970-01-01T00:00:01Z server: restart\n1970-01-01T00:00:02Z server " +
            print + ": now");
}

}  // namespace
}  // namespace runstone
