#include "common/tls/tls_channel.hpp"

#include <openssl/ssl.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <string>

#include "common/tls/self_signed_certificate.hpp"
#include "tests/support/tls/pem_files.hpp"

using namespace runstone;
using Status = TlsChannel::Status;

namespace {

std::array<std::uint8_t, 32> seed_of(std::uint8_t byte) {
  std::array<std::uint8_t, 32> seed{};
  seed.fill(byte);
  return seed;
}

/// The bytes that the other end has sent.
struct Wire final : TlsSource {
  Bytes bytes;
  std::size_t receive(std::span<std::uint8_t> into) override {
    const std::size_t count = std::min(into.size(), bytes.size());
    std::copy_n(bytes.begin(), count, into.begin());
    bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
    return count;
  }
};

/// Two ends with a wire in each direction.
struct Pair {
  explicit Pair(const TlsContext& of_server = TlsContext::self_signed_server(seed_of(1)),
                const TlsContext& of_client = TlsContext::client(),
                const std::string& host = "localhost")
      : server(TlsChannel::accept(of_server, to_server)),
        client(TlsChannel::connect(of_client, to_client, host)) {}

  /// Moves what both ends have to send.
  void carry() {
    to_server.bytes.insert(to_server.bytes.end(), client.output().begin(), client.output().end());
    to_client.bytes.insert(to_client.bytes.end(), server.output().begin(), server.output().end());
    client.output().clear();
    server.output().clear();
  }
  /// Returns how the handshake ended for the client and for the server.
  std::pair<Status, Status> shake_hands() {
    Status of_client = Status::wants_input, of_server = Status::wants_input;
    for (int round = 0; round < 4; ++round) {
      if (of_client == Status::wants_input) of_client = client.handshake();
      carry();
      if (of_server == Status::wants_input) of_server = server.handshake();
      carry();
    }
    return {of_client, of_server};
  }

  Wire to_server, to_client;
  TlsChannel server, client;
};

const std::pair<Status, Status> kBothDone = {Status::done, Status::done};

Bytes text_of(std::size_t bytes) {
  Bytes text(bytes);
  for (std::size_t i = 0; i < bytes; ++i) text[i] = static_cast<std::uint8_t>(i * 7);
  return text;
}

/// Reads all text that has arrived.
Bytes read_all(TlsChannel& channel) {
  Bytes text, buffer(100);
  std::size_t bytes = 0;
  while (channel.read(buffer, bytes) == Status::done)
    text.insert(text.end(), buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(bytes));
  return text;
}

}  // namespace

TEST_CASE("two ends exchange text of any size, in both directions") {
  Pair pair;
  REQUIRE(pair.shake_hands() == kBothDone);
  for (const std::size_t bytes : {1u, 100u, 16'384u, 16'385u, 100'000u}) {
    const Bytes text = text_of(bytes);
    REQUIRE(pair.client.write(text));
    REQUIRE(pair.server.write(text));
    pair.carry();
    CHECK(read_all(pair.server) == text);
    CHECK(read_all(pair.client) == text);
  }
}

TEST_CASE("a record costs the documented bytes, and none is larger than allowed") {
  Pair pair;
  REQUIRE(pair.shake_hands() == kBothDone);
  REQUIRE(pair.server.write(text_of(kTlsRecordBytesMax)));
  CHECK(pair.server.output().size() == kTlsRecordBytesMax + kTlsRecordExtraBytes);
  pair.server.output().clear();
  REQUIRE(pair.server.write(text_of(10)));
  CHECK(pair.server.output().size() == 10 + kTlsRecordExtraBytes);
}

TEST_CASE("both ends have the same binding, and another connection has another one") {
  Pair first, second;
  REQUIRE(first.shake_hands() == kBothDone);
  REQUIRE(second.shake_hands() == kBothDone);
  CHECK(first.client.binding() == first.server.binding());
  CHECK(second.client.binding() == second.server.binding());
  CHECK(first.client.binding() != second.client.binding());
}

TEST_CASE("a changed byte is never read as text") {
  Pair pair;
  REQUIRE(pair.shake_hands() == kBothDone);
  REQUIRE(pair.client.write(text_of(100)));
  pair.carry();
  pair.to_server.bytes[50] ^= 1;
  Bytes buffer(200);
  std::size_t bytes = 0;
  CHECK(pair.server.read(buffer, bytes) == Status::failed);
  CHECK_FALSE(pair.server.error().empty());
}

TEST_CASE("an orderly end is told from a broken connection") {
  Pair pair;
  REQUIRE(pair.shake_hands() == kBothDone);
  Bytes buffer(10);
  std::size_t bytes = 0;
  CHECK(pair.server.read(buffer, bytes) == Status::wants_input);
  pair.client.end();
  pair.carry();
  CHECK(pair.server.read(buffer, bytes) == Status::ended);
}

TEST_CASE("bytes that are no TLS fail with a reason") {
  Pair pair;
  const std::string http = "GET / HTTP/1.1\r\nHost: example\r\n\r\n";
  pair.to_server.bytes.assign(http.begin(), http.end());
  CHECK(pair.server.handshake() == Status::failed);
  CHECK(pair.server.error() == "http request");
}

TEST_CASE("an older version of TLS is refused") {
  const TlsContext old = TlsContext::client();
  REQUIRE(SSL_CTX_set_min_proto_version(old.get(), TLS1_2_VERSION) == 1);
  REQUIRE(SSL_CTX_set_max_proto_version(old.get(), TLS1_2_VERSION) == 1);
  Pair pair(TlsContext::self_signed_server(seed_of(1)), old);
  const auto [of_client, of_server] = pair.shake_hands();
  CHECK(of_server == Status::failed);
  CHECK(pair.server.error() == "unsupported protocol");
  CHECK(of_client == Status::failed);
}

TEST_CASE("the server's own certificate depends on its key alone and holds it") {
  const auto bytes_of = [](const CertificateWithKey& made) {
    Bytes der(static_cast<std::size_t>(i2d_X509(made.certificate.get(), nullptr)));
    std::uint8_t* into = der.data();
    i2d_X509(made.certificate.get(), &into);
    return der;
  };
  const auto first = self_signed_certificate(seed_of(1));
  CHECK(bytes_of(first) == bytes_of(self_signed_certificate(seed_of(1))));
  CHECK(bytes_of(first) != bytes_of(self_signed_certificate(seed_of(2))));
  CHECK(X509_verify(first.certificate.get(), first.key.get()) == 1);
}

TEST_CASE("a client of authorities accepts their certificates for the right name alone") {
  const test::PemFiles made("server.example");
  const auto server = TlsContext::server(made.chain(), made.key());
  REQUIRE(server);
  const auto client = TlsContext::client_of_authorities(made.authority_file());
  REQUIRE(client);
  Pair right(*server, *client, "server.example");
  CHECK(right.shake_hands() == kBothDone);
  Pair wrong(*server, *client, "other.example");
  CHECK(wrong.shake_hands().first == Status::failed);
  CHECK(wrong.client.error() == "certificate: hostname mismatch");
  Pair unknown(TlsContext::self_signed_server(seed_of(1)), *client, "server.example");
  CHECK(unknown.shake_hands().first == Status::failed);
  CHECK(unknown.client.error() == "certificate: self-signed certificate");
}

TEST_CASE("a server's certificate that cannot be used is refused with the reason") {
  const test::PemFiles made("server.example");
  const test::PemFiles other("other.example");
  const auto error_of = [](const std::string& chain, const std::string& key) {
    const auto context = TlsContext::server(chain, key);
    return context ? "" : context.error();
  };
  CHECK(error_of(made.chain(), made.key()).empty());
  CHECK(error_of("", made.key()) == "the certificate: no start line");
  CHECK(error_of(made.chain(), "") == "the secret key: unsupported");
  CHECK(error_of(made.chain(), other.key()) ==
        "the secret key is not that of the certificate: key values mismatch");
  CHECK_FALSE(TlsContext::client_of_authorities("/nowhere/authority.pem"));
  CHECK(TlsContext::client_of_authorities("/").error() ==
        "cannot read the authorities of /: it is a folder");
}
