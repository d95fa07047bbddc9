#include "server/admin/page_commands.hpp"

#include <array>

#include "common/core/utc_text.hpp"
#include "server/admin/access_token_store.hpp"
#include "server/admin/command_call.hpp"
#include "server/admin/rights_change_text.hpp"
#include "server/admin/role_commands.hpp"

namespace runstone {
namespace {

constexpr const char* kNoPage =
    "this server has no page for operators: its setting operators_page turns it on";
constexpr TimeUs kUsPerMinute = 60'000'000;

Result<PageLinkCommand, std::string> parse_page_link(WordReader& reader) {
  PageLinkCommand command;
  command.player = reader.player("page link");
  while (!reader.at_end()) {
    if (reader.take_word("rights")) {
      command.scope = take_rights(reader, "page link rights");
    } else {
      reader.wrong("page link \"" + reader.peek() +
                   "\": rights RIGHT,RIGHT comes after the player");
    }
  }
  if (reader.error().empty() && command.scope.and_in(kPageRights) == RightSet())
    reader.wrong("page link rights: name one of " + rights_text(kPageRights));
  return reader.result(command);
}

/// Returns the author number of a player of whom the log has a record. Other numbers may be given to
/// somebody else after a restart.
Result<AuthorId, std::string> stored_author(WorldReader& reader, const PublicKey& key,
                                            const std::string& who) {
  const auto rows = reader.players();
  if (!rows) return failure(rows.error().message());
  for (const PlayerRow& row : *rows) {
    if (row.key == key) return row.author;
  }
  return failure(who +
                 " has no record in the log yet: let the player join and build something first");
}

void make_page_link(const CommandCall& call, const PageLinkCommand& command) {
  AccessTokenStore* const tokens = call.services.actions.tokens.get();
  if (tokens == nullptr) return call.refuse(kNoPage);
  const auto go_on = [call, command, tokens](const KnownPlayers& players,
                                             const CommandCall::Keys& keys) {
    const PublicKey& key = keys.front();
    const std::string who = players.text_of(key);
    const RightsActor actor{key, call.services.is_operator(key)};
    if (page_rights(call.rights(), actor, command.scope, call.rights_time()) == RightSet())
      return call.refuse("page link: " + who +
                         " has no right for which the page is: " + rights_text(kPageRights));
    const TimeUs now_us = call.now.utc_us;
    call.on_worker(
        "page link: ",
        [tokens, key, who, scope = command.scope,
         now_us](WorldReader& reader) -> Result<MadeToken, std::string> {
          const auto author = stored_author(reader, key, who);
          if (!author) return failure(author.error());
          return tokens->make_link(key, *author, scope, now_us);
        },
        [call, who](const MadeToken& made) {
          call.answer(call.services.actions.page_base + std::string(kPageEnterPath) +
                      "?link=" + made.secret + "\ntoken " + std::to_string(made.token.number) +
                      " for " + who + ": works once, within " +
                      std::to_string(AccessTokens::kLinkUs / kUsPerMinute) +
                      " minutes. Whoever has the link acts as this player");
        });
  };
  call.with_players({command.player}, go_on, "page link ");
}

std::string token_line(const AccessToken& token, const KnownPlayers& players) {
  const RightSet missing = kPageRights.without(token.scope);
  return std::to_string(token.number) + " " + std::string(name_of(token.kind)) + " " +
         players.text_of(token.owner) + " until " + utc_text(token.ends_us) +
         (missing == RightSet() ? "" : " rights " + rights_text(token.scope));
}

void list_page_tokens(const CommandCall& call) {
  AccessTokenStore* const tokens = call.services.actions.tokens.get();
  if (tokens == nullptr) return call.refuse(kNoPage);
  call.with_players({}, [call, tokens](const KnownPlayers& players, const CommandCall::Keys&) {
    call.on_worker(
        "page list: ",
        [tokens, players,
         now_us = call.now.utc_us](WorldReader&) -> Result<std::string, std::string> {
          std::string text;
          for (const AccessToken& token : tokens->list(now_us))
            text += (text.empty() ? "" : "\n") + token_line(token, players);
          return text;
        },
        [call](const std::string& text) {
          call.answer(text.empty() ? "nobody has a link or uses the page" : text);
        });
  });
}

Result<PageRevokeCommand, std::string> parse_page_revoke(WordReader& reader) {
  PageRevokeCommand command;
  constexpr const char* kWhat = "a number (page list), a player or all";
  if (reader.take_word("all")) {
    // Neither number nor player.
  } else if (!reader.at_end() && number_of<std::uint64_t>(reader.peek())) {
    command.number = number_of<std::uint64_t>(reader.take("page revoke", kWhat));
  } else if (reader.at_end()) {
    reader.wrong(std::string("page revoke: ") + kWhat + " comes after it");
  } else {
    command.player = reader.player("page revoke");
  }
  reader.expect_end("page revoke");
  return reader.result(command);
}

void revoke_page_tokens(const CommandCall& call, const PageRevokeCommand& command) {
  AccessTokenStore* const tokens = call.services.actions.tokens.get();
  if (tokens == nullptr) return call.refuse(kNoPage);
  const auto revoke = [call, tokens](const std::function<bool(const AccessToken&)>& goes,
                                     bool is_one) {
    call.on_worker(
        "page revoke: ",
        [tokens, goes, now_us = call.now.utc_us](WorldReader&) {
          return tokens->remove(goes, now_us);
        },
        [call, is_one](const std::size_t& count) {
          if (is_one && count == 0)
            return call.refuse("page revoke: there is no such token (page list names them)");
          call.answer(std::to_string(count) + (count == 1 ? " token" : " tokens") +
                      " revoked: no command is given with them any more");
        });
  };
  if (command.number)
    return revoke(
        [number = *command.number](const AccessToken& token) { return token.number == number; },
        true);
  if (command.player.empty()) return revoke([](const AccessToken&) { return true; }, false);
  const auto go_on = [revoke](const KnownPlayers&, const CommandCall::Keys& keys) {
    revoke([key = keys.front()](const AccessToken& token) { return token.owner == key; }, false);
  };
  call.with_players({command.player}, go_on, "page revoke ");
}

constexpr std::array<CommandRow, 3> kPageRows = {{
    {"page link", kLocal,
     "page link PLAYER [rights RIGHT,...]\n"
     "                          a link with which this player enters the page for operators once",
     parsed_by<parse_page_link, make_page_link>()},
    {"page list", needs(Right::administer),
     "page list                 the links and the tokens of the page for operators",
     alone<list_page_tokens>()},
    {"page revoke", needs(Right::administer),
     "page revoke N             end a token; or those of a PLAYER, or all",
     parsed_by<parse_page_revoke, revoke_page_tokens>()},
}};

}  // namespace

RightSet page_rights(const RightsState& state, const RightsActor& actor, RightSet scope,
                     TimeUs now_us) {
  const RightSet wanted = kPageRights.and_in(scope);
  if (actor.is_operator || !actor.key) return wanted;
  // Who may not join may not act from outside either.
  if (!state.decide(*actor.key, Right::see, now_us).is_allowed) return {};
  return state.rights_in_force(*actor.key, now_us).and_in(wanted);
}

std::span<const CommandRow> page_commands() { return kPageRows; }

}  // namespace runstone
