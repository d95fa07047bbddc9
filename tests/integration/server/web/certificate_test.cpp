#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>

#include "server/web/certificate.hpp"
#include "tests/integration/server/web/web_bench.hpp"
#include "tests/support/net/web_player.hpp"
#include "tests/support/tls/pem_files.hpp"

namespace runstone::test {
namespace {

/// The files of a gateway's certificate, which a test replaces.
class CertificateFiles {
 public:
  CertificateFiles() : chain(folder_ / "chain.pem"), key(folder_ / "key.pem") {}
  /// Replaces both files, as a program that renews certificates does.
  void become(const PemFiles& other) {
    write(chain, other.chain());
    write(key, other.key());
  }
  static void write(const std::string& file, const std::string& text) {
    const std::string fresh = file + ".new";
    std::ofstream(fresh, std::ios::binary) << text;
    REQUIRE(::chmod(fresh.c_str(), 0600) == 0);
    std::filesystem::rename(fresh, file);
  }

 private:
  TempFolder folder_;

 public:
  const std::string chain, key;
};

/// Returns true if new connections have a certificate that this authority has signed.
bool gets_certificate_of(std::uint16_t port, const PemFiles& pem) {
  const auto context = TlsContext::client_of_authorities(pem.authority_file());
  REQUIRE(context.has_value());
  const WebPeer peer(port, INADDR_LOOPBACK, true, *context, "localhost");
  return peer.is_open();
}

bool comes_to_have_certificate_of(std::uint16_t port, const PemFiles& pem) {
  for (int i = 0; i < 300; ++i) {
    if (gets_certificate_of(port, pem)) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return false;
}

/// Asks over TLS until the metrics have the text.
bool metrics_come_to_show(std::uint16_t port, const std::string& text) {
  for (int i = 0; i < 300; ++i) {
    WebPeer peer(port, INADDR_LOOPBACK, true);
    if (peer.get("/metrics").body.find(text) != std::string::npos) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return false;
}

struct SecureBench {
  explicit SecureBench(const TempFolder& folder) : first("localhost"), second("localhost") {
    files.become(first);
    WebConfig config = web_config_of(folder);
    config.tls_certificate = files.chain;
    config.tls_key = files.key;
    server = start_server(server_config_of(folder), flat_creation());
    gateway = start_gateway(config);
  }
  const PemFiles first, second;
  CertificateFiles files;
  std::unique_ptr<Server> server;
  std::unique_ptr<WebGateway> gateway;
};

TEST_CASE("a certificate is replaced without an end of connections", "[integration]") {
  const TempFolder folder;
  SecureBench bench(folder);
  const std::uint16_t port = bench.gateway->port();
  WebPlayer player(port, INADDR_LOOPBACK, true);
  REQUIRE(player.join(1).has_value());
  CHECK(gets_certificate_of(port, bench.first));
  CHECK_FALSE(gets_certificate_of(port, bench.second));
  bench.files.become(bench.second);
  SECTION("when the operator says so") { bench.gateway->reload_certificate(); }
  SECTION("when the files have changed") {}
  CHECK(comes_to_have_certificate_of(port, bench.second));
  CHECK_FALSE(gets_certificate_of(port, bench.first));
  player.send(Ping{5});
  CHECK(player.next_of<Pong>().has_value());
  CHECK(metrics_come_to_show(port, "\nrunstone_web_certificates_read 1\n"));
}

TEST_CASE("a certificate that cannot be used is refused, and the old one stays", "[integration]") {
  const TempFolder folder;
  SecureBench bench(folder);
  const std::uint16_t port = bench.gateway->port();
  WebPlayer player(port, INADDR_LOOPBACK, true);
  REQUIRE(player.join(1).has_value());
  std::string chain = bench.second.chain(), key = bench.second.key();
  SECTION("a broken chain") { chain.resize(chain.size() / 4); }
  SECTION("no chain") { chain.clear(); }
  SECTION("the key of another certificate") { key = bench.first.key(); }
  SECTION("no key") { key = "secret\n"; }
  SECTION("a certificate that has ended") {
    const PemFiles ended("localhost", -2 * PemFiles::kDaySeconds, -60);
    chain = ended.chain();
    key = ended.key();
  }
  SECTION("a certificate that is not valid yet") {
    const PemFiles early("localhost", PemFiles::kDaySeconds, 2 * PemFiles::kDaySeconds);
    chain = early.chain();
    key = early.key();
  }
  CertificateFiles::write(bench.files.chain, chain);
  CertificateFiles::write(bench.files.key, key);
  bench.gateway->reload_certificate();
  CHECK(metrics_come_to_show(port, "\nrunstone_web_certificates_refused 1\n"));
  CHECK(gets_certificate_of(port, bench.first));
  player.send(Ping{5});
  CHECK(player.next_of<Pong>().has_value());
  bench.files.become(bench.second);  // the next try is a good one
  CHECK(comes_to_have_certificate_of(port, bench.second));
}

TEST_CASE("a certificate that has ended is taken at the start, and its fault is known",
          "[integration]") {
  const PemFiles ended("localhost", -2 * PemFiles::kDaySeconds, -60), next("localhost");
  CertificateFiles files;
  files.become(ended);
  auto certificate = Certificate::read(files.chain, files.key);
  REQUIRE(certificate.has_value());
  CHECK(certificate->fault() ==
        "tls_certificate = \"" + files.chain + "\": the certificate has ended");
  files.become(next);
  REQUIRE(certificate->reload().has_value());
  CHECK_FALSE(certificate->fault().has_value());
}

TEST_CASE("a key that others can read is refused until its rights are mended", "[integration]") {
  const TempFolder folder;
  SecureBench bench(folder);
  const std::uint16_t port = bench.gateway->port();
  bench.files.become(bench.second);
  REQUIRE(::chmod(bench.files.key.c_str(), 0644) == 0);
  bench.gateway->reload_certificate();
  CHECK(metrics_come_to_show(port, "\nrunstone_web_certificates_refused 1\n"));
  CHECK(gets_certificate_of(port, bench.first));
  REQUIRE(::chmod(bench.files.key.c_str(), 0600) == 0);
  CHECK(comes_to_have_certificate_of(port, bench.second));
}

}  // namespace
}  // namespace runstone::test
