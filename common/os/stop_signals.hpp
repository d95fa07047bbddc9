// SIGINT and SIGTERM as requests to stop, for the client and the bots.
#pragma once
#include <csignal>

namespace runstone {

/// Installs handlers that only count these signals. Returns the count, which lives as long as the
/// program.
const volatile std::sig_atomic_t& count_stop_signals();

}  // namespace runstone
