// WebGateway: a running gateway: it listens for browsers, serves pages, and passes WebSockets on to
// servers on this machine. The program runs one, tests run several.
// Threads: the functions may be called from any thread. The gateway has one thread of its own, on
// which all of its connections live.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "common/core/result.hpp"
#include "server/web/web_config.hpp"

namespace runstone {

class WebGateway {
 public:
  /// Binds the address and runs. The servers need not run yet. The error is one line for the
  /// operator.
  static Result<std::unique_ptr<WebGateway>, std::string> start(const WebConfig& config);
  /// Closes the WebSockets with words, all other connections at once, and ends the thread. Blocks
  /// for a few seconds at most.
  ~WebGateway();
  WebGateway(const WebGateway&) = delete;
  WebGateway& operator=(const WebGateway&) = delete;

  std::uint16_t port() const;
  bool is_encrypted() const;
  /// Reads the certificate again, for connections that are made from then on. If it cannot be used,
  /// the old one stays. Either way a line for the operator says so. The gateway reads
  /// it by itself when the files have changed.
  void reload_certificate();

 private:
  struct Parts;
  explicit WebGateway(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace runstone
