// A gateway that may open no more files. UndefinedBehaviorSanitizer opens a pipe whenever it checks the
// type of an object, and reports a fault if it cannot. So these cases are left out with sanitizers.
#ifndef RUNSTONE_SANITIZED
#include <catch2/catch.hpp>
#include <memory>
#include <optional>
#include <string>

#include "tests/integration/server/web/web_bench.hpp"
#include "tests/integration/server/web/web_program.hpp"
#include "tests/support/core/text_contains.hpp"
#include "tests/support/net/web_player.hpp"

namespace runstone::test {
namespace {

/// A gateway with one player.
struct FewFilesBench {
  FewFilesBench() { REQUIRE(player.join(1).has_value()); }

  const TempFolder folder;
  const std::unique_ptr<Server> server = start_server(server_config_of(folder), flat_creation());
  WebProgram program{folder};
  const std::size_t files = program.open_files().size();  // without the player's
  WebPlayer player{program.port()};
};

bool serves(WebPeer& peer) { return peer.get("/style.css").status == 200; }

TEST_CASE_METHOD(
    FewFilesBench,
    "a gateway that may open no more files closes its oldest idle connection for a new one",
    "[integration]") {
  WebPeer oldest(program.port()), newer(program.port());
  REQUIRE(program.comes_to_have_files(files + 4));
  program.forbid_more_files();

  WebPeer newcomer(program.port());
  CHECK(oldest.sees_the_end());
  CHECK(serves(newcomer));
  CHECK(serves(newer));
  CHECK(player.gets_pong());

  // The connection to the server needs one more file.
  REQUIRE(newcomer.upgrade().status == 101);
  const auto closed = newcomer.next_close();
  REQUIRE(closed.has_value());
  CHECK(closed->close_code() == 1013);
  CHECK(closed->close_words() == "the gateway has no room for one more connection: try again soon");
  CHECK(player.gets_pong());

  program.allow_files();
  WebPlayer later(program.port());
  CHECK(later.join(2).has_value());
  CHECK(serves(newer));
  const std::string metrics = newer.get("/metrics").body;
  CHECK(contains(metrics, "\nrunstone_web_accepts_failed 1\n"));
  CHECK(contains(metrics, "\nrunstone_web_evicted 1\n"));
  CHECK(contains(metrics, "\nrunstone_web_refused 0\n"));
  CHECK(contains(metrics, "\nrunstone_web_links_failed 1\n"));
  const std::string log = program.log();
  CAPTURE(log);
  CHECK(contains(log,
                 "cannot take a connection: Too many open files: see ulimit -n and sockets_max\n"));
  CHECK(contains(
      log, "a connection from 127.0.0.1 is closed to make room for a newer one: see ulimit -n\n"));
  CHECK(contains(log, "a WebSocket has no connection to " + folder.path() +
                          "/web.sock: Too many open files (the gateway has no room"));
}

TEST_CASE_METHOD(
    FewFilesBench,
    "a gateway without files closes no player, and takes new connections when one is free",
    "[integration]") {
  std::optional<WebPlayer> leaver(std::in_place, program.port());
  REQUIRE(leaver->join(2).has_value());
  REQUIRE(program.comes_to_have_files(files + 4));
  program.forbid_more_files();

  WebPeer newcomer(program.port());
  newcomer.send("GET /style.css HTTP/1.1\r\nHost: x\r\n\r\n");
  CHECK_FALSE(newcomer.next(500).has_value());  // it waits
  CHECK(newcomer.is_open());
  CHECK(player.gets_pong());
  CHECK(leaver->gets_pong());
  leaver.reset();
  CHECK(newcomer.reply().status == 200);
  CHECK(player.gets_pong());
  CHECK(contains(newcomer.get("/metrics").body, "\nrunstone_web_evicted 0\n"));
}

}  // namespace
}  // namespace runstone::test
#endif
