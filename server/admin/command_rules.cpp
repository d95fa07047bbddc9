#include "server/admin/command_rules.hpp"

#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <variant>

namespace runstone {
namespace {

// A command has a number: the alternatives of Command, then those of RightsCommand.
constexpr std::size_t kRightsCommandsFrom = std::variant_size_v<Command>;
constexpr std::size_t kCommandCount = kRightsCommandsFrom + std::variant_size_v<RightsCommand>;

template <class Kind, class... Kinds>
constexpr std::size_t index_in(const std::variant<Kinds...>*) {
  std::size_t index = 0;
  const bool is_found = ((std::is_same_v<Kind, Kinds> || (++index, false)) || ...);
  return is_found ? index : sizeof...(Kinds);
}
template <class Kind>
constexpr std::size_t number_of_kind() {
  constexpr std::size_t index = index_in<Kind>(static_cast<const Command*>(nullptr));
  if constexpr (index < kRightsCommandsFrom) {
    return index;
  } else {
    constexpr std::size_t rights = index_in<Kind>(static_cast<const RightsCommand*>(nullptr));
    static_assert(rights < std::variant_size_v<RightsCommand>);
    return kRightsCommandsFrom + rights;
  }
}

struct CommandRow {
  std::size_t number = 0;
  CommandRule rule;
  const char* help = "";  // lines of `help`, without a line break at the end
};

template <class Kind>
constexpr CommandRow row(RightSet any_of, const char* help) {
  return {number_of_kind<Kind>(), {any_of, false}, help};
}
template <class Kind>
constexpr CommandRow local_row(const char* help) {
  return {number_of_kind<Kind>(), {{}, true}, help};
}

// The table. The order is that of `help`.
constexpr std::array kCommandRows = {
    row<HelpCommand>({}, "help                      this list"),
    row<MaterialsCommand>({},
                          "materials [PART]          the materials of this world; "
                          "with PART those whose name contains it"),
    row<PlayersCommand>({},
                        "players                   who is here, who has ever built, "
                        "and who else was here since the server started"),
    row<WhyCommand>({},
                    "why PLAYER RIGHT          whether a player has a right, and which record "
                    "decides it\n"
                    "why PLAYER build X Y Z    whether a player may change this voxel"),
    row<ListRolesCommand>({}, "roles                     the roles, with rights and limits"),
    row<ListBoxesCommand>({},
                          "protected [at X Y Z]      the protected boxes; "
                          "with a place those that hold it"),
    row<UndoCommand>({Right::undo},
                     "undo                      take back your last edit; "
                     "what others built there since stays\n"
                     "redo                      do again what you undid last"),
    row<ClaimCommand>({Right::claim, Right::protect},
                      "claim NAME BOX            protect ground of your own"),
    row<ProtectCommand>({Right::claim, Right::protect},
                        "protect NAME [BOX] [owner PLAYER] [priority N]\n"
                        "                          protect ground, or change the box of this name"),
    row<BoxMembersCommand>({Right::claim, Right::protect},
                           "protect NAME add|remove PLAYER|role:ROLE\n"
                           "                          say who else may change the ground of a box"),
    row<UnprotectCommand>({Right::claim, Right::protect},
                          "unprotect NAME            remove a box; the ground stays as it is"),
    row<StatusCommand>({Right::moderate}, "status                    what the server does"),
    row<NamesCommand>({Right::moderate}, "names                     which key owns which name"),
    row<KickCommand>({Right::moderate},
                     "kick PLAYER [reason TEXT] end the sessions of a player, who may come back"),
    row<RestrictCommand>({Right::moderate},
                         "ban PLAYER|ADDRESS|RANGE [for DURATION] [reason TEXT]\n"
                         "                          let nobody join with this key, or from there\n"
                         "mute PLAYER ...           let a player not write to others\n"
                         "freeze PLAYER ...         let a player not edit"),
    row<LiftCommand>({Right::moderate}, "unban, unmute, unfreeze   end a ban, a mute or a freeze"),
    row<ListRestrictionsCommand>({Right::moderate},
                                 "bans                      the bans, mutes and freezes in force"),
    row<ListRefusalsCommand>({Right::moderate},
                             "refusals                  what players were refused lately"),
    row<ChatLogCommand>(
        {Right::moderate},
        "chat log [by PLAYER] [since MOMENT] [limit N]\n"
        "                          the newest lines of the chat, the last one at the bottom"),
    row<LogCommand>({Right::roll_back},
                    "log FILTERS [limit N]     the newest edits, the last one at the bottom"),
    row<RollbackPreviewCommand>(
        {Right::roll_back},
        "rollback preview FILTERS [picture]\n"
        "                          what a rollback of these edits would do; "
        "`picture` draws the area before and after"),
    row<RollbackCommand>({Right::roll_back},
                         "rollback apply ID         do it, while people go on playing; "
                         "what others built since stays\n"
                         "rollback cancel ID        stop it, or forget a preview\n"
                         "rollback undo ID          take a rollback back"),
    row<RollbackListCommand>({Right::roll_back},
                             "rollback list             previews, and the rollbacks so far"),
    row<GrantCommand>({Right::grant}, "grant PLAYER ROLE         give a player a role"),
    row<RevokeCommand>({Right::grant},
                       "revoke PLAYER             give a player the default role again"),
    row<ListGrantsCommand>({Right::grant}, "grants                    who has which role"),
    row<CreateInviteCommand>({Right::grant},
                             "invite [role ROLE] [uses N] [days N]\n"
                             "                          make a link with which players join and "
                             "get a role"),
    row<CancelInviteCommand>({Right::grant}, "invite cancel ID          end an invite"),
    row<ListInvitesCommand>({Right::grant}, "invites                   the invites in force"),
    row<SetRoleCommand>({Right::administer},
                        "role set NAME RIGHT,RIGHT,... [volume N] [claims N] [claim-volume N]\n"
                        "         [edits BUDGET] [view N] [loads N]\n"
                        "                          define a role; volume: voxels of one edit; "
                        "edits: as builder_budget;\n"
                        "                          view: chunks; loads: chunks a second"),
    row<RemoveRoleCommand>({Right::administer},
                           "role remove NAME          remove a role, or what was changed of a "
                           "built-in one"),
    row<DefaultRoleCommand>({Right::administer},
                            "role default NAME         the role of players without a grant"),
    row<UndoRightsCommand>({Right::administer},
                           "rights undo SEQ           take back a record that changed rights "
                           "(log cause rights)"),
    local_row<SetPasswordCommand>(
        "password set [role ROLE]  give the world a password, which control asks for"),
    row<ClearPasswordCommand>({Right::administer},
                              "password clear            take the world's password away"),
    row<ShowPasswordCommand>({Right::administer},
                             "password                  whether the world has a password"),
    row<ReleaseNameCommand>({Right::administer},
                            "names release NAME        free a name, so that the next player who "
                            "joins under it owns it"),
    local_row<AddMaterialsCommand>("materials add FILE        add the materials of a file"),
    row<SayCommand>({Right::administer},
                    "say TEXT                  write to all players, as the server"),
    local_row<BackupCommand>(
        "backup DIR                copy the world to a new folder, while people go on playing"),
    local_row<ReloadCommand>("reload                    read the settings again"),
    row<ServersCommand>({Right::administer},
                        "servers                   the servers of the world, with their numbers"),
    row<HandoverCommand>(
        {Right::administer},
        "handover [SERVER]         let another server own the world; nobody has to "
        "connect again"),
    row<StopCommand>({Right::administer}, "stop                      stop the server"),
};

constexpr bool has_each_command_once() {
  std::array<int, kCommandCount> counts{};
  for (const CommandRow& each : kCommandRows) ++counts[each.number];
  counts[number_of_kind<RightsCommand>()] = 1;  // its alternatives have rows of their own
  for (const int count : counts) {
    if (count != 1) return false;
  }
  return true;
}
static_assert(has_each_command_once());

constexpr const char* kPlayerHelp = "PLAYER: a name, #N, a fingerprint, or a key of 64 hex digits";
constexpr const char* kBoxHelp =
    "BOX: X Y Z X Y Z, two opposite corners, both inside; or columns X Z X Z, from the bottom to "
    "the top";
constexpr const char* kFilterHelp =
    "FILTERS, any of: author NAME or author #N (several: any of them), "
    "since 1h or since 2026-11-21T23:57:42Z,\n"
    "  until likewise, box X Y Z X Y Z, cause player|console|rollback|undo|redo|import|rights|materials";

bool may_give(const CommandRule& rule, const std::function<bool(Right)>& has_right, bool is_local) {
  if (rule.is_local) return is_local;
  if (rule.any_of == RightSet()) return true;
  for (std::size_t i = 0; i < kRightCount; ++i) {
    const auto right = static_cast<Right>(i);
    if (rule.any_of.has(right) && has_right(right)) return true;
  }
  return false;
}

}  // namespace

CommandRule rule_of(const Command& command) {
  static const std::array<CommandRule, kCommandCount> rules = [] {
    std::array<CommandRule, kCommandCount> by_number;
    for (const CommandRow& each : kCommandRows) by_number[each.number] = each.rule;
    return by_number;
  }();
  const auto* rights = std::get_if<RightsCommand>(&command);
  return rules[rights == nullptr ? command.index() : kRightsCommandsFrom + rights->index()];
}

std::string command_help(const std::function<bool(Right)>& has_right, bool is_local) {
  std::string text;
  for (const CommandRow& each : kCommandRows) {
    if (may_give(each.rule, has_right, is_local)) text += std::string(each.help) + "\n";
  }
  text += kPlayerHelp;
  if (has_right(Right::claim) || has_right(Right::protect)) text += std::string("\n") + kBoxHelp;
  if (has_right(Right::roll_back)) text += std::string("\n") + kFilterHelp;
  return text;
}

}  // namespace runstone
