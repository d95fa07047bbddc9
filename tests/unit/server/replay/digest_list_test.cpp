#include "server/replay/digest_list.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <limits>

#include "common/os/output_file.hpp"
#include "tests/support/core/temp_folder.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

DigestList sample_list() {
  DigestList list;
  for (std::size_t i = 0; i < list.world_id.size(); ++i)
    list.world_id[i] = static_cast<std::uint8_t>(17 * i);
  list.seq = 9120;
  list.chunks = {{{0, {1, 0, -3}}, {2, 9120}, {{0x1234, 0x1ffffffffffffffe}}},
                 {{0, {-2, 5, 7}}, {1, 3}, {{1, 2}}}};
  return list;
}

// These bytes are frozen: clients and servers of other builds write and read them.
constexpr const char* kGolden =
    R"({"world_id":"00112233445566778899aabbccddeeff","seq":9120,"chunks":[
{"lod":0,"x":-2,"y":5,"z":7,"epoch":1,"seq":3,"digest":"00000000000000010000000000000002"},
{"lod":0,"x":1,"y":0,"z":-3,"epoch":2,"seq":9120,"digest":"00000000000012341ffffffffffffffe"}
]}
)";

bool same(const DigestList& a, const DigestList& b) { return to_json(a) == to_json(b); }

std::string key_of_error(const std::string& json) {
  const auto list = parse_digests_json(json, "list.json");
  if (list) return "no error";
  CHECK(list.error().file == "list.json");
  return list.error().key;
}

std::string with(const std::string& from, const std::string& to) {
  std::string json = kGolden;
  const auto at = json.find(from);
  REQUIRE(at != std::string::npos);
  return json.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("a digest list has golden bytes, with the chunks in the order of their keys",
          "[store][digest-list]") {
  CHECK(to_json(sample_list()) == kGolden);
  const auto read = parse_digests_json(kGolden, "list.json");
  REQUIRE(read.has_value());
  CHECK(read->world_id == sample_list().world_id);
  CHECK(read->seq == 9120);
  REQUIRE(read->chunks.size() == 2);
  CHECK(read->chunks[0].key == ChunkKey{0, {-2, 5, 7}});
  CHECK(read->chunks[0].version == Version{1, 3});
  CHECK(read->chunks[1].digest == Digest{{0x1234, 0x1ffffffffffffffe}});
}

TEST_CASE("the extremes of every field survive a round trip", "[store][digest-list]") {
  DigestList list;
  constexpr auto kLow = std::numeric_limits<std::int32_t>::min();
  constexpr auto kHigh = std::numeric_limits<std::int32_t>::max();
  list.seq = std::numeric_limits<Sequence>::max();
  list.chunks = {{{255, {kLow, kHigh, 0}}, {std::numeric_limits<Epoch>::max(), list.seq}, {}}};
  const auto read = parse_digests_json(to_json(list), "");
  REQUIRE(read.has_value());
  CHECK(same(*read, list));
  CHECK(parse_digests_json(to_json(DigestList{}), "").has_value());
}

TEST_CASE("every truncation of a digest list and every extra byte is rejected",
          "[store][digest-list]") {
  const std::string json = kGolden;
  for (std::size_t length = 0; length + 1 < json.size(); ++length) {
    CAPTURE(length);
    CHECK_FALSE(parse_digests_json(json.substr(0, length), "").has_value());
  }
  for (const char extra : {'}', ',', '0', '"', 'x'})
    CHECK_FALSE(parse_digests_json(json + extra, "").has_value());
}

TEST_CASE("the error names the wrong field of a digest list", "[store][digest-list]") {
  CHECK(key_of_error("[]").empty());
  CHECK(key_of_error(with("\"world_id\"", "\"world\"")) == "world_id");
  CHECK(key_of_error(with("0011", "001")) == "world_id");
  CHECK(key_of_error(with("eeff", "EEFF")) == "world_id");
  CHECK(key_of_error(with("9120,\"chunks\"", "-1,\"chunks\"")) == "seq");
  CHECK(key_of_error(with("9120,\"chunks\"", "1.5,\"chunks\"")) == "seq");
  CHECK(key_of_error(with("9120,\"chunks\"", "\"9\",\"chunks\"")) == "seq");
  CHECK(key_of_error(with("\"chunks\"", "\"chunk\"")) == "chunks");
  CHECK(key_of_error(with("\"lod\":0,\"x\":1", "\"lod\":256,\"x\":1")) == "chunks[1]");
  CHECK(key_of_error(with("\"x\":-2", "\"x\":2147483648")) == "chunks[0]");
  CHECK(key_of_error(with("\"x\":-2", "\"x\":-2147483649")) == "chunks[0]");
  CHECK(key_of_error(with("\"epoch\":1", "\"epoch\":4294967296")) == "chunks[0]");
  CHECK(key_of_error(with("\"epoch\":1", "\"epoch\":null")) == "chunks[0]");
  CHECK(key_of_error(with("1ffffffffffffffe", "1fffffffffffffff")) ==
        "chunks[1]");  // a lane is not below 2^61 - 1
  CHECK(key_of_error(with("1ffffffffffffffe", "1FFFFFFFFFFFFFFE")) == "chunks[1]");
  CHECK(key_of_error(with("0002\"", "002\"")) == "chunks[0]");
}

TEST_CASE("a digest list file is replaced as a whole, and unknown keys in it are ignored",
          "[store][digest-list]") {
  const TempFolder folder;
  const std::string file = folder / "list.json";
  REQUIRE(write_digests_json(file, DigestList{}).has_value());
  REQUIRE(write_digests_json(file, sample_list()).has_value());
  CHECK(same(*read_digests_json(file), sample_list()));
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
  REQUIRE(
      write_output_file(file, with("{\"world_id\"", "{\"more\":[1,{}],\"world_id\"")).has_value());
  CHECK(same(*read_digests_json(file), sample_list()));
  CHECK(read_digests_json(folder / "missing.json").error().message() ==
        folder / "missing.json: cannot be read: No such file or directory");
  CHECK(read_digests_json(folder.path()).error().message() == folder.path() + ": is a folder");
  CHECK(read_digests_json("/dev/zero").error().message().find("is a device") != std::string::npos);
  CHECK(write_digests_json(folder / "no/list.json", {}).error() ==
        folder / "no/list.json: cannot be written: No such file or directory");
}
