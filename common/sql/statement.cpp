#include "common/sql/statement.hpp"

namespace runstone::sql {
namespace {

Unexpected<Error> no_statement() {
  return {Error{Error::Kind::bad_statement, "", "is no statement"}};
}

}  // namespace

Result<bool> Statement::step() {
  if (!handle_) return no_statement();
  return handle_->step();
}

Result<void> Statement::run() {
  if (!handle_) return no_statement();
  return handle_->run();
}

}  // namespace runstone::sql
