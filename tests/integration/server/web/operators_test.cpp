// The page for operators: a browser, the gateway and the server, with browsers that mean harm.
#include <array>
#include <catch2/catch.hpp>
#include <memory>
#include <string>

#include "tests/integration/server/app/session_messages.hpp"
#include "tests/integration/server/web/web_bench.hpp"
#include "tests/support/core/text_contains.hpp"
#include "tests/support/net/web_player.hpp"

namespace runstone::test {
namespace {

constexpr const char* kName = "player7";

ServerConfig page_server_config(const TempFolder& folder) {
  ServerConfig config = server_config_of(folder);
  config.operators_page = true;
  return config;
}
WebConfig page_web_config(const TempFolder& folder) {
  WebConfig config = web_config_of(folder);
  config.operators_page = true;
  return config;
}

/// A world in which player7 is a moderator and player8 a builder, and a browser.
struct OperatorBench {
  OperatorBench() : web(page_server_config(folder), page_web_config(folder)) {
    for (const std::uint8_t who : std::array<std::uint8_t, 2>{7, 8}) {
      WebPlayer player(web.port());
      REQUIRE(player.join(who).has_value());
      if (who != 7) continue;
      View view;
      view.number = 1;
      player.send(view);
      REQUIRE(player.next_of<ViewState>().has_value());
      player.send(voxel_edit(1, {1, 2, 3}, 2));  // the log knows the player from here on
      REQUIRE(player.next_of<Commit>().has_value());
    }
    REQUIRE(reaches(folder / "world", 1));
    const CommandAnswer granted = give("grant player7 moderator");
    INFO(granted.text);
    REQUIRE(granted.is_ok);
  }
  CommandAnswer give(const std::string& line) { return web.server->answer_of(line); }
  std::string new_link() {
    const CommandAnswer made = give(std::string("page link ") + kName);
    INFO(made.text);
    REQUIRE(made.is_ok);
    const std::size_t at = made.text.find("?link=");
    REQUIRE(at != std::string::npos);
    return made.text.substr(at + 6, 64);
  }
  std::string own_origin() const {
    return "Origin: http://127.0.0.1:" + std::to_string(web.port()) + "\r\n";
  }
  std::string cookie() const { return token.empty() ? "" : "Cookie: " + token + "\r\n"; }
  HttpReply get(const std::string& target) {
    WebPeer peer(web.port());
    return peer.request("GET", "/operators/" + target, cookie());
  }
  HttpReply post(const std::string& target, const std::string& form, const std::string& headers,
                 const std::string& type = "application/x-www-form-urlencoded") {
    WebPeer peer(web.port());
    peer.send("POST /operators/" + target + " HTTP/1.1\r\nHost: " + peer.host() +
              "\r\nContent-Type: " + type + "\r\nContent-Length: " + std::to_string(form.size()) +
              "\r\n" + headers + "\r\n" + form);
    return peer.reply();
  }
  HttpReply post(const std::string& target, const std::string& form) {
    return post(target, form, own_origin() + cookie());
  }
  /// Enters with a new link, and keeps the cookie and the key of the forms.
  void enter() {
    const HttpReply entered = post("enter", "link=" + new_link());
    REQUIRE(entered.status == 303);
    const std::string set = entered.header("Set-Cookie");
    token = set.substr(0, set.find(';'));
    const HttpReply page = get("");
    REQUIRE(page.status == 200);
    const std::string mark = "name=\"form\" value=\"";
    key = page.body.substr(page.body.find(mark) + mark.size(), 64);
  }
  HttpReply order(const std::string& fields) { return post("do", "form=" + key + "&" + fields); }

  const TempFolder folder;
  WebBench web;
  std::string token, key;
};

TEST_CASE("an operator enters by a link once, looks, acts under the own name, and leaves",
          "[integration]") {
  OperatorBench bench;
  const std::string link = bench.new_link();
  const HttpReply offer = bench.get("enter?link=" + link);
  CHECK(offer.status == 200);  // a look uses no link up
  CHECK(contains(offer.body, "<form method=\"post\" action=\"enter\">"));
  CHECK(contains(offer.header("Content-Security-Policy"), "frame-ancestors 'none'"));
  CHECK(contains(offer.header("Content-Security-Policy"), "form-action 'self'"));
  CHECK_FALSE(contains(offer.header("Content-Security-Policy"), "script-src"));
  CHECK(offer.header("X-Frame-Options") == "DENY");
  CHECK(offer.header("Cache-Control") == "no-store");
  CHECK(offer.header("Referrer-Policy") == "same-origin");
  const HttpReply entered = bench.post("enter", "link=" + link);
  REQUIRE(entered.status == 303);
  const std::string set = entered.header("Set-Cookie");
  CHECK(contains(set, "; Path=/; HttpOnly; SameSite=Strict"));
  CHECK_FALSE(contains(set, link));
  const HttpReply again = bench.post("enter", "link=" + link);
  CHECK(again.status == 403);
  CHECK(again.header("Set-Cookie").empty());

  bench.enter();
  const HttpReply status = bench.get("");
  CHECK(contains(status.body, kName));
  CHECK(contains(status.body, "sessions "));
  CHECK(contains(status.body, "href=\"./bans\""));
  CHECK_FALSE(contains(status.body, "href=\"./roles\""));  // a moderator gives no roles
  CHECK_FALSE(contains(status.body, "<script"));
  for (const char* section : {"bans", "log", "log?author=player8&limit=5", "rollback", "command"}) {
    CAPTURE(section);
    CHECK(bench.get(section).status == 200);
  }
  CHECK(contains(bench.get("log?author=player8&limit=5").body, "no edit matches"));
  CHECK(bench.get("nothing").status == 404);
  CHECK(bench.get("picture?id=../../p1&which=before").status == 404);

  const HttpReply banned = bench.order("action=restrict&kind=ban&who=player8&reason=dug+here");
  CHECK(banned.status == 200);
  CHECK(contains(banned.body, "ban &quot;player8&quot; reason &quot;dug here&quot;"));
  const std::string bans = bench.give("bans").text;
  CHECK(contains(bans, "player8"));
  CHECK(contains(bans, kName));  // the record is the operator's
  CHECK(contains(bench.get("bans").body, "dug here"));
  // A right that the operator lacks, as for the same command in a client.
  CHECK(contains(bench.order("action=command&line=role+default+visitor").body,
                 "this command needs the right administer"));
  CHECK(contains(bench.order("action=command&line=backup+x").body, "for the console"));
  const HttpReply hostile = bench.order("action=command&line=%3Cscript%3Ealert(1)%3C%2Fscript%3E");
  CHECK_FALSE(contains(hostile.body, "<script"));
  CHECK(contains(hostile.body, "&lt;script&gt;"));
  CHECK(bench.order("action=restrict&kind=ban&who=a%22+anyway").status == 400);
  CHECK(bench.order("action=restrict&kind=stop&who=a").status == 400);

  CHECK(bench.post("leave", "form=" + bench.key).status == 200);
  CHECK(bench.get("").status == 401);
  CHECK(contains(bench.give("page list").text, "2 page player7"));  // of the first link
}

TEST_CASE("no other page can make an operator's browser act", "[integration]") {
  OperatorBench bench;
  bench.enter();
  const std::string ban = "form=" + bench.key + "&action=restrict&kind=ban&who=player8";
  const std::string cookie = bench.cookie();
  const auto status = [&](const std::string& headers, const std::string& form,
                          const std::string& type = "application/x-www-form-urlencoded") {
    return bench.post("do", form, headers, type).status;
  };
  CHECK(status(cookie, ban) == 403);
  CHECK(status("Origin: null\r\n" + cookie, ban) == 403);
  CHECK(status("Origin: https://evil.example\r\n" + cookie, ban) == 403);
  CHECK(status("Origin: http://127.0.0.1:1\r\n" + cookie, ban) == 403);
  CHECK(status(bench.own_origin() + bench.own_origin() + cookie, ban) == 403);
  CHECK(status(bench.own_origin() + "Sec-Fetch-Site: cross-site\r\n" + cookie, ban) == 403);
  CHECK(status(bench.own_origin() + cookie, ban, "text/plain") == 415);
  CHECK(status(bench.own_origin() + cookie,
               "form=" + std::string(64, '0') + "&action=restrict&kind=ban&who=player8") == 403);
  CHECK(status(bench.own_origin() + cookie, "action=restrict&kind=ban&who=player8") == 403);
  CHECK(status(bench.own_origin() + cookie, ban + "&who=player7") == 400);
  CHECK(status(bench.own_origin() + cookie, ban + "%ff") == 400);
  CHECK(status(bench.own_origin(), ban) == 401);
  CHECK(bench.get("do?" + ban).status == 404);
  {
    WebPeer peer(bench.web.port());
    peer.send("POST /operators/do HTTP/1.1\r\nHost: " + peer.host() +
              "\r\nContent-Length: 10485760\r\n" + bench.own_origin() + cookie + "\r\n");
    CHECK(peer.reply().status == 413);
    WebPeer other(bench.web.port());
    other.send("POST /status HTTP/1.1\r\nHost: " + other.host() +
               "\r\nContent-Length: 5\r\n\r\n12345");
    CHECK(other.reply().status == 413);
  }
  CHECK_FALSE(contains(bench.give("bans").text, "player8"));
  CHECK(contains(bench.order("action=restrict&kind=ban&who=player8").body, "banned"));
}

TEST_CASE("the page ends with the role, with the token, and while the server restarts",
          "[integration]") {
  OperatorBench bench;
  bench.enter();
  bench.web.server.reset();
  CHECK(bench.get("").status == 503);
  CHECK(bench.order("action=kick&who=player8").status == 503);
  bench.web.server = start_server(page_server_config(bench.folder), flat_creation());
  CHECK(bench.get("bans").status == 200);  // the token outlives the server
  REQUIRE(bench.give("revoke player7").is_ok);
  CHECK(bench.get("bans").status == 403);
  CHECK(bench.order("action=restrict&kind=ban&who=player8").status == 403);
  REQUIRE(bench.give("grant player7 moderator").is_ok);
  CHECK(bench.get("bans").status == 200);
  REQUIRE(bench.give("ban player7").is_ok);
  CHECK(bench.get("bans").status == 403);
  REQUIRE(bench.give("unban player7").is_ok);
  REQUIRE(bench.give("page revoke all").is_ok);
  const HttpReply gone = bench.get("bans");
  CHECK(gone.status == 401);
  CHECK(contains(gone.header("Set-Cookie"), "Max-Age=0"));
}

TEST_CASE("an address that guesses links or cookies is slowed down", "[integration]") {
  OperatorBench bench;
  const std::string name = "runstone-operators-" + std::to_string(bench.web.port());
  CHECK(bench.get("").status == 401);
  bench.token = "runstone-operators-1=" + std::string(64, 'a');  // of another gateway
  CHECK(bench.get("").status == 401);
  int refused = 0;
  for (int i = 0; i < 30; ++i) {
    bench.token = name + "=" + std::string(63, 'a') + static_cast<char>('0' + i % 10);
    const int status = i % 2 == 0 ? bench.get("").status
                                  : bench.post("enter", "link=" + std::string(64, 'b')).status;
    refused += status == 429 ? 1 : 0;
    CHECK((status == 401 || status == 403 || status == 429));
  }
  CHECK(refused >= 1);
}

TEST_CASE("the page is off by default, and never on an open address without a certificate",
          "[integration]") {
  const TempFolder folder;
  {
    const WebBench off(folder);
    WebPeer peer(off.port());
    CHECK(peer.get("/operators/").status == 404);
    CHECK(contains(off.server->answer_of("page link #1").text, "operators_page turns it on"));
    const auto on = start_gateway(page_web_config(folder));
    WebPeer asks(on->port());
    CHECK(asks.get("/operators/").status == 401);
    WebPeer enters(on->port());
    const std::string form = "link=" + std::string(64, 'b');
    enters.send("POST /operators/enter HTTP/1.1\r\nHost: " + enters.host() + "\r\nOrigin: http://" +
                enters.host() + "\r\nContent-Type: application/x-www-form-urlencoded\r\n" +
                "Content-Length: " + std::to_string(form.size()) + "\r\n\r\n" + form);
    CHECK(enters.reply().status == 503);
  }
  WebConfig open = page_web_config(folder);
  open.listen = "0.0.0.0:0";
  open.i_know = true;
  const auto started = WebGateway::start(open);
  REQUIRE_FALSE(started.has_value());
  CHECK(contains(started.error(), "operators_page"));
  ServerConfig config = page_server_config(folder);
  config.gateway_socket.clear();
  const auto server = Server::start(config, flat_creation());
  REQUIRE_FALSE(server.has_value());
  CHECK(contains(server.error(), "needs the setting gateway_socket"));
}

}  // namespace
}  // namespace runstone::test
