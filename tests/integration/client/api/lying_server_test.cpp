// WorldClient and a peer that is no honest server.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <string>
#include <thread>
#include <utility>

#include "tests/integration/client/api/joined_client.hpp"
#include "tests/support/core/temp_folder.hpp"

namespace runstone::test {
namespace {

/// Accepts connections on a free port, and answers each with the same bytes.
class ByteServer {
 public:
  explicit ByteServer(std::string bytes)
      : bytes_(std::move(bytes)), socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in here{};
    here.sin_family = AF_INET;
    here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    REQUIRE(::bind(socket_, reinterpret_cast<sockaddr*>(&here), sizeof here) == 0);
    REQUIRE(::listen(socket_, 8) == 0);
    socklen_t size = sizeof here;
    REQUIRE(::getsockname(socket_, reinterpret_cast<sockaddr*>(&here), &size) == 0);
    port_ = ntohs(here.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  ~ByteServer() {
    ::shutdown(socket_, SHUT_RDWR);
    thread_.join();
    ::close(socket_);
  }
  std::uint16_t port() const { return port_; }
  int served() const { return served_; }

 private:
  void serve() {
    for (int peer = 0; (peer = ::accept(socket_, nullptr, nullptr)) >= 0;) {
      static_cast<void>(::send(peer, bytes_.data(), bytes_.size(), MSG_NOSIGNAL));
      char hello[512];
      static_cast<void>(::recv(peer, hello, sizeof hello, 0));
      ::close(peer);
      ++served_;
    }
  }

  const std::string bytes_;
  int socket_;
  std::uint16_t port_ = 0;
  std::atomic<int> served_{0};
  std::thread thread_;
};

ConnectionLost loss_at(const ByteServer& server, Encryption encryption) {
  WorldClientOptions options;
  options.server = "127.0.0.1:" + std::to_string(server.port());
  options.encryption = encryption;
  JoinedClient client(options);
  ConnectionLost lost = client.await<ConnectionLost>();
  CHECK_FALSE(lost.headline.empty());
  CHECK_FALSE(lost.is_final);
  CHECK(client->state() == ConnectionState::connecting);
  CHECK_FALSE(client->world().has_value());
  CHECK(client->chunks().empty());
  client.until([&] { return server.served() >= 2; });  // it tries again
  return lost;
}

}  // namespace

TEST_CASE("bytes of a peer that is no server are a loss with words", "[integration][client_api]") {
  std::string bytes;
  for (int i = 0; i < 4096; ++i) bytes += static_cast<char>(i * 37 + (i >> 8));
  const ByteServer garbage(bytes), silent(""), web("HTTP/1.1 400 Bad Request\r\n\r\n");
  CHECK(loss_at(garbage, Encryption::none).headline ==
        "This is no Runstone server, or it is broken");
  CHECK(loss_at(silent, Encryption::none).detail.size() > 4);
  CHECK(loss_at(web, Encryption::any_certificate).headline.find("does not encrypt") !=
        std::string::npos);
}

TEST_CASE("options that cannot be are words", "[integration][client_api]") {
  const auto words = [](WorldClientOptions options) {
    auto client = WorldClient::connect(std::move(options));
    return client ? std::string() : client.error();
  };
  const TempFolder folder;
  CHECK(words({}).find("server") == 0);
  CHECK(words({.server = "localhost:x"}).find("server: ") == 0);
  CHECK(words({.server = "localhost", .name = std::string(33, 'x')}).find("name: ") == 0);
  CHECK(words({.server = "localhost", .view_radius = 65}).find("view_radius") == 0);
  CHECK(words({.server = "localhost", .memory_mib = 1}).find("memory_mib") == 0);
  CHECK(words({.server = "localhost", .cache_mib = 0}).find("cache_mib") == 0);
  CHECK(words({.server = "localhost", .invite = "abc"}).find("invite: ") == 0);
  CHECK(words({.server = "localhost", .invite = std::string(100'000, 'a')}).find("invite: ") == 0);
  CHECK(words({.server = "localhost", .password = "p", .encryption = Encryption::none})
            .find("password: ") == 0);
  CHECK(words({.server = "localhost", .encryption = static_cast<Encryption>(9)})
            .find("encryption: ") == 0);
  CHECK(words({.server = "localhost", .key_file = folder / "missing/key"}).find("missing/key") !=
        std::string::npos);
  CHECK(words({.server = "localhost",
               .encryption = Encryption::authorities,
               .authorities_file = folder / "none.pem"})
            .size() > 4);
}

}  // namespace runstone::test
