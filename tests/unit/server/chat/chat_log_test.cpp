// The log of the chat on disk: what it keeps, for how long, and what happens when it cannot be written.
#include "server/chat/chat_log.hpp"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <future>

#include "common/core/hex.hpp"
#include "common/sqlite/sqlite_file.hpp"
#include "protocol/codec/key_fingerprint.hpp"
#include "server/runtime/read_clocks.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/core/text_contains.hpp"
#include "tests/support/sql/full_disk_vfs.hpp"

namespace runstone::test {
namespace {

using Texts = std::vector<std::string>;

ChatLog::Limits quick_limits() {
  ChatLog::Limits limits;
  limits.commit_interval = limits.warning_interval = std::chrono::milliseconds(0);
  return limits;
}

ChatEntry entry_by(std::uint8_t who, const std::string& text, TimeUs utc_us = 1'000) {
  ChatEntry entry;
  entry.line = {ChatLineKind::player, 0, "player" + std::to_string(who), text, utc_us};
  entry.key.fill(who);
  return entry;
}

ChatEntry entry_of_host(const std::string& text) {
  return {{ChatLineKind::server, 0, "", text, 1'000}, {}};
}

/// A log in a folder of its own, with the warnings that it wrote.
struct LogBench {
  explicit LogBench(ChatLog::Limits limits = quick_limits()) : limits_(limits) { open(); }

  void open(TimeUs forget_before_us = 0) {
    log.reset();
    log = std::make_unique<ChatLog>(
        folder.path(), forget_before_us,
        [this](const std::string& line) {
          const std::lock_guard guard(mutex_);
          warnings_.push_back(line);
        },
        limits_);
  }
  ChatLog::Found find(const ChatQuery& query) {
    const auto found = std::make_shared<std::promise<ChatLog::Found>>();
    REQUIRE(log->search(query, [found](const ChatLog::Found& f) { found->set_value(f); }));
    return found->get_future().get();
  }
  Texts texts(const std::string& by = "", std::uint64_t limit = kChatLinesListedMax) {
    const auto found = find({by, std::nullopt, limit});
    INFO((found ? "" : found.error()));
    REQUIRE(found.has_value());
    Texts all;
    for (const ChatEntry& entry : *found) all.push_back(entry.line.text);
    return all;
  }
  Texts warnings() {
    const std::lock_guard guard(mutex_);
    return warnings_;
  }
  std::string file(const std::string& end = "") const { return folder / ("chat.sqlite" + end); }

  TempFolder folder;
  std::unique_ptr<ChatLog> log;

 private:
  ChatLog::Limits limits_;
  std::mutex mutex_;
  Texts warnings_;
};

TEST_CASE("lines come back in their order after a restart, in a file for its owner only",
          "[chat]") {
  LogBench bench;
  const std::vector<ChatEntry> entries = {entry_by(1, "hello"), entry_of_host("restart at ten"),
                                          entry_by(2, "bye", 7)};
  for (const ChatEntry& entry : entries) bench.log->append(entry);
  bench.open();
  const auto found = bench.find({});
  REQUIRE(found.has_value());
  CHECK(*found == entries);
  struct stat status{};
  for (const char* end : {"", "-wal", "-shm"}) {
    REQUIRE(::stat(bench.file(end).c_str(), &status) == 0);
    CHECK((status.st_mode & 0777) == 0600);
  }
  CHECK(bench.warnings().empty());
}

TEST_CASE("the log keeps withdrawn lines, and a search may leave them out", "[chat]") {
  LogBench bench;
  bench.log->append(entry_by(1, "buy gold", 10));
  bench.log->append(entry_by(2, "hello", 10));
  bench.log->append(entry_by(1, "good morning", 20));
  bench.log->withdraw(entry_by(1, "").key, {10, 30});
  bench.log->append(entry_by(1, "after it", 40));
  for (int round = 0; round < 2; ++round) {
    const auto all = bench.find({"", std::nullopt, 10});
    REQUIRE(all.has_value());
    REQUIRE(all->size() == 4);
    CHECK((*all)[0].is_withdrawn);
    CHECK_FALSE((*all)[1].is_withdrawn);
    CHECK_FALSE((*all)[2].is_withdrawn);
    const auto rest = bench.find({"", std::nullopt, 2, false});
    REQUIRE(rest.has_value());
    REQUIRE(rest->size() == 2);
    CHECK(rest->front().line.text == "good morning");
    bench.open();
  }
}

TEST_CASE("a log of a version without withdrawn lines is continued", "[chat]") {
  LogBench bench;
  bench.log->append(entry_by(1, "old", 10));
  bench.log.reset();
  {
    auto file = sql::open_sqlite(bench.folder.path() + "/chat.sqlite", sql::SqliteMode::create);
    REQUIRE(file.has_value());
    REQUIRE(file->run("ALTER TABLE line DROP COLUMN withdrawn").has_value());
  }
  bench.open();
  bench.log->append(entry_by(1, "new", 20));
  CHECK(bench.texts() == Texts{"old", "new"});
  CHECK(bench.warnings().empty());
}

TEST_CASE("a search selects lines by player and time, the newest ones", "[chat]") {
  LogBench bench;
  for (int i = 0; i < 6; ++i)
    bench.log->append(entry_by(static_cast<std::uint8_t>(1 + i % 2), std::to_string(i), i));
  bench.log->append(entry_of_host("host"));
  CHECK(bench.texts("", 2) == Texts{"5", "host"});
  CHECK(bench.texts("PLAYER1") == Texts{"0", "2", "4"});
  CHECK(bench.texts("server") == Texts{"host"});
  CHECK(bench.texts("nobody").empty());
  PublicKey key{};
  key.fill(2);
  CHECK(bench.texts(key_fingerprint(key)) == Texts{"1", "3", "5"});
  CHECK(bench.texts(to_hex(key)) == Texts{"1", "3", "5"});
  const auto since = bench.find({"player2", 3, 20});
  REQUIRE(since.has_value());
  CHECK(since->size() == 2);
}

TEST_CASE("lines that a wrong clock has dated ahead are neither new nor kept for longer",
          "[chat][clock]") {
  LogBench bench;
  bench.log->append(entry_by(1, "before", 10));
  bench.log->append(entry_by(1, "of the wrong clock", 1'000'000));
  bench.log->append(entry_by(2, "corrected", 20));
  bench.log->append(entry_by(1, "after", 30));
  const auto since = bench.find({"player1", 25, 20});
  REQUIRE(since.has_value());
  REQUIRE(since->size() == 1);
  CHECK(since->front().line.text == "after");
  // A time before the correction selects all that came after it.
  CHECK(bench.find({"", 15, 20})->size() == 3);
  bench.log->forget_before(25);
  CHECK(bench.texts() == Texts{"after"});
}

TEST_CASE("lines are kept for their time, also while the log is open, and then no byte is left",
          "[chat]") {
  LogBench bench;
  const std::string secret = "an old secret that nobody may read any more";
  bench.log->append(entry_by(1, secret, 10));
  bench.log->append(entry_by(1, "newer", 20));
  CHECK(bench.texts().size() == 2);
  bench.log->forget_before(15);
  CHECK(bench.texts() == Texts{"newer"});
  bench.open(25);
  CHECK(bench.texts().empty());
  bench.log->stop();
  for (const auto& file : std::filesystem::directory_iterator(bench.folder.path())) {
    std::ifstream in(file.path(), std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    CHECK_FALSE(contains(bytes, secret));
  }
}

TEST_CASE("the file holds the newest lines and does not grow beyond them", "[chat]") {
  ChatLog::Limits limits = quick_limits();
  limits.lines_max = 200;
  LogBench bench(limits);
  for (int i = 0; i < 5'000; ++i) {
    bench.log->append(entry_by(1, std::string(500, 'x') + std::to_string(i)));
    if (i % 100 == 0) bench.texts();  // so that the queue does not fill
  }
  const Texts kept = bench.texts();
  REQUIRE(kept.size() == 200);
  CHECK(kept.back().ends_with("x4999"));
  bench.log->stop();
  bench.log.reset();
  CHECK(std::filesystem::file_size(bench.file()) < 200 * 1'024);
}

TEST_CASE("lines beyond the queue are not logged, and a warning counts them", "[chat]") {
  ChatLog::Limits limits = quick_limits();
  limits.queued_lines_max = 10;
  limits.commit_interval = std::chrono::hours(1);
  LogBench bench(limits);
  bench.log->append(entry_by(1, "first"));
  CHECK(bench.texts().size() == 1);  // the next commit is an hour away, unless somebody searches
  for (int i = 0; i < 25; ++i) bench.log->append(entry_by(1, std::to_string(i)));
  bench.log->stop();
  const Texts warnings = bench.warnings();
  REQUIRE(warnings.size() == 1);
  CHECK(contains(warnings[0], "lines=15 "));
  bench.open();
  CHECK(bench.texts().size() == 11);
}

TEST_CASE("a damaged file is set aside, and the lines go to a new one", "[chat]") {
  LogBench bench;
  bench.log->append(entry_by(1, "before"));
  bench.log.reset();
  SECTION("it is no database") {
    std::ofstream(bench.file(), std::ios::binary | std::ios::trunc) << std::string(8'192, 'x');
  }
  SECTION("its pages are damaged") {
    std::fstream file(bench.file(), std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(100);
    file << std::string(8'192, '\xff');
  }
  SECTION("it has the tables of another program") {
    std::filesystem::remove(bench.file());
    auto other = sql::open_sqlite(bench.file(), sql::SqliteMode::create);
    REQUIRE(other.has_value());
    REQUIRE(other->run("CREATE TABLE t(x); PRAGMA user_version = 9").has_value());
  }
  bench.open();
  bench.log->append(entry_by(1, "after"));
  CHECK(bench.texts() == Texts{"after"});
  CHECK(std::filesystem::exists(bench.file(".damaged")));
  REQUIRE(bench.warnings().size() == 1);
  CHECK(contains(bench.warnings()[0], "damaged"));
  bench.log.reset();
  remove_chat_log(bench.folder.path());
  CHECK(std::filesystem::is_empty(bench.folder.path()));
}

TEST_CASE("a file that was set aside is removed when its lines would have been", "[chat]") {
  LogBench bench;
  bench.log.reset();
  std::ofstream(bench.file(), std::ios::binary | std::ios::trunc) << std::string(8'192, 'x');
  bench.open();
  REQUIRE(std::filesystem::exists(bench.file(".damaged")));
  const TimeUs now_us = read_clocks().utc_us;
  constexpr TimeUs kHourUs = 3'600'000'000;
  bench.open(now_us - kHourUs);
  CHECK(std::filesystem::exists(bench.file(".damaged")));
  bench.open(now_us + kHourUs);
  CHECK_FALSE(std::filesystem::exists(bench.file(".damaged")));
}

TEST_CASE("rows that no line can be are left out", "[chat]") {
  LogBench bench;
  bench.log->append(entry_by(1, "sound"));
  bench.log.reset();
  {
    auto database = sql::open_sqlite(bench.file(), sql::SqliteMode::write);
    REQUIRE(database.has_value());
    for (const char* row : {"5, 1, zeroblob(32), 'a\"b', 'text'", "5, 1, zeroblob(31), 'a', 'text'",
                            "5, 3, zeroblob(32), '', 'text'", "5, 2, zeroblob(32), 'a', 'text'",
                            "5, 1, zeroblob(32), 'a', ''", "5, 1, zeroblob(32), 'a', x'ff0a'",
                            "9223372036854775807, 1, zeroblob(32), 'a', 'text'"}) {
      const std::string insert =
          std::string("INSERT INTO line(utc_us, kind, key, name, text) VALUES(") + row + ")";
      REQUIRE(database->run(insert.c_str()).has_value());
    }
  }
  bench.open();
  CHECK(bench.texts() == Texts{"sound"});
}

TEST_CASE("on a full disk lines are not logged, and later ones are when there is space", "[chat]") {
  FullDiskVfs disk;
  LogBench bench;
  bench.log->append(entry_by(1, "before"));
  CHECK(bench.texts().size() == 1);
  disk.fill();
  bench.log->append(entry_by(1, "lost"));
  while (bench.warnings().empty()) std::this_thread::yield();
  CHECK(contains(bench.warnings()[0], "lines=1 "));
  disk.make_room();
  bench.log->append(entry_by(1, "after"));
  CHECK(bench.texts() == Texts{"before", "after"});
  bench.log.reset();
}

TEST_CASE("on a full disk lines are withdrawn when there is space", "[chat]") {
  FullDiskVfs disk;
  LogBench bench;
  const ChatEntry entry = entry_by(1, "rude");
  bench.log->append(entry);
  CHECK(bench.texts().size() == 1);
  disk.fill();
  bench.log->withdraw(entry.key, {entry.line.utc_us});
  static_cast<void>(bench.find({}));  // the withdrawal is tried before
  disk.make_room();
  bool is_withdrawn = false;
  while (!is_withdrawn) {
    const auto found = bench.find({});
    REQUIRE(found.has_value());
    REQUIRE(found->size() == 1);
    is_withdrawn = found->front().is_withdrawn;
  }
  CHECK(bench.warnings().empty());
  bench.log.reset();
}

TEST_CASE("a file that cannot be opened is a warning, and searches say why", "[chat]") {
  LogBench bench;
  bench.log.reset();
  remove_chat_log(bench.folder.path());
  std::filesystem::create_directory(bench.file());
  bench.open();
  bench.log->append(entry_by(1, "lost"));
  const auto found = bench.find({});
  REQUIRE_FALSE(found.has_value());
  CHECK(contains(found.error(), "chat.sqlite"));
  bench.log->stop();
  CHECK(bench.warnings().size() >= 1);
  CHECK_FALSE(bench.log->search({}, [](const ChatLog::Found&) {}));
}

}  // namespace
}  // namespace runstone::test
