#include "server/admin/activity_commands.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>
#include <vector>

#include "common/core/utc_text.hpp"
#include "protocol/codec/key_fingerprint.hpp"
#include "server/admin/command_call.hpp"
#include "server/admin/server_health.hpp"

namespace runstone {
namespace {

Result<ActivityCommand, std::string> parse_activity(WordReader& reader) {
  constexpr const char* kOptions = "by PLAYER, since MOMENT, until MOMENT, limit N or --csv";
  ActivityCommand command;
  while (!reader.at_end()) {
    const std::string word = reader.take("activity", kOptions);
    if (word == "by") {
      command.by = reader.player("activity by");
    } else if (word == "since") {
      command.from_us = reader.moment(word);
    } else if (word == "until") {
      command.until_us = reader.moment(word);
    } else if (word == "limit") {
      command.limit = static_cast<std::uint64_t>(
          reader.number(word, 1, static_cast<std::int64_t>(kActivityLinesMax)));
    } else if (word == "csv" || word == "--csv") {
      command.is_csv = true;
    } else {
      reader.wrong("activity \"" + word + "\": " + kOptions);
    }
  }
  return reader.result(command);
}

void show_activity(const CommandCall& call, const ActivityCommand& command) {
  call.world().commit(call.now);
  const std::vector<std::string> words =
      command.by.empty() ? std::vector<std::string>() : std::vector{command.by};
  call.find_players(
      words, {},
      [call, command](const CommandCall::FoundPlayers& found) {
        const KnownPlayers& known = *found.known;
        SelectionFilter filter;
        filter.from_us = command.from_us.value_or(filter.from_us);
        filter.until_us = command.until_us.value_or(filter.until_us);
        filter.last = call.world().order().durable();
        for (const PublicKey& key : found.keys) {
          const auto author = known.author_of(key);
          if (!author) {
            return call.refuse("activity by \"" + command.by + "\": " + known.text_of(key) +
                               " has never built (players lists who has)");
          }
          filter.authors.push_back(*author);
        }
        std::set<AuthorId> present;
        for (const OnlinePlayer& player : call.world().people().online())
          present.insert(player.author);
        call.on_worker(
            "activity: ",
            [filter, limit = command.limit](WorldReader& reader) {
              return read_activity(reader, filter, limit);
            },
            [call, players = found.known, present,
             is_csv = command.is_csv](const ActivityReport& report) {
              call.answer((is_csv ? activity_csv : activity_table)(report, *players, present));
            });
      },
      "activity by ");
}

/// Returns the text in quotes if CSV needs them.
std::string csv_field(std::string text) {
  // "=1+1" and the like are formulas for spreadsheets, and a name may be one.
  if (!text.empty() && std::string_view("=+-@").find(text[0]) != std::string_view::npos)
    text.insert(0, 1, '\'');
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + "\"";
}

std::string padded_left(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, text.size()), ' ') + text;
}

constexpr std::array<CommandRow, 1> kActivityRows = {{
    {"activity", needs(Right::moderate),
     "activity [by PLAYER] [since MOMENT] [until MOMENT] [limit N] [--csv]\n"
     "                          how much each player has built, who has built most first",
     parsed_by<parse_activity, show_activity>()},
}};

}  // namespace

std::span<const CommandRow> activity_commands() { return kActivityRows; }

std::string activity_table(const ActivityReport& report, const KnownPlayers& players,
                           const std::set<AuthorId>& present) {
  if (report.players.empty()) return "no edit matches";
  constexpr std::size_t kNumberWidth = 10, kTimeWidth = 13, kDateWidth = 22;
  std::string text = padded_left("edits", kNumberWidth) + padded_left("voxels", kNumberWidth + 2) +
                     padded_left("building", kTimeWidth) + padded_left("first edit", kDateWidth) +
                     padded_left("last edit", kDateWidth) + "  player";
  for (const PlayerActivity& player : report.players) {
    text += "\n" + padded_left(std::to_string(player.edits), kNumberWidth) +
            padded_left(std::to_string(player.voxels), kNumberWidth + 2) +
            padded_left(uptime_text(player.building_us), kTimeWidth) +
            padded_left(utc_text(player.first_us), kDateWidth) +
            padded_left(utc_text(player.last_us), kDateWidth) + "  " +
            players.text_of(player.author) + (present.contains(player.author) ? ", is here" : "");
  }
  if (report.players_found > report.players.size()) {
    text += "\nand " + std::to_string(report.players_found - report.players.size()) +
            " more players (limit N lists more)";
  }
  if (!report.is_complete) {
    text +=
        "\nolder edits than " + utc_text(report.from_us) +
        " were not counted, because that takes too long: say by PLAYER or until MOMENT to count "
        "others";
  }
  return text;
}

std::string activity_csv(const ActivityReport& report, const KnownPlayers& players,
                         const std::set<AuthorId>& present) {
  std::string text =
      "author,name,fingerprint,edits,voxels,building_s,first_edit,last_edit,is_here,counted_from";
  // If all edits were counted, the column is empty.
  const std::string from = report.is_complete ? "" : utc_text(report.from_us);
  for (const PlayerActivity& player : report.players) {
    const auto key = players.key_of(player.author);
    text += "\n" + std::to_string(player.author) + "," +
            csv_field(key ? players.name_of(*key) : "") + "," + (key ? key_fingerprint(*key) : "") +
            "," + std::to_string(player.edits) + "," + std::to_string(player.voxels) + "," +
            std::to_string(player.building_us / 1'000'000) + "," + utc_text(player.first_us) + "," +
            utc_text(player.last_us) + "," + (present.contains(player.author) ? "1" : "0") + "," +
            from;
  }
  return text;
}

}  // namespace runstone
