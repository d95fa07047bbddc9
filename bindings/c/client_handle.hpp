// The object behind runstone_client: the client of the C++ library, and the events that a program
// has drained or that did not fit its buffer.
#pragma once
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "bindings/c/handle.hpp"
#include "client/api/world_client.hpp"
#include "common/core/text.hpp"

struct runstone_client : runstone::c_interface::Handle<0x746e6c63> {
  explicit runstone_client(runstone::WorldClient of) : client(std::move(of)) {}

  runstone::WorldClient client;
  std::vector<runstone::WorldEvent> drained;  // by the index that the program knows
  std::deque<runstone::WorldEvent> waiting;   // for the next call that drains
};

namespace runstone::c_interface {

/// Refuses a call with the words of the client.
[[noreturn]] void refuse_as(const ClientRefusal& refusal);

/// Copies a text in UTF-8 to a field, cut to its size between two characters, with a zero at the
/// end.
template <std::size_t kSize>
void write_text(const std::string& from, char (&out)[kSize]) {
  out[cut_utf8(from, kSize - 1).copy(out, kSize - 1)] = '\0';
}

}  // namespace runstone::c_interface
