#include "common/sql/transaction.hpp"

namespace runstone::sql {

Result<Transaction> Transaction::begin(Database& database) {
  if (const auto begun = database.connection().begin_write(); !begun) return failure(begun.error());
  return Transaction(database);
}

Transaction::~Transaction() {
  // A commit that failed may have rolled back already. This call then fails, and nothing is left to
  // undo.
  if (database_ != nullptr) static_cast<void>(database_->connection().roll_back().has_value());
}

Result<void> Transaction::commit() {
  auto done = database_->connection().commit();
  if (done) database_ = nullptr;
  return done;
}

}  // namespace runstone::sql
