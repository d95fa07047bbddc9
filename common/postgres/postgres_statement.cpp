#include <libpq-fe.h>

#include <algorithm>

#include "common/postgres/postgres_connection.hpp"

namespace runstone::sql {
namespace {

// Object ids of types (pg_type.dat of PostgreSQL), which are the same in all versions.
constexpr Oid kBool = 16, kBytea = 17, kInt8 = 20, kInt2 = 21, kInt4 = 23, kText = 25,
              kVarchar = 1043;

}  // namespace

PostgresStatement::Value* PostgresStatement::value_of(int parameter) {
  const auto i = static_cast<std::size_t>(parameter - 1);
  if (i < values_.size()) return &values_[i];
  has_bad_bind_ = true;
  return nullptr;
}

void PostgresStatement::bind(int parameter, std::int64_t value) {
  Value* const into = value_of(parameter);
  if (into == nullptr) return;
  for (std::size_t i = 0; i < into->integer.size(); ++i)
    into->integer[i] = static_cast<char>(static_cast<std::uint64_t>(value) >> (56 - 8 * i));
  into->is_integer = true;
  into->size = into->integer.size();
}

void PostgresStatement::bind(int parameter, ByteView value) {
  // libpq takes a null pointer as NULL.
  bind(parameter,
       value.empty() ? std::string_view("", 0)
                     : std::string_view(reinterpret_cast<const char*>(value.data()), value.size()));
}

void PostgresStatement::bind(int parameter, std::string_view value) {
  Value* const into = value_of(parameter);
  if (into == nullptr) return;
  into->is_integer = false;
  into->data = value.data() == nullptr ? "" : value.data();
  into->size = value.size();
}

PostgresValues PostgresStatement::values() const {
  PostgresValues out;
  const int count =
      text_.slots.empty() ? 0 : *std::max_element(text_.slots.begin(), text_.slots.end());
  out.data.resize(static_cast<std::size_t>(count));
  out.sizes.resize(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < values_.size(); ++i) {
    if (text_.slots[i] == 0) continue;
    const auto slot = static_cast<std::size_t>(text_.slots[i] - 1);
    const Value& value = values_[i];
    out.data[slot] = value.is_integer ? value.integer.data() : value.data;
    out.sizes[slot] = static_cast<int>(value.size);
  }
  return out;
}

Unexpected<Error> PostgresStatement::bad_bind() const {
  return {Error{Error::Kind::bad_statement, connection_.file(),
                "a statement has not so many parameters"}};
}

Result<bool> PostgresStatement::step() {
  if (has_bad_bind_) return bad_bind();
  if (!result_) {
    auto result = connection_.execute(text_, values());
    if (!result) return failure(result.error());
    result_ = *std::move(result);
    row_ = -1;
  }
  const int rows = PQntuples(result_.get());
  row_ = std::min(row_ + 1, rows);
  return row_ < rows;
}

Result<void> PostgresStatement::run() {
  Result<void> done = has_bad_bind_ ? Result<void>(bad_bind()) : connection_.send(text_, values());
  reset();
  return done;
}

void PostgresStatement::rewind() { result_.reset(); }

void PostgresStatement::reset() {
  result_.reset();
  std::fill(values_.begin(), values_.end(), Value());
  has_bad_bind_ = false;
}

std::int64_t PostgresStatement::integer(int column) const {
  if (type(column) != Type::integer) return 0;
  const ByteView bytes = blob(column);
  // The sign of the first byte is that of the number.
  std::int64_t value = static_cast<std::int8_t>(bytes[0]);
  for (std::size_t i = 1; i < bytes.size(); ++i)
    value = static_cast<std::int64_t>(static_cast<std::uint64_t>(value) << 8 | bytes[i]);
  return value;
}

ByteView PostgresStatement::blob(int column) const {
  return {reinterpret_cast<const std::uint8_t*>(PQgetvalue(result_.get(), row_, column)),
          static_cast<std::size_t>(PQgetlength(result_.get(), row_, column))};
}

Type PostgresStatement::type(int column) const {
  if (PQgetisnull(result_.get(), row_, column) != 0) return Type::other;
  switch (PQftype(result_.get(), column)) {
    case kBool:
    case kInt2:
    case kInt4:
    case kInt8:
      return Type::integer;
    case kText:
    case kVarchar:
      return Type::text;
    case kBytea:
      return Type::blob;
    default:
      return Type::other;
  }
}

}  // namespace runstone::sql
