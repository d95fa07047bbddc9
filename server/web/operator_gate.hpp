// OperatorGate: answers the requests for the page of operators. It knows tokens and rights of nobody:
// the server decides about each request (docs/operators-page.md).
// Thread: the gateway's.
#pragma once
#include <utility>
// Boost 1.74 uses std::exchange without its header, so <utility> comes first.
#include <boost/asio/awaitable.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include "common/core/address_block.hpp"
#include "server/web/http_answer.hpp"
#include "server/web/web_state.hpp"

namespace runstone {

/// The parts of a request that the page reads.
struct OperatorRequest {
  AddressBlock from;
  std::uint16_t port = 0;  // of the gateway
  std::string method, target, body;
  std::string host, cookie, content_type, fetch_site;
  /// The header Origin; nullopt: there is none, or there are several.
  std::optional<std::string> origin = std::nullopt;
};

/// Returns true if the path belongs to the page, whether the gateway has it or not.
bool is_for_operators(std::string_view path);
/// Returns the answer to a request with such a path. `state` must outlive the call.
boost::asio::awaitable<HttpAnswer> answer_operator(WebState& state, WebWorld& world,
                                                   OperatorRequest request);

}  // namespace runstone
