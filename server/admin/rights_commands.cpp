#include "server/admin/rights_commands.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include "common/core/key_text.hpp"
#include "common/core/utc_text.hpp"
#include "server/admin/rights_change_text.hpp"
#include "server/admin/rights_lists.hpp"
#include "server/admin/rights_reason.hpp"
#include "server/admin/rights_records.hpp"

namespace runstone {
namespace {

/// Returns the keys that the state of rights names, some more than once.
std::vector<PublicKey> keys_of(const RightsState& state) {
  std::vector<PublicKey> keys;
  for (const auto& [key, grant] : state.grants()) keys.push_back(key);
  for (const Decided<Restrict>* restriction : state.restrictions()) {
    if (const auto* key = std::get_if<PublicKey>(&restriction->value.subject)) keys.push_back(*key);
  }
  for (const auto& [name, box] : state.boxes()) {
    if (box.value.owner) keys.push_back(*box.value.owner);
    keys.insert(keys.end(), box.value.members.begin(), box.value.members.end());
  }
  return keys;
}

/// Returns what the world strand knows about players. A worker adds what the store has.
KnownPlayers::Sources sources_of(const WorldServer& world, const std::vector<std::string>& words) {
  KnownPlayers::Sources sources;
  for (const OnlinePlayer& player : world.people().online())
    sources.present.push_back({player.author, player.key, player.name});
  sources.visitors = world.order().players().visitors();
  // Only a fingerprint finds a key without a name.
  if (std::any_of(words.begin(), words.end(), is_fingerprint))
    sources.others = keys_of(world.rights().state());
  return sources;
}

/// What a worker finds out about the players that a command means.
struct PlayerLookUp {
  KnownPlayers players;
  std::vector<PublicKey> keys;
  std::string error;
};

PlayerLookUp look_up_players(WorldReader& reader, KnownPlayers::Sources sources,
                             const std::vector<std::string>& words) {
  PlayerLookUp found;
  auto stored = reader.players();
  auto used = reader.player_names();
  auto claims = reader.name_claims();
  if (!stored) found.error = stored.error().message();
  if (!used) found.error = used.error().message();
  if (!claims) found.error = claims.error().message();
  if (!found.error.empty()) return found;
  sources.stored = *std::move(stored);
  sources.used = *std::move(used);
  sources.claims = *std::move(claims);
  found.players = KnownPlayers(sources);
  for (const std::string& word : words) {
    const auto key = found.players.find(word);
    if (key) found.keys.push_back(*key);
    if (!key && found.error.empty()) found.error = "\"" + word + "\": " + key.error();
  }
  return found;
}

std::string end_text(TimeUs until_us) {
  return until_us == 0 ? std::string() : " until " + utc_text(until_us);
}
std::string colon_text(const std::string& reason) {
  return reason.empty() ? std::string() : ": " + reason;
}

/// Adds or removes one entry of an ascending list. Returns false if that changes nothing.
template <class T>
bool change_entry(std::vector<T>& list, const T& entry, bool is_removal) {
  const auto at = std::lower_bound(list.begin(), list.end(), entry);
  const bool is_in = at != list.end() && *at == entry;
  if (is_in != is_removal) return false;
  if (is_removal) {
    list.erase(at);
  } else {
    list.insert(at, entry);
  }
  return true;
}

std::string no_box(const std::string& name) {
  return "there is no protected box \"" + name + "\" (protected lists them)";
}

}  // namespace

void RightsCommands::run(const CommandCaller& caller, const RightsCommand& command,
                         const Clocks& now, const CommandReply& reply) {
  const Call call{caller, now, reply};
  std::visit([&](const auto& kind) { carry_out(kind, call); }, command);
}

void RightsCommands::tick() {
  std::vector<Waiting> waiting = std::exchange(waiting_, {});
  for (Waiting& each : waiting) {
    if (world_.order().durable() >= each.needed) {
      each.begin();
    } else if (!world_.order().accepts_edits()) {
      refuse(each.reply, "rights undo: the log cannot be written any more");
    } else {
      waiting_.push_back(std::move(each));
    }
  }
}

void RightsCommands::with_players(const Call& call, std::vector<std::string> words,
                                  std::function<void(const Players&, const Keys&)> go_on) {
  auto found = std::make_shared<PlayerLookUp>();
  KnownPlayers::Sources sources = sources_of(world_, words);
  workers_.run([found, sources = std::move(sources), words = std::move(words)](
                   WorldReader& reader,
                   const Generator&) { *found = look_up_players(reader, sources, words); },
               [found, reply = call.reply, go_on = std::move(go_on)](const std::string& error) {
                 if (!error.empty()) return refuse(reply, error);
                 if (!found->error.empty()) return refuse(reply, found->error);
                 go_on(Players(found, &found->players), found->keys);
               });
}

void RightsCommands::change(const Call& call, const RightsChange& change, const std::string& text) {
  if (const auto valid = validate(change); !valid) return refuse(call.reply, valid.error().what);
  const std::size_t sessions = world_.session_count();
  const auto seq =
      world_.changes().change_rights(change, call.caller.actor, call.caller.author, call.now);
  if (!seq) return refuse(call.reply, seq.error());
  std::string line = text + " (record " + std::to_string(*seq) + ")";
  const std::size_t left = world_.session_count();
  if (left < sessions) line += "; sessions ended: " + std::to_string(sessions - left);
  call.reply({line, true, true});
}

void RightsCommands::carry_out(const ListRolesCommand& /*command*/, const Call& call) {
  with_players(call, {}, [this, call](const Players& players, const Keys&) {
    call.reply({role_list(world_.rights().state(), *players), true, true});
  });
}

void RightsCommands::carry_out(const SetRoleCommand& command, const Call& call) {
  change(call, DefineRole{command.role},
         "role " + command.role.name + " is " + role_text(command.role));
}

void RightsCommands::carry_out(const RemoveRoleCommand& command, const Call& call) {
  const auto built_in = built_in_roles();
  const bool is_built_in = std::any_of(built_in.begin(), built_in.end(),
                                       [&](const Role& role) { return role.name == command.role; });
  change(call, RemoveRole{command.role},
         "role " + command.role + (is_built_in ? " is as it was built in" : " is removed"));
}

void RightsCommands::carry_out(const DefaultRoleCommand& command, const Call& call) {
  change(call, SetDefaultRole{command.role},
         "players without a grant have the role " + command.role);
}

void RightsCommands::carry_out(const GrantCommand& command, const Call& call) {
  with_players(call, {command.player},
               [this, call, role = command.role](const Players& players, const Keys& keys) {
                 change(call, GrantRole{keys[0], role},
                        players->text_of(keys[0]) + " has the role " + role);
               });
}

void RightsCommands::carry_out(const RevokeCommand& command, const Call& call) {
  with_players(call, {command.player}, [this, call](const Players& players, const Keys& keys) {
    const std::string who = players->text_of(keys[0]);
    if (!world_.rights().state().grants().contains(keys[0]))
      return refuse(call.reply, who + " has no granted role (grants lists them)");
    change(call, GrantRole{keys[0], ""},
           who + " has the default role " + world_.rights().state().default_role().value);
  });
}

void RightsCommands::carry_out(const ListGrantsCommand& /*command*/, const Call& call) {
  with_players(call, {}, [this, call](const Players& players, const Keys&) {
    call.reply({grant_list(world_.rights().state(), *players), true, true});
  });
}

void RightsCommands::carry_out(const RestrictCommand& command, const Call& call) {
  if (command.who.range) {
    return restrict_subject(command, *command.who.range,
                            "everybody from " + subject_text(*command.who.range), call);
  }
  with_players(call, {command.who.player},
               [this, command, call](const Players& players, const Keys& keys) {
                 restrict_subject(command, keys[0], players->text_of(keys[0]), call);
               });
}

void RightsCommands::restrict_subject(const RestrictCommand& command,
                                      const RestrictionSubject& subject, const std::string& who,
                                      const Call& call) {
  std::string text = who + " is " + restricted_text(command.kind) + end_text(command.until_us) +
                     colon_text(command.reason);
  if (command.who.is_widened) text += " [a single IPv6 address means its /64]";
  change(call, Restrict{command.kind, subject, command.until_us, command.reason}, text);
}

void RightsCommands::carry_out(const LiftCommand& command, const Call& call) {
  if (command.who.range) {
    return lift_subject(command, *command.who.range,
                        "everybody from " + subject_text(*command.who.range), call);
  }
  with_players(call, {command.who.player},
               [this, command, call](const Players& players, const Keys& keys) {
                 lift_subject(command, keys[0], players->text_of(keys[0]), call);
               });
}

void RightsCommands::lift_subject(const LiftCommand& command, const RestrictionSubject& subject,
                                  const std::string& who, const Call& call) {
  const RightsState& state = world_.rights().state();
  const TimeUs now_us = world_.rights().time();
  const std::string kind = restricted_text(command.kind);
  const Decided<Restrict>* found = state.find_restriction(command.kind, subject);
  if (found == nullptr || (found->value.until_us != 0 && found->value.until_us <= now_us)) {
    std::string text = who + " is not " + kind;
    const auto* range = std::get_if<AddressRange>(&subject);
    const auto* wider = range == nullptr ? nullptr : state.address_ban(range->first, now_us);
    if (wider != nullptr) text += ", but " + subject_text(wider->value.subject) + " is";
    return refuse(call.reply, text + " (bans lists all)");
  }
  std::string text = who + " is no longer " + kind;
  if (command.who.is_widened) text += " [a single IPv6 address means its /64]";
  change(call, Lift{command.kind, subject}, text);
}

void RightsCommands::carry_out(const ListRestrictionsCommand& /*command*/, const Call& call) {
  with_players(call, {}, [this, call](const Players& players, const Keys&) {
    call.reply(
        {restriction_list(world_.rights().state(), world_.rights().time(), *players), true, true});
  });
}

void RightsCommands::carry_out(const KickCommand& command, const Call& call) {
  with_players(
      call, {command.player},
      [this, call, reason = command.reason](const Players& players, const Keys& keys) {
        const std::string who = players->text_of(keys[0]);
        // A player may kick whom the player may mute: those who have fewer rights.
        const Restrict mute{RestrictionKind::mute, keys[0], 0, ""};
        if (auto why = world_.rights().change_refusal(mute, call.caller.actor))
          return refuse(call.reply, *std::move(why));
        const std::size_t ended = world_.people().kick(keys[0], reason);
        if (ended == 0) return refuse(call.reply, who + " is not here");
        call.reply({who + " was kicked; sessions ended: " + std::to_string(ended), true, true});
      });
}

void RightsCommands::carry_out(const ProtectCommand& command, const Call& call) {
  std::vector<std::string> words;
  if (command.owner) words.push_back(*command.owner);
  with_players(call, words, [this, command, call](const Players& players, const Keys& keys) {
    const Decided<ProtectedBox>* old = world_.rights().state().find_box(command.name);
    if (old == nullptr && !command.box) return refuse(call.reply, no_box(command.name));
    ProtectedBox box = old == nullptr ? ProtectedBox{} : old->value;
    box.name = command.name;
    if (command.box) box.box = *command.box;
    if (command.owner) box.owner = keys[0];
    if (command.priority) box.priority = *command.priority;
    const std::string owner = box.owner ? players->text_of(*box.owner) : "nobody";
    change(call, Protect{box},
           command.name + " protects " + ground_text(box.box) + ", priority " +
               std::to_string(box.priority) + ", owner " + owner);
  });
}

void RightsCommands::carry_out(const BoxMembersCommand& command, const Call& call) {
  with_players(
      call, command.players, [this, command, call](const Players& players, const Keys& keys) {
        const Decided<ProtectedBox>* old = world_.rights().state().find_box(command.name);
        if (old == nullptr) return refuse(call.reply, no_box(command.name));
        ProtectedBox box = old->value;
        const std::string unchanged = command.is_removal ? " is no member of " : " is a member of ";
        std::string changed;
        for (const PublicKey& key : keys) {
          const std::string who = players->text_of(key);
          if (!change_entry(box.members, key, command.is_removal))
            return refuse(call.reply, who + unchanged + command.name);
          changed += (changed.empty() ? "" : ", ") + who;
        }
        for (const std::string& role : command.roles) {
          if (!change_entry(box.roles, role, command.is_removal))
            return refuse(call.reply, "the role " + role + unchanged + command.name);
          changed += (changed.empty() ? "" : ", ") + ("the role " + role);
        }
        change(call, Protect{box},
               command.name + (command.is_removal ? " does not admit any more: " : " admits: ") +
                   changed);
      });
}

void RightsCommands::carry_out(const ClaimCommand& command, const Call& call) {
  const auto& owner = call.caller.actor.key;
  if (!owner) {
    return refuse(call.reply, "claims are for players: protect " + command.name +
                                  " ... owner PLAYER protects ground for one");
  }
  const Decided<ProtectedBox>* old = world_.rights().state().find_box(command.name);
  if (old != nullptr && old->value.owner != owner) {
    return refuse(call.reply, "there is a protected box \"" + command.name +
                                  "\" of somebody else: choose another name");
  }
  ProtectedBox box = old == nullptr ? ProtectedBox{} : old->value;
  box.name = command.name;
  box.box = command.box;
  box.owner = owner;
  change(call, Protect{box}, command.name + " protects " + ground_text(box.box) + " for you");
}

void RightsCommands::carry_out(const UnprotectCommand& command, const Call& call) {
  if (world_.rights().state().find_box(command.name) == nullptr)
    return refuse(call.reply, no_box(command.name));
  change(call, Unprotect{command.name}, command.name + " protects nothing any more");
}

void RightsCommands::carry_out(const ListBoxesCommand& command, const Call& call) {
  with_players(call, {}, [this, at = command.at, call](const Players& players, const Keys&) {
    std::vector<const Decided<ProtectedBox>*> boxes;
    if (at) {
      boxes = world_.rights().state().boxes_in({*at, {at->x + 1, at->y + 1, at->z + 1}});
    } else {
      for (const auto& [name, box] : world_.rights().state().boxes()) boxes.push_back(&box);
    }
    if (at && boxes.empty()) return call.reply({"no box protects " + text_of(*at), true, true});
    call.reply({box_list(boxes, *players), true, true});
  });
}

void RightsCommands::carry_out(const WhyCommand& command, const Call& call) {
  with_players(call, {command.player},
               [this, command, call](const Players& players, const Keys& keys) {
                 answer_why(command, keys[0], *players, call);
               });
}

void RightsCommands::answer_why(const WhyCommand& command, const PublicKey& key,
                                const KnownPlayers& players, const Call& call) {
  const RightsState& state = world_.rights().state();
  const TimeUs now_us = world_.rights().time();
  if (call.caller.actor.key != key) {
    const CommandRule about_others{{Right::moderate}, false};
    if (auto why = why_not(call.caller, state, about_others, now_us))
      return refuse(call.reply, "about other players: " + *why);
  }
  if (is_operator_(key)) {
    return call.reply({"yes: " + players.text_of(key) +
                           " has every right\nthe server's setting `operators` names the key",
                       true, true});
  }
  call.reply({rights_reason(state, {key, command.right, command.at}, now_us, players), true, true});
}

void RightsCommands::carry_out(const UndoRightsCommand& command, const Call& call) {
  // The inverse depends on the records after this one, so all of them must be on disk.
  const Sequence newest = world_.rights().newest();
  if (world_.order().durable() < newest) {
    waiting_.push_back({newest, [this, command, call] { carry_out(command, call); }, call.reply});
    return;
  }
  auto records =
      std::make_shared<StoreResult<std::vector<RightsRecord>>>(std::vector<RightsRecord>());
  workers_.run(
      [records](WorldReader& reader, const Generator&) { *records = read_rights_records(reader); },
      [this, records, command, call, newest](const std::string& error) {
        if (!error.empty()) return refuse(call.reply, "rights undo: " + error);
        if (!*records) return refuse(call.reply, "rights undo: " + records->error().message());
        if (newest != world_.rights().newest()) return carry_out(command, call);
        undo_record(command.seq, **records, call);
      });
}

void RightsCommands::undo_record(Sequence seq, const std::vector<RightsRecord>& records,
                                 const Call& call) {
  const auto found = std::find_if(records.begin(), records.end(), [&](const RightsRecord& record) {
    return record.origin.seq == seq;
  });
  const std::string number = std::to_string(seq);
  if (found == records.end()) {
    return refuse(call.reply,
                  "record " + number + " changes no rights (log cause rights lists those that do)");
  }
  const auto inverse = inverse_of(records, seq);
  if (!inverse) {
    return refuse(call.reply, "record " + number + " (" + rights_change_text(found->change) +
                                  ") decides nothing any more: a later one has replaced it");
  }
  change(call, *inverse,
         "record " + number + " (" + rights_change_text(found->change) +
             ") is taken back: " + rights_change_text(*inverse));
}

void RightsCommands::carry_out(const CreateInviteCommand& command, const Call& call) {
  const Invite invite{world_.people().new_invite_id(), command.role, command.uses,
                      command.until_us};
  change(call, CreateInvite{invite},
         world_.people().invite_link(invite.id) + "\ninvite " + invite_text(invite) +
             ". Whoever has the link can use it: pass it on in private");
}

void RightsCommands::carry_out(const CancelInviteCommand& command, const Call& call) {
  change(call, CancelInvite{command.invite},
         "invite " + invite_id_text(command.invite) +
             " is cancelled; players who accepted it keep their role");
}

void RightsCommands::carry_out(const ListInvitesCommand& /*command*/, const Call& call) {
  with_players(call, {}, [this, call](const Players& players, const Keys&) {
    call.reply(
        {invite_list(world_.rights().state(), world_.rights().time(), *players), true, true});
  });
}

void RightsCommands::carry_out(const ListRefusalsCommand& /*command*/, const Call& call) {
  with_players(call, {}, [this, call](const Players& players, const Keys&) {
    call.reply({refusal_list(world_.rights().refusals(), *players), true, true});
  });
}

void RightsCommands::carry_out(const SetPasswordCommand& command, const Call& call) {
  if (!command.has_verifier) {
    return refuse(call.reply,
                  "the password is typed where nobody sees it: runstone-server control --world "
                  "FOLDER password set");
  }
  std::string text = "players without a granted role join with the password and get the role " +
                     command.password.role;
  const Decided<Role>* usual =
      world_.rights().state().find_role(world_.rights().state().default_role().value);
  if (usual != nullptr && usual->value.rights.has(Right::see))
    text += "; others still join as " + usual->value.name + " (role default nobody keeps them out)";
  change(call, SetPassword{command.password}, text);
}

void RightsCommands::carry_out(const ClearPasswordCommand& /*command*/, const Call& call) {
  change(call, SetPassword{std::nullopt},
         "the world has no password; players who joined with it keep their role");
}

void RightsCommands::carry_out(const ShowPasswordCommand& /*command*/, const Call& call) {
  with_players(call, {}, [this, call](const Players& players, const Keys&) {
    call.reply({password_line(world_.rights().state(), *players), true, true});
  });
}

}  // namespace runstone
