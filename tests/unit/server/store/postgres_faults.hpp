// The faults of a PostgreSQL database that the tests of the store inject, and what an error of the
// store must say of each.
#pragma once
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "server/store/store_error.hpp"
#include "tests/support/sql/fault_proxy.hpp"

namespace runstone::test {

inline std::vector<ProxyFault> cut_connections() {
  using Kind = ProxyFault::Kind;
  return {{Kind::cut_before},
          {Kind::cut_before_answer},
          {Kind::cut_within_answer},
          {Kind::cut_after_answer}};
}

inline ProxyFault full_disk(bool is_for_ever) {
  return {ProxyFault::Kind::error, "53100",
          "could not extend file \"base/5/16402\": No space left on device", is_for_ever};
}
inline ProxyFault read_only_database(bool is_for_ever) {
  return {ProxyFault::Kind::error, "25006", "cannot execute INSERT in a read-only transaction",
          is_for_ever};
}

inline std::vector<ProxyFault> all_faults() {
  std::vector<ProxyFault> faults = cut_connections();
  faults.push_back(
      {ProxyFault::Kind::fatal, "57P01", "terminating connection due to administrator command"});
  faults.push_back({ProxyFault::Kind::error, "53300", "sorry, too many clients already"});
  for (const bool is_for_ever : {false, true}) {
    faults.push_back(full_disk(is_for_ever));
    faults.push_back(read_only_database(is_for_ever));
  }
  return faults;
}

inline bool has_any(const std::string& text, const std::vector<std::string>& parts) {
  return std::any_of(parts.begin(), parts.end(),
                     [&](const std::string& part) { return text.find(part) != std::string::npos; });
}

/// Checks kind and words of an error that a fault has caused. `name` is that of the database.
inline void check_error(const StoreError& error, const ProxyFault& fault, const std::string& name) {
  INFO(error.message());
  // libpq tells no SQLSTATE of a session that does not begin.
  const bool is_at_start = has_any(error.what, {"connection to server"});
  auto kind = StoreError::Kind::io;
  if (fault.sqlstate == "53100" && !is_at_start) kind = StoreError::Kind::full;
  if (fault.sqlstate == "25006" && !is_at_start) kind = StoreError::Kind::read_only;
  CHECK(error.kind == kind);
  CHECK(error.file == name);
  const std::vector<std::string> cut_words = {"server closed the connection unexpectedly",
                                              "could not receive data from server",
                                              "could not send data to server"};
  CHECK(has_any(error.what, fault.is_error() ? std::vector{fault.text} : cut_words));
  CHECK_FALSE(has_any(error.message(), {"damage", "corrupt", "vanish", "missing", "has no row",
                                        "backup", "estore", "pooler", "pipeline"}));
}

inline std::string text_of(const ProxyFault& fault) {
  constexpr const char* kKinds[] = {"cut before the statement",
                                    "cut before the answer",
                                    "cut within the answer",
                                    "cut after the answer",
                                    "error",
                                    "fatal error"};
  return std::string(kKinds[static_cast<std::size_t>(fault.kind)]) + " " + fault.sqlstate +
         (fault.is_for_ever ? ", for ever" : ", once");
}

}  // namespace runstone::test
