#include "server/admin/control_program.hpp"

#include <catch2/catch.hpp>

#include "server/admin/command.hpp"

using namespace runstone;

TEST_CASE("the words of a shell become one command line", "[admin][control]") {
  CHECK(control_line({"status"}) == "status");
  CHECK(control_line({"log", "box", "-1", "2", "3", "-4", "5", "6"}) == "log box -1 2 3 -4 5 6");
  // The shell has removed the quotes of: log author "the mole" since 2h
  CHECK(control_line({"log", "author", "the mole", "since", "2h"}) ==
        "log author \"the mole\" since 2h");
  // The shell has kept the inner quotes of: log author '"the mole"'
  CHECK(control_line({"log", "author", "\"the mole\""}) == "log author \"the mole\"");
  // A whole line in single quotes: 'log author "the mole"'
  CHECK(control_line({"log author \"the mole\""}) == "log author \"the mole\"");
  CHECK(control_line({"log", "author", ""}) == "log author \"\"");
}

TEST_CASE("a name with blanks is one author however the shell is quoted", "[admin][control]") {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"log", "author", "the mole"},
        {"log", "author", "\"the mole\""},
        {"log author \"the mole\""}}) {
    const auto command = parse_command(control_line(words), 0);
    REQUIRE(command.has_value());
    const auto& filter = std::get<LogCommand>(*command).filter;
    REQUIRE(filter.authors.size() == 1);
    CHECK(filter.authors[0].name == "the mole");
  }
}
