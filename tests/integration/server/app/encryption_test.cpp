// Connections with and without TLS, and attempts to get between a client and its server.
#include <openssl/evp.h>
#include <openssl/ssl.h>
#include <sys/stat.h>

#include <array>
#include <catch2/catch.hpp>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <future>

#include "common/os/steady_clock.hpp"
#include "common/tls/openssl_ptr.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/support/net/raw_client.hpp"
#include "tests/support/tls/pem_files.hpp"

namespace runstone::test {
namespace {

ServerConfig insecure_config(const std::string& world) {
  ServerConfig config = quiet_config(world);
  config.insecure = true;
  return config;
}

std::string start_error(const ServerConfig& config) {
  const auto server = Server::start(config, flat_creation());
  return server ? "" : server.error();
}

struct Reloaded {
  bool is_ok = false;
  std::string lines;
};
Reloaded reload(Server& server, const ServerConfig& config) {
  std::promise<Reloaded> answer;
  server.reload(config, [&answer](const CommandAnswer& reply) {
    answer.set_value({reply.is_ok, reply.text});
  });
  return answer.get_future().get();
}

/// A client that is nothing but OpenSSL on a blocking socket.
struct OpensslClient {
  explicit OpensslClient(std::uint16_t port) {
    sockaddr_in server{};
    server.sin_family = AF_INET;
    server.sin_port = htons(port);
    server.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    REQUIRE(::connect(socket, reinterpret_cast<const sockaddr*>(&server), sizeof server) == 0);
    const timeval deadline{10, 0};
    ::setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &deadline, sizeof deadline);
    REQUIRE(SSL_set_fd(ssl.get(), socket) == 1);
    REQUIRE(SSL_connect(ssl.get()) == 1);
  }
  ~OpensslClient() { ::close(socket); }
  OpensslClient(const OpensslClient&) = delete;
  OpensslClient& operator=(const OpensslClient&) = delete;

  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  const OpensslPtr<SSL_CTX, SSL_CTX_free> context{SSL_CTX_new(TLS_client_method())};
  const OpensslPtr<SSL, SSL_free> ssl{SSL_new(context.get())};
};

TEST_CASE("a server shows its own key in its certificate", "[integration][tls]") {
  const TempFolder folder;
  const auto server = start_server(quiet_config(folder / "world"), flat_creation());
  RawClient client(server->port());
  REQUIRE(client.join(1).has_value());
  const OpensslClient other(server->port());
  PublicKey shown{};
  std::size_t bytes = shown.size();
  REQUIRE(EVP_PKEY_get_raw_public_key(X509_get0_pubkey(SSL_get0_peer_certificate(other.ssl.get())),
                                      shown.data(), &bytes) == 1);
  CHECK(shown == client.welcome.server_key);
}

TEST_CASE("a client that changes its keys again and again is disconnected", "[integration][tls]") {
  const TempFolder folder;
  const auto server = start_server(quiet_config(folder / "world"), flat_creation());
  const OpensslClient client(server->port());
  std::signal(SIGPIPE, SIG_IGN);  // OpenSSL writes to the socket that the server has closed
  int updates = 0;
  for (bool goes_on = true; goes_on && updates < 10'000; ++updates) {
    goes_on = SSL_key_update(client.ssl.get(), SSL_KEY_UPDATE_REQUESTED) == 1 &&
              SSL_do_handshake(client.ssl.get()) == 1;
  }
  // The server closes: reading ends, and not because of the deadline.
  std::array<char, 100> text{};
  CHECK(SSL_read(client.ssl.get(), text.data(), text.size()) <= 0);
  CHECK(errno != EAGAIN);
  RawClient honest(server->port());
  CHECK(honest.join(1).has_value());
}

TEST_CASE("signatures hold on their own connection alone, so a handshake cannot be relayed",
          "[integration][tls]") {
  const TempFolder folder;
  const auto server = start_server(quiet_config(folder / "world"), flat_creation());
  RawClient of_attacker(server->port()), of_victim(server->port());
  SECTION("the client's signature of another connection") {
    // A man in the middle has a connection to the victim and another one to the server.
    CHECK_FALSE(of_attacker.join_as_on(1, 1, of_victim.binding()).has_value());
    CHECK(of_attacker.is_open() == false);
  }
  SECTION("the client's signature of a connection without TLS") {
    CHECK_FALSE(of_attacker.join_as_on(1, 1, std::nullopt).has_value());
  }
  SECTION("the server's signature of another connection") {
    const Hello hello = of_attacker.hello(1);
    of_attacker.send(hello);
    const auto welcome = of_attacker.next_of<Welcome>();
    REQUIRE(welcome.has_value());
    const auto holds_on = [&](const std::optional<ChannelBinding>& binding) {
      return verify(welcome->server_key, server_transcript(hello, *welcome, binding),
                    welcome->signature);
    };
    CHECK(holds_on(of_attacker.binding()));
    CHECK_FALSE(holds_on(of_victim.binding()));
    CHECK_FALSE(holds_on(std::nullopt));
  }
  RawClient honest(server->port());
  CHECK(honest.join(2).has_value());
}

TEST_CASE("a client without TLS is told that the server needs it", "[integration][tls]") {
  const TempFolder folder;
  const auto server = start_server(quiet_config(folder / "world"), flat_creation());
  RawClient plain(server->port(), INADDR_LOOPBACK, RawClient::Encryption::none);
  plain.send(plain.hello(1));
  const auto goodbye = plain.goodbye();
  REQUIRE(goodbye.has_value());
  CHECK(goodbye->reason == GoodbyeReason::wrong_protocol);
  CHECK(goodbye->text == "this server speaks TLS 1.3 only");
}

TEST_CASE("a server without TLS serves clients without it and no others", "[integration][tls]") {
  const TempFolder folder;
  const auto server = start_server(insecure_config(folder / "world"), flat_creation());
  RawClient plain(server->port(), INADDR_LOOPBACK, RawClient::Encryption::none);
  CHECK(plain.join(1).has_value());
  RawClient encrypted(server->port());
  CHECK_FALSE(encrypted.is_open());
}

TEST_CASE("a server without TLS listens on this machine alone, unless its operator knows",
          "[integration][tls]") {
  const TempFolder folder;
  ServerConfig config = insecure_config(folder / "world");
  config.listen = "0.0.0.0:0";
  CHECK_THAT(start_error(config), Catch::Matchers::Contains("insecure is for this machine only"));
  CHECK_FALSE(std::filesystem::exists(folder / "world"));
  config.i_know = true;
  CHECK(start_error(config).empty());
}

TEST_CASE("a connection that breaks TLS ends, and others go on", "[integration][tls]") {
  const TempFolder folder;
  const auto server = start_server(quiet_config(folder / "world"), flat_creation());
  RawClient honest(server->port()), broken(server->port());
  REQUIRE(honest.join(1).has_value());
  REQUIRE(broken.join(2).has_value());
  SECTION("bytes that are no records") { broken.send_to_socket(Bytes(1'000, 0x55)); }
  SECTION("a frame without encryption") {
    Bytes frame;
    FrameWriter().append(encode_message(Ping{1}), frame);
    broken.send_to_socket(frame);
  }
  CHECK(broken.sees_the_end());
  honest.send(Ping{1});
  CHECK(honest.next_of<Pong>().has_value());
}

TEST_CASE("a certificate of an authority is shown, and a renewed one after a reload",
          "[integration][tls]") {
  const TempFolder folder;
  const PemFiles first("server.example"), renewed("server.example");
  ServerConfig config = quiet_config(folder / "world");
  config.tls_certificate = folder / "chain.pem";
  config.tls_key = folder / "key.pem";
  const auto install = [&](const PemFiles& files) {
    const auto replace = std::filesystem::copy_options::overwrite_existing;
    std::filesystem::copy_file(files.chain_file(), config.tls_certificate, replace);
    std::filesystem::copy_file(files.key_file(), config.tls_key, replace);
    ::chmod(config.tls_key.c_str(), S_IRUSR | S_IWUSR);
  };
  install(first);
  const auto server = start_server(config, flat_creation());
  const auto joins = [&](const PemFiles& trusted) {
    const auto context = TlsContext::client_of_authorities(trusted.authority_file());
    REQUIRE(context);
    RawClient client(server->port(), INADDR_LOOPBACK, RawClient::Encryption::tls, *context,
                     "server.example");
    return client.is_open() && client.join(1).has_value();
  };
  CHECK(joins(first));
  CHECK_FALSE(joins(renewed));
  install(renewed);
  CHECK(reload(*server, config).is_ok);
  CHECK(joins(renewed));
  CHECK_FALSE(joins(first));
  std::ofstream(config.tls_certificate) << "nonsense";
  const auto refused = reload(*server, config);
  CHECK_FALSE(refused.is_ok);
  CHECK_THAT(refused.lines, Catch::Matchers::Contains("the certificate: no start line"));
  CHECK(joins(renewed));
}

TEST_CASE("a certificate that cannot be used stops the start before the world is made",
          "[integration][tls]") {
  const TempFolder folder;
  const PemFiles made("server.example"), other("other.example");
  ServerConfig config = quiet_config(folder / "world");
  config.tls_certificate = made.chain_file();
  std::string expected;
  SECTION("no key") { expected = "tls_certificate and tls_key: one of them is missing"; }
  SECTION("a key that is not there") {
    config.tls_key = folder / "nothing.pem";
    expected = "nothing.pem: cannot be read: No such file";
  }
  SECTION("a key without end") {
    config.tls_key = "/dev/zero";
    expected = "tls_key = /dev/zero: is a device";
  }
  SECTION("a certificate that is a folder") {
    config.tls_certificate = folder.path();
    config.tls_key = made.key_file();
    expected = folder.path() + ": is a folder";
  }
  SECTION("another certificate's key") {
    config.tls_key = other.key_file();
    expected = "the secret key is not that of the certificate";
  }
  SECTION("a key that every user can read") {
    config.tls_key = made.key_file();
    ::chmod(config.tls_key.c_str(), S_IRUSR | S_IROTH);
    expected = "every user of this machine can read the secret key";
  }
  CHECK_THAT(start_error(config), Catch::Matchers::Contains(expected));
  CHECK_FALSE(std::filesystem::exists(config.world));
}

TEST_CASE("an address that connects too often is refused before its handshake",
          "[integration][tls]") {
  const TempFolder folder;
  ServerConfig config = quiet_config(folder / "world");
  config.connections_per_second = 1;  // ten at once
  const auto server = start_server(config, flat_creation());
  constexpr std::uint32_t kOther = INADDR_LOOPBACK + 1;
  bool was_refused = false;
  for (int i = 0; i < 1'000 && !was_refused; ++i)
    was_refused = !RawClient(server->port(), kOther).is_open();
  CHECK(was_refused);
  RawClient honest(server->port());
  CHECK(honest.join(1).has_value());
}

TEST_CASE("an address whose clients break rules may connect less often", "[integration][tls]") {
  const TempFolder folder;
  ServerConfig config = quiet_config(folder / "world");
  config.connections_per_second = 1;  // ten at once
  const auto server = start_server(config, flat_creation());
  constexpr std::uint32_t kOther = INADDR_LOOPBACK + 1;
  // Each connection pays for itself, and once more for the rule, so five use up what ten may cost.
  // Meanwhile the budget refills by a connection a second.
  const TimeUs began_us = steady_now_us();
  bool was_refused = false;
  int accepted = 0;
  while (!was_refused && accepted < 1'000) {
    RawClient client(server->port(), kOther);
    was_refused = !client.is_open();
    if (was_refused) break;
    ++accepted;
    client.send(ClientAuth{});  // before hello
    const auto goodbye = client.goodbye();
    REQUIRE(goodbye);
    REQUIRE(goodbye->reason == GoodbyeReason::unexpected_message);
  }
  const auto seconds = static_cast<int>((steady_now_us() - began_us) / 1'000'000);
  CHECK(was_refused);
  CHECK(accepted <= 6 + seconds / 2);
  RawClient honest(server->port());
  CHECK(honest.join(1).has_value());
}

}  // namespace
}  // namespace runstone::test
