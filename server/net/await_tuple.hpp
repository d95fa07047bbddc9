// kTuple: the completion token of every asynchronous operation that a coroutine waits for. The
// result is a tuple that begins with the error code, so no operation throws.
#pragma once
#include <asio/experimental/as_tuple.hpp>
#include <asio/use_awaitable.hpp>

namespace runstone {

inline constexpr auto kTuple = asio::experimental::as_tuple(asio::use_awaitable);

}  // namespace runstone
