#include "server/admin/player_commands.hpp"

#include <array>

#include "common/core/key_text.hpp"
#include "server/admin/command_call.hpp"
#include "server/admin/command_table.hpp"
#include "server/admin/rights_lists.hpp"
#include "server/admin/rights_reason.hpp"
#include "server/admin/world_lists.hpp"

namespace runstone {
namespace {

void show_help(const CommandCall& call) {
  const auto has = [&](Right right) {
    return has_right(call.caller, call.rights(), right, call.rights_time());
  };
  call.answer(command_help(has, !call.caller.actor.key));
}

Result<std::string, std::string> parse_materials(WordReader& reader) {
  const std::string part = reader.at_end() ? std::string() : reader.take("", "");
  if (!reader.at_end()) {
    reader.wrong("materials \"" + reader.peek() + "\": at most one word comes after materials");
  }
  return reader.result(part);
}

void list_materials(const CommandCall& call, const std::string& part) {
  call.answer(material_list(call.world().order().materials(), part));
}

void list_players(const CommandCall& call) {
  call.on_worker(
      "players: ", [](WorldReader& reader) { return reader.players(); },
      [call, present = call.world().people().online(),
       visitors = call.world().order().players().visitors()](const std::vector<PlayerRow>& rows) {
        call.answer(player_list(rows, present, visitors));
      });
}

Result<WhyCommand, std::string> parse_why(WordReader& reader) {
  WhyCommand command;
  command.player = reader.player("why");
  const std::string name = reader.take("why", "one of the rights " + all_right_names());
  const auto right = right_named(name);
  if (!right) reader.wrong("why \"" + name + "\": one of the rights " + all_right_names());
  command.right = right.value_or(Right::see);
  if (!reader.at_end()) {
    if (command.right != Right::build)
      reader.wrong("why \"" + reader.peek() + "\": a place comes after the right build only");
    command.at = reader.position("why");
    reader.expect_end("why PLAYER build X Y Z");
  }
  return reader.result(command);
}

void answer_why(const CommandCall& call, const WhyCommand& command, const PublicKey& key,
                const KnownPlayers& players) {
  if (call.caller.actor.key != key) {
    if (auto why = why_not(call.caller, call.rights(), needs(Right::moderate), call.rights_time()))
      return call.refuse("about other players: " + *why);
  }
  if (call.services.is_operator(key)) {
    return call.answer("yes: " + players.text_of(key) +
                       " has every right\nthe server's setting `operators` names the key");
  }
  call.answer(
      rights_reason(call.rights(), {key, command.right, command.at}, call.rights_time(), players));
}

void explain_right(const CommandCall& call, const WhyCommand& command) {
  call.with_players({command.player},
                    [call, command](const KnownPlayers& players, const CommandCall::Keys& keys) {
                      answer_why(call, command, keys[0], players);
                    });
}

void list_roles(const CommandCall& call) {
  call.with_players({}, [call](const KnownPlayers& players, const CommandCall::Keys&) {
    call.answer(role_list(call.rights(), players));
  });
}

/// Parses the place after `protected`: the boxes that hold it are listed, without one all boxes.
Result<std::optional<VoxelPos>, std::string> parse_protected(WordReader& reader) {
  std::optional<VoxelPos> at;
  if (reader.take_word("at")) {
    at = reader.position("at");
    reader.expect_end("protected at X Y Z");
  } else if (!reader.at_end()) {
    reader.wrong("protected \"" + reader.peek() + "\": at X Y Z");
  }
  return reader.result(at);
}

void list_boxes(const CommandCall& call, const std::optional<VoxelPos>& at) {
  call.with_players({}, [call, at](const KnownPlayers& players, const CommandCall::Keys&) {
    std::vector<const Decided<ProtectedBox>*> boxes;
    if (at) {
      boxes = call.rights().boxes_in({*at, {at->x + 1, at->y + 1, at->z + 1}});
    } else {
      for (const auto& [name, box] : call.rights().boxes()) boxes.push_back(&box);
    }
    if (at && boxes.empty()) return call.answer("no box protects " + text_of(*at));
    call.answer(box_list(boxes, players));
  });
}

/// Undoes or redoes the caller's newest action (RollbackService::undo() or redo()).
template <void (RollbackService::*change)(AuthorId, const Clocks&, CommandReply)>
void undo_or_redo(const CommandCall& call) {
  (call.services.rollback.*change)(call.caller.author, call.now, call.reply);
}

constexpr std::array<CommandRow, 8> kPlayerRows = {{
    {"help", kForEverybody, "help                      this list", alone<show_help>()},
    {"materials", kForEverybody,
     "materials [PART]          the materials of this world; "
     "with PART those whose name contains it",
     parsed_by<parse_materials, list_materials>()},
    {"players", kForEverybody,
     "players                   who is here, who has ever built, "
     "and who else was here since the server started",
     alone<list_players>()},
    {"why", kForEverybody,
     "why PLAYER RIGHT          whether a player has a right, and which record decides it\n"
     "why PLAYER build X Y Z    whether a player may change this voxel",
     parsed_by<parse_why, explain_right>()},
    {"roles", kForEverybody, "roles                     the roles, with rights and limits",
     alone<list_roles>()},
    {"protected", kForEverybody,
     "protected [at X Y Z]      the protected boxes; with a place those that hold it",
     parsed_by<parse_protected, list_boxes>()},
    {"undo", needs(Right::undo),
     "undo                      take back your last edit; what others built there since stays",
     alone<undo_or_redo<&RollbackService::undo>>()},
    {"redo", needs(Right::undo), "redo                      do again what you undid last",
     alone<undo_or_redo<&RollbackService::redo>>()},
}};

}  // namespace

std::span<const CommandRow> player_commands() { return kPlayerRows; }

}  // namespace runstone
