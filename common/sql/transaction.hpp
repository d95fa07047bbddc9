// sql::Transaction: a write transaction that is rolled back unless it was committed.
#pragma once
#include "common/sql/database.hpp"

namespace runstone::sql {

class Transaction {
 public:
  /// Begins a transaction and takes the write lock at once, if the database has one.
  static Result<Transaction> begin(Database& database);
  Transaction(Transaction&& other) noexcept : database_(other.database_) {
    other.database_ = nullptr;
  }
  Transaction& operator=(Transaction&&) = delete;
  /// Rolls back unless commit() succeeded.
  ~Transaction();
  Result<void> commit();

 private:
  explicit Transaction(Database& database) : database_(&database) {}
  Database* database_;
};

}  // namespace runstone::sql
