#include "server/admin/command_handler.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "protocol/codec/key_fingerprint.hpp"
#include "server/admin/author_names.hpp"
#include "server/admin/command_rules.hpp"
#include "server/admin/log_line.hpp"
#include "server/admin/material_file.hpp"
#include "server/admin/material_list.hpp"
#include "server/admin/name_list.hpp"
#include "server/admin/player_list.hpp"
#include "server/admin/server_list.hpp"
#include "server/draw/preview_pictures.hpp"
#include "server/rollback/newest_edits.hpp"
#include "server/rollback/preview_edits.hpp"

namespace runstone {
namespace {

/// Returns a count of bytes in the largest unit of which there is at least one.
std::string memory_text(std::size_t bytes) {
  if (bytes < 1024) return std::to_string(bytes) + " bytes";
  if (bytes < 1024 * 1024) return std::to_string(bytes / 1024) + " KiB";
  return std::to_string(bytes / (1024 * 1024)) + " MiB";
}

/// Returns how many materials were added, the record, and a line for each.
std::string added_text(const AddedAt& at, const std::vector<MaterialRow>& rows) {
  std::string text = std::to_string(rows.size()) + (rows.size() == 1 ? " material" : " materials") +
                     " added (record " + std::to_string(at.seq) + ")";
  for (const std::string& line : material_lines(at.first, rows)) text += "\n" + line;
  return text;
}

StoreResult<AuthorNames> read_author_names(WorldReader& reader) {
  const auto rows = reader.players();
  if (!rows) return Unexpected<StoreError>{rows.error()};
  const auto used = reader.player_names();
  if (!used) return Unexpected<StoreError>{used.error()};
  return AuthorNames(*rows, *used);
}

}  // namespace

CommandHandler::CommandHandler(WorldServer& world, RollbackService& rollback,
                               RollbackService::Workers& workers, std::string world_folder,
                               OperatorActions actions, RightsCommands::IsOperator is_operator)
    : world_(world),
      rollback_(rollback),
      workers_(workers),
      rights_(world, workers, std::move(is_operator)),
      world_folder_(std::move(world_folder)),
      actions_(std::move(actions)) {}

bool CommandHandler::run_action(const Command& command, const CommandReply& reply) {
  if (std::holds_alternative<StopCommand>(command)) {
    reply({"the server stops", true, true});
    if (actions_.stop) actions_.stop();
    return true;
  }
  if (const auto* chat = std::get_if<ChatLogCommand>(&command)) {
    if (!actions_.list_chat) {
      refuse(reply, "chat log: this server keeps no log of the chat (chat_days = 0)");
    } else {
      actions_.list_chat(chat->query, reply);
    }
    return true;
  }
  const auto* backup = std::get_if<BackupCommand>(&command);
  const bool is_reload = std::holds_alternative<ReloadCommand>(command);
  if (backup == nullptr && !is_reload) return false;
  if (is_reload ? !actions_.reload : !actions_.back_up) {
    refuse(reply, "this server cannot do that");
  } else if (is_reload) {
    actions_.reload(reply);
  } else {
    actions_.back_up(backup->folder, reply);
  }
  return true;
}

void CommandHandler::run(const CommandCaller& caller, const std::string& line, const Clocks& now,
                         CommandReply reply) {
  // Restrictions end by the clock of the log, which may be ahead of the system's.
  const auto command = parse_command(line, std::max(now.utc_us, world_.rights().time()));
  if (!command) return refuse(reply, command.error());
  if (auto why =
          why_not(caller, world_.rights().state(), rule_of(*command), world_.rights().time()))
    return refuse(reply, *std::move(why));
  if (const auto* rights = std::get_if<RightsCommand>(&*command))
    return rights_.run(caller, *rights, now, reply);
  if (std::holds_alternative<HelpCommand>(*command)) return help(caller, reply);
  if (std::holds_alternative<StatusCommand>(*command)) return status(reply);
  if (std::holds_alternative<PlayersCommand>(*command)) return players(reply);
  if (std::holds_alternative<NamesCommand>(*command)) return names(reply);
  if (std::holds_alternative<ServersCommand>(*command))
    return reply({server_list(world_.cluster().known_servers()), true, true});
  if (const auto* handover = std::get_if<HandoverCommand>(&*command))
    return hand_over(handover->server, reply);
  if (const auto* release = std::get_if<ReleaseNameCommand>(&*command))
    return release_name(release->name, reply);
  if (const auto* list = std::get_if<MaterialsCommand>(&*command)) {
    return reply({material_list(world_.order().materials(), list->part), true, true});
  }
  if (const auto* add = std::get_if<AddMaterialsCommand>(&*command))
    return add_materials(add->file, now, reply);
  if (const auto* spoken = std::get_if<SayCommand>(&*command))
    return say(caller, spoken->text, now, reply);
  if (run_action(*command, reply)) return;
  if (const auto* undo = std::get_if<UndoCommand>(&*command)) {
    if (caller.author == 0) {
      return refuse(
          reply,
          "undo and redo are for players: the console has no edits of its own (rollback undo ID "
          "takes a rollback back)");
    }
    return undo->is_redo ? rollback_.redo(caller.author, now, std::move(reply))
                         : rollback_.undo(caller.author, now, std::move(reply));
  }
  if (const auto* log_of = std::get_if<LogCommand>(&*command)) return log(*log_of, now, reply);
  if (const auto* preview_of = std::get_if<RollbackPreviewCommand>(&*command)) {
    return preview(caller, *preview_of, now, reply);
  }
  if (std::holds_alternative<RollbackListCommand>(*command))
    return rollback_.list(std::move(reply));
  const auto& rollback = std::get<RollbackCommand>(*command);
  switch (rollback.verb) {
    case RollbackCommand::Verb::apply:
      return rollback_.apply(rollback.id, caller.author, std::move(reply));
    case RollbackCommand::Verb::cancel:
      return rollback_.cancel(rollback.id, std::move(reply));
    case RollbackCommand::Verb::undo:
      return rollback_.undo_rollback(rollback.id, caller.author, now, std::move(reply));
  }
}

void CommandHandler::help(const CommandCaller& caller, const CommandReply& reply) const {
  const auto has = [&](Right right) {
    return has_right(caller, world_.rights().state(), right, world_.rights().time());
  };
  reply({command_help(has, !caller.actor.key), true, true});
}

void CommandHandler::status(const CommandReply& reply) const {
  const WorldCounters& c = world_.counters();
  const WorldMemory memory = world_.order().memory();
  reply({"sessions " + std::to_string(world_.session_count()) + ", edits " +
             std::to_string(world_.order().head()) + " (on disk " +
             std::to_string(world_.order().durable()) + "), since the start " +
             std::to_string(c.edits_ordered) + " ordered and " + std::to_string(c.edits_rejected) +
             " rejected\nchunks in memory " +
             std::to_string(world_.order().chunks().resident_count()) + " (" +
             memory_text(memory.voxels) + "), waiting edits " +
             memory_text(memory.stacked + memory.queued) + ", damaged chunks " +
             std::to_string(c.chunks_failed) + ", rollbacks and undos under way " +
             std::to_string(rollback_.running()),
         true, true});
}

void CommandHandler::players(const CommandReply& reply) {
  auto rows = std::make_shared<StoreResult<std::vector<PlayerRow>>>(std::vector<PlayerRow>());
  workers_.run([rows](WorldReader& reader, const Generator&) { *rows = reader.players(); },
               [rows, present = world_.people().online(),
                visitors = world_.order().players().visitors(), reply](const std::string& error) {
                 if (!error.empty()) return refuse(reply, "players: " + error);
                 if (!*rows) return refuse(reply, "players: " + rows->error().message());
                 reply({player_list(**rows, present, visitors), true, true});
               });
}

void CommandHandler::hand_over(std::optional<SessionId> successor, const CommandReply& reply) {
  if (const auto why = world_.cluster().handover_refusal(successor))
    return refuse(reply, "handover: " + *why);
  if (!actions_.hand_over) return refuse(reply, "this server cannot do that");
  // A player at another server gets no later line: the next owner does not know of the command.
  reply({"handing the world over", false, true});
  actions_.hand_over(successor, reply);
}

void CommandHandler::names(const CommandReply& reply) const {
  std::vector<OwnedName> owned;
  for (const NameClaim& claim : world_.order().names().all())
    owned.push_back({claim.name, claim.key, world_.order().players().author_of(claim.key)});
  reply({name_list(owned), true, true});
}

void CommandHandler::release_name(const std::string& name, const CommandReply& reply) {
  const auto released = world_.people().names().release(name);
  if (!released) return refuse(reply, "names release: " + released.error());
  reply({"\"" + released->name + "\" was owned by " + key_fingerprint(released->key) +
             "; the next player who joins under it owns it",
         true, true});
}

void CommandHandler::say(const CommandCaller& caller, const std::string& text, const Clocks& now,
                         const CommandReply& reply) {
  const std::size_t sessions =
      world_.people().chat().say(text, caller.actor.key.value_or(PublicKey{}), now);
  reply({"sent to " + std::to_string(sessions) + (sessions == 1 ? " session" : " sessions"), true,
         true});
}

void CommandHandler::resolve(const CommandFilter& filter, const std::string& command,
                             const CommandReply& reply,
                             std::function<void(const SelectionFilter&)> go_on) {
  SelectionFilter out;
  out.from_us = filter.from_us.value_or(out.from_us);
  out.until_us = filter.until_us.value_or(out.until_us);
  out.box = filter.box;
  out.cause = filter.cause;
  const bool has_names = std::any_of(filter.authors.begin(), filter.authors.end(),
                                     [](const auto& a) { return !a.number; });
  for (const CommandFilter::Author& author : filter.authors) {
    if (author.number) out.authors.push_back(*author.number);
  }
  if (!has_names) return go_on(out);
  auto names = std::make_shared<StoreResult<AuthorNames>>(AuthorNames({}, {}));
  workers_.run(
      [names](WorldReader& reader, const Generator&) { *names = read_author_names(reader); },
      [names, out, filter, command, reply, go_on](const std::string& error) mutable {
        if (!error.empty()) return refuse(reply, command + ": " + error);
        if (!*names) return refuse(reply, command + ": " + names->error().message());
        for (const CommandFilter::Author& author : filter.authors) {
          if (author.number) continue;
          const std::string quoted = "author \"" + author.name + "\"";
          const auto named = (*names)->find(author.name);
          if (!named) return refuse(reply, command + " " + quoted + ": " + named.error());
          if (!(*names)->is_in_use(author.name, *named))
            reply({quoted + " is now called " + (*names)->of(*named), false, true});
          out.authors.push_back(*named);
        }
        go_on(out);
      });
}

void CommandHandler::log(const LogCommand& command, const Clocks& now, const CommandReply& reply) {
  world_.commit(now);
  resolve(command.filter, "log", reply,
          [this, limit = command.limit, reply](const SelectionFilter& filter) {
            SelectionFilter on_disk = filter;
            on_disk.last = world_.order().durable();
            auto text = std::make_shared<std::string>();
            auto wrong = std::make_shared<std::string>();
            workers_.run(
                [on_disk, limit, text, wrong](WorldReader& reader, const Generator&) {
                  const auto names = read_author_names(reader);
                  const auto newest = newest_edits(reader, on_disk, limit);
                  const auto materials = reader.materials();
                  if (!names) *wrong = names.error().message();
                  if (!newest) *wrong = newest.error().message();
                  if (!materials) *wrong = materials.error().message();
                  if (!wrong->empty()) return;
                  for (const EditRecord& record : *newest) {
                    *text += log_line(record, names->with_key(record.op.author), *materials) + "\n";
                  }
                },
                [text, wrong, reply](const std::string& error) {
                  if (!error.empty() || !wrong->empty())
                    return refuse(reply, "log: " + error + *wrong);
                  if (text->empty()) *text = "no edit matches\n";
                  text->pop_back();
                  reply({*text, true, true});
                });
          });
}

void CommandHandler::add_materials(const std::string& file, const Clocks& now,
                                   const CommandReply& reply) {
  using Read = Result<std::vector<MaterialFileRow>, std::string>;
  auto read = std::make_shared<Read>(std::vector<MaterialFileRow>());
  workers_.run([read, file](WorldReader&, const Generator&) { *read = read_material_file(file); },
               [this, read, file, now, reply](const std::string& error) {
                 const std::string command = "materials add: ";
                 if (!error.empty()) return refuse(reply, command + error);
                 if (!*read) return refuse(reply, command + read->error());
                 std::vector<MaterialRow> rows;
                 for (const MaterialFileRow& each : **read) rows.push_back(each.row);
                 const auto added = world_.changes().add_materials(rows, now);
                 if (added) return reply({added_text(*added, rows), true, true});
                 TextError wrong{file, 0, "", added.error().what};
                 if (const auto row = added.error().row) {
                   wrong.line = (**read)[*row].line;
                   wrong.key = "material[" + std::to_string(*row) + "]";
                 }
                 refuse(reply, command + wrong.message());
               });
}

void CommandHandler::preview(const CommandCaller& caller, const RollbackPreviewCommand& command,
                             const Clocks& now, const CommandReply& reply) {
  const auto edits = caller.preview_view ? std::make_shared<PreviewEdits>(*caller.preview_view)
                                         : std::shared_ptr<PreviewEdits>();
  const auto pictures = command.picture ? std::make_shared<PreviewPictures>(world_folder_)
                                        : std::shared_ptr<PreviewPictures>();
  const auto view_plan = [edits, pictures](const RestorePlan& plan) {
    if (edits) edits->add(plan);
    if (pictures) pictures->add(plan);
  };
  RollbackPreview::Summary summarise;
  if (pictures) {
    summarise = [pictures](WorldReader& reader, const Generator& generator, const std::string& id,
                           const ShouldContinue& wanted) {
      return pictures->draw(reader, generator, id, wanted);
    };
  }
  const auto answer = [edits, reply](CommandAnswer given) {
    if (edits && given.restore) {
      RestorePreview shown = *given.restore;
      edits->take(shown);
      given.restore = std::make_shared<const RestorePreview>(std::move(shown));
    }
    reply(given);
  };
  resolve(command.filter, "rollback preview", reply,
          [this, now, answer, view_plan, summarise](const SelectionFilter& filter) {
            rollback_.preview(filter, now, answer, view_plan, summarise);
          });
}

}  // namespace runstone
