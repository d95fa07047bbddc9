// An evening of building with the real client program, a mouse and a keyboard: a local world, walking,
// digging, each tool, copy and paste, undo, a second window, a picture, and a server that restarts.
// The log of the server tells what arrived.
#include <array>
#include <catch2/catch.hpp>
#include <chrono>
#include <regex>
#include <thread>

#include "tests/integration/client/window/title_bench.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/integration/server/app/server_commands.hpp"

namespace runstone {
namespace {

using test::ChildProcess;
using test::control;
using test::flat_creation;
using test::has_display_programs;
using test::kWait;
using test::quiet_config;
using test::start_server;
using test::text_in;
using test::TitleBench;
using test::wait_for;

/// The bench with the hands of a player in a world whose server answers control commands.
struct Evening : TitleBench {
  explicit Evening(std::string world_folder) : world(std::move(world_folder)) {}
  /// The world is there, with a seed of its own, so that each evening has the same ground.
  Evening() : world(folder / "data/runstone/worlds/home") {
    std::filesystem::create_directories(std::filesystem::path(world).parent_path());
    WorldCreation creation;
    creation.generator = "terrain";
    creation.seed = 1;
    REQUIRE(open_or_create_world(world, creation).has_value());
  }

  void hand(std::vector<std::string> words) { REQUIRE(display.hand(std::move(words))); }
  void focus(const std::string& title) {
    hand({"search", "--onlyvisible", "--name", title, "windowraise", "windowfocus", "--sync"});
  }
  void turn(int right, int down) {
    hand({"mousemove_relative", "--", std::to_string(right), std::to_string(down)});
  }
  void hold(const std::string& key, std::chrono::milliseconds time) {
    hand({"keydown", key});
    std::this_thread::sleep_for(time);
    hand({"keyup", key});
  }
  /// Waits for a new newest edit in the log whose line contains `part`.
  void expect_edit(const std::string& part) {
    INFO("expected: " << part << "; newest edit: " << newest << "; log: " << text_in(log));
    REQUIRE(has_edit(part, kWait));
  }
  bool has_edit(const std::string& part, std::chrono::milliseconds longest) {
    std::string line;
    const bool found = wait_for(longest, [&] {
      line = control(world, {"log", "limit", "1"}).text;
      return line != newest && line.find(part) != std::string::npos;
    });
    if (found) newest = line;
    return found;
  }
  /// Clicks until an edit comes. Where a click changes nothing, it aims beside, with another
  /// material: what it aims at may be of the chosen one.
  void click_for_edit(const std::string& button, const std::string& part) {
    for (int attempt = 0; attempt < 8; ++attempt) {
      hand({"click", button});
      if (has_edit(part, std::chrono::seconds(5))) return;
      turn(12, attempt % 2 == 0 ? 8 : -8);
      press({std::to_string(2 + attempt % 4)});
    }
    FAIL("no click made an edit: " << part << "; newest edit: " << newest
                                   << "; players: " << control(world, {"players"}).text
                                   << "; log: " << text_in(log));
  }
  /// Returns where the player of this name is.
  std::array<int, 3> place_of(const std::string& name) {
    const std::string players = control(world, {"players"}).text;
    std::smatch found;
    REQUIRE(std::regex_search(players, found,
                              std::regex(name + ".* is here, at (-?\\d+) (-?\\d+) (-?\\d+)")));
    return {std::stoi(found[1]), std::stoi(found[2]), std::stoi(found[3])};
  }

  const std::string world;
  std::string newest;  // line of the log
};

}  // namespace

TEST_CASE("an evening: a local world, every tool, copy and paste, undo, a guest and a picture",
          "[integration]") {
  if (!has_display_programs()) return;
  Evening evening;
  evening.start({"--name", "ana", "--screenshot-dir", evening.folder / "."});
  evening.press_first_button(0);
  REQUIRE(evening.logs("ground in view"));
  evening.hand({"mousemove", "320", "150", "click", "1"});

  // The player walks: it falls to the ground, and moves on.
  evening.press({"f"});
  std::array<int, 3> before{};
  REQUIRE(wait_for(kWait, [&] {  // it lies still when it stands
    const auto now = evening.place_of("ana");
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    before = evening.place_of("ana");
    return now == before;
  }));
  REQUIRE(wait_for(kWait, [&] {
    evening.hold("w", std::chrono::milliseconds(400));
    const auto now = evening.place_of("ana");
    return std::abs(now[0] - before[0]) + std::abs(now[2] - before[2]) > 1;
  }));

  // It flies so high that no tool here builds up to its eye: if the eye is inside stone, a click has
  // no target. It looks down at the ground ahead.
  evening.press({"f"});
  REQUIRE(wait_for(kWait, [&] {
    evening.hold("space", std::chrono::milliseconds(200));
    return evening.place_of("ana")[1] > before[1] + 14;
  }));
  for (int step = 0; step < 3; ++step) evening.turn(0, 80);

  evening.click_for_edit("1", "voxel");
  evening.press({"ctrl+2"});  // box: two corners
  evening.hand({"click", "3"});
  evening.turn(60, 0);
  evening.hand({"click", "3"});
  evening.expect_edit("box");
  evening.press({"ctrl+3"});
  evening.click_for_edit("3", "sphere");
  evening.press({"ctrl+4"});  // stroke: drawn while the button is held
  evening.hand({"mousedown", "3"});
  for (int step = 0; step < 5; ++step) evening.turn(20, 0);
  evening.hand({"mouseup", "3"});
  evening.expect_edit("stroke");
  for (const char* tool : {"ctrl+5", "ctrl+6", "ctrl+7", "ctrl+8"}) {  // fill to extrude
    evening.press({tool, tool == std::string("ctrl+6") ? "3" : "2"});  // with another material
    evening.click_for_edit("3", "player");
  }

  evening.press({"ctrl+9"});  // select: two corners
  evening.hand({"click", "3"});
  evening.turn(50, 0);
  evening.hand({"click", "3"});
  evening.press({"ctrl+c", "ctrl+v"});
  evening.turn(0, 60);
  evening.hand({"click", "3"});
  evening.expect_edit("paste");
  evening.press({"ctrl+z"});
  evening.expect_edit("undo");
  evening.press({"ctrl+y"});
  evening.expect_edit("redo");

  // A guest in a second window says something, and the host answers.
  const std::string server_log = text_in(evening.world + "/server.log");
  std::smatch port;
  REQUIRE(std::regex_search(server_log, port, std::regex("port=(\\d+)")));
  const std::string guest_log = evening.folder / "guest.log";
  const std::string address = "127.0.0.1:" + port[1].str();
  ChildProcess guest({RUNSTONE_CLIENT_PROGRAM, "--connect", address, "--name", "bea", "--key",
                      evening.folder / "bea.key", "--size", "320x240", "--view", "1", "--no-cache"},
                     guest_log, evening.client_environment());
  const auto guest_reads = [&](const std::string& part) {
    const bool found =
        wait_for(kWait, [&] { return text_in(guest_log).find(part) != std::string::npos; });
    INFO("log of the guest: " << text_in(guest_log));
    return found;
  };
  REQUIRE(guest_reads("ground in view"));
  const auto say = [&](const std::string& title, const std::string& text) {
    evening.focus(title);
    evening.press({"t"});
    evening.hand({"type", "--delay", "50", text});
    evening.press({"Return"});
  };
  say("^Runstone  " + address, "hello ana");
  REQUIRE(evening.logs("<bea> hello ana"));
  say("^Runstone  home", "welcome bea");
  REQUIRE(guest_reads("<ana> welcome bea"));

  evening.press({"F2"});
  REQUIRE(wait_for(kWait, [&] {
    for (const auto& entry : std::filesystem::directory_iterator(evening.folder / "."))
      if (entry.path().extension() == ".png" &&
          text_in(entry.path().string()).find("IEND") != std::string::npos)
        return true;
    return false;
  }));
  CHECK(evening.quit() == 0);
}

TEST_CASE("edits in a window while the server restarts arrive when it is back", "[integration]") {
  if (!has_display_programs()) return;
  const test::TempFolder folder;
  ServerConfig config = quiet_config(folder / "world");
  auto server = start_server(config, flat_creation());
  config.listen = "127.0.0.1:" + std::to_string(server->port());
  Evening evening(config.world);
  evening.start({"--connect", config.listen, "--name", "ana"});
  REQUIRE(evening.logs("ground in view"));
  evening.hand({"mousemove", "320", "150", "click", "1"});
  for (int step = 0; step < 4; ++step) evening.turn(0, 80);
  evening.click_for_edit("1", "voxel");

  CHECK(server->stop().is_clean);
  server.reset();
  REQUIRE(evening.logs("connection lost"));
  evening.hand({"click", "3"});
  server = start_server(config, flat_creation());
  REQUIRE(evening.logs("world open", 2));
  evening.expect_edit("player voxel");
  CHECK(evening.newest.find(":=") != std::string::npos);  // placed, not removed
  CHECK(server->stop().is_clean);
}

}  // namespace runstone
