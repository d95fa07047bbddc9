// AttackedServer: how experiments start the server that hostile clients attack, measure it from
// outside, and stop it. A TestbedServer with the settings that all such experiments share.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "bench/network/testbed.hpp"

namespace runstone::bench {

inline constexpr double kLookSeconds = 0.02;  // between two looks at a server's memory
/// The target for the server's memory in MB: its setting memory_mib, 512 by default, and what else
/// it may take.
inline constexpr double kServerMbMax = 512 * 1.048576 + 128;

/// Starts a server with default settings and `flags` on a new world. It ends a silent session after
/// 5 s, not after a minute, so that this happens within an attack.
Result<TestbedServer, std::string> start_attacked_server(Testbed& testbed, TestbedLink& link,
                                                         const std::vector<std::string>& flags);

double resident_mb(const TestbedServer& server);
/// Returns the KB that the server has caused to be written to disks so far.
double written_kb(const TestbedServer& server);

/// Stops the server in order. Calls `look` until the server has ended, because the figures of a
/// process disappear with its end. Returns the seconds that the stop took. Fails if the server does
/// not end properly within a minute.
Result<double, std::string> stop_attacked_server(Testbed& testbed, TestbedServer& server,
                                                 const std::function<void()>& look);

}  // namespace runstone::bench
