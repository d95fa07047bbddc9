#include "server/runtime/command_runner.hpp"

#include <catch2/catch.hpp>

#include "protocol/limits.hpp"

namespace runstone::test {

using Lines = std::vector<std::string>;

TEST_CASE("an answer is split at line breaks, and long lines go on", "[runtime]") {
  CHECK(answer_lines("") == Lines{""});
  CHECK(answer_lines("a\n\nb") == Lines{"a", "", "b"});
  const std::string full(kCommandLineBytesMax, 'x');
  CHECK(answer_lines(full + "\nb") == Lines{full, "b"});
  CHECK(answer_lines(full + full + "y") == Lines{full, full, "y"});
  // No character is cut.
  const std::string short_of_full(kCommandLineBytesMax - 1, 'x');
  CHECK(answer_lines(short_of_full + "\u00e4z") == Lines{short_of_full, "\u00e4z"});
}

}  // namespace runstone::test
