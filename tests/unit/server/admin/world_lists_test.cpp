#include "server/admin/world_lists.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "common/core/hex.hpp"
#include "protocol/codec/key_fingerprint.hpp"

using namespace runstone;

namespace {

PublicKey key_of(std::uint8_t first) { return PublicKey{first}; }

/// Returns how a line shows a key: "9M1Q-Z7CR-04KD key 0a0b...".
std::string shown(const PublicKey& key) { return key_fingerprint(key) + " key " + to_hex(key); }

}  // namespace

TEST_CASE("materials lists the names in the order of their ids", "[admin]") {
  MaterialTable table;
  for (const char* name : {"default:stone", "default:brick", "wool:red"}) {
    REQUIRE(table.add({name, {1, 2, 3, 255}, Visibility::opaque, std::nullopt}).has_value());
  }
  CHECK(material_list(table, "") == "air\ndefault:stone\ndefault:brick\nwool:red");
  CHECK(material_list(table, "default") == "default:stone\ndefault:brick");
  CHECK(material_list(table, "gold") == "no material's name contains \"gold\"");
}

TEST_CASE("materials lists 1000 names and counts the others", "[admin]") {
  MaterialTable table;
  for (int i = 1; i < 1002; ++i) {
    REQUIRE(table.add({"m" + std::to_string(i), {1, 2, 3, 255}, Visibility::opaque, std::nullopt})
                .has_value());
  }
  const std::string text = material_list(table, "");
  CHECK(text.find("\nm999\nand 2 more: materials PART") != std::string::npos);
  CHECK(text.find("\nm1000\n") == std::string::npos);
}

TEST_CASE("players lists builders, visitors and those who are here", "[admin]") {
  const std::vector<PlayerRow> stored = {{1, key_of(1), "ana"}, {2, key_of(2), "ben"}};
  const std::vector<OnlinePlayer> present = {{9, 2, "ben", key_of(2), {1.5, 64.0, -0.5}},
                                             {10, 4, "dan", key_of(4), {0, 0, 0}}};
  const std::vector<PlayerRow> visitors = {{3, key_of(3), "cleo"}};
  CHECK(player_list(stored, present, visitors) ==
        "ana #1 " + shown(key_of(1)) + "\nben #2 " + shown(key_of(2)) +
            " is here, at 1 64 -1\ncleo #3 " + shown(key_of(3)) + " left without an edit\ndan #4 " +
            shown(key_of(4)) + " is here, at 0 0 0");
  CHECK(player_list({}, {}, {}) == "nobody has ever been here");
}

TEST_CASE("players lists at most 500 absent builders and counts the others", "[admin]") {
  std::vector<PlayerRow> stored;
  for (AuthorId author = 1; author <= 503; ++author) {
    stored.push_back({author, key_of(1), "p" + std::to_string(author)});
  }
  const std::string without = player_list(stored, {}, {});
  CHECK(without.find("\np500 #500 ") != std::string::npos);
  CHECK(without.find("\np501 ") == std::string::npos);
  CHECK(without.ends_with("\nand 3 more who are not here"));
  const std::string with = player_list(stored, {{1, 502, "p502", key_of(1), {0, 0, 0}}}, {});
  CHECK(with.find("\np502 #502 ") != std::string::npos);
  CHECK(with.ends_with("\nand 2 more who are not here"));
}

TEST_CASE("names lists the owners, at most 500", "[admin][names]") {
  CHECK(name_list({}) == "nobody owns a name");
  const PublicKey key{7};
  CHECK(name_list({{"Ana", key, 3}, {"the mole", key, std::nullopt}}) ==
        "\"Ana\" " + key_fingerprint(key) + " #3\n\"the mole\" " + key_fingerprint(key));
  const std::string many = name_list(std::vector<OwnedName>(502, {"x", key, 3}));
  CHECK(many.ends_with("\nand 2 more"));
}

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
