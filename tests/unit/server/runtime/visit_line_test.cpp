#include "server/runtime/visit_line.hpp"

#include <catch2/catch.hpp>

#include "protocol/codec/key_fingerprint.hpp"

#include "server/runtime/log_payload.hpp"

using namespace runstone;

TEST_CASE("a line says who came, from where, and who left and why", "[log]") {
  PlayerVisit visit{7, 3, "the mole", {}, 4};
  for (std::size_t i = 0; i < visit.key.size(); ++i) visit.key[i] = static_cast<std::uint8_t>(i);
  CHECK(text_of(came_line(visit, "203.0.113.7:40312")) ==
        "came name=\"the mole\" author=3 key=" + key_fingerprint(visit.key) +
            " address=203.0.113.7:40312 players=4 session=7");
  CHECK(text_of(left_line(visit, {GoodbyeReason::timed_out, "no message for 60 s"})) ==
        "left name=\"the mole\" author=3 key=" + key_fingerprint(visit.key) +
            " reason=timed_out why=\"no message for 60 s\" players=4 session=7");
}
