// OriginCheck: which pages may open a WebSocket. A browser sends the origin of the page with the
// request, and the page cannot change it. A page of somebody else must not use the address of its
// visitors.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.hpp"

namespace runstone {

/// Splits the setting `origins`. Fails unless each is "http://HOST", "https://HOST" or one of them
/// with a port, in lower case and without a path.
Result<std::vector<std::string>, std::string> parse_origins(const std::string& text);

class OriginCheck {
 public:
  /// `allowed`: as parse_origins() returns them. If there are none, pages of this gateway may.
  /// Without encryption only those that were opened by an address in digits or as "localhost" may:
  /// a page of somebody else could let its own name lead to this gateway (DNS rebinding). A
  /// certificate prevents that, because it does not have that name.
  OriginCheck(std::vector<std::string> allowed, bool is_encrypted)
      : allowed_(std::move(allowed)),
        is_encrypted_(is_encrypted),
        scheme_(is_encrypted ? "https://" : "http://") {}

  /// Returns true if a request with these headers may open a WebSocket. Without an origin it does
  /// not come from a page, so it may.
  bool allows(std::optional<std::string_view> origin, std::string_view host) const;
  /// Returns the WebSockets of the allowed origins, each after a blank: " wss://play.example.org".
  /// Gateways of one world name each other's pages, so their pages may connect there.
  std::string sockets() const;

 private:
  const std::vector<std::string> allowed_;
  const bool is_encrypted_;
  const std::string scheme_;
};

}  // namespace runstone
