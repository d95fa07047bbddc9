#include <catch2/catch.hpp>
#include <future>
#include <string>
#include <vector>

#include "tests/support/core/shell_run.hpp"

// The conformance kit judges clients: those without a fault get full marks, and each fault that is
// planted on purpose loses the mark that is about it.
namespace runstone::test {
namespace {

/// Plays scenes to a client, or all scenes, and returns the exit code and what was printed.
ShellRun judged(const std::string& client, const std::string& scenes = "") {
  return run_shell(std::string(RUNSTONE_CONFORMANCE_PROGRAM) + " judge --jobs 8 " + scenes + " " +
                   client + " 2>&1");
}

/// A fault that is planted, the scene that it fails, and the reason.
struct Planted {
  const char* fault;
  const char* scene;
  const char* why;
};

}  // namespace

TEST_CASE("a minimum client gets full marks of the conformance kit", "[conformance]") {
  const ShellRun run = judged(CONFORMANCE_MINIMUM_CLIENT_PROGRAM);
  CAPTURE(run.text);
  CHECK(run.exit_code == 0);
  CHECK(run.text.find("failed") == std::string::npos);
  CHECK(run.text.find("not tried packed-chunks") != std::string::npos);
}

#ifdef CONFORMANCE_WORLD_CLIENT_PROGRAM  // a build without the client has none
TEST_CASE("the client of the library gets full marks of the conformance kit", "[conformance]") {
  const ShellRun run = judged(CONFORMANCE_WORLD_CLIENT_PROGRAM);
  CAPTURE(run.text);
  CHECK(run.exit_code == 0);
  CHECK(run.text.find("failed") == std::string::npos);
  CHECK(run.text.find("not tried") == std::string::npos);
}
#endif

TEST_CASE("a client with a fault loses the mark of its scene", "[conformance]") {
  static constexpr Planted kPlanted[] = {
      {"digest", "digest", "no ChunkRequest of the chunk (0, 0, 0)"},
      {"malformed", "truncated-chunk", "does not end the session"},
      {"signature", "relayed-welcome", "sends ClientAuth"},
      {"versions", "contained-commit", "has other voxels"},
      {"pending", "edit-offered-again", "is not offered again"},
  };
  // Each run waits for what does not come, so they run at the same time.
  std::vector<std::future<ShellRun>> runs;
  for (const Planted& planted : kPlanted) {
    runs.push_back(std::async(std::launch::async, [&planted] {
      return judged(
          std::string("-- ") + CONFORMANCE_MINIMUM_CLIENT_PROGRAM + " --fault " + planted.fault,
          std::string("--patience 2 --scene join --scene ") + planted.scene);
    }));
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const ShellRun run = runs[i].get();
    CAPTURE(kPlanted[i].fault, run.text);
    CHECK(run.exit_code == 1);
    CHECK(run.text.find("failed    " + std::string(kPlanted[i].scene)) != std::string::npos);
    CHECK(run.text.find("passed    join") != std::string::npos);
    CHECK(run.text.find(kPlanted[i].why) != std::string::npos);
  }
}

TEST_CASE("a client that prints without end fails its scene", "[conformance]") {
  const ShellRun lines = judged("yes", "--patience 2 --scene join");
  CAPTURE(lines.text);
  CHECK(lines.exit_code == 1);
  CHECK(lines.text.find("the program prints too many lines") != std::string::npos);
  const ShellRun bytes = judged("-- sh -c 'exec cat /dev/zero'", "--patience 0.5 --scene join");
  CAPTURE(bytes.text);
  CHECK(bytes.exit_code == 1);
  CHECK(bytes.text.find("the client does not connect") != std::string::npos);
}

TEST_CASE("the judge says what is wrong with its command line", "[conformance]") {
  const ShellRun unknown = judged("client", "--scene no-such-scene");
  CHECK(unknown.exit_code == 2);
  CHECK(unknown.text.find("there is no scene \"no-such-scene\"") != std::string::npos);
  const ShellRun missing = judged("/no/such/client", "--scene join");
  CHECK(missing.exit_code == 1);
  CHECK(missing.text.find("cannot start /no/such/client") != std::string::npos);
}

}  // namespace runstone::test
