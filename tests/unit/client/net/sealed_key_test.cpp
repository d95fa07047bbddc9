#include "client/net/sealed_key.hpp"

#include <catch2/catch.hpp>
#include <string>

namespace runstone::test {
namespace {

constexpr SealCost kCheap{1, 8};
constexpr const char* kPassphrase = "correct horse battery";

KeySeed some_seed() {
  KeySeed seed{};
  for (std::size_t i = 0; i < seed.size(); ++i) seed[i] = static_cast<std::uint8_t>(i + 1);
  return seed;
}

std::string sealed() {
  const auto line = seal_key(some_seed(), kPassphrase, kCheap);
  REQUIRE(line.has_value());
  return *line;
}

std::string error_of(const std::string& line, const std::string& passphrase = kPassphrase) {
  const auto opened = open_sealed_key(line, passphrase);
  REQUIRE_FALSE(opened.has_value());
  return opened.error();
}

}  // namespace

TEST_CASE("a sealed key is opened with its passphrase and no other", "[client][key]") {
  const std::string line = sealed();
  CHECK(line.find_first_of(" \n\r") == std::string::npos);
  CHECK(*open_sealed_key(line, kPassphrase) == some_seed());
  CHECK(*open_sealed_key("  " + line + "\r\n", kPassphrase) == some_seed());
  CHECK(error_of(line, "correct horse batterz") ==
        "the passphrase is wrong, or the exported key is damaged");
  CHECK(sealed() != line);  // salt and nonce are random
}

TEST_CASE("a line of version 1 stays readable", "[client][key][golden]") {
  CHECK(
      *open_sealed_key("runstone-key-1:AQEAAAAIAAAAznulxzTmep6IWPopleCtco1MLwDxER0y5HvQo2WLVDWJ5xbO"
                       "QHyzfW8lj+2sz7y1m52LP8SDkYcIsBw5sb4/q7A2Qot2oOGvVy5MIIoij0n7/WnYwfCawg==",
                       kPassphrase) == some_seed());
}

TEST_CASE("a damaged line is refused", "[client][key]") {
  const std::string line = sealed();
  for (std::size_t size = 0; size < line.size(); ++size) error_of(line.substr(0, size));
  error_of(line + "A");
  error_of(line + line);
  for (std::size_t at = 0; at < line.size(); ++at) {
    std::string changed = line;
    changed[at] = changed[at] == 'B' ? 'C' : 'B';
    CAPTURE(at);
    // A changed cost is refused at once, or makes another key. Only those of the first bytes of the
    // operations and the memory may still be within the bounds.
    CHECK_FALSE(open_sealed_key(changed, kPassphrase).has_value());
  }
}

TEST_CASE("a line that asks for too much memory or time is refused at once", "[client][key]") {
  // Version 1; the costs; the rest is zeros.
  const auto line = [](const std::string& head) {
    return "runstone-key-1:" + head + std::string(132 - head.size() - 4, 'A') + "AA==";
  };
  const std::string expected = "the exported key is damaged, or asks for too much memory or time";
  CHECK(error_of(line("AQEAAAD///9/")) == expected);  // 2 TiB
  CHECK(error_of(line("Af///38IAAAA")) == expected);  // 2^31 operations
  CHECK(error_of(line("AQAAAAAIAAAA")) == expected);  // no operations
  CHECK(error_of(line("AgEAAAAIAAAA")) == expected);  // version 2
  CHECK(error_of(line("AQEAAAAIAAAA")) ==
        "the passphrase is wrong, or the exported key is damaged");
}

}  // namespace runstone::test
