#include "server/runtime/command_runner.hpp"

#include <sodium.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "common/core/text.hpp"
#include "common/rights/right.hpp"
#include "protocol/codec/key_fingerprint.hpp"
#include "protocol/limits.hpp"
#include "server/admin/command_table.hpp"
#include "server/admin/page_commands.hpp"
#include "server/admin/rights_change_text.hpp"
#include "server/runtime/logging.hpp"
#include "server/runtime/page_desk.hpp"
#include "server/runtime/read_clocks.hpp"

namespace runstone {
namespace {

/// Returns true if a player with these rights can act on others, so that the commands are logged.
bool has_power(RightSet rights) {
  return rights.has(Right::roll_back) || rights.has(Right::moderate) || rights.has(Right::grant) ||
         rights.has(Right::administer);
}

/// Returns the actions with replies that may be called from any thread.
OperatorActions on_strand(WorldStrand& strand, const OperatorActions& actions) {
  const auto posted = [&strand](CommandReply reply) -> CommandReply {
    return [&strand, reply = std::move(reply)](const CommandAnswer& answer) {
      strand.post([reply, answer] { reply(answer); });
    };
  };
  OperatorActions out = actions;
  if (actions.reload) {
    out.reload = [posted, reload = actions.reload](CommandReply reply) {
      reload(posted(std::move(reply)));
    };
  }
  if (actions.back_up) {
    out.back_up = [posted, back_up = actions.back_up](const std::string& folder,
                                                      CommandReply reply) {
      back_up(folder, posted(std::move(reply)));
    };
  }
  if (actions.hand_over) {
    out.hand_over = [posted, hand_over = actions.hand_over](std::optional<SessionId> successor,
                                                            CommandReply reply) {
      hand_over(successor, posted(std::move(reply)));
    };
  }
  if (actions.save_build_file) {
    out.save_build_file = [&strand, save = actions.save_build_file](
                              std::uint64_t content, std::shared_ptr<const Bytes> file,
                              std::function<void(const std::string&)> done) {
      return save(content, std::move(file),
                  [&strand, done = std::move(done)](const std::string& why) {
                    strand.post([done, why] { done(why); });
                  });
    };
  }
  if (actions.list_chat) {
    out.list_chat = [posted, list = actions.list_chat](const ChatQuery& query, CommandReply reply) {
      list(query, posted(std::move(reply)));
    };
  }
  return out;
}

}  // namespace

std::vector<std::string> answer_lines(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view rest = std::string_view(text).substr(at, end - at);
    do {
      const std::string_view line = cut_utf8(rest, kCommandLineBytesMax);
      lines.emplace_back(line);
      rest.remove_prefix(line.size());
    } while (!rest.empty());
    at = end + 1;
  }
  return lines;
}

CommandRunner::CommandRunner(WorldStrand& strand, WorldServer& world, WorldReaders& readers,
                             std::set<PublicKey> operators, const std::string& world_folder,
                             const OperatorActions& actions)
    : strand_(strand),
      world_(world),
      readers_(readers),
      operators_(std::move(operators)),
      rollback_(world, *this,
                [](std::span<std::uint8_t> out) { randombytes_buf(out.data(), out.size()); }),
      placing_(world, rollback_, *this,
               [](std::span<std::uint8_t> out) { randombytes_buf(out.data(), out.size()); }),
      services_{world,
                rollback_,
                *this,
                placing_,
                world_folder,
                on_strand(strand, actions),
                [this](const PublicKey& key) { return operators_.contains(key); }} {}

void CommandRunner::run(const std::string& line, CommandReply reply) {
  strand_.post([this, line, reply = std::move(reply)] {
    if (world_.cluster().is_following()) return refuse(reply, kGiveThere);
    give_command({services_, {}, read_clocks(), reply}, line);
    tick(read_clocks());
  });
}

void CommandRunner::run(SessionId session, AuthorId author, const PublicKey& key,
                        const std::string& text) {
  // A command may answer at once, and WorldServer must not be called from within its own call.
  strand_.post([this, session, author, key, text] {
    if (world_.cluster().is_following())
      return world_.people().commands().answer(session, {kGiveThere}, true, false);
    const CommandCaller caller{author,
                               {key, operators_.contains(key)},
                               world_.people().commands().restore_preview_view(session)};
    if (caller.actor.is_operator || has_power(world_.rights().state().role_of(key).rights))
      logger("app").info("command author={} key={} command=\"{}\"", author, key_fingerprint(key),
                         logged_command(text));
    const auto reply = [this, session](const CommandAnswer& answer) {
      if (answer.restore) world_.people().commands().show_restore(session, *answer.restore);
      world_.people().commands().answer(session, answer_lines(answer.text), answer.is_done,
                                        answer.is_ok);
    };
    give_command({services_, caller, read_clocks(), reply}, text);
    tick(read_clocks());
  });
}

CommandCaller CommandRunner::caller_of(const AccessToken& token) const {
  return {token.author, {token.owner, operators_.contains(token.owner)}, std::nullopt, token.scope};
}

RightSet CommandRunner::rights_of(const AccessToken& token) {
  world_.changes().read_clocks(read_clocks());
  return page_rights(world_.rights().state(), caller_of(token).actor, token.scope,
                     world_.rights().time());
}

void CommandRunner::run(const AccessToken& token, const std::string& line,
                        const CommandReply& reply) {
  // The rights may have changed since the page was loaded.
  if (rights_of(token) == RightSet()) return refuse(reply, kPageBarred);
  logger("app").info("command author={} key={} page_token={} command=\"{}\"", token.author,
                     key_fingerprint(token.owner), token.number, logged_command(line));
  reply(CommandAnswer::progress(kPageKnown));
  give_command({services_, caller_of(token), read_clocks(), reply}, line);
  tick(read_clocks());
}

void CommandRunner::describe(const AccessToken& token, const CommandReply& reply) {
  const RightSet rights = rights_of(token);
  if (rights == RightSet()) return refuse(reply, kPageBarred);
  const CommandCaller caller = caller_of(token);
  const std::string role =
      caller.actor.is_operator ? "operator" : world_.rights().state().role_of(token.owner).name;
  const CommandCall call{services_, caller, read_clocks(), reply};
  call.with_players({}, [call, rights, role, owner = token.owner](const KnownPlayers& players,
                                                                  const CommandCall::Keys&) {
    call.answer(std::string(kPageKnown) + "\nname " + players.text_of(owner) + "\nrole " + role +
                "\nrights " + rights_text(rights));
  });
}

void CommandRunner::run(Work work, std::function<void(std::string)> then) {
  readers_.run_on_log_reader(std::move(work), [this, then = std::move(then)](std::string error) {
    then(std::move(error));
    tick(read_clocks());
  });
}

}  // namespace runstone
