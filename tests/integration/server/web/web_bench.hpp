// WebBench: a server with a gateway in front of it, both in this process.
#pragma once
#include <catch2/catch.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "server/web/web_gateway.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/support/net/web_peer.hpp"

namespace runstone::test {

inline ServerConfig server_config_of(const TempFolder& folder) {
  ServerConfig config = quiet_config(folder / "world");
  config.gateway_socket = folder / "web.sock";
  return config;
}

inline WebConfig web_config_of(const TempFolder& folder) {
  WebConfig config;
  config.listen = "127.0.0.1:0";
  config.gateway_socket = folder / "web.sock";
  config.connections_per_second = 0;
  config.sockets_per_address = 1'024;
  return config;
}

/// Requires the start to succeed.
inline std::unique_ptr<WebGateway> start_gateway(const WebConfig& config) {
  auto gateway = WebGateway::start(config);
  INFO((gateway ? std::string() : gateway.error()));
  REQUIRE(gateway.has_value());
  return *std::move(gateway);
}

struct WebBench {
  explicit WebBench(const TempFolder& folder)
      : WebBench(server_config_of(folder), web_config_of(folder)) {}
  WebBench(const ServerConfig& server_config, const WebConfig& web_config)
      : server(start_server(server_config, flat_creation())), gateway(start_gateway(web_config)) {}
  std::uint16_t port() const { return gateway->port(); }

  std::unique_ptr<Server> server;
  std::unique_ptr<WebGateway> gateway;
};

/// Asks for a page until it has the text, for at most half a minute.
inline bool comes_to_show(std::uint16_t port, const std::string& target, const std::string& text) {
  for (int i = 0; i < 300; ++i) {
    WebPeer peer(port);
    if (peer.get(target).body.find(text) != std::string::npos) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return false;
}

}  // namespace runstone::test
