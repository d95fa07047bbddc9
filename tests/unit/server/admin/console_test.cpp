// The console, reading from a pipe.
#include "server/admin/console.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <sstream>
#include <vector>

#include "protocol/limits.hpp"

using namespace runstone;

namespace {

class Pipe {
 public:
  Pipe() { REQUIRE(::pipe(ends_) == 0); }
  ~Pipe() {
    ::close(ends_[0]);
    hang_up();
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  int out() const { return ends_[0]; }
  int in() const { return ends_[1]; }
  void write(const std::string& text) const {
    REQUIRE(::write(in(), text.data(), text.size()) == static_cast<ssize_t>(text.size()));
  }
  void hang_up() {
    if (ends_[1] >= 0) ::close(ends_[1]);
    ends_[1] = -1;
  }

 private:
  int ends_[2] = {-1, -1};
};

/// A console and its output.
struct ConsoleBench {
  explicit ConsoleBench(int descriptor) {
    const auto handler = [this](const std::string& line, const CommandReply& reply) {
      lines.push_back(line);
      reply({"did " + line, true, true});
    };
    const auto opened = Console::open(
        loop, handler, [this](const std::string& why) { failures.push_back(why); }, descriptor,
        out);
    REQUIRE(opened.has_value());
    console = *opened;
  }
  void turn() {
    loop.restart();
    loop.poll();
  }
  asio::io_context loop;
  std::ostringstream out;
  std::vector<std::string> lines, failures;
  std::shared_ptr<Console> console;
};

const std::string kTooLong =
    "a command has at most " + std::to_string(kCommandBytesMax) + " bytes: this line is left out\n";

}  // namespace

TEST_CASE("lines of a file of another editor are commands", "[server][console]") {
  Pipe pipe;
  ConsoleBench bench(pipe.out());
  pipe.write("\xEF\xBB\xBFstatus\r\n\r\nplayers\r\n");
  bench.turn();
  CHECK(bench.lines == std::vector<std::string>{"status", "players"});
}

TEST_CASE("the console answers lines whatever pieces they arrive in", "[server][console]") {
  Pipe pipe;
  ConsoleBench bench(pipe.out());
  pipe.write("status\n   \n\npla");
  bench.turn();
  CHECK(bench.lines == std::vector<std::string>{"status"});
  pipe.write("yers\nlog\n");
  bench.turn();
  CHECK(bench.lines == std::vector<std::string>{"status", "players", "log"});
  pipe.write("rollback apply p1");
  pipe.hang_up();
  bench.turn();
  CHECK(bench.lines.size() == 3);  // the whole line might have been p12
  CHECK(bench.out.str() ==
        "did status\ndid players\ndid log\nthe last line has no end, and is left out\n");
  CHECK(bench.failures.empty());
}

TEST_CASE("a line that is too long is rejected, and the lines after it are carried out",
          "[server][console]") {
  Pipe pipe;
  ConsoleBench bench(pipe.out());
  const std::string longest(kCommandBytesMax, 'x');
  pipe.write(longest + "\n" + longest + "y\nstatus\n");
  bench.turn();
  CHECK(bench.lines == std::vector<std::string>{longest, "status"});
  for (int i = 0; i < 40; ++i) {  // much longer than one read
    pipe.write(std::string(1000, 'z'));
    bench.turn();
  }
  pipe.write("\nplayers\n");
  bench.turn();
  CHECK(bench.lines == std::vector<std::string>{longest, "status", "players"});
  const std::string said = bench.out.str();
  CHECK(said.find(kTooLong) != said.rfind(kTooLong));
  CHECK(said.size() == 2 * kTooLong.size() + std::string("did \ndid status\ndid players\n").size() +
                           longest.size());
  CHECK(bench.failures.empty());
}

TEST_CASE("a console that cannot be read reports why", "[server][console]") {
  Pipe pipe;
  ConsoleBench bench(pipe.in());  // the end that is for writing
  bench.turn();
  CHECK(bench.failures ==
        std::vector<std::string>{
            "console: standard input cannot be read any more: Bad file descriptor"});
  bench.turn();
  CHECK(bench.failures.size() == 1);
}

TEST_CASE("a closed console prints nothing", "[server][console]") {
  Pipe pipe;
  ConsoleBench bench(pipe.out());
  pipe.write("status");
  bench.turn();
  bench.console->close();
  bench.turn();
  CHECK(bench.out.str().empty());
  CHECK(bench.failures.empty());
}
