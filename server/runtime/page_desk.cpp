#include "server/runtime/page_desk.hpp"

#include <sodium.h>

#include <algorithm>
#include <array>
#include <asio/post.hpp>
#include <utility>

#include "common/core/hex.hpp"
#include "common/core/text.hpp"
#include "common/os/private_file.hpp"
#include "protocol/codec/key_fingerprint.hpp"
#include "server/admin/command_table.hpp"
#include "server/admin/word_reader.hpp"
#include "server/runtime/logging.hpp"
#include "server/runtime/read_clocks.hpp"

namespace runstone {
namespace {

constexpr std::size_t kPictureBytesMax = std::size_t{4} << 20;
constexpr std::size_t kPreviewIdBytesMax = 20;

/// The commands that change nothing, by the words of their rows.
constexpr std::array<std::string_view, 14> kLooks = {
    "status", "players",  "roles",   "grants",   "invites",  "bans",          "log",
    "names",  "chat log", "reports", "refusals", "activity", "rollback list", "page list"};

std::string_view take_page_word(std::string_view& rest) {
  const std::string_view word = rest.substr(0, rest.find(' '));
  rest.remove_prefix(std::min(word.size() + 1, rest.size()));
  return word;
}

bool changes_nothing(std::string_view line) {
  const auto words = command_words(line);
  const CommandRow* const row = words ? find_command(*words) : nullptr;
  return row != nullptr && std::ranges::find(kLooks, row->words) != kLooks.end();
}

bool is_form_key(std::string_view text, std::string_view secret) {
  const std::string expected = page_form_key(secret);
  return text.size() == expected.size() &&
         sodium_memcmp(text.data(), expected.data(), expected.size()) == 0;
}

bool is_preview_id(std::string_view id) {
  return id.size() > 1 && id.size() <= kPreviewIdBytesMax && id[0] == 'p' &&
         id.find_first_not_of("0123456789", 1) == std::string_view::npos;
}

}  // namespace

std::string page_form_key(std::string_view secret) {
  constexpr std::string_view kPurpose = "runstone page form";
  std::array<std::uint8_t, 32> out{};
  crypto_generichash(out.data(), out.size(), reinterpret_cast<const unsigned char*>(secret.data()),
                     secret.size(), reinterpret_cast<const unsigned char*>(kPurpose.data()),
                     kPurpose.size());
  return to_hex(out);
}

PageDesk::PageDesk(AccessTokenStore& tokens, asio::thread_pool& workers, std::string world_folder,
                   Server server)
    : tokens_(tokens),
      workers_(workers),
      previews_(std::move(world_folder) + "/previews/"),
      server_(std::move(server)) {}

void PageDesk::take(const std::string& line, CommandReply reply) {
  // A link that is used up is written to the disk.
  asio::post(workers_, [this, line, reply = std::move(reply)] { answer(line, reply); });
}

void PageDesk::answer(std::string_view line, const CommandReply& reply) {
  // The line of a command is written into the log of the server, where it must stay one line.
  if (!is_printable_utf8(line)) return refuse(reply, "a line is printable UTF-8 text");
  std::string_view rest = line;
  const std::string_view verb = take_page_word(rest);
  const std::string_view secret = take_page_word(rest);
  if (verb == "enter") return enter(secret, reply);
  const auto token = tokens_.find(TokenKind::page, secret, read_clocks().utc_us);
  if (!token) return refuse(reply, kPageUnknown);
  answer_known(verb, rest, *token, secret, reply);
}

void PageDesk::enter(std::string_view link, const CommandReply& reply) {
  const auto made = tokens_.enter(link, read_clocks().utc_us);
  if (!made) return refuse(reply, std::string(kPageBarred) + "\n" + made.error());
  if (!*made) return refuse(reply, kPageUnknown);
  const AccessToken& token = (*made)->token;
  logger("app").info("page_token={} author={} key={} entered the page for operators", token.number,
                     token.author, key_fingerprint(token.owner));
  reply(CommandAnswer::last(std::string(kPageKnown) + "\ntoken " + (*made)->secret + "\nends " +
                            std::to_string(token.ends_us / 1'000'000)));
}

void PageDesk::answer_known(std::string_view verb, std::string_view rest, const AccessToken& token,
                            std::string_view secret, const CommandReply& reply) {
  if (verb == "who") {
    const auto with_form = [reply, form = page_form_key(secret),
                            ends_us = token.ends_us](CommandAnswer answer) {
      if (answer.is_done && answer.is_ok)
        answer.text += "\nform " + form + "\nends " + std::to_string(ends_us / 1'000'000);
      reply(answer);
    };
    return server_.describe(token, with_form);
  }
  if (verb == "look") {
    if (changes_nothing(rest)) return server_.give(token, std::string(rest), reply);
    return refuse(reply, std::string(kPageKnown) + "\nonly a form may give this command");
  }
  if (verb == "picture") return send_picture(rest, token, reply);
  if (verb != "do" && verb != "leave")
    return refuse(reply, std::string(kPageKnown) + "\nthere is no such question");
  if (!is_form_key(take_page_word(rest), secret))
    return refuse(reply, std::string(kPageKnown) + "\nthe form is not of this page: load it again");
  if (verb == "leave") return leave(token, reply);
  server_.give(token, std::string(rest), reply);
}

void PageDesk::send_picture(std::string_view words, const AccessToken& token,
                            const CommandReply& reply) {
  const std::string_view id = take_page_word(words);
  if (!is_preview_id(id) || (words != "before" && words != "after"))
    return refuse(reply, std::string(kPageKnown) + "\nthere is no such picture");
  const std::string file = previews_ + std::string(id) + "-" + std::string(words) + ".png";
  server_.rights(token, [this, file, reply](RightSet rights) {
    if (!rights.has(Right::roll_back)) return refuse(reply, kPageBarred);
    asio::post(workers_, [file, reply] {
      const auto bytes = read_file_bytes(file, kPictureBytesMax);
      if (!bytes) return refuse(reply, std::string(kPageKnown) + "\nthere is no such picture");
      reply(CommandAnswer::last(std::string(kPageKnown) + "\n" + to_hex(*bytes)));
    });
  });
}

void PageDesk::leave(const AccessToken& token, const CommandReply& reply) {
  const auto gone = tokens_.remove(
      [number = token.number](const AccessToken& each) { return each.number == number; },
      read_clocks().utc_us);
  if (!gone) return refuse(reply, std::string(kPageKnown) + "\n" + gone.error());
  logger("app").info("page_token={} author={} key={} left the page for operators", token.number,
                     token.author, key_fingerprint(token.owner));
  reply(CommandAnswer::last(kPageKnown));
}

}  // namespace runstone
