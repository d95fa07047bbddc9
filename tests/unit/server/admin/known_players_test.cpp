#include "server/admin/known_players.hpp"

#include <catch2/catch.hpp>
#include <cctype>
#include <string>

#include "common/core/hex.hpp"
#include "protocol/codec/key_fingerprint.hpp"

namespace runstone::known_players_test {
namespace {

const PublicKey kAna{1}, kMole{2}, kBat{3}, kOther{4};

KnownPlayers players() {
  KnownPlayers::Sources sources;
  sources.stored = {{1, kAna, "Ana"}, {2, kMole, "the mole"}};
  sources.used = {{1, "ann"}, {1, "Ana"}, {2, "the bat"}};
  sources.present = {{3, kBat, "the bat"}};
  sources.claims = {{"owner", "Owner", kOther}};
  return KnownPlayers(sources);
}

}  // namespace

TEST_CASE("a pattern finds players by their present and earlier names", "[admin][rights]") {
  const KnownPlayers known = players();
  using Keys = std::vector<PublicKey>;
  CHECK(known.matching("AN*") == Keys{kAna});
  CHECK(known.matching("the *") == Keys{kMole, kBat});
  CHECK(known.matching("*bat") == Keys{kMole, kBat});
  CHECK(known.matching("*a*") == Keys{kAna, kMole, kBat});
  CHECK(known.matching("t*e*m*l*e") == Keys{kMole});
  CHECK(known.matching("*").size() == 4);
  CHECK(known.matching("ana*") == Keys{kAna});  // a star may stand for nothing
  CHECK(known.matching("b*").empty());
  CHECK(known.matching("*" + std::string(500, '*') + "x").empty());
  CHECK(known.author_count() == 3);
  CHECK(known.name_of(kAna) == "Ana");
  CHECK(known.key_of(2) == kMole);
  CHECK(known.key_of(9) == std::nullopt);
}

TEST_CASE("a player is found by name, number, key and fingerprint", "[admin][rights]") {
  const KnownPlayers known = players();
  CHECK(*known.find("ana") == kAna);  // names are folded
  CHECK(*known.find("ann") == kAna);  // an earlier name
  CHECK(*known.find("#3") == kBat);
  CHECK(*known.find("OWNER") == kOther);  // who never built
  CHECK(*known.find(to_hex(kMole)) == kMole);
  CHECK(*known.find(to_hex(PublicKey{9})) == PublicKey{9});  // nobody knows it yet
  CHECK(*known.find(key_fingerprint(kMole)) == kMole);
  std::string small = key_fingerprint(kMole);
  for (char& c : small) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  CHECK(*known.find(small) == kMole);
}

TEST_CASE("a word that means nobody or several players is refused", "[admin][rights]") {
  const KnownPlayers known = players();
  CHECK(known.find("nobody").error() ==
        "nobody of that name is known here (players and names list the others)");
  CHECK(known.find("#7").error() == "nobody has that author number (players lists them)");
  CHECK(known.find("0000-0000-0000").error() ==
        "nobody with that fingerprint is known here (players and names list them)");
  CHECK(known.find("the bat").error() ==
        "several players have, own or had that name: the mole #2 " + key_fingerprint(kMole) +
            " (say #2), the bat #3 " + key_fingerprint(kBat) + " (say #3)");

  KnownPlayers::Sources many;
  for (std::uint8_t i = 1; i <= 12; ++i) many.stored.push_back({i, PublicKey{i}, "x"});
  CHECK(KnownPlayers(many).find("x").error().find(" and 2 more") != std::string::npos);
}

TEST_CASE("a name that reads as a number or fingerprint never stands for another player",
          "[admin][rights]") {
  KnownPlayers::Sources sources;
  sources.stored = {{1, kAna, "Ana"}, {2, kMole, "#1"}, {3, kBat, key_fingerprint(kAna)}};
  const KnownPlayers known(sources);
  const std::string ana = "Ana #1 " + key_fingerprint(kAna);
  // Ana's number and fingerprint are names of others, so only her key means her alone.
  CHECK(known.find("#1").error() == "that is also the name of a player; it may mean " + ana +
                                        " (say " + to_hex(kAna) + "), #1 #2 " +
                                        key_fingerprint(kMole) + " (say #2)");
  CHECK(known.doubt_of(1) == known.find("#1").error());
  CHECK(known.doubt_of(2) == std::nullopt);
  CHECK(known.doubt_of(9) == std::nullopt);
  CHECK_FALSE(known.find(key_fingerprint(kAna)).has_value());
  CHECK(*known.find(to_hex(kAna)) == kAna);
  CHECK(*known.find("#2") == kMole);
  CHECK(*known.find("ana") == kAna);

  // Without a player of that number the word means nobody, and the answer names the player.
  sources.stored = {{2, kMole, "#7"}};
  CHECK(KnownPlayers(sources).find("#7").error() ==
        "nobody has that author number (players lists them). The player of that name is #7 #2 " +
            key_fingerprint(kMole) + " (say #2)");
  CHECK(KnownPlayers(sources).doubt_of(7).has_value());
}

TEST_CASE("the author and the name in use of a player are found", "[admin][rights]") {
  const KnownPlayers known = players();
  CHECK(known.author_of(kAna) == AuthorId{1});
  CHECK(known.author_of(kOther) == std::nullopt);
  CHECK(known.author_of(PublicKey{9}) == std::nullopt);
  CHECK(known.has_name(kAna, "ANA"));
  CHECK_FALSE(known.has_name(kAna, "ann"));
}

TEST_CASE("the text of a player has the fingerprint of the key", "[admin][rights]") {
  const KnownPlayers known = players();
  CHECK(known.text_of(kAna) == "Ana #1 " + key_fingerprint(kAna));
  CHECK(known.text_of(kOther) == "Owner " + key_fingerprint(kOther));
  CHECK(known.text_of(PublicKey{9}) == key_fingerprint(PublicKey{9}));
  CHECK(known.text_of(AuthorId{2}) == "the mole #2 " + key_fingerprint(kMole));
  CHECK(known.text_of(AuthorId{7}) == "#7");
  CHECK(known.text_of(AuthorId{0}) == "the server");
}

}  // namespace runstone::known_players_test
