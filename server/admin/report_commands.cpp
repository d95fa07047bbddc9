#include "server/admin/report_commands.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "common/core/key_text.hpp"
#include "common/core/text.hpp"
#include "common/core/utc_text.hpp"
#include "common/core/world_pos.hpp"
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
  report.from = player->from;
  report.who = player->name + " #" + std::to_string(player->author) + " " + key_fingerprint(key);
  report.time_us = call.rights_time();
  report.at = voxel_of_point(player->at);
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

using ReportNumbers = std::set<std::uint64_t>;

Result<ReportNumbers, std::string> parse_close(WordReader& reader) {
  ReportNumbers numbers;
  do {
    numbers.insert(static_cast<std::uint64_t>(
        reader.number("reports close", 1, std::numeric_limits<std::int64_t>::max())));
  } while (!reader.at_end());
  return reader.result(numbers);
}

void close_reports(const CommandCall& call, const ReportNumbers& numbers) {
  PlayerReports& reports = call.services.reports;
  for (const std::uint64_t number : numbers) {
    if (std::ranges::find(reports.open(), number, &PlayerReport::number) != reports.open().end())
      continue;
    return call.refuse("reports close " + std::to_string(number) +
                       ": no open report has that number (reports lists them)" +
                       (numbers.size() > 1 ? "; none of these was closed" : ""));
  }
  std::string text;
  for (const std::uint64_t number : numbers)
    text += (text.empty() ? "closed: " : "\nclosed: ") + report_line(*reports.close(number));
  call.answer(text);
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
    {"reports close", kModerate, "reports close N ...       remove reports from the list",
     parsed_by<parse_close, close_reports>()},
}};

}  // namespace

std::span<const CommandRow> report_commands() { return kReportRows; }

}  // namespace runstone
