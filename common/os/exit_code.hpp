// What runstone-client's exit codes mean to scripts.
#pragma once

namespace runstone {

inline constexpr int kExitOk = 0;
/// An expectation of the script failed, drift was found, or something could not be written.
inline constexpr int kExitFailed = 1;
/// Bad arguments or draw orders, no OpenGL or no more, no server.
inline constexpr int kExitNoStart = 2;

}  // namespace runstone
