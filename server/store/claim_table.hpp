// ClaimTable: the names that keys own (`name_claim`), by their folded form. The folded form is
// stored, so that it does not depend on the release of Unicode that a later program has.
#pragma once
#include <optional>
#include <string>
#include <utility>

#include "common/sql/database.hpp"
#include "server/store/folded_rows.hpp"
#include "server/store/store_error.hpp"
#include "server/world/environment/player_rows.hpp"

namespace runstone {

class ClaimTable {
 public:
  static StoreResult<ClaimTable> open(sql::Database& database);

  /// Returns all claims, ascending by folded form. Each row is verified.
  StoreResult<FoldedRows<NameClaim>> claims();
  /// Returns the key that owns a name, or nullopt. Fails (corrupt) if the row is damaged.
  StoreResult<std::optional<PublicKey>> owner(const std::string& folded);
  /// Adds a claim, in the caller's transaction, and updates the fold of `name_claim`. Requires that
  /// the name has no owner.
  StoreResult<void> add(const NameClaim& claim, RowFold& fold);
  /// Removes a claim, in the caller's transaction, and updates the fold of `name_claim`. Requires
  /// that the name has an owner.
  StoreResult<void> remove(const std::string& folded, RowFold& fold);

 private:
  ClaimTable(std::string file, sql::Statement all, sql::Statement one, sql::Statement insert,
             sql::Statement remove)
      : file_(std::move(file)),
        all_(std::move(all)),
        one_(std::move(one)),
        insert_(std::move(insert)),
        remove_(std::move(remove)) {}

  StoreResult<NameClaim> claim_of(const sql::Statement& row) const;

  std::string file_;
  sql::Statement all_, one_, insert_, remove_;
};

}  // namespace runstone
