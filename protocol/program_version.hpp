// Program version: the text that the programs that speak the protocol print for --version.
#pragma once
#include <string>
#include <string_view>

#include "common/core/version.hpp"
#include "protocol/limits.hpp"

namespace runstone {

/// Returns "PROGRAM 0.2.0, protocol 2" with the versions of this build.
inline std::string program_version(std::string_view program) {
  return std::string(program) + " " + std::string(version()) + ", protocol " +
         std::to_string(kProtocolVersion);
}

}  // namespace runstone
