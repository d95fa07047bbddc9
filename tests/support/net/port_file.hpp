// The file into which a program writes its port (--port-file).
#pragma once
#include <chrono>
#include <cstdint>
#include <fstream>
#include <string>
#include <thread>

namespace runstone::test {

/// Waits until a program has written its port, for at most a minute. Returns the port, or 0 if the
/// program wrote none.
inline std::uint16_t port_in(const std::string& file) {
  for (int i = 0; i < 6'000; ++i) {
    int port = 0;
    if (std::ifstream(file) >> port) return static_cast<std::uint16_t>(port);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return 0;
}

}  // namespace runstone::test
