// The exit codes of runstone-client and runstone-bot. Scripts rely on them.
#pragma once

namespace runstone {

inline constexpr int kExitOk = 0;
/// An expectation of a script failed, a replica drifted, or a file could not be written.
inline constexpr int kExitFailed = 1;
/// The arguments or draw orders are wrong, OpenGL is missing or failed, or no server answered.
inline constexpr int kExitNoStart = 2;

}  // namespace runstone
