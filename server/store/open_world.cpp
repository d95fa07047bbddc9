// create_world() and open_world() on the backend of a place.
#include "common/postgres/postgres_database.hpp"
#include "server/store/postgres_backend.hpp"
#include "server/store/sqlite_backend.hpp"
#include "server/store/store.hpp"

namespace runstone {

bool is_database(const std::string& place) { return sql::is_postgres_url(place); }

std::string place_name(const std::string& place) {
  return is_database(place) ? sql::without_password(place) : place;
}

StoreResult<std::unique_ptr<Store>> create_world(const std::string& place, const WorldMeta& meta,
                                                 const std::string& vfs, const LeaseTerms& lease) {
  if (is_database(place)) return create_postgres_world(place, meta, lease);
  return create_sqlite_world(place, meta, {vfs, true});
}

StoreResult<std::unique_ptr<Store>> open_world(const std::string& place, StoreAccess access,
                                               const std::string& vfs, const LeaseTerms& lease) {
  if (is_database(place)) return open_postgres_world(place, access, lease);
  return open_sqlite_world(place, access, {vfs, true});
}

}  // namespace runstone
