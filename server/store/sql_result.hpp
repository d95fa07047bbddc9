// Conversions from errors of the database to errors of the store, for the tables and SqlStore.
#pragma once
#include <utility>

#include "common/sql/sql_error.hpp"
#include "server/store/store_error.hpp"

namespace runstone {

/// Makes the error of the store that a function returns.
Unexpected<StoreError> failed(const sql::Error& error);
inline Unexpected<StoreError> failed(const StoreError& error) { return failure(error); }

inline StoreResult<void> store_result(const sql::Result<void>& result) {
  if (!result) return failed(result.error());
  return {};
}

template <class T>
StoreResult<T> store_result(sql::Result<T> result) {
  if (!result) return failed(result.error());
  return *std::move(result);
}

}  // namespace runstone
