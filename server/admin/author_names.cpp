#include "server/admin/author_names.hpp"

#include "protocol/codec/key_fingerprint.hpp"

namespace runstone {

AuthorNames::AuthorNames(const std::vector<PlayerRow>& rows, const std::vector<UsedName>& used) {
  for (const PlayerRow& row : rows) {
    names_[row.author] = row.name;
    keys_[row.author] = row.key;
    authors_[row.name].insert(row.author);
  }
  for (const UsedName& name : used) authors_[name.name].insert(name.author);
}

std::string AuthorNames::of(AuthorId author) const {
  if (author == 0) return "the server";
  const auto found = names_.find(author);
  return (found == names_.end() ? "" : found->second + " ") + "#" + std::to_string(author);
}

std::string AuthorNames::with_key(AuthorId author) const {
  const auto key = keys_.find(author);
  return of(author) + (key == keys_.end() ? "" : " " + key_fingerprint(key->second));
}

Result<AuthorId, std::string> AuthorNames::find(const std::string& name) const {
  const auto found = authors_.find(name);
  if (found == authors_.end()) {
    return failure("nobody of that name has ever built (players lists them)");
  }
  if (found->second.size() == 1) return *found->second.begin();
  std::string list;
  for (const AuthorId author : found->second) list += (list.empty() ? " " : ", ") + of(author);
  return failure("several players have or had that name:" + list + " (give # and a number)");
}

bool AuthorNames::is_in_use(const std::string& name, AuthorId author) const {
  const auto found = names_.find(author);
  return found != names_.end() && found->second == name;
}

}  // namespace runstone
