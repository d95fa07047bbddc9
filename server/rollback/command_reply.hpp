// CommandReply: how the desks answer a command.
#pragma once
#include <functional>
#include <string>
#include <utility>

namespace runstone {

/// One answer: text of one or more lines without a final line break. The last one of a request is done.
struct DeskAnswer {
  std::string text;
  bool is_done = true;
  bool is_ok = true;  // of the last one
};
using CommandReply = std::function<void(const DeskAnswer&)>;

/// The only answer to what cannot be done.
inline void refuse(const CommandReply& reply, std::string text) {
  reply({std::move(text), true, false});
}

}  // namespace runstone
