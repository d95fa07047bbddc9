#include "client/session/failure_words.hpp"

#include <catch2/catch.hpp>
#include <set>

namespace runstone {

TEST_CASE("each reason of a goodbye has words of its own, and keeps the server's text",
          "[client_session]") {
  const std::set<GoodbyeReason> special = {
      GoodbyeReason::closing,           GoodbyeReason::wrong_protocol,
      GoodbyeReason::not_authenticated, GoodbyeReason::already_connected,
      GoodbyeReason::server_full,       GoodbyeReason::timed_out,
      GoodbyeReason::flooding,          GoodbyeReason::name_refused,
      GoodbyeReason::not_admitted};
  std::set<std::string> headlines;
  for (const GoodbyeReason reason : special) {
    const FailureWords words = words_of(SessionEnd{reason, "the exact reason", true, true});
    CHECK(words.detail == "the exact reason");
    headlines.insert(words.headline);
  }
  CHECK(headlines.size() == special.size());
  CHECK(words_of({GoodbyeReason::malformed_frame, "", true, false}).headline ==
        "The server closed the connection");
  CHECK(words_of({GoodbyeReason::not_authenticated, "two keys", false, true}).headline ==
        "This is not the server that you know");
}

TEST_CASE("a connection that cannot be made has words for the player", "[client_session]") {
  const auto headline = [](std::string_view why) { return words_of_link(why, "a:1").headline; };
  CHECK(headline("cannot resolve a: Host not found (authoritative)") ==
        "There is no computer with this name");
  CHECK(headline("cannot connect: Connection refused") == "No server listens at a:1");
  CHECK(headline("cannot connect: Operation canceled") == "No answer from a:1");
  CHECK(headline("cannot connect: Permission denied") == "No connection to a:1");
  CHECK(headline("bad bytes from the server: x") == "This is no Runstone server, or it is broken");
  CHECK(headline("the server does not speak TLS: does it run with --insecure?") ==
        "The server at a:1 does not encrypt, or is no Runstone server");
  CHECK(headline("TLS: certificate verify failed") == "No encrypted connection to a:1");
  CHECK(headline("End of file") == "The connection to a:1 is lost");
  CHECK(headline("") == "No answer yet from a:1");
  CHECK(words_of_link("End of file", "a:1").detail == "End of file");
}

}  // namespace runstone
