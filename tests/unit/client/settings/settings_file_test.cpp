#include "client/settings/settings_file.hpp"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "common/os/private_file.hpp"
#include "tests/support/core/temp_folder.hpp"

namespace runstone {
namespace {

using test::TempFolder;

void write(const std::string& file, const std::string& text) { std::ofstream(file) << text; }

}  // namespace

TEST_CASE("settings are saved in a new folder, for their owner alone", "[client_settings]") {
  const TempFolder folder;
  const std::string file = folder / "a/b/client.toml";
  ClientSettings settings;
  settings.name = "ana";
  REQUIRE(save_settings(file, settings));
  settings.view_radius = 9;
  REQUIRE(save_settings(file, settings));
  const LoadedSettings loaded = load_settings(file);
  CHECK(loaded.warnings.empty());
  CHECK(loaded.settings == settings);
  struct stat info{};
  REQUIRE(::stat(file.c_str(), &info) == 0);
  CHECK((info.st_mode & 0777) == 0600);
  REQUIRE(::stat((folder / "a").c_str(), &info) == 0);
  CHECK((info.st_mode & 0777) == 0700);
  CHECK_FALSE(std::filesystem::exists(file + ".new"));
}

TEST_CASE("a missing settings file gives the defaults without a warning", "[client_settings]") {
  const TempFolder folder;
  for (const std::string& file : {folder / "client.toml", std::string()}) {
    const LoadedSettings loaded = load_settings(file);
    CHECK(loaded.settings == ClientSettings{});
    CHECK(loaded.warnings.empty());
  }
}

TEST_CASE("a broken settings file is kept aside, and the defaults are used", "[client_settings]") {
  const TempFolder folder;
  const std::string file = folder / "client.toml";
  const std::string text = "name = \"ana\n";
  write(file, text);
  const LoadedSettings loaded = load_settings(file);
  CHECK(loaded.settings == ClientSettings{});
  REQUIRE(loaded.warnings.size() == 2);
  CHECK_THAT(loaded.warnings[0], Catch::StartsWith(file + ":1: "));
  CHECK_THAT(loaded.warnings[1], Catch::EndsWith("the broken file is kept as " + file + ".broken"));
  CHECK_FALSE(std::filesystem::exists(file));
  CHECK(*read_file(file + ".broken", 100) == text);
}

TEST_CASE("a settings file that cannot be read stays, and a warning names it",
          "[client_settings]") {
  const TempFolder folder;
  const std::string file = folder / "client.toml";
  SECTION("a folder") {
    std::filesystem::create_directory(file);
    const LoadedSettings loaded = load_settings(file);
    REQUIRE(loaded.warnings.size() == 1);
    CHECK(loaded.warnings[0] == file + ": is a folder; the default settings are used");
    CHECK_FALSE(save_settings(file, {}));
  }
  SECTION("a huge file") {
    write(file, std::string(2 << 20, '#'));
    const LoadedSettings loaded = load_settings(file);
    REQUIRE(loaded.warnings.size() == 1);
    CHECK_THAT(loaded.warnings[0], Catch::Contains("is larger than 1048576 bytes"));
  }
  CHECK(std::filesystem::exists(file));
}

TEST_CASE("settings without a place say so", "[client_settings]") {
  const auto saved = save_settings("", {});
  REQUIRE_FALSE(saved);
  CHECK_THAT(saved.error(), Catch::StartsWith("the settings are not kept"));
  const auto blocked = save_settings("/proc/runstone/client.toml", {});
  REQUIRE_FALSE(blocked);
  CHECK_THAT(blocked.error(), Catch::StartsWith("/proc/runstone/client.toml: cannot be written: "));
}

}  // namespace runstone
