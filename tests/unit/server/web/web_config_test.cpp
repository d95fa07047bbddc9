#include "server/web/web_config.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("the settings of the gateway survive being printed and read", "[web]") {
  WebConfig config;
  config.title = "Ana's \"valley\" \\ town";
  config.sockets_max = 77;
  config.i_know = true;
  config.origins = "https://play.example.org";
  WebConfig read;
  const auto done = web_settings().read_toml(read, web_settings().to_toml(config), "web.toml");
  INFO((done ? std::string() : done.error().message()));
  REQUIRE(done.has_value());
  CHECK(read == config);
}

TEST_CASE("several servers are sections of the file", "[web]") {
  const std::string toml =
      "title = \"Our worlds\"\n[server.valley]\ngateway_socket = \"valley/web.sock\"\n"
      "title = \"Our valley\"\nworld = \"valley\"\n"
      "[server.hills-2]\ngateway_socket = \"hills/web.sock\"\n";
  WebConfig config;
  REQUIRE(read_web_toml(config, toml, "web.toml").has_value());
  REQUIRE(config.servers.size() == 2);
  CHECK(config.servers[0] == WebServer{"hills-2", "hills/web.sock", "", "", ""});
  CHECK(config.servers[1] == WebServer{"valley", "valley/web.sock", "Our valley", "", "valley"});
  CHECK(config_for(config, config.servers[0]).title == "hills-2");
  CHECK(config_for(config, config.servers[1]).world == "valley");
  WebConfig again;
  REQUIRE(read_web_toml(again, to_web_toml(config), "web.toml").has_value());
  CHECK(again == config);
}

TEST_CASE("a wrong section names its line", "[web]") {
  const auto error_of = [](const std::string& toml) {
    WebConfig config;
    const auto read = read_web_toml(config, toml, "web.toml");
    REQUIRE_FALSE(read.has_value());
    CHECK(config == WebConfig());
    return read.error().message();
  };
  CHECK(error_of("[server.a]\ntitle = \"A\"") == "web.toml:1: server.a: gateway_socket is missing");
  CHECK(error_of("[server.\"../a\"]\ngateway_socket = \"a\"").find("1 to 32 characters") !=
        std::string::npos);
  CHECK(error_of("[server.a]\ngateway_socket = \"a\"\nlisten = \"b\"").find("no such setting") !=
        std::string::npos);
  CHECK(error_of("[server.a]\ngateway_socket = \"x\"\n[server.b]\ngateway_socket = \"x\"")
            .find("is that of the server a") != std::string::npos);
  CHECK(error_of("world = \"w\"\n[server.a]\ngateway_socket = \"a\"")
            .find("belong into the sections") != std::string::npos);
  CHECK(error_of("server = 3").find("must be a section: [server.NAME]") != std::string::npos);
  CHECK(error_of("[servers.a]\ngateway_socket = \"a\"").find("no such setting") !=
        std::string::npos);
}

TEST_CASE("a wrong setting of the gateway names its line and changes nothing", "[web]") {
  const auto error_of = [](const std::string& toml) {
    WebConfig config;
    const auto read = web_settings().read_toml(config, toml, "web.toml");
    REQUIRE_FALSE(read.has_value());
    CHECK(config == WebConfig());
    return read.error().message();
  };
  CHECK(error_of("title = \"a\"\nsocket_max = 4").find("web.toml:2: socket_max: no such") == 0);
  CHECK(error_of("idle_s = 1").find("out of range") != std::string::npos);
  CHECK(error_of("idle_s = -5").find("must be a whole number") != std::string::npos);
  CHECK(error_of("idle_s = \"60\"").find("must be a whole number") != std::string::npos);
  CHECK(error_of("title = \"\"").find("must not be empty") != std::string::npos);
  CHECK(error_of("title = \"a\\nb\"").find("one line") != std::string::npos);
  CHECK(error_of("title = ").find("web.toml:1: ") == 0);
}

TEST_CASE("settings of the gateway come from variables and flags", "[web]") {
  CHECK(flag_name("sockets_per_address") == "--sockets-per-address");
  CHECK(web_settings().variable("idle_s") == "RUNSTONE_WEB_IDLE_S");
  WebConfig config;
  // The others are those of the server.
  REQUIRE(web_settings()
              .read_environment(config, {{"RUNSTONE_WEB_IDLE_S", "90"},
                                         {"RUNSTONE_IDLE_S", "x"},
                                         {"RUNSTONE_IDEL_S", "x"}})
              .has_value());
  CHECK(config.idle_s == 90);
  CHECK_FALSE(web_settings().set(config, "idle_s", "9 0").has_value());
  CHECK_FALSE(web_settings().set(config, "no_such_setting", "x").has_value());
  REQUIRE(web_settings().set(config, "i_know", "true").has_value());
  CHECK(config.i_know);
  for (const SettingField& field : web_settings().fields()) CHECK_FALSE(field.help.empty());
}

TEST_CASE("a variable of the gateway with a typing mistake is refused", "[web]") {
  WebConfig config;
  const auto read = web_settings().read_environment(config, {{"RUNSTONE_WEB_TITEL", "x"}});
  REQUIRE_FALSE(read.has_value());
  CHECK(read.error() ==
        "RUNSTONE_WEB_TITEL: no setting has this variable of the environment; did you mean "
        "RUNSTONE_WEB_TITLE?");
}

TEST_CASE("the public address is that of a server, and the world a place", "[web]") {
  WebConfig config;
  const auto address = web_settings().set(config, "public_address", "https://play.example.org/");
  REQUIRE_FALSE(address.has_value());
  CHECK(address.error().find("; write play.example.org") != std::string::npos);
  const auto world = web_settings().set(config, "world", "postgre://ana:secret@h/d");
  REQUIRE_FALSE(world.has_value());
  CHECK(world.error().find("secret") == std::string::npos);
  for (const char* wrong : {"public_address = \"https://h/\"", "world = \"mysql://h/d\""}) {
    CAPTURE(wrong);
    const std::string toml = std::string("[server.a]\ngateway_socket = \"a\"\n") + wrong;
    CHECK_FALSE(read_web_toml(config, toml, "web.toml").has_value());
  }
  CHECK(config == WebConfig());
  CHECK(web_settings().set(config, "public_address", "play.example.org").has_value());
  CHECK(web_settings().set(config, "public_address", "").has_value());
  CHECK(web_settings().set(config, "world", "postgresql://h/d").has_value());
  CHECK(web_settings().set(config, "world", "valley").has_value());
}
