// SIGINT and SIGTERM ask a program of the client's side to stop.
#pragma once
#include <csignal>

namespace runstone {

/// From now on they are only counted. Returns the count; it lives as long as the program.
const volatile std::sig_atomic_t& count_stop_signals();

}  // namespace runstone
