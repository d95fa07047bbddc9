#include "common/core/version.hpp"

namespace runstone {

std::string_view version() { return RUNSTONE_VERSION; }

}  // namespace runstone
