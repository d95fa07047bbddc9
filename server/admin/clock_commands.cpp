#include "server/admin/clock_commands.hpp"

#include <array>
#include <cstdlib>
#include <optional>
#include <string>

#include "common/core/utc_text.hpp"
#include "server/admin/command_call.hpp"
#include "server/admin/rights_change_text.hpp"

namespace runstone {
namespace {

const LogClock& clock_of(const CommandCall& call) {
  return call.world().order().authority().log_clock();
}

bool agree(const LogClock& clock) { return std::abs(clock.ahead_us()) <= LogClock::kJumpUs; }

/// Returns both times, and how far they differ.
std::string both_times(const LogClock& clock) {
  const TimeUs apart_us = clock.ahead_us();
  std::string text = "the time of the log is " + utc_text(clock.time()) +
                     ", the wall clock reads " + utc_text(clock.wall_us());
  if (agree(clock)) return text + ": they agree";
  return text + ": the log is " + apart_text(std::abs(apart_us)) +
         (apart_us > 0 ? " ahead" : " behind");
}

/// Returns why the wall clock may be wrong, or nullopt.
std::optional<std::string> doubt_of(const CommandCall& call) {
  const LogClock& clock = clock_of(call);
  if (clock.has_jumped())
    return "the wall clock has jumped within the hour, and may be wrong: " + both_times(clock);
  const auto& doubt_clock = call.services.actions.doubt_clock;
  const auto why =
      doubt_clock && clock.ahead_us() > 0 ? doubt_clock(clock.wall_us()) : std::nullopt;
  if (!why) return std::nullopt;
  return "the wall clock may be wrong, because " + *why + ": " + both_times(clock);
}

void show_clock(const CommandCall& call) {
  const LogClock& clock = clock_of(call);
  std::string text = both_times(clock);
  if (agree(clock)) return call.answer(text);
  if (clock.has_jumped()) {
    text += ". The wall clock has jumped; if it keeps the jump for an hour, the log follows";
    if (clock.ahead_us() > 0) text += ", but times of edits do not go back";
  }
  call.answer(text + ". If the wall clock is right, `clock correct` makes the log follow now");
}

/// Returns true if the command is confirmed.
Result<bool, std::string> parse_correct(WordReader& reader) {
  const bool is_confirmed = reader.take_word(kAnyway);
  reader.expect_end(reader.command());
  return reader.result(is_confirmed);
}

void correct_clock(const CommandCall& call, const bool& is_confirmed) {
  const LogClock& clock = clock_of(call);
  if (agree(clock)) {
    return call.refuse("clock correct: there is nothing to correct: " + both_times(clock) +
                       " to the minute, and the log makes up for the rest by itself");
  }
  CommandCall given = call;
  given.is_confirmed = is_confirmed;
  if (given.refuse_unless_confirmed(doubt_of(call))) return;
  const bool is_ahead = clock.ahead_us() > 0;
  const std::string step = std::string("the time of the log goes ") + (is_ahead ? "back" : "on") +
                           " from " + utc_text(clock.time()) + " to " + utc_text(clock.wall_us());
  Changes& changes = call.world().changes();
  const auto change = changes.time_correction();
  if (!change) {
    changes.accept_wall_clock();
    return call.answer(step);
  }
  if (const auto why = call.world().cluster().correction_refusal()) return call.refuse(*why);
  call.change_rights(*change, step +
                                  ". Bans, mutes, freezes and invites of the wrong clock keep the "
                                  "time that they had left");
}

constexpr CommandRule kClockAdministrators = needs(Right::administer);

constexpr std::array<CommandRow, 2> kClockRows = {{
    {"clock", kClockAdministrators,
     "clock                     the time of the log and the wall clock, and how far they differ",
     alone<show_clock>()},
    {"clock correct", kClockAdministrators,
     "clock correct [anyway]    make the time of the log that of the wall clock, after it was wrong",
     parsed_by<parse_correct, correct_clock>()},
}};

}  // namespace

std::span<const CommandRow> clock_commands() { return kClockRows; }

}  // namespace runstone
