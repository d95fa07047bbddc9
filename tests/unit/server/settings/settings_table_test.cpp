#include "server/settings/settings_table.hpp"

#include <CLI/CLI.hpp>
#include <catch2/catch.hpp>
#include <map>

namespace runstone {
namespace {

struct Lamp {
  std::uint64_t watts = 5;
  std::string label, place = "hall";
  bool is_on = false;
  friend bool operator==(const Lamp&, const Lamp&) = default;
};

SettingsTable<Lamp> lamp_settings() {
  return {"LAMP_",
          {number_setting("watts", &Lamp::watts, 1, 60, "power"),
           text_setting("label", "words on it", &Lamp::label, true),
           text_setting("place", "where it stands", &Lamp::place, false),
           flag_setting("is_on", "whether it shines", &Lamp::is_on)}};
}

/// Returns what is wrong with a file, which must leave the configuration as it was.
TextError error_of(const std::string& toml) {
  Lamp lamp;
  const auto read = lamp_settings().read_toml(lamp, toml, "lamp.toml");
  REQUIRE_FALSE(read.has_value());
  CHECK(lamp == Lamp{});
  return read.error();
}

TEST_CASE("texts of every script are printed as they are, and read back", "[settings]") {
  Lamp lamp;
  lamp.label = "Grüße \"aus\" Köln, привет\\мир, 日本";
  lamp.watts = 60;
  lamp.is_on = true;
  const std::string printed = lamp_settings().to_toml(lamp);
  CHECK(printed.find("Grüße \\\"aus\\\" Köln, привет\\\\мир, 日本") != std::string::npos);
  Lamp read;
  REQUIRE(lamp_settings().read_toml(read, printed, "lamp.toml").has_value());
  CHECK(read == lamp);
}

TEST_CASE("a value of another type is an error that says which type it must have", "[settings]") {
  for (const char* value : {"\"5\"", "5.5", "true", "[5]", "{a = 5}", "2026-01-01"})
    CHECK(error_of(std::string("watts = ") + value).what == "must be a whole number: power, 1..60");
  for (const char* value : {"5", "true", "[\"a\"]", "{a = \"a\"}"})
    CHECK(error_of(std::string("label = ") + value).what == "must be a text: words on it");
  for (const char* value : {"1", "[true]", "\"yes\"", "\"\""})
    CHECK(error_of(std::string("is_on = ") + value).what ==
          "must be true or false: whether it shines");
}

TEST_CASE("a flag may be quoted, an optional text may be empty", "[settings]") {
  Lamp lamp;
  lamp.label = "a";
  REQUIRE(
      lamp_settings().read_toml(lamp, "is_on = \"true\"\nlabel = \"\"\n", "lamp.toml").has_value());
  CHECK(lamp.is_on);
  CHECK(lamp.label.empty());
  CHECK(error_of("place = \"\"").what == "must not be empty");
}

TEST_CASE("an error in a later line leaves the values of earlier lines as they were",
          "[settings]") {
  const TextError error = error_of("watts = 7\n# light\nis_on = 3\n");
  CHECK(error.file == "lamp.toml");
  CHECK(error.line == 3);
  CHECK(error.key == "is_on");
  CHECK(error_of("colour = \"red\"").what == "no such setting");
  CHECK(error_of("wats = 7").what == "no such setting; did you mean watts?");
  CHECK(error_of("watts = 7\nwatts = 8\n").line == 2);
}

TEST_CASE("a variable that no setting has is an error with the nearest one", "[settings]") {
  const auto error_of = [](const Environment& environment) {
    Lamp lamp;
    const auto read = lamp_settings().read_environment(lamp, environment);
    return read ? std::string() : read.error();
  };
  CHECK(error_of({{"LAMP_WATTS", "7"}, {"PATH", "/bin"}, {"LAMPS", "x"}}).empty());
  CHECK(error_of({{"LAMP_WATS", "7"}}) ==
        "LAMP_WATS: no setting has this variable of the environment; did you mean LAMP_WATTS?");
  CHECK(error_of({{"LAMP_OIL_LITRES", "7"}}) ==
        "LAMP_OIL_LITRES: no setting has this variable of the environment");
  CHECK(error_of({{"LAMP_", ""}}) == "LAMP_: no setting has this variable of the environment");
  CHECK(error_of({{"LAMP_PORT", "25565"}}).starts_with("LAMP_PORT: no setting"));
  Lamp lamp;
  CHECK_FALSE(lamp_settings().read_environment(lamp, {{"LAMP_WATTS", "0"}}).has_value());
  CHECK(lamp == Lamp{});
}

TEST_CASE("variables that container software sets for a service are no mistakes", "[settings]") {
  Lamp lamp;
  CHECK(lamp_settings()
            .read_environment(lamp, {{"LAMP_SERVICE_HOST", "10.0.0.1"},
                                     {"LAMP_SERVICE_PORT", "4747"},
                                     {"LAMP_SERVICE_PORT_GAME", "4747"},
                                     {"LAMP_PORT", "tcp://10.0.0.1:4747"},
                                     {"LAMP_PORT_4747_TCP", "tcp://10.0.0.1:4747"},
                                     {"LAMP_PORT_4747_TCP_ADDR", "10.0.0.1"}})
            .has_value());
  CHECK(lamp == Lamp{});
}

TEST_CASE("the text of a setting with a secret is in no error", "[settings]") {
  Setting<Lamp> secret = number_setting("watts", &Lamp::watts, 1, 60, "power");
  secret.has_secret = true;
  const SettingsTable<Lamp> table("LAMP_", {secret});
  Lamp lamp;
  CHECK(table.set(lamp, "watts", "pass").error() == "watts: must be a whole number: power, 1..60");
}

TEST_CASE("an unknown flag leads to the nearest one", "[settings]") {
  CLI::App app;
  std::map<std::string, std::string> texts;
  const SettingsTable<Lamp> table = lamp_settings();
  add_setting_flags(app, table.fields(), texts);
  CHECK(nearest_flag(app, "--wats") == "; did you mean --watts?");
  CHECK(nearest_flag(app, "--labell=x") == "; did you mean --label?");
  CHECK(nearest_flag(app, "--colour").empty());
  CHECK(nearest_flag(app, "label").empty());
}

TEST_CASE("a flag without a value is true, and the last of two values counts", "[settings]") {
  const auto texts_of = [](const std::string& line) {
    CLI::App app;
    app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    std::map<std::string, std::string> texts;
    const SettingsTable<Lamp> table = lamp_settings();
    add_setting_flags(app, table.fields(), texts);
    app.parse(line);
    return texts;
  };
  using Texts = std::map<std::string, std::string>;
  CHECK(texts_of("--is-on --watts 7") == Texts{{"is_on", "true"}, {"watts", "7"}});
  CHECK(texts_of("--is-on false") == Texts{{"is_on", "false"}});
  CHECK(texts_of("--place a --place b").at("place") == "b");
  CHECK(texts_of("").empty());
}

}  // namespace
}  // namespace runstone
