// How a server ends the program that makes a backup.
#include "server/app/backup_child.hpp"

#include <signal.h>
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>

#include "tests/unit/server/app/backup_script.hpp"

namespace runstone::test {

TEST_CASE("a backup that ignores the signal to end is killed", "[backup]") {
  const BackupScript script("trap '' TERM\necho $$ > \"$FOLDER/pid\"\nexec sleep 600\n");
  BackupChild::Patience patience;
  patience.terminate = std::chrono::milliseconds(0);
  patience.kill = std::chrono::minutes(10);
  BackupChild child("world", patience);
  bool is_answered = false;
  child.start("to", [&](const CommandAnswer& /*none comes*/) { is_answered = true; });
  const pid_t pid = std::stoi("0" + script.written("pid"));
  REQUIRE(pid > 0);
  child.ask_to_stop();
  child.stop();
  const bool is_gone = ::kill(pid, 0) != 0 && errno == ESRCH;
  CHECK(is_gone);
  CHECK_FALSE(is_answered);
}

TEST_CASE("a backup that does not end is left behind", "[backup]") {
  // The inner program keeps the output open, as one that waits for a disk does.
  const BackupScript script(
      "trap '' TERM\nsleep 600 &\necho $$ > \"$FOLDER/pid\"\necho $! > \"$FOLDER/inner\"\nwait\n");
  BackupChild::Patience patience;
  patience.terminate = patience.kill = std::chrono::milliseconds(0);
  BackupChild child("world", patience);
  child.start("to", [](const CommandAnswer& /*none comes*/) {});
  const pid_t inner = std::stoi("0" + script.written("inner"));
  const pid_t pid = std::stoi("0" + script.written("pid"));
  REQUIRE(inner > 0);
  REQUIRE(pid > 0);
  child.stop();  // returns
  CHECK(::kill(inner, 0) == 0);
  ::kill(inner, SIGKILL);
  ::waitpid(pid, nullptr, 0);
}

TEST_CASE("the answer of a backup is all that its program prints", "[backup]") {
  const BackupScript script("echo \"$1 $2\"\necho wrong >&2\nexit 2\n");
  BackupChild child("world");
  std::mutex mutex;
  std::condition_variable changed;
  std::optional<CommandAnswer> answer;
  child.run({"backup", "add"}, [&](const CommandAnswer& given) {
    const std::lock_guard guard(mutex);
    answer = given;
    changed.notify_all();
  });
  std::unique_lock lock(mutex);
  changed.wait(lock, [&] { return answer.has_value(); });
  CHECK(answer->text == "backup add\nwrong");
  CHECK_FALSE(answer->is_ok);
}

}  // namespace runstone::test
