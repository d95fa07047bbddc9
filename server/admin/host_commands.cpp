#include "server/admin/host_commands.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "protocol/codec/key_fingerprint.hpp"
#include "server/admin/command_call.hpp"
#include "server/admin/line_text.hpp"
#include "server/admin/material_file.hpp"
#include "server/admin/world_lists.hpp"

namespace runstone {
namespace {

constexpr const char* kCannot = "this server cannot do that";

Result<std::string, std::string> parse_name(WordReader& reader) {
  return reader.result(reader.take_only("one name comes after it, in quotes if it has blanks"));
}

void release_name(const CommandCall& call, const std::string& name) {
  const auto released = call.world().people().names().release(name);
  if (!released) return call.refuse("names release: " + released.error());
  call.answer_when_names_durable("\"" + released->name + "\" was owned by " +
                                 key_fingerprint(released->key) +
                                 "; the next player who joins under it owns it");
}

Result<std::string, std::string> parse_material_file(WordReader& reader) {
  return reader.result(reader.take_only("one file comes after it, in quotes if it has blanks"));
}

/// Returns how many materials were added, the record, and a line for each.
std::string added_text(const AddedAt& at, const std::vector<MaterialRow>& rows) {
  std::string text = std::to_string(rows.size()) + (rows.size() == 1 ? " material" : " materials") +
                     " added (record " + std::to_string(at.seq) + ")";
  for (const std::string& line : material_lines(at.first, rows)) text += "\n" + line;
  return text;
}

void add_materials(const CommandCall& call, const std::string& file) {
  call.on_worker(
      "materials add: ", [file](WorldReader&) { return read_material_file(file); },
      [call, file](const std::vector<MaterialFileRow>& read) {
        std::vector<MaterialRow> rows;
        for (const MaterialFileRow& each : read) rows.push_back(each.row);
        const bool has_shape = std::any_of(
            rows.begin(), rows.end(), [](const MaterialRow& row) { return !row.shape.is_cube(); });
        const auto why = has_shape ? call.world().cluster().shapes_refusal() : std::nullopt;
        if (why) return call.refuse("materials add: " + *why);
        const auto added = call.world().changes().add_materials(rows, call.now);
        if (added) return call.answer_when_durable(added->seq, added_text(*added, rows));
        TextError wrong{file, 0, "", added.error().what};
        if (const auto row = added.error().row) {
          wrong.line = read[*row].line;
          wrong.key = "material[" + std::to_string(*row) + "]";
        }
        call.refuse("materials add: " + wrong.message());
      });
}

void say(const CommandCall& call, const std::string& text) {
  const std::size_t sessions =
      call.world().people().chat().say(text, call.caller.actor.key.value_or(PublicKey{}), call.now);
  call.answer("sent to " + std::to_string(sessions) + (sessions == 1 ? " session" : " sessions"));
}

Result<Announcement, std::string> parse_announce(WordReader& reader) {
  auto announcement = parse_announcement(reader.text());
  if (!announcement) return failure("announce: " + announcement.error());
  return announcement;
}

void announce(const CommandCall& call, const Announcement& announcement) {
  const auto added = call.services.announcements.add(announcement);
  if (!added) return call.refuse("announce: " + added.error());
  call.answer("announced until the server stops: " + text_of(announcement));
}

void list_announcements(const CommandCall& call) {
  call.answer(call.services.announcements.list());
}

Result<std::size_t, std::string> parse_announcement_number(WordReader& reader) {
  const std::int64_t number = reader.number("announcements remove", 1, 1'000);
  reader.expect_end("announcements remove N");
  return reader.result(static_cast<std::size_t>(number));
}

void remove_announcement(const CommandCall& call, const std::size_t& number) {
  const auto removed = call.services.announcements.remove(number);
  if (!removed) return call.refuse("announcements remove: " + removed.error());
  call.answer("no longer announced: " + text_of(*removed));
}

Result<std::string, std::string> parse_backup(WordReader& reader) {
  return reader.result(reader.take_only("the new folder comes after it"));
}

void back_up(const CommandCall& call, const std::string& folder) {
  const auto& action = call.services.actions.back_up;
  if (!action) return call.refuse(kCannot);
  action(folder, call.reply);
}

void reload(const CommandCall& call) {
  const auto& action = call.services.actions.reload;
  if (!action) return call.refuse(kCannot);
  action(call.reply);
}

void reload_at_follower(const FollowerCall& call) {
  if (!call.actions.reload) return refuse(call.reply, kGiveThere);
  call.actions.reload(call.reply);
}

void list_servers(const CommandCall& call) {
  call.answer(server_list(call.world().cluster().known_servers()));
}

/// Parses the number of a server. Without one the server with the most players is meant.
Result<std::optional<SessionId>, std::string> parse_server(WordReader& reader) {
  constexpr const char* kRule =
      "the number of one server comes after it, or nothing (servers lists them)";
  if (reader.at_end()) return std::optional<SessionId>();
  const auto number = number_of<SessionId>(reader.take_only(kRule));
  if (!number) reader.wrong(reader.command() + ": " + kRule);
  return reader.result(number);
}

void hand_over(const CommandCall& call, const std::optional<SessionId>& successor) {
  if (const auto why = call.world().cluster().handover_refusal(successor))
    return call.refuse("handover: " + *why);
  const auto& action = call.services.actions.hand_over;
  if (!action) return call.refuse(kCannot);
  // A player at another server gets no later line: the next owner does not know of the command.
  call.report("handing the world over");
  action(successor, call.reply);
}

void stop(const CommandCall& call) {
  call.answer("the server stops");
  if (call.services.actions.stop) call.services.actions.stop();
}

void stop_follower(const FollowerCall& call) {
  call.actions.stop();
  call.reply(CommandAnswer::last(""));
}

constexpr CommandRule kAdministrators = needs(Right::administer);

constexpr std::array<CommandRow, 11> kHostRows = {{
    {"names release", kAdministrators,
     "names release NAME        free a name, so that the next player who joins under it owns it",
     parsed_by<parse_name, release_name>()},
    {"materials add FILE", kLocal, "materials add FILE        add the materials of a file",
     parsed_by<parse_material_file, add_materials>()},
    {.words = "say",
     .rule = kAdministrators,
     .help = "say TEXT                  write to all players, as the server",
     .functions = parsed_by<line_text, say>(),
     .takes_text = true},
    {.words = "announce",
     .rule = kAdministrators,
     .help = "announce every DURATION TEXT, announce at HH:MM TEXT\n"
             "                          write a line to all players again and again, until the "
             "server stops",
     .functions = parsed_by<parse_announce, announce>(),
     .takes_text = true},
    {"announcements", kAdministrators, "announcements             the lines that are announced",
     alone<list_announcements>()},
    {"announcements remove", kAdministrators, "announcements remove N    announce a line no longer",
     parsed_by<parse_announcement_number, remove_announcement>()},
    {"backup", kLocal,
     "backup DIR                copy the world to a new folder, while people go on playing",
     parsed_by<parse_backup, back_up>()},
    {.words = "reload",
     .rule = kLocal,
     .help = "reload                    read the settings again",
     .functions = alone<reload>(),
     .run_at_follower = reload_at_follower},
    {"servers", kAdministrators,
     "servers                   the servers of the world, with their numbers",
     alone<list_servers>()},
    {"handover", kAdministrators,
     "handover [SERVER]         let another server own the world; nobody has to connect again",
     parsed_by<parse_server, hand_over>()},
    {.words = "stop",
     .rule = kAdministrators,
     .help = "stop                      stop the server",
     .functions = alone<stop>(),
     .run_at_follower = stop_follower},
}};

}  // namespace

std::span<const CommandRow> host_commands() { return kHostRows; }

}  // namespace runstone
