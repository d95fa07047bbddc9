// InputEnd: calls a function when standard input ends. A program that starts a server for itself
// keeps the other end of a pipe open. The system closes it however that program ends, so the server
// never outlives it.
#pragma once
#include <unistd.h>

#include <array>
#include <asio/io_context.hpp>
#include <asio/posix/stream_descriptor.hpp>
#include <functional>
#include <memory>
#include <string>

#include "common/core/result.hpp"

namespace runstone {

class InputEnd {
 public:
  /// Reads a copy of the descriptor and drops what it reads. Calls `on_end` once on the thread that
  /// runs the loop, when the input ends or cannot be read. Fails if the descriptor cannot be waited
  /// for, such as that of a regular file. The loop must outlive the object, and must not run any
  /// more when the object is destroyed.
  static Result<std::unique_ptr<InputEnd>, std::string> watch(asio::io_context& loop,
                                                              std::function<void()> on_end,
                                                              int descriptor = STDIN_FILENO);
  InputEnd(asio::io_context& loop, std::function<void()> on_end)
      : input_(loop), on_end_(std::move(on_end)) {}

 private:
  void read();

  asio::posix::stream_descriptor input_;
  const std::function<void()> on_end_;
  std::array<char, 256> dropped_{};
};

}  // namespace runstone
