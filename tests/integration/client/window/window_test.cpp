// The real client program with a window on an X server, a mouse and a keyboard. The test reads
// pixels from the display, and edits from the commits that another client receives.
#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <optional>

#include "common/materials/material_table.hpp"
#include "tests/integration/client/window/child_process.hpp"
#include "tests/integration/client/window/virtual_display.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/support/net/raw_client.hpp"

namespace runstone {
namespace {

using test::changed_share;
using test::ChildProcess;
using test::find_program;
using test::flat_creation;
using test::Grab;
using test::quiet_config;
using test::RawClient;
using test::start_server;
using test::TempFolder;
using test::VirtualDisplay;
using test::wait_for;

constexpr int kWidth = 480, kHeight = 360;
// The share of the middle's pixels that a changed scene changes. The outline of the picked voxel
// and the cross hair change less.
constexpr double kChanged = 0.5;
constexpr std::chrono::seconds kLong{60};  // for a step on a machine that has much else to do

/// Returns the required programs that this machine lacks.
std::string missing_programs() {
  std::string missing;
  for (const char* program : {"Xvfb", "xdotool"}) {
    if (!find_program(program)) missing += std::string(" ") + program;
  }
  return missing;
}

/// Returns the middle of a window of this size at the corner of the display. It is smaller than the
/// voxel aimed at.
Grab centre(const VirtualDisplay& display, int width, int height) {
  return display.grab(width / 2 - 20, height / 2 - 14, 40, 28);
}

/// Returns the middle once it has stopped changing.
Grab steady_centre(const VirtualDisplay& display, int width = kWidth, int height = kHeight) {
  Grab last = centre(display, width, height);
  int same = 0;
  REQUIRE(wait_for(kLong, [&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    Grab now = centre(display, width, height);
    same = now == last ? same + 1 : 0;
    last = std::move(now);
    return same >= 3;
  }));
  return last;
}

bool shows_ground(const Grab& grab) {
  const auto mean = grab.mean();
  return mean[0] + mean[1] + mean[2] > 60 &&
         mean[1] > mean[2] + 10;  // grass: neither black nor sky
}

/// Returns the edit that the server orders next.
EditDescriptor next_edit(RawClient& watcher) {
  std::optional<EditDescriptor> edit;
  wait_for(kLong, [&] {
    const auto message = watcher.next(1'000);
    if (!message) return !watcher.is_open();
    const auto* const commit = std::get_if<Commit>(&*message);
    if (commit == nullptr) return false;
    REQUIRE(commit->edits.size() == 1);
    edit = commit->edits[0].edit;
    return true;
  });
  REQUIRE(edit.has_value());
  return *edit;
}

std::vector<std::string> pictures_in(const std::string& folder) {
  std::vector<std::string> out;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".png") out.push_back(entry.path().string());
  }
  return out;
}

std::string text_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("a display that goes away ends the client with the exit code of a missing display",
          "[integration]") {
  if (const std::string missing = missing_programs(); !missing.empty()) {
    WARN("skipped: not installed:" << missing);
    return;
  }
  const TempFolder folder;
  const auto server = start_server(quiet_config(folder / "world"), flat_creation());
  VirtualDisplay display(folder / ".", 800, 600);
  const std::string log = folder / "client.log";
  ChildProcess client(
      {RUNSTONE_CLIENT_PROGRAM, "--connect", "127.0.0.1:" + std::to_string(server->port()),
       "--size", "320x240", "--view", "1", "--no-cache"},
      log, display.environment());
  const bool opened =
      wait_for(kLong, [&] { return text_of(log).find("world open") != std::string::npos; });
  INFO(text_of(log));
  REQUIRE(opened);
  display.end();
  const auto code = client.wait(kLong);
  INFO(text_of(log));
  REQUIRE(code.has_value());
  CHECK(*code == 2);
  CHECK(server->stop().is_clean);
}

TEST_CASE("in a window, clicks dig and place, and palette, chat, resizing, F2 and escape work",
          "[integration]") {
  if (const std::string missing = missing_programs(); !missing.empty()) {
    WARN("skipped: not installed:" << missing);
    return;
  }
  const TempFolder folder;
  ServerConfig config = quiet_config(folder / "world");
  config.idle_s = 3'600;  // the watcher sends nothing
  const auto server = start_server(config, flat_creation());
  RawClient watcher(server->port());
  REQUIRE(watcher.join(1).has_value());
  watcher.send(View{1, {0, 0, 0}, 2, 2});
  watcher.send(Move{{{0.5, 60.0, -60.0}, 0, 0}});  // out of view

  VirtualDisplay display(folder / ".", 800, 600);
  const std::string log = folder / "client.log";
  ChildProcess client(
      {RUNSTONE_CLIENT_PROGRAM, "--connect", "127.0.0.1:" + std::to_string(server->port()),
       "--name", "hands", "--size", std::to_string(kWidth) + "x" + std::to_string(kHeight),
       "--view", "2", "--no-cache", "--screenshot-dir", folder / ".", "--report",
       folder / "report.json"},
      log, display.environment());
  const std::vector<std::string> window = {"search", "--onlyvisible", "--name", "^Runstone"};
  const auto with_window = [&window](std::vector<std::string> words) {
    words.insert(words.begin(), window.begin(), window.end());
    return words;
  };
  const bool has_window = wait_for(kLong, [&] { return display.hand(window); });
  INFO(text_of(log));
  REQUIRE(has_window);
  REQUIRE(
      wait_for(kLong, [&] { return text_of(log).find("ground in view") != std::string::npos; }));

  // The first click captures the mouse. Then the player looks down at the ground some voxels ahead.
  REQUIRE(display.hand(with_window({"windowfocus", "mousemove", "240", "180", "click", "1"})));
  for (int step = 0; step < 4; ++step)
    REQUIRE(display.hand({"mousemove_relative", "--", "0", "80"}));
  REQUIRE(wait_for(kLong, [&] { return shows_ground(centre(display, kWidth, kHeight)); }));
  const Grab before = steady_centre(display);

  REQUIRE(display.hand({"click", "1"}));
  const EditDescriptor dug = next_edit(watcher);
  CHECK(dug.material == kEmpty);
  REQUIRE(std::holds_alternative<SetVoxel>(dug.shape));
  REQUIRE(wait_for(
      kLong, [&] { return changed_share(before, centre(display, kWidth, kHeight)) > kChanged; }));
  const Grab hole = steady_centre(display);
  CHECK(changed_share(before, hole) > kChanged);

  REQUIRE(display.hand({"click", "3"}));
  const EditDescriptor placed = next_edit(watcher);
  CHECK(placed.material == default_material_table().find("stone"));  // the first slot
  REQUIRE(std::holds_alternative<SetVoxel>(placed.shape));
  CHECK(std::get<SetVoxel>(placed.shape).at == std::get<SetVoxel>(dug.shape).at);  // the same voxel
  REQUIRE(wait_for(
      kLong, [&] { return changed_share(hole, centre(display, kWidth, kHeight)) > kChanged; }));

  // The palette gives another material, and a line of chat is typed and sent. Both free the mouse
  // and capture it again.
  REQUIRE(display.hand({"key", "e"}));
  REQUIRE(display.hand({"type", "--delay", "50", "gold"}));
  REQUIRE(display.hand({"key", "Return"}));
  REQUIRE(display.hand({"click", "3"}));
  CHECK(next_edit(watcher).material == default_material_table().find("gold"));
  REQUIRE(display.hand({"key", "t"}));
  REQUIRE(display.hand({"type", "--delay", "50", "hello, world"}));
  REQUIRE(display.hand({"key", "Return"}));
  REQUIRE(wait_for(kLong,
                   [&] { return text_of(log).find("<hands> hello, world") != std::string::npos; }));

  // A smaller window shows a smaller frame, filled to its edge, and F2 writes one of that size.
  REQUIRE(display.hand(with_window({"windowsize", "320", "240"})));
  REQUIRE(wait_for(kLong, [&] { return shows_ground(display.grab(290, 210, 20, 20)); }));
  static_cast<void>(steady_centre(display, 320, 240));
  REQUIRE(display.hand({"key", "F2"}));
  REQUIRE(wait_for(kLong, [&] {
    const auto pictures = pictures_in(folder / ".");
    return !pictures.empty() && text_of(pictures[0]).find("IEND") != std::string::npos;
  }));
  const std::string png = text_of(pictures_in(folder / ".")[0]);
  CHECK(png.substr(16, 8) ==
        std::string("\0\0\1\100\0\0\0\360", 8));  // width and height, big-endian

  // A button that is held digs again and again.
  REQUIRE(display.hand({"mousedown", "1"}));
  CHECK(next_edit(watcher).material == kEmpty);
  CHECK(next_edit(watcher).material == kEmpty);
  REQUIRE(display.hand({"mouseup", "1"}));

  // Escape opens the pause menu. Its last button quits.
  REQUIRE(display.hand({"key", "--delay", "200", "Escape", "Down", "Down", "Down", "space"}));
  const auto code = client.wait(kLong);
  INFO(text_of(log));
  REQUIRE(code.has_value());
  CHECK(*code == 0);
  CHECK(text_of(folder / "report.json").find("\"renderer\": \"GLFW\"") != std::string::npos);
  CHECK(server->stop().is_clean);
}

}  // namespace runstone
