#include "server/store/claim_table.hpp"

#include <algorithm>
#include <string_view>

#include "server/store/sql_result.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {
namespace {

std::int64_t claim_checksum(std::string_view folded, std::string_view name, ByteView key) {
  return RowChecksum("name_claim").text(folded).text(name).blob(key).value();
}

}  // namespace

StoreResult<ClaimTable> ClaimTable::open(sql::Database& database) {
  const std::string row = "SELECT folded, name, key, checksum FROM name_claim";
  auto all = database.prepare(row + " ORDER BY folded");
  if (!all) return failed(all.error());
  auto one = database.prepare(row + " WHERE folded = ?1");
  if (!one) return failed(one.error());
  auto insert = database.prepare(
      "INSERT INTO name_claim(folded, name, key, checksum) VALUES(?1, ?2, ?3, ?4)");
  if (!insert) return failed(insert.error());
  auto remove = database.prepare("DELETE FROM name_claim WHERE folded = ?1");
  if (!remove) return failed(remove.error());
  return ClaimTable(database.file(), *std::move(all), *std::move(one), *std::move(insert),
                    *std::move(remove));
}

StoreResult<NameClaim> ClaimTable::claim_of(const sql::Statement& row) const {
  NameClaim claim{std::string(row.text(0)), std::string(row.text(1)), {}};
  const ByteView key = row.blob(2);
  if (row.integer(3) != claim_checksum(claim.folded, claim.name, key) ||
      key.size() != claim.key.size()) {
    return failure(StoreError{StoreError::Kind::corrupt, file_,
                              "name_claim folded=\"" + claim.folded + "\"", "checksum is wrong"});
  }
  std::copy(key.begin(), key.end(), claim.key.begin());
  return claim;
}

StoreResult<FoldedRows<NameClaim>> ClaimTable::claims() {
  return read_folded_rows<NameClaim>(
      all_, 3, [this](const auto& row, auto& rows) { return append_row(claim_of(row), rows); });
}

StoreResult<std::optional<PublicKey>> ClaimTable::owner(const std::string& folded) {
  const sql::ResetAtEnd reset_at_end(one_);
  const auto found = one_.bind(1, std::string_view(folded)).step();
  if (!found) return failed(found.error());
  if (!*found) return std::optional<PublicKey>();
  const auto claim = claim_of(one_);
  if (!claim) return failed(claim.error());
  return std::optional(claim->key);
}

StoreResult<void> ClaimTable::add(const NameClaim& claim, RowFold& fold) {
  const std::int64_t checksum = claim_checksum(claim.folded, claim.name, claim.key);
  add_row(fold, checksum);
  return store_result(insert_.bind(1, std::string_view(claim.folded))
                          .bind(2, std::string_view(claim.name))
                          .bind(3, ByteView(claim.key))
                          .bind(4, checksum)
                          .run());
}

StoreResult<void> ClaimTable::remove(const std::string& folded, RowFold& fold) {
  {
    const sql::ResetAtEnd reset_at_end(one_);
    const auto found = one_.bind(1, std::string_view(folded)).step();
    if (!found) return failed(found.error());
    if (*found) remove_row(fold, one_.integer(3));
  }
  return store_result(remove_.bind(1, std::string_view(folded)).run());
}

}  // namespace runstone
