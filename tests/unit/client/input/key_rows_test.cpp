#include "client/input/key_rows.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>

#include "client/input/gamepad.hpp"

using namespace runstone;

TEST_CASE("docs/client.md has the table of keys that the client has", "[client_input]") {
  std::ifstream in(std::string(RUNSTONE_SOURCE_DIR) + "/docs/client.md");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  std::string table = "| input | effect |\n|---|---|\n";
  for (const KeyRow& row : key_rows(KeyMap{}))
    table += "| " + row.input + " | " + row.what + " |\n";
  INFO(table);
  CHECK(text.find(table) != std::string::npos);
}

TEST_CASE("docs/client.md has the table of the gamepad that the client has", "[client_input]") {
  std::ifstream in(std::string(RUNSTONE_SOURCE_DIR) + "/docs/client.md");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  std::string table = "| gamepad | effect |\n|---|---|\n";
  for (const GamepadBinding& row : gamepad_table()) {
    const std::string_view what = row.action ? info_of(*row.action).what : row.what;
    table += "| " + std::string(row.name) + " | " + std::string(what) + " |\n";
  }
  INFO(table);
  CHECK(text.find(table) != std::string::npos);
}

TEST_CASE("the keys of the slots are one row only while they are the digits", "[client_input]") {
  const auto has_slots = [](const KeyMap& keys) {
    const auto rows = key_rows(keys);
    return std::ranges::any_of(rows, [](const KeyRow& row) { return row.input == "1 to 9"; });
  };
  KeyMap keys;
  CHECK(has_slots(keys));
  keys.bind(Action::hold_slot_3, {{Key::f5}});
  CHECK_FALSE(has_slots(keys));
  const auto has_tools = [](const KeyMap& map) {
    return std::ranges::any_of(
        key_rows(map), [](const KeyRow& row) { return row.input.starts_with("ctrl+1 to"); });
  };
  CHECK(has_tools(keys));
  keys.bind(Action::tool_4, {});
  CHECK_FALSE(has_tools(keys));
}
