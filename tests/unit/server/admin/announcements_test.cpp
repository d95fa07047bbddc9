// Lines that the server announces at an interval, or at a time of the day.
#include "server/admin/announcements.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "server/admin/command_table.hpp"
#include "server/admin/server_config.hpp"
#include "tests/support/core/text_contains.hpp"
#include "tests/unit/server/admin/command_bench.hpp"

namespace runstone::test {
namespace {

constexpr TimeUs kMinuteUs = 60'000'000, kDayOfTestUs = 1'440 * kMinuteUs;

/// Announcements, and what they have said.
struct AnnouncementBench {
  void tick(TimeUs later_us) {
    now_us += later_us;
    announcements.tick(now_us, now_us + wall_us,
                       [this](const std::string& text) { said.push_back(text); });
  }
  std::vector<std::string> take() { return std::exchange(said, {}); }
  Announcements announcements;
  TimeUs now_us = 5 * kMinuteUs;
  TimeUs wall_us = 1'000 * kDayOfTestUs;  // the days begin at midnight
  std::vector<std::string> said;
};

using Said = std::vector<std::string>;

}  // namespace

TEST_CASE("announcements are read and written back", "[admin][announcements]") {
  const std::string text = "every 30m read the rules | at 20:00 the shop closes | every 1h30m hi";
  const auto read = parse_announcements(text);
  REQUIRE(read.has_value());
  REQUIRE(read->size() == 3);
  CHECK((*read)[0] == Announcement{30 * kMinuteUs, 0, "read the rules"});
  CHECK((*read)[1] == Announcement{0, 72'000'000, "the shop closes"});
  CHECK(text_of(*read) == text);
  CHECK(parse_announcements("  ")->empty());
  ServerConfig config;
  REQUIRE(set_config(config, "announcements", text).has_value());
  CHECK(config.announcements == *read);
  CHECK(config_text(config, "announcements") == text);
}

TEST_CASE("bad announcements are refused with what is wrong", "[admin][announcements]") {
  const auto error = [](const std::string& text) { return parse_announcements(text).error(); };
  CHECK(contains(error("hello"), "every DURATION TEXT, or at HH:MM TEXT"));
  CHECK(contains(error("every 5s hello"), "a time from 1m to 7d"));
  CHECK(contains(error("every 8d hello"), "a time from 1m to 7d"));
  CHECK(contains(error("every soon hello"), "every \"soon\""));
  CHECK(contains(error("at 25:00 hello"), "a time from 0:00 to 23:59"));
  CHECK(contains(error("every 30m"), "is refused: it is empty"));
  CHECK(contains(error("every 30m a |"), "every DURATION TEXT"));
  std::string many = "every 1m a";
  for (std::size_t i = 1; i <= kAnnouncementsMax; ++i) many += "|every 1m a";
  CHECK(contains(error(many), "more than 16"));
}

TEST_CASE("a line comes again and again, also after the settings were read anew",
          "[admin][announcements]") {
  AnnouncementBench bench;
  const std::vector<Announcement> rules = {{30 * kMinuteUs, 0, "rules"}};
  bench.announcements.set_configured(rules);
  bench.tick(0);
  bench.tick(29 * kMinuteUs);
  CHECK(bench.take().empty());
  bench.announcements.set_configured(rules);
  bench.tick(kMinuteUs);
  CHECK(bench.take() == Said{"rules"});
  bench.tick(90 * kMinuteUs);  // missed lines come once
  CHECK(bench.take() == Said{"rules"});
  bench.announcements.set_configured({});
  bench.tick(90 * kMinuteUs);
  CHECK(bench.take().empty());
}

TEST_CASE("a line comes once a day at its time, and not when the clock jumps",
          "[admin][announcements]") {
  AnnouncementBench bench;
  REQUIRE(bench.announcements.add({0, 10 * 60'000, "ten past"}).has_value());
  bench.tick(0);
  bench.tick(4 * kMinuteUs);
  CHECK(bench.take().empty());
  bench.tick(kMinuteUs);
  CHECK(bench.take() == Said{"ten past"});
  bench.tick(kMinuteUs);
  CHECK(bench.take().empty());
  bench.wall_us -= 3 * kMinuteUs;                                    // the clock was set back
  for (int minute = 0; minute < 5; ++minute) bench.tick(kMinuteUs);  // the time comes again
  CHECK(bench.take().empty());
  bench.wall_us += 2 * kDayOfTestUs;  // and far ahead
  bench.tick(kMinuteUs);
  CHECK(bench.take().empty());
}

TEST_CASE("commands add, list and remove announcements", "[admin][announcements]") {
  CommandBench bench;
  CommandServices services = bench.services();
  services.announcements.set_configured({{60 * kMinuteUs, 0, "from the settings"}});
  const auto give = [&](const std::string& line) {
    bench.answers.clear();
    give_command({services, {}, bench.bench.now(), bench.reply()}, line);
    return bench.answer();
  };
  CHECK(give("announce every 30m don't \"dig\" here").is_ok);
  CHECK(give("announcements").text ==
        "1 every 1h from the settings (setting)\n2 every 30m don't \"dig\" here");
  CHECK(contains(give("announcements remove 1").text, "is one of the setting"));
  CHECK(contains(give("announcements remove 3").text, "there is no announcement 3"));
  CHECK_FALSE(give("announce now").is_ok);

  // Nobody is here to read the first one.
  const auto tick = [&](TimeUs later_us) {
    bench.bench.time_us += later_us;
    services.tick(bench.bench.now());
    bench.bench.tick();
  };
  tick(0);
  tick(31 * kMinuteUs);
  CHECK(bench.bench.environment.chat.empty());
  bench.bench.join(kBuilder, kBuilder, 1, {}, kFeatureChat);
  tick(31 * kMinuteUs);
  REQUIRE(bench.bench.environment.chat.size() == 2);
  CHECK(bench.bench.environment.chat[0].line.text == "from the settings");
  CHECK(bench.bench.environment.chat[1].line.text == "don't \"dig\" here");
  CHECK(give("announcements remove 2").text == "no longer announced: every 30m don't \"dig\" here");
  for (std::size_t i = 0; i < kAnnouncementsMax; ++i) CHECK(give("announce every 1m a").is_ok);
  CHECK_FALSE(give("announce every 1m a").is_ok);
}

}  // namespace runstone::test
