#include "server/admin/known_players.hpp"

#include <cstddef>
#include <string_view>

#include "common/core/hex.hpp"
#include "common/names/folded_name.hpp"
#include "protocol/codec/key_fingerprint.hpp"
#include "server/admin/word_reader.hpp"

namespace runstone {
namespace {

/// Returns the fingerprint in the form of key_fingerprint(), or an empty text if the word has not
/// the form of one.
std::string fingerprint_in(std::string_view word) {
  std::string text;
  if (word.size() != 14) return text;
  for (std::size_t i = 0; i < word.size(); ++i) {
    const char c = word[i];
    const bool is_digit = c >= '0' && c <= '9';
    const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (i == 4 || i == 9 ? c != '-' : !is_digit && !is_letter) return "";
    text += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  }
  return text;
}

}  // namespace

bool is_fingerprint(const std::string& word) { return !fingerprint_in(word).empty(); }

KnownPlayers::KnownPlayers(const Sources& sources) {
  for (const PlayerRow& row : sources.present) add(row.key, row.name, row.author);
  for (const PlayerRow& row : sources.stored) add(row.key, row.name, row.author);
  for (const PlayerRow& row : sources.visitors) add(row.key, row.name, row.author);
  for (const NameClaim& claim : sources.claims) add(claim.key, claim.name, std::nullopt);
  for (const PublicKey& key : sources.others) players_.try_emplace(key);
  for (const UsedName& used : sources.used) {
    const auto key = authors_.find(used.author);
    if (key != authors_.end()) names_[folded_name(used.name)].insert(key->second);
  }
}

void KnownPlayers::add(const PublicKey& key, const std::string& name,
                       std::optional<AuthorId> author) {
  Player& player = players_[key];
  if (player.name.empty()) player.name = name;
  if (author && !player.author) player.author = author;
  if (author) authors_.try_emplace(*author, key);
  names_[folded_name(name)].insert(key);
}

Result<PublicKey, std::string> KnownPlayers::find(const std::string& word) const {
  constexpr std::size_t kListed = 10;
  if (word.starts_with('#')) {
    const auto author = number_of<AuthorId>(std::string_view(word).substr(1));
    const auto key = author ? authors_.find(*author) : authors_.end();
    if (key != authors_.end()) return key->second;
    return failure("nobody has that author number (players lists them)");
  }
  PublicKey typed{};
  if (read_hex(word, typed)) return typed;
  std::set<PublicKey> meant;
  if (const auto named = names_.find(folded_name(word)); named != names_.end())
    meant = named->second;
  const std::string fingerprint = fingerprint_in(word);
  if (!fingerprint.empty()) {
    for (const auto& [key, player] : players_) {
      if (key_fingerprint(key) == fingerprint) meant.insert(key);
    }
  }
  if (meant.size() == 1) return *meant.begin();
  if (meant.empty()) {
    return failure(
        fingerprint.empty()
            ? "nobody of that name is known here (players and names list the others)"
            : "nobody with that fingerprint is known here (players and names list them)");
  }
  std::string list;
  std::size_t listed = 0;
  for (const PublicKey& key : meant) {
    if (++listed > kListed) break;
    list += (listed == 1 ? " " : ", ") + text_of(key);
  }
  if (meant.size() > kListed) list += " and " + std::to_string(meant.size() - kListed) + " more";
  return failure("several players have, own or had that name:" + list +
                 " (give #N, the fingerprint or the key)");
}

std::string KnownPlayers::text_of(const PublicKey& key) const {
  const auto found = players_.find(key);
  std::string text;
  if (found != players_.end()) {
    if (!found->second.name.empty()) text += found->second.name + " ";
    if (found->second.author) text += "#" + std::to_string(*found->second.author) + " ";
  }
  return text + key_fingerprint(key);
}

std::string KnownPlayers::text_of(AuthorId author) const {
  if (author == 0) return "the server";
  const auto key = authors_.find(author);
  return key == authors_.end() ? "#" + std::to_string(author) : text_of(key->second);
}

}  // namespace runstone
