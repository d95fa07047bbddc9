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

namespace runstone::sql {
namespace {

void ignore_notice(void*, const PGresult*) {}

/// Fails if the database stores texts otherwise than in UTF-8, or commits before the disk has the
/// data.
Result<void> set_up(Database& database, PostgresMode mode) {
  const auto encoding = database.text("SELECT current_setting('server_encoding')");
  if (!encoding) return failure(encoding.error());
  if (*encoding != "UTF8") {
    return failure(Error{Error::Kind::io, database.file(),
                         "the encoding of the database is " + *encoding + ", not UTF8"});
  }
  const auto commits = database.text("SELECT current_setting('synchronous_commit')");
  if (!commits) return failure(commits.error());
  if (*commits == "off") {
    if (auto set = database.run("SET synchronous_commit = on"); !set) return set;
  }
  if (mode == PostgresMode::read) return database.run("SET default_transaction_read_only = on");
  // The server, too, notices that this machine vanished, and gives its locks back.
  return database.run(
      "SET tcp_keepalives_idle = 5; SET tcp_keepalives_interval = 5; SET tcp_keepalives_count = 2; "
      "SET tcp_user_timeout = 15000");
}

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
  if (PQconninfoOption* const options = PQconninfoParse(url.c_str(), nullptr)) {
    PQconninfoFree(options);
  } else {
    return failure(
        Error{Error::Kind::io, name, "is no address like postgresql://USER@HOST:PORT/DATABASE"});
  }
  PGconn* const handle = PQconnectdbParams(kKeys.data(), values.data(), 1);
  if (handle == nullptr) return failure(Error{Error::Kind::io, name, "out of memory"});
  Database database(std::make_unique<PostgresConnection>(name, handle));
  if (PQstatus(handle) != CONNECTION_OK) {
    return failure(Error{Error::Kind::io, name, connection_message(handle)});
  }
  PQsetNoticeReceiver(handle, &ignore_notice, nullptr);
  if (auto ready = set_up(database, mode); !ready) return failure(ready.error());
  return database;
}

}  // namespace runstone::sql
