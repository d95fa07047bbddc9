// All programs: output that cannot be written is an error, and no signal about it ends them.
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <string>
#include <utility>

#include "common/os/child_program.hpp"
#include "tests/support/core/shell_run.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/core/text_contains.hpp"
#include "tests/support/net/port_file.hpp"
#include "tests/support/net/raw_client.hpp"

namespace runstone::test {
namespace {

const std::string kPrograms[] = {RUNSTONE_SERVER_PROGRAM, RUNSTONE_CLIENT_PROGRAM,
                                 RUNSTONE_BOT_PROGRAM, RUNSTONE_REPLAY_PROGRAM,
                                 RUNSTONE_WEB_PROGRAM};

/// Returns the end of a pipe that nobody reads.
int unread_pipe() {
  int ends[2];
  REQUIRE(::pipe(ends) == 0);
  ::close(ends[0]);
  return ends[1];
}

/// The server program, whose output goes to a pipe that nobody reads.
class UnheardServer {
 public:
  explicit UnheardServer(const std::string& folder) {
    const int output = unread_pipe();
    ChildProgram program;
    program.words = {RUNSTONE_SERVER_PROGRAM,
                     "--world",
                     folder + "/world",
                     "--create",
                     "--generator",
                     "flat",
                     "--edge",
                     "16",
                     "--listen",
                     "127.0.0.1:0",
                     "--port-file",
                     folder + "/port"};
    program.out = program.errors = output;
    const auto started = start_program(std::move(program));
    ::close(output);
    REQUIRE(started.has_value());
    child_ = *started;
    port_ = port_in(folder + "/port");
    REQUIRE(port_ != 0);
  }
  ~UnheardServer() {
    if (child_ <= 0) return;
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
  }
  UnheardServer(const UnheardServer&) = delete;
  UnheardServer& operator=(const UnheardServer&) = delete;

  std::uint16_t port() const { return port_; }
  void send(int signal) const { ::kill(child_, signal); }
  /// Stops the server, and returns how it ended.
  std::string stop() {
    ::kill(child_, SIGTERM);
    int status = 0;
    ::waitpid(child_, &status, 0);
    child_ = -1;
    return how_it_ended(status);
  }

 private:
  pid_t child_ = -1;
  std::uint16_t port_ = 0;
};

}  // namespace

TEST_CASE("every program fails if its standard output is a full disk", "[integration]") {
  for (const std::string& program : kPrograms) {
    CAPTURE(program);
    const ShellRun help = run_shell(program + " --help 2>&1 >/dev/full");
    CHECK(help.exit_code != 0);
    CHECK(contains(help.text, "standard output could not be written completely"));
    CHECK(run_shell(program + " --help").exit_code == 0);
  }
}

TEST_CASE("no program is ended by a signal if nobody reads its standard output", "[integration]") {
  for (const std::string& program : kPrograms) {
    CAPTURE(program);
    const int output = unread_pipe();
    ChildProgram child;
    child.words = {program, "--help"};
    child.out = output;
    const auto started = start_program(std::move(child));
    ::close(output);
    REQUIRE(started.has_value());
    int status = 0;
    ::waitpid(*started, &status, 0);
    CHECK(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) != 0);
  }
}

TEST_CASE("a server whose log has lost its reader goes on", "[integration]") {
  const TempFolder folder;
  UnheardServer server(folder.path());
  for (int i = 0; i < 3; ++i) server.send(SIGUSR1);  // each logs a line
  RawClient client(server.port());
  REQUIRE(client.join(1).has_value());
  client.send(EditRequest{1, 0, {SetVoxel{{1, 1, 1}}, {}, 2}});
  CHECK(client.next_of<Commit>().has_value());
  CHECK(server.stop() == "ended with exit code 0");
}

}  // namespace runstone::test
