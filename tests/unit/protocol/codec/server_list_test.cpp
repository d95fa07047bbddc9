// Which addresses of servers and pages are valid, and which lists of servers are refused.
#include "protocol/codec/server_list.hpp"

#include <string>
#include <utility>
#include <vector>

#include "tests/unit/protocol/codec/built_message.hpp"

namespace runstone::test {
namespace {

struct EntryFields {
  std::string address = "a.example:4747", page = "https://a.example";
  bool has_page = true;
};

struct ServersFields {
  std::vector<EntryFields> servers = {{"a.example:4747"}, {"b.example:4747"}};
  std::uint8_t here = 2;
  Offset<wire::Servers> operator()(FlatBufferBuilder& b) const {
    std::vector<Offset<wire::ServerEntry>> rows;
    for (const EntryFields& entry : servers) {
      const auto address = b.CreateString(entry.address);
      const auto page = entry.has_page ? b.CreateString(entry.page) : Offset<flatbuffers::String>();
      rows.push_back(wire::CreateServerEntry(b, address, page, 7));
    }
    return wire::CreateServers(b, b.CreateVector(rows), here);
  }
};

/// Returns addresses in ascending order.
std::vector<EntryFields> many(std::size_t count) {
  std::vector<EntryFields> out;
  for (std::size_t i = 0; i < count; ++i)
    out.push_back({"host" + std::to_string(1'000 + i) + ":1", "", false});
  return out;
}

}  // namespace

TEST_CASE("an address of players is a host and a port", "[protocol]") {
  const std::string longest = std::string(kServerAddressBytesMax - 2, 'a') + ":1";
  for (const std::string& good :
       {std::string("a:1"), std::string("play.example.org:65535"), std::string("my_host-2:4747"),
        std::string("192.0.2.7:4747"), std::string("[2001:db8::7]:4747"), std::string("[::1]:1"),
        std::string("[::ffff:192.0.2.7]:80"), longest}) {
    CAPTURE(good);
    CHECK(is_player_address(good));
  }
  for (const std::string& bad : {std::string(),
                                 std::string("a"),
                                 std::string(":1"),
                                 std::string("a:"),
                                 std::string("a:0"),
                                 std::string("a:65536"),
                                 std::string("a:1x"),
                                 std::string("a:+1"),
                                 std::string("a b:1"),
                                 std::string("a\n:1"),
                                 std::string("h\xc3\xb6st:1"),
                                 std::string("a/b:1"),
                                 std::string("u@a:1"),
                                 std::string("2001:db8::7"),
                                 std::string("2001:db8::7:4747"),
                                 std::string("[2001:db8::7]"),
                                 std::string("[]:1"),
                                 std::string("[a]:1"),
                                 std::string("[:"),
                                 std::string("[::1:1"),
                                 std::string("[fe80::1%eth0]:1"),
                                 "a" + longest}) {
    CAPTURE(bad);
    CHECK_FALSE(is_player_address(bad));
  }
}

TEST_CASE("an address of a page is empty, or a URL with nothing but a host, a port and a path",
          "[protocol]") {
  const std::string longest = "https://" + std::string(kServerAddressBytesMax - 8, 'a');
  for (const std::string& good :
       {std::string(), std::string("https://play.example.org"),
        std::string("http://localhost:8080"), std::string("https://[::1]:8443/world/valley/"),
        std::string("https://[::1]"), std::string("https://a/x.y_z~1-2"), longest}) {
    CAPTURE(good);
    CHECK(is_page_address(good));
  }
  for (const std::string& bad :
       {std::string("play.example.org"), std::string("https://"), std::string("https:///play"),
        std::string("ftp://a"), std::string("javascript:alert"), std::string("https://a:0"),
        std::string("https://a:"), std::string("https://a?x=1"), std::string("https://a/#x"),
        std::string("https://u@a/"), std::string("https://a/ b"), std::string("https://a/\""),
        std::string("HTTPS://a"), longest + "a"}) {
    CAPTURE(bad);
    CHECK_FALSE(is_page_address(bad));
  }
}

TEST_CASE("a list of servers is refused with a bad entry", "[protocol]") {
  refuses<Servers, ServersFields>({
      [](auto& m) { m.servers[0].address = ""; },
      [](auto& m) { m.servers[0].address = "a.example"; },
      [](auto& m) { m.servers[0].address = "a.example:0"; },
      [](auto& m) { m.servers[1].page = "b.example"; },
      [](auto& m) { m.servers[1].page = "https://" + std::string(kServerAddressBytesMax, 'b'); },
      [](auto& m) { m.servers[0].address = m.servers[1].address; },
      [](auto& m) { std::swap(m.servers[0], m.servers[1]); },
      [](auto& m) { m.here = 3; },
      [](auto& m) { m.servers = many(kServersMax + 1); },
  });
}

TEST_CASE("a list of servers may be empty or full, and name no sender", "[protocol]") {
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, kServersMax}) {
    ServersFields fields{many(count), 0};
    CHECK(passes<Servers>(fields));
    fields.here = static_cast<std::uint8_t>(count);
    const auto read = received<Servers>(fields);
    REQUIRE(read.has_value());
    CHECK(std::get<Servers>(*read).here == count);
    CHECK(std::get<Servers>(*read).servers.size() == count);
    CHECK(decode(encode_message(*read)).value() == *read);
  }
}

TEST_CASE("a list is seen from one of its servers, and the others are the rest", "[protocol]") {
  const Servers list{{{"a:1"}, {"b:1"}, {"c:1"}}, 0};
  CHECK(others_of(list) == list.servers);
  const Servers from_b = seen_from(list, "b:1");
  CHECK(from_b.here == 2);
  CHECK(others_of(from_b) == std::vector<ServerEntry>{{"a:1"}, {"c:1"}});
  CHECK(seen_from(from_b, "d:1").here == 0);
  CHECK(others_of(seen_from({{{"a:1"}}, 0}, "a:1")).empty());
}

TEST_CASE("the WebSocket of a page is beside it", "[protocol]") {
  CHECK(web_socket_path("") == "/play");
  CHECK(web_socket_path("/") == "/play");
  CHECK(web_socket_path("/world/valley") == "/world/valley/play");
  CHECK(web_socket_path("/world/valley/") == "/world/valley/play");
}

}  // namespace runstone::test
