// The words for a player if a server or the display fails; no edit is lost without a word. The
// real client program runs in a window.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>
#include <catch2/catch.hpp>

#include <atomic>
#include <string_view>
#include <thread>

#include "tests/integration/client/window/title_bench.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/support/net/raw_client.hpp"

namespace runstone::test {
namespace {

/// A program that is no Runstone server. It answers the first bytes of each connection with a line of
/// HTTP.
class OtherServer {
 public:
  OtherServer() : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in here{};
    here.sin_family = AF_INET;
    here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof here;
    auto* const address = reinterpret_cast<sockaddr*>(&here);
    REQUIRE(::bind(socket_, address, size) == 0);
    REQUIRE(::listen(socket_, 8) == 0);
    REQUIRE(::getsockname(socket_, address, &size) == 0);
    port_ = ntohs(here.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  ~OtherServer() {
    ::shutdown(socket_, SHUT_RDWR);  // ends accept()
    thread_.join();
    ::close(socket_);
  }
  OtherServer(const OtherServer&) = delete;
  OtherServer& operator=(const OtherServer&) = delete;
  std::string address() const { return "127.0.0.1:" + std::to_string(port_); }

 private:
  void serve() const {
    for (int peer = 0; (peer = ::accept(socket_, nullptr, nullptr)) >= 0; ::close(peer)) {
      char bytes[512];
      constexpr std::string_view kAnswer = "HTTP/1.1 400 Bad Request\r\n\r\n";
      if (::recv(peer, bytes, sizeof bytes, 0) > 0)
        static_cast<void>(::send(peer, kAnswer.data(), kAnswer.size(), MSG_NOSIGNAL));
    }
  }

  const int socket_;
  std::uint16_t port_ = 0;
  std::thread thread_;
};

/// A client in a window at a server that the test stops and starts again at the same address.
struct ServerGoneBench : TitleBench {
  ServerGoneBench() {
    config = quiet_config(folder / "world");
    config.idle_s = 3'600;
    server = start_server(config, flat_creation());
    config.listen = "127.0.0.1:" + std::to_string(server->port());
    start({"--connect", config.listen, "--key", folder / "ana.key", "--name", "ana"});
    REQUIRE(logs("ground in view"));
    // A click captures the mouse, and the player looks at the ground.
    REQUIRE(display.hand({"mousemove", "320", "150", "click", "1"}));
    for (int step = 0; step < 4; ++step)
      REQUIRE(display.hand({"mousemove_relative", "--", "0", "80"}));
    server.reset();
    REQUIRE(logs("connection lost"));
    REQUIRE(display.hand({"click", "1"}));  // removes a voxel
  }

  ServerConfig config;
  std::unique_ptr<Server> server;
};

}  // namespace

TEST_CASE("an edit that was made while the server is gone reaches it when it is back",
          "[integration]") {
  if (!has_display_programs()) return;
  ServerGoneBench bench;
  bench.server = start_server(bench.config, flat_creation());
  CHECK(bench.logs("world open", 2));
  CHECK(reaches(bench.config.world, 1));
  bench.leave();
  CHECK_FALSE(text_in(bench.log).find("not confirmed") != std::string::npos);
}

TEST_CASE("a player who leaves while the server is gone reads how many edits may be lost",
          "[integration]") {
  if (!has_display_programs()) return;
  ServerGoneBench bench;
  bench.leave();
  CHECK(bench.logs("1 of your edits was not confirmed, and may be lost"));
}

TEST_CASE("a full server, and a program that is no server, are named in words", "[integration]") {
  if (!has_display_programs()) return;
  TitleBench bench;
  ServerConfig config = quiet_config(bench.folder / "world");
  config.idle_s = 3'600;
  config.sessions_max = 1;
  const auto server = start_server(config, flat_creation());
  RawClient guest(server->port());
  REQUIRE(guest.join(9).has_value());
  const std::vector<std::string> few_seconds = {"--name", "ana", "--reconnect-seconds", "1"};
  std::vector<std::string> join = {"--connect", "127.0.0.1:" + std::to_string(server->port())};
  join.insert(join.end(), few_seconds.begin(), few_seconds.end());
  bench.start(join);
  CHECK(bench.logs("The server is full"));

  const OtherServer other;
  join[1] = other.address();
  bench.start(join);
  CHECK(bench.logs("The server at " + other.address() + " does not encrypt"));
}

TEST_CASE("without a display, or with one that has too old an OpenGL, the client says so and ends",
          "[integration]") {
  if (!has_display_programs()) return;
  TempFolder folder;
  const std::string log = folder / "client.log";
  const auto words_of = [&](std::vector<std::string> environment) {
    std::filesystem::remove(log);
    ChildProcess client({RUNSTONE_CLIENT_PROGRAM}, log, std::move(environment));
    CHECK(client.wait(kWait) == 2);
    return text_in(log);
  };
  CHECK_THAT(words_of({"DISPLAY="}), Catch::Contains("no window: no display is reached"));
  const VirtualDisplay display(folder / ".", 320, 240);
  std::vector<std::string> old = display.environment();
  old.emplace_back("MESA_GL_VERSION_OVERRIDE=2.1");
  old.emplace_back("MESA_GLES_VERSION_OVERRIDE=2.0");
  CHECK_THAT(words_of(std::move(old)),
             Catch::Contains("no window: OpenGL 3.3 or OpenGL ES 3.0 is needed"));
}

TEST_CASE("where OpenGL is too old, the window is drawn with OpenGL ES", "[integration]") {
  if (!has_display_programs()) return;
  TempFolder folder;
  const VirtualDisplay display(folder / ".", 320, 240);
  std::vector<std::string> environment = display.environment();
  environment.emplace_back("MESA_GL_VERSION_OVERRIDE=2.1");
  const std::string log = folder / "client.log";
  ChildProcess client({RUNSTONE_CLIENT_PROGRAM}, log, std::move(environment));
  CHECK(wait_for(
      kWait, [&] { return text_in(log).find("renderer=GLFW, OpenGL ES") != std::string::npos; }));
}

}  // namespace runstone::test
