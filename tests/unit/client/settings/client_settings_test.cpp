#include "client/settings/client_settings.hpp"

#include <catch2/catch.hpp>

namespace runstone {
namespace {

ClientSettings unusual_settings() {
  ClientSettings out;
  out.name = "Ana Łuk #1";
  out.key_file = "/home/ana/keys/ana key";
  out.quality = QualityChoice::low;
  out.antialiasing = Antialiasing::fxaa;
  out.field_of_view = 91.5;
  out.view_radius = 11;
  out.far_levels = 3;
  out.memory_mib = 4096;
  out.shows_textures = false;
  out.sensitivity = 0.35;
  out.invert_y = true;
  out.interface_scale = 2;
  out.walks = true;
  out.shows_previews = false;
  out.shares_previews = false;
  out.keys = {{"undo", "ctrl+Z \\"}, {"live", ""}, {"odd name", "\""}};
  return out;
}

/// Returns the only warning of a text. The other settings of the text must be in force.
std::string only_warning(const std::string& line) {
  const ReadSettings read = read_settings(line + "\n[hand]\ninvert_y = true\n", "client.toml");
  CHECK_FALSE(read.is_broken);
  CHECK(read.settings.invert_y);
  ClientSettings others = read.settings;
  others.invert_y = false;
  CHECK(others == ClientSettings{});
  REQUIRE(read.warnings.size() == 1);
  return read.warnings[0];
}

}  // namespace

TEST_CASE("settings written as TOML are read back as they were", "[client_settings]") {
  for (const ClientSettings& settings : {ClientSettings{}, unusual_settings()}) {
    const ReadSettings read = read_settings(to_toml(settings), "client.toml");
    CHECK(read.warnings.empty());
    CHECK_FALSE(read.is_broken);
    CHECK(read.settings == settings);
  }
}

TEST_CASE("the written file explains its settings in comments", "[client_settings]") {
  const std::string text = to_toml(ClientSettings{});
  for (const char* part :
       {"# Settings of runstone-client", "# Vertical field of view in degrees", "[keys]"}) {
    CHECK_THAT(text, Catch::Contains(part));
  }
}

TEST_CASE("an empty text gives the default settings", "[client_settings]") {
  const ReadSettings read = read_settings("", "client.toml");
  CHECK(read.settings == ClientSettings{});
  CHECK(read.warnings.empty());
}

TEST_CASE("a setting that cannot be used is named with its line, and the others are used",
          "[client_settings]") {
  CHECK(only_warning("colour = 3") == "client.toml:1: colour: unknown key");
  CHECK(only_warning("name = 7") ==
        "client.toml:1: name: must be a text of 1 to 32 bytes without quotes, backslashes and "
        "unseen characters");
  CHECK_THAT(only_warning("\nname = \"\""), Catch::StartsWith("client.toml:2: name: must be"));
  CHECK_THAT(only_warning("name = \"a\\u202Eb\""), Catch::Contains("name: must be"));
  CHECK_THAT(only_warning("key_file = \"ana.key\""), Catch::Contains("begins with /"));
  CHECK_THAT(only_warning("view.quality = \"superb\""), Catch::Contains("view.quality: must be"));
  CHECK_THAT(only_warning("view.antialiasing = 4"),
             Catch::Contains(R"(view.antialiasing: must be "auto", "off", "fxaa" or "msaa")"));
  CHECK(only_warning("view.field_of_view = 400") ==
        "client.toml:1: view.field_of_view: must be a number from 30 to 110");
  CHECK(only_warning("view.radius = 6.5") ==
        "client.toml:1: view.radius: must be a whole number from 1 to 64");
  CHECK_THAT(only_warning("view.radius = -1"), Catch::Contains("must be a whole number"));
  CHECK(only_warning("view.far_levels = 9") ==
        "client.toml:1: view.far_levels: must be a whole number from 0 to 8");
  CHECK_THAT(only_warning("view.field_of_view = nan"), Catch::Contains("must be a number"));
  for (const char* wrong : {"\"all\"", "63", "-1", "65537", "100.5"}) {
    CHECK_THAT(only_warning(std::string("view.memory_mib = ") + wrong),
               Catch::Contains("must be 0 or a whole number from 64 to 65536"));
  }
  CHECK_THAT(only_warning("interface = 2"), Catch::Contains("interface: must be a table"));
  CHECK_THAT(only_warning("keys.undo = 3"), Catch::Contains("keys.undo: must be a text"));
}

TEST_CASE("a text that is not TOML gives the defaults and the line of the mistake",
          "[client_settings]") {
  const ReadSettings read = read_settings("name = \"ana\"\n[view\nradius = 3\n", "client.toml");
  CHECK(read.is_broken);
  CHECK(read.settings == ClientSettings{});
  REQUIRE(read.warnings.size() == 1);
  CHECK_THAT(read.warnings[0], Catch::StartsWith("client.toml:2: "));
}

}  // namespace runstone
