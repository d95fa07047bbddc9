// Commands to a running server in tests: from a client's session and through the control socket.
#pragma once
#include <catch2/catch.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "server/admin/control_program.hpp"
#include "tests/support/net/raw_client.hpp"

namespace runstone::test {

struct Answer {
  bool is_ok = false;
  std::string text;
};

/// Sends a command through the control socket of a world's server.
inline Answer control(const std::string& world, const std::vector<std::string>& words,
                      const ReadPassword& read_password = read_new_password) {
  std::ostringstream out;
  const auto done = control_server({world, words}, out, read_password);
  INFO((done ? "" : done.error()));
  REQUIRE(done.has_value());
  return {*done == ControlEnd::done, out.str()};
}

/// Sends a command as control(), and checks that it succeeds.
inline Answer must(const std::string& world, const std::vector<std::string>& words) {
  const Answer answer = control(world, words);
  INFO(words.front() << ": " << answer.text);
  CHECK(answer.is_ok);
  return answer;
}

/// Sends a client's command and waits until it is done.
inline Answer command(RawClient& client, const std::string& text) {
  static std::uint32_t id = 0;
  client.send(CommandRequest{++id, text});
  Answer answer;
  for (;;) {
    const auto output = client.next_of<CommandOutput>();
    REQUIRE(output.has_value());
    REQUIRE(output->id == id);
    for (const std::string& line : output->lines) answer.text += line + "\n";
    if (!output->is_done) continue;
    answer.is_ok = output->is_ok;
    return answer;
  }
}

}  // namespace runstone::test
