#include <catch2/catch.hpp>
#include <fstream>
#include <string>
#include <thread>

#include "tests/integration/server/web/web_bench.hpp"
#include "tests/support/net/web_player.hpp"

namespace runstone::test {
namespace {

bool has(const HttpReply& reply, const std::string& text) {
  return reply.body.find(text) != std::string::npos;
}

TEST_CASE("the pages show who is in the world", "[integration]") {
  const TempFolder folder;
  WebConfig config = web_config_of(folder);
  config.title = "The <valley>";
  config.public_address = "play.example.org";
  const WebBench bench(server_config_of(folder), config);
  WebPlayer player(bench.port());
  REQUIRE(player.join(7).has_value());
  REQUIRE(comes_to_show(bench.port(), "/", "<li>player7</li>"));
  WebPeer peer(bench.port());  // one connection for all
  const HttpReply world = peer.get("/");
  CHECK(world.status == 200);
  CHECK(has(world, "The &lt;valley&gt;"));
  CHECK(has(world, "runstone://play.example.org:4747"));
  const HttpReply status = peer.get("/status");
  CHECK(has(status, "The server is running."));
  CHECK(has(status, "<th scope=\"row\">sessions now</th><td>1</td>"));
  const HttpReply metrics = peer.get("/metrics");
  CHECK(has(metrics, "\nrunstone_sessions 1\n"));
  CHECK(has(metrics, "\nrunstone_web_websockets_open 1\n"));
  CHECK(metrics.header("Content-Type") == "text/plain; version=0.0.4; charset=utf-8");
  CHECK(peer.get("/style.css").header("Content-Type") == "text/css; charset=utf-8");
  const HttpReply head = peer.request("HEAD", "/style.css");
  CHECK(head.status == 200);
  CHECK(std::stoul(head.header("Content-Length")) > 100);
  CHECK(peer.request("DELETE", "/").header("Allow") == "GET, HEAD");
}

TEST_CASE("each answer has the headers for the safety of browsers", "[integration]") {
  const TempFolder folder;
  const WebBench bench(folder);
  WebPeer peer(bench.port());
  for (const char* target : {"/", "/status", "/metrics", "/style.css", "/nothing"}) {
    CAPTURE(target);
    const HttpReply reply = peer.get(target);
    CHECK(reply.header("Content-Security-Policy").find("default-src 'none'") == 0);
    CHECK(reply.header("Cross-Origin-Opener-Policy") == "same-origin");
    CHECK(reply.header("Cross-Origin-Embedder-Policy") == "require-corp");
    CHECK(reply.header("X-Content-Type-Options") == "nosniff");
  }
  CHECK(peer.upgrade().header("X-Content-Type-Options") == "nosniff");
}

TEST_CASE("the gateway serves the files of the client for browsers", "[integration]") {
  const TempFolder folder;
  for (const char* name : {"client.html", "client.css", "client.js", "program.js", "typing.js",
                           "keys.js", "database.js", "chunks.js", "textures.js", "ticker.js",
                           "runstone-web-client.js", "runstone-web-client.wasm", "DejaVuSans.ttf"})
    std::ofstream(folder.path() + "/" + name) << "plain " << name;
  WebConfig config = web_config_of(folder);
  config.client_files = folder.path();
  const WebBench bench(server_config_of(folder), config);
  WebPeer peer(bench.port());  // one connection for all
  CHECK(has(peer.get("/"), "href=\"client/\""));
  const HttpReply page = peer.get("/client/");
  CHECK(page.status == 200);
  CHECK(page.body == "plain client.html");
  CHECK(page.header("Content-Security-Policy").find("'wasm-unsafe-eval'") != std::string::npos);
  CHECK(page.header("Cross-Origin-Embedder-Policy") == "require-corp");
  CHECK(page.header("Cache-Control") == "no-cache");
  CHECK_FALSE(page.header("ETag").empty());
  CHECK(peer.get("/client/runstone-web-client.wasm").header("Content-Type") == "application/wasm");
  CHECK(peer.get("/client").header("Location") == "client/");
  CHECK(peer.get("/client/web.sock").status == 404);
  const HttpReply head = peer.request("HEAD", "/client/client.js");
  CHECK(head.header("Content-Length") == std::to_string(std::string("plain client.js").size()));
  CHECK(head.body.empty());
}

TEST_CASE("a gateway does not start with a folder that lacks the client", "[integration]") {
  const TempFolder folder;
  WebConfig config = web_config_of(folder);
  config.client_files = folder.path() + "/nothing";
  const auto gateway = WebGateway::start(config);
  REQUIRE_FALSE(gateway.has_value());
  CHECK(gateway.error() == "client_files: " + folder.path() +
                               "/nothing/client.html: cannot be read: No such file or directory");
}

TEST_CASE("paths that lead elsewhere and broken requests get an answer in words", "[integration]") {
  const TempFolder folder;
  const WebBench bench(folder);
  WebPeer peer(bench.port());
  for (const char* target : {"/../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "//etc/passwd",
                             "/style.css/../../web.sock", "/world/world.sqlite"}) {
    CAPTURE(target);
    const HttpReply reply = peer.get(target);
    CHECK(reply.status == 404);
    CHECK(reply.body == "there is no such page\n");
  }
  const auto answer = [&](const std::string& request) {
    WebPeer other(bench.port());
    other.send(request);
    return other.reply().status;
  };
  CHECK(answer("nonsense\r\n\r\n") == 400);
  CHECK(answer("GET / HTTP/1.1\r\nX: " + std::string(20'000, 'a') + "\r\n\r\n") == 431);
  CHECK(answer("POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 4\r\n\r\nabcd") == 413);
}

TEST_CASE("while the server is away the pages say so, and later players join again",
          "[integration]") {
  const TempFolder folder;
  const ServerConfig config = server_config_of(folder);
  WebBench bench(config, web_config_of(folder));
  {
    WebPlayer player(bench.port());
    REQUIRE(player.join(1).has_value());
    bench.server.reset();
    while (player.next()) {
    }
    REQUIRE(player.closed.has_value());
    CHECK(player.closed->close_code() == 1000);
    CHECK_FALSE(player.closed->close_words().empty());
  }
  CHECK(comes_to_show(bench.port(), "/", "not running, or it is restarting"));
  CHECK(comes_to_show(bench.port(), "/metrics", "runstone_up 0"));
  WebPeer early(bench.port());
  REQUIRE(early.upgrade().status == 101);
  const auto closed = early.next_close();
  REQUIRE(closed.has_value());
  CHECK(closed->close_code() == 1013);
  CHECK(closed->close_words().find("try again soon") != std::string::npos);
  bench.server = start_server(config, flat_creation());
  WebPlayer later(bench.port());
  CHECK(later.join(1).has_value());
  CHECK(comes_to_show(bench.port(), "/", "<li>player1</li>"));
}

TEST_CASE("a gateway that stops closes the WebSockets with words", "[integration]") {
  const TempFolder folder;
  WebBench bench(folder);
  WebPeer peer(bench.port());
  REQUIRE(peer.upgrade().status == 101);
  REQUIRE(comes_to_show(bench.port(), "/metrics", "\nrunstone_web_websockets_open 1\n"));
  WebPeer idle(bench.port());
  std::thread stop([&] { bench.gateway.reset(); });
  const auto closed = peer.next_close();
  stop.join();
  REQUIRE(closed.has_value());
  CHECK(closed->close_code() == 1001);
  CHECK(closed->close_words() == "the gateway stops");
  CHECK(idle.sees_the_end());
}

TEST_CASE("a gateway does not start with settings that would be unsafe or cannot work",
          "[integration]") {
  const auto error_of = [](const std::string& field, const std::string& text) {
    WebConfig config;
    config.listen = "127.0.0.1:0";
    REQUIRE(web_settings().set(config, field, text).has_value());
    const auto gateway = WebGateway::start(config);
    return gateway ? std::string() : gateway.error();
  };
  CHECK(error_of("listen", "0.0.0.0:0").find("without a certificate") != std::string::npos);
  CHECK(error_of("tls_key", "key.pem").find("one of them is missing") != std::string::npos);
  CHECK(error_of("origins", "example.org").find("no origin") != std::string::npos);
  CHECK(error_of("gateway_socket", std::string(120, 'x')).find("at most") != std::string::npos);
  CHECK(error_of("title", "valley").empty());
}

}  // namespace
}  // namespace runstone::test
