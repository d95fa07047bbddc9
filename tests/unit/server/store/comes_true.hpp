// Waiting for something that another thread does.
#pragma once
#include <chrono>
#include <functional>
#include <thread>

namespace runstone::test {

/// Asks every 10 ms, for a minute at most. Returns the last answer.
inline bool comes_true(const std::function<bool()>& ask) {
  for (int i = 0; i < 6'000 && !ask(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return ask();
}

}  // namespace runstone::test
