#include "server/admin/config_reload.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>

using namespace runstone;

TEST_CASE("a reload takes what a running server may change, and names the rest", "[config]") {
  ServerConfig running;
  ServerConfig read = running;
  CHECK(reload_config(running, read).text() == "nothing has changed");
  read.log_level = LogLevel::debug;
  read.idle_s = 30;
  read.operators.insert(PublicKey{1, 2, 3});
  read.peer_address = "one.example";
  read.listen = "127.0.0.1:1";
  read.memory_mib = 64;
  const ConfigReload reloaded = reload_config(running, read);
  CHECK(reloaded.text() ==
        "reloaded: log_level, idle_s, operators; after a restart: peer_address, listen, "
        "memory_mib");
  ServerConfig expected = running;
  expected.log_level = LogLevel::debug;
  expected.idle_s = 30;
  expected.operators = read.operators;
  CHECK(reloaded.config == expected);

  const ConfigReload back = reload_config(reloaded.config, running);
  CHECK(back.taken == std::vector<std::string>{"log_level", "idle_s", "operators"});
  CHECK(back.waiting.empty());
  CHECK(back.config == running);
}

TEST_CASE("the reference lists the settings that are reloaded, and no other", "[config]") {
  std::ifstream in(RUNSTONE_SOURCE_DIR "/docs/server-reference.md");
  const std::string page((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const std::size_t begin = page.find("A reload takes");
  REQUIRE(begin != std::string::npos);
  const std::string list = page.substr(begin, page.find(".\n", begin) - begin);
  for (const SettingField& field : config_fields()) {
    CAPTURE(field.name);
    CHECK((list.find("`" + field.name + "`") != std::string::npos) == is_reloaded(field.name));
  }
}
