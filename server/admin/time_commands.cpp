#include "server/admin/time_commands.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string>

#include "common/core/world_time.hpp"
#include "server/admin/command_call.hpp"

namespace runstone {
namespace {

/// The time from which a clock runs that nobody has set: that of clients without a clock.
constexpr std::uint32_t kUnsetDayMs = kDayMs / 10 * 4;  // 9:36

constexpr CommandRule kKeepersOfTime = needs(Right::moderate, Right::administer);

std::string words_of(const WorldTime& time) {
  const std::string text = day_time_text(time.day_ms);
  if (time.rate == 0) return text + ", and it stands still (rate 0)";
  const double seconds = kDayMs / 1000.0 / time.rate;
  return text + fmt::format(" at rate {}: a day takes {}", time.rate,
                            seconds < 100 ? fmt::format("{:.1f} s", seconds)
                                          : fmt::format("{:.0f} min", seconds / 60));
}

WorldTime time_now(const CommandCall& call) {
  return call.world().order().clock().at(call.now.steady_us).value_or(WorldTime{kUnsetDayMs, 0});
}

void set_time(const CommandCall& call, const WorldTime& time) {
  if (const auto why = call.world().cluster().clock_refusal()) return call.refuse("time: " + *why);
  const auto record = call.world().changes().set_clock(time, call.caller.author, call.now);
  if (!record) return call.refuse("time: " + record.error());
  call.answer_when_durable(*record, "the time of the world is " + words_of(time) + " (record " +
                                        std::to_string(*record) + ")");
}

/// The arguments of the command time. It shows the time if both are absent. Otherwise it sets the
/// time of day or the rate.
struct TimeWish {
  std::optional<std::uint32_t> day_ms, rate;
};

Result<TimeWish, std::string> parse_day(WordReader& reader) {
  const std::string word = reader.take_only("a time from 0:00 to 23:59, such as 21:00");
  if (!reader.error().empty()) return failure(reader.error());
  const auto day_ms = parse_day_ms(word);
  if (!day_ms)
    return failure("time \"" + word + "\": a time from 0:00 to 23:59, such as 21:00, or rate N");
  return TimeWish{day_ms, std::nullopt};
}

Result<TimeWish, std::string> parse_rate(WordReader& reader) {
  TimeWish wish;
  wish.rate = static_cast<std::uint32_t>(reader.number("rate", 0, kTimeRateMax));
  reader.expect_end("rate N");
  return reader.result(wish, "time ");
}

void show_time(const CommandCall& call) {
  const auto time = call.world().order().clock().at(call.now.steady_us);
  if (!time)
    return call.answer(
        "the world has no time of day: each player chooses one. `time 21:00` and `time rate 20` set "
        "one");
  call.answer("the time of the world is " + words_of(*time));
}

void change_time(const CommandCall& call, const TimeWish& wish) {
  const WorldTime now = time_now(call);
  set_time(call, {wish.day_ms.value_or(now.day_ms), wish.rate.value_or(now.rate)});
}

constexpr std::array<CommandRow, 3> kTimeRows = {{
    {"time", kForEverybody, "time                      the time of day of the world, and its rate",
     alone<show_time>()},
    {"time rate", kKeepersOfTime,
     "time rate N               seconds of the world in a second, 0 to 10000; 0 stands still",
     parsed_by<parse_rate, change_time>()},
    {"time HH:MM", kKeepersOfTime, "time HH:MM                set the time of day of the world",
     parsed_by<parse_day, change_time>()},
}};

}  // namespace

std::span<const CommandRow> time_commands() { return kTimeRows; }

}  // namespace runstone
