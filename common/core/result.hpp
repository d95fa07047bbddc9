// Result<T>: a value or an error, for input that may be bad. C++20 lacks std::expected, and g++ 12
// has it only in C++23 mode. The member names are those of std::expected, so that Result can become
// an alias later. An Error never allocates: it holds an enum, a static string and the byte offset
// of the fault.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

#include "common/core/assert.hpp"

namespace runstone {

enum class ErrorCode : std::uint16_t {
  truncated,         // the input ended early
  trailing_bytes,    // bytes left over after a complete value
  not_canonical,     // decodes, but is not the one accepted encoding
  bad_value,         // a field is outside its documented range
  bad_version,       // made by an unknown format version
  limit_exceeded,    // larger than a documented limit
  bad_checksum,      // bytes were damaged
  broken_invariant,  // a structural rule of runs, layers or frames does not hold
  unknown_kind,      // a tag, message type or encoding that this build does not know
  not_found,         // a named object does not exist
  io_failed,         // the disk or the network failed
  not_permitted,     // the player may not do this
};

struct Error {
  ErrorCode code{};
  const char* what = "";     // static string; names the field and the rule
  std::uint64_t offset = 0;  // byte offset, run index or row, as the callee documents
  friend bool operator==(const Error& a, const Error& b) {
    return a.code == b.code && a.offset == b.offset;
  }
};

/// An error on its way into a Result. failure() and fail() make it.
template <class E>
struct Unexpected {
  E error;
};

/// Makes the error that a function returns: `return failure(opened.error());`. Its type is that of the
/// argument, or std::string, a line of text, for everything that converts to one.
template <class E>
  requires(!std::is_convertible_v<E, std::string>)
Unexpected<std::remove_cvref_t<E>> failure(E&& error) {
  return {std::forward<E>(error)};
}
inline Unexpected<std::string> failure(std::string line) { return {std::move(line)}; }

/// Makes an Error that a function returns.
inline Unexpected<Error> fail(ErrorCode code, const char* what, std::uint64_t offset = 0) {
  return failure(Error{code, what, offset});
}

template <class T, class E = Error>
class [[nodiscard]] Result {
 public:
  /// Both constructors are implicit, so that a function can return a value or failure(...).
  template <class U = T>
    requires std::is_convertible_v<U, T> && (!std::is_same_v<std::remove_cvref_t<U>, Result>)
  Result(U&& value) : state_(std::in_place_index<0>, std::forward<U>(value)) {}
  Result(Unexpected<E> error) : state_(std::in_place_index<1>, std::move(error.error)) {}

  bool has_value() const { return state_.index() == 0; }
  explicit operator bool() const { return has_value(); }

  T& value() & {
    T* held = std::get_if<0>(&state_);
    RUNSTONE_ASSERT(held != nullptr);
    return *held;
  }
  const T& value() const& {
    const T* held = std::get_if<0>(&state_);
    RUNSTONE_ASSERT(held != nullptr);
    return *held;
  }
  T&& value() && { return std::move(value()); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  const E& error() const {
    const E* held = std::get_if<1>(&state_);
    RUNSTONE_ASSERT(held != nullptr);
    return *held;
  }

 private:
  std::variant<T, E> state_;
};

template <class E>
class [[nodiscard]] Result<void, E> {
 public:
  Result() = default;
  Result(Unexpected<E> error) : error_(std::move(error.error)) {}

  bool has_value() const { return !error_.has_value(); }
  explicit operator bool() const { return has_value(); }
  const E& error() const {
    RUNSTONE_ASSERT(error_.has_value());
    return *error_;
  }

 private:
  std::optional<E> error_;
};

}  // namespace runstone
