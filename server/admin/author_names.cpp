#include "server/admin/author_names.hpp"

namespace runstone {

AuthorNames::AuthorNames(const std::vector<PlayerRow>& rows) {
  for (const PlayerRow& row : rows) names_[row.author] = row.name;
}

std::string AuthorNames::of(AuthorId author) const {
  if (author == 0) return "the server";
  const auto found = names_.find(author);
  return (found == names_.end() ? "" : found->second + " ") + "#" + std::to_string(author);
}

Result<AuthorId, std::string> AuthorNames::find(const std::string& name) const {
  std::vector<AuthorId> named;
  for (const auto& [author, its_name] : names_) {
    if (its_name == name) named.push_back(author);
  }
  if (named.size() == 1) return named.front();
  if (named.empty()) {
    return Unexpected<std::string>{"nobody of that name has ever built (players lists them)"};
  }
  std::string numbers;
  for (const AuthorId number : named) numbers += " #" + std::to_string(number);
  return Unexpected<std::string>{"several players have that name:" + numbers};
}

}  // namespace runstone
