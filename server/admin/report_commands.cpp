#include "server/admin/report_commands.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "common/core/key_text.hpp"
#include "common/core/text.hpp"
#include "common/core/utc_text.hpp"
#include "protocol/codec/key_fingerprint.hpp"
#include "protocol/limits.hpp"
#include "protocol/rules/chat_text.hpp"
#include "server/admin/command_call.hpp"
#include "server/admin/line_text.hpp"

namespace runstone {
namespace {

std::string report_line(const PlayerReport& report) {
  return std::to_string(report.number) + " " + utc_text(report.time_us) + " " + report.who +
         " at " + text_of(report.at) + ": " + report.text;
}

/// Tells the moderators who are here. A longer text than a line of chat is cut.
void tell_moderators(const CommandCall& call, const std::string& text) {
  const auto line = chat_text(cut_utf8(text, kChatBytesMax));
  if (!line) return;
  call.world().people().chat().tell_those(
      [call](const PublicKey& key) {
        return call.services.is_operator(key) ||
               call.rights().decide(key, Right::moderate, call.rights_time()).is_allowed;
      },
      *line, call.now);
}

void take_report(const CommandCall& call, const std::string& text) {
  if (!call.caller.actor.key)
    return call.refuse("report: players report; `reports` lists what they have reported");
  const PublicKey& key = *call.caller.actor.key;
  const auto online = call.world().people().online();
  const auto player = std::ranges::find(online, key, &OnlinePlayer::key);
  if (player == online.end()) return call.refuse("report: you are not here any more");
  PlayerReport report;
  report.key = key;
  report.who = player->name + " #" + std::to_string(player->author) + " " + key_fingerprint(key);
  report.time_us = call.rights_time();
  report.at = {static_cast<std::int32_t>(std::floor(player->at.x)),
               static_cast<std::int32_t>(std::floor(player->at.y)),
               static_cast<std::int32_t>(std::floor(player->at.z))};
  report.text = text;
  const auto number = call.services.reports.add(report, call.now.steady_us);
  if (!number) return call.refuse("report: " + number.error());
  report.number = *number;
  // The names of the reporters in the log let a host find a report after a restart.
  if (call.services.actions.log_line)
    call.services.actions.log_line("report " + report_line(report));
  tell_moderators(call, "report " + std::to_string(*number) + " of " + player->name + " at " +
                            text_of(report.at) + ": " + text);
  call.answer("the moderators of this world can read it (report " + std::to_string(*number) + ")");
}

void list_reports(const CommandCall& call) {
  std::string text;
  for (const PlayerReport& report : call.services.reports.open())
    text += (text.empty() ? "" : "\n") + report_line(report);
  call.answer(text.empty() ? "no report is open" : text);
}

Result<std::uint64_t, std::string> parse_close(WordReader& reader) {
  const auto number = static_cast<std::uint64_t>(
      reader.number("reports close", 1, std::numeric_limits<std::int64_t>::max()));
  reader.expect_end("reports close N");
  return reader.result(number);
}

void close_report(const CommandCall& call, const std::uint64_t& number) {
  const auto report = call.services.reports.close(number);
  if (!report) {
    return call.refuse("reports close " + std::to_string(number) +
                       ": no open report has that number (reports lists them)");
  }
  call.answer("closed: " + report_line(*report));
}

constexpr CommandRule kModerate = needs(Right::moderate);

constexpr std::array<CommandRow, 3> kReportRows = {{
    {.words = "report",
     .rule = needs(Right::chat),
     .help = "report TEXT               tell the moderators of something, with where you are",
     .functions = parsed_by<line_text, take_report>(),
     .takes_text = true},
    {"reports", kModerate, "reports                   what players have reported",
     alone<list_reports>()},
    {"reports close", kModerate, "reports close N           remove a report from the list",
     parsed_by<parse_close, close_report>()},
}};

}  // namespace

std::span<const CommandRow> report_commands() { return kReportRows; }

}  // namespace runstone
