#include "server/admin/server_config.hpp"

#include "server/admin/edit_budget_text.hpp"
#include "server/admin/operators.hpp"

#include <catch2/catch.hpp>
#include <map>

namespace runstone {
namespace {

TEST_CASE("the printed configuration reads back to an equal one", "[admin]") {
  ServerConfig config;
  config.world = "a \"quoted\\ folder";
  config.sessions_max = 7;
  config.encoding = ChunkEncoding::raw;
  config.log_level = LogLevel::warn;
  config.operators = {PublicKey{1}, PublicKey{0xab}};
  config.message_of_the_day = "build with \"care\", \\o/";
  ServerConfig read;
  REQUIRE(read_config_toml(read, to_toml(config), "printed").has_value());
  CHECK(read == config);
  CHECK(to_toml(read) == to_toml(config));
}

TEST_CASE("a builder budget has a name, or a rate and a burst", "[admin]") {
  ServerConfig config;
  CHECK(to_toml(config).find("builder_budget = \"normal\"") != std::string::npos);
  REQUIRE(set_config(config, "builder_budget", "large").has_value());
  CHECK(config.builder_budget == EditBudget{1'000, 40'000});
  REQUIRE(set_config(config, "builder_budget", "7/30").has_value());
  CHECK(config.builder_budget == EditBudget{7, 30});
  ServerConfig read;
  REQUIRE(read_config_toml(read, to_toml(config), "printed").has_value());
  CHECK(read == config);
  REQUIRE(set_config(config, "builder_budget", "unlimited").has_value());
  CHECK_FALSE(config.builder_budget.is_limited());
  for (const char* bad : {"", "huge", "7", "7/", "/30", "0/30", "7/0", "-7/30", "7/30/1", "7/30 ",
                          "1000001/30", "7/100000001", "99999999999999999999/1"}) {
    CAPTURE(bad);
    const auto set = set_config(config, "builder_budget", bad);
    REQUIRE_FALSE(set.has_value());
    CHECK(set.error().find(edit_budget_rule()) != std::string::npos);
    CHECK_FALSE(config.builder_budget.is_limited());
  }
  CHECK_FALSE(set_config(config, "budgets_per_address", "-1").has_value());
}

TEST_CASE("the message of the day is one line of chat, or nothing", "[admin]") {
  ServerConfig config;
  REQUIRE(set_config(config, "message_of_the_day", " build with care ").has_value());
  CHECK(config.message_of_the_day == "build with care");
  for (const std::string& bad : {std::string("   "), std::string("a\nb"), std::string(513, 'x')}) {
    const auto set = set_config(config, "message_of_the_day", bad);
    REQUIRE_FALSE(set.has_value());
    CHECK(set.error().find("must be one line of text: it ") != std::string::npos);
    CHECK(config.message_of_the_day == "build with care");
  }
  REQUIRE(set_config(config, "message_of_the_day", "").has_value());
  CHECK(config.message_of_the_day.empty());
}

TEST_CASE("every setting is printed on one line and has a help text", "[admin]") {
  std::size_t lines = 0;
  for (const char c : to_toml(ServerConfig{})) lines += c == '\n' ? 1 : 0;
  CHECK(lines == config_fields().size());
  for (const SettingField& field : config_fields()) CHECK_FALSE(field.help.empty());
}

TEST_CASE("names in file, environment and flags follow one rule", "[admin]") {
  CHECK(environment_name("sessions_max") == "RUNSTONE_SESSIONS_MAX");
  CHECK(flag_name("sessions_max") == "--sessions-max");
}

TEST_CASE("a file sets the fields that it names and no others", "[admin]") {
  ServerConfig config;
  REQUIRE(read_config_toml(config, "sessions_max = 3\nlisten = \"[::1]:0\"\n", "server.toml")
              .has_value());
  ServerConfig expected;
  expected.sessions_max = 3;
  expected.listen = "[::1]:0";
  CHECK(config == expected);
}

TEST_CASE("retention is set under a header of its own", "[admin][retention]") {
  ServerConfig config;
  CHECK(config.retention_days == 0);
  REQUIRE(read_config_toml(config, "[retention]\ndays = 30\n", "server.toml").has_value());
  CHECK(config.retention_days == 30);
  for (const char* wrong : {"-1", "36501", "30 days", "2099-01-01"})
    CHECK_FALSE(set_config(config, "retention_days", wrong).has_value());
  CHECK(config.retention_days == 30);
}

TEST_CASE("backups are set under a header of their own", "[admin]") {
  ServerConfig config;
  REQUIRE(read_config_toml(config,
                           "sessions_max = 3\n[backup]\nevery = \"6h\"\nfolder = \"/b\"\n"
                           "keep_hourly = 1\nkeep_daily = 2\nkeep_weekly = 3\n",
                           "server.toml")
              .has_value());
  ServerConfig expected;
  expected.sessions_max = 3;
  expected.backup_every_s = 21'600;
  expected.backup_folder = "/b";
  expected.backup_keep_hourly = 1;
  expected.backup_keep_daily = 2;
  expected.backup_keep_weekly = 3;
  CHECK(config == expected);
  ServerConfig printed;
  REQUIRE(read_config_toml(printed, to_toml(config), "server.toml").has_value());
  CHECK(printed == config);
  // All lines below the header may be comments.
  REQUIRE(read_config_toml(config, "[backup]\n#every = \"7h\"\n", "server.toml").has_value());
  CHECK(config == expected);
  const std::pair<const char*, const char*> durations[] = {
      {"0", "0"}, {"60s", "1m"}, {"90m", "90m"}, {"2d", "48h"}, {"61s", "61s"}, {"366d", "8784h"}};
  for (const auto& [text, back] : durations) {
    CAPTURE(text);
    REQUIRE(set_config(config, "backup_every", text).has_value());
    CHECK(config_text(config, "backup_every") == back);
  }
  for (const char* bad : {"", "6", "59s", "0s1", "often", "367d", "-1h", "6 h"}) {
    CAPTURE(bad);
    CHECK_FALSE(set_config(config, "backup_every", bad).has_value());
  }
}

TEST_CASE("errors in a file name file, line and key, and change nothing", "[admin]") {
  const auto error = [](const char* toml) {
    ServerConfig config;
    const auto read = read_config_toml(config, toml, "server.toml");
    REQUIRE_FALSE(read.has_value());
    CHECK(config == ServerConfig{});
    return read.error();
  };
  const TextError broken = error("sessions_max = 3\nworld = \"unfinished\n");
  CHECK(broken.file == "server.toml");
  CHECK(broken.line == 2);
  const TextError unknown = error("sessions_max = 3\n\nsession_max = 4\n");
  CHECK(unknown.line == 3);
  CHECK(unknown.key == "session_max");
  const TextError under = error("sessions_max = 3\n[backup]\nevry = \"6h\"\n");
  CHECK(under.line == 3);
  CHECK(under.key == "backup_evry");
  CHECK(under.what == "no such setting; did you mean backup_every?");
  CHECK(error("backup_every = \"6h\"\n[backup]\nevery = \"7h\"\n").what == "is there twice");
  CHECK(error("[bakcup]\n").key == "bakcup");
  CHECK(error("backup = {}\n").key == "backup");
  CHECK(error("[backup]\n[backup.deep]\n").key == "backup_deep");
  CHECK(error("[backup.deep]\nevery = \"6h\"\n").key == "backup_deep");
  CHECK(error("sessions_max = 0").what.find("1..65536") != std::string::npos);
  CHECK(error("sessions_max = -1").key == "sessions_max");
  CHECK(error("sessions_max = \"3\"").key == "sessions_max");
  CHECK(error("sessions_max = 1.5").key == "sessions_max");
  CHECK(error("world = 3").key == "world");
  CHECK(error("world = \"\"").key == "world");
  CHECK(error("encoding = \"zip\"").what == "must be packed, raw or coded");
  CHECK(error("log_level = \"loud\"").what == "must be debug, info, warn or error");
  CHECK(error("log_level = 3").key == "log_level");
}

TEST_CASE("the environment sets fields and its errors name the variable", "[admin]") {
  Environment environment{{"RUNSTONE_IO_THREADS", "8"}};
  // They are for other programs.
  for (const char* other :
       {"RUNSTONE_WEB_TITLE", "RUNSTONE_WEB_TITEL", "RUNSTONE_SERVER", "RUNSTONE_CLIENT",
        "RUNSTONE_BOT", "RUNSTONE_WEB", "RUNSTONE_READ_MODEL", "RUNSTONE_TEST_POSTGRES"})
    environment[other] = "x";
  ServerConfig config;
  REQUIRE(read_config_environment(config, environment).has_value());
  CHECK(config.io_threads == 8);
  for (const char* bad : {"", "0", "65", "8x", "-8", "99999999999999999999999"}) {
    environment["RUNSTONE_IO_THREADS"] = bad;
    const auto read = read_config_environment(config, environment);
    REQUIRE_FALSE(read.has_value());
    CHECK(read.error().find("RUNSTONE_IO_THREADS") != std::string::npos);
    CHECK(config.io_threads == 8);
  }
}

TEST_CASE("a variable with a typing mistake is refused", "[admin]") {
  ServerConfig config;
  const auto read = read_config_environment(config, {{"RUNSTONE_SESIONS_MAX", "3"}});
  REQUIRE_FALSE(read.has_value());
  CHECK(read.error() ==
        "RUNSTONE_SESIONS_MAX: no setting has this variable of the environment; did you mean "
        "RUNSTONE_SESSIONS_MAX?");
  CHECK(config == ServerConfig{});
}

TEST_CASE("the place of the world is a folder, and the store a database", "[admin]") {
  ServerConfig config;
  for (const char* bad : {"postgre://ana:secret@h/d", "Postgresql://ana:secret@h/d",
                          "mysql://ana:secret@h/d", "host=localhost password=secret", "valley"}) {
    CAPTURE(bad);
    const auto set = set_config(config, "store", bad);
    REQUIRE_FALSE(set.has_value());
    CHECK(set.error().starts_with("store: "));
    CHECK(set.error().find("secret") == std::string::npos);
    const auto read =
        read_config_toml(config, std::string("store = \"") + bad + "\"\n", "server.toml");
    REQUIRE_FALSE(read.has_value());
    CHECK(read.error().message().find("secret") == std::string::npos);
  }
  for (const char* bad : {"postgre://h/d", "postgresql://h/d", "host=localhost", ""}) {
    CAPTURE(bad);
    CHECK_FALSE(set_config(config, "world", bad).has_value());
  }
  CHECK(config == ServerConfig{});
  CHECK(set_config(config, "store", "postgresql://ana:secret@h/d").has_value());
  CHECK(set_config(config, "world", "valley").has_value());
  CHECK(set_config(config, "store", "").has_value());
  CHECK(config.store.empty());
}

TEST_CASE("a choice is set by its name", "[admin]") {
  ServerConfig config;
  CHECK(set_config(config, "encoding", "coded").has_value());
  CHECK(config.encoding == ChunkEncoding::coded);
  CHECK(set_config(config, "log_level", "error").has_value());
  CHECK(config.log_level == LogLevel::error);
  CHECK_FALSE(set_config(config, "log_level", "ERROR").has_value());
  CHECK(config.log_level == LogLevel::error);
}

TEST_CASE("operators are keys, and the error names a word that is no key", "[admin]") {
  const std::string key(64, 'a');
  ServerConfig config;
  CHECK(set_config(config, "operators", key + ", " + std::string(64, '0')).has_value());
  CHECK(config.operators.size() == 2);
  CHECK(set_config(config, "operators", "").has_value());
  CHECK(config.operators.empty());
  for (const std::string& wrong : {std::string("ana"), key + "0", std::string(62, 'a') + "zz"}) {
    const auto set = set_config(config, "operators", wrong);
    REQUIRE_FALSE(set.has_value());
    CHECK(set.error().find("\"" + wrong + "\" is no public key: 64 hexadecimal digits") !=
          std::string::npos);
  }
}

TEST_CASE("an unknown setting is an error", "[admin]") {
  ServerConfig config;
  CHECK_FALSE(set_config(config, "sesions_max", "3").has_value());
  CHECK(set_config(config, "sessions_max", "3").has_value());
}

}  // namespace
}  // namespace runstone
