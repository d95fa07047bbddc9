// chunks_of: a Chunks message about one chunk.
#pragma once
#include <cstdint>
#include <utility>

#include "protocol/codec/messages.hpp"

namespace runstone::test {

/// `view` is the number of the view that the message answers.
inline Chunks chunks_of(ChunkAnswer answer, std::uint32_t view = 1) {
  Chunks message;
  message.view = view;
  message.chunks.push_back(std::move(answer));
  return message;
}

}  // namespace runstone::test
