#include "server/store/place_rule.hpp"

#include <string_view>
#include <vector>

#include "common/core/nearest_name.hpp"
#include "common/postgres/postgres_database.hpp"

namespace runstone {
namespace {

using Checked = Result<void, std::string>;

constexpr std::string_view kForm = "postgresql://USER@HOST:PORT/DATABASE";

/// Returns the text before "://", "postgre" for "postgre://h/d", or before a colon if that is nearly
/// the name of PostgreSQL. Returns an empty text if the text is the name of a folder.
std::string_view scheme_of(std::string_view text) {
  std::string_view scheme = text.substr(0, text.find("://"));
  if (scheme.size() == text.size()) {
    scheme = text.substr(0, text.find(':'));
    static const std::vector<std::string> schemes = {"postgresql", "postgres"};
    if (scheme.size() == text.size() || nearest_name(scheme, schemes).empty()) return {};
  }
  return scheme.find('/') == std::string_view::npos ? scheme : std::string_view();
}

std::string wrong_scheme(std::string_view scheme) {
  const std::string shown = "\"" + std::string(scheme) + ":\"";
  if (scheme == "file" || scheme.starts_with("sqlite"))
    return shown + " is no part of a place: write the folder alone, such as /srv/valley";
  return "\"" + std::string(scheme) +
         ":...\" is no place of a world: it is a folder, or the address of a PostgreSQL database, "
         "which is written " +
         std::string(kForm) + " in lower case";
}

/// Fails if the text is an address that begins right and cannot be read.
Checked check_url(const std::string& url) {
  if (sql::is_readable_url(url)) return {};
  return failure(
      "is no address like " + std::string(kForm) +
      ": in a name or a password, write %25 for %, %40 for @, %3A for :, %2F for / and %3F for ?");
}

}  // namespace

Checked check_place(const std::string& place) {
  if (sql::is_postgres_url(place)) return check_url(place);
  if (const std::string_view scheme = scheme_of(place); !scheme.empty())
    return failure(wrong_scheme(scheme));
  if (const auto url = sql::url_of_keywords(place)) {
    return failure("keywords such as host=... are no place of a world: write them as an address, " +
                   *url + ", with a password as USER:PASSWORD@");
  }
  return {};
}

Checked check_folder(const std::string& folder) {
  if (sql::is_postgres_url(folder))
    return failure("is the address of a database, and only a folder can be here");
  return check_place(folder);
}

Checked check_database_address(const std::string& address) {
  if (auto checked = check_place(address); !checked) return checked;
  if (sql::is_postgres_url(address)) return {};
  return failure("must be the address of a PostgreSQL database: " + std::string(kForm));
}

std::string place_refusal(const std::string& place) {
  const Checked checked = check_place(place);
  return checked ? std::string() : checked.error();
}

std::string folder_refusal(const std::string& folder) {
  const Checked checked = check_folder(folder);
  return checked ? std::string() : checked.error();
}

}  // namespace runstone
