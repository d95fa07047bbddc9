#include "server/admin/control_program.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "protocol/codec/password_key.hpp"
#include "server/admin/password_commands.hpp"
#include "server/admin/rollback_commands.hpp"
#include "tests/unit/server/admin/parsed_command.hpp"

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

TEST_CASE("names of files in the words of a shell become whole paths", "[admin][control]") {
  using Words = std::vector<std::string>;
  const std::string here = std::filesystem::current_path().string() + '/';
  CHECK(with_whole_paths({"materials", "add", "wool.toml"}) ==
        Words{"materials", "add", here + "wool.toml"});
  CHECK(with_whole_paths({"builds", "export", "7", "mill.rsb"}) ==
        Words{"builds", "export", "7", here + "mill.rsb"});
  CHECK(with_whole_paths({"import", "a.schem", "at", "1", "2", "3", "map", "m.toml", "without",
                          "air"}) == Words{"import", here + "a.schem", "at", "1", "2", "3", "map",
                                           here + "m.toml", "without", "air"});
  CHECK(with_whole_paths({"import", "\"a b.schem\"", "at", "1", "2", "3", "map", "/m.toml",
                          "colours", "c.png"}) == Words{"import", "\"a b.schem\"", "at", "1", "2",
                                                        "3", "map", "/m.toml", "colours",
                                                        here + "c.png"});
  CHECK(with_whole_paths({"say", "map", "file"}) == Words{"say", "map", "file"});
}

TEST_CASE("a name with blanks is one author however the shell is quoted", "[admin][control]") {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"log", "author", "the mole"},
        {"log", "author", "\"the mole\""},
        {"log author \"the mole\""}}) {
    const CommandFilter filter = test::parsed<LogCommand>(control_line(words)).filter;
    REQUIRE(filter.authors.size() == 1);
    CHECK(filter.authors[0].name == "the mole");
  }
}

TEST_CASE("control adds to `password set` what the world keeps, and not the password",
          "[admin][control]") {
  const auto type = [] { return Result<std::string, std::string>("correct horse"); };
  const auto line = completed_line("password set role visitor", type);
  REQUIRE(line.has_value());
  CHECK(line->find("correct") == std::string::npos);
  const auto set = test::parsed<SetPasswordCommand>(*line);
  CHECK(set.has_verifier);
  CHECK(set.password.role == "visitor");
  CHECK(is_key_of(set.password, password_key("correct horse", set.password.salt).value()));
  CHECK(*completed_line("password set role visitor", type) != *line);  // the salt is drawn anew
}

TEST_CASE("control reads no password for other commands and for mistakes", "[admin][control]") {
  const auto type = []() -> Result<std::string, std::string> {
    FAIL("nothing is to be read");
    return std::string();
  };
  for (const char* line : {"status", "password", "password clear", "password set hunter2",
                           "password set role", "say password set", ""})
    CHECK(completed_line(line, type).value() == line);
  const auto done = "password set verifier " + std::string(96, 'a');
  CHECK(completed_line(done, type).value() == done);
}

TEST_CASE("a short password and a missing one are refused before anything is sent",
          "[admin][control]") {
  const auto short_one = [] { return Result<std::string, std::string>("1234567"); };
  CHECK(completed_line("password set", short_one).error() ==
        "password set: the password has fewer than 8 characters: take some words");
  const auto none = []() -> Result<std::string, std::string> { return failure("no line"); };
  CHECK(completed_line("password set", none).error() == "no line");
}
