#include "common/sqlite/transaction.hpp"

namespace runstone::sql {

Result<Transaction> Transaction::begin(Database& database) {
  if (const auto begun = database.run("BEGIN IMMEDIATE"); !begun)
    return Unexpected<Error>{begun.error()};
  return Transaction(database);
}

Transaction::~Transaction() {
  // A COMMIT that failed may have rolled back already. This ROLLBACK then fails, and nothing is
  // left to undo.
  if (database_ != nullptr) static_cast<void>(database_->run("ROLLBACK").has_value());
}

Result<void> Transaction::commit() {
  auto done = database_->run("COMMIT");
  if (done) database_ = nullptr;
  return done;
}

}  // namespace runstone::sql
