#include "common/postgres/postgres_database.hpp"

#include <libpq-fe.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "common/postgres/postgres_connection.hpp"
#include "common/postgres/postgres_session.hpp"

namespace runstone::sql {
namespace {

void ignore_notice(void*, const PGresult*) {}

std::vector<std::string> parts_of(const std::string& list) {
  std::vector<std::string> parts;
  std::istringstream in(list);
  for (std::string part; std::getline(in, part, ',');) parts.push_back(part);
  if (parts.empty()) parts.emplace_back();
  return parts;
}
/// Returns HOST:PORT,HOST:PORT of lists with commas. One port is that of all hosts.
std::string hosts_of(const std::string& hosts, const std::string& ports) {
  const std::vector<std::string> port = parts_of(ports);
  std::string text;
  for (std::size_t i = 0; const std::string& host : parts_of(hosts)) {
    const std::string& its_port = port[std::min(i, port.size() - 1)];
    text += (i == 0 ? "" : ",") + host + (its_port.empty() ? "" : ":" + its_port);
    ++i;
  }
  return text;
}

/// Returns why a connection was not made.
std::string refusal_of(PGconn* handle) {
  const std::string message = connection_message(handle);
  // PostgreSQL itself knows all parameters that libpq sends, so a pooler answers.
  if (message.find("unsupported startup parameter") == std::string::npos) return message;
  return message +
         " (a pooler such as pgbouncer answers here: give the address of PostgreSQL itself)";
}

}  // namespace

bool is_postgres_url(const std::string& text) {
  return text.starts_with("postgresql://") || text.starts_with("postgres://");
}

std::string without_password(const std::string& url) {
  PQconninfoOption* const options = PQconninfoParse(url.c_str(), nullptr);
  if (options == nullptr) return "postgresql://...";
  std::map<std::string, std::string> values;
  for (const PQconninfoOption* option = options; option->keyword != nullptr; ++option) {
    if (option->val != nullptr) values[option->keyword] = option->val;
  }
  PQconninfoFree(options);
  const auto part = [&](const char* before, const char* key, const char* after) {
    const std::string& value = values[key];
    return value.empty() ? std::string() : before + value + after;
  };
  const bool is_socket = values["host"].starts_with('/');
  const std::string hosts = hosts_of(is_socket ? "" : values["host"], values["port"]);
  return "postgresql://" + part("", "user", "@") + hosts + part("/", "dbname", "") +
         (is_socket ? part("?host=", "host", "") : "") +
         part(is_socket ? "&options=" : "?options=", "options", "");
}

bool is_readable_url(const std::string& url) {
  PQconninfoOption* const options = PQconninfoParse(url.c_str(), nullptr);
  const bool is_readable = options != nullptr;
  PQconninfoFree(options);
  return is_readable;
}

std::optional<std::string> url_of_keywords(const std::string& text) {
  constexpr const char* kBlanks = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  const std::size_t equals = text.find('=');
  if (begin == std::string::npos || equals == std::string::npos || equals < begin)
    return std::nullopt;
  const std::string word = text.substr(begin, equals - begin);
  const std::string keyword = word.substr(0, word.find_first_of(kBlanks));
  PQconninfoOption* const options = PQconndefaults();
  bool is_known = false;
  for (const PQconninfoOption* option = options; option != nullptr && option->keyword != nullptr;
       ++option)
    is_known = is_known || keyword == option->keyword;
  PQconninfoFree(options);
  return is_known ? std::optional(without_password(text)) : std::nullopt;
}

Result<Database> open_postgres(const std::string& url, PostgresMode mode) {
  // These are defaults: libpq replaces them by the settings in the address, because that comes later
  // in the list. A connection to a machine that does not answer any more ends after 15 seconds.
  constexpr std::array kKeys = {
      "connect_timeout",  "keepalives_idle",  "keepalives_interval",
      "keepalives_count", "tcp_user_timeout", "application_name",
      "client_encoding",  "dbname",           static_cast<const char*>(nullptr)};
  const std::array values = {"10",   "5",         "5",
                             "2",    "15000",     "runstone",
                             "UTF8", url.c_str(), static_cast<const char*>(nullptr)};
  const std::string name = without_password(url);
  // libpq's message about an address that it cannot read quotes it, with its password.
  if (!is_readable_url(url)) {
    return failure(
        Error{Error::Kind::io, name, "is no address like postgresql://USER@HOST:PORT/DATABASE"});
  }
  const auto connect = [&] {
    return ConnectionHandle(PQconnectdbParams(kKeys.data(), values.data(), 1));
  };
  ConnectionHandle handle = connect();
  if (!handle) return failure(Error{Error::Kind::io, name, "out of memory"});
  if (PQstatus(handle.get()) != CONNECTION_OK)
    return failure(Error{Error::Kind::io, name, refusal_of(handle.get())});
  PQsetNoticeReceiver(handle.get(), &ignore_notice, nullptr);
  if (auto kept = refuse_shared_session(handle.get(), name, connect); !kept)
    return failure(kept.error());
  if (auto ready = set_up_session(handle.get(), name, mode); !ready) return failure(ready.error());
  return Database(std::make_unique<PostgresConnection>(name, std::move(handle)));
}

}  // namespace runstone::sql
