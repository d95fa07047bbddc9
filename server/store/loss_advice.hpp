// The advice at the end of an error about something that a world has lost.
#pragma once

namespace runstone {

inline constexpr const char* kLossAdvice =
    "Put the world back from a backup, or run `runstone-server repair`, or start the server once "
    "with --accept-losses";

}  // namespace runstone
