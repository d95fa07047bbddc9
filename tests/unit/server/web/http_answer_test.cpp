#include "server/web/http_answer.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <memory>
#include <vector>

#include "server/web/web_pages.hpp"

using namespace runstone;

namespace {

ServerStatus running_server() {
  ServerStatus out;
  out.is_up = true;
  out.counters = {{"sessions", 2}, {"seq", 9120}, {"durable", 9118}};
  out.players = {"ana", "<script>alert(1)</script>"};
  return out;
}

/// Answers with the pages of a gateway without a client.
HttpAnswer answer(const HttpRequest& request, const ServerStatus& server = running_server(),
                  const WebConfig& config = {}, const WebCounters& web = {},
                  std::string_view recent_edits = {}) {
  return answer_request(request, {config, {}, server, web, recent_edits});
}
HttpAnswer get(const std::string& target, const ServerStatus& server = running_server(),
               const WebConfig& config = {}) {
  return answer({"GET", target}, server, config);
}

bool has(const HttpAnswer& answer, const std::string& text) {
  return answer.body.find(text) != std::string::npos;
}

}  // namespace

TEST_CASE("the page of the world names it, its players and the way in", "[web]") {
  WebConfig config;
  config.title = "Valley & town";
  config.public_address = "play.example.org:4747";
  const HttpAnswer answer = get("/?from=mail", running_server(), config);
  CHECK(answer.status == 200);
  CHECK(answer.type == "text/html; charset=utf-8");
  CHECK(has(answer, "<h1>Valley &amp; town</h1>"));
  CHECK(has(answer, "<li>ana</li>"));
  CHECK(has(answer, "href=\"runstone://play.example.org:4747\""));
  config.public_address = "play.example.org";
  CHECK(has(get("/", running_server(), config), "href=\"runstone://play.example.org:4747\""));
  CHECK(has(answer, "href=\"status\""));
  CHECK(has(answer, "no client for the browser"));
}

TEST_CASE("names of players are text on every page, never tags", "[web]") {
  for (const char* target : {"/", "/status"}) {
    const HttpAnswer answer = get(target);
    CHECK_FALSE(has(answer, "<script"));
    CHECK(has(answer, "&lt;script&gt;alert(1)&lt;/script&gt;"));
  }
  CHECK(html_text("<a href=\"x\" title='y'>&") ==
        "&lt;a href=&quot;x&quot; title=&#39;y&#39;&gt;&amp;");
}

TEST_CASE("the pages load nothing from elsewhere and need no script", "[web]") {
  for (const char* target : {"/", "/status"}) {
    const HttpAnswer answer = get(target);
    CHECK_FALSE(has(answer, "<script"));
    CHECK_FALSE(has(answer, "http://"));
    CHECK_FALSE(has(answer, "https://"));
    CHECK_FALSE(has(answer, "style="));  // the policy forbids styles within tags
    CHECK(has(answer, "href=\"style.css\""));
  }
  CHECK(get("/style.css").body.find("url(") == std::string::npos);
  CHECK(get("/style.css").caching == HttpCaching::an_hour);
  CHECK(get("/").caching == HttpCaching::none);
}

TEST_CASE("the page of the map has the title of the world as text", "[web]") {
  WebConfig config;
  config.world = "world";
  config.title = "A & {title}";
  const HttpAnswer answer = get("/map", running_server(), config);
  CHECK(answer.status == 200);
  CHECK(has(answer, "<title>A &amp; {title}: map</title>"));
  CHECK(has(answer, "<h1><a href=\"./\">A &amp; {title}</a></h1>"));
  for (const char* file : {"map.js", "map.css"}) {
    CHECK(has(answer, file));
    std::ifstream in(std::string(RUNSTONE_SOURCE_DIR) + "/server/web/page/" + file,
                     std::ios::binary);
    CHECK(get(std::string("/") + file).body == std::string(std::istreambuf_iterator<char>(in), {}));
  }
}

TEST_CASE("a page says in words that the server is not running", "[web]") {
  ServerStatus down;
  down.why = "Connection refused";
  for (const char* target : {"/", "/status"}) {
    const HttpAnswer answer = get(target, down);
    CHECK(answer.status == 200);
    CHECK(has(answer, "not running, or it is restarting"));
    CHECK_FALSE(has(answer, "Connection refused"));  // it is for the host
    CHECK_FALSE(has(answer, "Nobody is in this world"));
  }
  CHECK(has(get("/metrics", down), "runstone_up 0"));
  CHECK_FALSE(has(get("/metrics", down), "runstone_sessions"));
}

TEST_CASE("the state shows how long edits wait, and the metrics have the same as a histogram",
          "[web]") {
  ServerStatus server = running_server();
  server.counters["edit_wait_count"] = 10;
  server.counters["edit_wait_us"] = 250'000;
  server.counters["edit_wait_ms_le_20"] = 9;
  server.counters["edit_wait_ms_le_5"] = 6;
  server.counters["edit_wait_ms_le_x"] = 6;
  const HttpAnswer page = get("/status", server);
  CHECK(has(page, "up to 5 ms</th><td><meter min=\"0\" max=\"100\" value=\"60\">"));
  CHECK(has(page, "30 %</meter></td><td>3</td>"));  // more than 5 ms, up to 20
  CHECK(has(page, "longer</th><td><meter min=\"0\" max=\"100\" value=\"10\">"));
  const HttpAnswer metrics = get("/metrics", server);
  CHECK(has(metrics, "runstone_edit_wait_seconds_bucket{le=\"0.005\"} 6\n"));
  CHECK(has(metrics, "runstone_edit_wait_seconds_bucket{le=\"+Inf\"} 10\n"));
  CHECK(has(metrics, "runstone_edit_wait_seconds_sum 0.25\n"));
}

TEST_CASE("the state lists the newest edits as text", "[web]") {
  const auto page_of = [](const char* json) {
    return answer({"GET", "/status"}, running_server(), {}, {}, json).body;
  };
  const std::string page =
      page_of(R"([{"time":"now","author":"<b>ana","what":"voxel 1 2 3 := stone","seq":7}])");
  CHECK(page.find("&lt;b&gt;ana") != std::string::npos);
  CHECK(page.find("voxel 1 2 3 := stone") != std::string::npos);
  for (const char* other : {"", "[]", "{}", "[1]", "nonsense", "[{\"time\":3}]"})
    CHECK(page_of(other).find("<h1>") != std::string::npos);
  CHECK(page_of("nonsense").find("Newest edits") == std::string::npos);
}

TEST_CASE("a long list of players is cut and counted", "[web]") {
  ServerStatus crowd = running_server();
  crowd.players.assign(1'000, "p");
  CHECK(has(get("/", crowd), "and 800 more"));
}

TEST_CASE("the metrics are those of server and gateway", "[web]") {
  WebCounters web;
  web.frames_in = 77;
  const HttpAnswer metrics = answer({"GET", "/metrics"}, running_server(), {}, web);
  CHECK(metrics.type == "text/plain; version=0.0.4; charset=utf-8");
  CHECK(has(metrics, "\nrunstone_seq 9120\n"));
  CHECK(has(metrics, "\nrunstone_up 1\n"));
  CHECK(has(metrics, "\nrunstone_web_frames_in 77\n"));
  CHECK(has(metrics, "# TYPE runstone_seq gauge"));
}

TEST_CASE("paths come from a table, so no path leads out of it", "[web]") {
  for (const char* target :
       {"/../etc/passwd", "/..%2f..%2fetc/passwd", "//etc/passwd", "/status/", "/Status", "",
        "status", "*", "http://127.0.0.1/status", "/./", "/style.css/../../x", "/\\..\\x"}) {
    CAPTURE(target);
    CHECK(get(target).status == 404);
    CHECK_FALSE(shows_status(target));
  }
  CHECK(shows_status("/"));
  CHECK(shows_status("/metrics?a=/../b"));
  CHECK_FALSE(shows_status("/style.css"));
}

TEST_CASE("other methods than GET and HEAD are refused with words", "[web]") {
  const HttpAnswer posted = answer({"POST", "/"});
  CHECK(posted.status == 405);
  CHECK(posted.allow == "GET, HEAD");
  CHECK(answer({"HEAD", "/"}).status == 200);
  CHECK(get("/play").status == 426);
}

TEST_CASE("a gateway with several servers lists their worlds", "[web]") {
  WebConfig config;
  config.title = "Our worlds";
  const auto up = std::make_shared<const ServerStatus>(running_server());
  const auto down = std::make_shared<const ServerStatus>();
  const std::vector<WorldStatus> worlds = {{"valley", "The <valley>", up},
                                           {"hills", "Hills", down}};
  const WebCounters web;
  const auto ask = [&](const std::string& target) {
    return answer_gateway_request({"GET", target}, {config, worlds, web});
  };
  const HttpAnswer list = ask("/");
  CHECK(list.status == 200);
  CHECK(has(list, "<h1>Our worlds</h1>"));
  CHECK(has(list, "<a href=\"world/valley/\">The &lt;valley&gt;</a>: 2 players"));
  CHECK(has(list, "<a href=\"world/hills/\">Hills</a>: not running now"));
  const HttpAnswer status = ask("/status");
  CHECK(has(status, "href=\"world/valley/status\""));
  CHECK(has(status, "This gateway"));
  const HttpAnswer metrics = ask("/metrics");
  CHECK(has(metrics, "runstone_up{world=\"valley\"} 1\n"));
  CHECK(has(metrics, "runstone_up{world=\"hills\"} 0\n"));
  CHECK(has(metrics, "runstone_seq{world=\"valley\"} 9120\n"));
  CHECK(has(metrics, "\nrunstone_web_frames_in 0\n"));
  CHECK(ask("/world/valley").location == "valley/");
  CHECK(ask("/style.css").status == 200);
  for (const char* target : {"/play", "/client/", "/map"}) {
    CHECK(ask(target).status == 404);
    CHECK(has(ask(target), "choose one at /"));
  }
  for (const char* target : {"/world/", "/world/nowhere", "/world/val", "/map/state.json"})
    CHECK(has(ask(target), "there is no such page"));
}

TEST_CASE("the state of one of several worlds leads to that of the gateway", "[web]") {
  const WebConfig config;
  const ClientFiles client;
  const WebCounters web;
  const ServerStatus server = running_server();
  PageContents contents{config, client, server, web};
  contents.world_name = "valley";
  const HttpAnswer status = answer_request({"GET", "/status"}, contents);
  CHECK(has(status, "href=\"../../status\""));
  CHECK_FALSE(has(status, "This gateway"));
  CHECK(answer_request({"GET", "/metrics"}, contents).status == 404);
}
