#include "server/web/client_files.hpp"

#include <catch2/catch.hpp>
#include <fstream>

#include "server/web/http_answer.hpp"
#include "tests/support/core/temp_folder.hpp"

using namespace runstone;
using runstone::test::TempFolder;

namespace {

void write(const TempFolder& folder, const std::string& name, const std::string& text) {
  std::ofstream(folder.path() + "/" + name, std::ios::binary) << text;
}

void write_all(const TempFolder& folder) {
  for (const char* name : {"client.html", "client.css", "client.js", "program.js", "typing.js",
                           "keys.js", "database.js", "chunks.js", "textures.js", "ticker.js",
                           "runstone-web-client.js", "runstone-web-client.wasm", "DejaVuSans.ttf"})
    write(folder, name, std::string("plain ") + name);
  write(folder, "client.js.gz", "gzip client.js");
  write(folder, "client.js.br", "brotli client.js");
  write(folder, "secret.txt", "not for browsers");
}

HttpAnswer get(const ClientFiles& files, const HttpRequest& request) {
  return answer_request(request, {{}, files, {}, {}});
}

}  // namespace

TEST_CASE("the files of the client have the smallest form that the browser accepts", "[web]") {
  const TempFolder folder;
  write_all(folder);
  const auto files = ClientFiles::load(folder.path());
  REQUIRE(files.has_value());
  const auto form = [&](std::string_view accepted) {
    const HttpAnswer answer = get(*files, {"GET", "/client/client.js", accepted});
    CHECK(answer.status == 200);
    CHECK(answer.type == "text/javascript; charset=utf-8");
    return std::pair(answer.encoding, std::string(answer.bytes()));
  };
  CHECK(form("gzip, deflate, br") == std::pair<std::string, std::string>("br", "brotli client.js"));
  CHECK(form("gzip") == std::pair<std::string, std::string>("gzip", "gzip client.js"));
  CHECK(form("br;q=0, gzip;q=0.5") ==
        std::pair<std::string, std::string>("gzip", "gzip client.js"));
  CHECK(form("") == std::pair<std::string, std::string>("", "plain client.js"));
  CHECK(form("brotli") == std::pair<std::string, std::string>("", "plain client.js"));
  CHECK(get(*files, {"GET", "/client/runstone-web-client.wasm"}).type == "application/wasm");
  CHECK(get(*files, {"GET", "/client/"}).bytes() == "plain client.html");
}

TEST_CASE("a browser that has the file already gets no second copy", "[web]") {
  const TempFolder folder;
  write_all(folder);
  const auto files = ClientFiles::load(folder.path());
  REQUIRE(files.has_value());
  const HttpAnswer first = get(*files, {"GET", "/client/client.js", "br"});
  CHECK(first.caching == HttpCaching::while_unchanged);
  const HttpAnswer again = get(*files, {"GET", "/client/client.js", "br", first.tag});
  CHECK(again.status == 304);
  CHECK(again.bytes().empty());
  const HttpAnswer plain = get(*files, {"GET", "/client/client.js", "", first.tag});
  CHECK(plain.status == 200);  // it has another form
  write(folder, "client.js.br", "brotli client.jt");
  const auto changed = ClientFiles::load(folder.path());
  REQUIRE(changed.has_value());
  CHECK(get(*changed, {"GET", "/client/client.js", "br", first.tag}).status == 200);
}

TEST_CASE("only the files of the client are served, and only if there is one", "[web]") {
  const TempFolder folder;
  write_all(folder);
  const auto files = ClientFiles::load(folder.path());
  REQUIRE(files.has_value());
  for (const char* target : {"/client/secret.txt", "/client/../secret.txt", "/client/client.js.br",
                             "/client/files", "/client//client.js", "/client/client.html"}) {
    CAPTURE(target);
    CHECK(get(*files, {"GET", target}).status == 404);
  }
  CHECK(get(*files, {"GET", "/client"}).location == "client/");
  CHECK(get(*files, {"POST", "/client/"}).status == 405);
  CHECK(get({}, {"GET", "/client/"}).status == 404);
  CHECK(get({}, {"GET", "/client"}).status == 404);
  CHECK(get(*files, {"GET", "/"}).bytes().find("href=\"client/\"") != std::string_view::npos);
  CHECK(get({}, {"GET", "/"}).bytes().find("client/") == std::string_view::npos);
}

TEST_CASE("the client may run its own code, the map a script, and no other page any", "[web]") {
  const auto policy = [](PageScripts scripts, const std::string& sockets = "") {
    for (const auto& [name, value] : safety_headers(scripts, sockets)) {
      if (name == "Content-Security-Policy") return value;
    }
    return std::string();
  };
  CHECK(policy(PageScripts::none).find("script-src") == std::string::npos);
  CHECK(policy(PageScripts::own).find("script-src 'self';") != std::string::npos);
  CHECK(policy(PageScripts::client).find("script-src 'self' 'wasm-unsafe-eval';") !=
        std::string::npos);
  CHECK(policy(PageScripts::client).find("'unsafe-inline'") == std::string::npos);
  CHECK(policy(PageScripts::client).find("connect-src 'self';") != std::string::npos);
  const std::string other = " wss://other.example";
  CHECK(policy(PageScripts::client, other).find("connect-src 'self' wss://other.example;") !=
        std::string::npos);
  for (const PageScripts scripts : {PageScripts::none, PageScripts::own})
    CHECK(policy(scripts, other) == policy(scripts));
  const TempFolder folder;
  write_all(folder);
  const auto files = ClientFiles::load(folder.path());
  REQUIRE(files.has_value());
  CHECK(get(*files, {"GET", "/client/"}).scripts == PageScripts::client);
  CHECK(get(*files, {"GET", "/map"}).scripts == PageScripts::own);
  CHECK(get(*files, {"GET", "/"}).scripts == PageScripts::none);
  CHECK(get(*files, {"GET", "/status"}).scripts == PageScripts::none);
}

TEST_CASE("a folder without the client is named when the gateway starts", "[web]") {
  const TempFolder folder;
  const auto files = ClientFiles::load(folder.path());
  REQUIRE_FALSE(files.has_value());
  CHECK(files.error() == folder.path() + "/client.html: cannot be read: No such file or directory");
}
