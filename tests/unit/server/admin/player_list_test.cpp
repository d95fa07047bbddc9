#include "server/admin/player_list.hpp"

#include <catch2/catch.hpp>

#include "common/core/hex.hpp"
#include "protocol/codec/key_fingerprint.hpp"

using namespace runstone;

namespace {

PublicKey key_of(std::uint8_t first) { return PublicKey{first}; }

/// Returns how a line shows a key: "9M1Q-Z7CR-04KD key 0a0b...".
std::string shown(const PublicKey& key) { return key_fingerprint(key) + " key " + to_hex(key); }

}  // namespace

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
