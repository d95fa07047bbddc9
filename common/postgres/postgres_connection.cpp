#include "common/postgres/postgres_connection.hpp"

#include <libpq-fe.h>

#include <cstdlib>

namespace runstone::sql {
namespace {

constexpr std::size_t kSentMax = 1'024;  // bounds the answers that wait in memory

/// Returns the kind of an SQLSTATE (PostgreSQL's documentation, appendix A).
Error::Kind kind_of_state(std::string_view state) {
  if (state == "53100") return Error::Kind::full;
  if (state.starts_with("23")) return Error::Kind::constraint;
  if (state == "25006") return Error::Kind::read_only;
  if (state.starts_with("42") || state.starts_with("0A")) return Error::Kind::bad_statement;
  if (state == "XX001" || state == "XX002") return Error::Kind::corrupt;
  if (state == "55P03" || state.starts_with("40")) return Error::Kind::locked;
  return Error::Kind::io;
}

}  // namespace

std::string connection_message(PGconn* handle) {
  const std::string text = PQerrorMessage(handle);
  return text.substr(0, text.find('\n'));
}

Error result_error(PGconn* handle, const std::string& name, const PGresult* result) {
  const char* message =
      result == nullptr ? nullptr : PQresultErrorField(result, PG_DIAG_MESSAGE_PRIMARY);
  if (message == nullptr) return {Error::Kind::io, name, connection_message(handle)};
  std::string what = message;
  if (const char* detail = PQresultErrorField(result, PG_DIAG_MESSAGE_DETAIL))
    what += std::string(": ") + detail;
  const char* state = PQresultErrorField(result, PG_DIAG_SQLSTATE);
  return {kind_of_state(state == nullptr ? "" : state), name, std::move(what)};
}

void ClearResult::operator()(PGresult* result) const { PQclear(result); }
void FinishConnection::operator()(PGconn* handle) const { PQfinish(handle); }

Unexpected<Error> PostgresConnection::result_failure(const PGresult* result) const {
  return failure(result_error(handle_.get(), name_, result));
}

bool PostgresConnection::is_connected() const { return PQstatus(handle_.get()) == CONNECTION_OK; }

Result<void> PostgresConnection::take(const PGresult* result) {
  const ExecStatusType status = PQresultStatus(result);
  if (status != PGRES_COMMAND_OK && status != PGRES_TUPLES_OK) return result_failure(result);
  if (status == PGRES_COMMAND_OK)
    changes_ = std::strtoll(PQcmdTuples(const_cast<PGresult*>(result)), nullptr, 10);
  return {};
}

Result<void> PostgresConnection::drain(PostgresResult* last) {
  if (unreported_) return failure(*std::exchange(unreported_, std::nullopt));
  if (sent_ == 0) return {};
  sent_ = 0;
  Result<void> done;
  if (PQpipelineSync(handle_.get()) != 1) return result_failure(nullptr);
  while (PQstatus(handle_.get()) == CONNECTION_OK) {
    PostgresResult result(PQgetResult(handle_.get()));
    if (!result) continue;  // it comes after the results of each statement
    if (PQresultStatus(result.get()) == PGRES_PIPELINE_SYNC) break;
    auto taken = take(result.get());
    if (!taken && done) done = std::move(taken);
    if (last != nullptr) *last = std::move(result);
  }
  if (PQstatus(handle_.get()) != CONNECTION_OK && done) done = result_failure(nullptr);
  if (PQexitPipelineMode(handle_.get()) != 1 && done) done = result_failure(nullptr);
  return done;
}

Result<void> PostgresConnection::run(const char* sql) {
  if (auto drained = drain(); !drained) return drained;
  const PostgresResult result(PQexec(handle_.get(), sql));
  return take(result.get());
}

Result<Statement> PostgresConnection::prepare(std::string_view sql) {
  auto found = prepared_.find(sql);
  if (found == prepared_.end()) {
    if (auto drained = drain(); !drained) return failure(drained.error());
    PostgresText text = postgres_text(sql);
    PreparedText prepared{"s" + std::to_string(prepared_.size()), std::move(text.slots)};
    const PostgresResult result(
        PQprepare(handle_.get(), prepared.name.c_str(), text.text.c_str(), 0, nullptr));
    if (auto taken = take(result.get()); !taken) return failure(taken.error());
    found = prepared_.emplace(sql, std::move(prepared)).first;
  }
  return Statement(std::make_unique<PostgresStatement>(*this, found->second));
}

std::int64_t PostgresConnection::changes() {
  if (auto drained = drain(); !drained) {
    unreported_ = drained.error();
    return 0;
  }
  return changes_;
}

Result<void> PostgresConnection::begin_write() {
  // PostgreSQL would only warn, and the end of the inner transaction would commit the outer one.
  if (is_writing_ || reads_ > 0)
    return failure(Error{Error::Kind::bad_statement, name_, "a transaction is open already"});
  if (auto ended = end_left_transaction(); !ended) return ended;
  // At other levels, PostgreSQL refuses to read a row that was changed after the begin, such as a lease
  // that was renewed. The database may have another level as its default.
  auto begun = run("BEGIN ISOLATION LEVEL READ COMMITTED");
  is_writing_ = begun.has_value();
  return begun;
}

Result<void> PostgresConnection::commit() {
  if (auto drained = drain(); !drained) return drained;
  const PostgresResult result(PQexec(handle_.get(), "COMMIT"));
  if (auto taken = take(result.get()); !taken) return taken;
  is_writing_ = false;
  // The commit of a transaction in which a statement has failed is a rollback.
  if (std::string_view(PQcmdStatus(result.get())) != "COMMIT")
    return failure(Error{Error::Kind::io, name_, "the transaction was rolled back"});
  return {};
}

Result<void> PostgresConnection::roll_back() {
  unreported_.reset();
  static_cast<void>(drain().has_value());
  is_writing_ = false;
  return run("ROLLBACK");
}

Result<void> PostgresConnection::end_left_transaction() {
  if (PQtransactionStatus(handle_.get()) == PQTRANS_IDLE) return {};
  return run("ROLLBACK");
}

Result<void> PostgresConnection::begin_reads() {
  if (!is_writing_ && reads_ == 0) {
    if (auto ended = end_left_transaction(); !ended) return ended;
    if (auto begun = run("BEGIN ISOLATION LEVEL REPEATABLE READ READ ONLY"); !begun) return begun;
  }
  ++reads_;
  return {};
}

Result<void> PostgresConnection::end_reads() {
  --reads_;
  if (is_writing_ || reads_ > 0) return {};
  return run("COMMIT");
}

Result<PostgresResult> PostgresConnection::execute(const PreparedText& statement,
                                                   const PostgresValues& values) {
  PostgresResult result;
  if (sent_ > 0) {
    if (auto queued = enqueue(statement, values); !queued) return failure(queued.error());
    if (auto drained = drain(&result); !drained) return failure(drained.error());
    return result;
  }
  if (auto drained = drain(); !drained) return failure(drained.error());  // an unreported error
  const std::vector<int> formats(values.data.size(), 1);
  result.reset(PQexecPrepared(handle_.get(), statement.name.c_str(),
                              static_cast<int>(values.data.size()), values.data.data(),
                              values.sizes.data(), formats.data(), 1));
  if (auto taken = take(result.get()); !taken) return failure(taken.error());
  return result;
}

Result<void> PostgresConnection::send(const PreparedText& statement, const PostgresValues& values) {
  if (!is_writing_) {
    const auto result = execute(statement, values);
    if (!result) return failure(result.error());
    return {};
  }
  if (sent_ >= kSentMax) {
    if (auto drained = drain(); !drained) return drained;
  }
  return enqueue(statement, values);
}

Result<void> PostgresConnection::enqueue(const PreparedText& statement,
                                         const PostgresValues& values) {
  if (sent_ == 0 && PQenterPipelineMode(handle_.get()) != 1) return result_failure(nullptr);
  ++sent_;
  const std::vector<int> formats(values.data.size(), 1);
  if (PQsendQueryPrepared(handle_.get(), statement.name.c_str(),
                          static_cast<int>(values.data.size()), values.data.data(),
                          values.sizes.data(), formats.data(), 1) != 1) {
    return result_failure(nullptr);
  }
  return {};
}

}  // namespace runstone::sql
