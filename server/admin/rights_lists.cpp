#include "server/admin/rights_lists.hpp"

#include <cstddef>
#include <map>
#include <utility>

#include "common/core/utc_text.hpp"
#include "server/admin/rights_change_text.hpp"
#include "server/admin/rights_reason.hpp"

namespace runstone {
namespace {

/// Collects the lines of an answer.
class RightsLines {
 public:
  /// Counts an entry. Returns true if its line is to be added.
  bool take() { return ++count_ <= kListed; }
  void add(const std::string& line) { text_ += (text_.empty() ? "" : "\n") + line; }
  std::string text(const char* if_empty) const {
    if (count_ == 0) return if_empty;
    if (count_ <= kListed) return text_;
    return text_ + "\nand " + std::to_string(count_ - kListed) + " more";
  }

 private:
  static constexpr std::size_t kListed = 500;
  std::size_t count_ = 0;
  std::string text_;
};

std::string player_or_range(const RestrictionSubject& subject, const KnownPlayers& players) {
  const auto* key = std::get_if<PublicKey>(&subject);
  return key == nullptr ? subject_text(subject) : players.text_of(*key);
}

std::string count_text(std::size_t grants) {
  return std::to_string(grants) + (grants == 1 ? " grant" : " grants");
}

}  // namespace

std::string role_list(const RightsState& state, const KnownPlayers& players) {
  std::map<std::string, std::size_t> grants;
  for (const auto& [key, grant] : state.grants()) ++grants[grant.value];
  RightsLines lines;
  for (const auto& [name, role] : state.roles()) {
    if (!lines.take()) continue;
    const bool is_default = state.default_role().value == name;
    lines.add(name + (is_default ? " (default): " : ": ") + role_text(role.value) + "; " +
              count_text(grants[name]) + "; " + origin_text(role.by, players));
  }
  return lines.text("there are no roles");
}

std::string grant_list(const RightsState& state, TimeUs now_us, const KnownPlayers& players) {
  RightsLines lines;
  for (const auto& [key, grant] : state.grants()) {
    if (!lines.take()) continue;
    const bool is_known = state.find_role(grant.value) != nullptr;
    lines.add(players.text_of(key) + ": " + grant.value +
              (is_known ? "" : " (there is no such role: the default role counts)") + "; " +
              origin_text(grant.by, players));
  }
  for (const auto& [key, grant] : state.timed_grants()) {
    if (state.timed_grant(key, now_us) == nullptr || !lines.take()) continue;
    lines.add(players.text_of(key) + ": " + grant.value.role + " until " +
              utc_text(grant.value.until_us) + "; " + origin_text(grant.by, players));
  }
  return lines.text("nobody has a granted role (roles names the default role)");
}

std::string invite_list(const RightsState& state, TimeUs now_us, const KnownPlayers& players) {
  RightsLines lines;
  for (const auto& [id, open] : state.invites()) {
    if (state.usable_invite(id, now_us) == nullptr || !lines.take()) continue;
    lines.add(invite_text(open.value.invite) + ", accepted " + std::to_string(open.value.accepted) +
              "; " + origin_text(open.by, players));
  }
  return lines.text("there are no invites in force (invite makes one)");
}

std::string password_line(const RightsState& state, const KnownPlayers& players) {
  const Decided<std::optional<JoinPassword>>& password = state.password();
  if (!password.value) return "the world has no password (password set gives it one)";
  return "the world has a password; who joins with it gets the role " + password.value->role +
         "; " + origin_text(password.by, players);
}

std::string restriction_list(const RightsState& state, TimeUs now_us, const KnownPlayers& players) {
  RightsLines lines;
  for (const Decided<Restrict>* restriction : state.restrictions()) {
    const Restrict& value = restriction->value;
    if (value.until_us != 0 && value.until_us <= now_us) continue;
    if (!lines.take()) continue;
    lines.add(player_or_range(value.subject, players) + ": " + restricted_text(value.kind) +
              (value.until_us == 0 ? " until it is lifted" : " until " + utc_text(value.until_us)) +
              (value.reason.empty() ? "" : ", \"" + value.reason + "\"") + "; " +
              origin_text(restriction->by, players));
  }
  return lines.text("nobody is banned, muted or frozen");
}

std::string refusal_list(const std::vector<RefusalRow>& rows, const KnownPlayers& players) {
  RightsLines lines;
  for (const RefusalRow& row : rows) {
    if (!lines.take()) continue;
    lines.add(utc_text(row.last_us) + " " + players.text_of(row.key) + ": " + row.what +
              (row.count == 1 ? "" : " (" + std::to_string(row.count) + " times)"));
  }
  return lines.text("nobody was refused anything since the server started");
}

std::string box_list(const std::vector<const Decided<ProtectedBox>*>& boxes,
                     const KnownPlayers& players) {
  RightsLines lines;
  for (const Decided<ProtectedBox>* box : boxes) {
    if (!lines.take()) continue;
    const ProtectedBox& value = box->value;
    const std::string line = value.name + ": " + ground_text(value.box) + ", priority " +
                             std::to_string(value.priority) + ", owner " +
                             (value.owner ? players.text_of(*value.owner) : "nobody");
    std::string members;
    for (const PublicKey& key : value.members)
      members += (members.empty() ? ", members " : " and ") + players.text_of(key);
    std::string roles;
    for (const std::string& role : value.roles)
      roles += (roles.empty() ? ", roles " : " and ") + role;
    lines.add(line + members + roles + "; " + origin_text(box->by, players));
  }
  return lines.text("no ground is protected");
}

}  // namespace runstone
