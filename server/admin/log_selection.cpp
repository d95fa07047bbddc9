#include "server/admin/log_selection.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "common/core/hex.hpp"
#include "server/names/name_reference.hpp"
#include "server/rollback/count_text.hpp"
#include "server/rollback/joined_after.hpp"

namespace runstone {
namespace {

using Authors = std::set<AuthorId>;

/// Returns true if the word is the number, the fingerprint or the key of a player.
bool is_reference(const std::string& word) {
  PublicKey key{};
  return word.starts_with('#') || !fingerprint_in(word).empty() || read_hex(word, key);
}

/// The words of a filter about players, in the order in which they are looked up.
std::vector<std::string> player_words_of(const CommandFilter& filter) {
  std::vector<std::string> words;
  for (const auto* authors : {&filter.authors, &filter.not_authors}) {
    for (const CommandFilter::Author& author : *authors) {
      if (!author.number && !is_name_pattern(author.name)) words.push_back(author.name);
    }
  }
  words.insert(words.end(), filter.address_of.begin(), filter.address_of.end());
  return words;
}

/// The patterns of a filter, in the order in which they are looked up.
std::vector<std::string> patterns_of(const CommandFilter& filter) {
  std::vector<std::string> patterns;
  for (const auto* authors : {&filter.authors, &filter.not_authors}) {
    for (const CommandFilter::Author& author : *authors) {
      if (is_name_pattern(author.name)) patterns.push_back(author.name);
    }
  }
  return patterns;
}

/// Returns the words of a hazard: what selects how many players.
std::string selects_text(const std::string& what, bool is_all, std::size_t players) {
  return what + " selects " + (is_all ? "everybody who has built, " : "") +
         counted(players, "player");
}

/// The players who joined after a time.
struct FreshPlayers {
  std::vector<AuthorId> authors;  // ascending
  std::size_t built = 0;          // how many players have built in all
};

/// Finds them. Blocks on the disk.
StoreResult<FreshPlayers> read_fresh(WorldReader& reader, TimeUs since_us) {
  auto authors = joined_after(reader, since_us);
  if (!authors) return failure(authors.error());
  const auto players = reader.players();
  if (!players) return failure(players.error());
  return FreshPlayers{*std::move(authors), players->size()};
}

/// Finds the authors that the words of a filter mean. A failure is the end of a refusal.
class AuthorFinder {
 public:
  AuthorFinder(const CommandCall& call, const CommandFilter& filter,
               const CommandCall::FoundPlayers& found)
      : call_(call),
        filter_(filter),
        players_(*found.known),
        key_(found.keys.begin()),
        match_(found.matches.begin()) {}

  /// Finds all of them, each word once.
  Result<void, std::string> find() {
    for (const CommandFilter::Author& author : filter_.authors) {
      if (auto found = find_author("author ", author, wanted_); !found) return found;
    }
    for (const CommandFilter::Author& author : filter_.not_authors) {
      if (auto found = find_author("not author ", author, excluded_); !found) return found;
    }
    for (const std::string& word : filter_.address_of) find_sharing(word, *key_++);
    return {};
  }
  const Authors& wanted() const { return wanted_; }
  const Authors& excluded() const { return excluded_; }
  /// Returns why the words select suspiciously many players, or nullopt.
  const std::optional<std::string>& hazard() const { return hazard_; }

 private:
  Result<void, std::string> find_author(const std::string& option,
                                        const CommandFilter::Author& author, Authors& out) {
    if (author.number) {
      // A number needs no player: the log of a copy may have authors whom nobody knows here.
      if (const auto doubt = players_.doubt_of(*author.number))
        return failure(option + "\"#" + std::to_string(*author.number) + "\": " + *doubt);
      out.insert(*author.number);
      return {};
    }
    if (is_name_pattern(author.name)) return find_pattern(option, author.name, out);
    const PublicKey key = *key_++;
    const auto number = players_.author_of(key);
    const std::string quoted = "\"" + author.name + "\"";
    if (!number)
      return failure(option + quoted + ": " + players_.text_of(key) +
                     " has never built (players lists who has)");
    if (!players_.has_name(key, author.name) && !is_reference(author.name))
      call_.report("author " + quoted + " is now called " + players_.text_of(key));
    out.insert(*number);
    return {};
  }
  Result<void, std::string> find_pattern(const std::string& option, const std::string& pattern,
                                         Authors& out) {
    const std::string quoted = "\"" + pattern + "\"";
    // Owners keep names with a "*" from before (name_reference.hpp).
    if (const std::string called = players_.list_of_named(pattern); !called.empty()) {
      return failure(option + quoted + ": that is also the name of a player; it may mean " +
                     called + ", or the pattern (say \"" + pattern + "*\")");
    }
    const Authors& found = *match_++;
    if (found.empty()) return failure(option + quoted + ": nobody of such a name is known here");
    if (&out == &wanted_) warn_of_many(quoted, found, kPatternPlayersMax);
    report_group(option + quoted, found);
    out.insert(found.begin(), found.end());
    return {};
  }
  void find_sharing(const std::string& word, const PublicKey& key) {
    std::set<PublicKey> keys{key};
    for (const PublicKey& other : call_.world().people().addresses().sharing(key))
      keys.insert(other);
    Authors found;
    for (const PublicKey& each : keys) {
      if (const auto number = players_.author_of(each)) found.insert(*number);
    }
    const std::string quoted = "address-of \"" + word + "\"";
    warn_of_many(quoted, found, kSharedPlayersMax);
    report_group(quoted, found);
    wanted_.insert(found.begin(), found.end());
  }
  /// Sets the hazard, unless there is one, if a word selects everybody or more than `players_max`.
  void warn_of_many(const std::string& word, const Authors& authors, std::size_t players_max) {
    const bool is_all = authors.size() > 1 && authors.size() == players_.author_count();
    if (hazard_ || (!is_all && authors.size() <= players_max)) return;
    hazard_ = selects_text(word, is_all, authors.size());
  }
  /// Shows whom a word means, because the line does not name these players.
  void report_group(const std::string& word, const Authors& authors) {
    constexpr std::size_t kListed = 20;
    std::string text = word + ": " + counted(authors.size(), "player");
    std::size_t listed = 0;
    for (const AuthorId author : authors) {
      if (++listed > kListed) break;
      text += (listed == 1 ? ": " : ", ") + players_.text_of(author);
    }
    if (authors.size() > kListed)
      text += " and " + std::to_string(authors.size() - kListed) + " more";
    call_.report(text);
  }

  const CommandCall& call_;
  const CommandFilter& filter_;
  const KnownPlayers& players_;
  CommandCall::Keys::const_iterator key_;
  std::vector<Authors>::const_iterator match_;  // of the next pattern
  Authors wanted_, excluded_;
  std::optional<std::string> hazard_;
};

/// Puts the authors into the filter. `fresh`: those who joined after a time, if that was asked.
/// Returns false if nobody is left.
bool choose_authors(const Authors& wanted, const Authors& excluded,
                    const std::optional<Authors>& fresh, bool names_players,
                    SelectionFilter& filter) {
  Authors chosen = wanted;
  if (fresh) {
    if (!names_players) chosen = *fresh;
    std::erase_if(chosen, [&](AuthorId author) { return !fresh->contains(author); });
  }
  const bool has_list = names_players || fresh;
  std::erase_if(chosen, [&](AuthorId author) { return excluded.contains(author); });
  filter.authors.assign(chosen.begin(), chosen.end());
  if (!has_list) filter.excluded_authors.assign(excluded.begin(), excluded.end());
  return !has_list || !chosen.empty();
}

/// Returns the filter that has these authors left out, and nothing else.
CommandFilter only_without(const std::vector<CommandFilter::Author>& authors) {
  CommandFilter filter;
  filter.not_authors = authors;
  return filter;
}

}  // namespace

void with_selection(const CommandCall& call, const CommandFilter& filter,
                    const std::string& command, bool must_confirm,
                    const std::function<void(const SelectionFilter&)>& go_on) {
  SelectionFilter out;
  out.from_us = filter.from_us.value_or(out.from_us);
  out.until_us = filter.until_us.value_or(out.until_us);
  out.box = filter.box;
  out.cause = filter.cause;
  if (!filter.is_about_players()) return go_on(out);
  const bool names_players = !filter.authors.empty() || !filter.address_of.empty();
  const bool leaves_out_only = filter == only_without(filter.not_authors);
  const auto nobody_left = [call, command] {
    call.refuse(command +
                ": the words about players (author, not author, joined-after, address-of) "
                "leave nobody");
  };
  call.find_players(
      player_words_of(filter), patterns_of(filter),
      [=](const CommandCall::FoundPlayers& players) {
        AuthorFinder finder(call, filter, players);
        if (const auto found = finder.find(); !found)
          return call.refuse(command + " " + found.error());
        std::optional<std::string> hazard = finder.hazard();
        if (leaves_out_only)
          hazard = "without another filter it selects the edits of everybody else";
        if (must_confirm && call.refuse_unless_confirmed(hazard)) return;
        if (!filter.joined_after_us) {
          SelectionFilter chosen = out;
          if (!choose_authors(finder.wanted(), finder.excluded(), std::nullopt, names_players,
                              chosen))
            return nobody_left();
          return go_on(chosen);
        }
        call.on_worker(
            command + ": ",
            [since_us = *filter.joined_after_us](WorldReader& reader) {
              return read_fresh(reader, since_us);
            },
            [=, wanted = finder.wanted(), excluded = finder.excluded()](const FreshPlayers& fresh) {
              SelectionFilter chosen = out;
              if (!choose_authors(wanted, excluded,
                                  Authors(fresh.authors.begin(), fresh.authors.end()),
                                  names_players, chosen))
                return nobody_left();
              std::optional<std::string> everybody;
              if (chosen.authors.size() > 1 && chosen.authors.size() == fresh.built)
                everybody = selects_text("joined-after", true, fresh.built);
              if (must_confirm && call.refuse_unless_confirmed(everybody)) return;
              go_on(chosen);
            });
      },
      command + (filter.address_of.empty() && filter.not_authors.empty() ? " author " : " "));
}

}  // namespace runstone
