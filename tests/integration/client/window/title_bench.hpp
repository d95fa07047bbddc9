// TitleBench: the real client program in a window of its own display, one at a time. Tests press
// its keys and read its log.
#pragma once
#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "tests/integration/client/window/child_process.hpp"
#include "tests/integration/client/window/virtual_display.hpp"
#include "tests/support/core/temp_folder.hpp"

namespace runstone::test {

/// The time for a step on a machine that has much else to do.
inline constexpr std::chrono::seconds kWait{60};

/// Returns false and warns if the programs for a display are not installed.
inline bool has_display_programs() {
  if (find_program("Xvfb") && find_program("xdotool")) return true;
  WARN("skipped: not installed: Xvfb or xdotool");
  return false;
}

inline std::string text_in(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A display with one client program at a time.
struct TitleBench {
  /// Starts a client. Its log is empty at first.
  void start(std::vector<std::string> arguments) {
    client.reset();
    std::filesystem::remove(log);
    arguments.insert(arguments.begin(), RUNSTONE_CLIENT_PROGRAM);
    for (const char* word : {"--size", "640x480", "--view", "2", "--no-cache"})
      arguments.emplace_back(word);
    client.emplace(std::move(arguments), log, client_environment());
    REQUIRE(wait_for(kWait, [&] {
      return display.hand({"search", "--onlyvisible", "--name", "^Runstone", "windowfocus"});
    }));
  }
  std::vector<std::string> client_environment() const {
    auto out = display.environment();
    out.push_back(std::string("RUNSTONE_SERVER=") + RUNSTONE_SERVER_PROGRAM);
    return out;
  }
  /// Returns how often the log has `part`.
  std::size_t count_of(const std::string& part) const {
    const std::string text = text_in(log);
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
      ++count;
    return count;
  }
  bool logs(const std::string& part, std::size_t times = 1) {
    const bool found = wait_for(kWait, [&] { return count_of(part) >= times; });
    UNSCOPED_INFO("log: " << text_in(log));
    return found;
  }
  /// Presses keys, one after another.
  void press(std::vector<std::string> keys) {
    keys.insert(keys.begin(), {"key", "--delay", "400"});
    REQUIRE(display.hand(std::move(keys)));
  }
  /// Presses the first button of the title screen until the log says that it worked: the window may
  /// not be drawn yet when it has the focus.
  void press_first_button(std::size_t worlds_before) {
    REQUIRE(wait_for(kWait, [&] {
      press({"space"});
      return wait_for(std::chrono::seconds(3),
                      [&] { return count_of("world open") > worlds_before; });
    }));
  }

  /// Leaves the world by the third button of the pause menu.
  void leave() { end_play({"Escape", "Down", "Down", "space"}); }
  /// Quits by the last button of the pause menu, and returns the exit code.
  std::optional<int> quit() {
    end_play({"Escape", "Down", "Down", "Down", "space"});
    return client->wait(kWait);
  }
  /// Presses keys until the log says that the client has left its world, and no key after that: it
  /// would press a button of the title screen.
  void end_play(const std::vector<std::string>& keys) {
    const std::size_t before = count_of("exit code=");
    const bool has_ended = wait_for(kWait, [&] {
      press(keys);
      return wait_for(std::chrono::seconds(15), [&] { return count_of("exit code=") > before; });
    });
    INFO(text_in(log));
    REQUIRE(has_ended);
  }

  TempFolder folder;
  VirtualDisplay display{folder / ".", 800, 600};
  const std::string log = folder / "client.log";
  std::optional<ChildProcess> client;
};

}  // namespace runstone::test
