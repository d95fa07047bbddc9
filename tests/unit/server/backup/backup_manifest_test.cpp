// The text of a manifest of a backup.
#include "server/backup/backup_manifest.hpp"

#include <catch2/catch.hpp>
#include <sstream>

#include "common/core/hex.hpp"

namespace runstone::test {
namespace {

BackupManifest sample_manifest() {
  BackupManifest manifest;
  manifest.world[0] = 0xab;
  manifest.taken_us = 1'795'000'000'000'000;
  manifest.epoch = 7;
  manifest.seq = 400;
  manifest.new_bytes = 40'000;
  const Bytes block{1, 2, 3};
  const BlockHash hash = hash_of_block(block);
  manifest.files = {{"server.toml", 3, {hash}},
                    {"world of mine.sqlite", kBlockBytes + 1, {hash, hash_of_block({})}},
                    {"world.durable", 0, {}}};
  return manifest;
}

/// Reads the text without its blocks.
Result<BackupManifest, std::string> sizes_of(const std::string& text) {
  std::istringstream in(text);
  return read_manifest_sizes(in);
}

/// Returns the text with the hash at its end made anew.
std::string with_right_end(std::string text) {
  text.resize(text.rfind("end "));
  const Bytes bytes(text.begin(), text.end());
  return text + "end " + to_hex(hash_of_block(bytes)) + "\n";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("a manifest has the text that the documents describe", "[backup]") {
  // BLAKE2b of 256 bits, computed by another program (Python's hashlib).
  const std::string block = "11c0e79b71c3976ccd0c02d1310e2516c08edc9d8b6f57ccd680d63a4d8e72da";
  const std::string none = "0e5751c026e543b2e8ab2eb06099daa1d1e5df47778f7787faab45cdf12fe3a8";
  const std::string text = manifest_text(sample_manifest());
  CHECK(text.substr(0, text.rfind("end ")) ==
        "runstone backup 1\n"
        "world ab000000000000000000000000000000\n"
        "taken 1795000000000000\n"
        "moment 7 400\n"
        "new 40000\n"
        "file 3 server.toml\n"
        "block " +
            block +
            "\n"
            "file 32769 world of mine.sqlite\n"
            "block " +
            block +
            "\n"
            "block " +
            none +
            "\n"
            "file 0 world.durable\n");
  CHECK(text == with_right_end(text));
  const auto back = parse_manifest(text);
  REQUIRE(back.has_value());
  CHECK(*back == sample_manifest());
  CHECK(back->bytes() == 3 + kBlockBytes + 1);
}

TEST_CASE("the sizes and the head of a manifest are those of all of it", "[backup]") {
  const std::string text = manifest_text(sample_manifest());
  BackupManifest expected = sample_manifest();
  for (BackedUpFile& file : expected.files) file.blocks.clear();
  const auto sizes = sizes_of(text);
  REQUIRE(sizes.has_value());
  CHECK(*sizes == expected);
  expected.files.clear();
  CHECK(parse_manifest_head(text) == expected);
  const std::size_t head_bytes = text.find("file 3");
  CHECK(parse_manifest_head(text.substr(0, head_bytes)) == expected);
  for (std::size_t bytes = 0; bytes < head_bytes; ++bytes) {
    CAPTURE(bytes);
    CHECK_FALSE(parse_manifest_head(text.substr(0, bytes)).has_value());
  }
}

TEST_CASE("a manifest that is cut off or changed is refused", "[backup]") {
  const std::string text = manifest_text(sample_manifest());
  for (std::size_t bytes = 0; bytes < text.size(); ++bytes) {
    CAPTURE(bytes);
    REQUIRE_FALSE(parse_manifest(text.substr(0, bytes)).has_value());
    REQUIRE_FALSE(sizes_of(text.substr(0, bytes)).has_value());
  }
  for (std::size_t i = 0; i < text.size(); ++i) {
    CAPTURE(i);
    std::string changed = text;
    changed[i] = static_cast<char>(changed[i] ^ 1);
    // A digit of the last hash in the other case is the same hash; bit 0 does not change the case.
    REQUIRE_FALSE(parse_manifest(changed).has_value());
    REQUIRE_FALSE(sizes_of(changed).has_value());
  }
  CHECK_FALSE(parse_manifest(text + "\n").has_value());
  CHECK_FALSE(sizes_of(text + "\n").has_value());
  CHECK(sizes_of(replaced(text, "backup 1", "backup 2")).error() ==
        "is of a newer version of Runstone");
  CHECK(sizes_of("dear diary\n").error() == "is no manifest of a backup");
  CHECK(sizes_of(replaced(text, "server.toml", std::string(1'000, 'a'))).error() == "is damaged");
  CHECK(parse_manifest(replaced(text, "backup 1", "backup 2")).error() ==
        "is of a newer version of Runstone");
  CHECK(parse_manifest("dear diary").error() == "is no manifest of a backup");
}

TEST_CASE("a manifest whose hash is right and whose lines are wrong is refused", "[backup]") {
  const std::string text = manifest_text(sample_manifest());
  REQUIRE(parse_manifest(with_right_end(text)).has_value());
  const std::pair<const char*, const char*> changes[] = {{"world ab", "world "},
                                                         {"taken 1", "taken x"},
                                                         {"moment 7 400", "moment 7"},
                                                         {"new 40000\n", ""},
                                                         {"file 3 server", "file 3 ../server"},
                                                         {"file 3 server.toml", "file 3 .."},
                                                         {"file 3 server.toml", "file 3 "},
                                                         {"file 3 ", "file 32769 "},
                                                         {"file 0 ", "file 1 "},
                                                         {"block 11", "block 1"},
                                                         {"block 11", "brick 11"},
                                                         {"new 40000", "new -1"}};
  for (const auto& [from, to] : changes) {
    CAPTURE(from, to);
    CHECK_FALSE(parse_manifest(with_right_end(replaced(text, from, to))).has_value());
    CHECK_FALSE(sizes_of(with_right_end(replaced(text, from, to))).has_value());
  }
}

TEST_CASE("the name of a backup is its time, and sorts by it", "[backup]") {
  CHECK(backup_name(1'795'000'000'000'000) == "20261118T110640Z");
  CHECK(backup_name(1'795'000'000'999'999) == "20261118T110640Z");
  CHECK(time_of_backup("20261118T110640Z") == std::optional<TimeUs>(1'795'000'000'000'000));
  for (const char* bad : {"", "20261118", "20261118T110640", "2026-11-18T11:06:40Z",
                          "20261318T110640Z", "20261118T110640Zx", "20261118T110640.5Z"}) {
    CAPTURE(bad);
    CHECK_FALSE(time_of_backup(bad).has_value());
  }
}

}  // namespace runstone::test
