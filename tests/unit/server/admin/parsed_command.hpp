// What the table of commands makes of a line.
#pragma once
#include <any>
#include <catch2/catch.hpp>
#include <string>

#include "server/admin/command_table.hpp"

namespace runstone::test {

inline constexpr TimeUs kTypedUs = 1'800'000'000'000'000;  // when the lines are typed

inline Command command_of(const std::string& line) {
  CAPTURE(line);
  const auto command = parse_command(line, kTypedUs);
  INFO((command ? "" : command.error()));
  REQUIRE(command.has_value());
  return *command;
}
/// Returns the words of the row of a line.
inline std::string row_of(const std::string& line) {
  return std::string(command_of(line).row->words);
}
/// Returns the meaning of a line, which must have this type.
template <class Meaning>
Meaning parsed(const std::string& line) {
  CAPTURE(line);
  const Command command = command_of(line);
  const auto* meaning = std::any_cast<Meaning>(&command.meaning);
  REQUIRE(meaning != nullptr);
  return *meaning;
}
inline std::string mistake(const std::string& line) {
  const auto command = parse_command(line, kTypedUs);
  return command ? "no mistake" : command.error();
}

}  // namespace runstone::test
