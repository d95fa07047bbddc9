#include "common/os/stop_signals.hpp"

namespace runstone {
namespace {

volatile std::sig_atomic_t signals_caught = 0;

void count_signal(int) { signals_caught = signals_caught + 1; }

}  // namespace

const volatile std::sig_atomic_t& count_stop_signals() {
  struct sigaction action{};
  action.sa_handler = count_signal;
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
  return signals_caught;
}

}  // namespace runstone
