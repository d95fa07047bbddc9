#include "server/admin/known_players.hpp"

#include <cstddef>
#include <string_view>

#include "common/core/hex.hpp"
#include "common/names/folded_name.hpp"
#include "protocol/codec/key_fingerprint.hpp"
#include "server/admin/word_reader.hpp"
#include "server/names/name_reference.hpp"

namespace runstone {
namespace {

/// Returns true if the text fits the pattern, in which "*" stands for any bytes. Cost: O(bytes of the
/// text * bytes of the pattern).
bool fits(std::string_view pattern, std::string_view text) {
  std::size_t at = 0, next = 0;                          // in the pattern and in the text
  std::size_t star = std::string_view::npos, again = 0;  // the last "*", and where its text ends
  while (next < text.size()) {
    if (at < pattern.size() && pattern[at] == '*') {
      star = at++;
      again = next;
    } else if (at < pattern.size() && pattern[at] == text[next]) {
      ++at;
      ++next;
    } else if (star != std::string_view::npos) {
      at = star + 1;  // the last "*" takes one byte more
      next = ++again;
    } else {
      return false;
    }
  }
  while (at < pattern.size() && pattern[at] == '*') ++at;
  return at == pattern.size();
}

}  // namespace

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

std::set<PublicKey> KnownPlayers::named(const std::string& name) const {
  const auto found = names_.find(folded_name(name));
  return found == names_.end() ? std::set<PublicKey>() : found->second;
}

std::set<PublicKey> KnownPlayers::with_fingerprint(const std::string& fingerprint) const {
  std::set<PublicKey> keys;
  for (const auto& [key, player] : players_) {
    if (key_fingerprint(key) == fingerprint) keys.insert(key);
  }
  return keys;
}

/// Returns text such as "ana #3 9M1Q-Z7CR-04KD (say #3), bob ...".
std::string KnownPlayers::list_of(const std::set<PublicKey>& keys) const {
  constexpr std::size_t kListed = 10;
  std::string list;
  std::size_t listed = 0;
  for (const PublicKey& key : keys) {
    if (++listed > kListed) break;
    list += (listed == 1 ? "" : ", ") + text_of(key) + " (say " + word_for(key) + ")";
  }
  if (keys.size() > kListed) list += " and " + std::to_string(keys.size() - kListed) + " more";
  return list;
}

Result<PublicKey, std::string> KnownPlayers::find(const std::string& word) const {
  PublicKey typed{};
  if (read_hex(word, typed)) return typed;
  const bool is_number = word.starts_with('#');
  const std::string fingerprint = fingerprint_in(word);
  const std::set<PublicKey> by_name = named(word);
  std::set<PublicKey> meant;
  if (is_number) {
    const auto author = number_of<AuthorId>(std::string_view(word).substr(1));
    const auto key = author ? authors_.find(*author) : authors_.end();
    if (key != authors_.end()) meant.insert(key->second);
  } else if (!fingerprint.empty()) {
    meant = with_fingerprint(fingerprint);
  } else {
    meant = by_name;
  }
  const bool is_reference = is_number || !fingerprint.empty();
  std::set<PublicKey> all = meant;
  all.insert(by_name.begin(), by_name.end());
  if (meant.size() == 1 && all.size() == 1) return *meant.begin();
  if (all.size() > 1) {
    return failure((is_reference && !by_name.empty()
                        ? "that is also the name of a player; it may mean "
                        : "several players have, own or had that name: ") +
                   list_of(all));
  }
  const std::string called = all.empty() ? "" : ". The player of that name is " + list_of(all);
  if (is_number) return failure("nobody has that author number (players lists them)" + called);
  if (!fingerprint.empty()) {
    return failure("nobody with that fingerprint is known here (players and names list them)" +
                   called);
  }
  return failure("nobody of that name is known here (players and names list the others)");
}

std::optional<std::string> KnownPlayers::doubt_of(AuthorId author) const {
  const std::set<PublicKey> by_name = named("#" + std::to_string(author));
  const auto key = authors_.find(author);
  std::set<PublicKey> all = by_name;
  if (key != authors_.end()) all.insert(key->second);
  if (by_name.empty() || (all.size() == 1 && key != authors_.end())) return std::nullopt;
  return "that is also the name of a player; it may mean " + list_of(all);
}

std::optional<AuthorId> KnownPlayers::author_of(const PublicKey& key) const {
  const auto found = players_.find(key);
  return found == players_.end() ? std::nullopt : found->second.author;
}

std::vector<PublicKey> KnownPlayers::matching(const std::string& pattern) const {
  const std::string folded = folded_name(pattern);
  std::set<PublicKey> keys;
  for (const auto& [name, named] : names_) {
    if (fits(folded, name)) keys.insert(named.begin(), named.end());
  }
  return {keys.begin(), keys.end()};
}

std::optional<PublicKey> KnownPlayers::key_of(AuthorId author) const {
  const auto found = authors_.find(author);
  if (found == authors_.end()) return std::nullopt;
  return found->second;
}

std::string KnownPlayers::name_of(const PublicKey& key) const {
  const auto found = players_.find(key);
  return found == players_.end() ? std::string() : found->second.name;
}

bool KnownPlayers::has_name(const PublicKey& key, const std::string& name) const {
  const auto found = players_.find(key);
  return found != players_.end() && folded_name(found->second.name) == folded_name(name);
}

std::string KnownPlayers::word_for(const PublicKey& key) const {
  const auto means_only = [&](std::set<PublicKey> meant, const std::string& word) {
    const std::set<PublicKey> by_name = named(word);
    meant.insert(by_name.begin(), by_name.end());
    return meant == std::set<PublicKey>{key};
  };
  if (const auto author = author_of(key)) {
    const std::string number = "#" + std::to_string(*author);
    if (means_only({authors_.at(*author)}, number)) return number;
  }
  const std::string fingerprint = key_fingerprint(key);
  return means_only(with_fingerprint(fingerprint), fingerprint) ? fingerprint : to_hex(key);
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
