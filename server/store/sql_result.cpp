#include "server/store/sql_result.hpp"

namespace runstone {
namespace {

StoreError::Kind kind_of(sql::Error::Kind kind) {
  switch (kind) {
    case sql::Error::Kind::full:
      return StoreError::Kind::full;
    case sql::Error::Kind::read_only:
      return StoreError::Kind::read_only;
    case sql::Error::Kind::corrupt:
      return StoreError::Kind::corrupt;
    case sql::Error::Kind::locked:
      return StoreError::Kind::locked;
    case sql::Error::Kind::constraint:
      return StoreError::Kind::bad_request;
    case sql::Error::Kind::io:
    case sql::Error::Kind::bad_statement:
      break;
  }
  return StoreError::Kind::io;
}

}  // namespace

Unexpected<StoreError> failed(const sql::Error& error) {
  return {{kind_of(error.kind), error.file, "", error.what}};
}

}  // namespace runstone
