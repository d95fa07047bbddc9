#include "server/world/sessions/session_output.hpp"

#include <catch2/catch.hpp>
#include <memory>
#include <set>
#include <vector>

#include "tests/unit/server/world/fake_environment.hpp"

namespace runstone::test {
namespace {

constexpr SessionId kHere = 3, kFollower = 50, kOtherFollower = 51;

EncodedMessage output_lines() {
  ChatLine line;
  line.kind = ChatLineKind::server;
  line.text = "hello";
  return encode_message(ChatLines{{line}});
}

std::vector<Relay> relays_to(const FakeEnvironment& environment, SessionId link) {
  return environment.messages<Relay>(link, 16);
}

TEST_CASE("a message to many sessions goes through each link once", "[world][servers]") {
  FakeEnvironment environment;
  SessionOutput output(environment);
  const SessionId a = output.add({kFollower, 7});
  const SessionId b = output.add({kOtherFollower, 7});
  const SessionId c = output.add({kFollower, 9});
  CHECK(std::set{a, b, c, kHere}.size() == 4);
  CHECK(output.relayed(kHere) == nullptr);
  REQUIRE(output.relayed(c) != nullptr);
  CHECK(output.relayed(c)->link == kFollower);
  CHECK(output.relayed(c)->remote == 9);
  CHECK(output.send_to_all(std::vector{kHere, a, b, c}, output_lines()).empty());
  REQUIRE(environment.sent.size() == 3);
  CHECK(environment.sent[0].session == kHere);
  CHECK(environment.sent[0].message.kind == kKindOf<ChatLines>);
  REQUIRE(relays_to(environment, kFollower).size() == 1);
  CHECK(relays_to(environment, kFollower)[0].sessions == std::vector<SessionId>{7, 9});
  CHECK(relays_to(environment, kFollower)[0].message.kind == kKindOf<ChatLines>);
  REQUIRE(relays_to(environment, kOtherFollower).size() == 1);
  CHECK(relays_to(environment, kOtherFollower)[0].sessions == std::vector<SessionId>{7});

  environment.full.insert(kFollower);
  CHECK(output.send_to_all(std::vector{kHere, a, b, c}, output_lines()) == std::vector{a, c});
  CHECK_FALSE(output.send(a, output_lines()));
  CHECK(output.send(b, output_lines()));
  output.remove(b);
  CHECK(output.relayed(b) == nullptr);
}

TEST_CASE("a message to more sessions than one relay may name goes in parts", "[world][servers]") {
  FakeEnvironment environment;
  SessionOutput output(environment);
  std::vector<SessionId> sessions;
  for (SessionId remote = 1; remote <= kRelaySessionsMax + 1; ++remote)
    sessions.push_back(output.add({kFollower, remote}));
  CHECK(output.send_to_all(sessions, output_lines()).empty());
  const auto relays = relays_to(environment, kFollower);
  REQUIRE(relays.size() == 2);
  CHECK(relays[0].sessions.size() == kRelaySessionsMax);
  CHECK(relays[1].sessions == std::vector<SessionId>{kRelaySessionsMax + 1});
}

TEST_CASE("a message that no relay may hold counts as one that does not fit", "[world][servers]") {
  FakeEnvironment environment;
  SessionOutput output(environment);
  const SessionId session = output.add({kFollower, 1});
  EncodedMessage large = output_lines();
  large.bytes = std::make_shared<const Bytes>(kRelayBodyBytesMax + 1);
  CHECK_FALSE(output.send(session, large));
  CHECK(output.send_to_all(std::vector{session}, large) == std::vector{session});
  CHECK(environment.sent.empty());
}

TEST_CASE("the end and the costs of a session go to where it is connected", "[world][servers]") {
  FakeEnvironment environment;
  SessionOutput output(environment);
  const SessionId session = output.add({kFollower, 7});
  output.close(kHere, GoodbyeReason::closing, "here");
  output.charge_reading(kHere, 5);
  REQUIRE(environment.closed.size() == 1);
  CHECK(environment.closed[0].session == kHere);
  CHECK(environment.charged[kHere] == 5);
  output.charge_reading(session, 6);
  output.close(session, GoodbyeReason::flooding, "there");
  CHECK(environment.closed.size() == 1);
  const auto charges = environment.messages<RelayCharge>(kFollower, 16);
  REQUIRE(charges.size() == 1);
  CHECK(charges[0] == RelayCharge{7, 6});
  const auto ends = environment.messages<RelayClose>(kFollower, 16);
  REQUIRE(ends.size() == 1);
  CHECK(ends[0] == RelayClose{7, static_cast<std::uint8_t>(GoodbyeReason::flooding), "there"});
  environment.full.insert(kFollower);
  output.close(session, GoodbyeReason::flooding, "there");
  CHECK(environment.closed.back().session == kFollower);
}

}  // namespace
}  // namespace runstone::test
